/* SPDX-License-Identifier: MIT
 *
 * hull.h - the convex hull of an outline: a polygon whose support function can be asked. Internal.
 */
#ifndef NARC_FIT_HULL_H
#define NARC_FIT_HULL_H

#include "narc_fit.h"

/* A convex polygon, counter-clockwise, no two corners in one place, no three in line. Corner k is the support point of
 * the directions between the normals of the sides k - 1 and k. */
typedef struct narc_hull {
    size_t count;
    narc_point *corners;
    narc_point *normals; /* unit, outward: normals[k] is that of side k, from corner k to corner k + 1 */
    double *angles;      /* of the normals, rising, in one turn */
    double inflation;    /* the body to be fitted holds all points within this distance of the polygon */
    double area, perimeter;
} narc_hull;

/* The corners of the hull of points that are sorted by compare_points(), Andrew's monotone chain; those that turn by less
 * than `straight`, as the sine of the angle, are left out. `out_corners` has room for count + 1. Returns how many. */
size_t narc_wrap_sorted(const narc_point *sorted, size_t count, double straight, narc_point *out_corners);

/* The hull of `points`. NARC_ERROR_COUNT: no points. NARC_ERROR_NOT_CONVEX: no area. NARC_ERROR_MEMORY. */
narc_status narc_make_hull(const narc_point *points, size_t count, narc_hull *out_hull, narc_error *error);

/* A hull from corners that are convex and counter-clockwise up to rounding, in their order. Those that coincide or lie
 * in line up to rounding are dropped. So every hull has sides with a direction and corners that turn, even after it was
 * moved, turned or scaled. NARC_ERROR_NOT_CONVEX: fewer than three stay. NARC_ERROR_MEMORY. */
narc_status narc_adopt_corners(const narc_point *corners, size_t count, narc_hull *out_hull, narc_error *error);

/* Drops corners that lie within `tolerance` of the segment between two that stay, and adds it to the inflation, so that
 * the body to be fitted still holds all of them. No memory: NARC_ERROR_MEMORY, and the hull is as before. */
narc_status narc_thin_hull(narc_hull *hull, double tolerance, narc_error *error);

void narc_release_hull(narc_hull *hull);

/* The corner that lies furthest in the direction of an angle. */
size_t narc_find_corner(const narc_hull *hull, double angle);

#endif
