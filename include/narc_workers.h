/* SPDX-License-Identifier: MIT
 *
 * narc_workers.h - the threads that calls may use: the caller's own, or OpenMP's.
 *
 * A call that is given workers divides its work into tasks and has them run; without (NULL) it works in the calling
 * thread. Tasks never wait for each other, so that any `run` will do that calls each task once and returns when all
 * have ended: in a pool's threads, in the calling one, one after the other, in any order. The answer is the same, bit
 * for bit. Each task needs NARC_STACK_SIZE bytes of stack, and the calling thread as many beside what `run` takes.
 *
 *     static void run(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument)
 *         { for (unsigned index = 0; index < task_count; index++)
 *             submit(context, task, argument, index);
 *         wait(context);
 *     }
 *     narc_workers workers = {.context = pool, .count = 8, .run = run};
 */
#ifndef NARC_WORKERS_H
#define NARC_WORKERS_H

#include "narc_export.h"

#ifdef __cplusplus
extern "C" {
#endif

/*   context  handed to `run`
 *   count    how many tasks may run at once: the most that `run` is given. 0 or 1: the calling thread does all, and
 *            `run` is not called
 *   run      calls task(argument, index) for each index below task_count, once. It may be called from the calling
 *            thread only, several times in one call, and never within a task. Must not fail */
typedef struct narc_workers {
    void *context;
    unsigned count;
    void (*run)(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument);
} narc_workers;

/* OpenMP's threads, `count` of them at most, the caller's among them; 0: as many as OpenMP would use. Never more than 256.
 * In a build without OpenMP, and within a parallel region of it, the calling thread. The others begin with the first call
 * that wants them, help all callers, sleep between calls, and end with the process. A caller does itself what nobody has
 * taken, and waits for none but those that are within a task. The child of a fork has threads of its own. Thread-safe.
 * `out_workers` NULL: nothing happens. */
NARC_API void narc_openmp_workers(unsigned count, narc_workers *out_workers);

#ifdef __cplusplus
}
#endif

#endif
