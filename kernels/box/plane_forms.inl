/* SPDX-License-Identifier: MIT
 *
 * plane_forms.inl - pairs of a half-plane and a shape that has a form: they wait in the queues of boxes, capsules and
 * circles, where the half-plane is a box of no height, whose edge at +y is the boundary (base/planes.inl).
 *
 * What they touch along is the boundary's normal, for certain: the box is wider than four times what the other body and its
 * height are together, so that the gap falls off on both sides of it by more than that, whatever is rounded. Of the other body
 * the edge counts that is nearest to it, or the only point of a circle. Where two edges of a box are equally near, or a side is
 * no longer than rounding, and where a capsule stands upright, the pair is left to the search. docs/algorithm.md, section 9.
 */
#ifndef NARC_BOX_PLANE_FORMS_INL
#define NARC_BOX_PLANE_FORMS_INL

#include <stdint.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/planes.inl"
#include "base/question.inl"
#include "base/vec2.inl"
#include "box/box_pairs.inl"
#include "box/capsules.inl"
#include "box/circles.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Pairs of a half-plane and another shape, laid to each other. */
struct plane_pairs {
    struct box_form a, b;
    struct placement placement;
    vm of_a;               /* is A the half-plane? */
    vec2 half;             /* of the other shape, scaled */
    vf radius, gap, slack; /* its radius; from the boundary to it */
};

/* Those that may have a contact of the pairs that are taken. */
INLINE vm find_near_planes(const struct call *call, const struct plane_pairs *p, vm taken, int32_t number) {
    const vm near = vm_and_not(taken, v_lt(v_add(p->placement.margin, p->slack), p->gap));
    if (!call->bits)
        return near;
    const vm deep = vm_and(near, v_lt(p->gap, v_neg(p->slack)));
    call->bits[(uint32_t)number / 64] |= (uint64_t)vm_bits(deep) << (uint32_t)number % 64;
    return vm_and_not(near, deep);
}

INLINE void take_circles_at_planes(const struct call *call, const struct plane_pairs *p, vm taken, int32_t number,
                                   struct box_queue *queue) {
    const struct pose *const pose = &p->placement.pose;
    const vm all = vm_front(V_WIDTH), of_a = p->of_a, near = find_near_planes(call, p, taken, number);
    const struct circle_pair pair = {.position = pose->position,
                                     .rotation = pose->rotation,
                                     .to_world = p->placement.rotation_a,
                                     .half = v2_select(of_a, p->a.half, p->b.half),
                                     .scale = v_select(of_a, pose->scale_a, pose->scale_b),
                                     .radius = v_set(0),
                                     .radius_circle = p->radius,
                                     .is_a = vm_not(of_a),
                                     .sides = all,
                                     .capsule = vm_front(0),
                                     .edge = all,
                                     .number = vi_set(1),
                                     .first = vi_and(vi_select(of_a, p->a.info, p->b.info), vi_set(3))};
    if (vm_any(near))
        push_circles(&pair, near, number, ANY_CIRCLES, queue);
}

INLINE void push_at_planes(const struct plane_pairs *p, vm near, vi code, int32_t number, struct box_queue *queue) {
    const struct pose *const pose = &p->placement.pose;
    vf item[BOX_FIELDS];
    set_vec2(item, BOX_POSITION, pose->position);
    set_vec2(item, BOX_ROTATION, pose->rotation);
    set_vec2(item, BOX_ROTATION_A, p->placement.rotation_a);
    set_vec2(item, BOX_HALF_A, v2_scale(p->a.half, pose->scale_a));
    set_vec2(item, BOX_HALF_B, p->b.half);
    item[BOX_SCALE_B] = pose->scale_b;
    item[BOX_RADIUS_A] = v_mul(p->a.radius, pose->scale_a);
    item[BOX_RADIUS_B] = v_mul(p->b.radius, pose->scale_b);
    item[BOX_SLACK] = p->slack;
    item[BOX_CODE] = v_of_bits(code);
    item[BOX_PAIR] = v_of_bits(vi_add(vi_lanes(), vi_set(number)));
    push_boxes(queue, near, item, BOX_FIELDS);
}

/* Returns those that it took of the pairs in the lanes `which`. */
INLINE vm take_boxes_at_planes(const struct call *call, const struct plane_pairs *p, vm which, int32_t number,
                               struct box_queue *queue) {
    const vec2 q = p->placement.pose.rotation;
    const vf c = v_abs(q.x), s = v_abs(q.y);
    const vm of_a = p->of_a, crossed = v_lt(c, s), nearer = vm_or(crossed, v_lt(s, c));
    const vm longer = v_lt(v_add(p->slack, p->slack), v_min(p->half.x, p->half.y));
    const vm taken = vm_and(which, vm_and(nearer, longer)), near = find_near_planes(call, p, taken, number);
    const vf down_x = v_select(of_a, v_neg(q.y), q.y); /* the boundary's normal, turned round */
    const vf down = v_select(crossed, down_x, v_neg(q.x));
    const vi boundary = vi_set(1), edge = find_edge_number(crossed, v_lt(down, v_set(0)));
    const vi edges = vi_add(vi_select(of_a, boundary, edge), vi_shift_left(vi_select(of_a, edge, boundary), 2));
    if (vm_any(near))
        push_at_planes(p, near, vi_add(edges, find_first_arcs(&p->a, &p->b)), number, queue);
    return taken;
}

