/* SPDX-License-Identifier: MIT
 *
 * narc_broad_phase.h - from bodies to pairs: world boxes, pairs of boxes that overlap, and what of the last step
 * belongs to the pairs of this one.
 *
 * The mental model
 *
 *   A simulation step goes from boxes around the bodies to pairs of boxes that overlap, and from pairs to contacts:
 *
 *       narc_compute_boxes()      the boxes of all bodies
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
 *     narc_compute_boxes(shapes, &bodies, NULL, 0, boxes, &error);
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

/* What narc_compute_boxes() puts boxes around; what is 0 or NULL is left out, as all is for {0}.
 *   margin              at least 0: how far a box reaches beyond its body on every side. To find all pairs that are
 *                       closer than some distance, half of it.
 *   motion_x, motion_y  world axes: what each body moves. Its box holds the body at its position, at position +
 *                       motion, and everywhere between.
 *   out_skipped         how many bodies have no box; NULL: nobody asks */
typedef struct narc_box_options {
    float margin;
    narc_float_column motion_x, motion_y;
    size_t *out_skipped;
} narc_box_options;

/* The axis-aligned boxes of all bodies in the world, as tight as single precision allows: never too small for the body,
 * however large its position, and on each side at most NARC_BOX_ROOM * (|coordinate of the position| + |motion| +
 * margin + extent) too large, the extent as in narc.h. (Where a shape's arcs were given a little apart, see
 * NARC_TOLERANCE, that much more is uncertain.)
 *   options    NULL: defaults
 *   threads    as in narc_find_overlaps()
 *   out_boxes  bodies->count items, overlapping none of the inputs. A body that is broken (see narc_bodies), that has a
 *              NaN or an infinity as its motion, or whose box is beyond the range of floats, gets the empty box from
 *              (INFINITY, INFINITY) to (-INFINITY, -INFINITY), which narc_find_pairs() leaves out.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, 2^32 bodies or more, a
 * negative margin), NARC_ERROR_NOT_FINITE (margin), NARC_ERROR_INDEX (`error` names the body and the shape), and as
 * narc_find_overlaps() for NARC_ISA. No bodies: NARC_OK. Allocates nothing. Thread-safe.
 * Source: the support function of an arc shape (docs/algorithm.md) along four axes; kernels/broad/boxes.inl. */
NARC_API narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies,
                                        const narc_box_options *options, unsigned threads, narc_box *out_boxes,
                                        narc_error *error);

/* The same for bodies first .. first + count - 1 (any first and count), in the calling thread, for callers that have
 * their own job system. `out_boxes` is that of all bodies; only those of the sub-range are written, and out_skipped
 * counts these. */
NARC_API narc_status narc_compute_boxes_range(const narc_shapes *shapes, const narc_bodies *bodies, size_t first,
                                              size_t count, const narc_box_options *options, narc_box *out_boxes,
                                              narc_error *error);

/* 40 roundings; derived in kernels/broad/boxes.inl. */
#define NARC_BOX_ROOM (40.0 / 16777216.0)

/* All pairs a < b of boxes that overlap or touch, in the order of a and then b.
 *   boxes      `count` of them, at most 2^32 - 2; box k is that of body k
 *   filter     see narc_pair_filter; its columns have `count` items
 *   threads    as in narc_find_overlaps()
 *   out_a      `capacity` items each, overlapping nothing else
 *   out_b
 *   out_count  how many there are. If that is more than `capacity`, nothing else is written and NARC_ERROR_CAPACITY is
 *              returned; make room and call again.
 * Time grows with n log n, n the number of boxes, and with the pairs of boxes that would overlap if each were 16 times
 * as wide and 8 times as high. Sizes may differ by any factor: boxes are divided into levels, heights within a factor
 * of 4 and widths within 16, and each box is searched for in every level that has boxes. So the bound is L n log n for
 * L levels, and the pairs; sizes that differ by 1 : 10,000 in height and in width make at most 32 levels. Boxes that
 * all lie in one row are sorted and swept by one thread.
 * Errors: NARC_ERROR_ARGUMENT (NULL, too many boxes), NARC_ERROR_COUNT (2^32 pairs or more, after the filter; counting
 * stops there), NARC_ERROR_MEMORY, NARC_ERROR_CAPACITY.
 * Source: sweep and prune (Baraff 1992; Cohen and others 1995) in strips, by levels of size. */
NARC_API narc_status narc_find_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                     const narc_pair_filter *filter, unsigned threads, uint32_t *out_a, uint32_t *out_b,
                                     size_t capacity, size_t *out_count, narc_error *error);

/* No pair of the old list. */
#define NARC_NO_MATCH UINT32_MAX

/* For each pair of a new list: its index in an old list, or NARC_NO_MATCH. Pairs (a, b) and (b, a) are different. Only
 * bodies are compared: of one pair with several shifts (periodic images) all match the first. Both
 * lists may be in any order; two lists in the order of (a, b), as narc_find_pairs() makes them, are matched without
 * memory, in one walk. Others take up to 15 bytes for each old pair and time that grows with n log n at most, whatever
 * the pairs are. If a pair stands several times in the old list, the first counts.
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
