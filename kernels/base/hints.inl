/* SPDX-License-Identifier: MIT
 *
 * hints.inl - what a call leaves for the next one: the arcs of A and B at which a pair's search ended, counted from 1
 * in the order of the store, A's in the lowest 8 bits. Any other value names no arcs.
 */
#ifndef NARC_BASE_HINTS_INL
#define NARC_BASE_HINTS_INL

#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "simd/simd.h"

/* The hint of two circles, which need none. */
#define FIRST_ARCS 0x0101

/* Where the hint of a pair is, by its number in the batch. */
INLINE uint32_t *find_hint(narc_hint_column column, int32_t number) {
    return (uint32_t *)(void *)((char *)column.base + (ptrdiff_t)(uint32_t)number * column.stride);
}

/* Leaves hints for pairs in the lanes `ended`. */
INLINE void put_hints(const struct call *call, vi pairs, vm ended, vi hints) {
    const narc_hint_column column = call->batch->query->hints;
    const uint32_t which = vm_bits(ended);
    int32_t number[V_WIDTH], hint[V_WIDTH];
    uint32_t spare;
    vi_store(number, find_numbers(call, pairs));
    vi_store(hint, hints);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        char *const place = (char *)find_hint(column, number[lane]);
        *(uint32_t *)(void *)choose(which >> lane & 1, place, (char *)&spare) = (uint32_t)hint[lane];
    }
}

INLINE vi make_hint(const struct queue *queue, int k, vi record_a, vi record_b) {
    const vi a = vi_sub(record_a, get_ring_a(queue, k).base), b = vi_sub(record_b, get_ring_b(queue, k).base);
    const vi both = vi_and(get_bits(queue, INFO_A, k), get_bits(queue, INFO_B, k));
    const vi hint = vi_add(vi_add(a, vi_set(1)), vi_shift_left(vi_add(b, vi_set(1)), 8));
    return vi_select(info_has(both, NARC_SHAPE_CIRCLE), vi_set(FIRST_ARCS), hint);
}

/* Leaves hints for the pairs k ... of a queue in the lanes `ended`, if hints are wanted. */
INLINE void store_hints(const struct call *call, const struct queue *queue, int k, vm ended, vi record_a, vi record_b) {
    if (call->batch->query->hints.base)
        put_hints(call, get_bits(queue, PAIR, k), ended, make_hint(queue, k, record_a, record_b));
}

/* Takes the arcs of the pairs `begin` ... of a queue from their hints, in lanes where these name arcs that exist. */
INLINE void read_hints(const struct call *call, struct queue *queue, int begin) {
    const narc_hint_column column = call->batch->query->hints;
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
        int32_t number[V_WIDTH], lane[V_WIDTH];
        vi_store(number, find_numbers(call, get_bits(queue, PAIR, k))); /* lanes behind the last pair have pair 0 */
        for (int l = 0; l < V_WIDTH; l++)
            lane[l] = (int32_t)*find_hint(column, number[l]);
        const vi hint = vi_load(lane), zero = vi_set(0), one = vi_set(1);
        const vi a = vi_and(hint, vi_set(0xff)), b = vi_shift_right(hint, 8);
        const vm exists_a = vm_and_not(vi_lt(zero, a), vi_lt(ring_a.count, a));
        const vm exists_b = vm_and_not(vi_lt(zero, b), vi_lt(ring_b.count, b));
        const vm exist = vm_and(exists_a, exists_b);
        vi_store(queue->record_a + k, vi_add(ring_a.base, vi_select(exist, vi_sub(a, one), zero)));
        vi_store(queue->record_b + k, vi_add(ring_b.base, vi_select(exist, vi_sub(b, one), zero)));
        vi_store(queue->hinted + k, vi_select(exist, one, zero));
    }
}

#endif
