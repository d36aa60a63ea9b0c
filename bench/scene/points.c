/* SPDX-License-Identifier: MIT
 *
 * points.c - the nearest bodies of points beside Chipmunk and GEOS, and distances by pair: settled piles and sparse
 * scenes. The ways take turns within one process. Chipmunk wants to know how far to look, and takes longer the further
 * that is; it is told a distance within which every point finds something. Both are asked of a tenth of the points.
 *
 *     bench_points [--bodies=1000, 30000 and 1000000] [--points=200000] [--rounds=5]
 */
#include <math.h>
#include <stdio.h>

#include "common.h"
#include "own.h"
#include "peers.h"
#include "random.h"
#include "setting.h"

enum { PEER_PART = 10 };

struct questions {
    size_t count;
    float *x, *y, *distances[2];
    uint32_t *body;
    narc_distance *rows;
};

static struct questions make_questions(double half, size_t count) {
    struct questions q = {count,
                          allocate(count, sizeof(float)),
                          allocate(count, sizeof(float)),
                          {allocate(count, sizeof(float)), allocate(count, sizeof(float))},
                          allocate(count, sizeof *q.body),
                          allocate(count, sizeof *q.rows)};
    uint64_t random = 78;
    for (size_t k = 0; k < count; k++) {
        q.x[k] = (float)random_between(&random, -half, half);
        q.y[k] = (float)random_between(&random, -half, half);
    }
    return q;
}

/* ------------------------------------------------------------------------------------------------ ways */

static const double reach = 2; /* of a pile; times the spread */

/* So many points in a call. */
static void find_nearest(const struct own *own, const struct questions *q, size_t batch,
                         const narc_nearest_options *options) {
    for (size_t k = 0; k < q->count; k += batch) {
        const narc_points points = {.count = batch < q->count - k ? batch : q->count - k,
                                    .x = NARC_POSITION_ARRAY(q->x + k),
                                    .y = NARC_POSITION_ARRAY(q->y + k)};
        narc_error error;
        must(narc_find_nearest(own->index, own->scene->shapes, &own->bodies, &points, options, q->rows + k,
                               points.count, &error),
             &error);
    }
}

static void find_distances(const struct own *own, const struct questions *q, narc_index_column body) {
    const narc_points points = {.count = q->count, .x = NARC_POSITION_ARRAY(q->x), .y = NARC_POSITION_ARRAY(q->y)};
    narc_error error;
    must(narc_find_distances(own->scene->shapes, &own->bodies, &points, body, NULL, q->rows, &error), &error);
}

enum way { ARCS, POLYGONS, ONE_BY_ONE, INSIDE, TWO_WORKERS, PAIRS, ONE_BODY, CHIPMUNK, GEOS, WAYS };

static double run(enum way way, const struct own *arcs, const struct own *own, void *const *peers,
                  const struct questions *q, float within) {
    const narc_workers two = narc_openmp_workers(2);
    const narc_nearest_options inside = {.inside = 1}, by_two = {.search.workers = &two};
    const uint32_t first = 0;
    const double start = now();
    switch (way) {
    case ARCS:
        find_nearest(arcs, q, q->count, NULL);
        break;
    case POLYGONS:
        find_nearest(own, q, q->count, NULL);
        break;
    case ONE_BY_ONE:
        find_nearest(arcs, q, 1, NULL);
        break;
    case INSIDE:
        find_nearest(arcs, q, q->count, &inside);
        break;
    case TWO_WORKERS:
        find_nearest(arcs, q, q->count, &by_two);
        break;
    case PAIRS:
        find_distances(arcs, q, NARC_ARRAY(q->body));
        break;
    case ONE_BODY:
        find_distances(arcs, q, (narc_index_column){&first, 0});
        break;
    case CHIPMUNK:
        chipmunk_scene.find_nearest(peers[0], q->x, q->y, q->count / PEER_PART, within, q->distances[0]);
        break;
    case GEOS:
        geos_find_nearest(peers[1], q->x, q->y, q->count / PEER_PART, q->distances[1]);
    case WAYS:
        break;
    }
    return (now() - start) / (double)(way >= CHIPMUNK ? q->count / PEER_PART : q->count);
}

static void compare(const struct setting *s, const char *scene_name, size_t bodies, double spread) {
    const struct own arcs = make_own(FAMILY_N_ARCS, bodies, spread);
    const struct own own = make_own(FAMILY_POLYGONS, bodies, spread);
    void *const peers[] = {chipmunk_scene.create(own.scene), geos_create_polygons(own.scene)};
    const struct questions q = make_questions(own.half, s->questions);
    double ns[WAYS][MOST_ROUNDS], wall[WAYS][MOST_ROUNDS], median[WAYS];
    size_t differences[2] = {0};
    find_nearest(&arcs, &q, q.count, NULL);
    for (size_t k = 0; k < q.count; k++)
        q.body[k] = q.rows[k].body;
    for (size_t round = 0; round < s->rounds; round++)
        for (enum way way = 0; way < WAYS; way++) {
            const double start = read_clock();
            ns[way][round] = run(way, &arcs, &own, peers, &q, (float)(reach * spread));
            wall[way][round] = read_clock() - start;
        }
    const double by_one = quantile(wall[ARCS], s->rounds, 0), by_two = quantile(wall[TWO_WORKERS], s->rounds, 0);
    find_nearest(&own, &q, q.count, NULL);
    for (int peer = 0; peer < 2; peer++)
        for (size_t k = 0; k < q.count / PEER_PART; k++) { /* within bodies they name another depth, or none */
            const float separation = q.rows[k].separation;
            differences[peer] += fabs((double)(separation - q.distances[peer][k])) > 1e-3 && separation > 0;
        }
    for (enum way way = 0; way < WAYS; way++)
        median[way] = quantile(ns[way], s->rounds, 0.5);
    printf("| %zu %s | %.0f | %.0f | %.0f | %.0f | %.2f | %.0f | %.0f |", own.bodies.count, scene_name, median[ARCS],
           median[POLYGONS], median[ONE_BY_ONE], median[INSIDE], by_one / by_two, median[PAIRS], median[ONE_BODY]);
    for (enum way way = CHIPMUNK; way < WAYS; way++)
        printf(" %.0f (%.1f, %.1f) |", median[way], median[way] / median[POLYGONS], median[way] / median[ONE_BY_ONE]);
    printf(" %zu, %zu |\n", differences[0], differences[1]);
    fflush(stdout);
}

int main(int argc, char **argv) {
    const struct setting s = read_setting(argc, argv, "--points=", 200000, 5);
    printf("%s, %s, %s; ns a point, the nearest body but for distances\n\n", processor_name(), compiler_name,
           choose_best_isa());
    printf("| Scene | n-arcs | polygons | n-arcs one by one | inside | two workers, times | distances by pair | of one "
           "body | Chipmunk (times polygons, one by one) | GEOS | Differ |\n");
    printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    compare_scenes(&s, compare);
    return 0;
}
