/* SPDX-License-Identifier: MIT
 *
 * match.c - narc_match_pairs() and narc_gather(): what of the last step belongs to the pairs of this one.
 *
 * Two lists in order are walked side by side. Otherwise the old pairs go into a hash table with open addressing, at
 * most half full.
 */
#include "broad_phase.h"
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"

#include <string.h>

/* Pairs that a thread matches at a time. */
enum { PART = 16384 };

/* Both indices of a pair as one number; pairs in order have rising numbers. */
static uint64_t pair_at(const narc_pairs *pairs, size_t k) {
    return (uint64_t)narc_index_at(pairs->a, k) << 32 | narc_index_at(pairs->b, k);
}

static size_t count_parts(size_t count) { return (count + PART - 1) / PART; }

static size_t end_of_part(size_t count, size_t part) { return count - part * PART < PART ? count : (part + 1) * PART; }

static bool in_order(const narc_pairs *pairs, unsigned threads) {
    const size_t parts = count_parts(pairs->count);
    const int team = narc_team_size(threads, parts);
    bool fine = true;
    (void)team;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(&& : fine) if (team > 1)
#endif
    for (size_t part = 0; part < parts; part++) {
        const size_t first = part * PART, end = end_of_part(pairs->count, part);
        uint64_t last = pair_at(pairs, part > 0 ? first - 1 : 0);
        for (size_t k = first; k < end; k++) {
            const uint64_t pair = pair_at(pairs, k);
            fine &= last <= pair;
            last = pair;
        }
    }
    return fine;
}

/* The first pair of a list in order that is not before `pair`. */
static size_t find_pair(const narc_pairs *pairs, uint64_t pair) {
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
static void walk(const narc_pairs *old_pairs, const narc_pairs *new_pairs, size_t first, size_t end,
                 uint32_t *out_match) {
    size_t at = find_pair(old_pairs, pair_at(new_pairs, first));
    uint64_t there = at < old_pairs->count ? pair_at(old_pairs, at) : UINT64_MAX;
    for (size_t k = first; k < end; k++) {
        const uint64_t pair = pair_at(new_pairs, k);
        while (there < pair)
            there = ++at < old_pairs->count ? pair_at(old_pairs, at) : UINT64_MAX;
        out_match[k] = there == pair && at < old_pairs->count ? (uint32_t)at : NARC_NO_MATCH;
    }
}

/* ------------------------------------------------------------------------------------------------ hash table */

/* Open addressing: a place holds an old pair's index + 1, or 0 while it is free. */
typedef struct table {
    uint32_t *places;
    size_t mask;
} table;

/* A multiplier with well-mixed bits (the golden ratio's), and the upper half of the product. */
static size_t hash(uint64_t pair) {
    const uint64_t mixed = (pair ^ pair >> 32) * 0x9e3779b97f4a7c15u;
    return (size_t)(mixed >> 32 ^ mixed >> 7);
}

static size_t table_size(size_t count) {
    size_t size = 16;
    while (size < 2 * count)
        size *= 2;
    return size;
}

/* The place of a pair, or the free place where it belongs. */
static size_t find_place(const table *t, const narc_pairs *old_pairs, uint64_t pair) {
    size_t at = hash(pair) & t->mask;
    while (t->places[at] != 0 && pair_at(old_pairs, t->places[at] - 1) != pair)
        at = (at + 1) & t->mask;
    return at;
}

static void fill(const table *t, const narc_pairs *old_pairs) {
    memset(t->places, 0, (t->mask + 1) * sizeof *t->places);
    for (size_t k = 0; k < old_pairs->count; k++) {
        uint32_t *const place = &t->places[find_place(t, old_pairs, pair_at(old_pairs, k))];
        if (*place == 0) /* the first of equal pairs counts */
            *place = (uint32_t)(k + 1);
    }
}

/* ------------------------------------------------------------------------------------------------ the calls */

static narc_status check(const narc_pairs *pairs, const char *name, narc_error *error) {
    if (!pairs)
        return narc_fail_missing(error, name);
    if (pairs->count > UINT32_MAX - 1)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)pairs->count, "%s: %zu pairs, at most %lu", name,
                         pairs->count, (unsigned long)(UINT32_MAX - 1));
    if (pairs->count > 0 && (!pairs->a.base || !pairs->b.base))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s.%c is NULL", name, pairs->a.base ? 'b' : 'a');
    return NARC_OK;
}

narc_status narc_match_pairs(narc_broad_phase *broad, const narc_pairs *old_pairs, const narc_pairs *new_pairs,
                             unsigned threads, uint32_t *out_match, narc_error *error) {
    narc_status status = check(old_pairs, "old_pairs", error);
    if (status == NARC_OK)
        status = check(new_pairs, "new_pairs", error);
    if (status != NARC_OK)
        return status;
    if (!broad || (new_pairs->count > 0 && !out_match))
        return narc_fail_missing(error, broad ? "out_match" : "broad");
    table t = {NULL, 0};
    if (!in_order(old_pairs, threads) || !in_order(new_pairs, threads)) {
        const size_t size = table_size(old_pairs->count);
        if (narc_reserve_matches(broad, size * sizeof *t.places) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)old_pairs->count, "not enough memory for %zu pairs",
                             old_pairs->count);
        t = (table){broad->match_memory, size - 1};
        fill(&t, old_pairs);
    }
    const size_t count = new_pairs->count, parts = count_parts(count);
    const int team = narc_team_size(threads, parts);
    (void)team;
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) if (team > 1)
#endif
    for (size_t part = 0; part < parts; part++) {
        const size_t first = part * PART, end = end_of_part(count, part);
        if (!t.places) {
            walk(old_pairs, new_pairs, first, end, out_match);
            continue;
        }
        for (size_t k = first; k < end; k++) {
            const uint32_t place = t.places[find_place(&t, old_pairs, pair_at(new_pairs, k))];
            out_match[k] = place ? place - 1 : NARC_NO_MATCH;
        }
    }
    return NARC_OK;
}

void narc_gather(const uint32_t *match, size_t count, size_t size, const void *items, void *out_items) {
    for (size_t k = 0; k < count; k++) {
        char *const to = (char *)out_items + k * size;
        if (match[k] == NARC_NO_MATCH)
            memset(to, 0, size);
        else if (size == sizeof(uint32_t)) /* the usual size, without a call */
            memcpy(to, (const char *)items + match[k] * sizeof(uint32_t), sizeof(uint32_t));
        else
            memcpy(to, (const char *)items + match[k] * size, size);
    }
}
