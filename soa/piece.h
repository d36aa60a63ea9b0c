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
    if ((header->first_arc & NARC_PIECE_MARKS) != NARC_PIECE_RUN || (arc >= 1 && arc + 6 <= count))
        return NARC_FRONT_ARC;
    return arc == 0 || arc + 5 == count ? NARC_FRONT_POINT : NARC_FRONT_NONE;
}

/* How far an arc reaches along a vector from its centre, with this radius. */
static inline double narc_find_arc_height(const narc_stored_arc *a, double radius, double x, double y) {
    const double u_x = (double)a->start_x, u_y = (double)a->start_y, v_x = (double)a->end_x, v_y = (double)a->end_y;
    const double side = radius < 0 ? -1 : 1; /* the point furthest along n has the normal -n on a concave arc */
    const double start = radius * (u_x * x + u_y * y), end = radius * (v_x * x + v_y * y);
    const int holds = side * (u_x * y - u_y * x) >= 0 && side * (x * v_y - y * v_x) >= 0;
    return holds ? fabs(radius) : start > end ? start : end;
}

/* How far a shape, of a run its front, and all within `depth` behind that against its normals, reaches from its origin
 * along a unit vector, and the largest sum of the absolute numbers of an arc, to which its rounding is in proportion. With
 * doubles that are rounded once each, so that all instruction sets agree; so is what follows. */
static inline double narc_find_front_height(const narc_shape_header *header, const narc_record *arcs, double x,
                                            double y, double depth, double *out_size) {
    double best = -INFINITY, size = 0;
    for (size_t k = 0; k < header->count; k++) {
        const narc_stored_arc *a = &arcs[k].arc;
        const double radius = (double)a->radius, c_x = (double)a->center_x, c_y = (double)a->center_y;
        const double along = c_x * x + c_y * y + narc_find_arc_height(a, radius, x, y);
        const double own = fabs(c_x) + fabs(c_y) + fabs(radius) + depth;
        if (narc_find_front(header, k) == NARC_FRONT_NONE)
            continue;
        best = along > best ? along : best;
        size = own > size ? own : size;
        if (depth > 0) {
            const double behind = c_x * x + c_y * y + narc_find_arc_height(a, radius - depth, x, y);
            best = behind > best ? behind : best;
        }
    }
    *out_size = size;
    return best;
}

/* Of a piece: how deep behind its front contacts are told. */
static inline double narc_find_front_depth(const narc_shape_header *header, const narc_record *arcs) {
    return (double)arcs[header->count].solid.depth;
}

/* ------------------------------------------------------------------------------------------------ what reaches them
 *
 * A contact of a body with a piece says, where it is d deep, that the body is free of the piece's front when it has
 * gone as far along the normal n. Let q be the foot on the front, and p = q - d n the body's deepest place. The contact is
 * true if d is at most the body's width along n and p lies in the solid, or the body meets the front:
 *   - The solid goes on behind all of the front for d. Beyond twice the inscribed radius the body may be past it, all in
 *     the air behind a leaning side.
 *   - Or p, of the body's deepest places along the stretch that the front spans, lies no further from one of its ends
 *     than all that is not the surface there. So does what leans into the next piece by a tip.
 *   - Or the body has a place of the front in it.
 * The width has a 1024th of the body's bounding radius as room, which is far more than rounding where ground is as large
 * as bodies are, and lets rods lie. */

/* One of two bodies: its shape and scale, and in its own axes the contact's normal, either way round, and the way to
 * the other's position. */
typedef struct narc_contact_side {
    const narc_shape_header *header;
    const narc_record *arcs;
    double scale, x, y, other_x, other_y;
} narc_contact_side;

/* Is a contact of a body with a piece, which has this thickness, so shallow that it is true? */
static inline bool narc_is_shallow(const narc_shape_header *body, double scale, double thickness, double separation) {
    return -separation <= 2 * scale * (double)body->inner_radius && -separation <= thickness;
}

/* Of two bodies, one of them a piece: is a contact with this separation one that reaches the piece? `front_only`: and no
 * deeper than the middle of the body. */
bool narc_is_reached(const narc_contact_side *a, const narc_contact_side *b, double separation, bool front_only);

/* How far the points and centres of a body may move against a piece before there may be a contact below the margin. What is
 * not above 0 says nothing; so of two pieces, or of none. `x`, `y`: of both the same direction, whichever it is. `size`:
 * the distance of the positions and both extents. Centres lie within the extent, too, if perhaps not within the outline. */
double narc_find_free_way(const narc_contact_side *piece, const narc_contact_side *body, double margin, double size);

#endif
