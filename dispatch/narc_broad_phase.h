/* SPDX-License-Identifier: MIT
 *
 * narc_broad_phase.h - from bodies to pairs: world boxes, pairs of boxes that overlap, and what of the last step
 * belongs to the pairs of this one.
 *
 * The mental model
 *
 *   A simulation step goes from boxes around the bodies to pairs of boxes that overlap, and from pairs to contacts:
 *
 *       narc_find_pairs()         all pairs of boxes that overlap and whose filters let them
 *       narc_match_pairs()        which pair of the last step each pair was
 *       narc_gather()             carries hints, impulses, friction history from the last step's pairs to this one's
 *       narc_find_contacts()      (narc.h)
 *
 *   Pairs come in the order of (a, b) with a < b, which is also the order that keeps memory close: a batch of pairs
 *   that are sorted by their first body loads each body once. The answer is the same for any number of threads and on
 *   every instruction set.
 *
 *   A narc_broad_phase (narc_shapes.h) owns the memory that finding and matching need.
 *
 * Example
 *
 *     narc_find_pairs(broad, boxes, count, NULL, 0, a, b, capacity, &found, &error);
 *     narc_pairs pairs = {.count = found, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
 *     narc_match_pairs(broad, &last_pairs, &pairs, 0, match, &error);
 *     narc_gather(match, found, sizeof *hints, last_hints, hints);
 */
#ifndef NARC_BROAD_PHASE_H
#define NARC_BROAD_PHASE_H

#include "narc_shapes.h"

#ifdef __cplusplus
extern "C" {
#endif

/* All pairs a < b of boxes that overlap or touch, in the order of a and then b.
 *   boxes      `count` of them, at most 2^32 - 2; box k is that of body k
 *   filter     see narc_pair_filter; its columns have `count` items
 *   threads    as in narc_find_overlaps()
 *   out_a      `capacity` items each, overlapping nothing else
 *   out_b
 *   out_count  how many there are. If that is more than `capacity`, nothing else is written and NARC_ERROR_CAPACITY is
 *              returned; make room and call again.
 * Time is in proportion to the boxes, the pairs, and the pairs that overlap in x and nearly in y. Sizes may differ by
 * any factor, but every strip of small boxes is swept with whole strips of the larger ones around it: in all up to the
 * number of the larger boxes times the ratio of their heights, or times the number of the small ones.
 * Errors: NARC_ERROR_ARGUMENT (NULL, too many boxes), NARC_ERROR_COUNT (2^32 or more overlap, before the filter),
 * NARC_ERROR_MEMORY, NARC_ERROR_CAPACITY.
 * Source: sweep and prune (Baraff 1992; Cohen and others 1995) in strips, by levels of size. */
NARC_API narc_status narc_find_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                     const narc_pair_filter *filter, unsigned threads, uint32_t *out_a, uint32_t *out_b,
                                     size_t capacity, size_t *out_count, narc_error *error);

/* No pair of the old list. */
#define NARC_NO_MATCH UINT32_MAX

/* For each pair of a new list: its index in an old list, or NARC_NO_MATCH. Pairs (a, b) and (b, a) are different. Both
 * lists may be in any order; two lists in the order of (a, b), as narc_find_pairs() makes them, are matched without
 * memory, in one walk. If a pair stands several times in the old list, the first counts.
 *   old_pairs, new_pairs   at most 2^32 - 2 pairs each
 *   out_match              new_pairs->count items, overlapping nothing else
 * Errors: NARC_ERROR_ARGUMENT (NULL, too many pairs), NARC_ERROR_MEMORY. */
NARC_API narc_status narc_match_pairs(narc_broad_phase *broad, const narc_pairs *old_pairs, const narc_pairs *new_pairs,
                                      unsigned threads, uint32_t *out_match, narc_error *error);

/* Carries a column over: item k of `out_items` becomes item match[k] of `items`, or all zero bytes where there is no
 * match. Items are `size` bytes, without gaps. `match` has `count` items below the number of items, or NARC_NO_MATCH;
 * out_items overlaps nothing else. */
NARC_API void narc_gather(const uint32_t *match, size_t count, size_t size, const void *items, void *out_items);

#ifdef __cplusplus
}
#endif

#endif
