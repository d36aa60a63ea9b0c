/* SPDX-License-Identifier: MIT
 *
 * narc_broad_phase.h - from bodies to pairs: world boxes, pairs of boxes that overlap, and what of the last step
 * belongs to the pairs of this one.
 *
 * The mental model
 *
 *   A simulation step goes from bodies to pairs that may touch, and from these to contacts (narc.h). One call takes
 *   the first way:
 *
 *       narc_update_pairs()       the list of all pairs of bodies that are close, and what of it is new
 *
 *   A narc_broad_phase keeps the list from step to step. Each body has a box, which is larger than the body by a
 *   SKIN. While all bodies stay inside their boxes, the list stays as it is: it has all pairs that are close, and some
 *   that are not. When one has left its box, it gets a new box, and so do all that have used up half of their skin; a
 *   new list has the pairs of these boxes, and each pair is told its index in the last list. In a scene at rest few
 *   bodies move, and only their pairs are looked for. What the caller knows of a pair (impulses, friction history) is
 *   carried over by that index with narc_gather(), or stays where it is if the list was kept. Pairs that are new or lost
 *   are listed: they begin and end what depends on being close.
 *
 *   The list is what the broad phase owns. It is valid until the next call of narc_update_pairs(),
 *   narc_update_box_pairs() or narc_forget_pairs() with this object, or until that is destroyed. A call that fails
 *   leaves the last list as it was, valid still, and the next call continues from there.
 *
 *   Bodies come and go, and change their numbers: with a column of ids the broad phase knows them again. Without ids
 *   body k is body k, so that bodies may only be added and removed at the end.
 *
 *   Shapes may be replaced, removed and exchanged at any time: only the boxes of the bodies count. So may filters: a
 *   body with another filter has another list made.
 *
 *   Pairs come in the order of (a, b) with a < b, which is also the order that keeps memory close: a batch of pairs
 *   that are sorted by their first body loads each body once. The answer is the same for any number of threads and on
 *   every instruction set.
 *
 *   Those who keep lists themselves have the steps below: narc_compute_boxes(), narc_find_pairs(), narc_match_pairs().
 *
 * Example
 *
 *     narc_pair_filter filter = {.kind = NARC_COLUMN(body, kind)};
 *     narc_pair_options options = {.margin = 0.02f, .skin = 0.05f, .filter = &filter, .id = NARC_COLUMN(body, id)};
 *     const narc_pair_list *list;
 *     narc_update_pairs(broad, shapes, &bodies, &options, &list, &error);
 *     if (!list->kept) {
 *         narc_gather(list->previous, list->pairs.count, sizeof *caches, last_caches, caches);
 *         for (size_t k = 0; k < list->lost_count; k++)
 *             end_event(list->lost[k].id_a, list->lost[k].id_b);
 *     }
 *     narc_find_contacts(shapes, &bodies, &list->pairs, ...);
 */
#ifndef NARC_BROAD_PHASE_H
#define NARC_BROAD_PHASE_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* ------------------------------------------------------------------------------------------------ pairs of a step */

/* How pairs are kept; what is 0 or NULL is left out, as all is for {0}.
 *   margin              at least 0: all pairs of bodies that are closer than this are listed: at least the margin that
 *                       contacts are then asked for
 *   skin                at least 0: how much larger than its body the box of a kept list is, on every side. A larger
 *                       one keeps lists longer, and makes them longer. 0: none is kept but where nothing moves
 *   motion_x, motion_y  world axes: what each body moves in this step, as in narc_box_options. A list has all
 *                       pairs that come close on the way
 *   reach               at least 0: how far beyond its box a body may reach in this step, such as by rotation
 *   id                  what a body is known by, whatever its number; no two have the same. A counter that
 *                       each new body takes its id from, or a handle with its generation. Left out: its number.
 *   filter              which bodies may form a pair, and which are static, asleep, sensors; NULL: all, and all move
 *   workers             threads to use; NULL: the calling one
 * Columns have one item for each body. */
typedef struct narc_pair_options {
    float margin, skin;
    narc_float_column motion_x, motion_y;
    narc_float_column reach;
    narc_word_column id;
    const narc_pair_filter *filter;
    const narc_workers *workers;
    void *reserved[4]; /* NULL */
} narc_pair_options;

