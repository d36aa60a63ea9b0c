/* SPDX-License-Identifier: MIT
 *
 * support.inl - the support points of two bodies along a direction.
 *
 * The difference B - A is the set of all b - a. It is convex, it holds the origin exactly if the bodies have a common
 * point, and its distance from the origin is the bodies' distance. For a unit direction m from A to B its point that
 * lies furthest towards -m is w = (b_j - r_j m) - (a_i + r_i m), i and j the arcs that hold m and -m: so w.m is the gap
 * g(m) of sat/normal_fan.inl. Every direction gives a lower bound of the separation that way, whether the bodies
 * collide or not.
 */
#ifndef NARC_METHODS_SUPPORT_INL
#define NARC_METHODS_SUPPORT_INL

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "sat/arc_lookup.inl"
#include "simd/simd.h"

/* When a search ends for want of precision, relative to the numbers that go into w: normal_fan.inl's table, with |t|
 * for D and the arcs' own |centre| + radius for the extents, comes to 53 roundings of their sum at worst; 16 are seldom
 * exceeded, and more would end searches that can still go on. */
#define SUPPORT_NOISE 0x1p-20f

struct support {
    vec2 m; /* unit */
    vec2 w;
    vf gap;
    vec2 middle; /* of the two support points */
    vf noise;
    vi record_a, record_b;
};

/* Which way along the ring an arc's neighbour is nearer to holding a direction: -1, 1, or 0 if the arc holds it. */
INLINE vi step_towards(const struct arcs *arc, vec2 m) {
    const vm before = v_lt(v2_cross(arc->start, m), v_set(0)), behind = v_lt(v2_cross(m, arc->end), v_set(0));
    return vi_select(before, vi_set(-1), vi_select(behind, vi_set(1), vi_set(0)));
}

INLINE vm is_not_zero(vi a) { return vm_or(vi_lt(a, vi_set(0)), vi_lt(vi_set(0), a)); }

/* The arcs of the pairs k ... of a queue that hold the unit vectors m and -m. The look-up is right but for junctions
 * within 16 bits of m; where these matter, at edges, a few steps along the ring mend that. */
INLINE struct arc_pair find_support_arcs(const narc_record *records, const struct queue *queue, int k, vm live, vec2 m,
                                         const struct pose *pose, vi *out_a, vi *out_b) {
    const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
    vi a, b;
    find_arcs(records, queue, k, m, &a, &b);
    for (int step = 0;; step++) {
        const struct arc_pair arcs = load_arc_pair(records, a, b, pose);
        const vi by_a = step_towards(&arcs.a, m), by_b = step_towards(&arcs.b, m);
        const vm moves = vm_or(is_not_zero(by_a), is_not_zero(by_b));
        if (!vm_any(vm_and(live, moves)) || step == NARC_MAX_ARCS) {
            *out_a = a;
            *out_b = b;
            return arcs;
        }
        a = step_record(ring_a, a, by_a);
        b = step_record(ring_b, b, by_b);
    }
}

INLINE vf sum_of_sizes(vec2 a) { return v_add(v_abs(a.x), v_abs(a.y)); }

/* The support points of the pairs k ... of a queue along a direction of any length, in the lanes `live`. */
INLINE struct support find_support(const narc_shapes *shapes, const struct queue *queue, int k, vm live,
                                   vec2 direction) {
    const struct pose pose = get_pose(queue, k);
    const vf square = v2_dot(direction, direction), half = v_set(0.5f);
    const vm is_short = v_lt(square, v_set(0x1p-100f)); /* bodies in one place: any direction will do */
    const vec2 m = v2_select(is_short, (vec2){v_set(1), v_set(0)}, v2_divide(direction, v_sqrt(square)));
    struct support s = {.m = m};
    const struct arc_pair arcs = find_support_arcs(shapes->records, queue, k, live, m, &pose, &s.record_a, &s.record_b);
    const vec2 u = find_center_difference(&arcs);
    const vf radii = v_add(arcs.a.radius, arcs.b.radius), lean = v_sub(arcs.a.radius, arcs.b.radius);
    const vf size_a = v_add(sum_of_sizes(arcs.a.center), arcs.a.radius);
    const vf size_b = v_add(sum_of_sizes(arcs.b.center), arcs.b.radius);
    s.w = v2_sub(u, v2_scale(m, radii));
    s.gap = v_sub(v2_dot(u, m), radii);
    s.middle = v2_scale(v2_add(v2_add(arcs.a.center, arcs.b.center), v2_scale(m, lean)), half);
    s.noise = v_mul(v_set(SUPPORT_NOISE), v_add(v_add(size_a, size_b), sum_of_sizes(pose.position)));
    return s;
}

#endif
