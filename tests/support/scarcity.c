/* SPDX-License-Identifier: MIT
 *
 * scarcity.c - allocations that fail.
 */
#define _POSIX_C_SOURCE 200809L /* posix_memalign */
#include "scarcity.h"

#include <errno.h>

struct scarcity scarcity;
size_t live_blocks;

#if CAN_FAIL
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);
extern void *__libc_memalign(size_t alignment, size_t size);
extern void __libc_free(void *memory);

static void *keep_book(void *memory) {
    if (memory)
        __atomic_add_fetch(&live_blocks, 1, __ATOMIC_RELAXED);
    return memory;
}

static bool denies(void) {
    if (!scarcity.counts || (scarcity.ignores && scarcity.ignores()))
        return false;
    const size_t number = __atomic_add_fetch(&scarcity.count, 1, __ATOMIC_RELAXED);
    const bool denied =
        scarcity.denied > 0 && (scarcity.forever ? number >= scarcity.denied : number == scarcity.denied);
    if (!denied || (scarcity.spares && scarcity.spares()))
        return false;
    errno = ENOMEM;
    return true;
}

#pragma GCC visibility push(default) /* the libraries below take these too */

void *malloc(size_t size) { return denies() ? NULL : keep_book(__libc_malloc(size)); }

void *calloc(size_t count, size_t size) { return denies() ? NULL : keep_book(__libc_calloc(count, size)); }

void *realloc(void *memory, size_t size) {
    if (denies())
        return NULL;
    return memory ? __libc_realloc(memory, size) : keep_book(__libc_malloc(size));
}

void *aligned_alloc(size_t alignment, size_t size) {
    return denies() ? NULL : keep_book(__libc_memalign(alignment, size));
}

int posix_memalign(void **out, size_t alignment, size_t size) {
    void *const memory = aligned_alloc(alignment, size);
    if (!memory)
        return ENOMEM;
    *out = memory;
    return 0;
}

void free(void *memory) {
    if (memory)
        __atomic_sub_fetch(&live_blocks, 1, __ATOMIC_RELAXED);
    __libc_free(memory);
}

#pragma GCC visibility pop
#endif
