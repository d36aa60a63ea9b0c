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

#include "model/chain.h"
#include "outline/hull.h"

typedef struct narc_extreme {
    narc_point direction;
    double difference;
} narc_extreme;

typedef struct narc_interval {
    size_t arc, corner;
    narc_point start, end; /* directions */
    narc_extreme least, largest;
} narc_interval;

/* The most intervals that a chain of `arcs` arcs and a hull of `corners` corners have. */
size_t narc_count_intervals(size_t arcs, size_t corners);

/* Walks both outlines once; intervals in the order of their directions, from the chain's first normal. Returns the
 * number of intervals. */
size_t narc_make_profile(const narc_chain *chain, const narc_hull *hull, narc_interval *out_intervals);

/* The least and the largest difference of all. */
typedef struct narc_difference_range {
    double least, largest;
} narc_difference_range;
narc_difference_range narc_find_range(const narc_interval *intervals, size_t count);

#endif