/* The same of capsules (capsules.inl). The end that counts is that behind both edges' normals, or between them, in their
 * order as the formula has it. */
INLINE vm take_capsules_at_planes(const struct call *call, const struct plane_pairs *p, vm which, int32_t number,
                                  struct box_queue *queue) {
    const vec2 q = p->placement.pose.rotation;
    const vf zero = v_set(0), one = v_set(1);
    const vm of_a = p->of_a, crossed = vm_not(v_lt(v_set(0x1p-7f), v_abs(q.x)));
    const vm longer = v_lt(v_add(p->slack, p->slack), p->half.x);
    const vm taken = vm_and_not(vm_and(which, longer), crossed), near = find_near_planes(call, p, taken, number);
    if (!vm_any(near))
        return taken;
    const vm below = v_lt(zero, q.x); /* the edge at -y faces the boundary */
    const vf sign = v_select(below, v_set(-1), one);
    const vec2 normal_b = {v_select(of_a, v_mul(p->b.half.y, sign), zero), v_select(of_a, sign, one)};
    const vm a_first =
        v_lt(v_select(vm_and_not(below, of_a), v_set(3), one), find_diamond_angle(v2_rotate_opposite(q, normal_b)));
    const vi first = vi_and(vi_select(of_a, vi_shift_left(p->b.info, 6), vi_shift_left(p->a.info, 4)), vi_set(0x50));
    vi code = vi_add(first, choose_bit(vm_not(of_a), EDGE_OF_B));
    code = vi_add(code, choose_bit(vm_not(vm_xor(a_first, below)), EDGE_TILTED));
    push_at_planes(p, near, code, number, queue);
    return taken;
}

/* Takes pairs of a half-plane and a circle, a box or a capsule, in the lanes `which`. Returns those that it took. */
NOINLINE vm take_planes(const struct call *call, const struct pair_indices *in, int k,
                        const struct placement *placement, vm which, int32_t number) {
    const narc_shapes *const shapes = call->batch->shapes;
    struct plane_pairs p = {.a = load_box_forms(shapes->boxes, in->shape_a + k),
                            .b = load_box_forms(shapes->boxes, in->shape_b + k),
                            .placement = *placement};
    const vm of_a = is_form(&p.a, NARC_IS_PLANE), of_b = is_form(&p.b, NARC_IS_PLANE);
    const vi info = vi_select(of_a, p.b.info, p.a.info);
    const vm asked = vm_and(which, vm_and(vm_xor(of_a, of_b), vi_lt(vi_set(0), info)));
    int32_t other[V_WIDTH];
    vf bound[4];
    if (!vm_any(asked))
        return asked;
    vi_store(other, vi_select(of_a, vi_load(in->shape_b + k), vi_load(in->shape_a + k)));
    v_rows(&shapes->headers->bound_x, sizeof *shapes->headers, other, bound);
    struct pose *const pose = &p.placement.pose;
    const vec2 q = pose->rotation;
    const vf scale = v_select(of_a, pose->scale_b, pose->scale_a),
             scale_plane = v_select(of_a, pose->scale_a, pose->scale_b);
    const struct laid_plane laid = lay_plane(call, in, k, of_a, q, (vec2){bound[0], bound[1]}, bound[2], scale);
    pose->position = laid.position;
    pose->scale_a = v_select(of_a, laid.size, pose->scale_a);
    pose->scale_b = v_select(of_a, pose->scale_b, laid.size);
    p.of_a = of_a;
    p.half = v2_scale(v2_select(of_a, p.b.half, p.a.half), scale);
    p.radius = v_mul(v_select(of_a, p.b.radius, p.a.radius), scale);
    const vf size = v_add(v_add(p.half.x, p.half.y), p.radius);
    const vf reach = v_add(v_mul(v_abs(q.x), p.half.y), v_mul(v_abs(q.y), p.half.x));
    p.gap = v_sub(v_sub(laid.height, reach), p.radius);
    p.slack =
        v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(laid.position.x), v_abs(laid.position.y)), v_add(size, laid.size)));
    const vm sizes = vm_and(is_box_in_range(size), is_box_in_range(scale_plane));
    const vm known = vm_and(asked, vm_and(laid.known, sizes));
    const vm circles = vm_and(known, vi_lt(vi_set((int32_t)NARC_IS_CIRCLE - 1), info));
    const vm boxes = vm_and(known, vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)NARC_IS_BOX))));
    const vm capsules = vm_and(known, vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)NARC_IS_CAPSULE))));
    if (vm_any(circles))
        take_circles_at_planes(call, &p, circles, number, &call->boxes[WITH_CIRCLE]);
    vm taken = circles;
    if (vm_any(boxes))
        taken = vm_or(taken, take_boxes_at_planes(call, &p, boxes, number, &call->boxes[OF_BOXES]));
    if (vm_any(capsules))
        taken = vm_or(taken, take_capsules_at_planes(call, &p, capsules, number, &call->boxes[OF_CAPSULES]));
    return taken;
}

#endif
