/* SPDX-License-Identifier: MIT
 *
 * flush.h - bounding polygons whose sides lie on sides of the hull. Internal.
 */
#ifndef NARC_FIT_FLUSH_H
#define NARC_FIT_FLUSH_H

#include "outline/hull.h"

/* Normals (angles, rising) of a bounding polygon of least area with at most `count` sides, all of them flush with sides
 * of the hull (after the hull was thinned out to some dozens of sides, where it has more). All but one of the sides of
 * the least-area bounding polygon are flush (DePano 1987), so it is near. Returns how many sides it has, fewer than
 * `count` if the hull has fewer; 0 if there is none (no triangle has its sides on a square's), or no memory, which sets
 * `no_memory`. */
size_t narc_find_flush_polygon(const narc_hull *hull, size_t count, double *out_angles, bool *no_memory);

#endif
