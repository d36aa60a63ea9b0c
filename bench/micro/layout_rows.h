/* SPDX-License-Identifier: MIT
 *
 * layout_rows.h - the benchmark rows that compare layouts.
 */
#ifndef NARC_BENCH_LAYOUT_ROWS_H
#define NARC_BENCH_LAYOUT_ROWS_H

#include "bench.h"
#include "workload.h"

/* The first stage over the pairs of a workload by each layout, "rows", "planes-gathered", "planes-masked" and
 * "planes-loaded", on instruction set `isa`. NULL where this layout or instruction set has none. */
struct bench_row *make_layout_row(const char *name, size_t layout, const struct workload_key *key, const char *isa);

/* NULL behind the last. */
const char *layout_name(size_t layout);

#endif
