/* SPDX-License-Identifier: MIT
 *
 * contact.c - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their order;
 * for manifolds it goes on from there to a second point (manifold_edges.inl).
 *
 * Pairs pass through stages until one of them knows the answer that the deciding formula (normal_fan.inl) would give,
 * to the last bit: circles, a probe along the axis (or of the arcs of the last call), another along u, a climb to a
 * local maximum, a walk past the two junctions beside it, and the formula itself. The normal n and the arcs are those of
 * the highest local maximum of the gap. Polygons of few corners go from the first probe to a stage that has the gap at
 * all junctions.
 */
#include <stdbool.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/pipeline.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_detour.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "kernels.h"
#include "piece/concave.inl"
#include "polygon/polygon_contact.inl"
#include "polygon/polygon_edges.inl"
#include "polygon/polygon_rows.inl"
#include "sat/arc_lookup.inl"
#include "sat/certificates.inl"
#include "sat/faces.inl"
#include "sat/manifold_edges.inl"
#include "sat/normal_fan.inl"
#include "sat/search.inl"
#include "simd/simd.h"

/* Answers pairs of two circles in the lanes `open`; returns those that are left. `in_order`: are the pairs before, and
 * those in the other lanes, done? */
INLINE vm answer_discs(const struct call *call, vm open, vf margin, const vf item[FIELDS], bool in_order) {
    const struct probe p = probe_discs(call->batch->shapes->records, item, open, margin);
    const vm answered = vm_and(open, vm_or(p.far, p.only)), left = vm_and_not(open, answered);
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
        write_answers(call, place, find_numbers(call, pairs), &answer);
    }
    if (call->batch->query->hints.base)
        put_hints(call, pairs, answered, vi_set(FIRST_ARCS));
    return left;
}

INLINE vm triage_rows(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    struct rows *rows = call->rows;
    const vm valid = take_valid(call, pair, circles, item), near = vm_and_not(valid, circles->apart);
    vm open = near;
    if (NARC_PIECES && !LIKELY(!call->concave))
        open = take_concave(call, valid, near, circles, item);
    const bool waits = NARC_PIECES && !LIKELY(!call->concave) && vm_any(vm_and(valid, has_concave(item)));
    const bool due = !rows->dense && rows->done == (int)pair && !vm_any(circles->invalid) && !waits;
    const bool room = (size_t)rows->listed + V_WIDTH <= call->count && !boxes_wait(call);
    const bool in_order = due && room;
    const vm left = are_discs(open, item) ? answer_discs(call, open, circles->margin, item, in_order) : open;
    if (due && !vm_any(left) && (in_order || !vm_any(open)))
        rows->done += V_WIDTH;
    return left;
}

/* That of stores with pieces where all else goes to the formula. */
INLINE vm triage_pieces(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    const vm valid = take_valid(call, pair, circles, item);
    return take_concave(call, valid, valid, circles, item);
}

/* Passes on the pairs k ... of a queue in the lanes `left`. */
INLINE void pass_on(const struct queue *queue, int k, vm left, struct queue *next) {
    vf item[FIELDS];
    if (!vm_any(left))
        return;
    get_item(queue, k, item, CONTACT_FIELDS);
    push(next, left, item, CONTACT_FIELDS);
}

/* Probes the arcs in record_a and record_b of the pairs k ... of a queue, in the lanes `live`. If u of these arcs lies
 * between their junctions, it is the direction of a local maximum, mostly the highest. Returns the lanes without an
 * answer; in *out_u, the direction to probe along next. */
INLINE vm probe(const struct call *call, const struct queue *queue, int k, vm live, bool hints, vec2 *out_u) {
    const vi record_a = vi_load(queue->record_a + k), record_b = vi_load(queue->record_b + k);
    const vf margin = get_margins(call, queue, k);
    const struct probe p = probe_arcs(call->batch->shapes->records, queue, k, live, margin);
    const vf limit = v_add(margin, find_lookup_slack(queue, k));
    vm apart = vm_or(p.far, is_above(p.u, p.radii, get_vec2(queue, DIRECTION, k), limit));
    if (hints) /* a hint's arcs may not hold DIRECTION */
        apart = vm_and_not(apart, vm_and_not(vi_lt(vi_set(0), vi_load(queue->hinted + k)), p.far));
    const vm certain = vm_and_not(p.only, apart);
    store_hints(call, queue, k, vm_or(p.far, p.only), record_a, record_b);
    const vm keep = vm_and(certain, is_below(p.separation, margin));
    if (vm_any(keep)) {
        const vec2 n = v2_divide(p.u, p.length);
        const struct feature on_a = find_feature(&p.arcs.a, &p.arcs.a, n, record_a, false);
        const struct feature on_b = find_feature(&p.arcs.b, &p.arcs.b, n, record_b, true);
        const vm kept = store_rows(call, queue, k, keep, p.separation, n, &on_a, &on_b);
        collect_edges(call, queue, k, kept, p.separation, n, &on_a, &on_b);
    }
    *out_u = p.u;
    return vm_and_not(live, vm_or(apart, certain));
}

