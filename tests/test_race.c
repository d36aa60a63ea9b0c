/* SPDX-License-Identifier: MIT
 *
 * test_race.c - the first call of a process from many threads at once, and the choice of an instruction set under
 * way. Says most under a thread sanitizer.
 */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <unistd.h>

#include "scene.h"

enum { THREADS = 8, ROUNDS = 12, PAIRS = 300 };

struct shared {
    struct scene scene;
    pthread_barrier_t start;
    bool switching; /* threads with an odd number choose instruction sets all the time */
};

struct worker {
    struct shared *shared;
    int number;
    uint64_t bits[NARC_BIT_WORDS(PAIRS)];
    float separation[PAIRS];
    size_t count;
    bool failed;
    pthread_t thread;
};

static void *work(void *argument) {
    struct worker *w = argument;
    const struct scene *scene = &w->shared->scene;
    narc_bodies bodies = scene_bodies(scene);
    narc_pairs pairs = scene_pairs(scene);
    narc_contacts contacts = {.capacity = PAIRS, .separation = w->separation};
    pthread_barrier_wait(&w->shared->start);
    bool chooses = w->shared->switching && w->number % 2;
    for (size_t k = 0; chooses && k < 40; k++) {
        const char *name = narc_isa_name(k % 4);
        narc_status status = narc_set_isa(name, NULL);
        w->failed = w->failed || status != (narc_isa_supported(name) ? NARC_OK : NARC_ERROR_ISA_UNSUPPORTED);
    }
    w->failed = w->failed || narc_find_overlaps(scene->store, &bodies, &pairs, 1, w->bits, NULL) != NARC_OK;
    w->failed =
        w->failed || narc_find_contacts(scene->store, &bodies, &pairs, 0, 1, &contacts, &w->count, NULL) != NARC_OK;
    w->failed = w->failed || !narc_get_isa();
    return NULL;
}

/* In a fresh process. Returns whether all threads got the same answer. */
static bool race(bool switching) {
    struct test_random random = test_random_named("race");
    struct shared shared = {.scene = make_random_scene(&random, NARC_FLOAT32, 100, PAIRS), .switching = switching};
    struct worker *workers = calloc(THREADS, sizeof(*workers));
    bool same = workers && pthread_barrier_init(&shared.start, NULL, THREADS) == 0;
    for (int k = 0; same && k < THREADS; k++) {
        workers[k].shared = &shared;
        workers[k].number = k;
        if (pthread_create(&workers[k].thread, NULL, work, &workers[k]) != 0) {
            return false; /* and the process ends: the others would wait for ever */
        }
    }
    for (int k = 0; same && k < THREADS; k++) {
        pthread_join(workers[k].thread, NULL);
    }
    for (int k = 0; same && k < THREADS; k++) {
        same = !workers[k].failed && workers[k].count == workers[0].count && workers[0].count > 0 &&
               memcmp(workers[k].bits, workers[0].bits, sizeof(workers[0].bits)) == 0 &&
               memcmp(workers[k].separation, workers[0].separation, workers[0].count * sizeof(float)) == 0;
    }
    pthread_barrier_destroy(&shared.start);
    destroy_scene(&shared.scene);
    free(workers);
    return same;
}

/* Only a process that has made no call yet has a first call, so each round is one. exit(), not _exit(): a sanitizer
 * then gets to say its word through the exit status. */
static void race_in_children(bool switching) {
    for (int round = 0; round < ROUNDS; round++) {
        pid_t child = fork();
        assert_true(child >= 0);
        if (child == 0) {
            exit(race(switching) ? 0 : 1);
        }
        int status;
        assert_int_equal(waitpid(child, &status, 0), child);
        assert_true(WIFEXITED(status));
        assert_int_equal(WEXITSTATUS(status), 0);
    }
}

static void test_first_call(void **state) {
    (void)state;
    race_in_children(false);
}

static void test_switching(void **state) {
    (void)state;
    race_in_children(true);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(test_first_call),
        cmocka_unit_test(test_switching),
    };
    return cmocka_run_group_tests_name("race", tests, NULL, NULL);
}
