/* SPDX-License-Identifier: MIT
 *
 * hill_climb.inl - the local maximum of the gap near a direction.
 */
#ifndef NARC_SAT_HILL_CLIMB_INL
#define NARC_SAT_HILL_CLIMB_INL

#include "base/arcs.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "sat/certificates.inl"
#include "simd/simd.h"

/* Most climbs end at the first step, and nearly all within four. */
enum { CLIMB_STEPS = 8 };

/* Where u lies in an interval of directions: the common part of the sectors of two arcs, from lo to hi. */
struct interval {
    vm lo_is_a, hi_is_a; /* whose junction it is */
    vm inside, up, down; /* does u lie in it, or does g rise beyond hi, beyond lo? */
};

INLINE struct interval find_interval(const struct arc_pair *arcs, vec2 u) {
    const vf zero = v_set(0);
    const vf start_a = v2_cross(arcs->a.start, u), start_b = v2_cross(arcs->b.start, u);
    const vf end_a = v2_cross(u, arcs->a.end), end_b = v2_cross(u, arcs->b.end);
    const vf least = v_min(v_min(start_a, end_a), v_min(start_b, end_b));
    struct interval i;
    i.lo_is_a = v_le(zero, v2_cross(arcs->b.start, arcs->a.start));
    i.hi_is_a = v_le(zero, v2_cross(arcs->a.end, arcs->b.end));
    i.inside = vm_and(v_le(zero, least), v_le(v_set(LEAST_SQUARE), v2_dot(u, u)));
    i.down = v_lt(v_select(i.lo_is_a, start_a, start_b), zero);
    i.up = v_lt(v_select(i.hi_is_a, end_a, end_b), zero);
    return i;
}

/* What a climb knows of the step before: its arcs, which way it left them, and whether A's moved. */
struct last_step {
    struct arc_pair arcs;
    vi record_a, record_b;
    vm up, down, moved_a;
};

/* Enters what a step has found in the lanes `open`; at_lo and at_hi: the junction there is the maximum. */
INLINE void keep_maximum(struct local_maximum *maximum, const struct arc_pair *arcs, vi record_a, vi record_b,
                         const struct last_step *last, const struct interval *i, vec2 u, vm at_lo, vm at_hi, vm open) {
    const struct arc_pair after = select_arc_pair(at_hi, &last->arcs, arcs);
    const struct arc_pair before = select_arc_pair(at_lo, &last->arcs, arcs);
    const vec2 lo = v2_select(i->lo_is_a, arcs->a.start, arcs->b.start);
    const vec2 hi = v2_select(i->hi_is_a, arcs->a.end, arcs->b.end);
    maximum->after = select_arc_pair(open, &after, &maximum->after);
    maximum->before = select_arc_pair(open, &before, &maximum->before);
    maximum->record_a = vi_select(open, vi_select(at_hi, last->record_a, record_a), maximum->record_a);
    maximum->record_b = vi_select(open, vi_select(at_hi, last->record_b, record_b), maximum->record_b);
    maximum->direction = v2_select(open, v2_select(at_lo, lo, v2_select(at_hi, hi, u)), maximum->direction);
    maximum->kink = vm_or(maximum->kink, vm_and(open, vm_or(at_lo, at_hi)));
}

/* Climbs from the arcs in record_a and record_b to a local maximum. Each step looks at the interval of two arcs, with
 * u from the centre of A's arc to that of B's (normal_fan.inl). If u lies in it, that is the maximum. Else the gap
 * rises beyond hi, or beyond lo, and the search crosses that junction; if it would go back over the junction that it
 * has just crossed, that junction is the maximum. Where the sectors have no common part (a hint that is stale) steps
 * lead anywhere: whoever uses the result checks that the arcs hold its direction. */
INLINE struct local_maximum climb(const narc_record *records, const struct queue *queue, int k, vm live) {
    const struct pose pose = get_pose(queue, k);
    const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
    const vm none = vm_front(0);
    vi record_a = vi_load(queue->record_a + k), record_b = vi_load(queue->record_b + k);
    vm open = live;
    struct last_step last = {.up = none, .down = none, .moved_a = none};
    struct local_maximum maximum;
    for (int step = 0;; step++) {
        const struct arc_pair arcs = load_arc_pair(records, record_a, record_b, &pose);
        const vec2 u = center_difference(&arcs);
        const struct interval i = find_interval(&arcs, u);
        /* Back over the junction that the last step crossed: the one at this end, and of the shape that moved. */
        const vm at_lo = vm_and_not(vm_and_not(vm_and(last.up, i.down), vm_xor(i.lo_is_a, last.moved_a)), i.inside);
        const vm at_hi = vm_and_not(vm_and_not(vm_and(last.down, i.up), vm_xor(i.hi_is_a, last.moved_a)), i.inside);
        if (step == 0)
            maximum = (struct local_maximum){none, none, u, arcs, arcs, record_a, record_b};
        else
            keep_maximum(&maximum, &arcs, record_a, record_b, &last, &i, u, at_lo, at_hi, open);
        const vm here = vm_and(open, vm_or(i.inside, vm_or(at_lo, at_hi)));
        maximum.found = vm_or(maximum.found, here);
        open = vm_and_not(open, here);
        if (step + 1 == CLIMB_STEPS || !vm_any(open))
            return maximum;
        const vm down = vm_and_not(i.down, i.up);
        last = (struct last_step){arcs, record_a, record_b,
                                  i.up, down,     vm_or(vm_and(i.up, i.hi_is_a), vm_and(down, i.lo_is_a))};
        const vi zero = vi_set(0), by = vi_select(i.up, vi_set(1), vi_select(down, vi_set(-1), zero));
        record_a = step_record(ring_a, record_a, vi_select(last.moved_a, by, zero));
        record_b = step_record(ring_b, record_b, vi_select(last.moved_a, zero, by));
    }
}

/* A local maximum and what it proves: that the separation is above the margin, or that it is this. */
struct certified_maximum {
    struct local_maximum maximum;
    vf separation;
    vec2 normal;
    vm apart, certain;
};

/* Climbs from the arcs in record_a and record_b of the pairs k ... of a queue. */
INLINE struct certified_maximum climb_and_certify(const narc_record *records, const struct queue *queue, int k, vm live,
                                                  vf margin) {
    const struct local_maximum m = climb(records, queue, k, live);
    const vec2 u = center_difference(&m.after);
    const vf radii = v_add(m.after.a.radius, m.after.b.radius), length = v2_length(u);
    const vf value = v_select(m.kink, v2_dot(u, m.direction), length);
    struct certified_maximum top = {.maximum = m, .separation = v_sub(value, radii)};
    top.normal = v2_divide(m.direction, v_select(m.kink, v_set(1), length));
    const struct sines sines = find_sines(queue, k, &m, top.normal);
    const vm found = vm_and(vm_and(live, m.found), v_le(v_set(0), sines.least));
    top.apart = vm_and(found, v_lt(v_add(margin, get(queue, SLACK, k)), top.separation));
    top.certain =
        vm_and(vm_and_not(found, top.apart), is_global_maximum(queue, k, &m, &sines, top.normal, top.separation));
    return top;
}

#endif
