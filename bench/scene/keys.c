/* SPDX-License-Identifier: MIT
 *
 * keys.c - pairs as numbers, to compare what two ways find.
 */
#include "keys.h"

#include <stdlib.h>

size_t add_keys(const narc_pairs *pairs, uint64_t first_a, uint64_t first_b, uint64_t *keys, size_t count) {
    const uint32_t *const a = pairs->a.base, *const b = pairs->b.base;
    for (size_t k = 0; k < pairs->count; k++)
        keys[count++] = (first_a + a[k]) << 32 | (first_b + b[k]);
    return count;
}

static int compare_keys(const void *left, const void *right) {
    const uint64_t l = *(const uint64_t *)left, r = *(const uint64_t *)right;
    return (l > r) - (l < r);
}

size_t count_differences(uint64_t *left, size_t left_count, uint64_t *right, size_t right_count) {
    size_t differences = 0, l = 0, r = 0;
    qsort(left, left_count, sizeof *left, compare_keys);
    qsort(right, right_count, sizeof *right, compare_keys);
    while (l < left_count && r < right_count) {
        differences += left[l] != right[r];
        const bool next_left = left[l] <= right[r], next_right = right[r] <= left[l];
        l += next_left;
        r += next_right;
    }
    return differences + (left_count - l) + (right_count - r);
}
