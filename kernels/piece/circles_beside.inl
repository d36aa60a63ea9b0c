/* SPDX-License-Identifier: MIT
 *
 * circles_beside.inl - circles beside the front of a run: where the foot of the centre lies is looked for among the
 * junctions, whose normals lie in the order of the arcs, by halving.
 *
 * Let p be the centre of the circle. Without its radius the gap is the distance of p from the closed run, where p lies
 * outside of that. It rises towards the foot from all sides, by at least as much as p lies beside the nearest normal of a
 * junction, as these spread outwards; and where it is below 0 it is less. So where p lies outside by two slacks, and by as
 * much off the normals at both ends of the arc or the edge that holds the foot, every sign of the formula is right
 * (box/circles.inl). Where the foot lies by two slacks beyond an end of the front, no contact is told. Other pairs are left.
 */
#ifndef NARC_PIECE_CIRCLES_BESIDE_INL
#define NARC_PIECE_CIRCLES_BESIDE_INL

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* A run in each lane, and the centre of a circle in its frame, at world scale. */
struct run_beside {
    struct ring ring;
    vi first; /* of the caller's arcs, the one that is stored first */
    vf scale;
    vec2 p;
};

/* The record of the caller's arc of a number. */
INLINE vi find_run_record(const struct run_beside *run, vi number) {
    const vi stored = vi_sub(number, run->first);
    return vi_add(run->ring.base, vi_select(vi_lt(stored, vi_set(0)), vi_add(stored, run->ring.count), stored));
}

/* From the centre of an arc to p. */
INLINE vec2 look_from_arc(const struct run_beside *run, const vf field[8]) {
    return v2_sub(run->p, v2_scale((vec2){field[0], field[1]}, run->scale));
}

/* The last arc of the front, up to the corner `last` behind it, whose start p lies behind, or the corner before it. */
INLINE vi find_arc_before(const narc_record *records, const struct run_beside *run, vi last) {
    const vi one = vi_set(1);
    vi low = vi_set(0), high = vi_add(last, one);
    for (;;) {
        const vm open = vi_lt(vi_add(low, one), high);
        if (!vm_any(open))
            return low;
        vf field[8];
        const vi middle = vi_shift_right(vi_add(low, high), 1);
        load_records(records, find_run_record(run, middle), field);
        const vm behind = v_le(v_set(0), v2_cross((vec2){field[4], field[5]}, look_from_arc(run, field)));
        low = vi_select(vm_and(open, behind), middle, low);
        high = vi_select(vm_and_not(open, behind), middle, high);
    }
}

/* Settles pairs of a circle and a run of those in the lanes `open`: those that touch go to the last stage. Returns the
 * others. */
NOINLINE vm settle_circles_beside(const struct call *call, struct queue *queues, vm open, vf margin,
                                  const vf item[FIELDS]) {
    const narc_record *const records = call->batch->shapes->records;
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B), one = vi_set(1);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN), is_b = has_mark(info_b, NARC_PIECE_RUN);
    const vm round = has_flag(vi_select(is_a, info_b, info_a), NARC_SHAPE_CIRCLE);
    const vm which = vm_and(open, vm_and(vm_xor(is_a, is_b), round));
    if (!vm_any(which))
        return open;
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    const struct ring ring_a = make_ring(get_item_bits(item, FIRST_RECORD_A), info_a),
                      ring_b = make_ring(get_item_bits(item, FIRST_RECORD_B), info_b);
    struct run_beside run = {.ring = {vi_select(is_a, ring_a.base, ring_b.base),
                                      vi_select(which, vi_select(is_a, ring_a.count, ring_b.count), vi_set(6))},
                             .first = vi_select(which, get_first_arc(vi_select(is_a, info_a, info_b)), vi_set(0)),
                             .scale = v_select(is_a, pose.scale_a, pose.scale_b)};
    const vi last = vi_sub(run.ring.count, vi_set(5)), circle_record = vi_select(is_a, ring_b.base, ring_a.base);
    int32_t index[V_WIDTH];
    vf circle[4], here[8], next[8];
    vi_store(index, circle_record);
    v_rows(records, sizeof *records, index, circle);
    const vec2 center = {circle[0], circle[1]}, center_a = v2_scale(center, pose.scale_a),
               center_b = place_center_b(center, &pose);
    run.p = v2_select(is_a, center_b, v2_unrotate(pose.rotation, v2_sub(center_a, pose.position)));

    const vi number = find_arc_before(records, &run, last), record = find_run_record(&run, number),
             next_record = find_run_record(&run, vi_add(number, one));
    load_records(records, record, here);
    load_records(records, next_record, next);
    const vf slack = item[SLACK], two = v_add(slack, slack);
    const vec2 u = look_from_arc(&run, here), start = {here[4], here[5]}, end = {here[6], here[7]};
    const vf radius = v_mul(here[2], run.scale),
             radius_circle = v_mul(circle[2], v_select(is_a, pose.scale_b, pose.scale_a));
    const vf behind_start = v2_cross(start, u), before_end = v2_cross(u, end);
    const vm is_first = vi_lt(number, one), is_last = vm_not(vi_lt(number, last));
    const vm within = vm_and(v_lt(two, behind_start), v_lt(two, before_end));
    const vm at_arc = vm_and_not(within, vm_or(is_first, is_last));
    const vm at_edge =
        vm_and_not(vm_and(v_lt(before_end, v_neg(two)), v_lt(two, v2_cross(look_from_arc(&run, next), end))), is_last);
    const vf distance = v_sub(v_select(at_edge, v2_dot(u, end), v2_length(u)), radius);
    const vm beyond_begin = vm_and(is_first, v_lt(two, before_end)),
             beyond_end = vm_and(is_last, v_lt(two, behind_start));
    const vm beyond = vm_and(vm_or(beyond_begin, beyond_end), v_lt(two, v2_dot(u, v2_select(is_first, end, start))));
    const vm known = vm_and(which, vm_or(beyond, vm_and(vm_or(at_arc, at_edge), v_lt(two, distance))));
    const vm near = vm_and_not(vm_and_not(known, beyond), v_lt(v_add(v_add(radius_circle, margin), slack), distance));
    if (vm_any(near)) { /* as the formula has it, with the arc that holds the foot, or lies behind its edge */
        vf field[8], own[FIELDS];
        for (int f = 0; f < 8; f++)
            field[f] = v_select(at_edge, next[f], here[f]);
        const struct arcs of_a = place_a(field, &pose), of_b = place_b(field, &pose);
        const vec2 way = v2_sub(v2_select(is_a, center_b, of_b.center), v2_select(is_a, of_a.center, center_a));
        const vf radii = v_add(v_select(is_a, of_a.radius, radius_circle), v_select(is_a, radius_circle, of_b.radius));
        const vec2 edge = v2_select(is_a, of_a.start, of_b.start);
        const vf length = v2_length(way);
        const vi touched = vi_select(at_edge, next_record, record);
        memcpy(own, item, sizeof own);
        own[SEPARATION] = v_sub(v_select(at_edge, v2_dot(way, edge), length), radii);
        set_vec2(own, NORMAL, v2_select(at_edge, edge, v2_divide(way, length)));
        own[RECORD_A] = v_of_bits(vi_select(is_a, touched, circle_record));
        own[RECORD_B] = v_of_bits(vi_select(is_a, circle_record, touched));
        push(&queues[ANSWER], vm_and(near, is_below(own[SEPARATION], margin)), own, ROW_FIELDS);
    }
    return vm_and_not(open, known);
}

#endif
