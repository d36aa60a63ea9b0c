/* SPDX-License-Identifier: MIT
 *
 * order.c - the last steps of narc_find_pairs(): the filter, and the order of the pairs.
 */
#include "column.h"
#include "steps.h"

#include <string.h>

static void put_in_order(uint32_t *one, uint32_t *other) {
    const uint32_t low = *one < *other ? *one : *other, high = *one < *other ? *other : *one;
    *one = low;
    *other = high;
}

/* ------------------------------------------------------------------------------------------------ filter */

narc_body_filter narc_read_filter(const narc_pair_filter *filter, size_t body) {
    const narc_word_column category = filter->category, mask = filter->mask;
    return (narc_body_filter){.category = category.base ? narc_word_at(category, body) : UINT64_MAX,
                              .mask = mask.base ? narc_word_at(mask, body) : UINT64_MAX,
                              .group = filter->group.base ? narc_index_at(filter->group, body) : 0,
                              .kind = filter->kind.base ? narc_byte_at(filter->kind, body) & NARC_KINDS : 0};
}

/* Two static bodies do not meet, nor do two sensors. */
static bool lets(const narc_pair_filter *filter, uint32_t a, uint32_t b) {
    const narc_body_filter one = narc_read_filter(filter, a), other = narc_read_filter(filter, b);
    return !(one.kind & other.kind & (NARC_STATIC | NARC_SENSOR)) && (one.group == 0 || one.group != other.group) &&
           (one.category & other.mask) != 0 && (other.category & one.mask) != 0;
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
        left += lets(filter, a[left], b[left]);
    }
    return left;
}

/* ------------------------------------------------------------------------------------------------ order */

enum { FEW = 32, FOUR = 4 };

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

static void insert_all(uint32_t *list, size_t count) {
    for (size_t k = 1; k < count; k++) {
        const uint32_t moved = list[k];
        size_t to = k;
        for (; to > 0 && list[to - 1] > moved; to--)
            list[to] = list[to - 1];
        list[to] = moved;
    }
}

/* Moves the item at `root` down a heap with the largest in front. */
static void sift_down(uint32_t *heap, size_t root, size_t count) {
    const uint32_t moved = heap[root];
    for (size_t child; (child = 2 * root + 1) < count; root = child) {
        child += child + 1 < count && heap[child + 1] > heap[child];
        if (heap[child] <= moved)
            break;
        heap[root] = heap[child];
    }
    heap[root] = moved;
}

/* Insertion for short lists; heap sort for those of a body that many others touch. */
static void sort_list(uint32_t *list, size_t count) {
    if (count <= FEW) {
        insert_all(list, count);
        return;
    }
    for (size_t k = count / 2; k-- > 0;)
        sift_down(list, k, count);
    for (size_t k = count; k-- > 1;) {
        const uint32_t largest = list[0];
        list[0] = list[k];
        list[k] = largest;
        sift_down(list, 0, k);
    }
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

/* The most threads, and so parts of the bodies (narc_team_size()). */
enum { MOST_PARTS = 256 };

/* Each thread reads all pairs that may be of its own bodies, and works on those that are. */
void narc_order_pairs(narc_broad_phase *broad, size_t blocks, size_t body_count, int team, uint32_t *out_a,
                      uint32_t *out_b) {
    uint32_t *const ends = broad->ends, start[MOST_PARTS + 1] = {0};
    const int parts = team < MOST_PARTS ? team : MOST_PARTS;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t first = narc_part_start(body_count, part, parts),
                     end = narc_part_start(body_count, part + 1, parts);
        uint32_t sum = 0;
        memset(ends + first, 0, (end - first) * sizeof *ends);
        count_partners(broad, blocks, (uint32_t)first, (uint32_t)end);
        for (size_t k = first; k < end; k++) {
            const uint32_t here = ends[k];
            ends[k] = sum;
            sum += here;
        }
        start[part + 1] = sum;
    }
    for (int part = 0; part < parts; part++)
        start[part + 1] += start[part];
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
#endif
    for (int part = 0; part < parts; part++) {
        const size_t first = narc_part_start(body_count, part, parts),
                     end = narc_part_start(body_count, part + 1, parts);
        uint32_t *const own_a = out_a + start[part], *const own_b = out_b + start[part];
        const uint32_t own_count = start[part + 1] - start[part];
        uint32_t from = 0;
        place_partners(broad, blocks, (uint32_t)first, (uint32_t)end, own_b);
        for (size_t body = first; body < end; from = ends[body++]) {
            const uint32_t count = ends[body] - from;
            if (count <= FOUR && own_count - from >= FOUR) { /* what is written too much, the next bodies write again */
                for (uint32_t k = 0; k < FOUR; k++)
                    own_a[from + k] = (uint32_t)body;
                sort_four(own_b + from, count);
                continue;
            }
            for (uint32_t k = from; k < ends[body]; k++)
                own_a[k] = (uint32_t)body;
            sort_list(own_b + from, count);
        }
    }
}
