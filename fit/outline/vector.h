/* SPDX-License-Identifier: MIT
 *
 * vector.h - the few vector operations of the fits. Internal.
 */
#ifndef NARC_FIT_VECTOR_H
#define NARC_FIT_VECTOR_H

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

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

static inline bool is_same(narc_point a, narc_point b) { return a.x == b.x && a.y == b.y; }
static inline narc_point unit(narc_point a) {
    const double size = length(a);
    return (narc_point){a.x / size, a.y / size};
}

/* A quarter turn counter-clockwise: from an outward normal to the direction in which the outline runs there. */
static inline narc_point turned(narc_point a) { return (narc_point){-a.y, a.x}; }

/* The squared distance of a point from the side a-b. */
static inline double side_distance(narc_point p, narc_point a, narc_point b) {
    const narc_point side = minus(b, a), from = minus(p, a);
    const double square = dot(side, side), part = square > 0 ? fmin(1, fmax(0, dot(from, side) / square)) : 0;
    const narc_point away = {from.x - part * side.x, from.y - part * side.y};
    return dot(away, away);
}

static inline int compare_numbers(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

/* By x, then by y: for qsort(). */
static inline int compare_points(const void *left, const void *right) {
    const narc_point *a = (const narc_point *)left, *b = (const narc_point *)right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

/* ---------------------------------------------------------------------------- contours */

/* Contour k begins where the one before it ends. */
static inline size_t begin_of(const size_t *ends, size_t k) { return k ? ends[k - 1] : 0; }

static inline narc_aabb widen_box(narc_aabb box, narc_point p) {
    return (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
}
static inline narc_aabb bound_points(const narc_point *points, size_t count) {
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < count; k++)
        box = widen_box(box, points[k]);
    return box;
}

/* The larger side of a box, and the largest absolute coordinate in it. */
static inline double extent_of(narc_aabb box) { return fmax(box.max_x - box.min_x, box.max_y - box.min_y); }
static inline double largest_in(narc_aabb box) {
    return fmax(fmax(-box.min_x, box.max_x), fmax(-box.min_y, box.max_y));
}

/* Is a point inside a closed contour: by how often a line from it to the right meets it. */
static inline bool is_around(const narc_point *points, size_t count, narc_point p) {
    bool inside = false;
    for (size_t k = 0; k < count; k++) {
        const narc_point a = points[k], b = points[k + 1 < count ? k + 1 : 0];
        if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
            inside = !inside;
    }
    return inside;
}

#endif
