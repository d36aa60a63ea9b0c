/* SPDX-License-Identifier: MIT
 *
 * least_distance.c - an n-arc bulges where the hull has a straight side.
 *
 * An n-arc whose radii are at most R rolls freely inside a circle of radius R (Blaschke): around it, and through its
 * foremost point in a direction u, there is such a circle. Let u be the normal of a side of length L, and t the distance.
 * If the n-arc holds the hull, the side is a chord of the circle with a sagitta of at most t: L^2 <= 8 R t. If it need
 * not, that holds of the n-arc moved out by t, which holds the hull and is at most 2 t away: L^2 <= 8 (R + t) 2 t.
 * Radii end at NARC_MAX_RADIUS_RATIO times the radius of a circle around the n-arc, which is at most 1 + t.
 */
#include "model/least_distance.h"

#include <math.h>

#include "outline/vector.h"

/* Arcs of that radius are rounded to single precision, by less than this. */
static const double ROUNDING = NARC_MAX_RADIUS_RATIO * 0x1p-22;

double narc_least_distance(const narc_hull *hull, bool bound) {
    double side = 0;
    for (size_t k = 0; k < hull->count; k++)
        side = fmax(side, length(minus(hull->corners[(k + 1) % hull->count], hull->corners[k])));
    /* The positive root of a t^2 + b t = L^2. */
    const double b = (bound ? 8 : 16) * NARC_MAX_RADIUS_RATIO, a = bound ? b : b + 16;
    const double root = 2 * side * side / (b + sqrt(b * b + 4 * a * side * side));
    return fmax(0, root - ROUNDING);
}
