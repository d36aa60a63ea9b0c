/* SPDX-License-Identifier: MIT
 *
 * threads.c - the caller and the pool's threads take tasks until none is left.
 */
#include "threads.h"

#include <pthread.h>
#include <stdatomic.h>

/* What a caller wants done; it lies on the caller's stack, who waits until nobody works on it. */
typedef struct work {
    void (*task)(void *argument, unsigned index);
    void *argument;
    unsigned count;
    atomic_uint next;
    unsigned helpers; /* that are at it */
    struct work *other;
} work;

static pthread_mutex_t lock = PTHREAD_MUTEX_INITIALIZER;
static pthread_cond_t wanted = PTHREAD_COND_INITIALIZER, ended = PTHREAD_COND_INITIALIZER;
static work *open; /* what helpers may come to */
static unsigned pool_size;
static int forks_under_way;

static void take_tasks(work *w) {
    for (unsigned index; (index = atomic_fetch_add(&w->next, 1)) < w->count;)
        w->task(w->argument, index);
}

/* With the lock: what still has tasks that nobody took. */
static work *find_work(void) {
    work *w = open;
    while (w && atomic_load(&w->next) >= w->count)
        w = w->other;
    return w;
}

static void *help(void *unused) {
    (void)unused;
    pthread_mutex_lock(&lock);
    for (;;) {
        work *w;
        while (!(w = find_work()))
            pthread_cond_wait(&wanted, &lock);
        w->helpers++;
        pthread_mutex_unlock(&lock);
        take_tasks(w);
        pthread_mutex_lock(&lock);
        if (--w->helpers == 0)
            pthread_cond_broadcast(&ended);
    }
    return NULL;
}

/* With the lock: as many helpers as all callers want. Where no more threads are to be had, those that there are do all. */
static void want_helpers(void) {
    pthread_attr_t detached;
    pthread_t made;
    unsigned count = 0;
    for (const work *w = open; w; w = w->other)
        count += w->count - 1;
    if (pool_size >= count || pthread_attr_init(&detached))
        return;
    pthread_attr_setdetachstate(&detached, PTHREAD_CREATE_DETACHED);
    while (pool_size < count && pool_size < MOST_THREADS && !pthread_create(&made, &detached, help, NULL))
        pool_size++;
    pthread_attr_destroy(&detached);
}

void run_in_threads(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument) {
    work w = {.task = task, .argument = argument, .count = task_count};
    (void)context;
    pthread_mutex_lock(&lock);
    w.other = open;
    open = &w;
    want_helpers();
    pthread_cond_broadcast(&wanted);
    pthread_mutex_unlock(&lock);
    take_tasks(&w);
    pthread_mutex_lock(&lock);
    work **at = &open;
    while (*at != &w)
        at = &(*at)->other;
    *at = w.other;
    while (w.helpers > 0)
        pthread_cond_wait(&ended, &lock);
    pthread_mutex_unlock(&lock);
}

void before_fork(void) {
    if (forks_under_way++ == 0)
        pthread_mutex_lock(&lock);
}

bool after_fork(bool is_child) {
    if (forks_under_way == 0)
        return false;
    forks_under_way = is_child ? 0 : forks_under_way - 1;
    if (is_child) {
        open = NULL;
        pool_size = 0;
        wanted = (pthread_cond_t)PTHREAD_COND_INITIALIZER;
        ended = (pthread_cond_t)PTHREAD_COND_INITIALIZER;
    }
    if (forks_under_way == 0)
        pthread_mutex_unlock(&lock);
    return is_child;
}
