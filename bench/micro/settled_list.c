/* SPDX-License-Identifier: MIT
 *
 * settled_list.c - which rows there are of settled piles.
 */
#include "list.h"

#include <stdio.h>
#include <string.h>

#include "common.h"
#include "disc_loops.h"
#include "peers.h"
#include "rows.h"

/* Bodies of a pile for 65,536 pairs of the other scenes: small, middle and large. */
static const size_t body_counts[] = {2000, 30000, 1000008};

static const struct shapes {
    enum family family;
    unsigned edges;
} all_shapes[] = {{FAMILY_N_ARCS, 4}, {FAMILY_N_ARCS, 8}, {FAMILY_N_ARCS, 12}, {FAMILY_ROUNDED, 8},
                  {FAMILY_BOXES, 4},  {FAMILY_DISCS, 8},  {FAMILY_KINDS, 8},   {FAMILY_CAPSULES, 4}};
enum { SHAPES = sizeof all_shapes / sizeof all_shapes[0] };

static size_t pair_count;

static struct workload_key settled(struct shapes shapes, enum scene scene, enum variety variety) {
    const double bodies = (double)body_counts[scene - SCENE_SETTLED_SMALL] * (double)pair_count / 65536;
    return (struct workload_key){.edges = shapes.edges,
                                 .family = shapes.family,
                                 .scene = scene,
                                 .variety = variety,
                                 .sorted = true,
                                 .body_count = bodies < 64 ? 64 : (size_t)bodies};
}

/* ------------------------------------------------------------------------------------------------ rows */

static void name_row(const char *title, const struct workload_key *key, const char *who, const char *suffix,
                     char name[BENCH_NAME]) {
    char workload[BENCH_NAME / 2];
    name_workload(key, workload, sizeof workload);
    snprintf(name, BENCH_NAME, "%s/%s/%s%s", title, workload, who, suffix);
}

static void add_query(enum query query, struct workload_key key, const char *who) {
    static const char *const titles[] = {[QUERY_OVERLAP] = "overlap",
                                         [QUERY_CONTACT] = "contact",
                                         [QUERY_HINTED] = "hinted",
                                         [QUERY_MANIFOLD] = "manifold",
                                         [QUERY_DISCS] = "contact"};
    char name[BENCH_NAME];
    name_row(titles[query], &key, who, "", name);
    const struct narc_job job = {.query = query, .key = key, .isa = who, .threads = 1};
    if (!is_listed(name))
        list_row(make_narc_row(name, &job));
}

static void add_batches(struct workload_key key, const char *isa, size_t batch) {
    char name[BENCH_NAME], suffix[32];
    snprintf(suffix, sizeof suffix, "/by%zu", batch);
    name_row("contact", &key, isa, suffix, name);
    const struct narc_job job = {.query = QUERY_CONTACT, .key = key, .isa = isa, .threads = 1, .batch = batch};
    list_row(make_narc_row(name, &job));
}

static void add_step(enum step step, struct workload_key key, const char *isa, unsigned threads) {
    static const char *const titles[] = {"boxes", "pairs", "match", "step", "kept"};
    char name[BENCH_NAME];
    name_row(titles[step], &key, isa, threads == 2 ? "/2threads" : "", name);
    const struct step_job job = {.step = step, .key = key, .isa = isa, .threads = threads};
    if (threads > narc_openmp_workers(0).count)
        bench_skip(name, "fewer threads here");
    else
        list_row(make_step_row(name, &job));
}

/* The example world with so many bodies. */
static void add_world_parts(struct workload_key key, const char *isa, size_t body_count) {
    static const char *const titles[] = {[WORLD_MANIFOLDS] = "world-manifold", [WORLD_CONTACTS] = "world-contact"};
    key.body_count = key.body_count * body_count / body_counts[1];
    for (enum world_part part = WORLD_MANIFOLDS; part <= WORLD_CONTACTS; part++) {
        char name[BENCH_NAME], suffix[32];
        snprintf(suffix, sizeof suffix, "/%zubodies", body_count);
        name_row(titles[part], &key, isa, suffix, name);
        list_row(make_world_part_row(name, part, &key, isa));
    }
}

/* A pile of 10,000 of which all, one of 20, one of 100, or no body leaves its box in a step. */
static void add_rest(struct workload_key key, const char *isa) {
    static const size_t parts[] = {1, 20, 100, 0};
    key.body_count /= body_counts[1] / 10000;
    for (size_t k = 0; k < sizeof parts / sizeof parts[0]; k++) {
        char name[BENCH_NAME], suffix[32];
        snprintf(suffix, sizeof suffix, "/1of%zu", parts[k]);
        name_row("update", &key, isa, suffix, name);
        list_row(make_rest_row(name, parts[k], &key, isa));
    }
}

static void add_loop(const char *loop, struct workload_key key) {
    char name[BENCH_NAME];
    name_row("contact", &key, loop, "", name);
    if (find_disc_loop(loop))
        add_query(QUERY_DISCS, key, loop);
    else
        bench_skip(name, "not supported here");
}

static void add_peer(const struct peer *peer, struct workload_key key) {
    char name[BENCH_NAME];
    name_row(peer->query, &key, peer->name, "", name);
    if (peer->missing)
        bench_skip(name, peer->missing);
    else
        list_row(make_peer_row(name, peer, &key));
}

