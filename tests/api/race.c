/* SPDX-License-Identifier: MIT
 *
 * race.c - the first calls of a process from many threads at once: with any question, and with the instruction set being
 * chosen under way. Says most under a thread sanitizer.
 */
#define _POSIX_C_SOURCE 200809L
#include <math.h>
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "questions.h"

enum { THREADS = 14, ROUNDS = 12, PAIRS = 600 };

struct shared {
    bool switching; /* the threads with an odd number choose instruction sets all the time */
    struct scene scene;
    const void *shapes;
    pthread_barrier_t start;
};

struct worker {
    struct shared *shared;
    const struct question *question;
    int number;
    pthread_t thread;
    uint8_t outcomes[PAIRS];
    narc_manifold rows[PAIRS]; /* of others and bits, too */
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
    const narc_bodies bodies = scene_bodies(&w->shared->scene);
    const narc_pairs pairs = scene_pairs(&w->shared->scene);
    const narc_query query = {.margin = INFINITY};
    const struct asked asked = {w->shared->shapes, &bodies, &pairs, &query, w->rows, PAIRS, &w->count, w->outcomes};
    for (int frame = 0; frame < 3; frame++)
        check(w, w->question->ask(w->question, &asked, NULL) == NARC_OK);
}

static void *work(void *argument) {
    struct worker *w = argument;
    pthread_barrier_wait(&w->shared->start);
    if (w->shared->switching && w->number % 2)
        switch_sets(w);
    ask(w);
    check(w, narc_get_isa() != NULL);
    return NULL;
}

/* Both were asked the same. */
static bool same_answers(const struct worker *one, const struct worker *other) {
    return one->count == other->count && memcmp(one->outcomes, other->outcomes, sizeof one->outcomes) == 0 &&
           memcmp(one->rows, other->rows, sizeof one->rows) == 0;
}

/* In a fresh process. Returns whether all threads that asked the same got the same. */
static bool race(size_t first, bool switching) {
    struct test_random random = test_random_named("race");
    const struct question of_polygons = {.polygons = true}; /* so that every question takes them */
    struct shared shared = {.switching = switching,
                            .scene = make_question_scene(&random, &of_polygons, NARC_FLOAT32, 100, PAIRS)};
    AUTO(free_at) struct worker *workers = calloc(THREADS, sizeof *workers);
    shared.shapes = take_shapes(shared.scene.store, NULL);
    if (!workers || pthread_barrier_init(&shared.start, NULL, THREADS) != 0)
        return false;
    for (int k = 0; k < THREADS; k++) {
        workers[k].shared = &shared;
        workers[k].question = &questions[(first + (size_t)k / 2) % question_count];
        workers[k].number = k;
        if (pthread_create(&workers[k].thread, NULL, work, &workers[k]) != 0)
            return false; /* and the process ends: the others would wait for ever */
    }
    bool same = true;
    for (int k = 0; k < THREADS; k++)
        pthread_join(workers[k].thread, NULL);
    for (int k = 0; k < THREADS; k++) {
        int like = 0;
        while (workers[like].question != workers[k].question)
            like++;
        same = same && !workers[k].failed && same_answers(&workers[k], &workers[like]) &&
               workers[k].count == (workers[k].question->row_size ? PAIRS : 0);
    }
    pthread_barrier_destroy(&shared.start);
    release_shapes(shared.shapes);
    destroy_scene(&shared.scene);
    return same;
}

/* Only a process that has made no call yet has a first call, so each round is one. exit(), not _exit(): a sanitizer
 * then gets to say its word through the exit status. */
static void race_in_children(bool switching) {
    for (size_t round = 0; round < ROUNDS; round++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0)
            exit(race(round * THREADS / 2, switching) ? 0 : 1);
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
    }
}

TEST(test_first_call) { race_in_children(false); }

TEST(test_switching) { race_in_children(true); }

int main(void) { return test_run("race", NULL, NULL); }
