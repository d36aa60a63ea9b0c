/* SPDX-License-Identifier: MIT
 *
 * threads.h - threads for one call: begun when it asks, ended before it returns, so that a fork has none to miss.
 */
#ifndef NARC_THREADS_H
#define NARC_THREADS_H

#include <narc_workers.h>

enum { MOST_THREADS = 256 };

/* narc_workers.run */
void run_in_threads(void *context, unsigned task_count, void (*task)(void *argument, unsigned index), void *argument);

#endif
