/* SPDX-License-Identifier: MIT
 *
 * bounding.inl - bounding circles, axis-aligned and oriented boxes against each other: filters.
 *
 * Two boxes are apart exactly if they are so along one of their four sides (separating axis theorem). With d from the
 * centre of one to that of the other, they are apart along an axis m if |d.m| is more than the sum of their extents
 * along m: half_x |x.m| + half_y |y.m|, x and y the box's own axes. Half sides and radii are 96 roundings of the
 * extents too large (store.h). The positions' distance D adds 32 e D at most, and of bodies that overlap D is at most
 * both extents.
 */
#ifndef NARC_METHODS_BOUNDING_INL
#define NARC_METHODS_BOUNDING_INL

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/queue.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "methods/boxes.inl"
#include "methods/run.inl"
#include "simd/simd.h"

/* The extent of a box along a unit vector, from its centre. */
INLINE vf find_extent(const struct box *box, vec2 m) {
    return v_add(v_mul(box->half_x, v_abs(v2_dot(box->axis, m))), v_mul(box->half_y, v_abs(v2_cross(box->axis, m))));
}

INLINE vm apart_along(const struct boxes *both, vec2 m) {
    const vf extents = v_add(find_extent(&both->a, m), find_extent(&both->b, m));
    return v_lt(extents, v_abs(v2_dot(v2_sub(both->b.center, both->a.center), m)));
}

/* Triages answer all pairs: every bit is set but those of pairs that are apart. */
INLINE vm mark_touching(const struct call *call, size_t pair, const struct filter *circles, vm apart) {
    call->bits[pair / 64] |= (uint64_t)vm_bits(vm_and_not(circles->valid, apart)) << pair % 64;
    return vm_front(0);
}

INLINE vm filter_circles(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    (void)item;
    return mark_touching(call, pair, circles, circles->apart);
}

/* The world's x axis in A's frame is (c, -s), its y axis (s, c). */
INLINE vm filter_aabbs(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    const vf c = item[ROTATION_A], s = item[ROTATION_A + 1];
    const struct boxes both = load_boxes(call->batch->shapes, item);
    const vm apart = vm_or(apart_along(&both, (vec2){c, v_neg(s)}), apart_along(&both, (vec2){s, c}));
    return mark_touching(call, pair, circles, apart);
}

INLINE vm filter_obbs(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    const struct boxes both = load_boxes(call->batch->shapes, item);
    const vm along_a = vm_or(apart_along(&both, both.a.axis), apart_along(&both, v2_left(both.a.axis)));
    const vm along_b = vm_or(apart_along(&both, both.b.axis), apart_along(&both, v2_left(both.b.axis)));
    return mark_touching(call, pair, circles, vm_or(along_a, along_b));
}

static void overlap_circle(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_filter(filter_circles, batch, first, count, skipped, out_bits);
}

static void overlap_aabb(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_filter(filter_aabbs, batch, first, count, skipped, out_bits);
}

static void overlap_obb(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_filter(filter_obbs, batch, first, count, skipped, out_bits);
}

#endif
