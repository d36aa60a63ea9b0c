/* SPDX-License-Identifier: MIT
 *
 * measures.h - what a fit must tell of itself, in long double, the slow obvious way: it shares nothing with the library.
 */
#ifndef NARC_TEST_MEASURES_H
#define NARC_TEST_MEASURES_H

#include <stddef.h>

#include "narc_fit.h"

typedef long double real;

typedef struct real_point {
    real x, y;
} real_point;

/* A convex polygon, counter-clockwise; free `corners`. */
struct reference_hull {
    real_point *corners;
    size_t count;
    real area, perimeter;
    real radius; /* the largest distance of a corner from the mean of all */
};

/* The hull of points less `origin`. */
struct reference_hull reference_wrap(const narc_point *points, size_t count, narc_point origin);

/* How far shapes reach in the direction of an angle: the largest of all their points. */
real reference_hull_support(const struct reference_hull *hull, real angle);
real reference_arcs_support(const narc_arc *arcs, size_t count, real angle);

/* The least and the largest of (support function of the arcs - that of the hull), sought over directions that hold all
 * normals of edges and junctions and many between, and refined between them. */
struct reference_range {
    real least, largest;
};
struct reference_range reference_compare(const narc_arc *arcs, size_t count, const struct reference_hull *hull);

/* Of arcs and the lines between them. */
real reference_area(const narc_arc *arcs, size_t count);
real reference_perimeter(const narc_arc *arcs, size_t count);

/* Mean over the outline of the distance to the hull's outline, by some ten thousand points. */
real reference_mean_distance(const narc_arc *arcs, size_t count, const struct reference_hull *hull);

/* Area of the symmetric difference, by `rays` strips from the hull's mean outwards. */
real reference_difference(const narc_arc *arcs, size_t count, const struct reference_hull *hull, size_t rays);

/* The number of straight edges longer than `length`. */
size_t reference_count_edges(const narc_arc *arcs, size_t count, double length);

/* Radius of the smallest circle around points: of all circles through two or three corners of their hull, the smallest
 * that holds the others. */
double reference_smallest_circle(const narc_point *points, size_t count);

#endif
