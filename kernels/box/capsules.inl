/* SPDX-License-Identifier: MIT
 *
 * capsules.inl - pairs of two capsules (store.h, narc_box_form): boxes without height, of which two edges are left, with
 * half a turn from one to the other. They wait in a queue of their own, with the fields of boxes.
 *
 * Corners and edges have the numbers of a box: edge 1 lies at +y and edge 3 at -y, each from the corner before it to its
 * own, which is behind it. So corners 0 and 3 are the end at +x, and 1 and 2 the one at -x.
 *
 * The fan has four junctions only, and so four intervals: all of them are computed, as the deciding formula does it
 * (normal_fan.inl), and no proof is needed. The junctions of each capsule are half a turn apart. So the walk, which
 * begins at +x, meets edge 1 of A, at the diamond angle 1, and that edge of B which lies within half a turn from +x, in
 * the order of their angles, and then the other two in theirs.
 */
#ifndef NARC_BOX_CAPSULES_INL
#define NARC_BOX_CAPSULES_INL

#include <math.h>

#include "base/arcs.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_pairs.inl"
#include "box/box_walk.inl"
#include "simd/simd.h"

/* Takes pairs of two capsules, in the lanes `which`: puts those that may have a contact into the queue. Returns the
 * lanes that it took. Any value of g is a bound: apart, if one along an axis of either exceeds the radii, the margin and
 * a slack. Colliding, if the segments cross, or the middle of B is well within A. */
INLINE vm take_capsules(const struct call *call, const struct box_form *a, const struct box_form *b,
                        const struct placement *placement, vm which, int32_t number, struct box_queue *queue) {
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position, q = pose->rotation;
    const vf zero = v_set(0);
    const vf half_a = v_mul(a->half.x, pose->scale_a), half_b = v_mul(b->half.x, pose->scale_b);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf size_a = v_add(half_a, radius_a), size_b = v_add(half_b, radius_b), radii = v_add(radius_a, radius_b);
    const vf c = v_abs(q.x), s = v_abs(q.y), x = v_abs(t.x), y = v_abs(t.y);
    const vec2 t_b = v2_unrotate(q, t);
    const vf along_a = v_sub(v_sub(x, half_a), v_mul(c, half_b)), across_a = v_sub(y, v_mul(s, half_b));
    const vf along_b = v_sub(v_sub(v_abs(t_b.x), half_b), v_mul(c, half_a));
    const vf across_b = v_sub(v_abs(t_b.y), v_mul(s, half_a));
    const vf across = v_max(across_a, across_b), best = v_max(across, v_max(along_a, along_b));

    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(x, y), v_add(size_a, size_b))), two = v_add(slack, slack);
    const vm sizes = vm_and(box_in_range(size_a), box_in_range(size_b));
    const vm taken = vm_and(which, vm_and(sizes, v_lt(two, v_min(half_a, half_b))));
    vm near = vm_and_not(taken, v_lt(v_add(placement->margin, slack), v_sub(best, radii)));
    if (call->bits) { /* nothing but overlaps is asked for */
        const vec2 beyond = {v_max(v_sub(x, half_a), zero), y};
        const vf core = v_max(v_sub(radii, two), zero);
        const vm inside = v_lt(v2_dot(beyond, beyond), v_mul(core, core));
        const vm deep = vm_and(near, vm_or(v_lt(across, v_neg(slack)), inside));
        call->bits[(uint32_t)number / 64] |= (uint64_t)vm_bits(deep) << (uint32_t)number % 64;
        near = vm_and_not(near, deep);
    }
    if (vm_any(near)) {
        const vi pairs = vi_add(vi_lanes(), vi_set(number));
        const vi first =
            vi_add(vi_shift_left(vi_and(a->info, vi_set(1)), 4), vi_shift_left(vi_and(b->info, vi_set(1)), 6));
        vf item[BOX_FIELDS];
        set_vec2(item, BOX_POSITION, t);
        set_vec2(item, BOX_ROTATION, q);
        set_vec2(item, BOX_ROTATION_A, placement->rotation_a);
        set_vec2(item, BOX_HALF_A, (vec2){half_a, a->half.y});
        set_vec2(item, BOX_HALF_B, b->half);
        item[BOX_SCALE_B] = pose->scale_b;
        item[BOX_RADIUS_A] = radius_a;
        item[BOX_RADIUS_B] = radius_b;
        item[BOX_SLACK] = slack;
        item[BOX_CODE] = v_of_bits(first);
        item[BOX_PAIR] = v_of_bits(pairs);
        push_boxes(queue, near, item);
        if (call->rows && call->batch->query->hints.base)
            put_hints(call, pairs, near, vi_set(FIRST_ARCS));
    }
    return taken;
}

