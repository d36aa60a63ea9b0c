/* SPDX-License-Identifier: MIT
 *
 * edge_rows.inl - rows of boxes and capsules on edges of runs: of two sides that touch, as those of two boxes are
 * (box/box_rows.inl).
 */
#ifndef NARC_PIECE_EDGE_ROWS_INL
#define NARC_PIECE_EDGE_ROWS_INL

#include <stdbool.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* Bodies on edges of runs: of these the arcs before and behind the edge, in their frames, and the number of the latter. */
struct edge_contact {
    const vf *item;                   /* of the pairs */
    vm is_a, rests, lies, capsule;    /* is the run A? What a body does (edges_below.inl) */
    vf before[8], behind[8], form[4]; /* form: the body's */
    vec2 axes;                        /* its own along the edge's normal */
    vi last, number, first_arc;       /* of the front; of the body */
    vi solid;                         /* its record */
    vf margin;
};

/* A run's edge with the arcs at its ends, or a body's side with its corners: fields, numbers as bits. */
enum {
    BEFORE,
    BEHIND = 2,
    SIDE_NORMAL = 4,
    RADIUS_BEFORE = 6,
    RADIUS_BEHIND,
    NUMBER_BEFORE,
    NUMBER_BEHIND,
    SIDE_FIELDS
};

INLINE vec2 get_side_vec2(const vf *side, int field) { return (vec2){side[field], side[field + 1]}; }

/* Places it, as of A in the lanes `is_a`, else of B. */
INLINE void place_side(const vf item[FIELDS], vm is_a, vf side[SIDE_FIELDS]) {
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    for (int f = BEFORE; f <= BEHIND; f += 2) {
        const vec2 center = get_side_vec2(side, f);
        set_vec2(side, f, v2_select(is_a, v2_scale(center, pose.scale_a), place_center_b(center, &pose)));
        side[RADIUS_BEFORE + f / 2] = v_mul(side[RADIUS_BEFORE + f / 2], v_select(is_a, pose.scale_a, pose.scale_b));
    }
    const vec2 normal = get_side_vec2(side, SIDE_NORMAL);
    set_vec2(side, SIDE_NORMAL, v2_select(is_a, normal, v2_rotate_opposite(pose.rotation, normal)));
}

/* The side of a body that faces the edge. Returns whether its corner that is lowest is the one behind it. */
INLINE vm find_facing_side(const struct edge_contact *e, bool capsules, vf side[SIDE_FIELDS]) {
    const vf zero = v_set(0);
    const vm left = v_lt(zero, e->axes.x), below = v_lt(zero, e->axes.y);
    const vm on_x = capsules ? vm_front(0) : v_lt(v_abs(e->axes.y), v_abs(e->axes.x)),
             negative = vm_or(vm_and(on_x, left), vm_and_not(below, on_x));
    const vf sign = v_select(negative, v_set(-1), v_set(1));
    /* The corners behind it and before it lie a quarter turn further, and back. */
    const vf x = v_mul(e->form[0], sign), y = capsules ? zero : v_mul(e->form[1], sign);
    const vi edge = find_edge_number(on_x, negative), three = vi_set(3), before = vi_add(edge, three);
    set_vec2(side, BEFORE, (vec2){x, v_select(on_x, v_neg(y), y)});
    set_vec2(side, BEHIND, (vec2){v_select(on_x, x, v_neg(x)), y});
    set_vec2(side, SIDE_NORMAL,
             (vec2){v_select(on_x, sign, capsules ? v_mul(e->form[1], sign) : zero), v_select(on_x, zero, sign)});
    side[RADIUS_BEFORE] = side[RADIUS_BEHIND] = e->form[2];
    side[NUMBER_BEFORE] = v_of_bits(number_box_arc(before, e->first_arc, capsules));
    side[NUMBER_BEHIND] = v_of_bits(number_box_arc(edge, e->first_arc, capsules));
    return vm_xor(vm_xor(left, below), on_x);
}

