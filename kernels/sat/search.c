/* SPDX-License-Identifier: MIT
 *
 * search.c - the search of all questions that have rows: with which arcs two bodies touch, and along which normal.
 *
 * Pairs pass through stages until one of them knows the answer that the deciding formula (normal_fan.inl) would give,
 * to the last bit: a probe along the axis, another along u, a climb to a local maximum, a walk past the two junctions
 * beside it, and the formula itself. The normal n and the arcs are those of the highest local maximum of the gap.
 * Polygons of few corners go from the first probe to a stage that has the gap at all junctions. What is certain goes to
 * the last stage, which is the question's.
 */
#include <stdbool.h>
#include <stddef.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/concave.inl"
#include "polygon/polygon_contact.inl"
#include "polygon/polygon_edges.inl"
#include "sat/arc_lookup.inl"
#include "sat/certificates.inl"
#include "sat/faces.inl"
#include "sat/normal_fan.inl"
#include "sat/search.inl"
#include "sat/stages.inl"
#include "simd/simd.h"

INLINE struct verdict judge(const struct call *call, struct queue *queue, int k, vm live) {
    const vf margin = get_margins(call, queue, k);
    const struct probe p = probe_arcs(call->batch->shapes->records, queue, k, live, margin);
    const vf limit = v_add(margin, find_lookup_slack(queue, k));
    const vm apart = vm_or(p.far, is_above(p.u, p.radii, get_vec2(queue, DIRECTION, k), limit));
    const vm certain = vm_and_not(p.only, apart);
    return (struct verdict){p.u, p.length, p.separation, vm_or(apart, certain),
                            vm_and(certain, is_below(p.separation, margin))};
}

INLINE void settle(const struct call *call, struct queue *queues, const struct queue *queue, int k, vm which,
                   vf separation, vec2 n, vi record_a, vi record_b) {
    vf item[FIELDS];
    get_item(queue, k, item, ROW_FIELDS);
    set_vec2(item, NORMAL, n);
    item[SEPARATION] = separation;
    item[RECORD_A] = v_of_bits(record_a);
    item[RECORD_B] = v_of_bits(record_b);
    if (call->question->edges) { /* where both bodies have edges there may be a second point */
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

static void probe_rows(const struct call *call, struct queue *queues, int begin) {
    probe_axis(&rows, call, queues, begin);
}

static void probe_rows_again(const struct call *call, struct queue *queues, int begin) {
    probe_again(&rows, call, queues, begin);
}

static void climb_rows(const struct call *call, struct queue *queues, int begin) {
    climb_from(&rows, call, queues, begin);
}

/* Polygons: the gap at all junctions. Those pairs for which one exceeds all others take the places of the queue's last
 * ones, from `begin` on: they are the question's. */
static void compare_edges(const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[POLYGONS];
    const int end = queue->count;
    queue->count = begin;
    for (int k = begin; k < end; k += V_WIDTH) {
        const vm live = vm_front(end - k);
        const vf slack = get(queue, SLACK, k), limit = v_add(get_margins(call, queue, k), v_mul(v_set(2), slack));
        const struct polygon_edge found = find_polygon_edge(call->batch->shapes->records, queue, k);
        const struct best_edge *best = &found.best;
        const vm near = vm_and_not(live, v_lt(limit, best->gap));
        if (!vm_any(near))
            continue;
        const vm clear = v_lt(best->second, v_sub(best->gap, v_mul(v_set(CLEAR_EDGE), slack)));
        vf item[FIELDS];
        get_item(queue, k, item, ROW_FIELDS);
        set_vec2(item, DIRECTION, best->normal);
        item[EDGE_CODE] = v_of_bits(vi_add(best->edge, vi_shift_left(found.corner, 4)));
        if (vm_any(vm_and_not(near, clear)))
            push(&queues[DECIDE], vm_and_not(near, clear), item, ROW_FIELDS);
        if (vm_any(vm_and(near, clear)))
            push(queue, vm_and(near, clear), item, FIELDS);
    }
    pad(queue); /* what was behind them has no edges */
}

/* The deciding formula, or a part of it that has its answer for certain. Its stack is not under that of what follows. */
NOINLINE void decide_gap(const narc_shapes *shapes, const struct queue *queue, int k, vm live, struct gap *out_gap) {
    vm certain = vm_front(0);
    if (NARC_SHORTCUTS)
        *out_gap = walk_near(shapes->records, queue, k, live, &certain);
    if (NARC_SHORTCUTS && !vm_any(vm_and_not(live, certain)))
        return;
    const struct gap gap = find_gap(shapes, queue, k, vm_and_not(live, certain), true);
    *out_gap = NARC_SHORTCUTS ? select_gap(certain, out_gap, &gap) : gap;
}

static void decide(const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[DECIDE];
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        struct gap gap;
        decide_gap(call->batch->shapes, queue, k, live, &gap);
        const vm wanted = vm_and(live, is_below(gap.separation, get_margins(call, queue, k)));
        if (vm_any(wanted))
            settle(call, queues, queue, k, wanted, gap.separation, find_normal(call, queue, k, wanted, &gap),
                   gap.record_a, gap.record_b);
    }
}

/* Of what never runs no kernel keeps the code. */
const struct row_search NARC_NAMED(search) = {
    .stages = {NARC_SHORTCUTS ? probe_rows : NULL, NARC_SHORTCUTS ? probe_rows_again : NULL,
               NARC_SHORTCUTS ? climb_rows : NULL, NARC_SHORTCUTS ? compare_edges : NULL, decide},
    .concave = NARC_PIECES ? answer_concave : NULL,
};
