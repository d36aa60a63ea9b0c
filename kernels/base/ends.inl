/* SPDX-License-Identifier: MIT
 *
 * ends.inl - two numbers that belong together, of the low end of something and of its high one. One pair by itself has
 * them side by side in a register, whose other lanes nobody needs.
 */
#ifndef NARC_BASE_ENDS_INL
#define NARC_BASE_ENDS_INL

#include "base/vec2.inl"
#include "simd/simd.h"

#ifdef V_JOINS
typedef vf end_pair;
typedef vm mask_pair;
#define OF_ENDS(type, of, name, op)                                                                                    \
    INLINE type name(of a, of b) { return op(a, b); }
INLINE end_pair join_ends(vf low, vf high) { return v_join(low, high); }
INLINE mask_pair join_masks(vm low, vm high) { return v_join(low, high); }
INLINE vf get_low(end_pair a) { return a; }
INLINE vf get_high(end_pair a) { return v_high(a); }
INLINE end_pair both_ends(vf a) { return v_both(a); }
INLINE end_pair pick_ends(end_pair low, end_pair high) { return v_low_high(low, high); }
INLINE end_pair select_ends(mask_pair m, end_pair a, end_pair b) { return v_select(m, a, b); }
#else
typedef struct {
    vf low, high;
} end_pair;
typedef struct {
    vm low, high;
} mask_pair;
#define OF_ENDS(type, of, name, op)                                                                                    \
    INLINE type name(of a, of b) { return (type){op(a.low, b.low), op(a.high, b.high)}; }
INLINE end_pair join_ends(vf low, vf high) { return (end_pair){low, high}; }
INLINE mask_pair join_masks(vm low, vm high) { return (mask_pair){low, high}; }
INLINE vf get_low(end_pair a) { return a.low; }
INLINE vf get_high(end_pair a) { return a.high; }
INLINE end_pair both_ends(vf a) { return (end_pair){a, a}; }
INLINE end_pair pick_ends(end_pair low, end_pair high) { return (end_pair){low.low, high.high}; }
INLINE end_pair select_ends(mask_pair m, end_pair a, end_pair b) {
    return (end_pair){v_select(m.low, a.low, b.low), v_select(m.high, a.high, b.high)};
}
/* Two rows of four words to byte `offset` of a place, the low one in front in the lanes `low_first`, or the high one; then
 * the high one in the lanes `two`, or zeros. */
INLINE void v_put_ends(char *const *place, int offset, const end_pair in[4], vm low_first, vm two) {
    const vf zero = v_set(0);
    vf row[4];
    UNROLL
    for (int i = 0; i < 4; i++)
        row[i] = v_select(low_first, in[i].low, in[i].high);
    v_put_rows(place, offset, row);
    UNROLL
    for (int i = 0; i < 4; i++)
        row[i] = v_select(two, in[i].high, zero);
    v_put_rows(place, offset + 16, row);
}
#endif

INLINE vf find_distance(vf a, vf b) { return v_abs(v_sub(a, b)); }

OF_ENDS(end_pair, end_pair, add_ends, v_add)
OF_ENDS(end_pair, end_pair, sub_ends, v_sub)
OF_ENDS(end_pair, end_pair, mul_ends, v_mul)
OF_ENDS(end_pair, end_pair, max_ends, v_max)
OF_ENDS(end_pair, end_pair, find_distances, find_distance)
OF_ENDS(mask_pair, end_pair, ends_are_less, v_lt)
OF_ENDS(mask_pair, end_pair, ends_are_at_most, v_le)

/* Turns vectors (base/vec2.inl). */
INLINE void rotate_ends(vec2 q, end_pair *x, end_pair *y) {
    const end_pair cosine = both_ends(q.x), sine = both_ends(q.y), from_x = *x, from_y = *y;
    *x = sub_ends(mul_ends(cosine, from_x), mul_ends(sine, from_y));
    *y = add_ends(mul_ends(sine, from_x), mul_ends(cosine, from_y));
}

#endif
