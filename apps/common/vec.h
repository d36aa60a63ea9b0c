/* SPDX-License-Identifier: MIT
 *
 * vec.h - vectors of the plane. A rotation is a unit vector, too: cosine and sine.
 */
#ifndef NARC_APPS_VEC_H
#define NARC_APPS_VEC_H

typedef struct vec {
    double x, y;
} vec;

static inline vec make_vec(double x, double y) {
    const vec v = {x, y};
    return v;
}

static inline vec plus(vec a, vec b) { return make_vec(a.x + b.x, a.y + b.y); }
static inline vec minus(vec a, vec b) { return make_vec(a.x - b.x, a.y - b.y); }
static inline vec times(double s, vec a) { return make_vec(s * a.x, s * a.y); }
static inline double dot(vec a, vec b) { return a.x * b.x + a.y * b.y; }
static inline double cross(vec a, vec b) { return a.x * b.y - a.y * b.x; }
static inline vec rotate(vec by, vec a) { return make_vec(by.x * a.x - by.y * a.y, by.y * a.x + by.x * a.y); }

#endif
