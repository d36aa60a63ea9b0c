/* SPDX-License-Identifier: MIT
 *
 * overlaps.inl - overlaps of pieces of chains: those of which the contact kernel has a row with a separation below 0.
 */
#ifndef NARC_PIECE_OVERLAPS_INL
#define NARC_PIECE_OVERLAPS_INL

#include <stddef.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* They wait until there are so many; take_pieces() writes up to a vector behind the last one. */
enum { PIECE_FLUSH = 32 };

/* Pairs with a piece, counted from the first of the call, in their order. */
struct piece_pairs {
    int count;
    int32_t pair[PIECE_FLUSH + V_WIDTH];
};

/* Asks of all that wait. Rows come in the order of their pairs. */
NOINLINE void ask_contacts(const struct call *call) {
    struct piece_pairs *const pairs = call->pieces;
    uint32_t number[PIECE_FLUSH + V_WIDTH];
    narc_contact contact[PIECE_FLUSH + V_WIDTH];
    size_t skipped = 0, further = 0;
    for (int k = 0; k < pairs->count; k++)
        number[k] = (uint32_t)find_number(call, pairs->pair[k]);
    const narc_query query = {.selection = {number, sizeof *number}};
    narc_batch batch = *call->batch;
    batch.query = &query;
    batch.manifolds = false;
    const narc_rows rows = {.base = (char *)contact, .stride = sizeof *contact, .further = &further};
    const size_t found = NARC_NAMED(contact)(&batch, 0, (size_t)pairs->count, &skipped, &rows);
    size_t row = 0;
    for (int k = 0; k < pairs->count && row < found; k++) {
        const uint32_t pair = (uint32_t)pairs->pair[k];
        if (contact[row].pair == number[k]) {
            call->bits[pair / 64] |= (uint64_t)1 << pair % 64;
            row++;
        }
    }
    pairs->count = 0;
}

/* Takes the pairs with a piece of those in the lanes `open`, and returns the others. */
INLINE vm take_pieces(const struct call *call, vm open, const vf item[FIELDS]) {
    const unsigned marks = NARC_PIECE_RUN | NARC_PIECE_CONCAVE;
    const vm mine =
        vm_and(open, vm_or(has_mark(get_item_bits(item, INFO_A), marks), has_mark(get_item_bits(item, INFO_B), marks)));
    if (!vm_any(mine))
        return open;
    struct piece_pairs *const pairs = call->pieces;
    vi_store(pairs->pair + pairs->count, vi_bits(v_pack(vm_packing(mine), item[PAIR])));
    pairs->count += COUNT_BITS(vm_bits(mine));
    if (pairs->count >= PIECE_FLUSH)
        ask_contacts(call);
    return vm_and_not(open, mine);
}

/* Of stores with pieces, begins with no pair that waits. */
INLINE void start_pieces(struct call *call, struct piece_pairs *pairs) {
    pairs->count = 0;
    call->pieces = NARC_PIECES && call->batch->shapes->piece_count > 0 ? pairs : NULL;
}

/* Answers all that wait. */
INLINE void end_pieces(const struct call *call) {
    if (NARC_PIECES && call->pieces && call->pieces->count > 0)
        ask_contacts(call);
}

#endif
