/* SPDX-License-Identifier: MIT
 *
 * ground_reference.c - the signed distance of the ground by all its pieces, and its minima by walking along a body's
 * outline.
 */
#include "ground_reference.h"

#include <assert.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "support.h"

/* Rounding at the ends of pieces, relative to their coordinates: a foot belongs to both pieces there. */
static const double end_tolerance = 1e-12;

/* How far what is in the air is from the normals at open ends, relative to the body. */
static const double end_room = 1e-3;

/* Feet that are as near, relative to the body, and as far apart, are two. */
static const double doubt = 1e-3;

/* An edge from one point to another, or an arc that turns by at most `widest`: its sector from the normal `low`
 * counter-clockwise to `high`. All of it is within `half` of `middle`. */
struct piece {
    bool is_edge, is_concave;
    narc_point from, to, along; /* an edge's direction, of length 1 */
    narc_point center, low, high, middle;
    double radius, length, half, room; /* what rounding leaves between pieces */
    double size;                       /* of all of its arc or edge; INFINITY if that is next to a point */
    size_t run;
    double grain, thickness;
};

/* Most halvings of a stretch of the outline, and two. */
enum { DEPTH = 64 };

/* Arcs and edges that are no longer are points to the search. */
static const double point_size = 1e-3;

static const double widest = 2;

struct ground {
    struct piece *pieces;
    size_t count, last; /* that which was nearest is looked at first */
    bool open;
    narc_point ends[2];
};

static double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static double dot(narc_point a, narc_point b) { return a.x * b.x + a.y * b.y; }
static narc_point minus(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }
static double length_of(narc_point a) { return sqrt(a.x * a.x + a.y * a.y); }

