/* SPDX-License-Identifier: MIT
 *
 * openmp.c - the workers that are built in: OpenMP's threads, which help whoever calls.
 *
 * A parallel region for each call would not do. It ends when all of its threads have come to its end, so a caller waits,
 * spinning for milliseconds, for threads that have done nothing because other programs keep them from a processor. Here
 * is one region without an end, in a thread of its own. Its threads sleep where there is nothing to do. A caller begins at
 * once, does itself what nobody has taken, and waits for those alone that are within a task.
 */
#define _POSIX_C_SOURCE 200809L
#include "narc_workers.h"

#ifdef _OPENMP
#include <omp.h>
#include <pthread.h>
#include <sched.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <time.h>

/* OpenMP ends the process if it cannot start as many as it was asked for. */
enum { MOST_THREADS = 256 };

/* In nanoseconds. So long a helper looks for another call before it sleeps, as waking it takes some 50,000; it gives way to
 * all other threads meanwhile. So long, a part's time, a caller looks whether helpers end. Who is kept from a processor
 * for so long in a task, whose caller then waits, or while it looks, stays away: 10 ms, and twice as long each time. */
enum { LOOKING = 200000, ENDING = 20000, KEPT_OFF = 500000, SHORT_REST = 10000000, LONG_REST = 640000000 };

/* One call of run_in_team(), in its stack. */
typedef struct job {
    void (*task)(void *argument, unsigned index);
    void *argument;
    unsigned next, count; /* the first task that nobody has taken; the number of tasks */
    atomic_uint helpers;  /* who are within a task of it */
    struct job *older;
} job;

typedef struct team {
    pthread_mutex_t lock;         /* of all this, and of the jobs */
    pthread_cond_t posted, ended; /* there is a new job; no helper is within a job's tasks */
    job *newest;
    unsigned wanted, size, asleep; /* helpers: of all jobs together; in the region, or on their way; who sleep */
    atomic_uint posts;
} team;

#define NO_TEAM                                                                                                        \
    { .lock = PTHREAD_MUTEX_INITIALIZER, .posted = PTHREAD_COND_INITIALIZER, .ended = PTHREAD_COND_INITIALIZER }

static team all = NO_TEAM;

/* The child of a fork has none of the threads, and begins anew. */
static void forget_team(void) { all = (team)NO_TEAM; }

static int64_t read_clock(clockid_t clock) {
    struct timespec now;
    clock_gettime(clock, &now);
    return 1000000000 * (int64_t)now.tv_sec + now.tv_nsec;
}

/* How long this thread has not run in all. */
static int64_t find_idle_time(void) { return read_clock(CLOCK_MONOTONIC) - read_clock(CLOCK_THREAD_CPUTIME_ID); }

/* Does the next task of a job. The lock is held but in it. */
static void do_task(job *work) {
    const unsigned index = work->next++;
    pthread_mutex_unlock(&all.lock);
    work->task(work->argument, index);
    pthread_mutex_lock(&all.lock);
}

/* Looks for another call, without the lock. Returns whether other threads want the processor: has the thread been idle
 * since it was `before`? */
static bool look_for_posts(unsigned seen, int64_t before) {
    const int64_t end = read_clock(CLOCK_MONOTONIC) + LOOKING;
    while (find_idle_time() - before <= KEPT_OFF) {
        if (atomic_load_explicit(&all.posts, memory_order_relaxed) != seen || read_clock(CLOCK_MONOTONIC) > end)
            return false;
        sched_yield();
    }
    return true;
}

/* One that has a task which nobody has taken, or NULL. */
static job *find_open_job(void) {
    job *work = all.newest;
    while (work && work->next == work->count)
        work = work->older;
    return work;
}

