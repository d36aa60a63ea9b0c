/* SPDX-License-Identifier: MIT
 *
 * search.inl - how the highest local maximum of the gap is found: the arcs that hold a direction, a probe of these arcs,
 * a climb from arc to arc, and a walk past two junctions. What they prove: certificates.inl.
 */
#ifndef NARC_SAT_SEARCH_INL
#define NARC_SAT_SEARCH_INL

#include <stdbool.h>
#include <stdint.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "piece/pieces.inl"
#include "sat/arc_lookup.inl"
#include "sat/certificates.inl"
#include "sat/normal_fan.inl"
#include "simd/simd.h"

/* ------------------------------------------------------------------------------------------------ probing
 *
 * What one arc of A and one of B tell of the gap. If u, from the centre of the one to that of the other, lies between
 * their junctions, it is the direction of a local maximum of the gap, and mostly of the highest. */

struct probe {
    struct arc_pair arcs;
    vec2 u;
    vf length, radii, separation; /* of u, of both arcs, along u */
    vm far;                       /* the separation is above the margin, for certain */
    vm only;                      /* it is the one that the deciding formula would give */
};

/* The sine of the angle from u to the nearest junction of its arcs, times the length of u. A circle's junctions mean
 * nothing. */
INLINE vf find_least_sine(const struct arc_pair *arcs, vec2 u, vf length, vi info_a, vi info_b) {
    const vf from_a = v_min(v2_cross(arcs->a.start, u), v2_cross(u, arcs->a.end));
    const vf from_b = v_min(v2_cross(arcs->b.start, u), v2_cross(u, arcs->b.end));
    return v_min(v_select(has_flag(info_a, NARC_SHAPE_CIRCLE), length, from_a),
                 v_select(has_flag(info_b, NARC_SHAPE_CIRCLE), length, from_b));
}

INLINE struct probe measure_gap(const struct arc_pair *arcs) {
    struct probe p = {.arcs = *arcs, .u = find_center_difference(arcs)};
    p.length = v2_length(p.u);
    p.radii = v_add(arcs->a.radius, arcs->b.radius);
    p.separation = v_sub(p.length, p.radii);
    return p;
}

/* `least` as find_least_sine() gives it. */
INLINE void certify_gap(struct probe *p, vf least, vf slack, vm live, vf margin) {
    const vf inner = v_add(p->arcs.a.inner, p->arcs.b.inner);
    const vm inside = vm_and(live, v_lt(v_set(0), least)); /* u is long enough for the formula if is_only_maximum() */
    p->far = vm_and(inside, v_lt(v_add(margin, slack), p->separation));
    p->only = vm_and(inside, is_only_maximum(inner, p->separation, least, p->length, slack));
}

/* Probes the arcs in record_a and record_b of the pairs k ... of a queue, in the lanes `live`. */
INLINE struct probe probe_arcs(const narc_record *records, const struct queue *queue, int k, vm live, vf margin) {
    const struct pose pose = get_pose(queue, k);
    const struct arc_pair arcs =
        load_arc_pair(records, vi_load(queue->record_a + k), vi_load(queue->record_b + k), &pose);
    struct probe p = measure_gap(&arcs);
    const vf least = find_least_sine(&arcs, p.u, p.length, get_bits(queue, INFO_A, k), get_bits(queue, INFO_B, k));
    certify_gap(&p, least, get(queue, SLACK, k), live, margin);
    return p;
}

/* Of two circles there is nothing to search: the gap is largest from centre to centre. Those that have no form, off their
 * origins, are answered as they are set up, without a queue. */

/* Are there pairs in the lanes `open`, all of two circles? */
INLINE bool are_discs(vm open, const vf item[FIELDS]) {
    return vm_any(open) && !vm_any(vm_and_not(open, both_have(item, NARC_SHAPE_CIRCLE)));
}

/* A circle in each lane: half of it, without its ends, which mean nothing. */
INLINE struct arcs load_disc(const narc_record *records, vi first_record, vi info, const struct pose *pose, bool is_b) {
    const vf none = v_set(0);
    vf field[8] = {none, none, none, none, none, none, none, none};
    load_circle(records, find_first_arc(first_record, info), field);
    return is_b ? place_b(field, pose) : place_a(field, pose);
}

