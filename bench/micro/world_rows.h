/* SPDX-License-Identifier: MIT
 *
 * world_rows.h - rows for what an engine does beside this library: the example world's contacts.
 */
#ifndef NARC_BENCH_WORLD_ROWS_H
#define NARC_BENCH_WORLD_ROWS_H

#include "bench.h"
#include "workload.h"

/* Of a settled pile in the example world, after a step. */
enum world_part {
    WORLD_MANIFOLDS, /* the batch call, with a margin for each pair and hints */
    WORLD_CONTACTS,  /* what its solver takes, made of these rows */
};

struct bench_row *make_world_part_row(const char *name, enum world_part part, const struct workload_key *key,
                                      const char *isa);

#endif
