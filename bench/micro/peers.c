/* SPDX-License-Identifier: MIT
 *
 * peers.c - the rows of the peers: all pairs in a loop, and the check of what they answer.
 */
#include "peers.h"

#include <math.h>
#include <stdio.h>

#include "bench.h"
#include "common.h"

#ifndef BENCH_BOX2D
const struct peer box2d_collide = {.name = "box2d-collide", .query = "contact", .missing = "built without Box2D"};
const struct peer box2d_overlap = {.name = "box2d-overlap", .query = "overlap", .missing = "built without Box2D"};
#endif
#ifndef BENCH_CHIPMUNK
const struct peer chipmunk_collide = {.name = "chipmunk", .query = "contact", .missing = "built without Chipmunk"};
#endif
#ifndef BENCH_CCD
const struct peer ccd_gjk = {.name = "ccd-gjk", .query = "overlap", .missing = "built without libccd"};
const struct peer ccd_mpr = {.name = "ccd-mpr", .query = "overlap", .missing = "built without libccd"};
#endif

const struct peer *const all_peers[] = {&box2d_collide, &box2d_overlap, &chipmunk_collide, &ccd_gjk,
                                        &ccd_mpr,       &plain_paper,   &plain_exact,      NULL};

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
    if (peer->polygons)
        row->key.family = FAMILY_POLYGONS;
    snprintf(row->row.name, sizeof row->row.name, "%s", name);
    row->row.pairs = key->pair_count;
    row->row.prepare = prepare;
    row->row.run = run;
    row->row.context = row;
    row->row.must_be_right = peer == &plain_exact;
    return &row->row;
}
