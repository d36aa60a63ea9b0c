/* SPDX-License-Identifier: MIT
 *
 * probe.inl - what one arc of A and one of B tell of the gap. If u, from the centre of the one to that of the other,
 * lies between their junctions, it is the direction of a local maximum of the gap, and mostly of the highest.
 */
#ifndef NARC_SAT_PROBE_INL
#define NARC_SAT_PROBE_INL

#include <stdbool.h>

#include "base/arcs.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "sat/certificates.inl"
#include "simd/simd.h"

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
    return v_min(v_select(info_has(info_a, NARC_SHAPE_CIRCLE), length, from_a),
                 v_select(info_has(info_b, NARC_SHAPE_CIRCLE), length, from_b));
}

INLINE struct probe measure_gap(const struct arc_pair *arcs) {
    struct probe p = {.arcs = *arcs, .u = center_difference(arcs)};
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

/* ------------------------------------------------------------------------------------------------ circles
 *
 * There is nothing to search: the gap is largest from centre to centre. Pairs of circles are answered as they are set
 * up, without a queue. */

/* Are there pairs in the lanes `open`, all of two circles? */
INLINE bool are_discs(vm open, const vf item[FIELDS]) {
    return vm_any(open) && !vm_any(vm_and_not(open, both_have(item, NARC_SHAPE_CIRCLE)));
}

/* A circle in each lane: half of it, without its ends, which mean nothing. */
INLINE struct arcs load_disc(const narc_record *records, vi first_record, vi info, const struct pose *pose, bool is_b) {
    const vf none = v_set(0);
    vf field[8] = {none, none, none, none, none, none, none, none};
    int32_t index[V_WIDTH];
    vi_store(index, first_arc_record(first_record, info));
    v_rows(records, sizeof *records, index, field);
    return is_b ? place_b(field, pose) : place_a(field, pose);
}

/* What two circles tell of the gap, in the lanes `live`. */
INLINE struct probe probe_discs(const narc_record *records, const vf item[FIELDS], vm live, vf margin) {
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    const struct arc_pair arcs = {
        load_disc(records, item_bits(item, FIRST_RECORD_A), item_bits(item, INFO_A), &pose, false),
        load_disc(records, item_bits(item, FIRST_RECORD_B), item_bits(item, INFO_B), &pose, true)};
    struct probe p = measure_gap(&arcs);
    certify_gap(&p, p.length, item[SLACK], live, margin);
    return p;
}

#endif
