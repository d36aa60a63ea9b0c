/* SPDX-License-Identifier: MIT
 *
 * profile.h - the difference of two support functions, a chain's less a hull's, over all directions. Internal.
 *
 * In an interval of directions that belong to one arc (centre a, radius r) and one corner p of the hull, the difference
 * is r - (p - a).u less the hull's inflation: a sinusoid, whose extremes are at the ends, and where u is along p - a
 * (least) or against it (largest).
 */
#ifndef NARC_FIT_PROFILE_H
#define NARC_FIT_PROFILE_H

#include "chain.h"
#include "hull.h"

typedef struct extreme {
    narc_point direction;
    double difference;
} extreme;

typedef struct interval {
    size_t arc, corner;
    narc_point from, to; /* directions */
    extreme least, largest;
} interval;

/* The most intervals that a chain of `arcs` arcs and a hull of `corners` corners have. */
size_t narc_count_intervals(size_t arcs, size_t corners);

/* Walks both outlines once; intervals in the order of their directions, from the chain's first normal. Each arc's
 * sector is taken as larger by `slop` radians at both ends. Returns the number of intervals. */
size_t narc_make_profile(const chain *of, const hull *around, double slop, interval *out_intervals);

/* The least and the largest difference of all. */
double narc_least_difference(const interval *intervals, size_t count);
double narc_largest_difference(const interval *intervals, size_t count);

#endif
