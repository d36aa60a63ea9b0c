/* SPDX-License-Identifier: MIT
 *
 * outlines.h - random smooth convex outlines, and the n-arc and the n-gon that stand for one.
 */
#ifndef NARC_PAPER_OUTLINES_H
#define NARC_PAPER_OUTLINES_H

#include "arcs.h"

enum { HARMONICS = 3 };

/* An outline by its radius of curvature as a function of the outward normal's angle: 1, and harmonics 2, 3 and 4. (A
 * first harmonic would leave it open.) */
struct smooth {
    double amplitude[HARMONICS], phase[HARMONICS];
};

struct smooth random_smooth(uint64_t *random);

/* The n-arc with these junction normals that follows the outline: each radius is such that the arc's chord is as long,
 * along its own direction, as that of the outline's piece with the same normals, but for the least change (in squares)
 * that closes the list. Its area is the outline's and its centroid the origin. False if a radius is below 0.05. */
bool fit_n_arc(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs);

/* The polygon whose vertices are the outline's points with these normals, enlarged to the outline's area; its centroid
 * is the origin. A vertex is an arc of radius 0. */
void fit_n_gon(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs);

#endif
