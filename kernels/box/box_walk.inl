/* SPDX-License-Identifier: MIT
 *
 * box_walk.inl - the deciding formula (normal_fan.inl) for two boxes of which more than two edges may answer: around
 * all of the fan, without a look at the arcs.
 *
 * The junctions of both boxes are a right angle apart. So the walk, which begins at +x, meets them in four couples: edge
 * p of A, at the diamond angle p, and the edge of B that is nearest to it, in the order of their angles. B's edge next
 * to +x may lie just before it: then its interval is the last of the walk. Half sizes are more than rounding, so there
 * is always a candidate.
 */
#ifndef NARC_BOX_BOX_WALK_INL
#define NARC_BOX_BOX_WALK_INL

#include <math.h>

#include "base/arcs.inl"
#include "base/gap.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "sat/normal_fan.inl"
#include "simd/simd.h"

/* The corners of a pair with their numbers, B's counted from the one behind the first couple. */
struct box_corners {
    struct arcs a[4], b[4];
    vi number_a[4], number_b[4];
};

/* Takes the candidate of the interval from `low` to `high` if it is better, in the lanes `which`. A's corner is number
 * p there, or the one before it in the lanes `before_a`, and so is B's. Returns whether the gap rises at `high`. */
INLINE vm try_interval(const struct box_corners *corners, int p, vm before_a, vm before_b, vec2 low, vec2 high,
                       vm which, vm rises, struct gap *best) {
    const int last = (p + 3) & 3;
    const struct arc_pair arcs = {select_arcs(before_a, &corners->a[last], &corners->a[p]),
                                  select_arcs(before_b, &corners->b[last], &corners->b[p])};
    const struct candidate found = find_candidate(&arcs, low, high, rises);
    const vm better = vm_and(which, vm_and(found.exists, v_lt(best->separation, found.value)));
    const struct gap gap = {found.value, v2_select(found.inside, found.u, low),
                            v_select(found.inside, found.length, v_set(1)),
                            vi_select(before_a, corners->number_a[last], corners->number_a[p]),
                            vi_select(before_b, corners->number_b[last], corners->number_b[p])};
    *best = select_gap(better, &gap, best);
    return found.rises;
}

/* The largest gap, with the numbers of the corners in place of records. */
static __attribute__((noinline)) void walk_boxes(const struct box_pair *pair, struct gap *out_best) {
    const vec2 q = pair->pose.rotation;
    const vm all = vm_front(V_WIDTH), none = vm_front(0);
    const vi zero = vi_set(0);
    /* B's edge nearest to +x. */
    const vm crossed = v_lt(v_abs(q.x), v_abs(q.y));
    const vm opposite = vm_or(vm_and(crossed, v_lt(q.y, v_set(0))), vm_and_not(v_lt(v_set(0), q.x), crossed));
    const vi turn = vi_add(vi_select(crossed, vi_set(1), zero), vi_select(opposite, vi_set(2), zero));
    struct box_corners corners;
    vec2 low[4], high[4];
    vm a_first[4], wraps = none;
    for (int p = 0; p < 4; p++) {
        const vi edge_a = vi_set(p), edge_b = vi_add(turn, edge_a);
        const vec2 of_a = box_normal(edge_a), of_b = v2_rotate_opposite(q, box_normal(edge_b));
        const vf angle = diamond_angle(of_b);
        wraps = p == 0 ? v_lt(v_set(2), angle) : wraps;
        a_first[p] = vm_and_not(v_lt(v_set((float)p), angle), p == 0 ? wraps : none);
        low[p] = v2_select(a_first[p], of_a, of_b);
        high[p] = v2_select(a_first[p], of_b, of_a);
        corners.a[p] = (struct arcs){.center = box_corner(pair->half_a, edge_a), .radius = pair->radius_a};
        corners.b[p] = (struct arcs){.center = place_center_b(box_corner(pair->half_b, edge_b), &pair->pose),
                                     .radius = pair->radius_b};
        corners.number_a[p] = edge_a;
        corners.number_b[p] = edge_b;
    }
    struct gap best = {v_set(-INFINITY), low[0], v_set(1), zero, zero};
    vm rises = v_lt(v2_cross(v2_sub(corners.b[3].center, corners.a[3].center), low[0]), v_set(0));
    for (int p = 0; p < 4; p++) {
        const vm which = p == 0 ? vm_not(wraps) : all;
        rises = try_interval(&corners, p, vm_not(a_first[p]), a_first[p], low[p], high[p], which, rises, &best);
        rises = try_interval(&corners, p, none, none, high[p], low[(p + 1) & 3], all, rises, &best);
    }
    try_interval(&corners, 0, vm_not(a_first[0]), a_first[0], low[0], high[0], wraps, rises, &best);
    best.normal = v2_divide(best.normal, best.length);
    *out_best = best;
}

#endif
