/* SPDX-License-Identifier: MIT
 *
 * circles.inl - pairs with a circle about its own origin: two circles, and a circle and a box or a capsule (store.h,
 * narc_box_form), by clamping. They share a queue, with fields of boxes.
 *
 * Let p be the centre of the circle in the frame of the other shape, and h that one's half sizes; of two circles it is A,
 * and h is 0. Without the radii the gap g of a sharp box and a point has four junctions, with the values |p.x| - h.x, |p.y|
 * - h.y and two others, opposite to these. Its kinks and corners against the point lie in nine regions: beyond a corner in x
 * and y that corner answers, and elsewhere the edges on whose length p lies. Where p is by two slacks off the limits of its
 * region, and the values of two edges differ by as much, every sign of the formula is right: what is found here is its only
 * candidate, or the largest by more than rounding. u is longer than two slacks then, so that it is no loose one (faces.inl).
 * A capsule has two edges, and ends that answer wherever p is beyond them. The junctions of circles make no kink, as u is
 * the same on both sides; an interval without width, where u is opposite to it, gives a value that is less. Other pairs
 * are left to the search. docs/algorithm.md, section 9.
 */
#ifndef NARC_BOX_CIRCLES_INL
#define NARC_BOX_CIRCLES_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Of the shape beside the circle, the fields of A in BOX_HALF_A, not scaled, and BOX_RADIUS_A; its scale is BOX_SCALE_B.
 * BOX_RADIUS_B is the circle's radius. BOX_CODE: the number of the corner that touches, or of that behind the edge, bits
 * 0-1; the first arc, bits 4-5; and these. */
enum {
    TOUCHED_EDGE = 1 << 2,
    CIRCLE_IS_A = 1 << 3,
    BESIDE_CAPSULE = 1 << 6,
    BESIDE_SIDES = 1 << 7 /* not two circles */
};

INLINE vi choose_bit(vm m, int bit) { return vi_select(m, vi_set(bit), vi_set(0)); }

INLINE vm is_form(const struct box_form *form, uint32_t kind) {
    return vi_lt(vi_set(0), vi_and(form->info, vi_set((int32_t)kind)));
}

/* Pairs of a circle and any shape that has a form. */
INLINE vm are_with_circle(const struct box_form *a, const struct box_form *b) {
    const vi circle = vi_set((int32_t)NARC_IS_CIRCLE - 1), zero = vi_set(0); /* circles have the largest number */
    const vm a_is = vi_lt(circle, a->info), b_is = vi_lt(circle, b->info);
    return vm_or(vm_and(a_is, vi_lt(zero, b->info)), vm_and(b_is, vi_lt(zero, a->info)));
}

/* Sets the bits of pairs in the lanes `near` that overlap for certain, if nothing else is asked for; returns the others.
 * `square`: the centre's distance from the sharp shape, squared. */
INLINE vm settle_deep(const struct call *call, int32_t number, vm near, vf square, vf radii, vf two) {
    if (!call->bits)
        return near;
    const vf core = v_max(v_sub(radii, two), v_set(0));
    const vm deep = vm_and(near, v_lt(square, v_mul(core, core)));
    call->bits[(uint32_t)number / 64] |= (uint64_t)vm_bits(deep) << (uint32_t)number % 64;
    return vm_and_not(near, deep);
}

INLINE void push_circles(const struct placement *placement, vm near, int32_t number, vec2 half, vf scale, vf radius,
                         vf radius_circle, vi code, struct box_queue *queue) {
    vf item[BOX_FIELDS];
    set_vec2(item, BOX_POSITION, placement->pose.position);
    set_vec2(item, BOX_ROTATION, placement->pose.rotation);
    set_vec2(item, BOX_ROTATION_A, placement->rotation_a);
    set_vec2(item, BOX_HALF_A, half);
    item[BOX_SCALE_B] = scale;
    item[BOX_RADIUS_A] = radius;
    item[BOX_RADIUS_B] = radius_circle;
    item[BOX_CODE] = v_of_bits(code);
    item[BOX_PAIR] = v_of_bits(vi_add(vi_lanes(), vi_set(number)));
    push_boxes(queue, near, item, CIRCLE_FIELDS);
}