/* What two circles tell of the gap, in the lanes `live`. */
INLINE struct probe probe_discs(const narc_record *records, const vf item[FIELDS], vm live, vf margin) {
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    const struct arc_pair arcs = {
        load_disc(records, get_item_bits(item, FIRST_RECORD_A), get_item_bits(item, INFO_A), &pose, false),
        load_disc(records, get_item_bits(item, FIRST_RECORD_B), get_item_bits(item, INFO_B), &pose, true)};
    struct probe p = measure_gap(&arcs);
    certify_gap(&p, p.length, item[SLACK], live, margin);
    return p;
}

/* ------------------------------------------------------------------------------------------------ climbing */

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
    const vm to_lo = vm_and(last->up, i->down), to_hi = vm_and(last->down, i->up);
    const struct arc_pair after = select_arc_pair(at_hi, &last->arcs, arcs);
    const struct arc_pair before = select_arc_pair(at_lo, &last->arcs, arcs);
    const vec2 lo = v2_select(i->lo_is_a, arcs->a.start, arcs->b.start);
    const vec2 hi = v2_select(i->hi_is_a, arcs->a.end, arcs->b.end);
    maximum->after = select_arc_pair(open, &after, &maximum->after);
    maximum->before = select_arc_pair(open, &before, &maximum->before);
    maximum->record_a = vi_select(open, vi_select(at_hi, last->record_a, record_a), maximum->record_a);
    maximum->record_b = vi_select(open, vi_select(at_hi, last->record_b, record_b), maximum->record_b);
    maximum->direction = v2_select(open, v2_select(to_lo, lo, v2_select(to_hi, hi, u)), maximum->direction);
    maximum->kink = vm_or(maximum->kink, vm_and(open, vm_or(at_lo, at_hi)));
}

/* Climbs from the arcs in record_a and record_b to a local maximum. Each step looks at the interval of two arcs, with
 * u from the centre of A's arc to that of B's (normal_fan.inl). If u lies in it, that is the maximum. Else the gap
 * rises beyond hi, or beyond lo, and the search crosses that junction; if it would go back over the junction that it
 * has just crossed, that junction is the maximum. Where it would go back over the other shape's, both junctions lie side
 * by side: the search ends there, `turned`. Where the sectors have no common part (arcs are looked up to some
 * digits) steps lead anywhere: whoever uses the result checks that the arcs hold its direction. */
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
        const vec2 u = find_center_difference(&arcs);
        const struct interval i = find_interval(&arcs, u);
        /* Back over the junction that the last step crossed: the one at this end, and of the shape that moved. */
        const vm at_lo = vm_and_not(vm_and_not(vm_and(last.up, i.down), vm_xor(i.lo_is_a, last.moved_a)), i.inside);
        const vm at_hi = vm_and_not(vm_and_not(vm_and(last.down, i.up), vm_xor(i.hi_is_a, last.moved_a)), i.inside);
        if (step == 0)
            maximum = (struct local_maximum){none, none, none, u, arcs, arcs, record_a, record_b};
        else
            keep_maximum(&maximum, &arcs, record_a, record_b, &last, &i, u, at_lo, at_hi, open);
        const vm here = vm_and(open, vm_or(i.inside, vm_or(at_lo, at_hi)));
        const vm back = vm_or(vm_and(last.up, i.down), vm_and(last.down, i.up)); /* perhaps over the other's junction */
        maximum.found = vm_or(maximum.found, here);
        maximum.turned = vm_or(maximum.turned, vm_and_not(vm_and(open, back), here));
        open = vm_and_not(open, vm_or(here, back));
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
    const vec2 u = find_center_difference(&m.after);
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

/* ------------------------------------------------------------------------------------------------ walking
 *
 * Where bodies rest face on face, a junction of A and one of B lie side by side, too close for a local maximum at one of
 * them to have a certificate. So the fan is walked there, as the deciding formula walks it, past two junctions, F and
 * G. Certificate 4 on both sides, before F with n = F and behind G with n = G, says that the gap rises before F, falls
 * behind G, and is less elsewhere: the candidates are a kink at F or what lies between F and G, and a kink at G, to the
 * last bit the formula's. Of two equal values it takes the one that it meets first, from +x on. F and G are less than a
 * right angle apart: docs/algorithm.md, section 9. */

/* The walk begins that much (radians) before the direction of the local maximum. */
#define WALK_BACK 0x1p-6f

/* Is a direction of length 1 within the sectors of both arcs, not close to an end? */
INLINE vm is_well_inside(const struct arc_pair *arcs, vec2 n) {
    const vm no_circle = vm_front(0);
    const vf ends = v_min(find_sine(n, arcs->a.end, no_circle), find_sine(n, arcs->b.end, no_circle));
    const vf starts = v_min(find_sine(mirror(n), mirror(arcs->a.start), no_circle),
                            find_sine(mirror(n), mirror(arcs->b.start), no_circle));
    return v_le(v_set(LEAST_ANGLE), v_min(ends, starts));
}

