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
#include "sat/row_stages.inl"
#include "sat/search.inl"
#include "sat/stages.inl"
#include "simd/simd.h"

static void probe_rows(const struct call *call, struct queue *queues, int begin) {
    probe_axis(&rows, call, queues, begin);
}

static void probe_rows_again(const struct call *call, struct queue *queues, int begin) {
    probe_again(&rows, call, queues, begin);
}

static void climb_rows(const struct call *call, struct queue *queues, int begin) {
    climb_from(&rows, call, queues, begin);
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
