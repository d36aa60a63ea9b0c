/* SPDX-License-Identifier: MIT
 *
 * kept.inl - what is kept of pairs, at their numbers.
 */
#ifndef NARC_SAT_KEPT_INL
#define NARC_SAT_KEPT_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "column.h"
#include "simd/simd.h"

/* Do the numbers in a vector follow each other? */
INLINE bool are_in_line(const int32_t *number) {
    const vi all = vi_load(number), next = vi_add(vi_set(*number), vi_lanes());
    return vm_bits(vm_or(vi_lt(all, next), vi_lt(next, all))) == 0;
}

/* Where items of an array lie; those of lanes that are not wanted have `room`. */
INLINE void find_places(char *base, ptrdiff_t stride, const int32_t *number, uint32_t lanes, char *room, char **place) {
    UNROLL
    for (int lane = 0; lane < V_WIDTH; lane++)
        place[lane] = lanes >> lane & 1 ? base + (ptrdiff_t)(uint32_t)number[lane] * stride : room;
}

/* The items of an array for the pairs in a vector, `words` of four bytes each. `in_line`: they follow each other. */
INLINE void load_items(const void *items, int words, const int32_t *number, bool in_line, vf *word) {
    static const int32_t lane[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    const ptrdiff_t size = words * (ptrdiff_t)sizeof(float);
    const float *const first = (const float *)items + (ptrdiff_t)(uint32_t)*number * words;
    UNROLL
    for (int w = 0; w < words; w += 4)
        if (LIKELY(in_line))
            v_rows(first + w, size, lane, word + w);
        else
            v_rows((const float *)items + w, size, number, word + w);
}

#endif
