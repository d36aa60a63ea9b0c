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
        return body->scale * (narc_find_front_height(body->header, body->arcs, body->x, body->y, &size) +
                              narc_find_front_height(body->header, body->arcs, -body->x, -body->y, &size) +
                              WIDTH_ROOM * (double)body->header->bound_radius);
    const double size_a = find_piece_size(a), size_b = find_piece_size(b);
    const double least = size_a < size_b ? size_a : size_b, most = 0.125 * (size_a < size_b ? size_b : size_a);
    return least > most ? least : most;
}

/* What of a piece faces the air, as a body sees it: a convex outline in the body's axes and unit, within the points
 * and, in directions between two, a circle about the last one. Points are both ends and what lies beyond them.
 *   of a concave arc   its sector, and the centre
 *   of a run           its front and what lies before its chord. In directions of the front it has no end: along those a
 *                      contact says how deep it is */
enum { SURFACE_POINTS = 7 };
typedef struct surface {
    double x[SURFACE_POINTS], y[SURFACE_POINTS];
    double radius, from_x, from_y, to_x, to_y;
    double room; /* for rounding */
    int count;
} surface;

#define SURFACE_ROOM 0x1p-16 /* of the piece's size and the body's together */

static surface see_surface(const narc_toucher *piece, const narc_toucher *body) {
    const size_t count = piece->header->count, first = piece->header->first_arc & NARC_FIRST_ARC;
    const bool hollow = narc_is_concave(piece->header);
    const narc_stored_arc *const low = &piece->arcs[hollow ? 0 : (count - first) % count].arc,
                                 *const high = &piece->arcs[hollow ? 0 : (2 * count - 5 - first) % count].arc;
    const narc_beyond *const beyond = &piece->arcs[count].beyond;
    const double from_x = (double)(hollow ? low->start_x : low->end_x),
                 from_y = (double)(hollow ? low->start_y : low->end_y),
                 to_x = (double)(hollow ? low->end_x : high->start_x),
                 to_y = (double)(hollow ? low->end_y : high->start_y);
    const double own = hollow ? (double)low->radius : 0; /* a run ends with corners */
    const double x[SURFACE_POINTS] = {(double)low->center_x + own * from_x,
                                      (double)high->center_x + own * to_x,
                                      (double)beyond->x[0],
                                      (double)beyond->x[1],
                                      (double)beyond->x[2],
                                      (double)beyond->x[3],
                                      (double)low->center_x};
    const double y[SURFACE_POINTS] = {(double)low->center_y + own * from_y,
                                      (double)high->center_y + own * to_y,
                                      (double)beyond->y[0],
                                      (double)beyond->y[1],
                                      (double)beyond->y[2],
                                      (double)beyond->y[3],
                                      (double)low->center_y};
    const double c = piece->x * body->x + piece->y * body->y, s = piece->x * body->y - piece->y * body->x;
    const double part = piece->scale / body->scale, sign = hollow ? -1 : 1;
    surface out = {.radius = hollow ? -part * own : INFINITY,
                   .from_x = sign * (c * from_x - s * from_y),
                   .from_y = sign * (s * from_x + c * from_y),
                   .to_x = sign * (c * to_x - s * to_y),
                   .to_y = sign * (s * to_x + c * to_y),
                   .room = SURFACE_ROOM * (find_piece_size(piece) / body->scale + (double)body->header->bound_radius),
                   .count = hollow ? SURFACE_POINTS : SURFACE_POINTS - 1};
    for (int k = 0; k < SURFACE_POINTS; k++) {
        out.x[k] = body->other_x / body->scale + part * (c * x[k] - s * y[k]);
        out.y[k] = body->other_y / body->scale + part * (s * x[k] + c * y[k]);
    }
    return out;
}

/* Is a direction between the two? They are less than half a turn apart. */
static bool faces(const surface *s, double x, double y) {
    return s->from_x * y - s->from_y * x >= 0 && x * s->to_y - y * s->to_x >= 0 &&
           x * (s->from_x + s->to_x) + y * (s->from_y + s->to_y) > 0;
}

/* Is a direction of length 1, from the body, one along which it is apart, where the body reaches `height`? */
static bool is_apart(const surface *s, double x, double y, double height) {
    const int center = SURFACE_POINTS - 1;
    double best = faces(s, -x, -y) ? s->radius - (s->x[center] * x + s->y[center] * y) : -INFINITY;
    for (int k = 0; k < s->count; k++) {
        const double along = -(s->x[k] * x + s->y[k] * y);
        best = along > best ? along : best;
    }
    return best + s->room < -height;
}

/* Is a body apart from it? Then so along a normal of one of them, or the way from a point to a centre. */
static bool misses(const surface *s, const narc_toucher *body) {
    double size;
    for (int k = 0; k < s->count; k++)
        for (int i = 0; i < s->count; i++) {
            const double x = s->y[i] - s->y[k], y = s->x[k] - s->x[i], length = sqrt(x * x + y * y);
            if (length > 0 && is_apart(s, x / length, y / length,
                                       narc_find_front_height(body->header, body->arcs, x / length, y / length, &size)))
                return true;
        }
    for (size_t k = 0; k < body->header->count; k++) {
        const narc_stored_arc *const a = &body->arcs[k].arc;
        const double c_x = (double)a->center_x, c_y = (double)a->center_y, radius = (double)a->radius;
        const double u_x = (double)a->start_x, u_y = (double)a->start_y, v_x = (double)a->end_x, v_y = (double)a->end_y;
        if (is_apart(s, u_x, u_y, c_x * u_x + c_y * u_y + radius))
            return true;
        for (int i = 0; i < s->count; i++) {
            const double x = s->x[i] - c_x, y = s->y[i] - c_y, length = sqrt(x * x + y * y);
            if (u_x * y - u_y * x >= 0 && x * v_y - y * v_x >= 0 && length > 0 &&
                is_apart(s, x / length, y / length, (c_x * x + c_y * y) / length + radius))
                return true;
        }
    }
    return false;
}

/* Does the middle of a body lie on the air's side, beside the piece? */
static bool lies_before(const surface *s, const narc_toucher *body) {
    const int from = s->radius < INFINITY ? SURFACE_POINTS - 1 : 0;
    const double x = (double)body->header->inner_x - s->x[from], y = (double)body->header->inner_y - s->y[from];
    if (s->radius < INFINITY)
        return x * x + y * y <= s->radius * s->radius && faces(s, x, y);
    const double way_x = s->x[1] - s->x[0], way_y = s->y[1] - s->y[0], along = x * way_x + y * way_y;
    return along >= 0 && along <= way_x * way_x + way_y * way_y && x * way_y - y * way_x >= 0;
}

/* Of two bodies, one of them a piece: do they reach each other's surface? */
bool narc_is_reached(const narc_toucher *a, const narc_toucher *b, double separation) {
    const bool of_a = narc_is_piece(a->header);
    const narc_toucher *const piece = of_a ? a : b, *const body = of_a ? b : a;
    const double depth = -separation;
    if (narc_is_shallow(a->header, a->scale, b->header, b->scale, separation))
        return true;
    if (depth <= 0 || depth > find_reach(a, b))
        return depth <= 0;
    if (narc_is_piece(body->header))
        return true;
    const surface seen = see_surface(piece, body);
    return lies_before(&seen, body) || !misses(&seen, body);
}