/* Climbs from the arcs in record_a and record_b of the pairs k ... of a queue, in the lanes `live`; returns those
 * without an answer. In *out_lost, those that are not even near a local maximum; DIRECTION leads to the others'. */
INLINE vm climb_to(const struct call *call, struct queue *queue, int k, vm live, vm *out_lost) {
    const vf margin = get_margins(call, queue, k);
    const struct certified_maximum top = climb_and_certify(call->batch->shapes->records, queue, k, live, margin);
    const struct local_maximum *m = &top.maximum;
    store_hints(call, queue, k, vm_or(top.apart, top.certain), m->record_a, m->record_b);
    const vm keep = vm_and(top.certain, is_below(top.separation, margin));
    if (vm_any(keep)) {
        const struct feature on_a = find_feature(&m->after.a, &m->before.a, top.normal, m->record_a, false);
        const struct feature on_b = find_feature(&m->after.b, &m->before.b, top.normal, m->record_b, true);
        const vm kept = store_rows(call, queue, k, keep, top.separation, top.normal, &on_a, &on_b);
        collect_edges(call, queue, k, kept, top.separation, top.normal, &on_a, &on_b);
    }
    const vm near = vm_or(m->found, m->turned);
    *out_lost = vm_and_not(live, near);
    store_vec2(queue, DIRECTION, k, v2_select(near, m->direction, get_vec2(queue, DIRECTION, k)));
    return vm_and_not(live, vm_or(top.apart, top.certain));
}

/* Stages that others pass pairs on to. */
enum { CLIMB = 2, DECIDE = 4 };

/* First stage: probes along the axis, and hands smooth pairs to the next probe, along u. Near edges u leads astray:
 * other pairs go to the climb, which begins along the axis again. */
static void probe_axis(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    look_up_arcs(call->batch->shapes->records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k), smooth = find_smooth(queue, k);
        vec2 u;
        const vm left = probe(call, queue, k, live, false, &u);
        store_vec2(queue, DIRECTION, k, v2_select(smooth, u, get_vec2(queue, DIRECTION, k)));
        pass_on(queue, k, vm_and(left, smooth), next);
        const vm edged = vm_and_not(left, smooth), polygons = select_polygons(queue, k, edged);
        pass_on(queue, k, vm_and_not(edged, polygons), queue + CLIMB);
        pass_on(queue, k, polygons, queue + POLYGONS);
        count_edged(queue, vm_and_not(live, smooth), vm_and_not(left, smooth));
    }
}

/* First stage with hints: probes the arcs of the last call, and the next stage probes along u. Where there are edges,
 * climbs from those arcs. A maximum that is not certain would mostly be found again from the axis: it is left to the
 * formula; those that lost their way begin anew. */
static void start_from_hints(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    read_hints(call, queue, begin);
    look_up_arcs(call->batch->shapes->records, queue, begin, true);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k), smooth = find_smooth(queue, k);
        const vm round = vm_and(live, smooth), edged = vm_and_not(live, smooth);
        if (vm_any(round)) {
            vec2 u;
            const vm left = probe(call, queue, k, round, true, &u);
            store_vec2(queue, DIRECTION, k, v2_select(smooth, u, get_vec2(queue, DIRECTION, k)));
            pass_on(queue, k, left, next);
        }
        if (vm_any(edged)) {
            vm lost;
            const vm left = climb_to(call, queue, k, edged, &lost);
            pass_on(queue, k, vm_and(left, lost), queue + CLIMB);
            pass_on(queue, k, vm_and_not(left, lost), queue + DECIDE);
        }
    }
}

/* Probes along DIRECTION. */
static void probe_again(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    look_up_arcs(call->batch->shapes->records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        vec2 u;
        const vm left = probe(call, queue, k, vm_front(queue->count - k), false, &u);
        store_vec2(queue, DIRECTION, k, v2_select(find_smooth(queue, k), u, get_vec2(queue, DIRECTION, k)));
        pass_on(queue, k, left, next);
    }
}

/* Climbs from the arcs that hold DIRECTION. */
static void climb_from(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    (void)next;
    look_up_arcs(call->batch->shapes->records, queue, begin, false);
    vm lost;
    for (int k = begin; k < queue->count; k += V_WIDTH)
        pass_on(queue, k, climb_to(call, queue, k, vm_front(queue->count - k), &lost), queue + (DECIDE - CLIMB));
}

/* Polygons: the gap at all junctions. Those pairs for which one exceeds all others take the places of the queue's last
 * ones, from `begin` on. */
