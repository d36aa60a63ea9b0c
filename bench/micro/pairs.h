/* SPDX-License-Identifier: MIT
 *
 * pairs.h - bodies and pairs for the shapes of a workload.
 */
#ifndef NARC_BENCH_PAIRS_H
#define NARC_BENCH_PAIRS_H

#include "workload.h"

/* One first body for 4 pairs, each with a second body of its own. */
void make_pairs(struct workload *workload);

/* One body for 10 pairs, at random places, as dense as it takes for that many pairs of boxes that overlap. */
void make_packing(struct workload *workload);

/* Squares in rows, each pair of neighbours. */
void make_stack(struct workload *workload);

#endif
