/* SPDX-License-Identifier: MIT
 *
 * polygon.h - from a cloud of points to a convex polygon with a given number of sides.
 */
#ifndef NARC_TOOL_POLYGON_H
#define NARC_TOOL_POLYGON_H

#include "narc_shapes.h"

/* The convex hull of `points`, which get sorted: its corners counter-clockwise into `out_hull` (room for `count` + 1),
 * no three of them in line. Returns their number; fewer than 3 if the points enclose no area. */
size_t compute_hull(narc_point *points, size_t count, narc_point *out_hull);

/* Gives a convex counter-clockwise polygon `wanted` sides, in place (room for the larger of both numbers).
 *   Too many: again and again, the side whose removal adds least area goes; its neighbours are extended until they
 *   meet, so the polygon still bounds what it bounded.
 *   Too few: the sharpest corners are cut off.
 * False if no side can be removed (extending a square's sides cannot make a triangle). */
bool set_side_count(narc_point *polygon, size_t count, size_t wanted);

/* The area a counter-clockwise polygon encloses. */
double polygon_area(const narc_point *points, size_t count);

#endif
