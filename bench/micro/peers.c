/* SPDX-License-Identifier: MIT
 *
 * peers.c - the rows of the peers: all pairs in a loop, and the check of what they answer.
 */
#include "peers.h"

#include <math.h>

#include "bench.h"
#include "common.h"

#ifndef BENCH_BOX2D
const struct peer box2d_collide = {.name = "box2d-collide", .query = "contact", .missing = "built without Box2D"};
const struct peer box2d_overlap = {.name = "box2d-overlap", .query = "overlap", .missing = "built without Box2D"};
const struct world_peer box2d_world = {.name = "box2d-world", .missing = "built without Box2D"};
const char *box2d_name(void) { return "no Box2D"; }
#endif
#ifndef BENCH_CHIPMUNK
const struct peer chipmunk_collide = {.name = "chipmunk", .query = "contact", .missing = "built without Chipmunk"};
const struct world_peer chipmunk_space = {.name = "chipmunk-space", .missing = "built without Chipmunk"};
#endif
#ifndef BENCH_CCD
const struct peer ccd_gjk = {.name = "ccd-gjk", .query = "overlap", .missing = "built without libccd"};
const struct peer ccd_mpr = {.name = "ccd-mpr", .query = "overlap", .missing = "built without libccd"};
#endif

const struct peer *const all_peers[] = {&box2d_collide, &box2d_overlap, &chipmunk_collide, &ccd_gjk,
                                        &ccd_mpr,       &plain_paper,   &plain_exact,      NULL};
const struct world_peer *const all_world_peers[] = {&box2d_world, &chipmunk_space, NULL};

struct peer_row {
    struct bench_row row;
    const struct peer *peer;
    struct workload_key key;
    const struct workload *workload;
    void *context;
    uint8_t *colliding;
};

static void run(struct bench_row *bench_row) {
    struct peer_row *row = bench_row->context;
    row->peer->run(row->context, row->workload->pairs, row->workload->pair_count, row->colliding);
}

static void prepare(struct bench_row *bench_row) {
    struct peer_row *row = bench_row->context;
    if (row->workload)
        return;
    const struct workload *workload = row->workload = get_workload(&row->key);
    bench_row->pairs = workload->pair_count;
    row->context = row->peer->create(workload);
    row->colliding = allocate(workload->pair_count, sizeof *row->colliding);
    run(bench_row);
    size_t colliding = 0, wrong = 0;
    for (size_t k = 0; k < workload->pair_count; k++) {
        colliding += row->colliding[k];
        wrong += row->colliding[k] != (workload->gaps[k] < 0) && fabs(workload->gaps[k]) >= TOUCHING;
    }
    bench_row->colliding = (double)colliding / (double)workload->pair_count;
    bench_row->wrong = (double)wrong;
}

struct bench_row *make_peer_row(const char *name, const struct peer *peer, const struct workload_key *key) {
    struct peer_row *row = allocate(1, sizeof *row);
    row->peer = peer;
    row->key = *key;
    if (peer->polygons && key->family == FAMILY_N_ARCS)
        row->key.family = FAMILY_POLYGONS;
    if (!peer->capsules && key->family == FAMILY_CAPSULES)
        row->key.family = FAMILY_CAPSULE_BOXES;
    bench_set(&row->row, name, prepare, run, row, peer == &plain_exact);
    return &row->row;
}

/* ------------------------------------------------------------------------------------------------ worlds */

struct world_row {
    struct bench_row row;
    const struct world_peer *peer;
    struct workload_key key;
    void *context;
};

static void step_world(struct bench_row *bench_row) {
    struct world_row *row = bench_row->context;
    bench_row->seconds = row->peer->step(row->context);
}

/* Steps that have pairs to find and contacts to make are outside the time. */
static void prepare_world(struct bench_row *bench_row) {
    struct world_row *row = bench_row->context;
    if (row->context)
        return;
    const struct workload *workload = get_workload(&row->key);
    row->context = row->peer->create(workload);
    bench_row->pairs = workload->pair_count;
    for (int step = 0; step < 3; step++)
        step_world(bench_row);
    bench_row->colliding = (double)row->peer->count_touching(row->context) / (double)workload->pair_count;
}

struct bench_row *make_world_row(const char *name, const struct world_peer *peer, const struct workload_key *key) {
    struct world_row *row = allocate(1, sizeof *row);
    row->peer = peer;
    row->key = *key;
    row->key.family = FAMILY_POLYGONS;
    bench_set(&row->row, name, prepare_world, step_world, row, false);
    row->row.own_clock = peer->own_clock;
    return &row->row;
}
