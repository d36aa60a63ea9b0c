/* SPDX-License-Identifier: MIT
 *
 * narc_rows.h - the rows of this library.
 */
#ifndef NARC_BENCH_NARC_ROWS_H
#define NARC_BENCH_NARC_ROWS_H

#include "bench.h"
#include "workload.h"

/* In a settled pile every run takes the other of two frames, whatever is asked. */
enum query {
    QUERY_OVERLAP,
    QUERY_CONTACT,
    QUERY_FRAMES,   /* contacts; every run takes the other of two frames */
    QUERY_HINTED,   /* the same, with the hints that the run before, in the other frame, gave back */
    QUERY_MANIFOLD, /* with such hints too */
    QUERY_DISCS,    /* contacts by a loop for discs (disc_loops.h) in the place of the library */
};

struct narc_job {
    enum query query;
    struct workload_key key;
    const char *isa; /* or the loop's name */
    unsigned threads;
    size_t pair_count; /* of the workload's, from the first on; 0: all */
    size_t batch;      /* contacts: pairs of a call, so that a run makes several; 0: one call */
};

/* The row that does this job. */
struct bench_row *make_narc_row(const char *name, const struct narc_job *job);

#endif