/* Writes the rows of boxes, or of capsules, in the lanes `which`; returns those that are settled. */
INLINE vm write_on_edges(const struct call *call, const struct edge_contact *e, vm which, bool capsules, bool edges) {
    const vf *const item = e->item;
    const vm is_a = e->is_a, of_b = vm_not(is_a), lies = e->lies;
    const vi one = vi_set(1), before = vi_sub(e->number, one);
    vf run[SIDE_FIELDS] = {e->before[0], e->before[1], e->behind[0], e->behind[1],      e->behind[4],
                           e->behind[5], e->before[2], e->behind[2], v_of_bits(before), v_of_bits(e->number)};
    vf body[SIDE_FIELDS], of[2][SIDE_FIELDS];
    const vm behind = find_facing_side(e, capsules, body);
    place_side(item, is_a, run);
    place_side(item, of_b, body);
    UNROLL
    for (int f = 0; f < SIDE_FIELDS; f++) {
        of[0][f] = v_select(is_a, run[f], body[f]);
        of[1][f] = v_select(is_a, body[f], run[f]);
    }
    struct box_contact c = {.a = {.normal = get_side_vec2(of[0], SIDE_NORMAL),
                                  .low = get_side_vec2(of[0], BEFORE),
                                  .high = get_side_vec2(of[0], BEHIND)},
                            .b = {.normal = get_side_vec2(of[1], SIDE_NORMAL),
                                  .low = get_side_vec2(of[1], BEHIND),
                                  .high = get_side_vec2(of[1], BEFORE)}};
    const struct facing_radii radii = {v_add(of[0][RADIUS_BEHIND], of[1][RADIUS_BEFORE]),
                                       v_add(of[0][RADIUS_BEFORE], of[1][RADIUS_BEHIND]),
                                       v_add(of[0][RADIUS_BEHIND], of[1][RADIUS_BEHIND])};
    vm left, corners;
    find_facing_of(&c, find_diamond_angle(c.a.normal), &radii, item[SLACK], true, &left, &corners);
    /* What rests does so along the edge's normal, with the arc behind that. */
    const vec2 n = get_side_vec2(run, SIDE_NORMAL);
    c.a.behind = vm_or(vm_and(lies, c.a.behind), vm_and_not(vm_or(is_a, behind), lies));
    c.b.behind = vm_or(vm_and(lies, c.b.behind), vm_and_not(vm_or(of_b, behind), lies));
    const vec2 u = v2_sub(v2_select(c.b.behind, c.b.low, c.b.high), v2_select(c.a.behind, c.a.high, c.a.low));
    c.separation = v_select(lies, c.separation, v_sub(v2_dot(u, n), radii.beyond));
    c.normal = v2_select(lies, c.normal, n);

    /* Along another normal than the edge's a body touches an arc, and at an end of the front that is no contact. */
    const vm parallel = v_le(v_abs(v2_cross(n, c.normal)), v_set(PARALLEL));
    const vm certain = vm_and_not(which, vm_and(lies, vm_or(left, corners)));
    const vm behind_edge = vm_or(vm_and(is_a, c.a.behind), vm_and_not(c.b.behind, is_a));
    const vm at_end =
        vm_or(vm_and_not(vi_lt(e->number, vi_set(2)), behind_edge), vm_and_not(behind_edge, vi_lt(e->number, e->last)));
    vm told = vm_and(certain, parallel);
    /* Deep ones are for those who know how far the solid goes on. */
    const vm deep = vm_and(told, v_lt(c.separation, v_set(0)));
    if (vm_any(deep)) {
        const vf x = e->form[0], y = e->form[1], scale_a = item[SCALE_A], scale_b = item[SCALE_B];
        const vf extent = v_add(v_add(x, y), e->form[2]),
                 room = v_mul(v_set(0x1p-17f), extent); /* of its inner circle */
        const vf inner = v_mul(v_sub(v_add(v_min(x, y), e->form[2]), room), v_select(is_a, scale_b, scale_a));
        vf solid[4];
        load_circle(call->batch->shapes->records, vi_select(which, e->solid, vi_set(0)), solid);
        const vm shallow =
            is_shallow(v_add(inner, inner), v_mul(solid[0], v_select(is_a, scale_a, scale_b)), c.separation);
        told = vm_and_not(told, vm_and_not(deep, call->batch->query->front_only ? vm_front(0) : shallow));
    }
    const vm keep = vm_and(told, is_below(c.separation, e->margin));
    const vm settled = vm_or(told, vm_and_not(vm_and(certain, at_end), parallel));
    if (!vm_any(keep))
        return settled;
    const vf *const on_a = of[0], *const on_b = of[1];
    const struct touching_sides sides = {{on_a[RADIUS_BEFORE], on_a[RADIUS_BEHIND], on_a[RADIUS_BEHIND],
                                          vi_bits(on_a[NUMBER_BEFORE]), vi_bits(on_a[NUMBER_BEHIND])},
                                         {on_b[RADIUS_BEHIND], on_b[RADIUS_BEFORE], on_b[RADIUS_BEHIND],
                                          vi_bits(on_b[NUMBER_BEFORE]), vi_bits(on_b[NUMBER_BEHIND])},
                                         get_item_bits(item, PAIR),
                                         {item[ROTATION_A], item[ROTATION_A + 1]},
                                         {item[POSITION], item[POSITION + 1]},
                                         capsules,
                                         NULL};
    struct told_sides rows;
    tell_sides(&c, &sides, &rows);
    char *place[V_WIDTH];
    find_places(call, sides.pairs, keep, place);
    write_touching(call, &c, &sides, &rows, e->margin, place, edges);
    return settled;
}

/* The same of both. */
INLINE vm answer_on_edges(const struct call *call, const struct edge_contact *e, bool edges) {
    const vm which = vm_or(e->rests, e->lies), boxes = vm_and_not(which, e->capsule);
    vm settled = vm_and_not(which, which);
    if (vm_any(boxes))
        settled = write_on_edges(call, e, boxes, false, edges);
    if (vm_any(vm_and(which, e->capsule)))
        settled = vm_or(settled, write_on_edges(call, e, vm_and(which, e->capsule), true, edges));
    return settled;
}

#endif
