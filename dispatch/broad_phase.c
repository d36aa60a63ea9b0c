/* SPDX-License-Identifier: MIT
 *
 * broad_phase.c - narc_find_pairs(): boxes into strips, a sweep through each strip and its neighbours, pairs into order.
 */
#include "broad_phase_steps.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"

/* Strips that a thread sweeps at a time have about so many boxes. */
enum { PART_BOXES = 1024 };

/* The first of strips first .. end - 1 whose number is at least this. */
static size_t find_strip(const narc_broad_phase *broad, size_t first, size_t end, uint64_t number) {
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (broad->strips[middle].number < number)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/* Ends a thread's block of pairs. */
static void end_block(narc_place_pairs *pairs) {
    if (pairs->a)
        pairs->broad->block_counts[(size_t)(pairs->a - pairs->broad->pair_a) / NARC_PAIR_BLOCK] = pairs->count;
    pairs->total += pairs->count;
    pairs->count = 0;
}

/* Gives a thread the next block of pairs; if there is no more, it counts as many as fit into 32 bits. */
static void get_block(narc_place_pairs *pairs) {
    narc_broad_phase *const broad = pairs->broad;
    end_block(pairs);
    const size_t block = atomic_fetch_add_explicit(&broad->block_count, 1, memory_order_relaxed);
    const bool exists = block < broad->block_capacity;
    pairs->room = exists ? NARC_PAIR_BLOCK : UINT32_MAX;
    pairs->a = exists ? broad->pair_a + block * NARC_PAIR_BLOCK : NULL;
    pairs->b = exists ? broad->pair_b + block * NARC_PAIR_BLOCK : NULL;
}

/* Sweeps a strip: itself, the one above it, and those of levels with higher strips that may reach it. */
static void sweep_strip(const narc_broad_phase *broad, const narc_kernel_table *kernels, size_t index,
                        narc_place_pairs *out) {
    const narc_strip *const strip = &broad->strips[index], *const above = strip + 1;
    const size_t level = (size_t)(strip->number / (uint64_t)broad->strip_span);
    kernels->sweep(&broad->boxes, strip->first, strip->end, strip->first, strip->end, out);
    if (index + 1 < broad->strip_count && above->number == strip->number + 1 && above->min_y <= strip->max_y)
        kernels->sweep(&broad->boxes, strip->first, strip->end, above->first, above->end, out);
    size_t end = index;
    for (size_t higher = level; higher-- > 0;) {
        const uint64_t lowest = narc_strip_number(broad, higher, strip->min_y, -1);
        const uint64_t highest = narc_strip_number(broad, higher, strip->max_y, 0);
        const size_t first = find_strip(broad, 0, end, lowest);
        for (size_t k = first; k < broad->strip_count && broad->strips[k].number <= highest; k++) {
            const narc_strip *const other = &broad->strips[k];
            if (other->min_y <= strip->max_y && strip->min_y <= other->max_y)
                kernels->sweep(&broad->boxes, strip->first, strip->end, other->first, other->end, out);
        }
        end = first;
    }
}

/* Sweeps all strips; returns how many pairs there are, of which only those are kept for which there are blocks. */
static uint64_t sweep_all(narc_broad_phase *broad, const narc_kernel_table *kernels, size_t boxes, int team) {
    const size_t parts = boxes / PART_BOXES + 1;
    uint64_t found = 0;
    atomic_store_explicit(&broad->block_count, 0, memory_order_relaxed);
    (void)team;
#ifdef _OPENMP
#pragma omp parallel num_threads(team) reduction(+ : found) if (team > 1)
#endif
    {
        narc_place_pairs out = {.get_room = get_block, .broad = broad};
        get_block(&out);
#ifdef _OPENMP
#pragma omp for schedule(dynamic)
#endif
        for (size_t part = 0; part < parts; part++) {
            /* The strips whose first box is in this part of the boxes. */
            const size_t from = part * PART_BOXES, to = from + PART_BOXES;
            size_t low = 0, high = broad->strip_count;
            while (low < high) {
                const size_t middle = low + (high - low) / 2;
                if (broad->strips[middle].first < from)
                    low = middle + 1;
                else
                    high = middle;
            }
            for (size_t k = low; k < broad->strip_count && broad->strips[k].first < to; k++)
                sweep_strip(broad, kernels, k, &out);
        }
        end_block(&out);
        found += out.total;
    }
    return found;
}

static narc_status check(const narc_broad_phase *broad, const narc_box *boxes, size_t count, const uint32_t *out_a,
                         const uint32_t *out_b, size_t capacity, const size_t *out_count, narc_error *error) {
    if (!broad || !out_count)
        return narc_fail_missing(error, !broad ? "broad" : "out_count");
    if (count > 0 && !boxes)
        return narc_fail_missing(error, "boxes");
    if (capacity > 0 && (!out_a || !out_b))
        return narc_fail_missing(error, !out_a ? "out_a" : "out_b");
    if (count > UINT32_MAX - 1)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)count, "%zu boxes, at most %lu", count,
                         (unsigned long)(UINT32_MAX - 1));
    return NARC_OK;
}

narc_status narc_find_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                            const narc_pair_filter *filter, unsigned threads, uint32_t *out_a, uint32_t *out_b,
                            size_t capacity, size_t *out_count, narc_error *error) {
    narc_status status = check(broad, boxes, count, out_a, out_b, capacity, out_count, error);
    if (status != NARC_OK)
        return status;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    if (narc_reserve_boxes(broad, count) != NARC_OK || narc_reserve_blocks(broad, count / NARC_PAIR_BLOCK) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)count, "not enough memory for %zu boxes", count);
    const size_t listed = narc_sort_into_strips(broad, boxes, count);
    const int team = narc_team_size(threads, listed / PART_BOXES + 1);
#ifdef _OPENMP
#pragma omp parallel for schedule(dynamic, 4) num_threads(team) if (team > 1)
#endif
    for (size_t k = 0; k < broad->strip_count; k++)
        narc_sort_strip(broad, &broad->strips[k], boxes);
    uint64_t found = sweep_all(broad, kernels, listed, team);
    const size_t blocks = atomic_load_explicit(&broad->block_count, memory_order_relaxed);
    if (found > UINT32_MAX)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)found, "%llu pairs of boxes overlap, at most %lu",
                         (unsigned long long)found, (unsigned long)UINT32_MAX);
    if (blocks > broad->block_capacity) {
        /* Less than NARC_BOX_PADDING places of a block stay free, but in the last one of each thread. */
        const size_t needed = (size_t)(found / (NARC_PAIR_BLOCK - NARC_BOX_PADDING)) + (size_t)team;
        if (narc_reserve_blocks(broad, needed) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)found, "not enough memory for %llu pairs",
                             (unsigned long long)found);
        sweep_all(broad, kernels, listed, team);
    }
    const size_t left = narc_filter_pairs(broad, filter, team);
    *out_count = left;
    if (left > capacity)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)left, "%zu pairs, but there is room for %zu", left,
                         capacity);
    narc_order_pairs(broad, count, team, out_a, out_b);
    return NARC_OK;
}
