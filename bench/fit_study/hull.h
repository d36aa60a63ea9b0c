/* SPDX-License-Identifier: MIT
 *
 * hull.h - an outline's convex hull with what the study asks of it, and a few vector operations.
 */
#ifndef NARC_STUDY_HULL_H
#define NARC_STUDY_HULL_H

#include <math.h>

#include "narc_fit.h"

#define PI 3.14159265358979323846

static inline narc_point minus(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }
static inline narc_point along(narc_point a, double t, narc_point b) {
    return (narc_point){a.x + t * b.x, a.y + t * b.y};
}
static inline double dot(narc_point a, narc_point b) { return a.x * b.x + a.y * b.y; }
static inline double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static inline double length(narc_point a) { return hypot(a.x, a.y); }

/* A convex polygon, counter-clockwise. */
typedef struct hull {
    size_t count;
    narc_point *corners;
    narc_point *normals; /* unit, outward: that of the side from corner k to corner k + 1 */
    double area, perimeter;
} hull;

/* The hull of points, or the end of the program, which calls them by `name`. */
hull make_hull(const char *name, const narc_point *points, size_t count);
void free_hull(hull *of);

#endif
