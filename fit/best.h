/* SPDX-License-Identifier: MIT
 *
 * best.h - the best chain over all starts. Internal.
 */
#ifndef NARC_FIT_BEST_H
#define NARC_FIT_BEST_H

#include "search.h"

/* Counts the work of a fit, for the caller's progress function. */
typedef struct progress {
    bool (*tell)(size_t done, size_t total, void *context);
    void *context;
    size_t done, total;
    bool cancelled;
} progress;

/* One piece of work is done. False if the caller wants no more. */
bool narc_advance(progress *of);

/* How many pieces of work narc_find_best() does at most with so many starts. */
size_t narc_count_work(unsigned starts);

/* Searches from `starts` starts, and from `known_count` chains of the same number of arcs: the best is no worse than
 * any of these. NARC_ERROR_NO_SOLUTION if nothing was found, NARC_ERROR_CANCELLED if nothing was found in time. */
narc_status narc_find_best(const problem *of, unsigned starts, const chain *known, size_t known_count, progress *work,
                           candidate *out_best, narc_error *error);

#endif
