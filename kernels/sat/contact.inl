/* SPDX-License-Identifier: MIT
 *
 * contact.inl - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their
 * order; and the manifold kernel, which goes on from there to a second point (manifold_edges.inl).
 *
 * Pairs pass through stages until one of them knows the answer that the deciding formula (normal_fan.inl) would give,
 * to the last bit: circles, a probe along the axis (or of the arcs of the last call), another along u, a climb to a
 * local maximum, and the formula itself. The normal n and the arcs are those of the highest local maximum of the gap.
 */
#ifndef NARC_SAT_CONTACT_INL
#define NARC_SAT_CONTACT_INL

#include <stdbool.h>
#include <string.h>

#include "base/arcs.inl"
#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/contact_rows.inl"
#include "base/hints.inl"
#include "base/pair_setup.inl"
#include "base/pipeline.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "sat/certificates.inl"
#include "sat/direction_lookup.inl"
#include "sat/hill_climb.inl"
#include "sat/manifold_edges.inl"
#include "sat/manifold_rows.inl"
#include "sat/normal_fan.inl"
#include "sat/shortcuts.inl"
#include "simd/simd.h"

INLINE vm triage_contacts(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    return vm_and_not(take_valid(call, pair, circles, item), circles->apart);
}

/* The sine of the angle from u to the nearest junction of its arcs, times the length of u. A circle's junctions mean
 * nothing. */
INLINE vf find_least_sine(const struct arc_pair *arcs, vec2 u, vf length, vi info_a, vi info_b) {
    const vf from_a = v_min(v2_cross(arcs->a.start, u), v2_cross(u, arcs->a.end));
    const vf from_b = v_min(v2_cross(arcs->b.start, u), v2_cross(u, arcs->b.end));
    return v_min(v_select(info_has(info_a, NARC_SHAPE_CIRCLE), length, from_a),
                 v_select(info_has(info_b, NARC_SHAPE_CIRCLE), length, from_b));
}

/* Stores what was found of the pairs k ... of a queue in the lanes `keep`. */
INLINE void store_answer(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n,
                         const struct feature *on_a, const struct feature *on_b, bool manifolds) {
    if (manifolds)
        store_deepest(call, queue, k, keep, separation, n, on_a, on_b);
    else
        store_contacts(call, queue, k, keep, separation, n, on_a, on_b);
}

/* Probes along DIRECTION, or the arcs of a hint. If u of these arcs lies between their junctions, it is the direction
 * of a local maximum, mostly the highest. The next stage probes along u, or along the axis where there are edges: near
 * them u leads astray. */
INLINE void probe(const struct call *call, struct queue *queue, int begin, struct queue *next, bool hints,
                  bool manifolds) {
    const narc_record *records = call->batch->shapes->records;
    if (hints)
        read_hints(queue, call->rows->hint);
    look_up_arcs(records, queue, begin, hints);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const vf slack = get(queue, SLACK, k), margin = get_margins(call, queue, k);
        const vi info_a = get_bits(queue, INFO_A, k), info_b = get_bits(queue, INFO_B, k);
        const vi record_a = vi_load(queue->record_a + k), record_b = vi_load(queue->record_b + k);
        const struct pose pose = get_pose(queue, k);
        const struct arc_pair arcs = load_arc_pair(records, record_a, record_b, &pose);
        const vec2 u = center_difference(&arcs);
        const vf length = v2_length(u), radii = v_add(arcs.a.radius, arcs.b.radius), separation = v_sub(length, radii);
        const vf least = find_least_sine(&arcs, u, length, info_a, info_b);
        const vm inside =
            vm_and(live, v_lt(v_set(0), least)); /* u is long enough for the formula if is_only_maximum() */
        const vm far = vm_and(inside, v_lt(v_add(margin, slack), separation));
        const vf limit = v_add(margin, lookup_slack(queue, k));
        vm apart = vm_or(far, is_above(u, radii, get_vec2(queue, DIRECTION, k), limit));
        if (hints) /* a hint's arcs may not hold DIRECTION */
            apart = vm_and_not(apart, vm_and_not(vi_lt(vi_set(0), vi_load(queue->hinted + k)), far));
        const vm only = is_only_maximum(v_add(arcs.a.inner, arcs.b.inner), separation, least, length, slack);
        const vm certain = vm_and_not(vm_and(inside, only), apart);
        store_hints(call, queue, k, vm_or(far, certain), record_a, record_b);
        const vm keep = vm_and(certain, is_below(separation, margin));
        if (vm_any(keep)) {
            const vec2 n = v2_divide(u, length);
            const struct feature on_a = find_feature(&arcs.a, &arcs.a, n, record_a, false);
            const struct feature on_b = find_feature(&arcs.b, &arcs.b, n, record_b, true);
            store_answer(call, queue, k, keep, separation, n, &on_a, &on_b, manifolds);
        }
        const vm left = vm_and_not(live, vm_or(apart, certain));
        if (vm_any(left)) {
            const vm smooth = info_has(vi_and(info_a, info_b), NARC_SHAPE_SMOOTH);
            vf item[FIELDS];
            get_item(queue, k, item, CONTACT_FIELDS);
            set_vec2(item, DIRECTION, v2_select(smooth, u, (vec2){item[AXIS], item[AXIS + 1]}));
            push(next, left, item, CONTACT_FIELDS);
        }
    }
}

