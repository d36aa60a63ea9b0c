/* SPDX-License-Identifier: MIT
 *
 * broad_phase_steps.h - the steps of narc_find_pairs(). Internal.
 */
#ifndef NARC_BROAD_PHASE_STEPS_H
#define NARC_BROAD_PHASE_STEPS_H

#include "broad_phase.h"

/* Lists the strips that `count` boxes lie in, and the entries of the boxes in the order of their strips; returns how
 * many boxes are not empty. There is room for all boxes. */
size_t narc_sort_into_strips(narc_broad_phase *broad, const narc_box *boxes, size_t count);

/* Puts the boxes of one strip into the columns, in the order of min_x. Strips may be sorted by several threads. */
void narc_sort_strip(narc_broad_phase *broad, narc_strip *strip, const narc_box *boxes);

/* The number of the strip of a level that holds `y`, or of one `offset` strips above it; the nearest one that boxes may
 * lie in. */
uint64_t narc_strip_number(const narc_broad_phase *broad, size_t level, float y, int64_t offset);

/* Turns places into bodies a < b and leaves out the pairs that the filter does not let; returns how many are left. */
size_t narc_filter_pairs(narc_broad_phase *broad, const narc_pair_filter *filter, int team);

/* Writes the pairs in their order. There is room for all. */
void narc_order_pairs(narc_broad_phase *broad, size_t body_count, int team, uint32_t *out_a, uint32_t *out_b);

#endif
