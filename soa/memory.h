/* SPDX-License-Identifier: MIT
 *
 * memory.h - the allocator that an object uses. Internal.
 */
#ifndef NARC_MEMORY_H
#define NARC_MEMORY_H

#include "narc_shapes.h"

/* The caller's allocator, or malloc() and free() for NULL. */
narc_allocator narc_choose_allocator(const narc_allocator *allocator);

#endif
