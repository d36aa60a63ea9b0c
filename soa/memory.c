/* SPDX-License-Identifier: MIT
 *
 * memory.c - the allocator that an object uses.
 */
#ifdef __linux__
#define _DEFAULT_SOURCE /* madvise */
#include <errno.h>
#include <sys/mman.h>
#include <unistd.h>
#endif

#include "memory.h"

#include <stdint.h>
#include <stdlib.h>

/* What is large is read here and there: of large pages, where the system has some, the processor knows where most of them are. */
static void *allocate_default(size_t size, void *context) {
    (void)context;
    char *const memory = malloc(size);
#ifdef MADV_HUGEPAGE
    if (memory && size >= (size_t)1 << 21) {
        const size_t before = (uintptr_t)memory % (uintptr_t)sysconf(_SC_PAGESIZE);
        const int error = errno; /* where there are none it is another, and nothing has failed */
        (void)madvise(memory - before, size + before, MADV_HUGEPAGE);
        errno = error;
    }
#endif
    return memory;
}

static void release_default(void *memory, void *context) {
    (void)context;
    free(memory);
}

narc_allocator narc_choose_allocator(const narc_allocator *allocator) {
    return allocator ? *allocator : (narc_allocator){allocate_default, release_default, NULL};
}
