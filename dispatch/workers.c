/* SPDX-License-Identifier: MIT
 *
 * workers.c - how work is spread: parts that any number of threads take one after the other.
 */
#include "dispatch.h"

#include <stdatomic.h>

unsigned narc_count_workers(const narc_workers *workers, size_t parts) {
    const unsigned count = workers && workers->run && workers->count > 1 ? workers->count : 1;
    return count < parts ? count : parts > 0 ? (unsigned)parts : 1;
}

struct work {
    narc_part *part;
    void *argument;
    size_t parts;
    atomic_size_t next;
};

/* One task: takes part after part until none is left. */
static void take_parts(void *argument, unsigned index) {
    struct work *work = argument;
    (void)index;
    for (;;) {
        const size_t part = atomic_fetch_add_explicit(&work->next, 1, memory_order_relaxed);
        if (part >= work->parts)
            return;
        work->part(work->argument, part);
    }
}

void narc_run_parts(const narc_workers *workers, size_t parts, narc_part *part, void *argument) {
    const unsigned count = narc_count_workers(workers, parts);
    if (count <= 1) {
        for (size_t k = 0; k < parts; k++)
            part(argument, k);
        return;
    }
    struct work work = {.part = part, .argument = argument, .parts = parts};
    atomic_init(&work.next, 0);
    workers->run(workers->context, count, take_parts, &work);
}

struct ranges {
    narc_range *range;
    void *argument;
    size_t count, size;
};

static void run_range(void *argument, size_t part) {
    const struct ranges *ranges = argument;
    const size_t first = part * ranges->size, left = ranges->count - first;
    ranges->range(ranges->argument, part, first, first + (left < ranges->size ? left : ranges->size));
}

size_t narc_run_ranges(const narc_workers *workers, size_t count, size_t size, narc_range *range, void *argument) {
    struct ranges ranges = {range, argument, count, size};
    const size_t parts = count / size + (count % size != 0);
    narc_run_parts(workers, parts, run_range, &ranges);
    return parts;
}
