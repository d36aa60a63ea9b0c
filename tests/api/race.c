/* SPDX-License-Identifier: MIT
 *
 * race.c - the first calls of a process from many threads at once: of one kind, with the instruction set being chosen
 * under way, and of all methods on one store. Says most under a thread sanitizer.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "methods.h"

enum { METHODS = 7, THREADS = 2 * METHODS, ROUNDS = 12, PAIRS = 600 };

/* The threads with an odd number choose instruction sets all the time, or two threads have each method. */
enum kind { FIRST_CALL, SWITCHING, ALL_METHODS };

struct shared {
    enum kind kind;
    struct scene scene;
    const narc_methods *methods;
    pthread_barrier_t start;
};

struct worker {
    struct shared *shared;
    int number;
    pthread_t thread;
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    uint32_t hints[PAIRS];
    uint8_t outcomes[PAIRS];
    narc_contact rows[PAIRS];
    size_t count;
    bool failed;
};

static void check(struct worker *w, bool right) { w->failed = w->failed || !right; }

static void switch_sets(struct worker *w) {
    for (size_t k = 0; k < 40; k++) {
        const char *name = narc_isa_name(k % 4);
        const narc_status expected = narc_isa_supported(name) ? NARC_OK : NARC_ERROR_ISA_UNSUPPORTED;
        check(w, narc_set_isa(name, NULL) == expected);
    }
}

static void ask(struct worker *w) {
    const struct scene *scene = &w->shared->scene;
    const narc_query query = {.margin = INFINITY};
    check(w, ask_overlaps(scene, &query, w->bits, NULL) == NARC_OK);
    check(w, ask_contacts(scene, &query, w->rows, PAIRS, &w->count, NULL) == NARC_OK);
}

static void ask_method(struct worker *w, narc_method method) {
    const struct scene *scene = &w->shared->scene;
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    const narc_methods *methods = w->shared->methods;
    const narc_method_options options = {.method = method, .out_outcomes = w->outcomes};
    const narc_query query = {.margin = INFINITY, .hints = NARC_HINT_ARRAY(w->hints)};
    for (int frame = 0; frame < 3; frame++) {
        check(w, narc_find_overlaps_by(methods, &bodies, &pairs, &options, &query, w->bits, NULL) == NARC_OK);
        if (method < NARC_METHOD_CIRCLE) {
            check(w, narc_find_contacts_by(methods, &bodies, &pairs, &options, &query, w->rows, PAIRS, &w->count,
                                           NULL) == NARC_OK);
        }
    }
}

static void *work(void *argument) {
    struct worker *w = argument;
    pthread_barrier_wait(&w->shared->start);
    if (w->shared->kind == SWITCHING && w->number % 2)
        switch_sets(w);
    if (w->shared->kind == ALL_METHODS)
        ask_method(w, (narc_method)(w->number % METHODS));
    else
        ask(w);
    check(w, narc_get_isa() != NULL);
    return NULL;
}

/* Polygons only, so that every method takes them. */
static struct scene make_polygon_scene(void) {
    struct test_random random = test_random_named("race");
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

/* Both were asked the same. */
static bool same_answers(const struct worker *one, const struct worker *other) {
    return one->count == other->count && memcmp(one->bits, other->bits, sizeof one->bits) == 0 &&
           memcmp(one->hints, other->hints, sizeof one->hints) == 0 &&
           memcmp(one->outcomes, other->outcomes, sizeof one->outcomes) == 0 &&
           memcmp(one->rows, other->rows, sizeof one->rows) == 0;
}

/* In a fresh process. Returns whether all threads that asked the same got the same. */
static bool race(enum kind kind) {
    struct shared shared = {.kind = kind, .scene = make_polygon_scene()};
    struct worker *workers = calloc(THREADS, sizeof *workers);
    shared.methods = scene_methods(&shared.scene);
    if (!workers || pthread_barrier_init(&shared.start, NULL, THREADS) != 0)
        return false;
    for (int k = 0; k < THREADS; k++) {
        workers[k].shared = &shared;
        workers[k].number = k;
        if (pthread_create(&workers[k].thread, NULL, work, &workers[k]) != 0)
            return false; /* and the process ends: the others would wait for ever */
    }
    bool same = true;
    for (int k = 0; k < THREADS; k++)
        pthread_join(workers[k].thread, NULL);
    for (int k = 0; k < THREADS; k++) {
        const int method = kind == ALL_METHODS ? k % METHODS : NARC_METHOD_SAT;
        same = same && !workers[k].failed && same_answers(&workers[k], &workers[method]) &&
               workers[k].count == (method < NARC_METHOD_CIRCLE ? PAIRS : 0);
    }
    pthread_barrier_destroy(&shared.start);
    destroy_scene(&shared.scene);
    free(workers);
    return same;
}

/* Only a process that has made no call yet has a first call, so each round is one. exit(), not _exit(): a sanitizer
 * then gets to say its word through the exit status. */
static void race_in_children(enum kind kind) {
    for (int round = 0; round < ROUNDS; round++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            exit(race(kind) ? 0 : 1);
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
    }
}

TEST(test_first_call) { race_in_children(FIRST_CALL); }

TEST(test_switching) { race_in_children(SWITCHING); }

TEST(test_all_methods) { race_in_children(ALL_METHODS); }

int main(void) { return test_run("race", NULL, NULL); }
