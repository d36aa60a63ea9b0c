/* SPDX-License-Identifier: MIT
 *
 * arcs.h - lists of arcs in the making: junction normals and radii are known, the rest follows.
 */
#ifndef NARC_BENCH_ARCS_H
#define NARC_BENCH_ARCS_H

#include "common.h"

/* Angles of `count` + 1 junction normals, the last one turn after the first: up to 0.3 sectors from equal angles. */
void random_junctions(uint64_t *random, size_t count, double *out_angles);

/* The change of the radii that closes the list, the least one if that of arc k counts 1 / weights[k]^2; NULL: all
 * weights are 1. */
void close_radii(narc_arc *arcs, size_t count, const double *weights);

/* Puts the centres of a list of junction normals and radii one behind the other, so that tangents are continuous. */
void chain_centers(narc_arc *arcs, size_t count);

/* Multiplies all lengths. */
void resize(narc_arc *arcs, size_t count, double factor);

/* Area, centroid and moment of a list that is known to be a shape. */
narc_mass mass_of(const narc_arc *arcs, size_t count);

/* Moves the centroid to the origin. */
void center(narc_arc *arcs, size_t count);

#endif
