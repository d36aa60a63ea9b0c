/* SPDX-License-Identifier: MIT
 *
 * pair_setup.inl - what every kernel begins with: B's pose in A's frame, and a first filter by circles.
 *
 * With d = position B - position A and rotations as complex numbers, B's frame in A's is
 *     t = d / rotation A,   q = rotation B / rotation A,
 * so that a point p of B lies at t + scale_b q p where a point p of A lies at scale_a p. Both keep their scale: nothing
 * is divided.
 *
 * The filter may only say what the deciding formula (sat/normal_fan.inl) would say after all its rounding. That formula
 * is within 32 e (D + E_a + E_b) of exact, e = 2^-24, D = |d|, E the extents; the bounding radii are 96 e E too large
 * and the inner ones 96 e E too small (store.h). Let s be the distance between two circles' centres, so that
 * D <= s + E_a + E_b.
 *
 *   apart   s (1 - 2^-17) > sum of bounding radii + margin. Then the exact gap exceeds the margin by more than
 *           128 e s + 96 e (E_a + E_b), of which the formula can lose 32 e s + 64 e (E_a + E_b).
 *   deep    s (1 + 2^-17) < sum of inner radii. Then s + the distances of the centres from their origins are at most
 *           E_a + E_b, and so is D; the exact gap is below -96 e (E_a + E_b), and the formula can add 64 e (E_a + E_b).
 *
 * What is left over covers the rounding of s itself.
 */
#ifndef NARC_BASE_PAIR_SETUP_INL
#define NARC_BASE_PAIR_SETUP_INL

#include <math.h>
#include <stdbool.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/planes.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* 128 e (D + E_a + E_b), four times what the deciding formula can be off by: what a value from the same arithmetic must
 * be clear of, before it can stand for the formula's. Infinite where an extent is not known. */
INLINE vf find_slack(vec2 position, vi info_a, vi info_b, vf size_a, vf size_b) {
    const vi unknown = vi_set(255), ratio_a = get_extent_ratio(info_a), ratio_b = get_extent_ratio(info_b);
    const vf extents = v_add(v_mul(size_a, v_of_int(ratio_a)), v_mul(size_b, v_of_int(ratio_b)));
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(position.x), v_abs(position.y)), extents));
    return v_select(vm_and(vi_lt(ratio_a, unknown), vi_lt(ratio_b, unknown)), slack, v_set(INFINITY));
}

/* What the circles say of a pair in each lane. */
struct filter {
    vm valid, invalid; /* are all numbers in range? Only a valid pair has an answer. Neither: there is no pair */
    vm apart;          /* the separation is above the margin, for certain */
    vm deep;           /* the bodies collide, for certain */
    vf margin;
    vf size, square; /* the sum of the bounding radii; what circles that are apart have a smaller square of it than */
    vec2 between;    /* from the centre of A's bounding circle to that of B's */
};

/* From the centre of a circle of A to that of a circle of B. */
INLINE vec2 find_circle_difference(vec2 a, vec2 b, const struct pose *pose) {
    return v2_sub(place_center_b(b, pose), v2_scale(a, pose->scale_a));
}

/* Where the bodies of a pair in each lane are. */
struct placement {
    struct pose pose;
    vec2 rotation_a;
    vf margin;
    vm in_range; /* all that is known without the shapes' sizes */
};

INLINE struct placement place_bodies(const struct body_pair *bodies, vf margin) {
    vm valid_a, valid_b;
    const vec2 rotation_a = normalise_rotation(bodies->rotation_a, &valid_a);
    const vec2 rotation_b = normalise_rotation(bodies->rotation_b, &valid_b);
    const vm near = vm_and(is_distance_in_range(bodies->difference), v_le(margin, margin));
    return (struct placement){{v2_unrotate(rotation_a, bodies->difference), v2_unrotate(rotation_a, rotation_b),
                               bodies->scale_a, bodies->scale_b},
                              rotation_a,
                              margin,
                              vm_and(near, vm_and(valid_a, valid_b))};
}

