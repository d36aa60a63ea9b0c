/* SPDX-License-Identifier: MIT
 *
 * find_pairs.c - narc_find_pairs(): boxes into strips, a sweep through each strip and its neighbours, pairs into order.
 */
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <math.h>

/* Pairs that a box has, more or less: a call that finds more of them sweeps twice, the first time. */
enum { USUAL_PAIRS = 3 };

/* A sweep of all strips, and what its tasks share. */
typedef struct sweep {
    narc_broad_phase *broad;
    const narc_kernel_table *kernels;
    const narc_pair_filter *filter;
    size_t tasks, strips_at_a_time;
    atomic_size_t next_strip;
    atomic_uint_least64_t found, steps;
} sweep;

/* A task's pairs, and where those go for which there is no block: they are only counted. */
typedef struct own_pairs {
    narc_found_pairs pairs; /* the kernel's view, first */
    const sweep *sweep;
    uint32_t filtered; /* pairs of the block that have been */
    uint64_t total;    /* of the blocks before it */
    uint32_t *a, *b;   /* NARC_PAIR_BLOCK each */
} own_pairs;

/* Without a filter, pairs that are only counted may stay as they are. */
static void filter_new(own_pairs *own) {
    narc_found_pairs *const pairs = &own->pairs;
    if (pairs->a == own->a && !own->sweep->filter)
        own->filtered = pairs->count;
    else
        own->filtered = pairs->count =
            narc_filter_pairs(own->sweep->filter, pairs->a, pairs->b, own->filtered, pairs->count);
}

/* One task reads all blocks: then their ranges do not matter. */
static narc_pair_block describe_block(const narc_found_pairs *pairs, size_t tasks) {
    if (tasks == 1)
        return (narc_pair_block){pairs->count, 0, UINT32_MAX};
    narc_pair_block block = {pairs->count, UINT32_MAX, 0};
    for (uint32_t k = 0; k < pairs->count; k++) {
        block.lowest_a = pairs->a[k] < block.lowest_a ? pairs->a[k] : block.lowest_a;
        block.highest_a = pairs->a[k] > block.highest_a ? pairs->a[k] : block.highest_a;
    }
    return block;
}

static void end_block(own_pairs *own) {
    narc_found_pairs *const pairs = &own->pairs;
    filter_new(own);
    if (pairs->a != own->a)
        own->sweep->broad->blocks[(size_t)(pairs->a - own->sweep->broad->pair_a) / NARC_PAIR_BLOCK] =
            describe_block(pairs, own->sweep->tasks);
    own->total += pairs->count;
    own->filtered = pairs->count = 0;
}

static void begin_block(own_pairs *own) {
    narc_broad_phase *const broad = own->sweep->broad;
    const size_t block = atomic_fetch_add_explicit(&broad->block_count, 1, memory_order_relaxed);
    const bool exists = block < broad->block_capacity;
    own->pairs.a = exists ? broad->pair_a + block * NARC_PAIR_BLOCK : own->a;
    own->pairs.b = exists ? broad->pair_b + block * NARC_PAIR_BLOCK : own->b;
}

/* Blocks that hold so many pairs: all are full but the last one of each task. */
static size_t count_blocks(uint64_t pairs, size_t tasks) { return (size_t)(pairs / NARC_FULL_BLOCK) + tasks; }

/* More than the largest number of pairs? Tasks have asked for more blocks than hold that many. */
static bool has_too_many(const narc_broad_phase *broad, size_t tasks) {
    return atomic_load_explicit(&broad->block_count, memory_order_relaxed) > count_blocks(UINT32_MAX, tasks) + 1;
}

/* A block that the filter leaves room in is filled up first. */
static void get_room(narc_found_pairs *pairs) {
    own_pairs *const own = (own_pairs *)pairs;
    filter_new(own);
    if (pairs->count <= NARC_FULL_BLOCK)
        return;
    end_block(own);
    begin_block(own);
    pairs->enough = has_too_many(own->sweep->broad, own->sweep->tasks);
}

/* ------------------------------------------------------------------------------------------------ sweeps */

