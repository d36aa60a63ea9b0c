/* SPDX-License-Identifier: MIT
 *
 * sweep.c - the sweep of the broad phase: pairs of boxes that overlap, of two lists in the order of min_x, or of one
 * list with itself.
 *
 * A box of one list overlaps boxes of the other whose min_x is at most its own max_x, and at least its own min_x less
 * the widest box's width. The first of these moves on from box to box. They are looked at a vector at a time.
 */
#include <stdbool.h>
#include <stdint.h>

#include "broad_phase.h"
#include "kernels.h"
#include "simd/simd.h"

/* Where a sweep puts pairs, its numbers in registers. */
struct pair_writer {
    narc_found_pairs *out;
    uint32_t count;
    uint64_t steps;
};

INLINE void make_room(struct pair_writer *to) {
    to->out->count = to->count;
    to->out->get_room(to->out);
    to->count = to->out->count;
}

/* Appends the bodies of those boxes of places from .. end - 1 that overlap the box at `place`; `behind`: all begin
 * behind it. */
INLINE void sweep_box(const narc_box_columns *boxes, uint32_t place, uint32_t from, uint32_t end, bool behind,
                      struct pair_writer *to) {
    const vf min_x = v_set(boxes->min_x[place]), max_x = v_set(boxes->max_x[place]);
    const vf min_y = v_set(boxes->min_y[place]), max_y = v_set(boxes->max_y[place]);
    const vi body = vi_set((int32_t)boxes->body[place]);
    const uint32_t all = vm_bits(vm_front(V_WIDTH));
    for (uint32_t k = from; k < end; k += V_WIDTH) {
        vm near = v_le(v_load(boxes->min_x + k), max_x);
        if (end - k < V_WIDTH)
            near = vm_and(near, vm_front((int)(end - k)));
        vm hit = vm_and(v_le(v_load(boxes->min_y + k), max_y), v_le(min_y, v_load(boxes->max_y + k)));
        hit = vm_and(near, hit);
        if (!behind)
            hit = vm_and(hit, v_le(min_x, v_load(boxes->max_x + k)));
        if (to->out->room - to->count < V_WIDTH)
            make_room(to);
        const vf others = v_of_bits(vi_load((const int32_t *)(const void *)(boxes->body + k)));
        v_store((float *)(void *)(to->out->b + to->count), v_pack(vm_packing(hit), others));
        vi_store((int32_t *)(void *)(to->out->a + to->count), body);
        to->count += (uint32_t)COUNT_BITS(vm_bits(hit));
        to->steps++;
        if (vm_bits(near) != all)
            return;
    }
}

/* The first of places from .. end - 1 whose min_x is not below `x`. It is mostly within the first vector; else steps
 * that double, and then halve, find it: those are counted. */
INLINE uint32_t find_min_x(const float *min_x, uint32_t from, uint32_t end, float x, uint64_t *steps) {
    const uint32_t left = end - from;
    vm below = v_lt(v_load(min_x + from), v_set(x));
    if (left < V_WIDTH)
        below = vm_and(below, vm_front((int)left));
    from += (uint32_t)COUNT_BITS(vm_bits(below));
    if (vm_bits(below) != vm_bits(vm_front(V_WIDTH)))
        return from;
    uint32_t high = from, step = 1, halves = 0;
    while (high < end && min_x[high] < x) {
        from = high + 1;
        high = end - high > step ? high + step : end;
        step *= 2;
        halves += 2; /* as many again */
    }
    *steps += halves;
    while (from < high) {
        const uint32_t middle = from + (high - from) / 2;
        if (min_x[middle] < x)
            from = middle + 1;
        else
            high = middle;
    }
    return from;
}

/* All pairs of one box of places first_a .. end_a - 1 and one of first_b .. end_b - 1, none of which is wider than
 * width_b. The lists have no box in common, or are the same. */
void NARC_NAMED(sweep)(const narc_box_columns *boxes, uint32_t first_a, uint32_t end_a, uint32_t first_b,
                       uint32_t end_b, float width_b, narc_found_pairs *out) {
    struct pair_writer to = {out, out->count, 0};
    uint32_t from = first_b;
    if (first_a == first_b) {
        for (uint32_t a = first_a; a < end_a && !out->enough; a++)
            sweep_box(boxes, a, a + 1, end_a, true, &to);
    } else {
        for (uint32_t a = first_a; a < end_a && !out->enough; a++) {
            from = find_min_x(boxes->min_x, from, end_b, boxes->min_x[a] - width_b, &to.steps);
            sweep_box(boxes, a, from, end_b, false, &to);
        }
    }
    out->count = to.count;
    out->steps += to.steps;
}
