/* SPDX-License-Identifier: MIT
 *
 * narc_broad_phase.h - world boxes of bodies, and all pairs of boxes that overlap.
 *
 * The steps of one frame for those who ask batches (narc.h), or have boxes of things that are no bodies. From step to step
 * narc_update_contacts() (narc_contacts.h) does this and all that follows, with work only for what has moved.
 *
 *   Pairs come in the order of (a, b) with a < b, which is also the order that keeps memory close: a batch of pairs
 *   that are sorted by their first body loads each body once. The answer is the same for any number of threads and on
 *   every instruction set.
 *
 * Example
 *
 *     narc_compute_boxes(shapes, &bodies, &(narc_box_options){.margin = margin / 2}, boxes, &error);
 *     narc_find_pairs(broad, boxes, bodies.count, &filter, NULL, a, b, 0, capacity, &count, &error);
 *     narc_pairs pairs = {.count = count, .a = NARC_ARRAY(a), .b = NARC_ARRAY(b)};
 *     narc_find_contacts(shapes, &bodies, &pairs, ...);
 */
#ifndef NARC_BROAD_PHASE_H
#define NARC_BROAD_PHASE_H

#include "narc_pairs.h"

#ifdef __cplusplus
extern "C" {
#endif

/* What narc_compute_boxes() puts boxes around; what is 0 or NULL is left out, as all is for {0}.
 *   margin              at least 0: how far a box reaches beyond its body on every side. To find all pairs that are
 *                       closer than some distance, half of it.
 *   motion_x, motion_y  world axes: what each body moves. Its box holds the body at its position, at position +
 *                       motion, and everywhere between.
 *   first, count        a sub-range of the bodies; count 0: to the end. Only its boxes are written
 *   workers             threads to use; NULL: the calling one
 *   out_skipped         how many bodies have no box; NULL: nobody asks
 *   origin              where in the world the boxes' (0, 0) is, finite; NULL: at its own. Boxes are float: far from it they
 *                       grow by roundings, so that the more pairs are found the further away the bodies are. Positions are
 *                       subtracted in double precision */
typedef struct narc_box_options {
    float margin;
    narc_float_column motion_x, motion_y;
    size_t first, count;
    const narc_workers *workers;
    size_t *out_skipped;
    const narc_point *origin;
    void *reserved[3]; /* NULL */
} narc_box_options;

/* The axis-aligned boxes of all bodies, in the world's axes, as tight as single precision allows: never too small for the body,
 * however large its position, and on each side at most NARC_BOX_ROOM * (|coordinate of the position, from the origin| +
 * |motion| + margin + extent) too large, the extent as in narc.h. (Where a shape's arcs were given a little apart, see
 * NARC_TOLERANCE, that much more is uncertain.)
 *   options    NULL: defaults
 *   out_boxes  bodies->count items, overlapping none of the inputs. A body that is broken (see narc_bodies), that has a
 *              NaN or an infinity as its motion, or whose box is beyond the range of floats, gets the empty box from
 *              (INFINITY, INFINITY) to (-INFINITY, -INFINITY), which narc_find_pairs() leaves out.
 * Errors, all found before anything is written: NARC_ERROR_ARGUMENT (a needed pointer is NULL, 2^32 bodies or more, a
 * negative margin), NARC_ERROR_NOT_FINITE (margin, origin), NARC_ERROR_INDEX (`error` names the body and the shape), and as
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
 *   out_a      `capacity` items each, overlapping nothing else but each other's gaps
 *   out_b
 *   stride     bytes from an item to the next, of both: so out_a, out_b of an array of pairs are &pair[0].a, &pair[0].b and
 *              the size of a pair, or its columns; 0: no gaps
 *   out_count  how many there are. If that is more than `capacity`, nothing else is written and NARC_ERROR_CAPACITY is
 *              returned; make room and call again.
 * Time grows with n log n, n the number of boxes, and with the pairs of boxes that would overlap if each were 16 times
 * as wide and 8 times as high. Sizes may differ by any factor: boxes are divided into levels, heights within a factor
 * of 4 and widths within 16, and each box is searched for in every level that has boxes. So the bound is L n log n for
 * L levels, and the pairs; sizes that differ by 1 : 10,000 in height and in width make at most 32 levels. Boxes that
 * all lie in one row are sorted and swept by one thread.
 * Errors: NARC_ERROR_ARGUMENT (NULL, too many boxes, a stride that is no multiple of 4), NARC_ERROR_COUNT (2^32 pairs or more, after the filter; counting
 * stops there), NARC_ERROR_MEMORY, NARC_ERROR_CAPACITY.
 * Source: sweep and prune (Baraff 1992; Cohen and others 1995) in strips, by levels of size. */
NARC_API narc_status narc_find_pairs(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                                     const narc_pair_filter *filter, const narc_workers *workers, uint32_t *out_a,
                                     uint32_t *out_b, ptrdiff_t stride, size_t capacity, size_t *out_count,
                                     narc_error *error);

#ifdef __cplusplus
}
#endif

#endif
