/* SPDX-License-Identifier: MIT
 *
 * disc_loops.h - contacts of discs by loops that know nothing else: what a general narrow phase is measured against.
 */
#ifndef NARC_BENCH_DISC_LOOPS_H
#define NARC_BENCH_DISC_LOOPS_H

#include <stddef.h>

#include "narc.h"
#include "workload.h"

/* All that there is to know of a body. */
struct disc {
    float x, y, radius, unused;
};

/* Writes the contacts of the pairs that collide, in the order of the pairs; returns how many. May write one more. */
typedef size_t disc_loop(const struct disc *discs, const struct pair *pairs, size_t count, narc_contact *out);

/* By name, "scalar-loop" or "avx2-loop"; NULL where it can't run. */
disc_loop *find_disc_loop(const char *name);

#endif
