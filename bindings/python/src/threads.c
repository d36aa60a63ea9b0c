/* SPDX-License-Identifier: MIT
 *
 * threads.c - the caller and its helpers take tasks until none is left.
 */
#include "threads.h"

#include <pthread.h>
#include <stdatomic.h>

typedef struct work {
    void (*task)(void *argument, unsigned index);
    void *argument;
    unsigned count;
    atomic_uint next;
} work;

static void *take_tasks(void *argument) {
    work *const w = argument;
    for (unsigned index; (index = atomic_fetch_add(&w->next, 1)) < w->count;)
        w->task(w->argument, index);
    return NULL;
}

void run_in_threads(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument) {
    work w = {.task = task, .argument = argument, .count = task_count};
    pthread_t helpers[MOST_THREADS];
    unsigned count = 0;
    (void)context;
    /* where no more threads are to be had, those that there are do all */
    while (count + 1 < task_count && count < MOST_THREADS && !pthread_create(&helpers[count], NULL, take_tasks, &w))
        count++;
    take_tasks(&w);
    while (count > 0)
        pthread_join(helpers[--count], NULL);
}
