/* SPDX-License-Identifier: MIT
 *
 * leaves.h - the two orders in which an index is built. Internal.
 */
#ifndef NARC_SCENE_LEAVES_H
#define NARC_SCENE_LEAVES_H

#include "index.h"

/* Fill index->body with the bodies of its boxes, eight for each leaf. There is room for them. The order depends on the
 * boxes alone. */
void narc_halve_bodies(narc_index *index, const narc_box *boxes, const narc_workers *workers);
void narc_sort_bodies_by_curve(narc_index *index, const narc_box *boxes, const narc_workers *workers);

/* Puts a 0 before each of 16 bits. */
static inline uint32_t narc_spread_bits(uint32_t k) {
    k = (k | k << 8) & 0x00ff00ff;
    k = (k | k << 4) & 0x0f0f0f0f;
    k = (k | k << 2) & 0x33333333;
    return (k | k << 1) & 0x55555555;
}

#endif
