/* SPDX-License-Identifier: MIT
 *
 * vec.h - vectors of the plane. A rotation is a unit vector, too: cosine and sine.
 */
#ifndef NARC_APPS_VEC_H
#define NARC_APPS_VEC_H

typedef struct vec {
    double x, y;
} vec;

static inline vec plus(vec a, vec b) { return (vec){a.x + b.x, a.y + b.y}; }
static inline vec minus(vec a, vec b) { return (vec){a.x - b.x, a.y - b.y}; }
static inline vec times(double s, vec a) { return (vec){s * a.x, s * a.y}; }
static inline double dot(vec a, vec b) { return a.x * b.x + a.y * b.y; }
static inline double cross(vec a, vec b) { return a.x * b.y - a.y * b.x; }
static inline vec rotate(vec by, vec a) { return (vec){by.x * a.x - by.y * a.y, by.y * a.x + by.x * a.y}; }

#endif
