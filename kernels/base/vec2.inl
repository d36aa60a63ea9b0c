/* SPDX-License-Identifier: MIT
 *
 * vec2.inl - vectors of the plane, one in each lane. A rotation is a unit vector (cosine, sine).
 *
 * What is written out here is what is computed, operation by operation, down to the signs of zeros: the `opposite`
 * functions give the vector turned by half a turn, and not v2_neg() of it, which has other zeros.
 */
#ifndef NARC_BASE_VEC2_INL
#define NARC_BASE_VEC2_INL

#include "simd/simd.h"

typedef struct {
    vf x, y;
} vec2;

INLINE vec2 v2_add(vec2 a, vec2 b) { return (vec2){v_add(a.x, b.x), v_add(a.y, b.y)}; }
INLINE vec2 v2_sub(vec2 a, vec2 b) { return (vec2){v_sub(a.x, b.x), v_sub(a.y, b.y)}; }
INLINE vec2 v2_scale(vec2 a, vf factor) { return (vec2){v_mul(a.x, factor), v_mul(a.y, factor)}; }
INLINE vec2 v2_divide(vec2 a, vf divisor) { return (vec2){v_div(a.x, divisor), v_div(a.y, divisor)}; }
INLINE vec2 v2_select(vm m, vec2 a, vec2 b) { return (vec2){v_select(m, a.x, b.x), v_select(m, a.y, b.y)}; }
INLINE vf v2_dot(vec2 a, vec2 b) { return v_add(v_mul(a.x, b.x), v_mul(a.y, b.y)); }
INLINE vf v2_cross(vec2 a, vec2 b) { return v_sub(v_mul(a.x, b.y), v_mul(a.y, b.x)); }
INLINE vf v2_length(vec2 a) { return v_sqrt(v2_dot(a, a)); }

/* A quarter turn, counter-clockwise and clockwise. */
INLINE vec2 v2_left(vec2 a) { return (vec2){v_neg(a.y), a.x}; }
INLINE vec2 v2_right(vec2 a) { return (vec2){a.y, v_neg(a.x)}; }

INLINE vec2 v2_rotate(vec2 q, vec2 a) {
    return (vec2){v_sub(v_mul(q.x, a.x), v_mul(q.y, a.y)), v_add(v_mul(q.y, a.x), v_mul(q.x, a.y))};
}
INLINE vec2 v2_rotate_opposite(vec2 q, vec2 a) {
    return (vec2){v_sub(v_mul(q.y, a.y), v_mul(q.x, a.x)), v_neg(v_add(v_mul(q.y, a.x), v_mul(q.x, a.y)))};
}
/* By the inverse rotation. */
INLINE vec2 v2_unrotate(vec2 q, vec2 a) {
    return (vec2){v_add(v_mul(q.x, a.x), v_mul(q.y, a.y)), v_sub(v_mul(q.x, a.y), v_mul(q.y, a.x))};
}
INLINE vec2 v2_unrotate_opposite(vec2 q, vec2 a) {
    return (vec2){v_neg(v_add(v_mul(q.x, a.x), v_mul(q.y, a.y))), v_sub(v_mul(q.y, a.x), v_mul(q.x, a.y))};
}

#endif