/* The first strip of a level whose number is at least this. */
static size_t find_strip(const narc_broad_phase *broad, const narc_level *level, uint64_t number) {
    size_t first = level->first, end = level->end;
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (broad->strips[middle].number < number)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/* The boxes of the shorter strip look for theirs in the other. */
static void sweep_both(const narc_broad_phase *broad, const narc_kernel_table *kernels, const narc_strip *one,
                       const narc_strip *other, narc_found_pairs *out) {
    if (one->min_y > other->max_y || other->min_y > one->max_y)
        return;
    const bool swap = one->end - one->first > other->end - other->first;
    const narc_strip *const a = swap ? other : one, *const b = swap ? one : other;
    kernels->sweep(&broad->boxes, a->first, a->end, b->first, b->end, b->width, out);
}

/* Sweeps a strip, or any boxes, and those of its world's levels first .. end - 1 that may reach it. */
static void sweep_levels(const narc_broad_phase *broad, const narc_kernel_table *kernels, const narc_strip *strip,
                         size_t first, size_t end, narc_found_pairs *out) {
    for (const narc_level *level = broad->levels + first; level < broad->levels + end; level++) {
        const uint64_t lowest = narc_strip_number(broad, level, strip->min_y, -1);
        const uint64_t highest = narc_strip_number(broad, level, strip->max_y, 0);
        for (size_t k = find_strip(broad, level, lowest); k < level->end && broad->strips[k].number <= highest; k++)
            sweep_both(broad, kernels, strip, &broad->strips[k], out);
    }
}

/* Sweeps a strip: itself, the one above it, and those of levels with strips at least as high that may reach it. */
static void sweep_strip(const narc_broad_phase *broad, const narc_kernel_table *kernels, size_t index,
                        narc_found_pairs *out) {
    const narc_strip *const strip = &broad->strips[index], *const above = strip + 1;
    kernels->sweep(&broad->boxes, strip->first, strip->end, strip->first, strip->end, strip->width, out);
    if (index + 1 < broad->strip_count && above->number == strip->number + 1)
        sweep_both(broad, kernels, strip, above, out);
    sweep_levels(broad, kernels, strip, broad->levels[strip->level].start, strip->level, out);
}

/* One task: sweeps strips that no other does. */
static void sweep_some(void *argument, size_t task) {
    sweep *job = argument;
    const size_t step = job->strips_at_a_time, count = job->broad->strip_count;
    uint32_t a[NARC_PAIR_BLOCK], b[NARC_PAIR_BLOCK];
    own_pairs own = {{.room = NARC_PAIR_BLOCK, .get_room = get_room}, job, 0, 0, a, b};
    (void)task;
    begin_block(&own);
    for (size_t first; (first = atomic_fetch_add_explicit(&job->next_strip, step, memory_order_relaxed)) < count;)
        for (size_t k = first; k < count && k - first < step && !own.pairs.enough; k++)
            sweep_strip(job->broad, job->kernels, k, &own.pairs);
    end_block(&own);
    atomic_fetch_add_explicit(&job->found, own.total, memory_order_relaxed);
    atomic_fetch_add_explicit(&job->steps, own.pairs.steps, memory_order_relaxed);
}

/* Sweeps all strips; returns how many pairs the filter lets, of which only those are kept for which there are
 * blocks. Beyond UINT32_MAX it stops: then it returns any larger number. */
static uint64_t sweep_all(narc_broad_phase *broad, const narc_kernel_table *kernels, const narc_pair_filter *filter,
                          const narc_workers *workers) {
    sweep job = {.broad = broad,
                 .kernels = kernels,
                 .filter = filter,
                 .tasks = workers->count,
                 .strips_at_a_time = 1 + broad->strip_count / ((size_t)workers->count * 64)};
    atomic_store_explicit(&broad->block_count, 0, memory_order_relaxed);
    narc_run_parts(workers, job.tasks, sweep_some, &job);
    broad->steps = atomic_load_explicit(&job.steps, memory_order_relaxed);
    return atomic_load_explicit(&job.found, memory_order_relaxed);
}

/* The workers for so many boxes. */
static narc_workers choose_workers(const narc_workers *workers, size_t count) {
    narc_workers chosen = workers ? *workers : (narc_workers){.count = 1};
    chosen.count = narc_count_workers(workers, count / NARC_PART_BOXES + 1);
    return chosen;
}

/* ------------------------------------------------------------------------------------------------ few boxes */

/* Appends unsorted bodies of a world as they lie in the columns, both kinds together in the order of min_x, so that they
 * hardly need sorting the next time. */
static void merge_unsorted(narc_broad_phase *broad, const narc_strip *old, const narc_strip *fresh) {
    const narc_box_columns *const boxes = &broad->boxes;
    uint32_t *to = broad->unsorted + broad->unsorted_count, i = old->first, k = fresh->first;
    while (i < old->end || k < fresh->end) {
        const bool take_old = k == fresh->end || (i < old->end && boxes->min_x[i] <= boxes->min_x[k]);
        *to++ = boxes->body[take_old ? i++ : k++];
    }
    broad->unsorted_count = (size_t)(to - broad->unsorted);
}

/* Unsorted boxes lie behind the strips in the columns, world by world: first those that are not fresh, then the fresh ones,
 * as if each were a strip. Lists their entries; returns where they end. There is room for all. */
static uint32_t list_entries(narc_broad_phase *broad, const narc_box *boxes, const narc_pair_filter *filter) {
    uint64_t limit = 0;
    size_t count = 0;
    for (uint8_t fresh = 0; fresh < 2; fresh++)
        for (size_t k = 0; k < broad->unsorted_count; k++) {
            const uint32_t body = broad->unsorted[k];
            const uint64_t strip = 2 * (uint64_t)narc_read_world(filter, body) + fresh;
            if (!narc_is_box(&boxes[body]))
                broad->place[body] = NARC_NO_PLACE;
            else if (broad->fresh[body] == fresh)
                broad->entries[count++] = (narc_box_entry){strip, boxes[body].min_x, body};
            limit = strip >= limit ? strip + 1 : limit;
        }
    if (limit > 2) /* there are several worlds */
        narc_sort_by_strip(broad, count, limit, 1, NULL);
    memmove(broad->entries + broad->sorted_count, broad->entries, count * sizeof *broad->entries);
    narc_end_columns(&broad->boxes, broad->sorted_count + count);
    return (uint32_t)(broad->sorted_count + count);
}

/* Takes fresh bodies out of the strips. */
static void list_unsorted(narc_broad_phase *broad, size_t count) {
    if (broad->unsorted_count == 0) {
        for (size_t k = 0; k < count; k++)
            broad->place[k] = NARC_NO_PLACE;
        for (uint32_t k = 0; k < broad->sorted_count; k++)
            broad->place[broad->boxes.body[k]] = k;
    }
    for (size_t body = 0; (body = narc_find_flag(broad->fresh, body, count)) < count; body++) {
        const uint32_t place = broad->place[body];
        if (place == NARC_UNSORTED)
            continue;
        if (place != NARC_NO_PLACE)
            broad->boxes.min_y[place] = INFINITY; /* nothing overlaps it; min_x stays, for the order */
        broad->place[body] = NARC_UNSORTED;
        broad->unsorted[broad->unsorted_count++] = (uint32_t)body;
    }
}

/* What a search for fresh boxes may take for each box of all, less than finding all pairs; how many fresh boxes are
 * swept before it is asked how long that took. */
enum { STEPS_FOR_BOX = 4, FRESH_AT_A_TIME = 16 };

/* The levels of a world. */
static size_t find_levels(const narc_broad_phase *broad, uint32_t world, size_t *out_end) {
    size_t first = 0, end = broad->level_count;
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (broad->levels[middle].world < world)
            first = middle + 1;
        else
            end = middle;
    }
    while (end < broad->level_count && broad->levels[end].world == world)
        end++;
    *out_end = end;
    return first;
}

