/* SPDX-License-Identifier: MIT
 *
 * rays.c - rays beside Box2D and Chipmunk: settled piles and sparse scenes of polygons; fans, long and short rays; in
 * batches and one by one. The libraries take turns within one process.
 *
 *     bench_rays [--bodies=1000, 30000 and 1000000] [--rays=10800] [--rounds=7]
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "own.h"
#include "peers.h"
#include "random.h"
#include "setting.h"

enum { FAN = 1080, WAYS = 3 };

/* ------------------------------------------------------------------------------------------------ rays */

enum kind { FANS, LONG, SHORT, KINDS };
static const char *const kind_names[KINDS] = {"fans of 1080", "long", "short"};

struct questions {
    size_t count;
    struct peer_ray *rays;
    float *motion_x, *motion_y, *fractions;
    narc_ray_hit *hits;
};

static struct questions make_questions(double half, enum kind kind, size_t count) {
    struct questions q = {count,
                          allocate(count, sizeof *q.rays),
                          allocate(count, sizeof(float)),
                          allocate(count, sizeof(float)),
                          allocate(count, sizeof(float)),
                          allocate(count, sizeof *q.hits)};
    uint64_t random = 77;
    double x = 0, y = 0;
    for (size_t k = 0; k < count; k++) {
        if (kind != FANS || k % FAN == 0) {
            x = random_between(&random, -half, half);
            y = random_between(&random, -half, half);
        }
        const double angle = kind == FANS ? 2 * pi * (double)(k % FAN) / FAN : random_between(&random, -pi, pi);
        const double length = kind == SHORT ? 4 : half;
        struct peer_ray *const ray = &q.rays[k];
        ray->x = (float)x;
        ray->y = (float)y;
        q.motion_x[k] = (float)(length * cos(angle));
        q.motion_y[k] = (float)(length * sin(angle));
        ray->end_x = ray->x + q.motion_x[k];
        ray->end_y = ray->y + q.motion_y[k];
    }
    return q;
}

/* ------------------------------------------------------------------------------------------------ this library */

/* So many rays in a call. */
static void cast_own(const struct own *own, const struct questions *q, size_t batch) {
    const narc_ray_options options = {.inside = NARC_INSIDE_IGNORES};
    for (size_t k = 0; k < q->count; k += batch) {
        const narc_rays rays = {.count = batch < q->count - k ? batch : q->count - k,
                                .x = NARC_POSITION_COLUMN(q->rays + k, x),
                                .y = NARC_POSITION_COLUMN(q->rays + k, y),
                                .motion_x = NARC_ARRAY(q->motion_x + k),
                                .motion_y = NARC_ARRAY(q->motion_y + k)};
        narc_error error;
        must(narc_cast_rays(own->index, own->scene->shapes, &own->bodies, &rays, &options, q->hits + k, rays.count,
                            &error),
             &error);
    }
}

/* How many rays of the two differ in what they hit, but for those that graze. */
static size_t count_differences(const struct questions *q) {
    size_t count = 0;
    for (size_t k = 0; k < q->count; k++) {
        const double own = q->hits[k].count ? (double)q->hits[k].fraction : 2;
        count += fabs(own - (double)q->fractions[k]) > 1e-3;
    }
    return count;
}

/* ------------------------------------------------------------------------------------------------ table */

static void compare_rays(const struct setting *s, const char *scene_name, const struct own *arcs, const struct own *own,
                         void *const *peer_scenes, enum kind kind) {
    static const struct scene_peer *const peers[] = {&box2d_scene, &chipmunk_scene};
    const struct questions q = make_questions(own->half, kind, s->questions / FAN * FAN);
    double ns[WAYS + 2][MOST_ROUNDS], median[WAYS + 2];
    size_t hits = 0, differences = 0;
    for (size_t round = 0; round < s->rounds; round++) {
        for (int way = 0; way < WAYS + 2; way++) {
            const double start = now();
            if (way < WAYS)
                cast_own(way == 2 ? arcs : own, &q, way == 1 ? 1 : kind == FANS ? FAN : q.count);
            else
                peers[way - WAYS]->cast(peer_scenes[way - WAYS], q.rays, q.count, q.fractions);
            ns[way][round] = (now() - start) / (double)q.count;
            if (round == 0 && way == 1)
                for (size_t k = 0; k < q.count; k++)
                    hits += q.hits[k].count;
            if (round == 0 && way == WAYS) {
                cast_own(own, &q, q.count);
                differences = count_differences(&q);
            }
        }
    }
    for (int way = 0; way < WAYS + 2; way++)
        median[way] = quantile(ns[way], s->rounds, 0.5);
    printf("| %zu %s | %s | %.0f %% | %.0f | %.0f | %.0f | %.0f (%.1f, %.1f) | %.0f (%.1f) | %zu |\n",
           own->scene->body_count, scene_name, kind_names[kind], 100.0 * (double)hits / (double)q.count, median[2],
           median[0], median[1], median[3], median[3] / median[0], median[3] / median[1], median[4],
           median[4] / median[0], differences);
    fflush(stdout);
    free(q.rays);
    free(q.motion_x);
    free(q.motion_y);
    free(q.fractions);
    free(q.hits);
}

static void compare(const struct setting *s, const char *name, size_t bodies, double spread) {
    const struct own arcs = make_own(FAMILY_N_ARCS, bodies, spread), own = make_own(FAMILY_POLYGONS, bodies, spread);
    void *const peer_scenes[] = {box2d_scene.create(own.scene), chipmunk_scene.create(own.scene)};
    for (enum kind kind = 0; kind < KINDS; kind++)
        compare_rays(s, name, &arcs, &own, peer_scenes, kind);
}

int main(int argc, char **argv) {
    const struct setting s = read_setting(argc, argv, "--rays=", 10800, 7);
    if (s.questions < FAN)
        fail("--rays=%d or more", FAN);
    printf("%s, %s, %s; one thread, ns a ray; beside %s\n\n", processor_name(), compiler_name, choose_best_isa(),
           box2d_name());
    printf("| Scene | Rays | Hit | n-arcs | Polygons | one by one | Box2D (times batch, one by one) | Chipmunk | "
           "Differ |\n");
    printf("| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n");
    compare_scenes(&s, compare);
    return 0;
}
