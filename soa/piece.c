/* SPDX-License-Identifier: MIT
 *
 * piece.c - do bodies reach a piece's surface? (piece.h)
 */
#include "piece.h"

#include <math.h>
#include <stdbool.h>

#define WIDTH_ROOM 0x1p-10

/* How large a piece is: of a concave arc its chord, of a run half the way to its first far corner, which is twice what
 * its front reaches from its middle (chain_pieces.c). */
static double find_piece_size(const narc_toucher *t) {
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
static double find_reach(const narc_toucher *a, const narc_toucher *b) {
    const narc_toucher *const body = narc_is_piece(a->header) ? b : a;
    double size;
    if (!narc_is_piece(body->header))
        return body->scale * (narc_find_front_height(body->header, body->arcs, body->x, body->y, 0, &size) +
                              narc_find_front_height(body->header, body->arcs, -body->x, -body->y, 0, &size) +
                              WIDTH_ROOM * (double)body->header->bound_radius);
    const double size_a = find_piece_size(a), size_b = find_piece_size(b);
    const double least = size_a < size_b ? size_a : size_b, most = 0.125 * (size_a < size_b ? size_b : size_a);
    return least > most ? least : most;
}

typedef struct spot {
    double x, y;
} spot;

static double cross(spot a, spot b) { return a.x * b.y - a.y * b.x; }
static double dot(spot a, spot b) { return a.x * b.x + a.y * b.y; }
static spot subtract(spot a, spot b) { return (spot){a.x - b.x, a.y - b.y}; }
static spot add(spot a, double length, spot d) { return (spot){a.x + length * d.x, a.y + length * d.y}; }
static double get_least(double a, double b) { return a < b ? a : b; }
static double get_most(double a, double b) { return a > b ? a : b; }

/* Is a direction in a sector of at most half a turn? */
static bool holds(spot start, spot end, spot d) {
    return cross(start, d) >= 0 && cross(d, end) >= 0 && dot(start, d) + dot(end, d) >= 0;
}

/* An arc as a body sees it, in the body's axes and unit: its circle, the directions of its ends from the centre,
 * counter-clockwise, and these ends, in the order of the piece's normals. */
typedef struct seen_arc {
    spot center, start, end, first, last;
    double radius;
} seen_arc;

static seen_arc see_own(const narc_stored_arc *a) {
    const double radius = (double)a->radius, sign = radius < 0 ? -1 : 1;
    seen_arc out = {.center = {(double)a->center_x, (double)a->center_y}, .radius = sign * radius};
    const spot start = {(double)a->start_x, (double)a->start_y}, end = {(double)a->end_x, (double)a->end_y};
    out.start = (spot){sign * start.x, sign * start.y};
    out.end = (spot){sign * end.x, sign * end.y};
    out.first = add(out.center, radius, start);
    out.last = add(out.center, radius, end);
    return out;
}

/* A body beside a piece. `turn`, `part`, `at`: the piece's axes, unit and origin in the body's. */
typedef struct view {
    const narc_toucher *piece, *body;
    spot turn, at;
    double part;
    double room; /* for rounding */
} view;

#define FRONT_ROOM 0x1p-18 /* of the piece's size and the body's together */

static view make_view(const narc_toucher *piece, const narc_toucher *body) {
    return (view){piece,
                  body,
                  {piece->x * body->x + piece->y * body->y, piece->x * body->y - piece->y * body->x},
                  {body->other_x / body->scale, body->other_y / body->scale},
                  piece->scale / body->scale,
                  FRONT_ROOM * (find_piece_size(piece) / body->scale + (double)body->header->bound_radius)};
}

static spot turn_by(spot turn, spot d) { return (spot){turn.x * d.x - turn.y * d.y, turn.y * d.x + turn.x * d.y}; }

static spot see_place(const view *v, spot p) { return add(v->at, v->part, turn_by(v->turn, p)); }

/* An arc of the piece, by its number. */
static seen_arc see_arc(const view *v, size_t number) {
    const size_t count = v->piece->header->count, first = v->piece->header->first_arc & NARC_FIRST_ARC;
    const seen_arc own = see_own(&v->piece->arcs[(number + count - first) % count].arc);
    return (seen_arc){see_place(v, own.center), turn_by(v->turn, own.start), turn_by(v->turn, own.end),
                      see_place(v, own.first),  see_place(v, own.last),      v->part * own.radius};
}

/* ------------------------------------------------------------------------------------------------ near an end */

/* Does one of the body's deepest places, along its outward normal w, that lie behind the front, lie near an end? */
static bool lies_near_end(const view *v, spot w) {
    const narc_shape_header *const header = v->piece->header;
    const bool hollow = narc_is_concave(header);
    const narc_solid *const solid = &v->piece->arcs[header->count].solid;
    const seen_arc first = see_arc(v, 0), last = hollow ? first : see_arc(v, header->count - 5u);
    const spot along = {-w.y, w.x}, end[2] = {hollow ? first.first : first.last, hollow ? last.last : last.first};
    double size, low = INFINITY, high = -INFINITY;
    const double height = narc_find_front_height(v->body->header, v->body->arcs, w.x, w.y, 0, &size);
    const double flat = height - v->room - 0x1p-20 * size;
    for (size_t k = 0; k < v->body->header->count; k++) {
        const seen_arc arc = see_own(&v->body->arcs[k].arc);
        const spot places[3] = {arc.first, arc.last, add(arc.center, arc.radius, w)};
        for (int i = 0; i < (holds(arc.start, arc.end, w) ? 3 : 2); i++)
            if (dot(places[i], w) >= flat) {
                low = get_least(low, dot(places[i], along));
                high = get_most(high, dot(places[i], along));
            }
    }
    const double at[2] = {dot(end[0], along), dot(end[1], along)};
    const double from = hollow ? low : get_most(low, get_least(at[0], at[1])),
                 to = hollow ? high : get_least(high, get_most(at[0], at[1]));
    if (from > to + 2 * v->room)
        return false;
    for (int i = 0; i < 2; i++) {
        const double x = get_least(get_most(at[i], from), get_most(from, to)) - at[i], y = height - dot(end[i], w);
        const double reach = v->part * (double)solid->clearance[i];
        if (x * x + y * y <= reach * reach)
            return true;
    }
    return false;
}

/* ------------------------------------------------------------------------------------------------ meeting the front */

static double find_line_square(spot c, spot p, spot q) {
    const spot way = subtract(q, p), to = subtract(c, p);
    const double square = dot(way, way), along = dot(to, way);
    const double part = square > 0 ? get_least(get_most(along / square, 0), 1) : 0;
    const spot off = add(to, -part, way);
    return dot(off, off);
}

/* Does the body meet a segment, or a point? If its inscribed circle does; not if its bounding circle does not; else they
 * are apart along a normal of one of them or the way from a centre to an end, or meet. */
static bool meets_line(const view *v, spot p, spot q) {
    const narc_shape_header *const header = v->body->header;
    const spot inner = {(double)header->inner_x, (double)header->inner_y},
               bound = {(double)header->bound_x, (double)header->bound_y}, way = subtract(q, p);
    const double inner_radius = (double)header->inner_radius, bound_radius = (double)header->bound_radius + v->room;
    double size;
    if (inner_radius > 0 && find_line_square(inner, p, q) <= inner_radius * inner_radius)
        return true;
    if (find_line_square(bound, p, q) > bound_radius * bound_radius)
        return false;
    const double length = sqrt(dot(way, way));
    if (length > 0) {
        const spot n = {way.y / length, -way.x / length};
        const double height = dot(p, n);
        if (height > narc_find_front_height(header, v->body->arcs, n.x, n.y, 0, &size) + v->room ||
            -height > narc_find_front_height(header, v->body->arcs, -n.x, -n.y, 0, &size) + v->room)
            return false;
    }
    for (size_t k = 0; k < header->count; k++) {
        const seen_arc a = see_own(&v->body->arcs[k].arc);
        const spot to[2] = {subtract(p, a.center), subtract(q, a.center)};
        const double radius = a.radius + v->room;
        if (dot(to[0], a.start) > radius && dot(to[1], a.start) > radius)
            return false;
        for (int i = 0; i < 2; i++) {
            const double away = sqrt(dot(to[i], to[i]));
            if (away > radius && holds(a.start, a.end, to[i]) && dot(to[1 - i], to[i]) > radius * away)
                return false;
        }
    }
    return true;
}

/* Does the outline of the body cross an arc of the front? */
static bool crosses_arc(const view *v, const seen_arc *arc) {
    const narc_shape_header *const header = v->body->header;
    const spot center = arc->center;
    const double r = arc->radius;
    for (size_t k = 0; k < header->count; k++) {
        const seen_arc a = see_own(&v->body->arcs[k].arc),
                       b = see_own(&v->body->arcs[k + 1 < header->count ? k + 1 : 0].arc);
        const spot way = subtract(a.center, center);
        const double radius = a.radius + v->room, square = dot(way, way), away = sqrt(square);
        if (away > 0 && away <= r + radius && away >= fabs(r - radius)) {
            const double along = (square + r * r - radius * radius) / (2 * away),
                         across = sqrt(get_most(0, r * r - along * along));
            for (int side = -1; side <= 1; side += 2) {
                const spot at = {(along * way.x - side * across * way.y) / away,
                                 (along * way.y + side * across * way.x) / away};
                if (holds(arc->start, arc->end, at) && holds(a.start, a.end, subtract(at, way)))
                    return true;
            }
        }
        const spot from = subtract(add(a.last, v->room, a.end), center),
                   edge = subtract(add(b.first, v->room, a.end), add(a.last, v->room, a.end));
        const double length = dot(edge, edge), half = dot(from, edge),
                     root = half * half - length * (dot(from, from) - r * r);
        for (int side = -1; side <= 1 && length > 0 && root >= 0; side += 2) {
            const double part = (-half + side * sqrt(root)) / length;
            if (part >= 0 && part <= 1 && holds(arc->start, arc->end, add(from, part, edge)))
                return true;
        }
    }
    return false;
}

/* Does the body meet an arc of the front, whose ends it does not meet? */
static bool meets_arc(const view *v, const seen_arc *arc) {
    const narc_shape_header *const header = v->body->header;
    const spot inner = subtract((spot){(double)header->inner_x, (double)header->inner_y}, arc->center),
               bound = subtract((spot){(double)header->bound_x, (double)header->bound_y}, arc->center);
    const double off = fabs(sqrt(dot(inner, inner)) - arc->radius);
    if (off <= (double)header->inner_radius && holds(arc->start, arc->end, inner))
        return true;
    if (fabs(sqrt(dot(bound, bound)) - arc->radius) > (double)header->bound_radius + v->room)
        return false;
    return crosses_arc(v, arc);
}

static bool meets_front(const view *v) {
    const narc_shape_header *const header = v->piece->header;
    const seen_arc first = see_arc(v, 0);
    if (narc_is_concave(header))
        return meets_line(v, first.first, first.first) || meets_line(v, first.last, first.last) || meets_arc(v, &first);
    spot last = first.last;
    for (size_t number = 1; number + 5 <= header->count; number++) {
        const seen_arc arc = see_arc(v, number);
        if (meets_line(v, last, arc.first) || (number + 6 <= header->count && arc.radius > 0 && meets_arc(v, &arc)))
            return true;
        last = arc.last;
    }
    return false;
}

/* Is the middle of a body, `depth` deep along its outward normal w, behind the front? */
static bool is_behind(const narc_toucher *body, spot w, double depth) {
    double size;
    const double height = narc_find_front_height(body->header, body->arcs, w.x, w.y, 0, &size);
    return depth > body->scale * (height - (double)body->header->bound_x * w.x - (double)body->header->bound_y * w.y);
}

bool narc_is_reached(const narc_toucher *a, const narc_toucher *b, double separation, bool front_only) {
    const bool of_a = narc_is_piece(a->header);
    const narc_toucher *const piece = of_a ? a : b, *const body = of_a ? b : a;
    const double depth = -separation, sign = of_a ? -1 : 1; /* normals point from A to B */
    const spot w = {sign * body->x, sign * body->y};
    if (depth <= 0)
        return true;
    const double reach = find_reach(a, b);
    if (depth > reach || narc_is_piece(body->header))
        return depth <= reach;
    if (front_only && is_behind(body, w, depth))
        return false;
    const double thickness = (double)piece->arcs[piece->header->count].solid.thickness;
    if (narc_is_shallow(body->header, body->scale, piece->scale * thickness, separation))
        return true;
    const view seen = make_view(piece, body);
    if (signbit(thickness)) /* of a line in the air that side tells of a body on which there is less of it */
        return depth <= reach / 2 && meets_front(&seen);
    return lies_near_end(&seen, w) || meets_front(&seen);
}