/* The fan at a direction: what comes before it belongs to the next round. */
INLINE struct fan start_fan_at(const narc_record *records, const struct queue *queue, int k, const struct pose *pose,
                               vec2 direction) {
    struct fan fan = {.ring_a = get_ring_a(queue, k), .ring_b = get_ring_b(queue, k)};
    const vi here = vi_bits(find_diamond_angle(direction)), this_round = vi_set(THIS_ROUND), zero = vi_set(0);
    find_arcs(records, queue, k, direction, &fan.record_a, &fan.record_b);
    fan.arcs = load_arc_pair(records, fan.record_a, fan.record_b, pose);
    const vi angle_a = vi_bits(find_diamond_angle(fan.arcs.a.end)),
             angle_b = vi_bits(find_diamond_angle(fan.arcs.b.end));
    fan.angle_a = vi_add(angle_a, vi_select(vi_lt(angle_a, here), zero, this_round));
    fan.angle_b = vi_add(angle_b, vi_select(vi_lt(angle_b, here), zero, this_round));
    fan.a_is_next = vi_lt(fan.angle_a, fan.angle_b);
    return fan;
}

/* The gap near DIRECTION of the pairs k ... of a queue; *out_certain: it is the formula's answer. */
INLINE struct gap walk_near(const narc_record *records, const struct queue *queue, int k, vm live, vm *out_certain) {
    const struct pose pose = get_pose(queue, k);
    const vec2 d = get_vec2(queue, DIRECTION, k), n = v2_divide(d, v2_length(d));
    const vf slack = get(queue, SLACK, k);
    const vm none = vm_front(0), all = vm_front(V_WIDTH);
    const vec2 begin = v2_add(n, v2_scale(v2_right(n), v_set(WALK_BACK)));
    struct fan fan = start_fan_at(records, queue, k, &pose, begin);
    const struct arc_pair arcs_before = fan.arcs;
    const vec2 f = get_fan_end(&fan);
    const vm inside = vm_and(live, is_well_inside(&fan.arcs, begin));
    pass_junction(&fan, records, &pose);
    const vec2 g = get_fan_end(&fan);
    const struct candidate found = find_candidate(&fan.arcs, f, g, all);
    const struct gap from_f = {found.value, v2_select(found.inside, found.u, f),
                               v_select(found.inside, found.length, v_set(1)), fan.record_a, fan.record_b};
    pass_junction(&fan, records, &pose);

    const vec2 u_before = find_center_difference(&arcs_before), u_after = find_center_difference(&fan.arcs);
    const vf value_f = v_sub(v2_dot(u_before, f), v_add(arcs_before.a.radius, arcs_before.b.radius));
    const vf value_g = v_sub(v2_dot(u_after, g), v_add(fan.arcs.a.radius, fan.arcs.b.radius));
    const struct gap at_g = {value_g, g, v_set(1), fan.record_a, fan.record_b};
    const vm wraps = vi_lt(vi_bits(find_diamond_angle(g)), vi_bits(find_diamond_angle(f)));
    const vm better = vm_or(v_lt(found.value, value_g), vm_and(wraps, v_le(found.value, value_g)));
    const struct gap gap = select_gap(vm_and(found.rises, vm_or(better, vm_not(found.exists))), &at_g, &from_f);

    const struct fan_ends ends_f = find_fan_ends(queue, k, f, gap.separation);
    const struct fan_ends ends_g = find_fan_ends(queue, k, g, gap.separation);
    const vm after = is_side_clear(&fan.arcs, find_sine(g, fan.arcs.a.end, none), find_sine(g, fan.arcs.b.end, none),
                                   v2_cross(u_after, g), all, ends_g.after, v_neg(value_g), slack);
    const vm before = is_side_clear(&arcs_before, find_sine(mirror(f), mirror(arcs_before.a.start), none),
                                    find_sine(mirror(f), mirror(arcs_before.b.start), none), v2_cross(f, u_before), all,
                                    ends_f.before, v_neg(value_f), slack);
    const vm narrow = vm_and(vm_and(ends_f.narrow, ends_g.narrow), v_lt(v_set(0), v2_dot(f, g)));
    *out_certain = vm_and(inside, vm_and(narrow, vm_and(after, before)));
    return gap;
}

#endif
