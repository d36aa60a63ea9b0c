/* SPDX-License-Identifier: MIT
 *
 * paper.h - the paper's own way from a polygon to an n-arc that bounds. Internal.
 */
#ifndef NARC_FIT_PAPER_H
#define NARC_FIT_PAPER_H

#include "outline/hull.h"

/* Algorithm 1 of "Using Piecewise Circular Curves as a 2D Collision Primitive" (in the corrected form of
 * narc_adjust_polygon()) on a polygon, whose sharpest corners are cut off until it has `count`; of even counts the free
 * radius is tried at many values; each n-arc is scaled about its centroid until it bounds the hull, and the one with
 * the least area is taken. Errors: those of narc_adjust_polygon() and narc_build_points(), if no radius gives an
 * n-arc. */
narc_status narc_follow_paper(const narc_point *polygon, size_t sides, size_t count, const narc_hull *hull,
                              narc_arc *out_arcs, size_t *out_count, narc_error *error);

#endif