/* Sweeps fresh boxes of a world with each other, with the other unsorted ones, and one by one with the strips. */
static void sweep_world(const narc_broad_phase *broad, const narc_kernel_table *kernels, uint32_t world,
                        const narc_strip *old, const narc_strip *fresh, uint64_t most_steps, narc_found_pairs *out) {
    const narc_box_columns *const boxes = &broad->boxes;
    narc_strip few = *fresh, behind = *fresh;
    size_t end_level;
    const size_t level = find_levels(broad, world, &end_level);
    for (; behind.first < behind.end && out->steps < most_steps; few.first = few.end) {
        few.end = behind.end - few.first > FRESH_AT_A_TIME ? few.first + FRESH_AT_A_TIME : behind.end;
        behind.first = few.end;
        kernels->sweep(boxes, few.first, few.end, few.first, few.end, few.width, out);
        sweep_both(broad, kernels, &few, &behind, out);
        sweep_both(broad, kernels, &few, old, out);
        for (uint32_t k = few.first; k < few.end; k++) {
            const narc_strip one = {.first = k, .end = k + 1, .min_y = boxes->min_y[k], .max_y = boxes->max_y[k]};
            sweep_levels(broad, kernels, &one, level, end_level, out);
        }
    }
}

/* Takes the entries of a strip, if they come next, and fills the columns with their boxes. */
static narc_strip take_strip(narc_broad_phase *broad, const narc_box *boxes, uint64_t strip, uint32_t first,
                             uint32_t end) {
    narc_strip taken = {.first = first, .end = first};
    while (taken.end < end && broad->entries[taken.end].strip == strip)
        taken.end++;
    narc_fill_strip(broad, &taken, boxes);
    return taken;
}

