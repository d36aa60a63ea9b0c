/* SPDX-License-Identifier: MIT
 *
 * step_rows.h - rows for the steps of a simulation from bodies to manifolds, and for these steps together.
 */
#ifndef NARC_BENCH_STEP_ROWS_H
#define NARC_BENCH_STEP_ROWS_H

#include "bench.h"
#include "workload.h"

/* Of settled piles. Every run takes the other of two frames. */
enum step {
    STEP_BOXES,
    STEP_PAIRS, /* of boxes that are there */
    STEP_MATCH, /* pairs of one frame with those of the other, and hints carried over */
    STEP_WHOLE, /* all of these, and manifolds */
    STEP_KEPT,  /* pairs that are updated, and kept, and manifolds */
};

struct step_job {
    enum step step;
    struct workload_key key;
    const char *isa;
    unsigned threads;
};

struct bench_row *make_step_row(const char *name, const struct step_job *job);

#endif
