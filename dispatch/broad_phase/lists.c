/* SPDX-License-Identifier: MIT
 *
 * lists.c - the parts of a new list of narc_update_pairs(): pairs that stay, which pair of the last list each was,
 * which are new or lost, marks.
 */
#include "dispatch.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <string.h>

/* Pairs that a thread matches at a time: some 10 microseconds of work. */
enum { PART = 4096 };

/* ------------------------------------------------------------------------------------------------ matching */

static bool is_pair(const narc_kept_list *list, size_t k, uint32_t a, uint32_t b) {
    return k < list->list.pairs.count && list->a[k] == a && list->b[k] == b;
}

typedef struct matching {
    const narc_kept_list *last;
    narc_kept_list *made;
    const uint32_t *last_index;
} matching;

/* New pairs first .. end - 1 by the numbers that their bodies had. Behind the last match comes the next, mostly. */
static void match_part(void *argument, size_t part, size_t first, size_t end) {
    const matching *const m = argument;
    size_t at = first;
    (void)part;
    for (size_t k = first; k < end; k++) {
        const uint32_t a = m->last_index[m->made->a[k]], b = m->last_index[m->made->b[k]];
        const uint32_t low = a < b ? a : b, high = a < b ? b : a;
        if (!is_pair(m->last, at, low, high))
            at = narc_find_pair(&m->last->list.pairs, narc_join_pair(low, high));
        const bool found = high != NARC_NO_MATCH && is_pair(m->last, at, low, high);
        m->made->previous[k] = found ? (uint32_t)at++ : NARC_NO_MATCH;
        m->made->marks[k] = found && b < a ? NARC_FLIPPED : 0;
    }
}

void narc_match_lists(const narc_kept_list *last, narc_kept_list *made, const uint32_t *last_index,
                      const narc_workers *workers) {
    matching m = {last, made, last_index};
    narc_run_ranges(workers, made->list.pairs.count, PART, match_part, &m);
}

size_t narc_list_added(narc_kept_list *last, narc_kept_list *made) {
    const size_t count = made->list.pairs.count, last_count = last->list.pairs.count;
    size_t added = 0;
    memset(last->matched, 0, last_count);
    for (size_t k = 0; k < count; k++)
        if (made->previous[k] == NARC_NO_MATCH)
            made->added[added++] = (uint32_t)k;
        else
            last->matched[made->previous[k]] = 1;
    made->list.added_count = added;
    return last_count - (count - added);
}

void narc_list_lost(const narc_kept_list *last, narc_kept_list *made, size_t lost_count) {
    const uint8_t *at = last->matched;
    for (size_t lost = 0; lost < lost_count; lost++, at++) {
        at = memchr(at, 0, last->list.pairs.count - (size_t)(at - last->matched));
        const size_t k = (size_t)(at - last->matched);
        const uint32_t a = last->a[k], b = last->b[k];
        made->lost[lost] = (narc_lost_pair){.pair = (uint32_t)k,
                                            .a = a,
                                            .b = b,
                                            .marks = last->marks[k] & NARC_KINDS,
                                            .id_a = last->has_ids ? last->ids[a] : a,
                                            .id_b = last->has_ids ? last->ids[b] : b};
    }
    made->list.lost = made->lost;
    made->list.lost_count = lost_count;
}

/* ------------------------------------------------------------------------------------------------ pairs that stay */

static void list_numbers(uint32_t *out, uint32_t first, uint32_t count) {
    for (uint32_t k = 0; k < count; k++)
        out[k] = first + k;
}

/* Takes pairs first .. end - 1 of the last list over, to place `to`. */
static void take_over(const narc_kept_list *last, size_t first, size_t end, narc_kept_list *made, size_t to) {
    const size_t count = end - first;
    memcpy(made->a + to, last->a + first, count * sizeof *made->a);
    memcpy(made->b + to, last->b + first, count * sizeof *made->b);
    list_numbers(made->previous + to, (uint32_t)first, (uint32_t)count);
    for (size_t k = 0; k < count; k++)
        made->marks[to + k] = last->marks[first + k] & NARC_KINDS;
}

/* The first pair of a list from `at` on that has a fresh body, or is not before `next`; the number of pairs if there is
 * none. Four at a time, as most of them have not. */
static size_t skip_pairs(const uint8_t *fresh, const narc_kept_list *list, size_t at, uint64_t next) {
    const uint32_t *const a = list->a, *const b = list->b;
    const size_t count = list->list.pairs.count;
    while (count - at >= 4 && narc_join_pair(a[at + 3], b[at + 3]) < next &&
           !(fresh[a[at]] | fresh[b[at]] | fresh[a[at + 1]] | fresh[b[at + 1]] | fresh[a[at + 2]] | fresh[b[at + 2]] |
             fresh[a[at + 3]] | fresh[b[at + 3]]))
        at += 4;
    while (at < count && !(fresh[a[at]] | fresh[b[at]]) && narc_join_pair(a[at], b[at]) < next)
        at++;
    return at;
}

/* A pair of a fresh body that is there still belongs to the run of those that stay. */
size_t narc_merge_pairs(const uint8_t *fresh, narc_kept_list *last, narc_kept_list *made, const uint32_t *a,
                        const uint32_t *b, size_t count) {
    const size_t last_count = last->list.pairs.count;
    size_t first = 0, at = 0, k = 0, to = 0, added = 0, lost = 0;
    memset(last->matched, 1, last_count);
    for (;;) {
        const uint64_t next = k < count ? narc_join_pair(a[k], b[k]) : UINT64_MAX;
        at = skip_pairs(fresh, last, at, next);
        const uint64_t there = at < last_count ? narc_join_pair(last->a[at], last->b[at]) : UINT64_MAX;
        if (there == next && k == count) /* both lists are at their ends */
            break;
        if (there == next) {
            at++;
            k++;
            continue;
        }
        take_over(last, first, at, made, to);
        to += at - first;
        first = at;
        if (there < next) {
            last->matched[at] = 0;
            first = ++at;
            lost++;
            continue;
        }
        made->a[to] = a[k];
        made->b[to] = b[k++];
        made->previous[to] = NARC_NO_MATCH;
        made->added[added++] = (uint32_t)to++;
    }
    take_over(last, first, at, made, to);
    made->list.pairs.count = to + at - first;
    made->list.added_count = added;
    return lost;
}

/* ------------------------------------------------------------------------------------------------ marks */

/* `kinds` NULL: there is no filter. */
static void mark_pair(const uint8_t *kinds, narc_kept_list *made, size_t k) {
    const unsigned both = kinds ? kinds[made->a[k]] | kinds[made->b[k]] : 0u;
    made->marks[k] = (uint8_t)((made->marks[k] & NARC_FLIPPED) | both);
}

void narc_mark_pairs(const narc_broad_phase *broad, narc_kept_list *made) {
    const uint8_t *const kinds = broad->has_filter ? broad->kinds : NULL;
    for (size_t k = 0; k < made->list.pairs.count && broad->has_other_kinds; k++)
        mark_pair(kinds, made, k);
    for (size_t i = 0; i < made->list.added_count && !broad->has_other_kinds; i++)
        mark_pair(kinds, made, made->added[i]);
}
