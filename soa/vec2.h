/* SPDX-License-Identifier: MIT
 *
 * vec2.h - two coordinates in double precision (narc_point): sums and products. In float lanes: kernels/base/vec2.inl.
 */
#ifndef NARC_VEC2_H
#define NARC_VEC2_H

#include "narc_shapes.h"

static inline narc_point narc_subtract(narc_point a, narc_point b) { return (narc_point){a.x - b.x, a.y - b.y}; }

/* a + length * d */
static inline narc_point narc_add_scaled(narc_point a, double length, narc_point d) {
    return (narc_point){a.x + length * d.x, a.y + length * d.y};
}

static inline double narc_dot(narc_point a, narc_point b) { return a.x * b.x + a.y * b.y; }

/* Above 0: b lies to the left of a. */
static inline double narc_cross(narc_point a, narc_point b) { return a.x * b.y - a.y * b.x; }

#endif
