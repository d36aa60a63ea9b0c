/* SPDX-License-Identifier: MIT
 *
 * ledger.c - an allocator that keeps book, and may run out.
 */
#include "ledger.h"

#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "support.h"

enum { HEADER = 16 }; /* holds the size, and keeps the alignment */

static void *allocate(size_t size, void *context) {
    struct ledger *ledger = context;
    if (ledger->limited && ledger->left == 0)
        return NULL;
    size_t *start = malloc(size + HEADER);
    assert_non_null(start);
    *start = size;
    ledger->left -= ledger->limited;
    ledger->allocations++;
    ledger->live += size;
    ledger->most = ledger->live > ledger->most ? ledger->live : ledger->most;
    return memset((char *)start + HEADER, GUARD_JUNK, size);
}

static void release(void *memory, void *context) {
    struct ledger *ledger = context;
    assert_non_null(memory);
    AUTO(free_at) size_t *start = (size_t *)(void *)((char *)memory - HEADER);
    ledger->live -= *start;
    memset(memory, GUARD_JUNK, *start);
}

narc_allocator ledger_allocator(struct ledger *ledger) { return (narc_allocator){allocate, release, ledger}; }

narc_shapes *ledger_store(struct ledger *ledger) {
    const narc_allocator allocator = ledger_allocator(ledger);
    narc_shapes *shapes = NULL;
    assert_int_equal(narc_create_shapes(&allocator, &shapes), NARC_OK);
    return shapes;
}

narc_broad_phase *create_broad_phase(struct ledger *ledger) {
    const narc_allocator allocator = ledger_allocator(ledger);
    narc_broad_phase *broad = NULL;
    const narc_status status = narc_create_broad_phase(ledger ? &allocator : NULL, &broad);
    assert_int_equal(status, broad ? NARC_OK : NARC_ERROR_MEMORY);
    return broad;
}