NOINLINE void compare_edges(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    const int end = queue->count;
    queue->count = begin;
    for (int k = begin; k < end; k += V_WIDTH) {
        const vm live = vm_front(end - k);
        const vf slack = get(queue, SLACK, k), limit = v_add(get_margins(call, queue, k), v_mul(v_set(2), slack));
        const struct polygon_edge found = find_polygon_edge(call->batch->shapes->records, queue, k, true);
        const struct best_edge *best = &found.best;
        if (call->batch->query->hints.base)
            put_hints(call, get_bits(queue, PAIR, k), live, vi_set(FIRST_ARCS));
        const vm near = vm_and_not(live, v_lt(limit, best->gap));
        if (!vm_any(near))
            continue;
        const vm clear = v_lt(best->second, v_sub(best->gap, v_mul(v_set(CLEAR_EDGE), slack)));
        vf item[FIELDS];
        get_item(queue, k, item, CONTACT_FIELDS);
        set_vec2(item, DIRECTION, best->normal);
        item[EDGE_CODE] = v_of_bits(vi_add(best->edge, vi_shift_left(found.corner, 4)));
        if (vm_any(vm_and_not(near, clear)))
            push(next, vm_and_not(near, clear), item, CONTACT_FIELDS);
        if (vm_any(vm_and(near, clear)))
            push(queue, vm_and(near, clear), item, FIELDS);
    }
    pad(queue); /* what was behind them has no edges */
}

/* The contacts of polygons, if they are certain. */
NOINLINE void answer_edges(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct polygon_contact c = find_polygon_contact(call->batch->shapes->records, queue, k);
        const vf margin = get_margins(call, queue, k);
        const vm keep = vm_and(vm_and(live, c.certain), is_below(c.separation, margin));
        if (vm_any(keep))
            store_polygon_rows(call, queue, k, keep, margin, &c);
        pass_on(queue, k, vm_and_not(live, c.certain), next);
    }
}

/* One after the other, so that neither's stack is added to the other's. */
static void answer_polygons(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    compare_edges(call, queue, begin, next);
    answer_edges(call, queue, begin, next);
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

static void decide(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    (void)next;
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        struct gap gap;
        decide_gap(call->batch->shapes, queue, k, live, &gap);
        store_hints(call, queue, k, live, gap.record_a, gap.record_b);
        const vm keep = vm_and(live, is_below(gap.separation, get_margins(call, queue, k)));
        if (vm_any(keep)) {
            struct feature on_a, on_b;
            const vec2 n = find_gap_features(call, queue, k, keep, &gap, &on_a, &on_b);
            const vm kept = store_rows(call, queue, k, keep, gap.separation, n, &on_a, &on_b);
            collect_edges(call, queue, k, kept, gap.separation, n, &on_a, &on_b);
        }
    }
}

static box_stage *const contact_detours[BOX_QUEUES] = {answer_box_contacts, answer_capsule_contacts};
static box_stage *const manifold_detours[BOX_QUEUES] = {answer_box_manifolds, answer_capsule_manifolds};

INLINE vm detour_rows(const struct call *call, const struct pair_indices *indices, int k,
                      const struct placement *placement, vm open, int32_t number) {
    return take_detour(call, indices, k, placement, open, number, call->edges ? manifold_detours : contact_detours);
}

/* `concave`: a queue for pairs with concave arcs, or NULL if there are no pieces. */
NOINLINE size_t find_rows(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out,
                          struct queue *concave) {
    const bool hinted = batch->query->hints.base != NULL, manifolds = batch->manifolds;
    stage *const stages[STAGES] = {
        hinted ? start_from_hints : probe_axis, probe_again, climb_from, answer_polygons, decide, find_second_points};
    stage *const formula[] = {decide, find_second_points};
    const int stage_count = manifolds ? STAGES : STAGES - 1, edged_stage = hinted ? 0 : CLIMB;
    struct queue queues[STAGES];
    struct box_queue boxes[BOX_QUEUES];
    struct rows rows;
    struct call call = begin_rows(batch, first, count, skipped, out, &rows);
    call.edges = !manifolds ? NULL : NARC_SHORTCUTS ? &queues[STAGES - 1] : &queues[1];
    call.concave = concave;
    if (!NARC_SHORTCUTS) {
        run_pairs(&call, NULL, call.pieces ? triage_pieces : take_valid, FIELDS, formula, manifolds ? 2 : 1, 0, queues);
    } else if (batch->shapes->box_count > 0) {
        start_boxes(&call, boxes);
        run_pairs(&call, detour_rows, triage_rows, CONTACT_FIELDS, stages, stage_count, edged_stage, queues);
        end_boxes(&call, manifolds ? manifold_detours : contact_detours);
    } else {
        run_pairs(&call, NULL, triage_rows, CONTACT_FIELDS, stages, stage_count, edged_stage, queues);
    }
    while (NARC_PIECES && concave && concave->count > 0)
        answer_concave(&call);
    return end_rows(&call);
}

/* Only where there are pieces is that queue on the stack. */
NOINLINE size_t find_piece_rows(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                                const narc_rows *out) {
    struct queue concave;
    concave.count = 0;
    return find_rows(batch, first, count, skipped, out, &concave);
}

size_t NARC_NAMED(contact)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    return has_pieces(batch) ? find_piece_rows(batch, first, count, skipped, out)
                             : find_rows(batch, first, count, skipped, out, NULL);
}
