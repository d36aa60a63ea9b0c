/* SPDX-License-Identifier: MIT
 *
 * exact.h - the separation of two bodies in double precision, without the library: what every row is checked against.
 */
#ifndef NARC_BENCH_EXACT_H
#define NARC_BENCH_EXACT_H

#include "scenes.h"

#ifdef __cplusplus
extern "C" {
#endif

enum { MAX_EDGES = 16 };

/* An arc covers the outward normals from its start normal to that of the next arc, a turn by less than pi, or half a turn
 * if there are two. A polygon
 * is one of arcs with radius 0: the vertices, each with the normal of the edge before it. */
struct arc {
    double x, y, radius;
    double start_x, start_y;
};

/* A convex outline around its centroid. One arc alone is a circle, start normal unused. */
struct outline {
    size_t count;
    struct arc arcs[MAX_EDGES + 1]; /* the arc behind the last one is the first */
};

struct vector {
    double x, y;
};

/* The largest gap of two bodies over all directions, and the unit direction from A to B that has it. A body's shape is
 * an index into the outlines. */
double exact_gap(const struct outline *outlines, const struct body *a, const struct body *b, struct vector *out_normal);

#ifdef __cplusplus
}
#endif

#endif
