/* SPDX-License-Identifier: MIT
 *
 * oracle.h - what can be known of arcs without the library: by sampling and searching, the slow obvious way.
 */
#ifndef NARC_TEST_ORACLE_H
#define NARC_TEST_ORACLE_H

#include "narc_shapes.h"

/* Points of the outline, `per_arc` steps along each arc, both its ends included. */
struct samples {
    narc_point *point;
    size_t count;
    double area_error;   /* the polygon through them lacks at most this much of the area, */
    double length_error; /* of the perimeter, */
    double height_error; /* and of the extent in any direction */
    double defect;       /* how far neighbouring arcs are from meeting: rounding, of the radii above all */
};
struct samples oracle_sample(const narc_arc *arcs, size_t count, size_t per_arc);
void oracle_free(struct samples *samples);

/* Area, centroid and second moment of the polygon through the samples, triangle by triangle. */
narc_mass oracle_mass(const struct samples *samples);
double oracle_perimeter(const struct samples *samples);

/* The largest x * point.x + y * point.y of the samples. */
double oracle_height(const struct samples *samples, double x, double y);

/* The signed distance from a point, the largest over all normals: see ray_reference.h. */
double oracle_distance(const narc_arc *arcs, size_t count, narc_point point);

/* The distance from a point to the furthest point of the arcs. */
double oracle_reach(const narc_arc *arcs, size_t count, narc_point point);

/* The least reach, and the deepest point's distance to the outline, found by searches in x of searches in y. */
double oracle_bounding_radius(const narc_arc *arcs, size_t count);
double oracle_inscribed_radius(const narc_arc *arcs, size_t count);

#endif
