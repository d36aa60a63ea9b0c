/* SPDX-License-Identifier: MIT
 *
 * regions.c - regions beside Box2D, Chipmunk and GEOS, in batches and one by one, by one worker and two (the ratio of
 * the least times on the clock). Settled piles and sparse scenes of polygons; regions that find 48 bodies and 3. The
 * libraries take turns within one process.
 *
 *     bench_regions [--bodies=1000, 30000 and 1000000] [--regions=10000] [--rounds=7]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "keys.h"
#include "own.h"
#include "peers.h"
#include "random.h"
#include "setting.h"

enum { MOST_FOUND = 200 /* of a region, in the mean */ };

static const struct region_peer *const peers[] = {&box2d_regions, &chipmunk_regions, &geos_regions};
enum { PEERS = sizeof peers / sizeof *peers, BATCH = PEERS, ONE_BY_ONE, TWO_WORKERS, WAYS };

/* Squares that meet so many boxes in the mean, were these everywhere as dense. */
static void make_regions(const struct own *own, double found, narc_box *regions, size_t count) {
    const size_t bodies = own->bodies.count;
    uint64_t random = 79;
    double width = 0;
    for (size_t k = 0; k < bodies; k++)
        width += (double)(own->boxes[k].max_x - own->boxes[k].min_x) / (double)bodies;
    const double size = fmax(0, 2 * own->half * sqrt(found / (double)bodies) - width);
    for (size_t k = 0; k < count; k++) {
        const double x = random_between(&random, -own->half, own->half - size);
        const double y = random_between(&random, -own->half, own->half - size);
        regions[k] = (narc_box){(float)x, (float)y, (float)(x + size), (float)(y + size)};
    }
}

/* So many regions in a call; the pairs of the last one. */
static narc_pairs find_own(narc_index *index, const narc_box *regions, size_t count, size_t batch, unsigned workers) {
    const narc_workers some = narc_openmp_workers(workers);
    const narc_index_query query = {.workers = workers > 1 ? &some : NULL};
    narc_pairs pairs = {0};
    narc_error error;
    for (size_t k = 0; k < count; k += batch)
        must(narc_query_index(index, regions + k, batch, &query, &pairs, &error), &error);
    return pairs;
}

static void compare_regions(const struct setting *s, const char *name, const struct own *own, void *const *trees,
                            double found) {
    narc_box *const regions = allocate(s->questions, sizeof *regions);
    uint64_t *keys[PEERS + 1]; /* the last ones are this library's */
    size_t counts[PEERS + 1];
    double ns[WAYS][MOST_ROUNDS], wall[WAYS][MOST_ROUNDS], median[WAYS];
    for (int k = 0; k <= PEERS; k++)
        keys[k] = allocate(MOST_FOUND * s->questions, sizeof *keys[k]);
    make_regions(own, found, regions, s->questions);
    for (size_t round = 0; round < s->rounds; round++)
        for (int way = 0; way < WAYS; way++) {
            const double start = now(), wall_start = read_clock();
            if (way < PEERS)
                counts[way] = peers[way]->find(trees[way], regions, s->questions, keys[way]);
            else
                find_own(own->index, regions, s->questions, way == ONE_BY_ONE ? 1 : s->questions,
                         way == TWO_WORKERS ? 2 : 1);
            ns[way][round] = (now() - start) / (double)s->questions;
            wall[way][round] = read_clock() - wall_start;
        }
    const double by_one = quantile(wall[BATCH], s->rounds, 0);
    const double by_two = quantile(wall[TWO_WORKERS], s->rounds, 0);
    for (int way = 0; way < WAYS; way++)
        median[way] = quantile(ns[way], s->rounds, 0.5);
    const narc_pairs pairs = find_own(own->index, regions, s->questions, s->questions, 1);
    counts[PEERS] = add_keys(&pairs, 0, 0, keys[PEERS], 0);
    printf("| %zu %s | %.1f | %.0f | %.0f | %.1f |", own->bodies.count, name,
           (double)counts[PEERS] / (double)s->questions, median[BATCH], median[ONE_BY_ONE], by_one / by_two);
    for (int k = 0; k < PEERS; k++)
        printf(" %.0f (%.1f, %.1f) |", median[k], median[k] / median[BATCH], median[k] / median[ONE_BY_ONE]);
    for (int k = 0; k < PEERS; k++)
        printf("%s %zu", k ? "," : "", count_differences(keys[PEERS], counts[PEERS], keys[k], counts[k]));
    printf(" |\n");
    fflush(stdout);
    for (int k = 0; k <= PEERS; k++)
        free(keys[k]);
    free(regions);
}

static void compare(const struct setting *s, const char *name, size_t bodies, double spread) {
    const struct own own = make_own(FAMILY_POLYGONS, bodies, spread);
    void *trees[PEERS];
    for (int k = 0; k < PEERS; k++)
        trees[k] = peers[k]->create(own.scene, own.boxes);
    compare_regions(s, name, &own, trees, 48);
    compare_regions(s, name, &own, trees, 3);
}

int main(int argc, char **argv) {
    const struct setting s = read_setting(argc, argv, "--regions=", 10000, 7);
    printf("%s, %s, %s; beside %s\n\n", processor_name(), compiler_name, choose_best_isa(), box2d_name());
    printf("| Scene, ns a region | Found | Batch | one by one | two workers, times | Box2D (times batch, one by one) | "
           "Chipmunk | GEOS | Differ |\n| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    compare_scenes(&s, compare);
    return 0;
}
