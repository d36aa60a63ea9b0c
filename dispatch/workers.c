/* SPDX-License-Identifier: MIT
 *
 * workers.c - how work is spread: parts that any number of threads take one after the other.
 */
#include "workers.h"

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
