/* SPDX-License-Identifier: MIT
 *
 * steps.h - the steps of narc_find_pairs() and narc_update_pairs(). Internal.
 */
#ifndef NARC_BROAD_PHASE_STEPS_H
#define NARC_BROAD_PHASE_STEPS_H

#include "broad_phase.h"

/* Where part number `part` of `parts` parts of about equal size begins. */
static inline size_t narc_part_start(size_t count, int part, int parts) {
    return count / (size_t)parts * (size_t)part + count % (size_t)parts * (size_t)part / (size_t)parts;
}

/* What the filter says of one body. */
narc_body_filter narc_read_filter(const narc_pair_filter *filter, size_t body);

/* Finds the pairs of boxes that overlap and may form a pair; *out_count is how many. The broad phase holds as many of
 * them as there is memory for. Errors as narc_find_pairs() has them, but for NARC_ERROR_CAPACITY. */
narc_status narc_sweep_boxes(narc_broad_phase *broad, const narc_box *boxes, size_t count,
                             const narc_pair_filter *filter, unsigned threads, size_t *out_count, narc_error *error);

/* Lists these `found` pairs in their order, sweeping again if not all were held. NARC_ERROR_MEMORY. */
narc_status narc_list_found_pairs(narc_broad_phase *broad, size_t count, const narc_pair_filter *filter,
                                  unsigned threads, size_t found, uint32_t *out_a, uint32_t *out_b, narc_error *error);

/* Lists the levels and strips that `count` boxes lie in, and the entries of the boxes in the order of their strips;
 * returns how many boxes are not empty. There is room for all boxes. */
size_t narc_sort_into_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count, int team);

/* Puts the boxes of one strip into the columns, in the order of min_x. Strips may be sorted by several threads. */
void narc_sort_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes);

/* The number of the strip of a level that holds `y`, or of one `offset` strips above it; the nearest one that boxes may
 * lie in. */
uint64_t narc_strip_number(const narc_broad_phase *broad, const narc_level *level, float y, int64_t offset);

/* Puts the bodies of each pair from `first` on into their order, a < b, leaves out pairs that the filter does not let,
 * and returns how many there are then, with those before `first`. */
uint32_t narc_filter_pairs(const narc_pair_filter *filter, uint32_t *a, uint32_t *b, uint32_t first, uint32_t count);

/* Writes the pairs of `blocks` blocks in their order. There is room for all. */
void narc_order_pairs(narc_broad_phase *broad, size_t blocks, size_t body_count, int team, uint32_t *out_a,
                      uint32_t *out_b);

#endif
