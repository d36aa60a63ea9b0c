/* SPDX-License-Identifier: MIT
 *
 * gjk_hints.inl - what GJK leaves of a pair for the next call: where its search ended.
 *
 * A hint is a number of 30 bits and, in the lowest two, what it is: 1, the direction of the largest gap; 3, those of
 * the three points of a triangle around the origin, in 10 bits each. Directions are diamond angles in A's frame.
 */
#ifndef NARC_METHODS_GJK_HINTS_INL
#define NARC_METHODS_GJK_HINTS_INL

#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "methods/lanes.inl"
#include "methods/simplex.inl"
#include "simd/simd.h"

enum { HINT_AXIS = 1, HINT_TRIANGLE = 3 };

/* The direction, of some length, with a diamond angle. */
INLINE vec2 find_direction(vf angle) {
    const vm upper = v_le(angle, v_set(2));
    const vf x = v_select(upper, v_sub(v_set(1), angle), v_sub(angle, v_set(3))), y = v_sub(v_set(1), v_abs(x));
    return (vec2){x, v_select(upper, y, v_neg(y))};
}

/* The direction of point number `point` of a triangle, or of the axis. */
INLINE vec2 read_hint(vi hint, int point) {
    const vm triangle = vi_lt(vi_set(2), vi_and(hint, vi_set(3)));
    const vf small = v_of_int(vi_and(vi_shift_right(hint, 2 + 10 * point), vi_set(1023)));
    const vf whole = v_of_int(vi_shift_right(hint, 2));
    const vf coarse = v_mul(v_add(small, v_set(0.5f)), v_set(0x1p-8f)), fine = v_mul(whole, v_set(0x1p-28f));
    return find_direction(v_select(triangle, coarse, fine));
}

INLINE vi ten_bits(vf angle) { return vi_truncate(v_min(v_mul(angle, v_set(0x1p8f)), v_set(1023))); }

/* How many directions a hint has: 0, 1 or 3. */
INLINE vi hint_length(vi hint) {
    const vi tag = vi_and(hint, vi_set(3));
    const vm odd = vi_lt(vi_set(0), vi_and(tag, vi_set(1)));
    return vi_select(odd, tag, vi_set(0));
}

/* The hints of the pairs that lanes begin with. */
INLINE void read_simplexes(const struct call *call, const struct lanes *lanes, int32_t *hint) {
    const narc_hint_column column = call->batch->query->hints;
    int32_t number[V_WIDTH];
    if (!column.base)
        return;
    vi_store(number, find_numbers(call, get_bits(&lanes->pair, PAIR, 0)));
    for (int lane = 0; lane < V_WIDTH; lane++)
        if (lanes->begins[lane])
            hint[lane] = (int32_t)*find_hint(column, number[lane]);
}

/* Leaves hints for the pairs of the lanes `done`: the corners of a triangle in the lanes `collides`, else an axis. */
INLINE void leave_simplex(const struct call *call, const struct lanes *lanes, const struct vertex *const corners[3],
                          vec2 axis, vm collides, vm done) {
    const vi triangle = vi_add(ten_bits(corners[0]->angle), vi_add(vi_shift_left(ten_bits(corners[1]->angle), 10),
                                                                   vi_shift_left(ten_bits(corners[2]->angle), 20)));
    const vf angle = v_min(v_mul(find_diamond_angle(axis), v_set(0x1p28f)), v_set(0x1p30f - 64));
    const vi hint = vi_select(collides, vi_add(vi_shift_left(triangle, 2), vi_set(HINT_TRIANGLE)),
                              vi_add(vi_shift_left(vi_truncate(angle), 2), vi_set(HINT_AXIS)));
    put_hints(call, get_bits(&lanes->pair, PAIR, 0), done, hint);
}

#endif
