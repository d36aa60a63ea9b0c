/* SPDX-License-Identifier: MIT
 *
 * keys.h - pairs as numbers, to compare what two ways find.
 */
#ifndef NARC_BENCH_SCENE_KEYS_H
#define NARC_BENCH_SCENE_KEYS_H

#include "narc.h"

/* Appends pairs as keys a << 32 | b, of bodies that begin at first_a and first_b. */
size_t add_keys(const narc_pairs *pairs, uint64_t first_a, uint64_t first_b, uint64_t *keys, size_t count);

/* How many keys only one of the two has. Sorts both. */
size_t count_differences(uint64_t *left, size_t left_count, uint64_t *right, size_t right_count);

#endif
