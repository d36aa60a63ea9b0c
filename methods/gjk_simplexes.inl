/* SPDX-License-Identifier: MIT
 *
 * gjk_simplexes.inl - the cache of simplexes: what GJK leaves of a pair for the next call's warm start.
 *
 * A simplex is a number of 30 bits and, in the lowest two, what it is: 1, the direction of the largest gap; 3, those of
 * the three points of a triangle around the origin, in 10 bits each. Directions are diamond angles in A's frame.
 */
#ifndef NARC_METHODS_GJK_SIMPLEXES_INL
#define NARC_METHODS_GJK_SIMPLEXES_INL

#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "methods/lanes.inl"
#include "methods/method_kernels.h"
#include "methods/simplex.inl"
#include "simd/simd.h"

enum { SIMPLEX_AXIS = 1, SIMPLEX_TRIANGLE = 3 };

/* The direction, of some length, with a diamond angle. */
INLINE vec2 find_direction(vf angle) {
    const vm upper = v_le(angle, v_set(2));
    const vf x = v_select(upper, v_sub(v_set(1), angle), v_sub(angle, v_set(3))), y = v_sub(v_set(1), v_abs(x));
    return (vec2){x, v_select(upper, y, v_neg(y))};
}

/* The direction of point number `point` of a triangle, or of the axis. */
INLINE vec2 get_simplex_direction(vi simplex, int point) {
    const vm triangle = vi_lt(vi_set(2), vi_and(simplex, vi_set(3)));
    const vf small = v_of_int(vi_and(vi_shift_right(simplex, 2 + 10 * point), vi_set(1023)));
    const vf whole = v_of_int(vi_shift_right(simplex, 2));
    const vf coarse = v_mul(v_add(small, v_set(0.5f)), v_set(0x1p-8f)), fine = v_mul(whole, v_set(0x1p-28f));
    return find_direction(v_select(triangle, coarse, fine));
}

INLINE vi ten_bits(vf angle) { return vi_truncate(v_min(v_mul(angle, v_set(0x1p8f)), v_set(1023))); }

/* How many directions a simplex has: 0, 1 or 3. */
INLINE vi simplex_length(vi simplex) {
    const vi tag = vi_and(simplex, vi_set(3));
    const vm odd = vi_lt(vi_set(0), vi_and(tag, vi_set(1)));
    return vi_select(odd, tag, vi_set(0));
}

/* The simplexes of the pairs that lanes begin with. */
INLINE void read_simplexes(const struct call *call, const struct lanes *lanes, int32_t *simplex) {
    const uint32_t *const simplexes = narc_call_of(call->batch)->simplexes;
    int32_t pair[V_WIDTH];
    if (!simplexes)
        return;
    get_pairs(&lanes->pair, 0, pair);
    for (int lane = 0; lane < V_WIDTH; lane++)
        if (lanes->begins[lane])
            simplex[lane] = (int32_t)simplexes[find_number(call, pair[lane])];
}

/* Leaves those of the pairs of the lanes `done`: the corners of a triangle in the lanes `collides`, else an axis. */
INLINE void leave_simplexes(const struct call *call, const struct lanes *lanes, const struct vertex *const corners[3],
                            vec2 axis, vm collides, vm done) {
    const vi triangle = vi_add(ten_bits(corners[0]->angle), vi_add(vi_shift_left(ten_bits(corners[1]->angle), 10),
                                                                   vi_shift_left(ten_bits(corners[2]->angle), 20)));
    const vf angle = v_min(v_mul(find_diamond_angle(axis), v_set(0x1p28f)), v_set(0x1p30f - 64));
    int32_t pair[V_WIDTH], simplex[V_WIDTH];
    vi_store(simplex, vi_select(collides, vi_add(vi_shift_left(triangle, 2), vi_set(SIMPLEX_TRIANGLE)),
                                vi_add(vi_shift_left(vi_truncate(angle), 2), vi_set(SIMPLEX_AXIS))));
    get_pairs(&lanes->pair, 0, pair);
    for (uint32_t bits = vm_bits(done); bits; bits &= bits - 1) {
        const int lane = FIND_LOWEST(bits);
        narc_call_of(call->batch)->simplexes[find_number(call, pair[lane])] = (uint32_t)simplex[lane];
    }
}

#endif
