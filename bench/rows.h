/* SPDX-License-Identifier: MIT
 *
 * rows.h - rows: a question asked of a scene, by this library or a peer. Their names are query/shapes/scene/who, such as
 * overlap/n8/pile/avx512; README.md says what each word means.
 */
#ifndef NARC_BENCH_ROWS_H
#define NARC_BENCH_ROWS_H

#include "bench.h"
#include "peers.h"

struct row;

/* What is asked. `prepare` makes what a run needs, runs once and checks the answers. */
struct question {
    const char *name;
    void (*prepare)(struct row *row);
    void (*run)(struct row *row);
    int what;       /* of several questions that have one function */
    bool own_clock; /* a run says itself how long it took */
};

struct row {
    struct bench_row bench;
    const struct question *question;
    const struct family *family;
    const struct layout_kind *layout;
    const struct peer *peer; /* NULL: this library, */
    const char *isa;         /* on this instruction set */
    bool alone;              /* "/alone": calls of two bodies */
    size_t batch;            /* "/by16": that many questions in a call; 0: all */
    size_t one_of;           /* "/1of20" */
    narc_workers workers;
    struct scene *scene; /* NULL: the question has its own */
    void *state;         /* the question's */
    void *peer_state;
};

/* Behind the last one comes one without a name. */
extern const struct question pair_questions[];  /* overlaps, contacts, manifolds; bits of all peers */
extern const struct question step_questions[];  /* from bodies to manifolds, and what an engine does besides */
extern const struct question scene_questions[]; /* rays, regions, points, indices */
extern const struct question impact_questions[];
extern const struct question ground_questions[];
extern const struct question outline_questions[]; /* hulls, polylines */

/* Makes and registers all rows. */
void list_rows(const char *best_isa, unsigned threads);
const struct row *get_row(size_t index); /* NULL behind the last one */

/* The number of a row's questions in a call. */
size_t batch_of(const struct row *row, size_t done);

/* Room for `count` manifolds, one for all rows, since they run one after another: a call may move it. */
narc_manifold *share_manifolds(size_t count);
float deepest_separation(const narc_manifold *manifold);

#endif
