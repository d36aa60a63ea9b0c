/* SPDX-License-Identifier: MIT
 *
 * measures.h - what a fit must tell of itself, in double precision, the slow obvious way.
 */
#ifndef NARC_TEST_MEASURES_H
#define NARC_TEST_MEASURES_H

#include <stddef.h>

#include "narc_fit.h"

/* A convex polygon, counter-clockwise; free `corners`. */
struct reference_hull {
    narc_point *corners;
    size_t count;
    double area, perimeter;
    double radius; /* the largest distance of a corner from the mean of all */
};

/* The hull of points less `origin`: going round, always to the point that has none to the right. */
struct reference_hull reference_wrap(const narc_point *points, size_t count, narc_point origin);

/* How far shapes reach in the direction of an angle: the largest of all their points. */
double reference_hull_support(const struct reference_hull *hull, double angle);
double reference_arcs_support(const narc_arc *arcs, size_t count, double angle);

/* The least and the largest of (support function of the arcs - that of the hull), sought over directions that hold all
 * normals of edges and junctions and many between, and refined between them. */
struct reference_range {
    double least, largest;
};
struct reference_range reference_compare(const narc_arc *arcs, size_t count, const struct reference_hull *hull);

/* By polygons with corners on the arcs, and Richardson's extrapolation. */
double reference_area(const narc_arc *arcs, size_t count);
double reference_perimeter(const narc_arc *arcs, size_t count);

/* Mean over the outline of the distance to the hull's outline, by some ten thousand points. */
double reference_mean_distance(const narc_arc *arcs, size_t count, const struct reference_hull *hull);

/* Area of the symmetric difference, by `rays` strips from the hull's mean outwards. */
double reference_difference(const narc_arc *arcs, size_t count, const struct reference_hull *hull, size_t rays);

/* The number of straight edges longer than `length`. */
size_t reference_count_edges(const narc_arc *arcs, size_t count, double length);

/* Radius of the smallest circle around points: of all circles through two or three corners of their hull, the smallest
 * that holds the others. */
double reference_smallest_circle(const narc_point *points, size_t count);

#endif
