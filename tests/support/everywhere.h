/* SPDX-License-Identifier: MIT
 *
 * everywhere.h - one question to every instruction set.
 */
#ifndef NARC_TEST_EVERYWHERE_H
#define NARC_TEST_EVERYWHERE_H

#include <stddef.h>

#include "narc_workers.h"

/* `isa` gave another byte than `first`, the first instruction set, did. */
struct difference {
    const char *isa, *first; /* NULL: none */
    size_t at;
};

/* Calls `ask` on each instruction set that there is. It fills `size` bytes of junk, which must come out the same, and are
 * returned for the caller to free. `workers` is NULL, or runs its tasks last to first. What differs goes to `out`; NULL:
 * it fails the test. */
void *ask_everywhere(void (*ask)(const void *question, const narc_workers *workers, void *out_rows),
                     const void *question, size_t size, struct difference *out);

#endif
