/* SPDX-License-Identifier: MIT
 *
 * rest_rows.h - rows for lists of pairs that are kept from step to step.
 */
#ifndef NARC_BENCH_REST_ROWS_H
#define NARC_BENCH_REST_ROWS_H

#include "bench.h"
#include "workload.h"

/* narc_update_pairs() of a settled pile in which one body of so many leaves its kept box in each step, another one in
 * the next; 1: all of them, 0: none. */
struct bench_row *make_rest_row(const char *name, size_t one_of, const struct workload_key *key, const char *isa);

#endif
