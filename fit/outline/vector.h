/* SPDX-License-Identifier: MIT
 *
 * vector.h - the few vector operations of the fits. Internal.
 */
#ifndef NARC_FIT_VECTOR_H
#define NARC_FIT_VECTOR_H

#include <math.h>

#include "elementary.h"
#include "narc_shapes.h"

#define PI 3.14159265358979323846

static inline narc_point plus(narc_point a, narc_point b) { return (narc_point){a.x + b.x, a.y + b.y}; }
static inline narc_point minus(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }
static inline narc_point along(narc_point a, double t, narc_point b) {
    return (narc_point){a.x + t * b.x, a.y + t * b.y};
}
static inline double dot(narc_point a, narc_point b) { return a.x * b.x + a.y * b.y; }
static inline double cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }
static inline double length(narc_point a) { return narc_hypot(a.x, a.y); }
static inline narc_point unit_at(double angle) {
    narc_point unit;
    narc_find_cosine(angle, &unit.x, &unit.y);
    return unit;
}
static inline double tangent(double angle) { return narc_sin(angle) / narc_cos(angle); }

/* A quarter turn counter-clockwise: from an outward normal to the direction in which the outline runs there. */
static inline narc_point turned(narc_point a) { return (narc_point){-a.y, a.x}; }

#endif