/* Fills the columns with unsorted boxes, up to `end`, and sweeps the fresh ones, world by world. False: it took long. */
static bool sweep_unsorted(narc_broad_phase *broad, const narc_kernel_table *kernels, const narc_box *boxes,
                           const narc_pair_filter *filter, size_t count, uint32_t end, size_t *out_count) {
    const uint64_t most_steps = STEPS_FOR_BOX * (uint64_t)count;
    sweep job = {.broad = broad, .kernels = kernels, .filter = filter, .tasks = 1};
    uint32_t a[NARC_PAIR_BLOCK], b[NARC_PAIR_BLOCK];
    own_pairs own = {{.room = NARC_PAIR_BLOCK, .get_room = get_room}, &job, 0, 0, a, b};
    atomic_store_explicit(&broad->block_count, 0, memory_order_relaxed);
    begin_block(&own);
    broad->unsorted_count = 0;
    for (uint32_t first = (uint32_t)broad->sorted_count; first < end;) {
        const uint64_t world = broad->entries[first].strip / 2;
        const narc_strip old = take_strip(broad, boxes, 2 * world, first, end);
        const narc_strip fresh = take_strip(broad, boxes, 2 * world + 1, old.end, end);
        sweep_world(broad, kernels, (uint32_t)world, &old, &fresh, most_steps, &own.pairs);
        merge_unsorted(broad, &old, &fresh);
        first = fresh.end;
    }
    end_block(&own);
    *out_count = (size_t)own.total;
    return own.pairs.steps < most_steps &&
           atomic_load_explicit(&broad->block_count, memory_order_relaxed) <= broad->block_capacity;
}

bool narc_sweep_fresh(narc_broad_phase *broad, const narc_box *boxes, size_t count, size_t fresh_count,
                      const narc_pair_filter *filter, const narc_workers *workers, size_t *out_count) {
    narc_status status;
    const narc_kernel_table *const kernels = narc_kernels(&status, NULL);
    const narc_workers chosen = choose_workers(workers, count);
    if (!kernels || fresh_count > narc_most_unsorted(count) / 2)
        return false;
    if (broad->unsorted_count + fresh_count > narc_most_unsorted(count))
        narc_make_strips(broad, boxes, count, filter, &chosen);
    list_unsorted(broad, count);
    const uint32_t end = list_entries(broad, boxes, filter);
    return sweep_unsorted(broad, kernels, boxes, filter, count, end, out_count);
}

/* ------------------------------------------------------------------------------------------------ the call */

static narc_status check_arguments(const narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                   const uint32_t *out_a, const uint32_t *out_b, ptrdiff_t stride, size_t capacity,
                                   const size_t *out_count, narc_error *error) {
    if (!broad || !out_count)
        return narc_fail_missing(error, !broad ? "broad" : "out_count");
    if (count > 0 && !boxes)
        return narc_fail_missing(error, "boxes");
    if (capacity > 0 && (!out_a || !out_b))
        return narc_fail_missing(error, !out_a ? "out_a" : "out_b");
    if (stride % 4 != 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)stride, "stride is %td, no multiple of 4", stride);
    if (count > UINT32_MAX - 1)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)count, "%zu boxes, at most %lu", count,
                         (unsigned long)(UINT32_MAX - 1));
    return NARC_OK;
}

narc_status narc_sweep_boxes(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                             const narc_pair_filter *filter, const narc_workers *workers, size_t *out_count,
                             narc_error *error) {
    narc_status status;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    const narc_workers chosen = choose_workers(workers, count);
    broad->is_sorted = false;
    if (narc_reserve_boxes(broad, count) != NARC_OK ||
        narc_reserve_blocks(broad, count_blocks(USUAL_PAIRS * (uint64_t)count, chosen.count)) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)count, "not enough memory for %zu boxes", count);
    narc_make_strips(broad, boxes, count, filter, &chosen);
    const uint64_t found = sweep_all(broad, kernels, filter, &chosen);
    if (found > UINT32_MAX)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)UINT32_MAX, "more than %lu pairs of boxes overlap",
                         (unsigned long)UINT32_MAX);
    *out_count = (size_t)found;
    return NARC_OK;
}

