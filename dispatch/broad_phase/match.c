/* SPDX-License-Identifier: MIT
 *
 * match.c - narc_match_pairs(): which pair of an old list each of a new one was.
 *
 * Two lists in order are walked side by side. Otherwise the old pairs go into buckets by a hash, which mostly have one
 * or two. Many pairs may have one hash, of lists that were made for it all of them; a bucket with more than a few is in
 * order, so that a pair is found in it by halving.
 */
#include "column.h"
#include "dispatch.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <string.h>

/* Pairs that a thread matches at a time. */
enum { PART = 16384 };

static uint64_t pair_at(const narc_pairs *pairs, size_t k) {
    return narc_join_pair(narc_index_at(pairs->a, k), narc_index_at(pairs->b, k));
}

typedef struct list_check {
    const narc_pairs *pairs;
    atomic_bool disorder;
} list_check;

static void check_order(void *argument, size_t part, size_t first, size_t end) {
    list_check *check = argument;
    uint64_t last = pair_at(check->pairs, part > 0 ? first - 1 : 0);
    bool fine = true;
    for (size_t k = first; k < end; k++) {
        const uint64_t pair = pair_at(check->pairs, k);
        fine &= last <= pair;
        last = pair;
    }
    if (!fine)
        atomic_store_explicit(&check->disorder, true, memory_order_relaxed);
}

static bool is_in_order(const narc_pairs *pairs, const narc_workers *workers) {
    list_check check = {.pairs = pairs};
    narc_run_ranges(workers, pairs->count, PART, check_order, &check);
    return !atomic_load_explicit(&check.disorder, memory_order_relaxed);
}

size_t narc_find_pair(const narc_pairs *pairs, uint64_t pair) {
    size_t first = 0, end = pairs->count;
    while (first < end) {
        const size_t middle = first + (end - first) / 2;
        if (pair_at(pairs, middle) < pair)
            first = middle + 1;
        else
            end = middle;
    }
    return first;
}

/* New pairs first .. end - 1, both lists in order. */
static void match_by_walk(const narc_pairs *old_pairs, const narc_pairs *new_pairs, size_t first, size_t end,
                          uint32_t *out_match) {
    size_t at = narc_find_pair(old_pairs, pair_at(new_pairs, first));
    uint64_t there = at < old_pairs->count ? pair_at(old_pairs, at) : UINT64_MAX;
    for (size_t k = first; k < end; k++) {
        const uint64_t pair = pair_at(new_pairs, k);
        while (there < pair)
            there = ++at < old_pairs->count ? pair_at(old_pairs, at) : UINT64_MAX;
        out_match[k] = there == pair && at < old_pairs->count ? (uint32_t)at : NARC_NO_MATCH;
    }
}

/* ------------------------------------------------------------------------------------------------ buckets */

/* Of bucket k: items starts[k] .. starts[k + 1] - 1, indices of old pairs. They rise; in a bucket with more than FEW
 * they are in the order of their pairs, and rise among equal ones. */
typedef struct buckets {
    const narc_pairs *pairs;
    uint32_t *starts, *items;
    unsigned bits; /* there are 2^bits buckets, more than pairs if these are below 2^31 */
} buckets;

enum { FEW = 8 };

/* Products with the golden ratio's bits, and of the second the upper bits, which depend on all of the pair's. */
static size_t find_bucket(const buckets *t, uint64_t pair) {
    const uint64_t ratio = 0x9e3779b97f4a7c15u, once = pair * ratio;
    return (size_t)((once ^ once >> 32) * ratio >> 1 >> (63 - t->bits));
}

static bool comes_before(const void *context, uint32_t one, uint32_t other) {
    const buckets *const t = context;
    const uint64_t first = pair_at(t->pairs, one), second = pair_at(t->pairs, other);
    return first < second || (first == second && one < other);
}

/* A counting sort by bucket. */
static void fill_buckets(const buckets *t) {
    const size_t count = t->pairs->count, bucket_count = (size_t)1 << t->bits;
    uint32_t sum = 0;
    memset(t->starts, 0, (bucket_count + 1) * sizeof *t->starts);
    for (size_t k = 0; k < count; k++)
        t->starts[find_bucket(t, pair_at(t->pairs, k))]++;
    for (size_t k = 0; k <= bucket_count; k++)
        t->starts[k] = sum += t->starts[k];
    for (size_t k = count; k-- > 0;)
        t->items[--t->starts[find_bucket(t, pair_at(t->pairs, k))]] = (uint32_t)k;
    for (size_t k = 0; k < bucket_count; k++)
        if (t->starts[k + 1] - t->starts[k] > FEW)
            narc_sort_indices(t->items + t->starts[k], t->starts[k + 1] - t->starts[k], comes_before, t);
}

/* The first old pair that is this one. */
static uint32_t find_match(const buckets *t, uint64_t pair) {
    const size_t bucket = find_bucket(t, pair);
    uint32_t first = t->starts[bucket], end = t->starts[bucket + 1];
    while (end - first > FEW) {
        const uint32_t middle = first + (end - first) / 2;
        if (pair_at(t->pairs, t->items[middle]) < pair)
            first = middle + 1;
        else
            end = middle + 1;
    }
    for (; first < end; first++)
        if (pair_at(t->pairs, t->items[first]) == pair)
            return t->items[first];
    return NARC_NO_MATCH;
}

/* NARC_ERROR_MEMORY. */
static narc_status make_buckets(narc_broad_phase *broad, const narc_pairs *pairs, buckets *out) {
    *out = (buckets){.pairs = pairs};
    while (out->bits < 31 && pairs->count >> out->bits > 0)
        out->bits++;
    const size_t start_count = ((size_t)1 << out->bits) + 1;
    if (narc_reserve_matches(broad, start_count, pairs->count) != NARC_OK)
        return NARC_ERROR_MEMORY;
    out->starts = broad->match_memory;
    out->items = out->starts + start_count;
    fill_buckets(out);
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ the walk */

typedef struct matching {
    buckets old;
    const narc_pairs *pairs;
    uint32_t *out_match;
} matching;

static void match_part(void *argument, size_t part, size_t first, size_t end) {
    const matching *m = argument;
    (void)part;
    if (!m->old.starts)
        match_by_walk(m->old.pairs, m->pairs, first, end, m->out_match);
    else
        for (size_t k = first; k < end; k++)
            m->out_match[k] = find_match(&m->old, pair_at(m->pairs, k));
}

void narc_match_in_order(const narc_pairs *old_pairs, const narc_pairs *new_pairs, const narc_workers *workers,
                         uint32_t *out_match) {
    matching m = {{.pairs = old_pairs}, new_pairs, out_match};
    narc_run_ranges(workers, new_pairs->count, PART, match_part, &m);
}

narc_status narc_match_pairs(narc_broad_phase *broad, const narc_pairs *old_pairs, const narc_pairs *new_pairs,
                             const narc_workers *workers, uint32_t *out_match) {
    matching m = {{.pairs = old_pairs}, new_pairs, out_match};
    if ((!is_in_order(new_pairs, workers) || !is_in_order(old_pairs, workers)) &&
        make_buckets(broad, old_pairs, &m.old) != NARC_OK)
        return NARC_ERROR_MEMORY;
    narc_run_ranges(workers, new_pairs->count, PART, match_part, &m);
    return NARC_OK;
}
