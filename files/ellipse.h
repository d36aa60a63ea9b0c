/* SPDX-License-Identifier: MIT
 *
 * ellipse.h - parts of ellipses as arcs of circles and cubic curves. Internal.
 */
#ifndef NARC_ELLIPSE_H
#define NARC_ELLIPSE_H

#include <math.h>
#include <stdbool.h>

#include "elementary.h"
#include "narc_shapes.h"

/* center + cos t u + sin t v */
typedef struct ellipse {
    narc_point center, u, v;
} ellipse;

/* Quarter turns, which t has no digits for, are exact. */
static inline narc_point find_on(const ellipse *e, double t) {
    const double nothing = 4e-16;
    double cosine, sine;
    narc_find_cosine(t, &cosine, &sine);
    cosine = fabs(cosine) < nothing ? 0 : cosine;
    sine = fabs(sine) < nothing ? 0 : sine;
    return (narc_point){e->center.x + cosine * e->u.x + sine * e->v.x, e->center.y + cosine * e->u.y + sine * e->v.y};
}

/* The part from one parameter to another, in equal steps. */
typedef struct ellipse_part {
    ellipse of;
    double from, step, count;
    bool round; /* a circle: steps are arcs, others are cubics */
} ellipse_part;

/* A cubic through a 32nd of half a turn is within 1e-12 of the ellipse; an arc turns by at most half a turn. What differs
 * from a circle by less than 1e-9 of its size is one. */
static inline ellipse_part divide_ellipse(const ellipse *e, double from, double to) {
    const double uu = e->u.x * e->u.x + e->u.y * e->u.y, vv = e->v.x * e->v.x + e->v.y * e->v.y,
                 uv = e->u.x * e->v.x + e->u.y * e->v.y, nothing = 1e-9, half_turn = 3.14159265358979323846;
    const bool round = fabs(uu - vv) <= nothing * (uu + vv) && fabs(uv) <= nothing * (uu + vv);
    const double count = fmax(from != to, ceil(fabs(to - from) / (round ? half_turn : half_turn / 32) - nothing));
    return (ellipse_part){*e, from, (to - from) / fmax(1, count), count, round};
}

/* Where step k ends; a point in the middle of its arc; the control points of its cubic from p to q. */
static inline narc_point end_step(const ellipse_part *part, double k) {
    return find_on(&part->of, part->from + (k + 1) * part->step);
}
static inline narc_point halve_step(const ellipse_part *part, double k) {
    return find_on(&part->of, part->from + (k + 0.5) * part->step);
}
static inline void bend_step(const ellipse_part *part, double k, narc_point p, narc_point q, narc_point *out_controls) {
    const double s = part->from + k * part->step, quarter = part->step / 4,
                 reach = 4 * narc_sin(quarter) / narc_cos(quarter) / 3;
    const ellipse *e = &part->of, leave = {p, {reach * e->v.x, reach * e->v.y}, {-reach * e->u.x, -reach * e->u.y}},
                  arrive = {q, {-leave.u.x, -leave.u.y}, {-leave.v.x, -leave.v.y}};
    out_controls[0] = find_on(&leave, s);
    out_controls[1] = find_on(&arrive, s + part->step);
}

#endif
