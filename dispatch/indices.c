/* SPDX-License-Identifier: MIT
 *
 * indices.c - do all indices that a caller gave name something that exists: pairs bodies, bodies shapes?
 */
#include "column.h"
#include "dispatch.h"

#include <stdatomic.h>

/* Pairs that one worker looks at in one go: some 50 microseconds of work. */
enum { PART = 65536 };

/* So few pairs are looked at one by one. */
enum { FEW = 32 };

/* A limit that are_below() can take. What it then finds wrong may be right, and is looked at again. */
static uint32_t clip(size_t limit) { return limit < 0x80000000u ? (uint32_t)limit : 0x80000000u; }

/* Are items first .. last - 1 of a column below `limit`? With limit at most 2^31, the upper bit of k - limit is that of
 * a k below it, if k has none itself. So all that is kept of the items is the union and the intersection of bits: two
 * operations each, on four items at a time, because one would wait for the other. */
static bool are_below(narc_index_column column, size_t first, size_t last, uint32_t limit) {
    uint32_t any[4] = {0}, all[4] = {UINT32_MAX, UINT32_MAX, UINT32_MAX, UINT32_MAX};
    size_t k = first;
    if (column.stride == sizeof(uint32_t)) { /* of a plain array compilers make vectors */
        const uint32_t *index = column.base;
        for (; k < last; k++) {
            any[0] |= index[k];
            all[0] &= index[k] - limit;
        }
    }
    for (; k + 4 <= last; k += 4)
        for (size_t i = 0; i < 4; i++) {
            const uint32_t index = narc_index_at(column, k + i);
            any[i] |= index;
            all[i] &= index - limit;
        }
    for (; k < last; k++) {
        any[0] |= narc_index_at(column, k);
        all[0] &= narc_index_at(column, k) - limit;
    }
    const uint32_t one = any[0] | any[1] | any[2] | any[3], every = all[0] & all[1] & all[2] & all[3];
    return (~one & every) >> 31;
}

/* Are all bodies that pairs first .. last - 1 name there? */
static bool are_bodies_there(const narc_batch *batch, size_t first, size_t last) {
    const narc_index_column a = batch->pairs->a, b = batch->pairs->b;
    const ptrdiff_t item = sizeof(uint32_t);
    if (a.stride == 2 * item && b.stride == 2 * item && b.base == a.base + 1 && batch->a->count == batch->b->count)
        return are_below((narc_index_column){a.base, item}, 2 * first, 2 * last,
                         clip(batch->a->count)); /* one column */
    return (!a.base || are_below(a, first, last, clip(batch->a->count))) &&
           (!b.base || are_below(b, first, last, clip(batch->b->count)));
}

/* A search for what is wrong, part by part. */
struct search {
    const narc_batch *batch;
    narc_index_column column; /* or without a batch: are all of its items below the limit? */
    size_t limit;
    size_t first, count, parts;
    atomic_bool fine;
    atomic_size_t bad; /* the first that was found */
};

/* The range of a part. */
static void find_part(const struct search *search, size_t part, size_t *out_first, size_t *out_end) {
    const size_t start = part * PART, left = search->count - start;
    *out_first = search->first + start;
    *out_end = search->first + start + (left < PART ? left : PART);
}

/* Are the shapes of a part of some bodies there? */
static bool are_shapes_there(const narc_batch *batch, const narc_bodies *bodies, size_t parts, size_t part) {
    const size_t bodies_in_part = bodies->count / parts + 1, body = part * bodies_in_part;
    const size_t rest = bodies->count > body ? bodies->count - body : 0;
    const size_t end = body + (rest < bodies_in_part ? rest : bodies_in_part);
    return are_below(bodies->shape, body, end, clip(batch->shapes->count));
}

/* Are all bodies of a part's pairs in range, and all shapes of a part of the bodies? Reads columns from front to back,
 * which is much faster than looking up every pair's bodies. */
static void look_at_columns(void *argument, size_t part) {
    struct search *const search = argument;
    const narc_batch *batch = search->batch;
    const bool one_set = batch->a->shape.base == batch->b->shape.base &&
                         batch->a->shape.stride == batch->b->shape.stride && batch->a->count == batch->b->count;
    size_t first, end;
    find_part(search, part, &first, &end);
    if (!are_bodies_there(batch, first, end) || !are_shapes_there(batch, batch->a, search->parts, part) ||
        !(one_set || are_shapes_there(batch, batch->b, search->parts, part)))
        atomic_store_explicit(&search->fine, false, memory_order_relaxed);
}

static bool is_body_fine(const narc_batch *batch, narc_index_column column, const narc_bodies *bodies, size_t pair) {
    const size_t body = column.base ? narc_index_at(column, pair) : pair;
    return body < bodies->count && narc_index_at(bodies->shape, body) < batch->shapes->count;
}

/* The first place from `place` on of a pair that is not fine, or `end`. */
static size_t find_bad_place(const narc_batch *batch, size_t place, size_t end) {
    for (; place < end; place++) {
        const size_t pair = narc_pair_at(batch, place);
        if (pair >= batch->pairs->count || !is_body_fine(batch, batch->pairs->a, batch->a, pair) ||
            !is_body_fine(batch, batch->pairs->b, batch->b, pair))
            break;
    }
    return place;
}

/* Keeps the first of what is bad. */
static void keep_first(struct search *search, size_t bad) {
    size_t known = atomic_load_explicit(&search->bad, memory_order_relaxed);
    while (bad < known && !atomic_compare_exchange_weak_explicit(&search->bad, &known, bad, memory_order_relaxed,
                                                                 memory_order_relaxed))
        continue;
}

static void look_at_pairs(void *argument, size_t part) {
    struct search *const search = argument;
    size_t place, end;
    find_part(search, part, &place, &end);
    place = find_bad_place(search->batch, place, end);
    if (place < end)
        keep_first(search, place);
}

size_t narc_find_bad_pair(const narc_batch *batch) {
    const size_t first = batch->first, count = batch->count;
    if (count < FEW)
        return find_bad_place(batch, first, first + count);
    struct search search = {.batch = batch, .first = first, .count = count, .parts = (count - 1) / PART + 1};
    atomic_init(&search.fine, true);
    atomic_init(&search.bad, first + count);
    /* With many more bodies than pairs it is better to look up those that are named. A body that no pair names may have
     * any shape, so what the quick way finds wrong is looked at again. */
    if (!batch->query->selection.base && (batch->a->count + batch->b->count) / 8 <= count) {
        narc_run_parts(batch->query->workers, search.parts, look_at_columns, &search);
        if (atomic_load(&search.fine))
            return first + count;
    }
    narc_run_parts(batch->query->workers, search.parts, look_at_pairs, &search);
    return atomic_load(&search.bad);
}

static void look_at_items(void *argument, size_t part) {
    struct search *const search = argument;
    size_t item, end;
    find_part(search, part, &item, &end);
    if (are_below(search->column, item, end, clip(search->limit)))
        return;
    while (item < end && narc_index_at(search->column, item) < search->limit)
        item++;
    if (item < end)
        keep_first(search, item);
}

size_t narc_find_bad_index(narc_index_column column, size_t first, size_t count, size_t limit,
                           const narc_workers *workers) {
    struct search search = {.column = column, .limit = limit, .first = first, .count = count};
    atomic_init(&search.bad, first + count);
    narc_run_parts(workers, count / PART + (count % PART != 0), look_at_items, &search);
    return atomic_load(&search.bad);
}
