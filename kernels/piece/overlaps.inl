/* SPDX-License-Identifier: MIT
 *
 * overlaps.inl - overlaps of pieces of chains: pairs of which the contact kernel has a row with a separation below 0.
 * It is asked when all other pairs are answered, so that neither's stack is added to the other's.
 */
#ifndef NARC_PIECE_OVERLAPS_INL
#define NARC_PIECE_OVERLAPS_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* Takes the pairs with a piece of those in the lanes `open`, the first of which is `pair`: sets their bits. Returns the
 * others. */
INLINE vm take_pieces(const struct call *call, size_t pair, vm open, const vf item[FIELDS]) {
    const vm pieces = vm_and(open, vm_or(has_mark(get_item_bits(item, INFO_A), NARC_PIECE_MARKS),
                                         has_mark(get_item_bits(item, INFO_B), NARC_PIECE_MARKS)));
    call->bits[pair / 64] |= (uint64_t)vm_bits(pieces) << pair % 64;
    return vm_and_not(open, pieces);
}

/* Pairs that are asked of at once. */
enum { PIECE_GROUP = 32 };

struct piece_pairs {
    size_t count;
    uint32_t pair[PIECE_GROUP], number[PIECE_GROUP];
    narc_contact contact[PIECE_GROUP];
};

/* Clears the bits of those that have no contact: rows come in the order of the pairs. */
static void ask_contacts(const narc_batch *batch, struct piece_pairs *pairs, uint64_t *bits) {
    size_t skipped = 0, more = 0, row = 0;
    const narc_query query = {.selection = {pairs->number, sizeof *pairs->number},
                              .front_only = batch->query->front_only};
    narc_batch selected = *batch;
    selected.query = &query;
    selected.more_at = NARC_MORE_AT(narc_contact, count);
    const narc_rows rows = {.base = (char *)pairs->contact, .stride = sizeof *pairs->contact, .more = &more};
    const size_t found = NARC_NAMED(contact)(&selected, 0, pairs->count, &skipped, &rows);
    for (size_t k = 0; k < pairs->count; k++) {
        const bool touches = row < found && pairs->contact[row].pair == pairs->number[k];
        row += touches;
        bits[pairs->pair[k] / 64] &= ~((uint64_t)!touches << pairs->pair[k] % 64);
    }
    pairs->count = 0;
}

/* Of pairs with a piece whose bits are set, clears those that do not overlap. */
NOINLINE void decide_piece_overlaps(const narc_batch *batch, size_t first, size_t count, uint64_t *bits) {
    struct piece_pairs pairs;
    pairs.count = 0;
    for (size_t word = 0; word < (count + 63) / 64; word++)
        for (uint64_t left = bits[word]; left; left &= left - 1) {
            const size_t pair = 64 * word + (size_t)FIND_LOWEST_64(left), number = narc_pair_at(batch, first + pair);
            if (!narc_is_piece(find_header(batch, batch->a, batch->pairs->a, number)) &&
                !narc_is_piece(find_header(batch, batch->b, batch->pairs->b, number)))
                continue;
            pairs.pair[pairs.count] = (uint32_t)pair;
            pairs.number[pairs.count++] = (uint32_t)number;
            if (pairs.count == PIECE_GROUP)
                ask_contacts(batch, &pairs, bits);
        }
    if (pairs.count > 0)
        ask_contacts(batch, &pairs, bits);
}

#endif
