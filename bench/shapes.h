/* SPDX-License-Identifier: MIT
 *
 * shapes.h - the random shapes of the benchmarks, of a radius around 1, and the separation of two bodies in double
 * precision, without the library: what every row is checked against.
 */
#ifndef NARC_BENCH_SHAPES_H
#define NARC_BENCH_SHAPES_H

#include <stdbool.h>

#include "bodies.h"

enum { MAX_EDGES = 16 };

/* An arc covers the outward normals from its start normal to that of the next arc, a turn by less than pi, or half a turn
 * if there are two. A polygon is one of arcs with radius 0: the vertices, each with the normal of the edge before it. */
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

/* What shapes are like. */
enum form {
    FORM_N_ARC,
    FORM_KINDS,       /* circles, boxes, polygons and n-arcs, equally many, in all combinations */
    FORM_BALLS_BOXES, /* both in turn, and of a pile the pairs of one of each */
    FORM_ROUNDED, /* the polygon of the junctions, 0.8 times as large, with an arc of radius 0.2 around each vertex */
    FORM_BOX,     /* sides 1 .. 2.4 long */
    FORM_SQUARE,  /* sides of 1 */
    FORM_DISC,
    FORM_CAPSULE, /* a segment 1 .. 2.4 long with a radius of 0.35 .. 0.6 */
    FORM_POLYGON, /* that of an n-arc's junctions */
};

/* Shape `index` of a set. */
struct outline make_outline(enum form form, size_t edges, size_t index, uint64_t *random);

/* The polygon of an n-arc's junctions; `large`: grown around the origin to the n-arc's area. */
struct outline polygon_of(const struct outline *n_arc, bool large);

struct outline box_with(double x, double y); /* half of the sides */
struct outline circle_with(double radius);

double area_of(const struct outline *outline);

/* No point of the outline is farther from the origin. */
double extent_of(const struct outline *outline);

/* Adds an outline to a store, as a shape of its own. */
void add_outline(narc_shapes *shapes, const struct outline *outline);

#endif
