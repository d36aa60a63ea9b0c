/* SPDX-License-Identifier: MIT
 *
 * call.inl - one call of a kernel: what its pairs bring, their numbers and margins; and answers of single bits.
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

/* What a row is (write_rows() in rows.inl). */
enum row_kind { CONTACT_ROWS, MANIFOLD_ROWS, SEPARATION_ROWS };

struct call {
    const narc_batch *batch;
    size_t first, count;       /* its pairs, of those that are asked of */
    float margin;              /* 0 for overlaps */
    narc_float_column margins; /* one for each pair of the batch; base NULL: all are `margin` */
    size_t *skipped;           /* pairs without an answer are added to it */
    uint64_t *bits;            /* overlap kernels: where the answers go; else NULL */
    struct rows *rows;         /* the others: the same */
    enum row_kind kind;        /* theirs */
    const struct question *question;
    struct box_queue *boxes;      /* pairs of forms that wait (box/box_detour.inl), or NULL */
    bool pieces, planes;          /* are there pieces of chains; half-planes? */
    bool *planes_first;           /* rows: set where a pair has one for A; or NULL */
    struct queue *concave, *runs; /* rows, with pieces: where pairs with a concave arc, with a run wait; or NULL */
    struct queue *settled;        /* with these: where pairs wait that touch, for certain */
};

/* Are there pieces of chains, and are they asked of as such? */
static inline bool has_pieces(const narc_batch *batch) {
    return NARC_PIECES && !batch->of_casts && batch->shapes->piece_count > 0;
}

static inline bool has_planes(const narc_batch *batch) { return NARC_PIECES && batch->shapes->plane_count > 0; }

/* One of two places, without a branch: which lanes have an answer can't be foreseen. */
INLINE char *choose(bool first, char *a, char *b) {
    const uintptr_t mask = (uintptr_t)0 - first;
    return (char *)(((uintptr_t)a & mask) | ((uintptr_t)b & ~mask));
}

/* The batch's number of a pair. */
INLINE size_t find_number(const struct call *call, int32_t pair) {
    if (BLOCK == 1) /* one pair by itself, whose number is known */
        return call->first;
    return narc_pair_at(call->batch, call->first + (uint32_t)pair);
}

INLINE vi find_numbers(const struct call *call, vi pairs) {
    int32_t number[V_WIDTH];
    if (BLOCK == 1)
        return vi_set((int32_t)(uint32_t)call->first);
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
    if (BLOCK == 1 || !call->margins.base)
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

#endif
