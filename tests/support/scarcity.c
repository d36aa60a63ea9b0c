/* SPDX-License-Identifier: MIT
 *
 * scarcity.c - allocations that fail.
 */
#include "scarcity.h"

#include <errno.h>

struct scarcity scarcity;

#if CAN_FAIL
extern void *__libc_malloc(size_t size);
extern void *__libc_calloc(size_t count, size_t size);
extern void *__libc_realloc(void *memory, size_t size);

static bool denies(void) {
    if (!scarcity.counts)
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

void *malloc(size_t size) { return denies() ? NULL : __libc_malloc(size); }

void *calloc(size_t count, size_t size) { return denies() ? NULL : __libc_calloc(count, size); }

void *realloc(void *memory, size_t size) { return denies() ? NULL : __libc_realloc(memory, size); }

#pragma GCC visibility pop
#endif