/* What take_circles() does, where all are two circles: the same values. */
INLINE vm take_two_circles(const struct call *call, const struct box_form *a, const struct box_form *b,
                           const struct placement *placement, vm which, int32_t number, struct box_queue *queue) {
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position;
    const vf zero = v_set(0), x = v_abs(t.x), y = v_abs(t.y);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf radii = v_add(radius_a, radius_b);
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(x, y), radii)), two = v_add(slack, slack);
    const vf square = v2_dot(t, t), limit = v_add(v_add(radii, placement->margin), slack);
    const vm apart = v_lt(v_mul(limit, limit), square), certain = v_lt(two, v_max(x, y));
    const vm sizes = vm_and(is_box_in_range(radius_a), is_box_in_range(radius_b));
    const vm taken = vm_and(vm_and(which, sizes), vm_or(certain, apart));
    const vm near = settle_deep(call, number, vm_and_not(taken, apart), square, radii, two);
    if (vm_any(near))
        push_circles(placement, near, number, (vec2){zero, zero}, zero, radius_a, radius_b, vi_set(0), queue);
    return taken;
}

/* Takes pairs with a circle, in the lanes `which`: puts those that may have a contact into the queue. Returns the lanes
 * that it took. */
INLINE vm take_circles(const struct call *call, const struct box_form *a, const struct box_form *b,
                       const struct placement *placement, vm which, int32_t number, struct box_queue *queue) {
    const vi last = vi_set((int32_t)NARC_IS_CIRCLE - 1);
    if (!vm_any(vm_and_not(which, vm_and(vi_lt(last, a->info), vi_lt(last, b->info)))))
        return take_two_circles(call, a, b, placement, which, number, queue);
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position, q = pose->rotation, t_b = v2_unrotate(q, t);
    const vf zero = v_set(0);
    const vm is_a = vm_and_not(is_form(a, NARC_IS_CIRCLE), is_form(b, NARC_IS_CIRCLE)); /* A is the circle, and B not */
    const vi info = vi_select(is_a, b->info, a->info);
    const vm sides = vm_not(vi_lt(last, info));
    const vm capsule = vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)NARC_IS_CAPSULE)));
    const vec2 half = v2_select(is_a, b->half, a->half);
    const vf scale = v_select(is_a, pose->scale_b, pose->scale_a);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf radius = v_select(is_a, radius_b, radius_a), radius_circle = v_select(is_a, radius_a, radius_b);
    const vf radii = v_add(radius_a, radius_b);
    const vec2 size = v2_scale(half, scale), p = {v_select(is_a, v_neg(t_b.x), t.x), v_select(is_a, v_neg(t_b.y), t.y)};
    const vf beyond_x = v_sub(v_abs(p.x), size.x), beyond_y = v_sub(v_abs(p.y), size.y);
    const vf size_other = v_add(v_add(size.x, size.y), radius);
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(t.x), v_abs(t.y)), v_add(size_other, radius_circle)));
    const vf two = v_add(slack, slack), inside = v_neg(two);

    const vm off_x = v_lt(two, beyond_x), off_y = v_lt(two, beyond_y), on_x = v_lt(beyond_x, inside),
             on_y = v_lt(beyond_y, inside);
    const vm at_x = vm_and(vm_and(on_y, v_lt(two, v_sub(beyond_x, beyond_y))), v_lt(two, v_abs(p.x)));
    const vm at_y = vm_and(vm_and(on_x, v_lt(two, v_sub(beyond_y, beyond_x))), v_lt(two, v_abs(p.y)));
    const vm at_corner = vm_or(vm_and(off_x, vm_or(off_y, capsule)), vm_and_not(vm_or(off_x, off_y), sides));
    const vec2 off = {v_max(beyond_x, zero), v_max(beyond_y, zero)};
    const vf square = v2_dot(off, off), limit = v_add(v_add(radii, placement->margin), slack);
    const vm apart = v_lt(v_mul(limit, limit), square);
    const vm at_edge = vm_or(at_x, at_y), certain = vm_or(at_edge, at_corner);
    const vm sizes = vm_and(is_box_in_range(size_other), is_box_in_range(radius_circle));
    const vm taken = vm_and(vm_and(which, sizes), vm_or(certain, apart));
    const vm near = settle_deep(call, number, vm_and_not(taken, apart), square, radii, two);
    if (vm_any(near)) {
        const vm left = v_lt(p.x, zero), below = v_lt(p.y, zero);
        /* Edges 0 to 3 lie at +x, +y, -x, -y; corners at +x +y, -x +y, -x -y, +x -y. Of a capsule corner 3 is its end at
         * +x, and corner 1 that at -x. */
        const vi edge = vi_select(at_x, choose_bit(left, 2), vi_select(below, vi_set(3), vi_set(1)));
        const vi end = vi_select(left, vi_set(1), vi_set(3));
        const vi corner = vi_select(below, vi_select(left, vi_set(2), vi_set(3)), choose_bit(left, 1));
        const vi touched = vi_select(at_edge, edge, vi_select(capsule, end, corner));
        vi code = vi_select(sides, vi_add(touched, vi_add(choose_bit(at_edge, TOUCHED_EDGE), vi_set(BESIDE_SIDES))),
                            vi_set(0));
        code = vi_add(code, vi_add(choose_bit(is_a, CIRCLE_IS_A), choose_bit(capsule, BESIDE_CAPSULE)));
        code = vi_add(code, vi_shift_left(vi_and(info, vi_set(3)), 4));
        push_circles(placement, near, number, half, scale, radius, radius_circle, code, queue);
    }
    return taken;
}

