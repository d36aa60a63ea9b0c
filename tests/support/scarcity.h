/* SPDX-License-Identifier: MIT
 *
 * scarcity.h - memory that runs out: malloc() and its like of a program that links this, or of one that loads it first
 * (see scarcity_preload.c). They stand before the C library's, also for the libraries below.
 */
#ifndef NARC_TEST_SCARCITY_H
#define NARC_TEST_SCARCITY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdlib.h>

#include "sanitizers.h"

/* Other C libraries have no name for their malloc(). */
#if defined(__GLIBC__) && !IS_SANITIZED
#define CAN_FAIL 1
#else
#define CAN_FAIL 0
#endif

struct scarcity {
    bool counts, forever;
    size_t count, denied;  /* allocations while it counts; the first that fails, from 1; 0: none */
    bool (*ignores)(void); /* one that does not count; NULL: all do */
    bool (*spares)(void);  /* one that would fail does not; NULL: none is spared */
};

/* Blocks that are given out, counted or not. */
extern size_t live_blocks;

extern struct scarcity scarcity;

#endif
