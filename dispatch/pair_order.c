/* SPDX-License-Identifier: MIT
 *
 * pair_order.c - the last steps of narc_find_pairs(): places to bodies, the filter, and the order of the pairs.
 */
#include "broad_phase_steps.h"
#include "column.h"

#include <string.h>

/* ------------------------------------------------------------------------------------------------ filter */

static uint32_t bits_at(narc_column column, uint32_t body) {
    return column.base ? narc_index_at(column, body) : UINT32_MAX;
}

static bool lets(const narc_pair_filter *filter, uint32_t a, uint32_t b) {
    const narc_column still = filter->still, group = filter->group;
    if (still.base && *(const uint8_t *)narc_at(still, a) && *(const uint8_t *)narc_at(still, b))
        return false;
    if (group.base && narc_index_at(group, a) != 0 && narc_index_at(group, a) == narc_index_at(group, b))
        return false;
    return (bits_at(filter->category, a) & bits_at(filter->mask, b)) != 0 &&
           (bits_at(filter->category, b) & bits_at(filter->mask, a)) != 0;
}

static uint32_t filter_block(const narc_broad_phase *broad, const narc_pair_filter *filter, size_t block) {
    uint32_t *const first = broad->pair_a + block * NARC_PAIR_BLOCK, *const second =
                                                                         broad->pair_b + block * NARC_PAIR_BLOCK;
    uint32_t left = 0;
    for (uint32_t k = 0; k < broad->block_counts[block]; k++) {
        const uint32_t one = broad->boxes.body[first[k]], other = broad->boxes.body[second[k]];
        const uint32_t a = one < other ? one : other, b = one < other ? other : one;
        first[left] = a;
        second[left] = b;
        left += !filter || lets(filter, a, b);
    }
    return left;
}

size_t narc_filter_pairs(narc_broad_phase *broad, const narc_pair_filter *filter, int team) {
    const size_t blocks = atomic_load_explicit(&broad->block_count, memory_order_relaxed);
    size_t left = 0;
    (void)team;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(+ : left) if (team > 1)
#endif
    for (size_t block = 0; block < blocks; block++) {
        broad->block_counts[block] = filter_block(broad, filter, block);
        left += broad->block_counts[block];
    }
    return left;
}

/* ------------------------------------------------------------------------------------------------ order */

enum { FEW = 32 };

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

static uint32_t part_start(size_t count, int part, int parts) {
    return (uint32_t)(count * (size_t)part / (size_t)parts);
}

/* Counts the partners of bodies first .. end - 1. */
static void count_partners(const narc_broad_phase *broad, size_t blocks, uint32_t first, uint32_t end) {
    for (size_t block = 0; block < blocks; block++) {
        const uint32_t *const a = broad->pair_a + block * NARC_PAIR_BLOCK;
        for (uint32_t k = 0; k < broad->block_counts[block]; k++)
            if (a[k] - first < end - first)
                broad->ends[a[k]]++;
    }
}

/* Puts the partners of these bodies where `ends` says, and moves it on. */
static void place_partners(const narc_broad_phase *broad, size_t blocks, uint32_t first, uint32_t end,
                           uint32_t *out_b) {
    for (size_t block = 0; block < blocks; block++) {
        const uint32_t *const a = broad->pair_a + block * NARC_PAIR_BLOCK;
        const uint32_t *const b = broad->pair_b + block * NARC_PAIR_BLOCK;
        for (uint32_t k = 0; k < broad->block_counts[block]; k++)
            if (a[k] - first < end - first)
                out_b[broad->ends[a[k]]++] = b[k];
    }
}

/* Each thread reads all pairs and works on those of its own bodies. */
void narc_order_pairs(narc_broad_phase *broad, size_t body_count, int team, uint32_t *out_a, uint32_t *out_b) {
    const size_t blocks = atomic_load_explicit(&broad->block_count, memory_order_relaxed);
    uint32_t *const ends = broad->ends;
    memset(ends, 0, body_count * sizeof *ends);
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
#endif
    for (int part = 0; part < team; part++)
        count_partners(broad, blocks, part_start(body_count, part, team), part_start(body_count, part + 1, team));
    uint32_t sum = 0;
    for (size_t k = 0; k < body_count; k++) {
        const uint32_t here = ends[k];
        ends[k] = sum;
        sum += here;
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
#endif
    for (int part = 0; part < team; part++) {
        const uint32_t first = part_start(body_count, part, team), end = part_start(body_count, part + 1, team);
        uint32_t start = first < end ? ends[first] : 0;
        place_partners(broad, blocks, first, end, out_b);
        for (uint32_t body = first; body < end; body++) {
            for (uint32_t k = start; k < ends[body]; k++)
                out_a[k] = body;
            sort_list(out_b + start, ends[body] - start);
            start = ends[body];
        }
    }
}
