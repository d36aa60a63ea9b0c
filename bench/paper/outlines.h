/* SPDX-License-Identifier: MIT
 *
 * outlines.h - random smooth convex outlines, and the n-arc and the n-gon that stand for one.
 */
#ifndef NARC_PAPER_OUTLINES_H
#define NARC_PAPER_OUTLINES_H

#include "common.h"

enum { HARMONICS = 3 };

/* An outline by its radius of curvature as a function of the outward normal's angle: 1, and harmonics 2, 3 and 4. (A
 * first harmonic would leave it open.) */
struct smooth {
    double amplitude[HARMONICS], phase[HARMONICS];
};

struct smooth random_smooth(uint64_t *random);

/* Angles of `count` + 1 junction normals, the last one turn after the first: up to 0.3 sectors from equal angles. */
void random_junctions(uint64_t *random, size_t count, double *out_angles);

/* The n-arc with these junction normals that follows the outline: each radius is such that the arc's chord is as long,
 * along its own direction, as that of the outline's piece with the same normals, but for the least change (in squares)
 * that closes the list. Its area is the outline's and its centroid the origin. False if a radius is below 0.05. */
bool fit_n_arc(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs);

/* The polygon whose vertices are the outline's points with these normals, enlarged to the outline's area; its centroid
 * is the origin. A vertex is an arc of radius 0. */
void fit_n_gon(const struct smooth *outline, const double *junctions, size_t count, narc_arc *out_arcs);

/* Puts the centres of a list of junction normals and radii one behind the other, so that tangents are continuous. */
void chain_centers(narc_arc *arcs, size_t count);

/* The change of the radii that closes the list, the least one if that of arc k counts 1 / weights[k]^2. */
void close_radii(narc_arc *arcs, size_t count, const double *weights);

/* Multiplies all lengths. */
void resize(narc_arc *arcs, size_t count, double factor);

/* Moves the centroid to the origin. */
void center(narc_arc *arcs, size_t count);

#endif
