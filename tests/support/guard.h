/* SPDX-License-Identifier: MIT
 *
 * guard.h - memory between pages that can't be touched: whoever reads or writes behind its end crashes at once.
 */
#ifndef NARC_TEST_GUARD_H
#define NARC_TEST_GUARD_H

#include <stddef.h>

#include "auto.h"
#include "narc_shapes.h"

/* `size` bytes that end where a forbidden page begins, filled with junk; what lies before them is watched. */
void *guard_allocate(size_t size);

/* Checks that nothing before the memory was written (behind it, nothing could be) and frees it. */
void guard_release(void *memory);
RELEASE_AT(guard_release)

/* A copy of something in such memory. */
void *guard_copy(const void *bytes, size_t size);

/* For a store: the same, aligned to 16 bytes. */
extern const narc_allocator guard_allocator;

/* The byte that junk is made of. As a float it is about -3e-16, as an index it is out of range. */
enum { GUARD_JUNK = 0xa5 };

#endif
