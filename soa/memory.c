/* SPDX-License-Identifier: MIT
 *
 * memory.c - the allocator that an object uses.
 */
#include "memory.h"

#include <stdlib.h>

static void *allocate_default(size_t size, void *context) {
    (void)context;
    return malloc(size);
}

static void release_default(void *memory, void *context) {
    (void)context;
    free(memory);
}

narc_allocator narc_choose_allocator(const narc_allocator *allocator) {
    return allocator ? *allocator : (narc_allocator){allocate_default, release_default, NULL};
}
