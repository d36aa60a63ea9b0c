/* SPDX-License-Identifier: MIT
 *
 * workers.h - how work is spread over a caller's workers. Internal.
 */
#ifndef NARC_DISPATCH_WORKERS_H
#define NARC_DISPATCH_WORKERS_H

#include <stddef.h>

#include "narc_workers.h"

/* How many run at once of so many parts: at least 1. `workers` as the caller gave it, NULL too. */
unsigned narc_count_workers(const narc_workers *workers, size_t parts);

/* Calls part(argument, k) for each k below `parts`, once. They are begun in rising order; none waits for another, and
 * all have ended when this returns. With one worker, or one part, in the calling thread, without `workers->run`. */
typedef void narc_part(void *argument, size_t part);
void narc_run_parts(const narc_workers *workers, size_t parts, narc_part *part, void *argument);

/* The same for items: range(argument, part, first, end) for each part of `size` items first .. end - 1, of which the
 * last may have fewer. Returns how many parts there are. */
typedef void narc_range(void *argument, size_t part, size_t first, size_t end);
size_t narc_run_ranges(const narc_workers *workers, size_t count, size_t size, narc_range *range, void *argument);

#endif
