/* SPDX-License-Identifier: MIT
 *
 * row_stages.inl - how the search ends for questions that have rows: what is certain goes to their last stage.
 */
#ifndef NARC_SAT_ROW_STAGES_INL
#define NARC_SAT_ROW_STAGES_INL

#include <stdbool.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "polygon/polygon_contact.inl"
#include "polygon/polygon_edges.inl"
#include "sat/certificates.inl"
#include "sat/normal_fan.inl"
#include "sat/search.inl"
#include "sat/stages.inl"
#include "simd/simd.h"

SHARED struct verdict judge(const struct call *call, struct queue *queue, int k, vm live) {
    const vf margin = get_margins(call, queue, k);
    const struct probe p = probe_arcs(call->batch->shapes->records, queue, k, live, margin);
    const vf limit = v_add(margin, find_lookup_slack(queue, k));
    const vm apart = vm_or(p.far, is_above(p.u, p.radii, get_vec2(queue, DIRECTION, k), limit));
    const vm certain = vm_and_not(p.only, apart);
    return (struct verdict){p.u, p.length, p.separation, vm_or(apart, certain),
                            vm_and(certain, is_below(p.separation, margin))};
}

SHARED void settle(const struct call *call, struct queue *queues, const struct queue *queue, int k, vm which,
                   vf separation, vec2 n, vi record_a, vi record_b) {
    vf item[FIELDS];
    get_item(queue, k, item, ROW_FIELDS);
    set_vec2(item, NORMAL, n);
    item[SEPARATION] = separation;
    item[RECORD_A] = v_of_bits(record_a);
    item[RECORD_B] = v_of_bits(record_b);
    if (call->kind == MANIFOLD_ROWS) { /* where both bodies have edges there may be a second point */
        const vm smooth = vm_or(has_flag(get_bits(queue, INFO_A, k), NARC_SHAPE_SMOOTH),
                                has_flag(get_bits(queue, INFO_B, k), NARC_SHAPE_SMOOTH));
        const vm edged = vm_and_not(which, smooth);
        which = vm_and(which, smooth);
        if (vm_any(edged))
            push(&queues[ANSWER_EDGES], edged, item, ROW_FIELDS);
    }
    push(&queues[ANSWER], which, item, ROW_FIELDS);
}

static const struct search rows = {
    .fields = ROW_FIELDS, .rows = true, .judge_axis = judge, .judge = judge, .settle = settle};

/* Polygons: the gap at all junctions. Those pairs for which one exceeds all others take the places of the queue's last
 * ones, from `begin` on: they are the question's. */
static void compare_edges(const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[POLYGONS];
    const int end = queue->count;
    queue->count = begin;
    for (int k = begin; k < end; k += V_WIDTH) {
        const vm live = vm_front(end - k);
        const vf slack = get(queue, SLACK, k);
        const vf limit = v_add(get_margins(call, queue, k), v_mul(v_set(LOOSE), slack));
        const struct polygon_edge found = find_polygon_edge(call->batch->shapes->records, queue, k);
        const struct best_edge *best = &found.best;
        const vm near = vm_and_not(live, v_lt(limit, best->gap));
        if (!vm_any(near))
            continue;
        const vm clear = v_lt(best->second, v_sub(best->gap, v_mul(v_set(CLEAR_EDGE), slack)));
        const vf code = v_of_bits(vi_add(best->edge, vi_shift_left(found.corner, 4)));
        vf item[FIELDS];
        if (CAPACITY == 1) { /* it stays in its place */
            store_vec2(queue, DIRECTION, k, best->normal);
            store_field(queue->item[EDGE_CODE] + k, code);
            queue->count = vm_any(clear) != 0;
            if (!vm_any(clear))
                pass_on(queue, k, live, FIELDS, &queues[DECIDE]);
            continue;
        }
        get_item(queue, k, item, ROW_FIELDS);
        set_vec2(item, DIRECTION, best->normal);
        item[EDGE_CODE] = code;
        if (vm_any(vm_and_not(near, clear)))
            push(&queues[DECIDE], vm_and_not(near, clear), item, ROW_FIELDS);
        if (vm_any(vm_and(near, clear)))
            push(queue, vm_and(near, clear), item, FIELDS);
    }
    pad(queue); /* what was behind them has no edges */
}

#endif