static void help_for_ever(void) {
    int64_t idle = find_idle_time(), rest = SHORT_REST;
    pthread_mutex_lock(&all.lock);
    for (;;) {
        const unsigned seen = all.posts;
        bool helped = false;
        for (job *work; (work = find_open_job()) != NULL; helped = true) {
            atomic_fetch_add(&work->helpers, 1);
            do_task(work);
            if (atomic_fetch_sub(&work->helpers, 1) == 1)
                pthread_cond_broadcast(&all.ended);
        }
        pthread_mutex_unlock(&all.lock);
        if (look_for_posts(seen, idle)) {
            nanosleep(&(struct timespec){.tv_nsec = (long)rest}, NULL);
            rest = rest < LONG_REST ? 2 * rest : rest;
        } else if (helped)
            rest = SHORT_REST;
        pthread_mutex_lock(&all.lock);
        if (all.posts == seen) {
            all.asleep++;
            pthread_cond_wait(&all.posted, &all.lock);
            all.asleep--;
        }
        idle = find_idle_time();
    }
}

/* OpenMP has a place for each thread of a region, from that of the first one on: this one takes the caller's, and sleeps. */
static void *keep_region(void *helpers) {
    const int threads = (int)(uintptr_t)helpers + 1;
#pragma omp parallel num_threads(threads)
    {
        if (omp_get_thread_num() > 0)
            help_for_ever();
        static pthread_cond_t never = PTHREAD_COND_INITIALIZER;
        pthread_mutex_lock(&all.lock);
        for (;;)
            pthread_cond_wait(&never, &all.lock);
    }
    return NULL;
}

/* As many helpers as are wanted, if there can be so many. */
static void grow(void) {
    pthread_t thread;
    const unsigned size = all.wanted < MOST_THREADS ? all.wanted : MOST_THREADS;
    if (size <= all.size)
        return;
#ifndef _WIN32
    static bool watches_forks;
    if (!watches_forks)
        watches_forks = pthread_atfork(NULL, NULL, forget_team) == 0;
#endif
    if (pthread_create(&thread, NULL, keep_region, (void *)(uintptr_t)(size - all.size)) == 0) {
        pthread_detach(thread);
        all.size = size;
    }
}

static void post(job *work) {
    pthread_mutex_lock(&all.lock);
    work->older = all.newest;
    all.newest = work;
    all.wanted += work->count - 1;
    all.posts++;
    grow();
    const unsigned sleepers = all.asleep < work->count - 1 ? all.asleep : work->count - 1;
    pthread_mutex_unlock(&all.lock);
    for (unsigned k = 0; k < sleepers; k++)
        pthread_cond_signal(&all.posted);
}

/* Does what is left of a job, and returns when all of it has ended. */
static void finish(job *work) {
    pthread_mutex_lock(&all.lock);
    while (work->next < work->count)
        do_task(work);
    job **place = &all.newest;
    while (*place != work)
        place = &(*place)->older;
    *place = work->older;
    all.wanted -= work->count - 1;
    pthread_mutex_unlock(&all.lock);
    const int64_t end = read_clock(CLOCK_MONOTONIC) + ENDING;
    while (atomic_load(&work->helpers) > 0 && read_clock(CLOCK_MONOTONIC) < end)
        ;
    pthread_mutex_lock(&all.lock);
    while (work->helpers > 0)
        pthread_cond_wait(&all.ended, &all.lock);
    pthread_mutex_unlock(&all.lock);
}

static void run_in_team(void *context, unsigned task_count, void (*task)(void *argument, unsigned index),
                        void *argument) {
    job work = {.task = task, .argument = argument, .count = task_count};
    (void)context;
    if (task_count > 1 && !omp_in_parallel()) {
        post(&work);
        finish(&work);
    } else /* threads of other regions have no helpers */
        for (unsigned index = 0; index < task_count; index++)
            task(argument, index);
}
#endif

void narc_openmp_workers(unsigned count, narc_workers *out_workers) {
    narc_workers workers = {.count = 1};
#ifdef _OPENMP
    workers.count = count ? count : (unsigned)omp_get_max_threads();
    workers.run = run_in_team;
    if (workers.count > MOST_THREADS)
        workers.count = MOST_THREADS;
#else
    (void)count;
#endif
    if (out_workers)
        *out_workers = workers;
}
