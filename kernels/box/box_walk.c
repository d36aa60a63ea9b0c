/* SPDX-License-Identifier: MIT
 *
 * box_walk.c - the deciding formula (normal_fan.inl) for two boxes of which more than two edges may answer: around
 * all of the fan, without a look at the arcs.
 *
 * The junctions of each box are a right angle apart. So the walk, which begins at +x, meets them in four couples:
 * edge p of A, at the diamond angle p, and the edge of B that is nearest to it, in the order of their angles. B's edge
 * next to +x may lie just before it: then its interval is the last of the walk. Half sizes are more than rounding, so
 * there is always a candidate.
 */
#include <math.h>

#include "base/call.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "kernels.h"
#include "sat/faces.inl"
#include "sat/normal_fan.inl"
#include "simd/simd.h"

/* Two junctions that follow each other, and the corners behind their edges, with their numbers. */
struct couple {
    vec2 low, high, corner_a, corner_b;
    vm a_first, b_first;
    vi number_a, number_b;
};

/* Couple p, with edge `turn` + p of B; `wraps`: B's edge lies before +x. */
INLINE struct couple find_couple(const struct box_pair *pair, int p, vi turn, vm *out_wraps) {
    const struct pose pose = get_box_pose(pair);
    const vi edge_a = vi_set(p), edge_b = vi_add(turn, edge_a);
    const vec2 of_a = find_box_normal(pair, BOX_HALF_A, edge_a), of_b = find_side_normal(pair, edge_b, true);
    const vf angle = find_diamond_angle(of_b);
    *out_wraps = v_lt(v_set(2), angle);
    const vm a_first = p == 0 ? vm_and_not(v_lt(v_set(0), angle), *out_wraps) : v_lt(v_set((float)p), angle);
    return (struct couple){.low = v2_select(a_first, of_a, of_b),
                           .high = v2_select(a_first, of_b, of_a),
                           .corner_a = find_box_corner(pair, BOX_HALF_A, edge_a),
                           .corner_b = place_center_b(find_box_corner(pair, BOX_HALF_B, edge_b), &pose),
                           .a_first = a_first,
                           .b_first = vm_not(a_first),
                           .number_a = edge_a,
                           .number_b = edge_b};
}

/* Takes the candidate of the interval between a couple's junctions, or of the one behind them, up to `end`, if it is
 * better, in the lanes `which`. Returns whether the gap rises at the interval's end. */
INLINE vm try_interval(const struct box_pair *pair, const struct couple *last, const struct couple *couple, vec2 end,
                       bool behind, vm which, vm rises, struct gap *best) {
    const vm none = vm_front(0), last_a = behind ? none : couple->b_first, last_b = behind ? none : couple->a_first;
    const vec2 start = behind ? couple->high : couple->low;
    const struct arc_pair arcs = {
        {.center = v2_select(last_a, last->corner_a, couple->corner_a), .radius = get_box_field(pair, BOX_RADIUS_A)},
        {.center = v2_select(last_b, last->corner_b, couple->corner_b), .radius = get_box_field(pair, BOX_RADIUS_B)}};
    const struct candidate found = find_candidate(&arcs, start, end, rises);
    const vm better = vm_and(which, vm_and(found.exists, v_lt(best->separation, found.value)));
    const struct gap gap = {
        found.value, v2_select(found.inside, found.u, start), v_select(found.inside, found.length, v_set(1)),
        vi_select(last_a, last->number_a, couple->number_a), vi_select(last_b, last->number_b, couple->number_b)};
    *best = select_gap(better, &gap, best);
    return found.rises;
}

