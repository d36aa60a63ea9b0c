/* SPDX-License-Identifier: MIT
 *
 * test_methods_race.c - all methods at once, each in a thread of its own, on one store and in the process's first
 * calls. Says most under a thread sanitizer.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>

#include "methods.h"

enum { METHODS = 7, TWICE = 2, PAIRS = 600 };

struct shared {
    struct scene scene;
    pthread_barrier_t start;
};

/* Two threads have the same method: their bytes must be the same. */
struct worker {
    struct shared *shared;
    narc_method method;
    pthread_t thread;
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    uint32_t hints[PAIRS];
    uint8_t outcomes[PAIRS];
    float separation[PAIRS];
    size_t count;
    narc_status status;
};

static void *work(void *argument) {
    struct worker *w = argument;
    const struct scene *scene = &w->shared->scene;
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_contacts contacts = {.capacity = PAIRS, .separation = w->separation};
    const narc_query query = {.method = w->method, .hints = w->hints, .out_outcomes = w->outcomes};
    pthread_barrier_wait(&w->shared->start);
    for (int frame = 0; frame < 3 && w->status == NARC_OK; frame++) {
        w->status = narc_query_overlaps(scene->store, &bodies, &pairs, &query, 1, w->bits, NULL);
        if (w->status == NARC_OK && w->method < NARC_METHOD_CIRCLE) {
            w->status =
                narc_query_contacts(scene->store, &bodies, &pairs, &query, INFINITY, 1, &contacts, &w->count, NULL);
        }
    }
    return NULL;
}

/* Polygons only, so that every method takes them. */
static struct scene make_polygon_scene(void) {
    struct test_random random = test_random_named("methods race");
    struct scene scene = create_scene(NARC_FLOAT32, 10, 100, PAIRS);
    for (int k = 0; k < 10; k++) {
        const struct shape shape = make_shape(&random, FAMILY_POLYGON);
        scene_add_shape(&scene, &shape);
    }
    for (uint32_t k = 0; k < 100; k++) {
        struct body body = turned_body(random_between(&random, -3, 3), 1);
        body.x = random_between(&random, 0, 2.5);
        body.y = random_between(&random, 0, 2.5);
        body.shape = k % 10;
        scene_add_body(&scene, body);
    }
    for (size_t k = 0; k < PAIRS; k++) {
        const uint32_t a = (uint32_t)random_below(&random, 100);
        scene_add_pair(&scene, a, (uint32_t)random_below(&random, 100));
    }
    return scene;
}

static void test_methods_at_once(void **state) {
    (void)state;
    struct shared shared = {.scene = make_polygon_scene()};
    struct worker *workers = calloc(METHODS * TWICE, sizeof *workers);
    assert_non_null(workers);
    assert_int_equal(pthread_barrier_init(&shared.start, NULL, METHODS * TWICE), 0);
    for (int k = 0; k < METHODS * TWICE; k++) {
        workers[k].shared = &shared;
        workers[k].method = (narc_method)(k % METHODS);
        if (pthread_create(&workers[k].thread, NULL, work, &workers[k]) != 0) {
            print_error("no thread\n");
            exit(EXIT_FAILURE); /* the others would wait for ever */
        }
    }
    for (int k = 0; k < METHODS * TWICE; k++) {
        pthread_join(workers[k].thread, NULL);
    }
    for (int k = 0; k < METHODS; k++) {
        const struct worker *one = &workers[k], *other = &workers[k + METHODS];
        assert_int_equal(one->status, NARC_OK);
        assert_int_equal(other->status, NARC_OK);
        assert_int_equal(one->count, k < NARC_METHOD_CIRCLE ? PAIRS : 0);
        assert_memory_equal(one->bits, other->bits, sizeof one->bits);
        assert_memory_equal(one->hints, other->hints, sizeof one->hints);
        assert_memory_equal(one->outcomes, other->outcomes, sizeof one->outcomes);
        assert_memory_equal(one->separation, other->separation, sizeof one->separation);
    }
    pthread_barrier_destroy(&shared.start);
    destroy_scene(&shared.scene);
    free(workers);
}

int main(void) {
    const struct CMUnitTest tests[] = {cmocka_unit_test(test_methods_at_once)};
    return cmocka_run_group_tests_name("methods_race", tests, NULL, NULL);
}
