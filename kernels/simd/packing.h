/* SPDX-License-Identifier: MIT
 *
 * packing.h - which lanes go in front, for each set of lanes that is kept: what wrappers look up that have no instruction
 * for it.
 */
#ifndef NARC_SIMD_PACKING_H
#define NARC_SIMD_PACKING_H

#include <stdint.h>

#include "compiler.h"

/* Of four lanes: the bytes of those that are kept; then lane 0 again. */
static const uint8_t v_four_lanes[16][16] = {
    {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},       {0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},
    {4, 5, 6, 7, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},       {0, 1, 2, 3, 4, 5, 6, 7, 0, 1, 2, 3, 0, 1, 2, 3},
    {8, 9, 10, 11, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},     {0, 1, 2, 3, 8, 9, 10, 11, 0, 1, 2, 3, 0, 1, 2, 3},
    {4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 2, 3, 0, 1, 2, 3},     {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 0, 1, 2, 3},
    {12, 13, 14, 15, 0, 1, 2, 3, 0, 1, 2, 3, 0, 1, 2, 3},   {0, 1, 2, 3, 12, 13, 14, 15, 0, 1, 2, 3, 0, 1, 2, 3},
    {4, 5, 6, 7, 12, 13, 14, 15, 0, 1, 2, 3, 0, 1, 2, 3},   {0, 1, 2, 3, 4, 5, 6, 7, 12, 13, 14, 15, 0, 1, 2, 3},
    {8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3, 0, 1, 2, 3}, {0, 1, 2, 3, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3},
    {4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15, 0, 1, 2, 3}, {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15}};

/* Of eight lanes: the numbers of those that are kept, a byte each, from the lowest on; then lane 0 again. */
#define V_LANE(set, lane) ((uint64_t)(((set) >> (lane)) & 1) * (lane) << 8 * COUNT_BITS((set) & ((1 << (lane)) - 1)))
#define V_LANES(set)                                                                                                   \
    (V_LANE(set, 1) | V_LANE(set, 2) | V_LANE(set, 3) | V_LANE(set, 4) | V_LANE(set, 5) | V_LANE(set, 6) |             \
     V_LANE(set, 7))
#define V_FOUR_SETS(set)    V_LANES(set), V_LANES((set) + 1), V_LANES((set) + 2), V_LANES((set) + 3)
#define V_SIXTEEN_SETS(set) V_FOUR_SETS(set), V_FOUR_SETS((set) + 4), V_FOUR_SETS((set) + 8), V_FOUR_SETS((set) + 12)
#define V_64_SETS(set)                                                                                                 \
    V_SIXTEEN_SETS(set), V_SIXTEEN_SETS((set) + 16), V_SIXTEEN_SETS((set) + 32), V_SIXTEEN_SETS((set) + 48)
static const uint64_t v_eight_lanes[256] = {V_64_SETS(0), V_64_SETS(64), V_64_SETS(128), V_64_SETS(192)};

#endif
