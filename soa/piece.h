/* SPDX-License-Identifier: MIT
 *
 * piece.h - how far pieces of chains reach, the front of a run or a concave arc, and what reaches them. Internal.
 */
#ifndef NARC_PIECE_H
#define NARC_PIECE_H

#include <math.h>
#include <stdbool.h>

#include "store.h"

/* What touches of a stored arc: all of it, its point alone (a corner where a run ends), or nothing. */
enum narc_front { NARC_FRONT_NONE, NARC_FRONT_POINT, NARC_FRONT_ARC };

static inline enum narc_front narc_find_front(const narc_shape_header *header, size_t stored) {
    const size_t count = header->count, arc = (stored + (header->first_arc & NARC_FIRST_ARC)) % count;
    if (!(header->first_arc & NARC_PIECE_RUN) || (arc >= 1 && arc + 6 <= count))
        return NARC_FRONT_ARC;
    return arc == 0 || arc + 5 == count ? NARC_FRONT_POINT : NARC_FRONT_NONE;
}

/* How far a shape, of a run its front, reaches from its origin along a unit vector, and the largest sum of the absolute
 * numbers of an arc, to which its rounding is in proportion. With doubles that are rounded once each, so that all
 * instruction sets agree; so is what follows. */
static inline double narc_find_front_height(const narc_shape_header *header, const narc_record *arcs, double x,
                                            double y, double *out_size) {
    double best = -INFINITY, size = 0;
    for (size_t k = 0; k < header->count; k++) {
        const enum narc_front front = narc_find_front(header, k);
        const narc_stored_arc *a = &arcs[k].arc;
        const double radius = (double)a->radius, c_x = (double)a->center_x, c_y = (double)a->center_y;
        const double u_x = (double)a->start_x, u_y = (double)a->start_y, v_x = (double)a->end_x, v_y = (double)a->end_y;
        const double side = radius < 0 ? -1 : 1; /* the point furthest along n has the normal -n on a concave arc */
        const double start = radius * (u_x * x + u_y * y), end = radius * (v_x * x + v_y * y);
        const int holds = side * (u_x * y - u_y * x) >= 0 && side * (x * v_y - y * v_x) >= 0;
        const double along = c_x * x + c_y * y + (holds ? fabs(radius) : start > end ? start : end);
        const double own = fabs(c_x) + fabs(c_y) + fabs(radius);
        if (front == NARC_FRONT_NONE)
            continue;
        best = along > best ? along : best;
        size = own > size ? own : size;
    }
    *out_size = size;
    return best;
}

/* ------------------------------------------------------------------------------------------------ what reaches them
 *
 * A contact with a piece is one only if the other body reaches the piece's surface: a body that lies behind it by more
 * than its own width along the normal is in the air behind thin ground, or too deep. What rounding may do to both is
 * far less than NARC_WIDTH_ROOM of the width where ground is as large as bodies are; where it is not, a body that is
 * nearly all in the ground may be counted either way. */
#define NARC_WIDTH_ROOM 0x1p-10

/* One of two bodies: its shape and scale, and the contact's normal, either way round, in its own axes. */
typedef struct narc_toucher {
    const narc_shape_header *header;
    const narc_record *arcs;
    double scale, x, y;
} narc_toucher;

/* How large a piece is: of a concave arc its chord, of a run half the way to its first far corner, which is twice what its
 * front reaches from its middle (chain_pieces.c). */
static inline double narc_find_piece_size(const narc_toucher *t) {
    const size_t count = t->header->count, first = t->header->first_arc & NARC_FIRST_ARC;
    const narc_stored_arc *const a = &t->arcs[0].arc;
    if (t->header->first_arc & NARC_PIECE_CONCAVE) {
        const double x = (double)a->end_x - (double)a->start_x, y = (double)a->end_y - (double)a->start_y;
        return t->scale * fabs((double)a->radius) * sqrt(x * x + y * y);
    }
    const narc_stored_arc *const end = &t->arcs[(2 * count - 5 - first) % count].arc,
                                 *const corner = &t->arcs[(2 * count - 4 - first) % count].arc;
    const double x = (double)corner->center_x - (double)end->center_x,
                 y = (double)corner->center_y - (double)end->center_y;
    return t->scale * 0.5 * sqrt(x * x + y * y);
}

static inline double narc_find_width(const narc_toucher *t) {
    double size;
    return t->scale * (narc_find_front_height(t->header, t->arcs, t->x, t->y, &size) +
                       narc_find_front_height(t->header, t->arcs, -t->x, -t->y, &size));
}

/* How deep a contact of two bodies, one of them a piece, may be. How thick the solid behind a piece is, is not known: of
 * two pieces the smaller one counts, or an eighth of the larger one where a tip or the bottom of a valley is smaller. */
static inline double narc_find_reach(const narc_toucher *a, const narc_toucher *b) {
    if (!narc_is_piece(a->header) || !narc_is_piece(b->header))
        return narc_find_width(narc_is_piece(a->header) ? b : a);
    const double size_a = narc_find_piece_size(a), size_b = narc_find_piece_size(b);
    const double least = size_a < size_b ? size_a : size_b, most = 0.125 * (size_a < size_b ? size_b : size_a);
    return least > most ? least : most;
}

/* Of two bodies, one of them a piece: do they reach each other's surface? */
static inline bool narc_is_reached(const narc_toucher *a, const narc_toucher *b, double separation) {
    const narc_toucher *const body = narc_is_piece(a->header) ? b : a;
    const double depth = -separation, inner = 2 * body->scale * (double)body->header->inner_radius;
    return depth <= 0 || (!narc_is_piece(body->header) && depth <= inner) ||
           depth <= (1 + NARC_WIDTH_ROOM) * narc_find_reach(a, b);
}

#endif
