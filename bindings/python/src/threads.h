/* SPDX-License-Identifier: MIT
 *
 * threads.h - a pool of threads for calls that ask for more than one. They begin with the first call that wants them, help
 * all callers, sleep between calls, and end with the process.
 */
#ifndef NARC_THREADS_H
#define NARC_THREADS_H

#include <stdbool.h>

#include <narc_workers.h>

enum { MOST_THREADS = 256 };

/* narc_workers.run */
void run_in_threads(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument);

/* Around a fork, whose child begins threads of its own; with Python's lock, which is given up between the two: several threads
 * may fork at a time. The second is true once in a child. */
void before_fork(void);
bool after_fork(bool is_child);

#endif