/* What is told of the largest gap: a normal of unit length (sat/faces.inl). */
INLINE void tell_box_normal(const struct box_pair *pair, struct gap *best) {
    const vf radii = v_add(get_box_field(pair, BOX_RADIUS_A), get_box_field(pair, BOX_RADIUS_B)),
             slack = get_box_field(pair, BOX_SLACK);
    best->normal = v2_divide(best->normal, best->length);
    if (!vm_any(v_lt(v_add(best->separation, radii), v_add(slack, slack)))) /* |u| is no less */
        return;
    const struct pose pose = get_box_pose(pair);
    const vi one = vi_set(1), own_a = best->record_a, own_b = best->record_b;
    vi edge[JUNCTIONS] = {own_a, own_b, vi_add(own_a, one), vi_add(own_b, one)};
    for (int k = 0; pair->capsules && k < 2; k++) {
        edge[k] = find_own_edge(edge[k]);
        edge[k + 2] = vi_sub(vi_set(4), edge[k]);
    }
    const struct arc_pair arcs = {
        {.center = find_box_corner(pair, BOX_HALF_A, own_a),
         .radius = get_box_field(pair, BOX_RADIUS_A),
         .start = find_side_normal(pair, edge[0], false),
         .end = find_side_normal(pair, edge[2], false)},
        {.center = place_center_b(find_box_corner(pair, BOX_HALF_B, own_b), &pose),
         .radius = get_box_field(pair, BOX_RADIUS_B),
         .start = find_side_normal(pair, edge[1], true),
         .end = find_side_normal(pair, edge[3], true)},
    };
    const vm all = vm_front(V_WIDTH), none = vm_front(0), faces[JUNCTIONS] = {all, all, all, all};
    const vm loose = is_loose(&arcs, pose.position);
    if (vm_any(loose))
        best->normal = choose_face(&arcs, pose.position, loose, faces, none, none, best->normal);
}

void NARC_NAMED(walk_boxes)(const struct box_pair *given, struct gap *out_best) {
    const struct box_pair boxes = {given->queue, given->k, false}, *const pair = &boxes; /* a constant */
    const vec2 q = get_box_vec2(pair, BOX_ROTATION);
    const vm all = vm_front(V_WIDTH);
    const vi zero = vi_set(0);
    /* B's edge nearest to +x. */
    const vm crossed = v_lt(v_abs(q.x), v_abs(q.y));
    const vm opposite = vm_or(vm_and(crossed, v_lt(q.y, v_set(0))), vm_and_not(v_lt(v_set(0), q.x), crossed));
    const vi turn = vi_add(vi_select(crossed, vi_set(1), zero), vi_select(opposite, vi_set(2), zero));
    vm wraps, never;
    const struct couple first = find_couple(pair, 0, turn, &wraps);
    const struct couple before = find_couple(pair, 3, turn, &never);
    struct couple last = before, couple = first;
    struct gap best = {v_set(-INFINITY), first.low, v_set(1), zero, zero};
    vm rises = v_lt(v2_cross(v2_sub(last.corner_b, last.corner_a), first.low), v_set(0));
    for (int p = 0; p < 4; p++) {
        const struct couple next = p == 3 ? first : p == 2 ? before : find_couple(pair, p + 1, turn, &never);
        rises = try_interval(pair, &last, &couple, couple.high, false, p == 0 ? vm_not(wraps) : all, rises, &best);
        rises = try_interval(pair, &last, &couple, next.low, true, all, rises, &best);
        last = couple;
        couple = next;
    }
    if (vm_any(wraps))
        try_interval(pair, &before, &first, first.high, false, wraps, rises, &best);
    tell_box_normal(pair, &best);
    *out_best = best;
}

/* Of the couples 1 and 3 are left, 1 with that edge of B which lies within
 * half a turn from +x. */
void NARC_NAMED(walk_capsules)(const struct box_pair *given, struct gap *out_best) {
    const struct box_pair capsules = {given->queue, given->k, true}, *const pair = &capsules;
    const vm all = vm_front(V_WIDTH);
    const vi zero = vi_set(0);
    const vf angle_1 = find_diamond_angle(find_side_normal(pair, vi_set(1), true));
    const vf angle_3 = find_diamond_angle(find_side_normal(pair, vi_set(3), true));
    const vi turn = vi_select(v_lt(angle_3, angle_1), vi_set(2), zero);
    vm never;
    const struct couple first = find_couple(pair, 1, turn, &never), last = find_couple(pair, 3, turn, &never);
    struct gap best = {v_set(-INFINITY), first.low, v_set(1), zero, zero};
    vm rises = v_lt(v2_cross(v2_sub(last.corner_b, last.corner_a), first.low), v_set(0));
    rises = try_interval(pair, &last, &first, first.high, false, all, rises, &best);
    rises = try_interval(pair, &last, &first, last.low, true, all, rises, &best);
    rises = try_interval(pair, &first, &last, last.high, false, all, rises, &best);
    try_interval(pair, &first, &last, first.low, true, all, rises, &best);
    tell_box_normal(pair, &best);
    *out_best = best;
}
