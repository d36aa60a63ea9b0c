/* SPDX-License-Identifier: MIT
 *
 * team.c - the built-in workers: who calls waits for nobody who has not begun; several callers share the helpers; the
 * child of a fork has its own. With NARC_TEST_CALLERS, another program: the callers alone.
 */
#define _POSIX_C_SOURCE 200809L
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdlib.h>
#include <string.h>
#include <sys/wait.h>
#include <time.h>
#include <unistd.h>

#include "narc.h"
#include "sanitizers.h"
#include "support.h"

enum { BODIES = 1000, PAIRS = 60000, CALLERS = 4, LONGEST = 120 /* seconds, before SIGALRM ends the program */ };

static narc_shapes *shapes;
static narc_body body[BODIES];
static uint32_t a[PAIRS], b[PAIRS];
static narc_contact expected[PAIRS];
static size_t expected_count;

static size_t ask(unsigned threads, narc_contact *rows) {
    const narc_workers workers = openmp_workers(threads);
    narc_bodies bodies;
    narc_view_bodies(body, BODIES, &bodies);
    const narc_pairs pairs = {.count = PAIRS, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
    size_t found = 0;
    narc_find_contacts(shapes, &bodies, &pairs, &(narc_query){.workers = &workers}, rows, PAIRS, &found, NULL);
    return found;
}

static bool is_answered(unsigned threads) {
    AUTO(free_at) narc_contact *rows = calloc(PAIRS, sizeof *rows);
    return rows && ask(threads, rows) == expected_count && memcmp(rows, expected, expected_count * sizeof *rows) == 0;
}

/* ------------------------------------------------------------------------------------------------ callers */

static void *call(void *argument) {
    bool *right = argument;
    *right = true;
    for (unsigned k = 0; k < test_trials(40); k++)
        *right = *right && is_answered(2 + k % 3);
    return NULL;
}

static void join_callers(pthread_t thread[CALLERS], const bool right[CALLERS]) {
    for (int k = 0; k < CALLERS; k++) {
        assert_int_equal(pthread_join(thread[k], NULL), 0);
        assert_true(right[k]);
    }
}

static void start_callers(pthread_t thread[CALLERS], bool right[CALLERS]) {
    for (int k = 0; k < CALLERS; k++)
        assert_int_equal(pthread_create(&thread[k], NULL, call, &right[k]), 0);
}

#if NARC_TEST_CALLERS

TEST(serves_several_callers) {
    pthread_t thread[CALLERS];
    bool right[CALLERS];
    start_callers(thread, right);
    join_callers(thread, right);
}

#else

/* ------------------------------------------------------------------------------------------------ tasks */

typedef struct counts {
    atomic_uint begun[300];
} counts;

static void count_task(void *argument, unsigned index) {
    counts *c = argument;
    atomic_fetch_add(&c->begun[index], 1);
}

TEST(runs_each_task_once) {
    const narc_workers workers = openmp_workers(4);
    for (unsigned count = 0; count <= 300 && workers.run; count++) {
        counts c = {0};
        workers.run(workers.context, count, count_task, &c);
        for (unsigned k = 0; k < 300; k++)
            assert_int_equal(c.begun[k], k < count);
    }
    assert_true(is_answered(0));
}

/* Two tasks of which neither ends before both have begun: they have two threads. */
typedef struct meeting {
    atomic_uint begun;
    pthread_t thread[2];
} meeting;

static void meet(void *argument, unsigned index) {
    meeting *m = argument;
    m->thread[index] = pthread_self();
    atomic_fetch_add(&m->begun, 1);
    while (atomic_load(&m->begun) < 2)
        nanosleep(&(struct timespec){.tv_nsec = 1000}, NULL);
}

/* Stopped where it is, as a thread is whose processor other programs have. */
static int stopped[2], released[2];
static void stop(int number) {
    char byte = (char)number;
    if (write(stopped[1], &byte, 1) == 1)
        while (read(released[0], &byte, 1) != 1)
            ;
}

TEST(waits_for_nobody_who_has_not_begun) {
    const narc_workers workers = openmp_workers(2);
    meeting m = {.begun = 0};
    char byte = 0;
    if (!workers.run || getenv("OMP_THREAD_LIMIT"))
        skip();
    workers.run(workers.context, 2, meet, &m);
    const pthread_t helper = m.thread[pthread_equal(m.thread[0], pthread_self()) ? 1 : 0];
    assert_false(pthread_equal(helper, pthread_self()));
    assert_int_equal(pipe(stopped) | pipe(released), 0);
    assert_int_equal(sigaction(SIGUSR1, &(struct sigaction){.sa_handler = stop}, NULL), 0);
    nanosleep(&(struct timespec){.tv_nsec = 50000000}, NULL); /* it sleeps by then, and holds no lock */
    assert_int_equal(pthread_kill(helper, SIGUSR1), 0);
    assert_int_equal(read(stopped[0], &byte, 1), 1);
    for (int k = 0; k < 20; k++)
        assert_true(is_answered(2));
    assert_int_equal(write(released[1], &byte, 1), 1);
    m.begun = 0; /* and it helps again */
    workers.run(workers.context, 2, meet, &m);
    assert_true(is_answered(2));
}

/* ------------------------------------------------------------------------------------------------ forks */

/* Asks in the child of a fork, in its child, and so on. Returns whether all were answered. */
static bool answers_in_children(int generations) {
    int status = 1;
    const pid_t child = fork();
    if (child == 0) {
        alarm(LONGEST); /* it is not inherited */
        _exit(!(is_answered(2) && is_answered(3) && (generations == 1 || answers_in_children(generations - 1))));
    }
    return child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status) && WEXITSTATUS(status) == 0;
}

TEST(answers_in_the_child_of_a_fork) {
    assert_true(is_answered(2));
    assert_true(answers_in_children(3));
    assert_true(is_answered(2)); /* the parent has its helpers */
}

/* While other threads call, whose jobs and locks the child has copies of. Not under a sanitizer: where a thread is being
 * started while another one forks, the child has a copy of the sanitizer's own lock, taken, and can start none. */
TEST(answers_in_children_of_busy_processes) {
    pthread_t thread[CALLERS];
    bool right[CALLERS];
    if (IS_SANITIZED)
        skip();
    start_callers(thread, right);
    for (int k = 0; k < 10; k++)
        assert_true(answers_in_children(1));
    join_callers(thread, right);
}

#endif

static int set_up(void **state) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    (void)state;
    alarm(LONGEST);
    for (uint32_t k = 0; k < BODIES; k++)
        body[k] = (narc_body){.x = 0.4 * k, .y = 0.01 * (k % 7), .cosine = 1, .scale = 1};
    for (uint32_t k = 0; k < PAIRS; k++) {
        a[k] = k % (BODIES - 3);
        b[k] = a[k] + 1 + k % 3;
    }
    if (narc_create_shapes(NULL, &shapes) || narc_build_circle(0.5, arcs, &count, NULL) ||
        narc_add_shape(shapes, arcs, count, NULL, NULL))
        return 1;
    expected_count = ask(1, expected);
    return expected_count == 0;
}

static int tear_down(void **state) {
    (void)state;
    narc_destroy_shapes(shapes);
    return 0;
}

int main(void) {
    return test_begin() ? test_run(NARC_TEST_CALLERS ? "callers" : "team", set_up, tear_down) : TEST_SKIPPED;
}
