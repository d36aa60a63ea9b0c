/* SPDX-License-Identifier: MIT
 *
 * formula.c - the separation as the largest gap over all candidates: O(m n), no library: docs/algorithm.md, section 4.
 */
#include "formula.h"

#include <math.h>
#include <stdbool.h>

static const double full_turn = 6.283185307179586, seam = 1e-12; /* so that no direction falls between two arcs */

static arc place(arc a, pose p) {
    const double c = p.scale * cos(p.angle), s = p.scale * sin(p.angle);
    const vector center = {p.position.x + c * a.center.x - s * a.center.y,
                           p.position.y + s * a.center.x + c * a.center.y};
    return (arc){center, p.scale * a.radius, a.start + p.angle, a.end + p.angle};
}

static bool holds(arc a, vector n) { /* is n an outward normal of the arc? */
    const double sweep = a.end - a.start, past = fmod(atan2(n.y, n.x) - a.start + seam, full_turn);
    return (past < 0 ? past + full_turn : past) <= (sweep > 0 ? sweep : sweep + full_turn) + 2 * seam;
}

double formula_separation(shape a, pose pose_a, shape b, pose pose_b) {
    double separation = -INFINITY;
    for (int i = 0; i < a.count; i++)
        for (int j = 0; j < b.count; j++) {
            const arc p = place(a.arcs[i], pose_a), q = place(b.arcs[j], pose_b);
            const vector u = {q.center.x - p.center.x, q.center.y - p.center.y};
            const double length = hypot(u.x, u.y); /* where it is 0, the first candidate is NaN and not held */
            const vector candidates[] = {{u.x / length, u.y / length},    /* arc against arc */
                                         {cos(p.start), sin(p.start)},    /* the edge before arc i of A */
                                         {-cos(q.start), -sin(q.start)}}; /* the edge before arc j of B */
            for (int k = 0; k < 3; k++) {
                const vector n = candidates[k], back = {-n.x, -n.y};
                if (holds(p, n) && holds(q, back))
                    separation = fmax(separation, u.x * n.x + u.y * n.y - (p.radius + q.radius));
            }
        }
    return separation;
}