INLINE vec2 find_capsule_normal_b(const struct box_pair *pair, vi edge) {
    return v2_rotate_opposite(box_vec2(pair, BOX_ROTATION), box_normal(pair, BOX_HALF_B, edge));
}

/* The junctions of edge `edge_a` of A and edge `edge_b` of B, which is `angle_b`. */
INLINE struct couple find_capsule_couple(const struct box_pair *pair, int edge_a, vi edge_b, vf angle_b) {
    const struct pose pose = box_pose(pair);
    const vi edge = vi_set(edge_a);
    const vec2 of_a = box_normal(pair, BOX_HALF_A, edge), of_b = find_capsule_normal_b(pair, edge_b);
    const vm a_first = v_lt(v_set((float)edge_a), angle_b);
    return (struct couple){.low = v2_select(a_first, of_a, of_b),
                           .high = v2_select(a_first, of_b, of_a),
                           .corner_a = box_corner(pair, BOX_HALF_A, edge),
                           .corner_b = place_center_b(box_corner(pair, BOX_HALF_B, edge_b), &pose),
                           .a_first = a_first,
                           .b_first = vm_not(a_first),
                           .number_a = edge,
                           .number_b = edge_b};
}

/* The largest gap, with the numbers of the corners in place of records. */
INLINE struct gap walk_capsules(const struct box_pair *pair) {
    const vm all = vm_front(V_WIDTH);
    const vi one = vi_set(1), three = vi_set(3), zero = vi_set(0);
    const vf angle_1 = diamond_angle(find_capsule_normal_b(pair, one));
    const vf angle_3 = diamond_angle(find_capsule_normal_b(pair, three));
    const vm turned = v_lt(angle_3, angle_1);
    const struct couple first =
        find_capsule_couple(pair, 1, vi_select(turned, three, one), v_select(turned, angle_3, angle_1));
    const struct couple last =
        find_capsule_couple(pair, 3, vi_select(turned, one, three), v_select(turned, angle_1, angle_3));
    struct gap best = {v_set(-INFINITY), first.low, v_set(1), zero, zero};
    vm rises = v_lt(v2_cross(v2_sub(last.corner_b, last.corner_a), first.low), v_set(0));
    rises = try_interval(pair, &last, &first, first.high, false, all, rises, &best);
    rises = try_interval(pair, &last, &first, last.low, true, all, rises, &best);
    rises = try_interval(pair, &first, &last, last.high, false, all, rises, &best);
    try_interval(pair, &first, &last, first.low, true, all, rises, &best);
    best.normal = v2_divide(best.normal, best.length);
    return best;
}

/* The edge of a capsule that is closer to n, of the two at the end where it touches, corner 1 or 3. `of_corner`: the
 * normal of the edge with that number. */
INLINE vi find_capsule_edge(vi corner, vec2 of_corner, vec2 n, vm *out_behind) {
    *out_behind = v_lt(v_set(0), v2_dot(of_corner, n));
    return vi_select(*out_behind, corner, vi_sub(vi_set(4), corner));
}

/* How the capsules of a pair touch. */
INLINE struct box_contact find_capsule_contact(const struct box_pair *pair) {
    const struct gap gap = walk_capsules(pair);
    const vec2 of_a = box_normal(pair, BOX_HALF_A, gap.record_a), of_b = find_capsule_normal_b(pair, gap.record_b);
    vm behind_a, behind_b;
    const vi edge_a = find_capsule_edge(gap.record_a, of_a, gap.normal, &behind_a);
    const vi edge_b = find_capsule_edge(gap.record_b, of_b, gap.normal, &behind_b);
    struct box_contact contact = {gap.separation, gap.normal, find_side_a(pair, edge_a), find_side_b(pair, edge_b)};
    contact.a.behind = behind_a;
    contact.b.behind = behind_b;
    return contact;
}

#endif
