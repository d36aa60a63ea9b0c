/* SPDX-License-Identifier: MIT
 *
 * hints.inl - what a call leaves for the next one: the arcs of A and B at which a pair's search ended, counted from 1
 * in the order of the store, A's in the lowest 8 bits. Any other value names no arcs.
 */
#ifndef NARC_BASE_HINTS_INL
#define NARC_BASE_HINTS_INL

#include <stdint.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "simd/simd.h"

/* The hint of two circles, which need none. */
#define FIRST_ARCS 0x0101

INLINE vi make_hint(const struct queue *queue, int k, vi record_a, vi record_b) {
    const vi a = vi_sub(record_a, get_ring_a(queue, k).base), b = vi_sub(record_b, get_ring_b(queue, k).base);
    const vi both = vi_and(get_bits(queue, INFO_A, k), get_bits(queue, INFO_B, k));
    const vi hint = vi_add(vi_add(a, vi_set(1)), vi_shift_left(vi_add(b, vi_set(1)), 8));
    return vi_select(info_has(both, NARC_SHAPE_CIRCLE), vi_set(FIRST_ARCS), hint);
}

/* Takes the arcs of all pairs of a queue from their hints, in lanes where these name arcs that exist. */
INLINE void read_hints(struct queue *queue, const uint32_t *hints) {
    for (int k = 0; k < queue->count; k += V_WIDTH) {
        const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
        int32_t pair[V_WIDTH], lane[V_WIDTH];
        get_pairs(queue, k, pair);
        for (int l = 0; l < V_WIDTH; l++)
            lane[l] = (int32_t)hints[pair[l]];
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