/* How the shape beside a circle touches it. */
struct circle_contact {
    vf separation;
    vec2 normal, center;  /* of the circle */
    vec2 corner, start;   /* of the other one: the corner that touches, and the normal of the edge before it */
    vm is_a, sides, edge; /* is A the circle; has the other one sides; does its edge touch? */
    vi arc;               /* the caller's number of the other one's arc, or of its edge */
    vf radius, radius_circle;
};

/* Corner i of the shapes beside circles, placed, and the normal of edge i. */
INLINE vec2 place_form_corner(const struct box_pair *pair, vm is_a, vm capsule, vi i) {
    const vec2 half = get_box_vec2(pair, BOX_HALF_A), q = get_box_vec2(pair, BOX_ROTATION),
               t = get_box_vec2(pair, BOX_POSITION);
    const vf zero = v_set(0);
    const vec2 corner = {v_mul(half.x, find_sign(vi_add(i, vi_set(1)))),
                         v_select(capsule, zero, v_mul(half.y, find_sign(i)))};
    /* By what leaves it as it is, where it is A's. */
    const struct pose pose = {.position = {v_select(is_a, t.x, zero), v_select(is_a, t.y, zero)},
                              .rotation = {v_select(is_a, q.x, v_set(1)), v_select(is_a, q.y, zero)},
                              .scale_b = get_box_field(pair, BOX_SCALE_B)};
    return place_center_b(corner, &pose);
}

INLINE vec2 place_form_normal(const struct box_pair *pair, vm is_a, vm capsule, vi i) {
    const vf sign = find_sign(i), zero = v_set(0), half_y = get_box_field(pair, BOX_HALF_A + 1);
    const vm odd = vi_lt(vi_set(0), vi_and(i, vi_set(1)));
    const vec2 n = {v_select(odd, v_select(capsule, v_mul(half_y, sign), zero), sign), v_select(odd, sign, zero)};
    return v2_select(is_a, v2_rotate_opposite(get_box_vec2(pair, BOX_ROTATION), n), n);
}

INLINE struct circle_contact find_circle_contact(const struct box_pair *pair) {
    const vi code = get_box_code(pair), number = vi_and(code, vi_set(3));
    const vf zero = v_set(0);
    const vec2 origin = {zero, zero}, t = get_box_vec2(pair, BOX_POSITION);
    struct circle_contact c = {.is_a = has_bit(code, CIRCLE_IS_A),
                               .sides = has_bit(code, BESIDE_SIDES),
                               .edge = has_bit(code, TOUCHED_EDGE),
                               .radius = get_box_field(pair, BOX_RADIUS_A),
                               .radius_circle = get_box_field(pair, BOX_RADIUS_B)};
    const vf radii = v_add(c.radius, c.radius_circle);
    /* Nothing but the signs of zeros: as if B's centre had been turned. */
    const vec2 b = v2_add(t, v2_rotate(get_box_vec2(pair, BOX_ROTATION), origin));
    vec2 u = b;
    c.center = b;
    c.corner = c.start = origin;
    c.arc = vi_set(0);
    if (vm_any(c.sides)) {
        const vm capsule = has_bit(code, BESIDE_CAPSULE);
        const vi first = vi_and(vi_shift_right(code, 4), vi_set(3)), end = vi_shift_right(number, 1);
        c.arc = vi_select(capsule, vi_and(vi_add(end, first), vi_set(1)), vi_and(vi_add(number, first), vi_set(3)));
        c.center = v2_select(c.is_a, origin, b);
        c.corner = place_form_corner(pair, c.is_a, capsule, number);
        c.start = place_form_normal(pair, c.is_a, capsule, number);
        u = v2_sub(v2_select(c.is_a, c.corner, c.center), v2_select(c.is_a, c.center, c.corner));
    }
    const vf length = v2_length(u);
    c.separation = v_sub(v_select(c.edge, v2_dot(u, c.start), length), radii);
    c.normal = v2_select(c.edge, c.start, v2_divide(u, length));
    return c;
}

