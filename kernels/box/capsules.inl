/* SPDX-License-Identifier: MIT
 *
 * capsules.inl - pairs of two capsules (store.h, narc_box_form): boxes without height, of which two edges are left,
 * half a turn apart. They wait in a queue of their own, with the fields of boxes.
 *
 * Corners and edges have the numbers of a box: edge 1 lies at +y and edge 3 at -y, each from the corner before it to
 * its own one behind it. So corners 0 and 3 are the end at +x, and 1 and 2 the one at -x.
 *
 * Let g be the gap of the two segments, without the radii. Its fan has four junctions. Next to that with the largest
 * value are two of the other capsule, and the formula's answer is the kink there or lies in one of the two intervals in
 * between, if three things are so: the value exceeds those of the other three by two slacks; it exceeds 64 slacks, or
 * is below minus two; and the capsules are not at a right angle. docs/algorithm.md, section 9, proves it. Other pairs
 * are walked around all four intervals.
 */
#ifndef NARC_BOX_CAPSULES_INL
#define NARC_BOX_CAPSULES_INL

#include <math.h>

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_pairs.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Bits of BOX_CODE, of the edge with the largest value: it is of B, and not of A; it lies at -y; the end at +x of the
 * capsule which has not that edge is further off from it, if it is B, or nearer, if it is A. */
enum { EDGE_OF_B = 1, EDGE_NEGATIVE = 2, EDGE_TILTED = 4 };

/* Takes pairs of two capsules, in the lanes `which`: puts those that may have a contact into the queue. Returns the
 * lanes that it took. Any value of g is a bound: apart, if one along an axis of either exceeds the radii, the margin
 * and a slack. Colliding, if the segments cross, or a point of one is closer to one of the other than both radii. */
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
    const vm sizes = vm_and(is_box_in_range(size_a), is_box_in_range(size_b));
    const vm taken = vm_and(which, vm_and(sizes, v_lt(two, v_min(half_a, half_b))));
    vm near = vm_and_not(taken, v_lt(v_add(placement->margin, slack), v_sub(best, radii)));
    if (call->bits) { /* nothing but overlaps is asked for */
        /* The point of A that is closest to the middle of B, and that of B which is closest to it. */
        const vec2 r = {v_sub(t.x, v_max(v_min(t.x, half_a), v_neg(half_a))), t.y};
        const vf along = v_max(v_min(v_neg(v2_dot(q, r)), half_b), v_neg(half_b));
        const vec2 between = v2_add(r, v2_scale(q, along));
        const vf core = v_max(v_sub(radii, two), zero);
        const vm close = v_lt(v2_dot(between, between), v_mul(core, core));
        near = settle_overlaps(call, number, near, vm_or(v_lt(across, v_neg(slack)), close));
    }
    if (vm_any(near)) {
        const vm by_b = v_lt(across_a, across_b);
        const vf center = v_select(by_b, t_b.y, t.y); /* of the other capsule, across the edge; or minus that */
        const vm negative = vm_xor(by_b, v_lt(center, zero)), tilted = vm_xor(v_lt(zero, q.y), negative);
        const vf others = v_max(v_min(across_a, across_b), v_sub(across, v_mul(v_set(2), v_abs(center))));
        const vm clear = vm_or(v_lt(v_mul(v_set(64), slack), across), v_lt(across, v_neg(two)));
        const vm certain = vm_and(vm_and(clear, v_lt(two, v_sub(across, others))), v_lt(v_set(0x1p-7f), c));
        vi code = vi_select(certain, vi_set(0), vi_set(BOX_TIE));
        code = vi_add(code, vi_select(by_b, vi_set(EDGE_OF_B), vi_set(0)));
        code = vi_add(code, vi_select(negative, vi_set(EDGE_NEGATIVE), vi_set(0)));
        code = vi_add(code, vi_select(tilted, vi_set(EDGE_TILTED), vi_set(0)));
        const vi first =
            vi_add(vi_shift_left(vi_and(a->info, vi_set(1)), 4), vi_shift_left(vi_and(b->info, vi_set(1)), 6));
        push_forms(placement, (vec2){half_a, a->half.y}, b->half, radius_a, radius_b, slack, vi_add(code, first), near,
                   number, queue);
    }
    return taken;
}

