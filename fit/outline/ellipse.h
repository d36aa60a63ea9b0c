/* SPDX-License-Identifier: MIT
 *
 * ellipse.h - parts of ellipses as arcs of circles and cubic curves. Internal.
 */
#ifndef NARC_ELLIPSE_H
#define NARC_ELLIPSE_H

#include "outline/vector.h"

/* center + cos t u + sin t v */
typedef struct ellipse {
    narc_point center, u, v;
} ellipse;

static inline narc_point find_on(const ellipse *e, double t) {
    const narc_point way = unit_at(t);
    return along(along(e->center, way.x, e->u), way.y, e->v);
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
    const double size = dot(e->u, e->u) + dot(e->v, e->v), nothing = 1e-9;
    const bool round =
        fabs(dot(e->u, e->u) - dot(e->v, e->v)) <= nothing * size && fabs(dot(e->u, e->v)) <= nothing * size;
    const double count = fmax(from != to, ceil(fabs(to - from) / (round ? PI : PI / 32) - nothing));
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
    const ellipse slope = {{0, 0}, part->of.v, {-part->of.u.x, -part->of.u.y}};
    const double s = part->from + k * part->step, reach = 4 * tangent(part->step / 4) / 3;
    out_controls[0] = along(p, reach, find_on(&slope, s));
    out_controls[1] = along(q, -reach, find_on(&slope, s + part->step));
}

#endif