/* Climbs from the arcs that hold DIRECTION. */
INLINE void climb_to(const struct call *call, struct queue *queue, int begin, struct queue *next, bool manifolds) {
    const narc_record *records = call->batch->shapes->records;
    look_up_arcs(records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const vf margin = get_margins(call, queue, k);
        const struct certified_maximum top = climb_and_certify(records, queue, k, live, margin);
        const struct local_maximum *m = &top.maximum;
        store_hints(call, queue, k, vm_or(top.apart, top.certain), m->record_a, m->record_b);
        const vm keep = vm_and(top.certain, is_below(top.separation, margin));
        if (vm_any(keep)) {
            const struct feature on_a = find_feature(&m->after.a, &m->before.a, top.normal, m->record_a, false);
            const struct feature on_b = find_feature(&m->after.b, &m->before.b, top.normal, m->record_b, true);
            store_answer(call, queue, k, keep, top.separation, top.normal, &on_a, &on_b, manifolds);
        }
        const vm left = vm_and_not(live, vm_or(top.apart, top.certain));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(queue, k, item, CONTACT_FIELDS);
            push(next, left, item, CONTACT_FIELDS);
        }
    }
}

INLINE void decide(const struct call *call, struct queue *queue, int begin, bool manifolds) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct gap gap = find_gap(call->batch->shapes, queue, k, live, true);
        store_hints(call, queue, k, live, gap.record_a, gap.record_b);
        const vm keep = vm_and(live, is_below(gap.separation, get_margins(call, queue, k)));
        if (vm_any(keep)) {
            struct feature on_a, on_b;
            const vec2 n = find_gap_features(call, queue, k, &gap, &on_a, &on_b);
            store_answer(call, queue, k, keep, gap.separation, n, &on_a, &on_b, manifolds);
        }
    }
}

/* The stages of both kernels. */
#define STAGES_OF(answers, manifolds)                                                                                  \
    static void probe_##answers(const struct call *call, struct queue *queue, int begin, struct queue *next) {         \
        probe(call, queue, begin, next, false, manifolds);                                                             \
    }                                                                                                                  \
    static void probe_hinted_##answers(const struct call *call, struct queue *queue, int begin, struct queue *next) {  \
        probe(call, queue, begin, next, true, manifolds);                                                              \
    }                                                                                                                  \
    static void climb_to_##answers(const struct call *call, struct queue *queue, int begin, struct queue *next) {      \
        climb_to(call, queue, begin, next, manifolds);                                                                 \
    }                                                                                                                  \
    static void decide_##answers(const struct call *call, struct queue *queue, int begin, struct queue *next) {        \
        (void)next;                                                                                                    \
        decide(call, queue, begin, manifolds);                                                                         \
    }
STAGES_OF(contacts, false)
STAGES_OF(manifolds, true)
#undef STAGES_OF

/* Runs `stages`, the first of which reads hints if there are any. */
INLINE void run_with_hints(const struct call *call, stage *const *stages, int stage_count, struct queue *queues) {
    const narc_batch *batch = call->batch;
    struct contact_rows *rows = call->rows;
    rows->hinted = batch->hints != NULL;
    if (batch->hints)
        memcpy(rows->hint, batch->hints + call->first, call->count * sizeof *rows->hint);
    run_pairs(call, triage_contacts, CONTACT_FIELDS, stages, stage_count, queues);
    if (batch->hints)
        memcpy(batch->hints + call->first, rows->hint, call->count * sizeof *rows->hint);
}

static size_t contact(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    stage *const start = batch->hints ? probe_hinted_contacts : probe_contacts;
    stage *const stages[] = {start, probe_contacts, climb_to_contacts, decide_contacts};
    struct queue queues[4];
    struct contact_rows rows;
    if (!NARC_SHORTCUTS)
        return run_contact_method(decide_contacts, batch, first, count, margin, out);
    const struct call call = begin_contacts(batch, first, count, margin, &rows);
    run_with_hints(&call, stages, 4, queues);
    return list_contacts(&call, out);
}

static size_t manifold(const narc_batch *batch, size_t first, size_t count, float margin, const narc_manifolds *out) {
    stage *const start = batch->hints ? probe_hinted_manifolds : probe_manifolds;
    stage *const stages[] = {start, probe_manifolds, climb_to_manifolds, decide_manifolds, find_second_points};
    stage *const all[] = {decide_manifolds, find_second_points};
    struct queue queues[STAGES];
    struct manifold_rows rows;
    struct call call = begin_contacts(batch, first, count, margin, &rows.first);
    call.manifolds = &rows;
    if (NARC_SHORTCUTS) {
        call.edges = &queues[STAGES - 1];
        run_with_hints(&call, stages, STAGES, queues);
    } else {
        call.edges = &queues[1];
        run_pairs(&call, take_valid, FIELDS, all, 2, queues);
    }
    return list_manifolds(&call, out);
}

#endif
