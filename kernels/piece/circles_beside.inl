/* SPDX-License-Identifier: MIT
 *
 * circles_beside.inl - circles beside the front of a run: where the foot of the centre lies is looked for among the
 * junctions, whose normals lie in the order of the arcs, by halving, then step by step.
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
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* What is known of all pairs: mostly ground comes last. */
enum run_side { ANY_RUN, RUN_IS_B };

/* One where the run is A, the other one where it is B. */
INLINE vf pick(enum run_side of, vm is_a, vf a, vf b) { return of == RUN_IS_B ? b : v_select(is_a, a, b); }

INLINE vi pick_bits(enum run_side of, vm is_a, vi a, vi b) { return of == RUN_IS_B ? b : vi_select(is_a, a, b); }

INLINE vec2 pick_vec2(enum run_side of, vm is_a, vec2 a, vec2 b) { return of == RUN_IS_B ? b : v2_select(is_a, a, b); }

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

/* Is p behind the start of an arc? */
INLINE vm is_behind_start(const struct run_beside *run, const vf field[8]) {
    return v_le(v_set(0), v2_cross((vec2){field[4], field[5]}, look_from_arc(run, field)));
}

/* The last arc of the front, up to the corner `last` behind it, whose start p lies behind, or the corner before it: its
 * number, and the fields of it and, but for the last one, of the next. By halving, and then step by step. */
INLINE vi find_arc_before(const narc_record *records, const struct run_beside *run, vi last, vf here[8], vf next[8]) {
    const vi one = vi_set(1);
    vi low = vi_set(0), high = vi_add(last, one);
    for (;;) {
        const vm open = vi_lt(vi_add(low, vi_set(3)), high);
        if (!vm_any(open))
            break;
        const vi middle = vi_shift_right(vi_add(low, high), 1);
        load_records(records, find_run_record(run, middle), here);
        const vm behind = is_behind_start(run, here);
        low = vi_select(vm_and(open, behind), middle, low);
        high = vi_select(vm_and_not(open, behind), middle, high);
    }
    load_records(records, find_run_record(run, low), here);
    for (;;) {
        load_records(records, find_run_record(run, vi_add(low, one)), next);
        const vm moves = vm_and(vi_lt(vi_add(low, one), high), is_behind_start(run, next));
        if (!vm_any(moves))
            return low;
        for (int f = 0; f < 8; f++)
            here[f] = v_select(moves, next[f], here[f]);
        low = vi_select(moves, vi_add(low, one), low);
        if (!vm_any(vm_and(moves, vi_lt(low, last))))
            return low;
    }
}

/* The arcs of a run, placed, and which of two features is whose. */
INLINE struct arcs place_run_arc(const vf field[8], const struct pose *pose, enum run_side of, vm is_a) {
    const struct arcs of_b = place_b(field, pose);
    if (of == RUN_IS_B)
        return of_b;
    const struct arcs of_a = place_a(field, pose);
    return select_arcs(is_a, &of_a, &of_b);
}

INLINE struct feature pick_feature(enum run_side of, vm m, const struct feature *a, const struct feature *b) {
    if (of == RUN_IS_B)
        return *b;
    return (struct feature){v_select(m, a->across, b->across),       v_select(m, a->along_min, b->along_min),
                            v_select(m, a->along_max, b->along_max), vi_select(m, a->record, b->record),
                            v_select(m, a->radius, b->radius),       v_select(m, a->magnitude, b->magnitude),
                            v2_select(m, a->start, b->start),        v2_select(m, a->end, b->end)};
}

/* The point of an arc with the normal n: `sign` 1 of A, -1 of B. */
INLINE vec2 find_point_of(const struct arcs *arc, vec2 n, vf sign) {
    return v2_add(arc->center, v2_scale(n, v_mul(sign, arc->radius)));
}

/* How a circle touches a run: with the arc `touched`, in `record`, or with the edge between that and the arc before. */
struct run_touch {
    vm is_a, at_edge; /* is the run A? */
    vi record, circle_record;
    struct arcs touched, before, circle;
    const vf *circle_field; /* four, of its record */
    vf separation;
    vec2 n;
};

/* Answers pairs in the lanes `near`; returns those that are not so simple: which are deep, or touch an arc that turns by next
 * to nothing. */
