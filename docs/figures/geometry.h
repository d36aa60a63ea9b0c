/* SPDX-License-Identifier: MIT
 *
 * geometry.h - what the figures of the algorithm show, in double precision: placed shapes, the gap, both normal fans.
 */
#ifndef NARC_FIGURES_GEOMETRY_H
#define NARC_FIGURES_GEOMETRY_H

#include "narc_shapes.h"

typedef struct outline {
    narc_arc arc[2 * NARC_MAX_ARCS];
    size_t count;
} outline;

/* An n-arc near a polygon, a polygon with its corners rounded, and a list of arcs; all end the program on error. */
outline outline_near(const narc_point *points, size_t count);
outline outline_of_polygon(const narc_point *points, size_t count, double radius);

outline place_outline(outline shape, double x, double y, double angle);

/* An angle between 0 and a full turn. */
double wrap_angle(double angle);

/* The arc that holds the normal at an angle: the one whose start was passed last. */
size_t arc_at(const outline *shape, double angle);

/* g at the direction with this angle, and the largest. */
double gap_at(const outline *a, const outline *b, double angle);

/* An interval of the normal fan of A and the negated one of B, laid over each other: normals from start to end, arc i of
 * A and arc j of B, the vector between their centres and the sum of their radii. */
typedef struct interval {
    double start, end;
    size_t i, j;
    double u_x, u_y, radii;
} interval;

/* m + n intervals counter-clockwise, the first one starts at the smallest angle. */
size_t overlay_fans(const outline *a, const outline *b, interval *out);

/* A local maximum of the gap: at a junction or along u. */
typedef struct maximum {
    double angle, value;
    size_t interval;
    bool kink;
} maximum;

size_t find_maxima(const interval *intervals, size_t count, maximum *out);
maximum find_highest(const maximum *maxima, size_t count);

/* The largest circle in a shape that touches its outline from inside at the point with this normal. */
double find_inner_radius(const outline *shape, double angle);

/* All differences between a point of A and a point of B. */
outline subtract_outlines(const outline *a, const outline *b);

#endif
