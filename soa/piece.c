/* SPDX-License-Identifier: MIT
 *
 * piece.c - do bodies reach a piece's surface? (piece.h)
 */
#include "piece.h"

#include <math.h>
#include <stdbool.h>

#include "chain.h"
#include "vec2.h"

#define WIDTH_ROOM 0x1p-10

/* How large a piece is: of a concave arc its chord, of a run half the way to its first far corner, which is twice what
 * its front reaches from its middle (chain_pieces.c). */
static double find_piece_size(const narc_contact_side *t) {
    const size_t count = t->header->count, first = t->header->first_arc & NARC_FIRST_ARC;
    const narc_stored_arc *const a = &t->arcs[0].arc;
    if (narc_is_concave(t->header)) {
        const double x = (double)a->end_x - (double)a->start_x, y = (double)a->end_y - (double)a->start_y;
        return t->scale * fabs((double)a->radius) * sqrt(x * x + y * y);
    }
    const narc_stored_arc *const end = &t->arcs[(2 * count - 5 - first) % count].arc,
                                 *const corner = &t->arcs[(2 * count - 4 - first) % count].arc;
    const double x = (double)corner->center_x - (double)end->center_x,
                 y = (double)corner->center_y - (double)end->center_y;
    return t->scale * 0.5 * sqrt(x * x + y * y);
}

/* How deep a contact of two bodies, one of them a piece, may be. How thick the solid behind a piece is, is not known:
 * of two pieces the smaller one counts, or an eighth of the larger one where a tip or the bottom of a valley is
 * smaller. */
static double find_most_depth(const narc_contact_side *a, const narc_contact_side *b) {
    const narc_contact_side *const body = narc_is_piece(a->header) ? b : a;
    double size;
    if (!narc_is_piece(body->header))
        return body->scale * (narc_find_front_height(body->header, body->arcs, body->x, body->y, 0, &size) +
                              narc_find_front_height(body->header, body->arcs, -body->x, -body->y, 0, &size) +
                              WIDTH_ROOM * (double)body->header->bound_radius);
    const double size_a = find_piece_size(a), size_b = find_piece_size(b);
    const double least = size_a < size_b ? size_a : size_b, most = 0.125 * (size_a < size_b ? size_b : size_a);
    return least > most ? least : most;
}

static double get_least(double a, double b) { return a < b ? a : b; }
static double get_most(double a, double b) { return a > b ? a : b; }

/* Is a direction in a sector of at most half a turn? */
static bool holds(narc_point start, narc_point end, narc_point d) {
    return narc_cross(start, d) >= 0 && narc_cross(d, end) >= 0 && narc_dot(start, d) + narc_dot(end, d) >= 0;
}

/* An arc as a body sees it, in the body's axes and unit: its circle, the directions of its ends from the centre,
 * counter-clockwise, and these ends, in the order of the piece's normals. */
typedef struct seen_arc {
    narc_point center, start, end, first, last;
    double radius;
} seen_arc;

static seen_arc see_own(const narc_stored_arc *a) {
    const double radius = (double)a->radius, sign = radius < 0 ? -1 : 1;
    seen_arc out = {.center = {(double)a->center_x, (double)a->center_y}, .radius = sign * radius};
    const narc_point start = {(double)a->start_x, (double)a->start_y}, end = {(double)a->end_x, (double)a->end_y};
    out.start = (narc_point){sign * start.x, sign * start.y};
    out.end = (narc_point){sign * end.x, sign * end.y};
    out.first = narc_add_scaled(out.center, radius, start);
    out.last = narc_add_scaled(out.center, radius, end);
    return out;
}

/* A body beside a piece. `turn`, `part`, `at`: the piece's axes, unit and origin in the body's. */
typedef struct view {
    const narc_contact_side *piece, *body;
    narc_point turn, at;
    double part;
    double room; /* for rounding */
} view;

#define FRONT_ROOM 0x1p-18 /* of the piece's size and the body's together */