INLINE vm answer_circles_beside(const struct call *call, const struct run_touch *touch, const struct ring *run,
                                enum run_side of, vm near, const vf item[FIELDS]) {
    const vm is_a = touch->is_a;
    const vec2 n = touch->n;
    const struct touching_pair pair = {get_item_bits(item, FIRST_RECORD_A),
                                       get_item_bits(item, FIRST_RECORD_B),
                                       get_item_bits(item, INFO_A),
                                       get_item_bits(item, INFO_B),
                                       item[SCALE_A],
                                       item[SCALE_B],
                                       {item[ROTATION_A], item[ROTATION_A + 1]},
                                       .round_a = of == RUN_IS_B};
    const vf scale = pick(of, is_a, pair.scale_a, pair.scale_b),
             scale_circle = pick(of, is_a, pair.scale_b, pair.scale_a);
    const vm shallow = vm_and_not(is_circle_shallow(call->batch->shapes->records, touch->circle_field, scale_circle,
                                                    vi_add(run->base, run->count), scale, touch->separation),
                                  vm_front(call->batch->query->front_only ? V_WIDTH : 0));
    const vm simple = vm_and_not(vm_or(shallow, v_le(v_set(0), touch->separation)), is_parallel(touch->touched.end, n));
    const vm keep = vm_and(near, simple);
    if (!vm_any(keep))
        return near;
    const vf sign = pick(of, is_a, v_set(1), v_set(-1));
    const vec2 point = find_point_of(&touch->touched, n, sign), other = find_point_of(&touch->before, n, sign),
               on_circle = find_point_of(&touch->circle, n, v_neg(sign));
    const vf along = v2_cross(n, point), along_before = v_select(touch->at_edge, v2_cross(n, other), along);
    const vf size = find_magnitude(&touch->touched), along_circle = v2_cross(n, on_circle);
    const struct feature of_run = {
        v2_dot(n, point),           v_min(along, along_before),
        v_max(along, along_before), touch->record,
        touch->touched.radius,      v_add(size, v_select(touch->at_edge, find_magnitude(&touch->before), size)),
        touch->touched.start,       touch->touched.end};
    const struct feature of_circle = {
        v2_dot(n, on_circle), along_circle, along_circle, touch->circle_record, touch->circle.radius, v_set(0), n, n};
    const struct feature on_a = pick_feature(of, is_a, &of_run, &of_circle),
                         on_b = pick_feature(of, is_a, &of_circle, &of_run);
    const struct answer answer = tell_touch(&pair, touch->separation, n, &on_a, &on_b, has_reaches(call));
    const vi feature = pick_bits(of, is_a, vi_and(answer.feature, vi_set(0xff)), vi_shift_right(answer.feature, 8));
    char *place[V_WIDTH];
    const vi pairs = get_item_bits(item, PAIR);
    find_places(call, pairs, vm_and(keep, is_front(pick_bits(of, is_a, pair.info_a, pair.info_b), feature)), place);
    write_rows(call, place, find_numbers(call, pairs), &answer);
    return vm_and_not(near, keep);
}

/* Settles the pairs of a circle and a run in the lanes `which`: those that touch are answered, or go to the last stage. Returns
 * those that are not settled. */