/* That of the pairs k ... of a block. `shapes`: those that POSE_DOUBLE_ROWS bring go to the indices, too. */
INLINE struct placement place_pairs(const struct call *call, const struct sources *given, struct pair_indices *in,
                                    int k, enum pose_layout layout, bool shapes) {
    const narc_pairs *pairs = &given->pairs;
    const bool shifted = pairs->shift_x.base || pairs->shift_y.base;
    const vec2 shift = {load_column_or(pairs->shift_x, in->number + k, 0),
                        load_column_or(pairs->shift_y, in->number + k, 0)};
    int32_t *const out_shapes[] = {in->shape_a + k, in->shape_b + k};
    const struct body_pair bodies =
        load_bodies(given, layout, in->a + k, in->b + k, shifted ? &shift : NULL, shapes ? out_shapes : NULL);
    return place_bodies(&bodies, load_column_or(call->margins, in->number + k, call->margin));
}

/* Sets up the pairs k ... of a block in the lanes `which`, the first of which has the number `number`: fills `item`. */
INLINE struct filter set_up_pairs(const struct call *call, const struct pair_indices *in, int k,
                                  const struct placement *placement, vm which, int32_t number, vf item[FIELDS]) {
    const narc_batch *batch = call->batch;
    const float shrink = 1.0f - 0x1p-16f, grow = 1.0f + 0x1p-16f; /* of a square: 2^-17 of the distance */
    struct pose pose = placement->pose;
    const vf margin = placement->margin;
    struct headers a = load_headers(batch->shapes->headers, in->shape_a + k);
    struct headers b = load_headers(batch->shapes->headers, in->shape_b + k);
    struct filter filter = {.margin = margin};
    vf size_a = v_mul(pose.scale_a, a.bound_radius), size_b = v_mul(pose.scale_b, b.bound_radius);
    vm in_range = vm_and(placement->in_range, vm_and(is_size_in_range(size_a), is_size_in_range(size_b)));
    if (NARC_PIECES && BLOCK > 1 &&
        !LIKELY(!call->planes)) { /* by way of the item, so that all else stays in registers */
        set_vec2(item, POSITION, pose.position);
        set_vec2(item, ROTATION, pose.rotation);
        item[SCALE_A] = pose.scale_a;
        item[SCALE_B] = pose.scale_b;
        vm ground;
        in_range = vm_and(in_range, lay_planes(call, in, k, item, &ground));
        which = vm_and_not(which, ground);
        pose.position = (vec2){item[POSITION], item[POSITION + 1]};
        pose.scale_a = item[SCALE_A];
        pose.scale_b = item[SCALE_B];
        a.info = get_item_bits(item, INFO_A);
        b.info = get_item_bits(item, INFO_B);
        size_a = v_mul(pose.scale_a, a.bound_radius);
        size_b = v_mul(pose.scale_b, b.bound_radius);
    }
    const vf scale_a = pose.scale_a, scale_b = pose.scale_b;
    filter.valid = vm_and(which, in_range);
    filter.invalid = vm_and_not(which, in_range);

    const vec2 bounds = find_circle_difference(a.bound_center, b.bound_center, &pose);
    const vec2 axis = find_circle_difference(a.inner_center, b.inner_center, &pose);
    const vf size = v_add(size_a, size_b), limit = v_add(size, margin);
    const vf core = v_add(v_mul(scale_a, a.inner_radius), v_mul(scale_b, b.inner_radius));
    filter.size = size;
    filter.between = bounds;
    filter.square = v_mul(v2_dot(bounds, bounds), v_set(shrink));
    filter.apart = vm_or(v_lt(limit, v_set(0)), v_lt(v_mul(limit, limit), filter.square));
    filter.deep = v_lt(v_mul(v2_dot(axis, axis), v_set(grow)), v_mul(core, v_abs(core))); /* a core below 0 is none */

    set_vec2(item, POSITION, pose.position);
    set_vec2(item, ROTATION, pose.rotation);
    item[SCALE_A] = scale_a;
    item[SCALE_B] = scale_b;
    set_vec2(item, AXIS, axis);
    item[CORE] = core;
    item[SLACK] = find_slack(pose.position, a.info, b.info, size_a, size_b);
    item[FIRST_RECORD_A] = v_of_bits(a.first_record);
    item[FIRST_RECORD_B] = v_of_bits(b.first_record);
    item[INFO_A] = v_of_bits(a.info);
    item[INFO_B] = v_of_bits(b.info);
    item[PAIR] = v_of_bits(vi_add(vi_lanes(), vi_set(number + k)));
    set_vec2(item, DIRECTION, axis);
    set_vec2(item, ROTATION_A, placement->rotation_a);
    item[SIZE] = size;
    return filter;
}

#endif
