/* SPDX-License-Identifier: MIT
 *
 * stages.inl - the search for the highest local maximum of the gap (search.inl), stage by stage: a probe along the axis
 * between the inscribed circles, another along u, a climb. How a probe is judged, and what becomes of what is certain, is
 * not theirs: rows (search.c) want all of a contact, overlaps (overlap.c) a sign.
 */
#ifndef NARC_SAT_STAGES_INL
#define NARC_SAT_STAGES_INL

#include <stdbool.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "polygon/polygon_edges.inl"
#include "sat/arc_lookup.inl"
#include "sat/certificates.inl"
#include "sat/search.inl"
#include "simd/simd.h"

/* What a probe of the arcs that a stage has found tells. */
struct verdict {
    vec2 u; /* where to probe next */
    vf length, separation;
    vm settled; /* known is all that is asked for, */
    vm wanted;  /* and it is to be told */
};

/* How a search ends: constants. */
struct search {
    int fields; /* what a pair needs in the queues */
    bool rows;  /* are there margins? */
    /* What probes along the axis, and along u, of the arcs in record_a and record_b of the pairs k ... tell. */
    struct verdict (*judge_axis)(const struct call *call, struct queue *queue, int k, vm live);
    struct verdict (*judge)(const struct call *call, struct queue *queue, int k, vm live);
    /* Pairs k ... of a queue in the lanes `which` touch along n, with the arcs in these records. */
    void (*settle)(const struct call *call, struct queue *queues, const struct queue *queue, int k, vm which,
                   vf separation, vec2 n, vi record_a, vi record_b);
};

/* Hands on what is to be told of the pairs k ... of a queue, in the lanes `live`. Returns those without an answer. */
INLINE vm end_probe(const struct search *search, const struct call *call, struct queue *queues,
                    const struct queue *queue, int k, vm live, const struct verdict *v) {
    if (vm_any(v->wanted))
        search->settle(call, queues, queue, k, v->wanted, v->separation, v2_divide(v->u, v->length),
                       vi_load(queue->record_a + k), vi_load(queue->record_b + k));
    return vm_and_not(live, v->settled);
}

/* First stage: probes along the axis, and hands smooth pairs to the next probe, along u. Near edges u leads astray:
 * other pairs go to the climb, which begins along the axis again. */
INLINE void probe_axis(const struct search *search, const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[PROBE];
    look_up_arcs(call->batch->shapes->records, queue, begin);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k), smooth = find_smooth(queue, k);
        const struct verdict v = search->judge_axis(call, queue, k, live);
        const vm left = end_probe(search, call, queues, queue, k, live, &v);
        store_vec2(queue, DIRECTION, k, v2_select(smooth, v.u, get_vec2(queue, DIRECTION, k)));
        const vm edged = vm_and_not(left, smooth);
        const vm polygons = POLYGONS > 0 ? select_polygons(queue, k, edged) : vm_front(0);
        pass_on(queue, k, vm_and(left, smooth), search->fields, &queues[PROBE_AGAIN]);
        pass_on(queue, k, vm_and_not(edged, polygons), search->fields, &queues[CLIMB]);
        if (POLYGONS > 0)
            pass_on(queue, k, polygons, search->fields, &queues[POLYGONS]);
        count_edged(queue, vm_and_not(live, smooth), edged);
    }
}

/* Probes along DIRECTION. */
INLINE void probe_again(const struct search *search, const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[PROBE_AGAIN];
    look_up_arcs(call->batch->shapes->records, queue, begin);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct verdict v = search->judge(call, queue, k, live);
        const vm left = end_probe(search, call, queues, queue, k, live, &v);
        store_vec2(queue, DIRECTION, k, v.u);
        pass_on(queue, k, left, search->fields, &queues[CLIMB]);
    }
}

/* Climbs from the arcs that hold DIRECTION, which becomes that of a local maximum where rows are wanted and one is near. */
INLINE void climb_from(const struct search *search, const struct call *call, struct queue *queues, int begin) {
    struct queue *const queue = &queues[CLIMB];
    const narc_record *const records = call->batch->shapes->records;
    look_up_arcs(records, queue, begin);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const vf margin = search->rows ? get_margins(call, queue, k) : v_set(0);
        const struct certified_maximum top = climb_and_certify(records, queue, k, live, margin);
        const struct local_maximum *m = &top.maximum;
        const vm wanted =
            vm_and(top.certain, search->rows ? is_below(top.separation, margin) : v_lt(top.separation, margin));
        if (vm_any(wanted))
            search->settle(call, queues, queue, k, wanted, top.separation, top.normal, m->record_a, m->record_b);
        if (search->rows)
            store_vec2(queue, DIRECTION, k,
                       v2_select(vm_or(m->found, m->turned), m->direction, get_vec2(queue, DIRECTION, k)));
        pass_on(queue, k, vm_and_not(live, vm_or(top.apart, top.certain)), search->fields, &queues[DECIDE]);
    }
}

#endif