/* The pairs of bodies that are closer than the margin, and perhaps others, none further apart than margin + 3 * skin
 * and the motion (of boxes, and but for rounding, NARC_BOX_ROOM) when the list was made.
 *   A list has all pairs of KEPT BOXES that overlap and may form a pair. When a body has left its kept box, or has
 * another filter, it and all bodies with less than half of the skin, or more than one and a half, left on a side get new
 * ones, larger than they are now by the skin. All bodies do if there are more or fewer than in the last call, or others
 * by their ids, with the first filter, after narc_forget_pairs(), and perhaps after a call that failed.
 *   bodies    at most 2^32 - 2
 *   options   NULL: defaults
 *   out_list  see narc_pair_list; its arrays belong to `broad`. A broken body (narc_bodies; also one whose motion or
 *             reach is NaN, infinite, or below 0 as a reach) is in no pair, and counted in `skipped`.
 * The list depends on the bodies of this call and of those before. For the same calls it is the same, bit by bit.
 *
 * Removal and insertion: take the body out of your arrays or put it in, in any way, with its id. If the last one fills
 * the gap (swap-with-last), its pairs have their `previous` index as all others have. Where bodies of a pair have
 * changed their order (a was b), its mark NARC_FLIPPED says so: normals, feature ids and impulses that you kept are
 * those of the pair (b, a). A lost pair names its bodies by their ids and by their numbers in the last list, whether they
 * still exist or not. Ids that come back, as those of pools without a generation may, make one body of two.
 *
 * Sleep: see narc_pair_filter's table. Boxes of bodies at rest are looked at like others, so that a body that is static
 * or asleep may be put anywhere.
 *
 * Time: a look at each body, and narc_compute_boxes() of those whose position, rotation, scale or shape differs from
 * the last call's (of all where there is motion or a reach, or the store of shapes has changed). With a new list also a
 * walk over all pairs, and a search for those of the bodies with new boxes; if these are more than one in 16, or others
 * by their ids, the time of narc_find_pairs() and narc_match_pairs(). Which way is taken changes no bit of the list.
 * Memory: some 240 bytes for each body, 260 with ids, and some 55 for each pair, and a quarter of it for growth; kept
 * from step to step.
 * Errors: as narc_compute_boxes() and narc_find_pairs(), but for NARC_ERROR_CAPACITY; NARC_ERROR_ARGUMENT (a negative
 * skin, two bodies with the same id: found at the latest when it would match a body wrongly), NARC_ERROR_NOT_FINITE,
 * NARC_ERROR_MEMORY. On an error `*out_list` is untouched, and the last list is as it was and valid. */
NARC_API narc_status narc_update_pairs(narc_broad_phase *broad, const narc_shapes *shapes, const narc_bodies *bodies,
                                       const narc_pair_options *options, const narc_pair_list **out_list,
                                       narc_error *error);

/* The same for boxes that the caller has. `count` boxes, at most 2^32 - 2, each around what it holds in this step:
 * there are no motion columns. An empty box is in no pair, and counted. */
NARC_API narc_status narc_update_box_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                           const narc_pair_options *options, const narc_pair_list **out_list,
                                           narc_error *error);

/* Forgets the list, and keeps the memory: for another level, or a state that was restored. All pairs of the next list
 * are new, and none is lost. NULL: nothing happens. */
NARC_API void narc_forget_pairs(narc_broad_phase *broad);

/* ------------------------------------------------------------------------------------------------ its steps */

/* What narc_compute_boxes() puts boxes around; what is 0 or NULL is left out, as all is for {0}.
 *   margin              at least 0: how far a box reaches beyond its body on every side. To find all pairs that are
 *                       closer than some distance, half of it.
 *   motion_x, motion_y  world axes: what each body moves. Its box holds the body at its position, at position +
 *                       motion, and everywhere between.
 *   first, count        a sub-range of the bodies; count 0: to the end. Only its boxes are written
 *   workers             threads to use; NULL: the calling one
 *   out_skipped         how many bodies have no box; NULL: nobody asks */
typedef struct narc_box_options {
    float margin;
    narc_float_column motion_x, motion_y;
    size_t first, count;
    const narc_workers *workers;
    size_t *out_skipped;
    void *reserved[4]; /* NULL */
} narc_box_options;

/* The axis-aligned boxes of all bodies in the world, as tight as single precision allows: never too small for the body,
 * however large its position, and on each side at most NARC_BOX_ROOM * (|coordinate of the position| + |motion| +
 * margin + extent) too large, the extent as in narc.h. (Where a shape's arcs were given a little apart, see
 * NARC_TOLERANCE, that much more is uncertain.)
 *   options    NULL: defaults
 *   out_boxes  bodies->count items, overlapping none of the inputs. A body that is broken (see narc_bodies), that has a
 *              NaN or an infinity as its motion, or whose box is beyond the range of floats, gets the empty box from
 *              (INFINITY, INFINITY) to (-INFINITY, -INFINITY), which narc_find_pairs() leaves out.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, 2^32 bodies or more, a
 * negative margin), NARC_ERROR_NOT_FINITE (margin), NARC_ERROR_INDEX (`error` names the body and the shape), and as
 * narc_find_overlaps() for NARC_ISA. No bodies: NARC_OK. Allocates nothing. Thread-safe.
 * Source: the support function of an arc shape (docs/algorithm.md) along four axes; kernels/broad/boxes.c. */
NARC_API narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies,
                                        const narc_box_options *options, narc_box *out_boxes, narc_error *error);

/* 40 roundings; derived in kernels/broad/boxes.c. */
#define NARC_BOX_ROOM (40.0 / 16777216.0)

/* All pairs a < b of boxes that overlap or touch, in the order of a and then b.
 *   boxes      `count` of them, at most 2^32 - 2; box k is that of body k
 *   filter     see narc_pair_filter; its columns have `count` items
 *   workers    threads to use; NULL: the calling one
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
                                     const narc_pair_filter *filter, const narc_workers *workers, uint32_t *out_a,
                                     uint32_t *out_b, size_t capacity, size_t *out_count, narc_error *error);

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
                                      const narc_workers *workers, uint32_t *out_match, narc_error *error);

/* Carries a column over: item k of `out_items` becomes item match[k] of `items`, or all zero bytes where there is no
 * match. Items are `size` bytes, without gaps. `match` has `count` items below the number of items, or NARC_NO_MATCH;
 * out_items overlaps nothing else. */
NARC_API void narc_gather(const uint32_t *match, size_t count, size_t size, const void *items, void *out_items);

#ifdef __cplusplus
}
#endif

#endif
