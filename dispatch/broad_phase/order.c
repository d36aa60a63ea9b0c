/* SPDX-License-Identifier: MIT
 *
 * order.c - the last steps of narc_find_pairs(): the filter, and the order of the pairs.
 */
#include "column.h"
#include "dispatch.h"
#include "steps.h"

#include <string.h>

static void put_in_order(uint32_t *one, uint32_t *other) {
    const uint32_t low = *one < *other ? *one : *other, high = *one < *other ? *other : *one;
    *one = low;
    *other = high;
}

/* ------------------------------------------------------------------------------------------------ filter */

/* Two static bodies do not meet, nor do two sensors. */
static bool lets_pair(const narc_pair_filter *filter, uint32_t a, uint32_t b) {
    const narc_body_filter one = narc_read_filter(filter, a), other = narc_read_filter(filter, b);
    return one.world == other.world && !(one.kind & other.kind & (NARC_STATIC | NARC_SENSOR)) &&
           (one.owner == UINT32_MAX || one.owner != other.owner) && (one.category & other.mask) != 0 &&
           (other.category & one.mask) != 0;
}

uint32_t narc_filter_pairs(const narc_pair_filter *filter, uint32_t *a, uint32_t *b, uint32_t first, uint32_t count) {
    for (uint32_t k = first; k < count; k++)
        put_in_order(&a[k], &b[k]);
    if (!filter)
        return count;
    uint32_t left = first;
    for (uint32_t k = first; k < count; k++) {
        a[left] = a[k];
        b[left] = b[k];
        left += lets_pair(filter, a[left], b[left]);
    }
    return left;
}

/* ------------------------------------------------------------------------------------------------ order */

enum { FOUR = 4 };

/* Sorts the first `count` of four items and leaves the others, without a branch: how many partners a body has is hard
 * to predict. */
static void sort_four(uint32_t *list, uint32_t count) {
    uint32_t sorted[FOUR];
    for (uint32_t k = 0; k < FOUR; k++)
        sorted[k] = k < count ? list[k] : UINT32_MAX;
    put_in_order(&sorted[0], &sorted[1]);
    put_in_order(&sorted[2], &sorted[3]);
    put_in_order(&sorted[0], &sorted[2]);
    put_in_order(&sorted[1], &sorted[3]);
    put_in_order(&sorted[1], &sorted[2]);
    for (uint32_t k = 0; k < FOUR; k++)
        list[k] = k < count ? sorted[k] : list[k];
}

static bool is_less(const void *context, uint32_t one, uint32_t other) {
    (void)context;
    return one < other;
}

/* Where bodies are numbered as they lie, few blocks hold pairs of more than one thread's bodies. */
static bool has_pairs_of(const narc_pair_block *block, uint32_t first, uint32_t end) {
    return block->lowest_a < end && block->highest_a >= first;
}

/* Counts the partners of bodies first .. end - 1. */
static void count_partners(const narc_broad_phase *broad, size_t blocks, uint32_t first, uint32_t end) {
    uint32_t *const ends = broad->ends;
    for (size_t block = 0; block < blocks; block++) {
        const uint32_t *const a = broad->pair_a + block * NARC_PAIR_BLOCK;
        const uint32_t count = broad->blocks[block].count;
        if (!has_pairs_of(&broad->blocks[block], first, end))
            continue;
        for (uint32_t k = 0; k < count; k++)
            if (a[k] - first < end - first)
                ends[a[k]]++;
    }
}

/* Puts the partners of these bodies where `ends` says, and moves it on. */
static void place_partners(const narc_broad_phase *broad, size_t blocks, uint32_t first, uint32_t end,
                           uint32_t *out_b) {
    uint32_t *const ends = broad->ends;
    for (size_t block = 0; block < blocks; block++) {
        const uint32_t *const a = broad->pair_a + block * NARC_PAIR_BLOCK;
        const uint32_t *const b = broad->pair_b + block * NARC_PAIR_BLOCK;
        const uint32_t count = broad->blocks[block].count;
        if (!has_pairs_of(&broad->blocks[block], first, end))
            continue;
        for (uint32_t k = 0; k < count; k++)
            if (a[k] - first < end - first)
                out_b[ends[a[k]]++] = b[k];
    }
}

/* The most parts of the bodies. */
enum { MOST_PARTS = 256 };

typedef struct order {
    narc_broad_phase *broad;
    size_t blocks;
    uint32_t *out_a, *out_b;
    uint32_t start[MOST_PARTS + 1]; /* of each part's pairs; how many the part before has, until all are counted */
} order;

static void count_part(void *argument, size_t part, size_t first, size_t end) {
    order *o = argument;
    uint32_t *const ends = o->broad->ends, sum = 0;
    memset(ends + first, 0, (end - first) * sizeof *ends);
    count_partners(o->broad, o->blocks, (uint32_t)first, (uint32_t)end);
    for (size_t k = first; k < end; k++) {
        const uint32_t here = ends[k];
        ends[k] = sum;
        sum += here;
    }
    o->start[part + 1] = sum;
}

static void order_part(void *argument, size_t part, size_t first, size_t end) {
    const order *o = argument;
    const uint32_t *const ends = o->broad->ends, own_count = o->start[part + 1] - o->start[part];
    uint32_t *const own_a = o->out_a + o->start[part], *const own_b = o->out_b + o->start[part], from = 0;
    place_partners(o->broad, o->blocks, (uint32_t)first, (uint32_t)end, own_b);
    for (size_t body = first; body < end; from = ends[body++]) {
        const uint32_t count = ends[body] - from;
        if (count == 0)
            continue;
        if (count <= FOUR && own_count - from >= FOUR) { /* what is written too much, the next bodies write again */
            for (uint32_t k = 0; k < FOUR; k++)
                own_a[from + k] = (uint32_t)body;
            sort_four(own_b + from, count);
            continue;
        }
        for (uint32_t k = from; k < ends[body]; k++)
            own_a[k] = (uint32_t)body;
        narc_sort_indices(own_b + from, count, is_less, NULL);
    }
}

/* Each part reads all pairs that may be of its own bodies, and works on those that are. */
void narc_order_pairs(narc_broad_phase *broad, size_t blocks, size_t body_count, const narc_workers *workers,
                      uint32_t *out_a, uint32_t *out_b) {
    order o = {broad, blocks, out_a, out_b, {0}};
    const size_t size = narc_part_size(body_count, workers->count < MOST_PARTS ? workers->count : MOST_PARTS);
    const size_t parts = narc_run_ranges(workers, body_count, size, count_part, &o);
    for (size_t part = 0; part < parts; part++)
        o.start[part + 1] += o.start[part];
    if (o.start[parts] > 0) /* or else there may be no memory to write to */
        narc_run_ranges(workers, body_count, size, order_part, &o);
}
