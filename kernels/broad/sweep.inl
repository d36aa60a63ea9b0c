/* SPDX-License-Identifier: MIT
 *
 * sweep.inl - the sweep of the broad phase: pairs of boxes that overlap, of two lists in the order of min_x, or of one
 * list with itself.
 *
 * Of two boxes that overlap in x, one has the smaller min_x, and the min_x of the other lies within it. So for each box
 * the boxes behind it are looked at, a vector at a time, until their min_x is beyond its max_x; what is left to ask is
 * whether they overlap in y.
 */
#ifndef NARC_SWEEP_INL
#define NARC_SWEEP_INL

#include "broad_phase.h"
#include "simd/simd.h"

/* Appends those boxes of places from .. end - 1 that overlap the box at `place`, all of which begin behind it. */
INLINE void sweep_box(const narc_box_columns *boxes, uint32_t place, uint32_t from, uint32_t end,
                      narc_place_pairs *out) {
    const vf max_x = v_set(boxes->max_x[place]), min_y = v_set(boxes->min_y[place]), max_y = v_set(boxes->max_y[place]);
    const uint32_t all = vm_bits(vm_front(V_WIDTH));
    for (uint32_t k = from; k < end; k += V_WIDTH) {
        vm near = v_le(v_load(boxes->min_x + k), max_x);
        if (end - k < V_WIDTH)
            near = vm_and(near, vm_front((int)(end - k)));
        const vm beside = vm_and(v_le(v_load(boxes->min_y + k), max_y), v_le(min_y, v_load(boxes->max_y + k)));
        const vm hit = vm_and(near, beside);
        if (out->room - out->count < V_WIDTH)
            out->get_room(out);
        if (out->a) {
            const vf places = v_of_bits(vi_add(vi_lanes(), vi_set((int32_t)k)));
            v_store((float *)(void *)(out->b + out->count), v_pack(vm_packing(hit), places));
            vi_store((int32_t *)(void *)(out->a + out->count), vi_set((int32_t)place));
        }
        out->count += (uint32_t)__builtin_popcount(vm_bits(hit));
        if (vm_bits(near) != all)
            return;
    }
}

/* All pairs of one box of places first_a .. end_a - 1 and one of first_b .. end_b - 1; the lists have no box in common,
 * or are the same. */
static void sweep(const narc_box_columns *boxes, uint32_t first_a, uint32_t end_a, uint32_t first_b, uint32_t end_b,
                  narc_place_pairs *out) {
    if (first_a == first_b) {
        for (uint32_t a = first_a; a < end_a; a++)
            sweep_box(boxes, a, a + 1, end_a, out);
        return;
    }
    uint32_t a = first_a, b = first_b;
    while (a < end_a && b < end_b)
        if (boxes->min_x[a] <= boxes->min_x[b])
            sweep_box(boxes, a++, b, end_b, out);
        else
            sweep_box(boxes, b++, a, end_a, out);
}

#endif