INLINE vm settle_circles_of(const struct call *call, struct queue *queues, enum run_side of, vm is_a, vm which,
                            vf margin, const vf item[FIELDS]) {
    const narc_record *const records = call->batch->shapes->records;
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B), one = vi_set(1);
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    const struct ring ring_a = make_ring(get_item_bits(item, FIRST_RECORD_A), info_a),
                      ring_b = make_ring(get_item_bits(item, FIRST_RECORD_B), info_b);
    /* Other lanes have the first records of all, of which there are as many as a run has. */
    struct run_beside run = {.ring = {vi_select(which, pick_bits(of, is_a, ring_a.base, ring_b.base), vi_set(0)),
                                      vi_select(which, pick_bits(of, is_a, ring_a.count, ring_b.count), vi_set(6))},
                             .first = vi_select(which, get_first_arc(pick_bits(of, is_a, info_a, info_b)), vi_set(0)),
                             .scale = pick(of, is_a, pose.scale_a, pose.scale_b)};
    const vi last = vi_sub(run.ring.count, vi_set(5)), circle_record = pick_bits(of, is_a, ring_b.base, ring_a.base);
    int32_t index[V_WIDTH];
    vf circle[4], here[8], next[8];
    vi_store(index, circle_record);
    v_rows(records, sizeof *records, index, circle);
    const vec2 center = {circle[0], circle[1]}, center_a = v2_scale(center, pose.scale_a),
               center_b = place_center_b(center, &pose);
    run.p = pick_vec2(of, is_a, center_b, v2_unrotate(pose.rotation, v2_sub(center_a, pose.position)));

    const vi number = find_arc_before(records, &run, last, here, next), record = find_run_record(&run, number),
             next_record = find_run_record(&run, vi_add(number, one));
    const vf slack = item[SLACK], two = v_add(slack, slack);
    const vec2 u = look_from_arc(&run, here), start = {here[4], here[5]}, end = {here[6], here[7]};
    const vf radius = v_mul(here[2], run.scale),
             radius_circle = v_mul(circle[2], pick(of, is_a, pose.scale_b, pose.scale_a));
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
    if (!vm_any(near))
        return vm_and_not(which, known);
    /* As the formula has it, with the arc that holds the foot, or lies behind its edge. */
    vf touched[8];
    for (int f = 0; f < 8; f++)
        touched[f] = v_select(at_edge, next[f], here[f]);
    struct run_touch touch = {.is_a = is_a,
                              .at_edge = at_edge,
                              .record = vi_select(at_edge, next_record, record),
                              .circle_record = circle_record,
                              .circle_field = circle,
                              .touched = place_run_arc(touched, &pose, of, is_a),
                              .before = place_run_arc(here, &pose, of, is_a),
                              .circle = {.center = pick_vec2(of, is_a, center_b, center_a), .radius = radius_circle}};
    const vec2 way = v2_sub(pick_vec2(of, is_a, touch.circle.center, touch.touched.center),
                            pick_vec2(of, is_a, touch.touched.center, touch.circle.center));
    const vf length = v2_length(way), radii = v_add(touch.touched.radius, radius_circle);
    touch.separation = v_sub(v_select(at_edge, v2_dot(way, touch.touched.start), length), radii);
    touch.n = v2_select(at_edge, touch.touched.start, v2_divide(way, length));
    const vm found = vm_and(near, is_below(touch.separation, margin));
    const vm left = answer_circles_beside(call, &touch, &run.ring, of, found, item);
    if (vm_any(left)) {
        vf own[FIELDS];
        memcpy(own, item, sizeof own);
        own[SEPARATION] = touch.separation;
        set_vec2(own, NORMAL, touch.n);
        own[RECORD_A] = v_of_bits(pick_bits(of, is_a, touch.record, circle_record));
        own[RECORD_B] = v_of_bits(pick_bits(of, is_a, circle_record, touch.record));
        push(&queues[ANSWER], left, own, ROW_FIELDS);
    }
    return vm_and_not(which, known);
}

NOINLINE vm settle_circles_beside_a(const struct call *call, struct queue *queues, vm is_a, vm which, vf margin,
                                    const vf item[FIELDS]) {
    return settle_circles_of(call, queues, ANY_RUN, is_a, which, margin, item);
}

NOINLINE vm settle_circles_before_b(const struct call *call, struct queue *queues, vm which, vf margin,
                                    const vf item[FIELDS]) {
    return settle_circles_of(call, queues, RUN_IS_B, vm_front(0), which, margin, item);
}

/* Settles pairs of a circle and a run of those in the lanes `open`; returns the others. */
INLINE vm settle_circles_beside(const struct call *call, struct queue *queues, vm open, vf margin,
                                const vf item[FIELDS]) {
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN), is_b = has_mark(info_b, NARC_PIECE_RUN);
    const vm round = has_flag(vi_select(is_a, info_b, info_a), NARC_SHAPE_CIRCLE);
    const vm which = vm_and(open, vm_and(vm_xor(is_a, is_b), round));
    if (!vm_any(which))
        return open;
    const vm left = vm_any(vm_and(which, is_a)) ? settle_circles_beside_a(call, queues, is_a, which, margin, item)
                                                : settle_circles_before_b(call, queues, which, margin, item);
    return vm_or(vm_and_not(open, which), left);
}

#endif