narc_point chain_point(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

static void add_piece(struct ground *ground, struct piece piece) {
    const narc_point chord = minus(piece.to, piece.from);
    piece.middle = (narc_point){(piece.from.x + piece.to.x) / 2, (piece.from.y + piece.to.y) / 2};
    piece.half = length_of(chord) / 2 + 4 * piece.room;
    ground->pieces[ground->count++] = piece;
}

static void add_arc(struct ground *ground, const narc_arc *arc, size_t run) {
    const bool concave = signbit(arc->radius);
    const double sweep = arc->end - arc->start;
    const size_t parts = (size_t)ceil(fabs(sweep) / widest);
    for (size_t k = 0; k < parts; k++) {
        double low = arc->start + sweep * (double)k / (double)parts;
        double high = arc->start + sweep * (double)(k + 1) / (double)parts;
        struct piece piece = {
            .is_concave = concave, .center = {arc->center_x, arc->center_y}, .run = concave ? GROUND_CONCAVE : run};
        piece.from = chain_point(arc, low);
        piece.to = chain_point(arc, high);
        piece.radius = fabs(arc->radius);
        piece.length = fabs(arc->radius * sweep) / (double)parts;
        piece.size = fabs(arc->radius * sweep) > point_size ? fabs(arc->radius * sweep) : INFINITY;
        piece.thickness = arc->radius == 0 && sweep > PI / 2 + 1e-6 ? 0 : INFINITY; /* the tip of a wedge */
        piece.room = end_tolerance * (1 + fabs(piece.from.x) + fabs(piece.from.y) + piece.radius);
        piece.low = concave ? (narc_point){cos(high), sin(high)} : (narc_point){cos(low), sin(low)};
        piece.high = concave ? (narc_point){cos(low), sin(low)} : (narc_point){cos(high), sin(high)};
        add_piece(ground, piece);
    }
}

/* Of each piece's size and radius the least of its own and its neighbours'; points are none. */
static void find_grains(struct ground *ground) {
    for (size_t k = 0; k < ground->count; k++) {
        struct piece *piece = &ground->pieces[k];
        piece->grain = INFINITY;
        for (int side = -1; side <= 1; side++) {
            const struct piece *other = piece;
            for (size_t i = 0; i < ground->count && (other == piece || isinf(other->size)) && side; i++)
                other =
                    &ground->pieces[((size_t)(other - ground->pieces) + ground->count + (size_t)side) % ground->count];
            const double radius = other->is_edge || isinf(other->size) ? INFINITY : other->radius;
            piece->grain = fmin(piece->grain, fmin(other->size, radius));
        }
    }
}

/* Which pieces are there; their grain and thickness are not known. */
static struct ground *walk_pieces(const struct chain *chain) {
    struct ground *ground = calloc(1, sizeof *ground);
    ground->pieces = malloc(5 * chain->count * sizeof *ground->pieces);
    ground->open = !chain->closed;
    ground->ends[0] = chain_point(&chain->arcs[0], chain->arcs[0].start);
    ground->ends[1] = chain_point(&chain->arcs[chain->count - 1], chain->arcs[chain->count - 1].end);
    size_t concave_count = 0, run = 0; /* concave arcs: of all, and before arc k */
    for (size_t k = 0; k < chain->count; k++)
        concave_count += signbit(chain->arcs[k].radius) != 0;
    for (size_t k = 0; k < chain->count; k++) {
        const narc_arc *arc = &chain->arcs[k], *before = k ? arc - 1 : &chain->arcs[chain->count - 1];
        struct piece edge = {
            .is_edge = true, .from = chain_point(before, before->end), .to = chain_point(arc, arc->start), .run = run};
        const narc_point along = minus(edge.to, edge.from);
        edge.length = length_of(along);
        edge.size = edge.length > point_size ? edge.length : INFINITY;
        edge.thickness = INFINITY;
        edge.room = end_tolerance * (1 + fabs(edge.from.x) + fabs(edge.from.y) + fabs(arc->radius));
        edge.along = (narc_point){along.x / edge.length, along.y / edge.length};
        edge.low = (narc_point){edge.along.y, -edge.along.x};
        if ((k || chain->closed) && edge.length > edge.room)
            add_piece(ground, edge);
        add_arc(ground, arc, run);
        run += signbit(arc->radius) != 0;
        run = chain->closed && run == concave_count ? 0 : run; /* the last one is the first one */
    }
    return ground;
}

/* The outline of a body. */
static struct ground *walk_body(const struct reference_body *body) {
    narc_arc arcs[NARC_MAX_ARCS];
    const double c = body->cosine * body->scale, s = body->sine * body->scale, scale = hypot(c, s), turn = atan2(s, c);
    for (size_t k = 0; k < body->count; k++) {
        const narc_arc *arc = &body->arcs[k];
        const double sweep = arc->end - arc->start + (arc->end <= arc->start ? 2 * PI : 0);
        arcs[k] =
            (narc_arc){body->x + c * arc->center_x - s * arc->center_y, body->y + s * arc->center_x + c * arc->center_y,
                       scale * fabs(arc->radius), arc->start + turn, arc->start + turn + sweep};
    }
    return walk_pieces(&(struct chain){arcs, body->count, true});
}

void destroy_ground(struct ground *ground) {
    free(ground->pieces);
    free(ground);
}

/* Is the direction of a vector that of an arc's point, seen from its centre? */
static bool faces(const struct piece *piece, narc_point away) {
    const double sign = piece->is_concave ? -1 : 1;
    return sign * cross(piece->low, away) >= -piece->room && sign * cross(away, piece->high) >= -piece->room;
}

static bool find_foot(const struct piece *piece, narc_point point, struct ground_foot *out) {
    if (piece->is_edge) {
        const narc_point from = minus(point, piece->from);
        const double t = dot(piece->along, from);
        if (t < -piece->room || t - piece->length > piece->room)
            return false;
        *out = (struct ground_foot){dot(piece->low, from),
                                    {piece->from.x + t * piece->along.x, piece->from.y + t * piece->along.y},
                                    piece->low.x,
                                    piece->low.y,
                                    piece->run,
                                    piece->grain,
                                    piece->thickness};
        return true;
    }
    const double sign = piece->is_concave ? -1 : 1;
    const narc_point away = {sign * (point.x - piece->center.x), sign * (point.y - piece->center.y)};
    const double distance = length_of(away);
    const narc_point normal = distance > 0 ? (narc_point){away.x / distance, away.y / distance} : piece->low;
    if (!faces(piece, minus(point, piece->center)))
        return false;
    *out = (struct ground_foot){
        sign * (distance - piece->radius),
        {piece->center.x + sign * piece->radius * normal.x, piece->center.y + sign * piece->radius * normal.y},
        normal.x,
        normal.y,
        piece->run,
        piece->grain,
        piece->thickness};
    return true;
}

/* From the nearest end of the chain. */
static double end_distance(const struct ground *ground, narc_point point) {
    return ground->open ? fmin(length_of(minus(point, ground->ends[0])), length_of(minus(point, ground->ends[1])))
                        : INFINITY;
}

struct ground_foot ground_distance(struct ground *ground, narc_point point) {
    struct ground_foot nearest = {.distance = INFINITY}, foot;
    (void)(ground->last < ground->count && find_foot(&ground->pieces[ground->last], point, &nearest));
    for (size_t k = 0; k < ground->count; k++) {
        const narc_point away = minus(point, ground->pieces[k].middle);
        const double reach = fabs(nearest.distance) + ground->pieces[k].half;
        if (dot(away, away) <= reach * reach && find_foot(&ground->pieces[k], point, &foot) &&
            fabs(foot.distance) < fabs(nearest.distance)) {
            nearest = foot;
            ground->last = k;
        }
    }
    if (end_distance(ground, point) < fabs(nearest.distance) * (1 - end_tolerance))
        nearest.distance = INFINITY;
    return nearest;
}

static int compare_feet(const void *left, const void *right) {
    const double l = fabs(((const struct ground_foot *)left)->distance);
    const double r = fabs(((const struct ground_foot *)right)->distance);
    return (l > r) - (l < r);
}

size_t ground_feet(const struct ground *ground, narc_point point, struct ground_foot *out, size_t capacity) {
    AUTO(free_at) struct ground_foot *all = malloc(ground->count * sizeof *all);
    size_t count = 0;
    for (size_t k = 0; k < ground->count; k++)
        count += find_foot(&ground->pieces[k], point, &all[count]);
    qsort(all, count, sizeof *all, compare_feet);
    count = count < capacity ? count : capacity;
    for (size_t k = 0; k < count; k++)
        out[k] = all[k];
    return count;
}

/* ------------------------------------------------------------------------------------------------ how thick it is */

/* Where a line along a vector of length 1 first crosses a piece beyond `least`, from either side or from the air alone. */
static struct ground_crossing find_crossing(const struct piece *piece, narc_point from, narc_point along, double least,
                                            bool from_air) {
    const narc_point to = minus(piece->is_edge ? piece->from : piece->center, from);
    struct ground_crossing out = {INFINITY, piece->low};
    if (piece->is_edge) {
        const double area = cross(along, piece->along), way = cross(to, piece->along) / area,
                     place = cross(to, along) / area;
        if (way > least && place >= -piece->room && place <= piece->length + piece->room &&
            !(from_air && dot(piece->low, along) >= 0))
            out.along = way;
        return out;
    }
    const double sign = piece->is_concave ? -1 : 1, middle = dot(to, along),
                 half = sqrt(fmax(0, piece->radius * piece->radius - dot(to, to) + middle * middle));
    for (int side = -1; side <= 1; side += 2) {
        const double way = middle + side * half;
        const narc_point away = {way * along.x - to.x, way * along.y - to.y};
        const narc_point normal = {sign * away.x / piece->radius, sign * away.y / piece->radius};
        if (way > least && way < out.along && fabs(length_of(away) - piece->radius) <= piece->room &&
            faces(piece, away) && !(from_air && !(dot(normal, along) < 0)))
            out = (struct ground_crossing){way, normal};
    }
    return out;
}

struct ground_crossing ground_cross(const struct ground *ground, narc_point from, narc_point along) {
    struct ground_crossing first = {INFINITY, {0, 0}};
    for (size_t k = 0; k < ground->count; k++) {
        const struct ground_crossing crossing = find_crossing(&ground->pieces[k], from, along, 0, true);
        first = crossing.along < first.along ? crossing : first;
    }
    return first;
}

/* How thick the solid is behind a piece, at many places: the way against the normal to where there is ground again. */
static double find_thickness(const struct ground *ground, const struct piece *piece) {
    enum { PLACES = 24 };
    double least = piece->thickness;
    for (int k = 0; k <= PLACES; k++) {
        const double part = (double)k / PLACES, sign = piece->is_concave ? -1 : 1;
        narc_point place = {piece->from.x + part * (piece->to.x - piece->from.x),
                            piece->from.y + part * (piece->to.y - piece->from.y)},
                   normal = piece->low;
        if (!piece->is_edge) {
            const double turn = atan2(cross(piece->low, piece->high), dot(piece->low, piece->high)) * part;
            normal = (narc_point){cos(turn) * piece->low.x - sin(turn) * piece->low.y,
                                  sin(turn) * piece->low.x + cos(turn) * piece->low.y};
            place = (narc_point){piece->center.x + sign * piece->radius * normal.x,
                                 piece->center.y + sign * piece->radius * normal.y};
        }
        for (size_t i = 0; i < ground->count; i++)
            least = fmin(least, find_crossing(&ground->pieces[i], place, (narc_point){-normal.x, -normal.y},
                                              1e4 * piece->room, false)
                                    .along);
    }
    return least;
}

/* Of all pieces of a convex stretch the least. */
static void find_thicknesses(struct ground *ground) {
    for (size_t k = 0; k < ground->count; k++)
        ground->pieces[k].thickness = find_thickness(ground, &ground->pieces[k]);
    for (size_t k = 0; k < ground->count; k++)
        for (size_t i = 0; i < ground->count; i++)
            if (ground->pieces[i].run == ground->pieces[k].run && ground->pieces[k].run != GROUND_CONCAVE)
                ground->pieces[k].thickness = fmin(ground->pieces[k].thickness, ground->pieces[i].thickness);
}

struct ground *make_ground(const struct chain *chain) {
    struct ground *ground = walk_pieces(chain);
    find_grains(ground);
    find_thicknesses(ground);
    return ground;
}

/* ------------------------------------------------------------------------------------------------ how far away it is */

/* How far a point is from a piece. */
static double piece_distance(const struct piece *piece, narc_point point) {
    struct ground_foot foot;
    const narc_point from = minus(point, piece->from), to = minus(point, piece->to);
    const double ends = sqrt(fmin(dot(from, from), dot(to, to)));
    return find_foot(piece, point, &foot) ? fmin(fabs(foot.distance), ends) : ends;
}

double ground_outline_distance(const struct ground *ground, narc_point point) {
    double least = INFINITY;
    for (size_t k = 0; k < ground->count; k++)
        least = fmin(least, piece_distance(&ground->pieces[k], point));
    return least;
}

/* How far an edge is from an arc, or 0, where neither ends. */
static double find_edge_gap(const struct piece *edge, const struct piece *arc) {
    const narc_point to = minus(arc->center, edge->from);
    const double foot = dot(to, edge->along), height = cross(edge->along, to), side = height > 0 ? 1 : -1;
    const narc_point away = {side * edge->low.x, side * edge->low.y};
    double least = INFINITY;
    if (foot >= 0 && foot <= edge->length && fabs(height) >= arc->radius && faces(arc, away))
        least = fabs(height) - arc->radius;
    const double half = sqrt(fmax(0, arc->radius * arc->radius - height * height));
    for (int k = -1; k <= 1 && fabs(height) < arc->radius; k += 2) {
        const double place = foot + k * half;
        const narc_point from = {edge->from.x + place * edge->along.x - arc->center.x,
                                 edge->from.y + place * edge->along.y - arc->center.y};
        if (place >= 0 && place <= edge->length && faces(arc, from))
            least = 0;
    }
    return least;
}

/* The same of two arcs. */
static double find_arc_gap(const struct piece *a, const struct piece *b) {
    const narc_point way = minus(b->center, a->center);
    const double apart = length_of(way), inner = fabs(a->radius - b->radius), side = a->radius > b->radius ? 1 : -1;
    const narc_point u = {way.x / apart, way.y / apart};
    if (!(apart > 0))
        return INFINITY; /* the ends are as near */
    if (apart >= a->radius + b->radius)
        return faces(a, u) && faces(b, (narc_point){-u.x, -u.y}) ? apart - a->radius - b->radius : INFINITY;
    if (apart <= inner) {
        const narc_point outwards = {side * u.x, side * u.y};
        return faces(a, outwards) && faces(b, outwards) ? inner - apart : INFINITY;
    }
    const double along = (apart * apart + a->radius * a->radius - b->radius * b->radius) / (2 * apart);
    const double across = sqrt(fmax(0, a->radius * a->radius - along * along));
    for (int k = -1; k <= 1; k += 2) {
        const narc_point from = {along * u.x - k * across * u.y, along * u.y + k * across * u.x};
        if (faces(a, from) && faces(b, minus(from, way)))
            return 0;
    }
    return INFINITY;
}

/* The distance of two pieces, 0 if they cross. */
static double find_piece_gap(const struct piece *a, const struct piece *b) {
    const double at_a = fmin(piece_distance(b, a->from), piece_distance(b, a->to));
    const double ends = fmin(at_a, fmin(piece_distance(a, b->from), piece_distance(a, b->to)));
    if (!a->is_edge && !b->is_edge)
        return fmin(ends, find_arc_gap(a, b));
    if (!a->is_edge || !b->is_edge)
        return fmin(ends, a->is_edge ? find_edge_gap(a, b) : find_edge_gap(b, a));
    const double from = cross(b->along, minus(a->from, b->from)), to = cross(b->along, minus(a->to, b->from));
    const double other = cross(a->along, minus(b->from, a->from)), other_to = cross(a->along, minus(b->to, a->from));
    return from * to <= 0 && other * other_to <= 0 && (from != 0 || to != 0) ? 0 : ends;
}

/* Of two outlines. */
static double find_gap(const struct ground *a, const struct ground *b) {
    double least = INFINITY;
    for (size_t k = 0; k < a->count; k++)
        for (size_t i = 0; i < b->count; i++) {
            const struct piece *p = &a->pieces[k], *q = &b->pieces[i];
            const narc_point away = minus(p->middle, q->middle);
            const double reach = least + p->half + q->half;
            if (dot(away, away) < reach * reach)
                least = fmin(least, find_piece_gap(p, q));
        }
    return least;
}

/* The normals at the open ends of a chain, far into the solid. */
static double find_end_gap(const struct ground *ground, const struct ground *outline, double length) {
    double least = INFINITY;
    for (int end = 0; end < 2 && ground->open; end++) {
        struct piece way = {.is_edge = true, .from = ground->ends[end], .length = length};
        const struct piece *last = &ground->pieces[end ? ground->count - 1 : 0];
        for (size_t k = 1; k < ground->count && !last->is_edge && !(last->radius > 0); k++)
            last += end ? -1 : 1; /* below a corner the edge beside it is nearer */
        const narc_point n = last->is_edge || !end == !last->is_concave ? last->low : last->high;
        way.along = (narc_point){-n.x, -n.y};
        way.low = (narc_point){way.along.y, -way.along.x};
        way.to = (narc_point){way.from.x + length * way.along.x, way.from.y + length * way.along.y};
        for (size_t k = 0; k < outline->count; k++)
            least = fmin(least, find_piece_gap(&way, &outline->pieces[k]));
    }
    return least;
}

struct ground_clearance ground_find_clearance(struct ground *ground, const struct reference_body *body) {
    AUTO(destroy_ground_at) struct ground *outline = walk_body(body);
    const bool is_outside = ground_distance(outline, ground->pieces[0].from).distance > 0;
    struct ground_clearance out = {is_outside ? find_gap(outline, ground) : 0, false};
    const double extent = reference_extent(body);
    out.in_air = out.distance > 0 && ground_distance(ground, outline->pieces[0].from).distance > 0 &&
                 find_end_gap(ground, outline, 8 * (out.distance + extent)) > end_room * extent;
    return out;
}

/* ------------------------------------------------------------------------------------------------ the outline */

struct sample {
    double along, distance;
};

struct ground_search {
    struct ground near; /* the pieces that any point of the body may be next to; behind them there is room for others */
    struct ground *outline; /* the body's */
    double *start;          /* of its pieces, measured along it */
    double perimeter, size, margin, step, part;
    narc_point inner; /* in the body */
    struct sample *samples;
    size_t count, capacity;
};

static narc_point point_at(const struct ground_search *search, double along) {
    along -= search->perimeter * floor(along / search->perimeter);
    size_t k = search->outline->count - 1;
    while (k > 0 && search->start[k] > along)
        k--;
    const struct piece *piece = &search->outline->pieces[k];
    const double t = fmin(along - search->start[k], piece->length);
    if (piece->is_edge)
        return (narc_point){piece->from.x + t * piece->along.x, piece->from.y + t * piece->along.y};
    if (!(piece->length > 0))
        return piece->from;
    const double turn = t / piece->radius, c = cos(turn), s = sin(turn);
    return (narc_point){piece->center.x + piece->radius * (c * piece->low.x - s * piece->low.y),
                        piece->center.y + piece->radius * (s * piece->low.x + c * piece->low.y)};
}

static double distance_at(struct ground_search *search, double along) {
    return ground_distance(&search->near, point_at(search, along)).distance;
}

static void add_sample(struct ground_search *search, double along, double distance) {
    if (search->count == search->capacity) {
        search->capacity = 2 * search->capacity + 256;
        search->samples = realloc(search->samples, search->capacity * sizeof *search->samples);
        assert(search->samples);
    }
    search->samples[search->count++] = (struct sample){along, distance};
}

/* Those pieces, in `out`, that a point within `radius` of `middle` may be next to. Such a one is no further from the
 * middle than the piece next to that, and twice the way between both. */
static struct ground choose_pieces(const struct ground *ground, narc_point middle, double radius, struct piece *out) {
    struct ground chosen = *ground;
    double least = INFINITY;
    chosen.pieces = out;
    chosen.count = chosen.last = 0;
    for (int pass = 0; pass < 2; pass++)
        for (size_t k = 0; k < ground->count; k++) {
            const narc_point away = minus(middle, ground->pieces[k].middle);
            const double limit = pass ? least + 2.001 * radius : least, reach = limit + ground->pieces[k].half;
            if (!(dot(away, away) <= reach * reach))
                continue;
            const double distance = piece_distance(&ground->pieces[k], middle);
            least = fmin(least, distance);
            if (pass && distance <= limit)
                out[chosen.count++] = ground->pieces[k];
        }
    return chosen;
}

/* Samples from `from` up to but without `to`, of which pieces of `above` are next to all: a step apart, less beside small
 * pieces, but where all is further than the margin. No distance changes by more than the way. Behind `room` is memory. */
static void add_samples(struct ground_search *search, const struct ground *above, struct piece *room, double from,
                        double to) {
    const double along = (from + to) / 2, half = (to - from) / 2;
    const narc_point middle = point_at(search, along);
    struct ground near = choose_pieces(above, middle, half, room);
    const double distance = ground_distance(&near, middle).distance;
    double step = search->step;
    for (size_t k = 0; k < near.count; k++)
        step = fmin(step, near.pieces[k].size * search->part);
    assert(room + near.count <= search->near.pieces + DEPTH * search->near.count);
    if (2 * half <= step) {
        add_sample(search, from, ground_distance(&near, point_at(search, from)).distance);
        add_sample(search, along, distance);
    } else if (isfinite(distance) && distance - half > search->margin) {
        add_sample(search, along, distance);
    } else {
        add_samples(search, &near, room + near.count, from, along);
        add_samples(search, &near, room + near.count, along, to);
    }
}

struct ground_search *search_ground(const struct ground *ground, const struct reference_body *body, double margin,
                                    double step, double part) {
    struct ground_search *search = calloc(1, sizeof *search);
    narc_circle inner = {0, 0, 0}, around = {0, 0, 0};
    narc_compute_inscribed_circle(body->arcs, body->count, &inner);
    narc_compute_bounding_circle(body->arcs, body->count, &around);
    const double c = body->cosine * body->scale, s = body->sine * body->scale;
    search->inner = (narc_point){body->x + c * inner.x - s * inner.y, body->y + s * inner.x + c * inner.y};
    const narc_point middle = {body->x + c * around.x - s * around.y, body->y + s * around.x + c * around.y};
    search->size = around.radius * hypot(c, s);
    search->margin = margin;
    search->step = step;
    search->part = part;
    search->outline = walk_body(body);
    search->start = malloc(search->outline->count * sizeof *search->start);
    for (size_t k = 0; k < search->outline->count; k++) {
        search->start[k] = search->perimeter;
        search->perimeter += search->outline->pieces[k].length;
    }
    struct piece *near = malloc((ground->count + 1) * sizeof *near);
    search->near = choose_pieces(ground, middle, search->size, near);
    search->near.pieces = malloc(DEPTH * (search->near.count + 1) * sizeof *near);
    memcpy(search->near.pieces, near, search->near.count * sizeof *near);
    free(near);
    for (size_t k = 0; k < search->outline->count; k++)
        if (search->outline->pieces[k].length > 0)
            add_samples(search, &search->near, search->near.pieces + search->near.count, search->start[k],
                        search->start[k] + search->outline->pieces[k].length);
    return search;
}

void destroy_search(struct ground_search *search) {
    destroy_ground(search->outline);
    free(search->start);
    free(search->near.pieces);
    free(search->samples);
    free(search);
}

/* ------------------------------------------------------------------------------------------------ minima */

/* A place's sample, counted beyond the last one: around the outline. */
static struct sample sample_at(const struct ground_search *search, size_t k) {
    struct sample sample = search->samples[k % search->count];
    sample.along += (double)(k / search->count) * search->perimeter;
    return sample;
}

/* Golden-section search between two samples beside a least one. */
static double descend(struct ground_search *search, double low, double high) {
    const double ratio = 0.618033988749894848;
    double left = high - ratio * (high - low), right = low + ratio * (high - low);
    double at_left = distance_at(search, left), at_right = distance_at(search, right);
    while (high - low > 1e-12 * search->perimeter) {
        if (at_left < at_right) {
            high = right;
            right = left;
            at_right = at_left;
            left = high - ratio * (high - low);
            at_left = distance_at(search, left);
        } else {
            low = left;
            left = right;
            at_left = at_right;
            right = low + ratio * (high - low);
            at_right = distance_at(search, right);
        }
    }
    return (low + high) / 2;
}

/* Is another piece as near, with another normal, so that the distance has no gradient, or an open end? */
static bool is_doubtful(struct ground_search *search, const struct ground_minimum *minimum) {
    const struct ground_foot *nearest = &minimum->foot;
    const double tolerance = doubt * search->size, distance = fabs(nearest->distance);
    struct ground_foot foot;
    if (end_distance(&search->near, minimum->at) < distance + tolerance)
        return true;
    for (size_t k = 0; k < search->near.count && nearest->distance < 0; k++)
        if (find_foot(&search->near.pieces[k], minimum->at, &foot) && fabs(foot.distance) < distance + tolerance &&
            hypot(foot.normal_x - nearest->normal_x, foot.normal_y - nearest->normal_y) > doubt)
            return true;
    return false;
}

/* The refined minimum beside sample k, if it is one over the body: going inwards, the distance rises. */
static bool refine(struct ground_search *search, size_t k, struct ground_minimum *out) {
    const struct sample before = sample_at(search, k + search->count - 1),
                        after = sample_at(search, k + search->count + 1);
    const struct sample here = sample_at(search, k + search->count);
    double along = descend(search, before.along, after.along);
    if (!(distance_at(search, along) < here.distance))
        along = here.along;
    along -= search->perimeter * floor(along / search->perimeter);
    *out = (struct ground_minimum){.at = point_at(search, along), .along = along, .depth = INFINITY};
    out->foot = ground_distance(&search->near, out->at);
    const narc_point inwards = minus(search->inner, out->at);
    return isfinite(out->foot.distance) && out->foot.distance < search->margin &&
           out->foot.normal_x * inwards.x + out->foot.normal_y * inwards.y > 0;
}

/* The highest sample between two places, going counter-clockwise. */
static double highest_between(struct ground_search *search, double from, double to) {
    double highest = fmax(distance_at(search, from), distance_at(search, to));
    to += to < from ? search->perimeter : 0;
    for (size_t k = 0; k < 2 * search->count; k++) {
        const struct sample sample = sample_at(search, k);
        if (sample.along > from && sample.along < to)
            highest = fmax(highest, sample.distance);
    }
    return highest;
}

double ground_barrier(struct ground_search *search, double from, double to) {
    return fmin(highest_between(search, from, to), highest_between(search, to, from));
}

double ground_least(struct ground_search *search, double along, double reach) {
    enum { STEPS = 64 };
    double least = INFINITY;
    for (int k = -STEPS; k <= STEPS; k++)
        least = fmin(least, distance_at(search, along + reach * k / STEPS));
    return least;
}

/* Merges neighbours that nothing separates, and measures what separates the others. */
static size_t merge_minima(struct ground_search *search, double noise, struct ground_minimum *minima, size_t count) {
    for (size_t k = 0; count > 1 && k < count;) {
        const size_t next = (k + 1) % count;
        const double wall = highest_between(search, minima[k].along, minima[next].along);
        struct ground_minimum *higher =
            minima[k].foot.distance > minima[next].foot.distance ? &minima[k] : &minima[next];
        const double rise = wall - higher->foot.distance;
        if (rise <= noise) {
            for (size_t i = (size_t)(higher - minima); i + 1 < count; i++)
                minima[i] = minima[i + 1];
            count--;
            k = 0; /* what is left may have other neighbours */
            continue;
        }
        higher->depth = fmin(higher->depth, rise);
        k++;
    }
    return count;
}

size_t ground_minima(struct ground_search *search, double noise, struct ground_minimum *out) {
    size_t count = 0;
    for (size_t k = 0; k < search->count; k++) {
        const double here = sample_at(search, k).distance;
        const double before = sample_at(search, k + search->count - 1).distance,
                     after = sample_at(search, k + 1).distance;
        if (here < search->margin + search->step && here <= before && here < after && count < GROUND_MINIMA)
            count += refine(search, k, &out[count]);
    }
    count = merge_minima(search, noise, out, count);
    for (size_t k = 0; k < count; k++)
        out[k].doubtful = is_doubtful(search, &out[k]);
    return count;
}

double ground_project(const struct ground_search *search, narc_point point, double *out_distance) {
    double best = 0;
    *out_distance = INFINITY;
    for (size_t k = 0; k < search->outline->count; k++) {
        const struct piece *piece = &search->outline->pieces[k];
        const narc_point from = minus(point, piece->is_edge ? piece->from : piece->center);
        double t = dot(from, piece->along);
        if (!piece->is_edge && piece->length > 0) {
            const double half = piece->length / piece->radius / 2,
                         turn = atan2(cross(piece->low, from), dot(piece->low, from));
            t = piece->length / 2 + remainder(turn - half, 2 * PI) * piece->radius;
        }
        t = search->start[k] + fmin(fmax(t, 0), piece->length);
        const double distance = length_of(minus(point_at(search, t), point));
        best = distance < *out_distance ? t : best;
        *out_distance = fmin(*out_distance, distance);
    }
    return best;
}