INLINE vm has_bit(vi code, int bit) { return vi_lt(vi_set(0), vi_and(code, vi_set(bit))); }

INLINE vec2 find_end_a(const struct box_pair *pair, vm right) {
    const vf half = get_box_field(pair, BOX_HALF_A);
    return (vec2){v_select(right, half, v_neg(half)), v_set(0)};
}

/* How the capsules of a pair touch, in the lanes `open`. */
INLINE struct box_contact find_capsule_contact(const struct box_pair *pair, vm open) {
    const struct pose pose = get_box_pose(pair);
    const vf zero = v_set(0), radii = v_add(get_box_field(pair, BOX_RADIUS_A), get_box_field(pair, BOX_RADIUS_B));
    const vi code = get_box_code(pair), first = vi_set(1), second = vi_set(3);
    const vm by_b = has_bit(code, EDGE_OF_B), negative = has_bit(code, EDGE_NEGATIVE);
    const vm tilted = has_bit(code, EDGE_TILTED);
    /* The ends that face each other in the intervals before the edge's normal and behind it: those at +x? */
    const vm up = vm_not(negative), other = vm_xor(tilted, vm_not(by_b));
    const vm before_a = vm_or(vm_and(by_b, other), vm_and_not(up, by_b)),
             behind_a = vm_or(vm_and(by_b, other), vm_and_not(negative, by_b));
    const vm before_b = vm_or(vm_and(by_b, up), vm_and_not(other, by_b)),
             behind_b = vm_or(vm_and(by_b, negative), vm_and_not(other, by_b));
    const vf half_b = get_box_field(pair, BOX_HALF_B);
    const vec2 left_b = place_center_b((vec2){v_neg(half_b), zero}, &pose),
               right_b = place_center_b((vec2){half_b, zero}, &pose);
    const vec2 u_before = v2_sub(v2_select(before_b, right_b, left_b), find_end_a(pair, before_a));
    const vec2 u_behind = v2_sub(v2_select(behind_b, right_b, left_b), find_end_a(pair, behind_a));
    const vi edge = vi_select(negative, second, first);
    const vec2 f = v2_select(by_b, find_side_normal(pair, edge, true), find_side_normal(pair, edge, false));

    const vm rises = v_lt(v2_cross(u_before, f), zero), falls = v_lt(v2_cross(f, u_behind), zero);
    const vm at_ends = vm_not(vm_and(rises, falls));
    struct box_contact c = {.separation = v_sub(v2_dot(u_behind, f), radii), .normal = f};
    vm left = vm_or(has_bit(code, BOX_TIE), vm_not(vm_or(rises, falls)));
    if (vm_any(at_ends)) {
        const vec2 u = v2_select(rises, u_behind, u_before);
        const vf length = v2_length(u);
        c.separation = v_select(at_ends, v_sub(length, radii), c.separation);
        c.normal = v2_select(at_ends, v2_divide(u, length), c.normal);
    }
    const vm at_right_a = vm_or(vm_and(rises, behind_a), vm_and_not(before_a, rises));
    const vm at_right_b = vm_or(vm_and(rises, behind_b), vm_and_not(before_b, rises));
    vi corner_a = vi_select(at_right_a, second, first), corner_b = vi_select(at_right_b, second, first);
    c.left = left = vm_and(open, left);
    if (BLOCK > 1 && vm_any(left)) {
        struct gap gap;
        NARC_NAMED(walk_capsules)(pair, &gap);
        c.separation = v_select(left, gap.separation, c.separation);
        c.normal = v2_select(left, gap.normal, c.normal);
        corner_a = vi_select(left, gap.record_a, corner_a);
        corner_b = vi_select(left, gap.record_b, corner_b);
    }
    c.a = find_closest_side(pair, corner_a, c.normal, false);
    c.b = find_closest_side(pair, corner_b, c.normal, true);
    const vm at_top = vi_lt(c.b.edge, second); /* its ends are placed already */
    c.b.low = v2_select(at_top, left_b, right_b);
    c.b.high = v2_select(at_top, right_b, left_b);
    return c;
}

#endif
