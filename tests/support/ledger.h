/* SPDX-License-Identifier: MIT
 *
 * ledger.h - an allocator that keeps book, and may run out.
 */
#ifndef NARC_TEST_LEDGER_H
#define NARC_TEST_LEDGER_H

#include <stdbool.h>

#include "narc_broad_phase.h"

struct ledger {
    size_t allocations;
    size_t live, most; /* bytes that are given out, and the most there ever were */
    bool limited;      /* there are only `left` allocations more */
    size_t left;
};

/* Memory is junk when it is given, and when it is released, so that what still reads it shows. */
narc_allocator ledger_allocator(struct ledger *ledger);

/* An empty store of such memory. */
narc_shapes *ledger_store(struct ledger *ledger);

/* A broad phase of such memory, NULL if it has none; NULL: of malloc's. */
narc_broad_phase *create_broad_phase(struct ledger *ledger);

#endif