static void add_world(const struct world_peer *peer, struct workload_key key) {
    char name[BENCH_NAME];
    name_row("step", &key, peer->name, "", name);
    if (peer->missing)
        bench_skip(name, peer->missing);
    else
        list_row(make_world_row(name, peer, &key));
}

/* ------------------------------------------------------------------------------------------------ which */

static void add_queries(const char *isa, enum variety variety) {
    for (size_t k = 0; k < SHAPES; k++) {
        const struct workload_key key = settled(all_shapes[k], SCENE_SETTLED, variety);
        add_query(QUERY_OVERLAP, key, isa);
        add_query(QUERY_CONTACT, key, isa);
        add_query(QUERY_HINTED, key, isa);
        add_query(QUERY_MANIFOLD, key, isa);
    }
}

static void add_steps(struct workload_key key, const char *isa, unsigned threads) {
    for (enum step step = STEP_BOXES; step <= STEP_KEPT; step++)
        add_step(step, key, isa, threads);
}

/* Stacks of boxes beside Box2D, with few shapes and one for each body or nearly. */
static void add_stacks(const char *isa) {
    for (enum scene scene = SCENE_PYRAMID; scene <= SCENE_LATTICE; scene++) {
        for (enum variety variety = UNIQUE; variety <= TEMPLATES; variety++) {
            const struct workload_key key = {.edges = 4,
                                             .family = FAMILY_BOXES,
                                             .scene = scene,
                                             .variety = variety,
                                             .sorted = true,
                                             .pair_count = pair_count / 4};
            add_query(QUERY_OVERLAP, key, isa);
            add_query(QUERY_CONTACT, key, isa);
            add_query(QUERY_MANIFOLD, key, isa);
            add_peer(&box2d_collide, key);
        }
    }
}

/* What the instruction sets are compared by: piles on each of them, `best` having its rows already. */
static void add_instruction_sets(struct workload_key key, const char *best) {
    for (size_t k = 0; narc_isa_name(k); k++) {
        const char *isa = narc_isa_name(k);
        if (!narc_isa_supported(isa) || strcmp(isa, best) == 0)
            continue;
        add_queries(isa, FEW);
        add_step(STEP_BOXES, key, isa, 1);
        add_step(STEP_PAIRS, key, isa, 1);
    }
}

void list_settled(const struct row_choice *choice) {
    const struct shapes four = {FAMILY_N_ARCS, 4}, eight = {FAMILY_N_ARCS, 8}, boxes = {FAMILY_BOXES, 4};
    const struct shapes discs = {FAMILY_DISCS, 8}, capsules = {FAMILY_CAPSULES, 4};
    const char *best = choice->best_isa;
    pair_count = choice->pair_count;
    const struct workload_key key = settled(eight, SCENE_SETTLED, FEW),
                              small = settled(eight, SCENE_SETTLED_SMALL, FEW),
                              large = settled(eight, SCENE_SETTLED_LARGE, FEW);
    add_queries(best, FEW);
    add_queries(best, UNIQUE);
    for (size_t batch = 1; batch <= 65536; batch *= batch == 256 ? 256 : 4)
        add_batches(key, best, batch);
    add_steps(small, best, 1);
    add_steps(key, best, 1);
    add_steps(large, best, 1);
    add_steps(large, best, 2);
    add_query(QUERY_MANIFOLD, large, best);
    add_stacks(best);
    if (choice->all)
        add_instruction_sets(key, best);
    add_rest(key, best);
    add_world_parts(key, best, 10000);
    add_world_parts(key, best, 30000);
    if (narc_isa_supported("avx2")) {
        add_query(QUERY_CONTACT, settled(four, SCENE_SETTLED, FEW), "avx2");
        add_query(QUERY_HINTED, settled(four, SCENE_SETTLED, FEW), "avx2");
        add_query(QUERY_CONTACT, key, "avx2");
        add_query(QUERY_HINTED, key, "avx2");
        add_query(QUERY_CONTACT, settled(capsules, SCENE_SETTLED, FEW), "avx2");
        add_query(QUERY_MANIFOLD, settled(capsules, SCENE_SETTLED, FEW), "avx2");
    }
    add_loop("scalar-loop", settled(discs, SCENE_SETTLED, FEW));
    add_loop("avx2-loop", settled(discs, SCENE_SETTLED, FEW));
    for (enum variety variety = UNIQUE; variety < VARIETIES; variety += FEW - UNIQUE) {
        add_peer(&box2d_collide, settled(four, SCENE_SETTLED, variety));
        add_peer(&box2d_collide, settled(eight, SCENE_SETTLED, variety));
        add_peer(&box2d_collide, settled(boxes, SCENE_SETTLED, variety));
        add_peer(&chipmunk_collide, settled(eight, SCENE_SETTLED, variety));
        add_peer(&chipmunk_collide, settled(boxes, SCENE_SETTLED, variety));
        add_peer(&box2d_collide, settled(capsules, SCENE_SETTLED, variety));
        add_peer(&chipmunk_collide, settled(capsules, SCENE_SETTLED, variety));
    }
    for (size_t p = 0; all_world_peers[p]; p++) {
        add_world(all_world_peers[p], small);
        add_world(all_world_peers[p], key);
    }
}