/* Answers the pairs k ... of a queue, all with rows of one point. */
INLINE void answer_circles(const struct call *call, const struct box_queue *queue, int k, int live) {
    const struct box_pair pair = {queue, k, false};
    const vi pairs = vi_bits(get_box_field(&pair, BOX_PAIR));
    const struct circle_contact c = find_circle_contact(&pair);
    const vm keep = vm_and(vm_front(live), is_below(c.separation, find_margins(call, pairs)));
    if (!vm_any(keep))
        return;
    const vec2 n = c.normal, to_world = get_box_vec2(&pair, BOX_ROTATION_A);
    /* Outwards along n: of B, which is touched on its side -n, below 0. */
    const vf radius = v_select(c.is_a, v_neg(c.radius), c.radius),
             radius_circle = v_select(c.is_a, c.radius_circle, v_neg(c.radius_circle));
    const vec2 on_circle = v2_add(c.center, v2_scale(n, radius_circle)), step = v2_scale(n, radius),
               on_other = v2_add(c.corner, step);
    const vf half = v_set(0.5f), along = v2_cross(n, on_circle), touched = v2_cross(n, on_other);
    const vi number = vi_and(get_box_code(&pair), vi_set(3));
    const vm capsule = has_bit(get_box_code(&pair), BESIDE_CAPSULE);
    vf before = touched;
    if (vm_any(c.edge)) { /* from the corner before the edge on */
        const vec2 corner = place_form_corner(&pair, c.is_a, capsule, vi_sub(number, vi_set(1)));
        before = v_select(c.edge, v2_cross(n, v2_add(corner, step)), touched);
    }
    const vf min = v_min(touched, before), max = v_max(touched, before);
    const vf most = v_max(v_select(c.is_a, along, min), v_select(c.is_a, min, along)),
             least = v_min(v_select(c.is_a, along, max), v_select(c.is_a, max, along));
    const vec2 place = {v_mul(half, v_add(v2_dot(n, on_circle), v2_dot(n, on_other))), v_mul(half, v_add(most, least))};
    const vi other = vi_add(c.arc, choose_bit(c.edge, NARC_FEATURE_EDGE));
    const vf curved = v_select(c.edge, v_set(INFINITY), c.radius);
    struct answer answer = {.separation = c.separation,
                            .normal = v2_rotate(to_world, n),
                            .point = v2_rotate(to_world, v2_rotate(n, place)),
                            .feature = vi_select(c.is_a, vi_shift_left(other, 8), other),
                            .radius_a = v_select(c.is_a, c.radius_circle, curved),
                            .radius_b = v_select(c.is_a, curved, c.radius_circle)};
    if (call->question->kind == MANIFOLD_ROWS) {
        const vi all_round = vi_set(-1); /* NARC_REACH_ONE twice */
        const vi next = vi_add(number, vi_select(capsule, vi_set(2), vi_set(1)));
        const struct feature arc = {.start = c.start, .end = place_form_normal(&pair, c.is_a, capsule, next)};
        const vi reach = vi_select(c.sides, find_reach(&arc, n, vi_set(0), c.edge), all_round);
        answer.reach_a = vi_select(c.is_a, all_round, reach);
        answer.reach_b = vi_select(c.is_a, reach, all_round);
    }
    char *to[V_WIDTH];
    find_box_places(call, queue, k + live - 1, pairs, keep, to);
    write_rows(call, to, find_numbers(call, pairs), &answer);
}

#endif