narc_status narc_hold_pairs(narc_broad_phase *broad, const narc_pairs *pairs, size_t count,
                            const narc_pair_filter *filter, size_t *out_count, narc_error *error) {
    const size_t blocks = pairs->count / NARC_PAIR_BLOCK + 1;
    if (narc_reserve_boxes(broad, count) != NARC_OK || narc_reserve_blocks(broad, blocks) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)pairs->count, "not enough memory for %zu pairs",
                         pairs->count);
    broad->is_sorted = false;
    atomic_store_explicit(&broad->block_count, blocks, memory_order_relaxed);
    *out_count = 0;
    for (size_t block = 0; block < blocks; block++) {
        const size_t first = block * NARC_PAIR_BLOCK, left = pairs->count - first;
        narc_found_pairs held = {.a = broad->pair_a + first, .b = broad->pair_b + first};
        for (; held.count < left && held.count < NARC_PAIR_BLOCK; held.count++) {
            const size_t k = first + held.count;
            const uint32_t a = narc_index_at(pairs->a, k), b = narc_index_at(pairs->b, k), high = a > b ? a : b;
            if (high >= count)
                return narc_fail(error, NARC_ERROR_INDEX, k, high, "pair %zu: body %lu, but there are %zu bodies", k,
                                 (unsigned long)high, count);
            if (a == b)
                return narc_fail(error, NARC_ERROR_ARGUMENT, k, a, "pair %zu: both are body %lu", k, (unsigned long)a);
            held.a[held.count] = a;
            held.b[held.count] = b;
        }
        held.count = narc_filter_pairs(filter, held.a, held.b, 0, held.count);
        broad->blocks[block] = describe_block(&held, 2);
        *out_count += held.count;
    }
    return NARC_OK;
}

narc_status narc_list_found_pairs(narc_broad_phase *broad, size_t count, const narc_pair_filter *filter,
                                  const narc_workers *workers, size_t found, uint32_t *out_a, uint32_t *out_b,
                                  narc_error *error) {
    const narc_workers chosen = choose_workers(workers, count);
    if (atomic_load_explicit(&broad->block_count, memory_order_relaxed) > broad->block_capacity) {
        narc_status status;
        const narc_kernel_table *const kernels = narc_kernels(&status, error);
        if (!kernels)
            return status;
        if (narc_reserve_blocks(broad, count_blocks(found, chosen.count)) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)found, "not enough memory for %zu pairs", found);
        sweep_all(broad, kernels, filter, &chosen);
    }
    narc_order_pairs(broad, atomic_load_explicit(&broad->block_count, memory_order_relaxed), count, &chosen, out_a,
                     out_b);
    return NARC_OK;
}

narc_status narc_find_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                            const narc_pair_filter *filter, const narc_workers *workers, uint32_t *out_a,
                            uint32_t *out_b, ptrdiff_t stride, size_t capacity, size_t *out_count, narc_error *error) {
    size_t found = 0;
    narc_status status = check_arguments(broad, boxes, count, out_a, out_b, stride, capacity, out_count, error);
    if (status == NARC_OK)
        status = narc_sweep_boxes(broad, boxes, count, filter, workers, &found, error);
    if (status != NARC_OK)
        return status;
    if (found > capacity) {
        *out_count = found;
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)found, "%zu pairs, but there is room for %zu", found,
                         capacity);
    }
    /* Lists are sorted where they lie, without gaps. */
    uint32_t *a = out_a, *b = out_b;
    const bool has_gaps = stride != 0 && stride != sizeof *a && found > 0;
    if (has_gaps) {
        if (narc_reserve_matches(broad, found, found) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)found, "not enough memory for %zu pairs", found);
        a = broad->match_memory;
        b = a + found;
    }
    status = narc_list_found_pairs(broad, count, filter, workers, found, a, b, error);
    if (status == NARC_OK && has_gaps) {
        const narc_pairs listed = {.count = found, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
        status = narc_copy_pairs(&listed, NULL, found, out_a, out_b, stride, error);
    }
    if (status == NARC_OK)
        *out_count = found;
    return status;
}
