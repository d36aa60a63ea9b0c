/* SPDX-License-Identifier: MIT
 *
 * call.inl - one call of a kernel: what its pairs bring, their numbers, margins and hints; and answers of single bits.
 */
#ifndef NARC_BASE_CALL_INL
#define NARC_BASE_CALL_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/queue.inl"
#include "column.h"
#include "kernels.h"
#include "simd/simd.h"

struct call {
    const narc_batch *batch;
    size_t first, count;             /* its pairs, of those that are asked of */
    float margin;                    /* 0 for overlaps */
    narc_float_column margins;       /* one for each pair of the batch; base NULL: all are `margin` */
    size_t *skipped;                 /* pairs without an answer are added to it */
    uint64_t *bits;                  /* overlap kernels: where the answers go; else NULL */
    struct rows *rows;               /* the others: the same */
    const struct question *question; /* theirs */
    struct box_queue *boxes;         /* pairs of boxes and of capsules that wait (box/box_detour.inl), or NULL */
    bool pieces;                     /* are there pieces of chains? */
    struct queue *concave;           /* rows, with pieces: where pairs with a concave arc wait; else NULL */
};

/* Are there pieces of chains, and are they asked of as such? */
static inline bool has_pieces(const narc_batch *batch) {
    return NARC_PIECES && !batch->of_casts && batch->shapes->piece_count > 0;
}

/* One of two places, without a branch: which lanes have an answer can't be foreseen. */
INLINE char *choose(bool first, char *a, char *b) {
    const uintptr_t mask = (uintptr_t)0 - first;
    return (char *)(((uintptr_t)a & mask) | ((uintptr_t)b & ~mask));
}

/* The batch's number of a pair. */
INLINE size_t find_number(const struct call *call, int32_t pair) {
    return narc_pair_at(call->batch, call->first + (uint32_t)pair);
}

INLINE vi find_numbers(const struct call *call, vi pairs) {
    int32_t number[V_WIDTH];
    if (!call->batch->query->selection.base)
        return vi_add(pairs, vi_set((int32_t)(uint32_t)call->first));
    const uint32_t count = (uint32_t)call->count; /* lanes that are not of a pair may have any */
    vi_store(number, pairs);
    for (int lane = 0; lane < V_WIDTH; lane++)
        number[lane] = (int32_t)(uint32_t)find_number(call, (uint32_t)number[lane] < count ? number[lane] : 0);
    return vi_load(number);
}

/* The margin of a pair, counted from the first of the call. */
INLINE float find_margin(const struct call *call, int32_t pair) {
    return call->margins.base ? narc_float_at(call->margins, find_number(call, pair)) : call->margin;
}

/* The margins of pairs. */
INLINE vf find_margins(const struct call *call, vi pairs) {
    int32_t pair[V_WIDTH];
    float lane[V_WIDTH];
    if (!call->margins.base)
        return v_set(call->margin);
    vi_store(pair, pairs);
    for (int l = 0; l < V_WIDTH; l++)
        lane[l] = find_margin(call, pair[l]);
    return v_load(lane);
}

/* The same for the pairs k ... of a queue. */
INLINE vf get_margins(const struct call *call, const struct queue *queue, int k) {
    return find_margins(call, get_bits(queue, PAIR, k));
}

/* With an infinite margin every separation counts, an infinite one too. */
INLINE vm is_below(vf separation, vf margin) { return vm_or(v_lt(separation, margin), v_le(v_set(INFINITY), margin)); }

/* Sets the bits of pairs in the lanes `hits`. */
INLINE void mark_pairs(const struct call *call, vi pairs, vm hits) {
    int32_t pair[V_WIDTH];
    vi_store(pair, pairs);
    for (uint32_t lanes = vm_bits(hits); lanes; lanes &= lanes - 1) {
        const uint32_t number = (uint32_t)pair[FIND_LOWEST(lanes)];
        call->bits[number / 64] |= (uint64_t)1 << number % 64;
    }
}

/* The same for the pairs k ... of a queue. */
INLINE void mark_overlaps(const struct call *call, const struct queue *queue, int k, vm hits) {
    mark_pairs(call, get_bits(queue, PAIR, k), hits);
}

/* ------------------------------------------------------------------------------------------------ hints
 *
 * What a call leaves for the next one: the arcs of A and B at which a pair's search ended, counted from 1 in the order of
 * the store, A's in the lowest 8 bits. Any other value names no arcs. */

/* The hint of two circles, boxes, capsules or polygons of few corners, which need none. */
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
    return vi_select(has_flag(both, NARC_SHAPE_CIRCLE), vi_set(FIRST_ARCS), hint);
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