static view make_view(const narc_contact_side *piece, const narc_contact_side *body) {
    return (view){piece,
                  body,
                  {piece->x * body->x + piece->y * body->y, piece->x * body->y - piece->y * body->x},
                  {body->other_x / body->scale, body->other_y / body->scale},
                  piece->scale / body->scale,
                  FRONT_ROOM * (find_piece_size(piece) / body->scale + (double)body->header->bound_radius)};
}

static narc_point turn_by(narc_point turn, narc_point d) {
    return (narc_point){turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y};
}

static narc_point see_point(const view *v, narc_point p) {
    return narc_add_scaled(v->at, v->part, turn_by(v->turn, p));
}

/* An arc of the piece, by its number. */
static seen_arc see_arc(const view *v, size_t number) {
    const size_t count = v->piece->header->count, first = v->piece->header->first_arc & NARC_FIRST_ARC;
    const seen_arc own = see_own(&v->piece->arcs[(number + count - first) % count].arc);
    return (seen_arc){see_point(v, own.center), turn_by(v->turn, own.start), turn_by(v->turn, own.end),
                      see_point(v, own.first),  see_point(v, own.last),      v->part * own.radius};
}

/* ------------------------------------------------------------------------------------------------ near an end */

/* Does one of the body's deepest points, along its outward normal w, that lie behind the front, lie near an end? */
static bool lies_near_end(const view *v, narc_point w) {
    const narc_shape_header *const header = v->piece->header;
    const bool concave = narc_is_concave(header);
    const narc_solid *const solid = &v->piece->arcs[header->count].solid;
    const seen_arc first = see_arc(v, 0), last = concave ? first : see_arc(v, header->count - 5u);
    const narc_point along = {-w.y, w.x},
                     end[2] = {concave ? first.first : first.last, concave ? last.last : last.first};
    double size, low = INFINITY, high = -INFINITY;
    const double height = narc_find_front_height(v->body->header, v->body->arcs, w.x, w.y, 0, &size);
    const double flat = height - v->room - 0x1p-20 * size;
    for (size_t k = 0; k < v->body->header->count; k++) {
        const seen_arc arc = see_own(&v->body->arcs[k].arc);
        const narc_point points[3] = {arc.first, arc.last, narc_add_scaled(arc.center, arc.radius, w)};
        for (int i = 0; i < (holds(arc.start, arc.end, w) ? 3 : 2); i++)
            if (narc_dot(points[i], w) >= flat) {
                low = get_least(low, narc_dot(points[i], along));
                high = get_most(high, narc_dot(points[i], along));
            }
    }
    const double at[2] = {narc_dot(end[0], along), narc_dot(end[1], along)};
    const double from = concave ? low : get_most(low, get_least(at[0], at[1])),
                 to = concave ? high : get_least(high, get_most(at[0], at[1]));
    if (from > to + 2 * v->room)
        return false;
    for (int i = 0; i < 2; i++) {
        const double x = get_least(get_most(at[i], from), get_most(from, to)) - at[i], y = height - narc_dot(end[i], w);
        const double clearance = v->part * (double)solid->clearance[i];
        if (x * x + y * y <= clearance * clearance)
            return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------ meeting the front */

static double find_line_square(narc_point c, narc_point p, narc_point q) {
    const narc_point way = narc_subtract(q, p), to = narc_subtract(c, p);
    const double square = narc_dot(way, way), along = narc_dot(to, way);
    const double part = square > 0 ? get_least(get_most(along / square, 0), 1) : 0;
    const narc_point off = narc_add_scaled(to, -part, way);
    return narc_dot(off, off);
}

/* Does the body meet a segment, or a point? If its inscribed circle does; not if its bounding circle does not; else they
 * are apart along a normal of one of them or the way from a centre to an end, or meet. */
static bool meets_line(const view *v, narc_point p, narc_point q) {
    const narc_shape_header *const header = v->body->header;
    const narc_point inner = {(double)header->inner_x, (double)header->inner_y},
                     bound = {(double)header->bound_x, (double)header->bound_y}, way = narc_subtract(q, p);
    const double inner_radius = (double)header->inner_radius, bound_radius = (double)header->bound_radius + v->room;
    double size;
    if (inner_radius > 0 && find_line_square(inner, p, q) <= inner_radius * inner_radius)
        return true;
    if (find_line_square(bound, p, q) > bound_radius * bound_radius)
        return false;
    const double length = sqrt(narc_dot(way, way));
    if (length > 0) {
        const narc_point n = {way.y / length, -way.x / length};
        const double height = narc_dot(p, n);
        if (height > narc_find_front_height(header, v->body->arcs, n.x, n.y, 0, &size) + v->room ||
            -height > narc_find_front_height(header, v->body->arcs, -n.x, -n.y, 0, &size) + v->room)
            return false;
    }
    for (size_t k = 0; k < header->count; k++) {
        const seen_arc a = see_own(&v->body->arcs[k].arc);
        const narc_point to[2] = {narc_subtract(p, a.center), narc_subtract(q, a.center)};
        const double radius = a.radius + v->room;
        if (narc_dot(to[0], a.start) > radius && narc_dot(to[1], a.start) > radius)
            return false;
        for (int i = 0; i < 2; i++) {
            const double away = sqrt(narc_dot(to[i], to[i]));
            if (away > radius && holds(a.start, a.end, to[i]) && narc_dot(to[1 - i], to[i]) > radius * away)
                return false;
        }
    }
    return true;
}

/* Does the outline of the body cross an arc of the front? */
static bool crosses_arc(const view *v, const seen_arc *arc) {
    const narc_shape_header *const header = v->body->header;
    const narc_point center = arc->center;
    const double r = arc->radius;
    for (size_t k = 0; k < header->count; k++) {
        const seen_arc a = see_own(&v->body->arcs[k].arc),
                       b = see_own(&v->body->arcs[k + 1 < header->count ? k + 1 : 0].arc);
        const narc_point way = narc_subtract(a.center, center);
        const double radius = a.radius + v->room, square = narc_dot(way, way), away = sqrt(square);
        if (away > 0 && away <= r + radius && away >= fabs(r - radius)) {
            const double along = (square + r * r - radius * radius) / (2 * away),
                         across = sqrt(get_most(0, r * r - along * along));
            for (int side = -1; side <= 1; side += 2) {
                const narc_point at = {(along * way.x - side * across * way.y) / away,
                                       (along * way.y + side * across * way.x) / away};
                if (holds(arc->start, arc->end, at) && holds(a.start, a.end, narc_subtract(at, way)))
                    return true;
            }
        }
        const narc_point from = narc_subtract(narc_add_scaled(a.last, v->room, a.end), center),
                         edge = narc_subtract(narc_add_scaled(b.first, v->room, a.end),
                                              narc_add_scaled(a.last, v->room, a.end));
        const double length = narc_dot(edge, edge), half = narc_dot(from, edge),
                     root = half * half - length * (narc_dot(from, from) - r * r);
        for (int side = -1; side <= 1 && length > 0 && root >= 0; side += 2) {
            const double part = (-half + side * sqrt(root)) / length;
            if (part >= 0 && part <= 1 && holds(arc->start, arc->end, narc_add_scaled(from, part, edge)))
                return true;
        }
    }
    return false;
}

/* Does the body meet an arc of the front, whose ends it does not meet? */
static bool meets_arc(const view *v, const seen_arc *arc) {
    const narc_shape_header *const header = v->body->header;
    const narc_point inner = narc_subtract((narc_point){(double)header->inner_x, (double)header->inner_y}, arc->center),
                     bound = narc_subtract((narc_point){(double)header->bound_x, (double)header->bound_y}, arc->center);
    const double off = fabs(sqrt(narc_dot(inner, inner)) - arc->radius);
    if (off <= (double)header->inner_radius && holds(arc->start, arc->end, inner))
        return true;
    if (fabs(sqrt(narc_dot(bound, bound)) - arc->radius) > (double)header->bound_radius + v->room)
        return false;
    return crosses_arc(v, arc);
}

static bool meets_front(const view *v) {
    const narc_shape_header *const header = v->piece->header;
    const seen_arc first = see_arc(v, 0);
    if (narc_is_concave(header))
        return meets_line(v, first.first, first.first) || meets_line(v, first.last, first.last) || meets_arc(v, &first);
    narc_point last = first.last;
    for (size_t number = 1; number + 5 <= header->count; number++) {
        const seen_arc arc = see_arc(v, number);
        if (meets_line(v, last, arc.first) || (number + 6 <= header->count && arc.radius > 0 && meets_arc(v, &arc)))
            return true;
        last = arc.last;
    }
    return false;
}

/* Is the middle of a body, `depth` deep along its outward normal w, behind the front? */
static bool is_behind(const narc_contact_side *body, narc_point w, double depth) {
    double size;
    const double height = narc_find_front_height(body->header, body->arcs, w.x, w.y, 0, &size);
    return depth > body->scale * (height - (double)body->header->bound_x * w.x - (double)body->header->bound_y * w.y);
}

bool narc_is_reached(const narc_contact_side *a, const narc_contact_side *b, double separation, bool front_only) {
    const bool of_a = narc_is_piece(a->header);
    const narc_contact_side *const piece = of_a ? a : b, *const body = of_a ? b : a;
    const double depth = -separation, sign = of_a ? -1 : 1; /* normals point from A to B */
    const narc_point w = {sign * body->x, sign * body->y};
    if (depth <= 0)
        return true;
    const double most = find_most_depth(a, b);
    if (depth > most || narc_is_piece(body->header))
        return depth <= most;
    if (front_only && is_behind(body, w, depth))
        return false;
    const double thickness = (double)piece->arcs[piece->header->count].solid.thickness;
    if (narc_is_shallow(body->header, body->scale, piece->scale * thickness, separation))
        return true;
    const view seen = make_view(piece, body);
    if (signbit(thickness)) /* of a line in the air that side tells of a body on which there is less of it */
        return depth <= most / 2 && meets_front(&seen);
    return lies_near_end(&seen, w) || meets_front(&seen);
}

/* ------------------------------------------------------------------------------------------------ the way to a contact
 *
 * While no point of a body, and no centre of an arc, moves by more than d, no gap along a direction changes by more: there is
 * none below the margin where one exceeds that by d.
 *   Nor is there a contact with the front of a run whose end E lies aside of the body's deepest place p (kernels/piece/
 * edges_below.inl). Along a normal the deepest place lies on an arc c, right below its centre: so far as the normal turns from
 * n, at the end, to m beyond it, the gap grows by the turn times how far the centre lies beyond E. That is more than what two
 * gaps are rounded by if it lies NEED beyond. The other normals of the front have smaller gaps where p lies nearer to E along
 * none of them, which the other one of its ends tells. After a move by d only an arc is deepest that is less than 2 d higher
 * now.
 *   Along m another arc may be the deepest one, as where a side is nearly level: the gap is its own then, which is h greater
 * than that along n if it is h higher, and grows by the turn times how far it lies beyond E, or falls so much if it does not.
 * So of an arc that is not NEED beyond h makes up for that: after a move by d h is 2 d less, and it lies by d less beyond. */
#define NEED 0x1.2p-8 /* 2^-18 by the turn of 2^-10, and more: D grows by a sixteenth of the sum */

static double find_way_to_end(const view *v, narc_point end, narc_point n, narc_point other_n, double side,
                              double need) {
    const narc_shape_header *const header = v->body->header;
    const narc_point beyond = {-side * n.y, side * n.x}, down = {-n.x, -n.y}, turn = narc_subtract(n, other_n);
    const double turned = sqrt(narc_dot(turn, turn));
    double size, way = INFINITY;
    const double depth = narc_find_front_height(header, v->body->arcs, down.x, down.y, 0, &size);
    for (size_t k = 0; k < header->count; k++) {
        const seen_arc arc = see_own(&v->body->arcs[k].arc);
        const narc_point place = narc_add_scaled(arc.center, arc.radius, down), from = narc_subtract(place, end);
        const double ends = get_most(narc_dot(arc.first, down), narc_dot(arc.last, down));
        const double height = depth - (holds(arc.start, arc.end, down) ? narc_dot(place, down) : ends);
        const double off = narc_dot(from, beyond) - need,
                     nearer = turned > 0 ? narc_dot(from, turn) / turned : INFINITY;
        const double spare = (height + NARC_END_TURN * get_least(off, 0)) / (2 + NARC_END_TURN);
        way = get_least(way, get_most(get_least(off, nearer), spare * (1 - NARC_END_TURN)));
    }
    return way;
}

/* Between a body and what the piece's arc has along a direction of its sector. */
static double find_gap(const view *v, const seen_arc *arc, narc_point n) {
    double size;
    return -narc_find_front_height(v->body->header, v->body->arcs, -n.x, -n.y, 0, &size) - narc_dot(arc->center, n) -
           arc->radius;
}

static double find_way_to_run(const view *v, double margin, double need) {
    const size_t last_number = v->piece->header->count - 5u;
    const narc_shape_header *const header = v->body->header;
    const narc_point middle = {(double)header->bound_x, (double)header->bound_y};
    const seen_arc first = see_arc(v, 0), last = see_arc(v, last_number);
    double gap = get_most(find_gap(v, &first, first.start), find_gap(v, &last, last.end));
    for (size_t number = 1; number <= last_number; number++) {
        const seen_arc arc = number < last_number ? see_arc(v, number) : last;
        const narc_point up = narc_subtract(middle, arc.center);
        const double length = sqrt(narc_dot(up, up));
        gap = get_most(gap, find_gap(v, &arc, arc.start));
        if (length > 0 && holds(arc.start, arc.end, up))
            gap = get_most(gap, find_gap(v, &arc, (narc_point){up.x / length, up.y / length}));
    }
    return get_most(gap - margin, get_most(find_way_to_end(v, first.last, first.end, last.start, -1, need),
                                           find_way_to_end(v, last.first, last.start, first.end, 1, need)));
}

/* Each arc of a body has a contact with a concave one, if any, where its centre lies in the sector (kernels/piece/concave.inl). */
static double find_way_to_concave(const view *v, double margin) {
    const narc_stored_arc *const a = &v->piece->arcs[0].arc;
    const narc_point center = see_point(v, (narc_point){(double)a->center_x, (double)a->center_y});
    const narc_point start = turn_by(v->turn, (narc_point){(double)a->start_x, (double)a->start_y}),
                     end = turn_by(v->turn, (narc_point){(double)a->end_x, (double)a->end_y});
    const double radius = v->part * fabs((double)a->radius);
    double least = INFINITY;
    for (size_t k = 0; k < v->body->header->count; k++) {
        const narc_stored_arc *const own = &v->body->arcs[k].arc;
        const narc_point back = {center.x - (double)own->center_x, center.y - (double)own->center_y};
        const double gap = radius - sqrt(narc_dot(back, back)) - (double)own->radius;
        const double off = -get_least(narc_cross(start, back), narc_cross(back, end));
        least = get_least(least, get_most(gap - margin, off - FRONT_ROOM * (radius + (double)own->radius)));
    }
    return least;
}

double narc_find_free_way(const narc_contact_side *piece, const narc_contact_side *body, double margin, double size) {
    if (!narc_is_piece(piece->header) || narc_is_piece(body->header))
        return 0;
    const view v = make_view(piece, body);
    const double own = margin / body->scale, need = NEED * size / body->scale;
    const double way = narc_is_concave(piece->header) ? find_way_to_concave(&v, own) : find_way_to_run(&v, own, need);
    return get_least(body->scale * way, size / 16) - 0x1p-17 * size;
}
