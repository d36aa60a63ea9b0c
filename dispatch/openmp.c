/* SPDX-License-Identifier: MIT
 *
 * openmp.c - the workers that are built in.
 */
#include "narc_workers.h"

#ifdef _OPENMP
#include <omp.h>
#endif

/* OpenMP ends the process if it cannot start as many threads as it was asked for. */
enum { MOST_THREADS = 256 };

#ifdef _OPENMP
static void run_in_team(void *context, unsigned task_count, void (*task)(void *argument, unsigned index),
                        void *argument) {
    (void)context;
#pragma omp parallel for schedule(static, 1) num_threads((int)task_count)
    for (unsigned index = 0; index < task_count; index++)
        task(argument, index);
}
#endif

narc_workers narc_openmp_workers(unsigned count) {
    narc_workers workers = {.count = 1};
#ifdef _OPENMP
    workers.count = count ? count : (unsigned)omp_get_max_threads();
    workers.run = run_in_team;
    if (workers.count > MOST_THREADS)
        workers.count = MOST_THREADS;
#else
    (void)count;
#endif
    return workers;
}
