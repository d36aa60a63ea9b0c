/* SPDX-License-Identifier: MIT
 *
 * piece.h - how far pieces of chains reach: the front of a run, a concave arc. Internal.
 */
#ifndef NARC_PIECE_H
#define NARC_PIECE_H

#include <math.h>

#include "store.h"

/* What touches of a stored arc of a piece: all of it, its point alone (a corner where a run ends), or nothing. */
enum narc_front { NARC_FRONT_NONE, NARC_FRONT_POINT, NARC_FRONT_ARC };

static inline enum narc_front narc_find_front(const narc_shape_header *header, size_t stored) {
    const size_t count = header->count, arc = (stored + (header->first_arc & NARC_FIRST_ARC)) % count;
    if (header->first_arc & NARC_PIECE_CONCAVE || (arc >= 1 && arc + 6 <= count))
        return NARC_FRONT_ARC;
    return arc == 0 || arc + 5 == count ? NARC_FRONT_POINT : NARC_FRONT_NONE;
}

/* How far a piece reaches from its origin along a unit vector, and the largest sum of the absolute numbers of an arc, to
 * which its rounding is in proportion. With doubles that are rounded once each, so that all instruction sets agree. */
static inline double narc_find_piece_height(const narc_shape_header *header, const narc_record *arcs, double x,
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

#endif
