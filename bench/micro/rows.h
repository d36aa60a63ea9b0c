/* SPDX-License-Identifier: MIT
 *
 * rows.h - the rows of this library: batch calls, the steps of a simulation, lists of pairs that are kept, and what an
 * engine does besides.
 */
#ifndef NARC_BENCH_ROWS_H
#define NARC_BENCH_ROWS_H

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

/* narc_update_pairs() of a settled pile in which one body of so many leaves its kept box in each step, another one in
 * the next; 1: all of them, 0: none. */
struct bench_row *make_rest_row(const char *name, size_t one_of, const struct workload_key *key, const char *isa);

/* Of a settled pile in the example world, after a step. */
enum world_part {
    WORLD_MANIFOLDS, /* the batch call, with a margin for each pair and hints */
    WORLD_CONTACTS,  /* what its solver takes, made of these rows */
};

struct bench_row *make_world_part_row(const char *name, enum world_part part, const struct workload_key *key,
                                      const char *isa);

#endif
