/* SPDX-License-Identifier: MIT
 *
 * counting.h - an allocator that counts, and fails when it is told to.
 */
#ifndef NARC_TEST_COUNTING_H
#define NARC_TEST_COUNTING_H

#include <stdlib.h>

#include "narc_broad_phase.h"
#include "support.h"

struct counter {
    size_t allocations, bytes;
    size_t left; /* to be made before the next one fails */
};

static inline void *counted_allocate(size_t size, void *context) {
    struct counter *counter = context;
    if (counter->left == 0)
        return NULL;
    counter->left--;
    counter->allocations++;
    counter->bytes += size;
    return malloc(size);
}

static inline void counted_release(void *memory, void *context) {
    (void)context;
    free(memory);
}

/* NULL if its own memory fails. Without a counter memory is malloc's. */
static inline narc_broad_phase *create_broad_phase(struct counter *counter) {
    const narc_allocator allocator = {counted_allocate, counted_release, counter};
    narc_broad_phase *broad = NULL;
    const narc_status status = narc_create_broad_phase(counter ? &allocator : NULL, &broad);
    assert_int_equal(status, broad ? NARC_OK : NARC_ERROR_MEMORY);
    return broad;
}

#endif
