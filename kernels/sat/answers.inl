/* SPDX-License-Identifier: MIT
 *
 * answers.inl - the last step of pairs with rows: of two circles off their origins, which is their only one, of those that the search has
 * settled, and of polygons.
 */
#ifndef NARC_SAT_ANSWERS_INL
#define NARC_SAT_ANSWERS_INL

#include <stdbool.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "piece/pieces.inl"
#include "polygon/polygon_contact.inl"
#include "polygon/polygon_rows.inl"
#include "sat/manifold_edges.inl"
#include "sat/search.inl"
#include "simd/simd.h"

/* Answers pairs of two circles in the lanes `open`; returns those that are left. `in_order`: are the pairs before, and
 * those in the other lanes, done? */
INLINE vm answer_discs(const struct call *call, vm open, vf margin, const vf item[FIELDS], bool in_order) {
    const struct probe p = probe_discs(call->batch->shapes->records, item, open, margin);
    const vm left = vm_and_not(open, vm_or(p.far, p.only));
    const vec2 to_world = {item[ROTATION_A], item[ROTATION_A + 1]}, n = v2_divide(p.u, p.length);
    const struct feature on_a = find_feature(&p.arcs.a, &p.arcs.a, n, vi_set(0), false);
    const struct feature on_b = find_feature(&p.arcs.b, &p.arcs.b, n, vi_set(0), true);
    const vi pairs = get_item_bits(item, PAIR), all_round = vi_set(-1); /* NARC_REACH_ONE twice */
    const struct answer answer = {.separation = p.separation,
                                  .normal = v2_rotate(to_world, n),
                                  .point = v2_rotate(to_world, v2_rotate(n, find_contact_place(&on_a, &on_b))),
                                  .feature = vi_set(0),
                                  .radius_a = p.arcs.a.radius,
                                  .radius_b = p.arcs.b.radius,
                                  .reach_a = all_round,
                                  .reach_b = all_round};
    const vm found = vm_and(vm_and_not(p.only, p.far), is_below(p.separation, margin));
    if (in_order && !vm_any(left)) {
        append_answers(call, pairs, found, &answer);
    } else {
        char *place[V_WIDTH];
        find_places(call, pairs, found, place);
        write_rows(call, place, find_numbers(call, pairs), &answer);
    }
    return left;
}

/* `edges`: do both bodies have edges, and are second points asked for? */
INLINE void answer_settled(const struct call *call, struct queue *queues, int begin, bool edges) {
    const struct queue *const queue = &queues[edges ? ANSWER_EDGES : ANSWER];
    const narc_record *const records = call->batch->shapes->records;
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const struct pose pose = get_pose(queue, k);
        const vi record_a = get_bits(queue, RECORD_A, k), record_b = get_bits(queue, RECORD_B, k);
        const vi pairs = get_bits(queue, PAIR, k);
        const vf separation = get(queue, SEPARATION, k);
        const vec2 n = get_vec2(queue, NORMAL, k);
        const struct feature on_a = find_feature_at(records, get_ring_a(queue, k), record_a, &pose, n, false);
        const struct feature on_b = find_feature_at(records, get_ring_b(queue, k), record_b, &pose, n, true);
        const struct answer answer = find_answer(queue, k, separation, n, &on_a, &on_b, has_reaches(call));
        const vm kept = keep_fronts(call, queue, k, vm_front(queue->count - k), separation, n,
                                    vi_and(answer.feature, vi_set(0xff)), vi_shift_right(answer.feature, 8));
        char *place[V_WIDTH];
        find_places(call, pairs, kept, place);
        if (edges) {
            struct sides sides;
            find_sides(call, queue, k, on_a.record, on_b.record, n, find_contact_place(&on_a, &on_b), &sides);
            write_sides(call, place, pairs, &answer, &sides);
        } else {
            write_rows(call, place, find_numbers(call, pairs), &answer);
        }
    }
}

/* The contacts of polygons, if they are certain; the gaps at their junctions are known. */
NOINLINE void answer_compared(const struct call *call, struct queue *queues, int begin, bool edges) {
    const struct queue *const queue = &queues[POLYGONS];
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct polygon_contact c = find_polygon_contact(call->batch->shapes->records, queue, k);
        const vf margin = get_margins(call, queue, k);
        const vm keep = vm_and(vm_and(live, c.certain), is_below(c.separation, margin));
        if (vm_any(keep))
            write_polygons(call, queue, k, keep, margin, &c, edges);
        pass_on(queue, k, vm_and_not(live, c.certain), ROW_FIELDS, &queues[DECIDE]);
    }
}

/* The stack of the comparison is not under that of what follows. */
INLINE void answer_polygons(const struct call *call, struct queue *queues, int begin, bool edges) {
    NARC_NAMED(search).stages[POLYGONS](call, queues, begin);
    answer_compared(call, queues, begin, edges);
}

#endif
