/* SPDX-License-Identifier: MIT
 *
 * narc_rows.h - the rows of this library.
 */
#ifndef NARC_BENCH_NARC_ROWS_H
#define NARC_BENCH_NARC_ROWS_H

#include "bench.h"
#include "workload.h"

enum query {
    QUERY_OVERLAP,
    QUERY_CONTACT,
    QUERY_FRAMES, /* contacts; every run takes the other of two frames */
    QUERY_HINTED, /* the same, with the hints that the run before, in the other frame, gave back */
};

struct narc_job {
    enum query query;
    struct workload_key key;
    const char *isa;
    unsigned threads;
    size_t pair_count; /* of the workload's, from the first on */
};

/* The row that does this job. */
struct bench_row *make_narc_row(const char *name, const struct narc_job *job);

#endif
