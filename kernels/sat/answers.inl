/* SPDX-License-Identifier: MIT
 *
 * answers.inl - the way of a question that has rows, from its row_writer: pairs of circles are answered as they are set
 * up, of boxes, capsules and concave arcs by their detours, all others by the search (search.c), whose last two stages
 * are here.
 */
#ifndef NARC_SAT_ANSWERS_INL
#define NARC_SAT_ANSWERS_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/pipeline.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_detour.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "kernels.h"
#include "piece/concave_detour.inl"
#include "piece/pieces.inl"
#include "polygon/polygon_contact.inl"
#include "polygon/polygon_rows.inl"
#include "sat/manifold_edges.inl"
#include "sat/search.inl"
#include "simd/simd.h"

/* Answers pairs of two circles in the lanes `open`; returns those that are left. `in_order`: are the pairs before, and
 * those in the other lanes, done? */
INLINE vm answer_discs(const struct call *call, vm open, vf margin, const vf item[FIELDS], bool in_order,
                       row_writer *write) {
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
        append_answers(call, pairs, found, &answer, write);
    } else {
        char *place[V_WIDTH];
        find_places(call, pairs, found, place);
        write(call, place, find_numbers(call, pairs), &answer, NULL);
    }
    if (call->batch->query->hints.base)
        put_hints(call, pairs, answered, vi_set(FIRST_ARCS));
    return left;
}

INLINE vm triage_rows(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS],
                      row_writer *write) {
    struct rows *rows = call->rows;
    const vm valid = take_valid(call, pair, circles, item);
    const vm near = NARC_SHORTCUTS ? vm_and_not(valid, circles->apart) : valid;
    vm open = near;
    if (NARC_PIECES && !LIKELY(!call->concave))
        open = take_concave(call, valid, near, circles, item);
    if (!NARC_SHORTCUTS)
        return open;
    const bool waits = NARC_PIECES && !LIKELY(!call->concave) && vm_any(vm_and(valid, has_concave(item)));
    const bool due = !rows->dense && rows->done == (int)pair && !vm_any(circles->invalid) && !waits;
    const bool room = (size_t)rows->listed + V_WIDTH <= call->count && !boxes_wait(call);
    const bool in_order = due && room;
    const vm left = are_discs(open, item) ? answer_discs(call, open, circles->margin, item, in_order, write) : open;
    if (due && !vm_any(left) && (in_order || !vm_any(open)))
        rows->done += V_WIDTH;
    return left;
}

/* The last stages. `edges`: do both bodies have edges, and are second points asked for? */
INLINE void answer_settled(const struct call *call, struct queue *queues, int begin, row_writer *write, bool edges) {
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
        const struct answer answer = find_answer(queue, k, separation, n, &on_a, &on_b);
        const vm kept = keep_fronts(call, queue, k, vm_front(queue->count - k), separation, n,
                                    vi_and(answer.feature, vi_set(0xff)), vi_shift_right(answer.feature, 8));
        char *place[V_WIDTH];
        find_places(call, pairs, kept, place);
        if (edges) {
            struct sides sides;
            find_sides(call, queue, k, on_a.record, on_b.record, n, find_contact_place(&on_a, &on_b), &sides);
            write(call, place, find_numbers(call, pairs), &answer, &sides);
        } else {
            write(call, place, find_numbers(call, pairs), &answer, NULL);
        }
    }
}

/* The contacts of polygons, if they are certain; the gaps at their junctions are known. */
INLINE void answer_polygons(const struct call *call, struct queue *queues, int begin, row_writer *write, bool edges) {
    const struct queue *const queue = &queues[POLYGONS];
    NARC_NAMED(search).stages[POLYGONS](call, queues, begin);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct polygon_contact c = find_polygon_contact(call->batch->shapes->records, queue, k);
        const vf margin = get_margins(call, queue, k);
        const vm keep = vm_and(vm_and(live, c.certain), is_below(c.separation, margin));
        if (vm_any(keep))
            write_polygons(call, queue, k, keep, margin, &c, write, edges);
        pass_on(queue, k, vm_and_not(live, c.certain), ROW_FIELDS, &queues[DECIDE]);
    }
}

/* `queues`: `end` of them, one for each stage. `concave`: one for pairs with concave arcs, or NULL if there are no pieces. */
INLINE size_t find_rows(const struct question *question, size_t size, int end, triage *settle, detour *take,
                        const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out,
                        struct queue *queues, struct queue *concave) {
    const struct row_search *const search = &NARC_NAMED(search);
    const bool hinted = batch->query->hints.base != NULL;
    stage *const stages[STAGES] = {hinted ? search->hinted : search->stages[PROBE],
                                   search->stages[PROBE_AGAIN],
                                   search->stages[CLIMB],
                                   question->polygons,
                                   search->stages[DECIDE],
                                   question->answer,
                                   question->edges};
    const struct course course = {.take = take,
                                  .settle = settle,
                                  .fields = NARC_SHORTCUTS ? ROW_FIELDS : FIELDS,
                                  .stages = stages,
                                  .first = NARC_SHORTCUTS ? PROBE : DECIDE,
                                  .edged = NARC_SHORTCUTS && !hinted ? CLIMB : 0,
                                  .end = end};
    struct box_queue boxes[BOX_QUEUES];
    struct rows rows;
    struct call call = begin_rows(question, batch, first, count, skipped, out, &rows);
    call.concave = concave;
    if (NARC_SHORTCUTS && batch->shapes->box_count > 0)
        start_boxes(&call, boxes);
    run_pairs(&call, &course, queues);
    if (call.boxes)
        end_boxes(&call, question->boxes);
    while (NARC_PIECES && concave && concave->count > 0)
        search->concave(&call);
    return end_rows(&call, size);
}

/* A question, name_question, from its row_writer, without what never runs. `normal`, `extra`: normal_at and extra_row;
 * `second`: are second points asked for? */
#define NARC_QUESTION(name, type, normal, extra, nothing, writer, second)                                              \
    static void name##_of_settled(const struct call *call, struct queue *queues, int begin) {                          \
        answer_settled(call, queues, begin, writer, false);                                                            \
    }                                                                                                                  \
    static void name##_of_edges(const struct call *call, struct queue *queues, int begin) {                            \
        answer_settled(call, queues, begin, writer, second);                                                           \
    }                                                                                                                  \
    static void name##_of_polygons(const struct call *call, struct queue *queues, int begin) {                         \
        answer_polygons(call, queues, begin, writer, second);                                                          \
    }                                                                                                                  \
    static void name##_of_boxes(const struct call *call, const struct box_queue *queue, int k, int live) {             \
        answer_boxes(call, queue, k, live, false, writer, second);                                                     \
    }                                                                                                                  \
    static void name##_of_capsules(const struct call *call, const struct box_queue *queue, int k, int live) {          \
        answer_boxes(call, queue, k, live, true, writer, second);                                                      \
    }                                                                                                                  \
    static void name##_of_gaps(const struct call *call, const struct queue *queue, int k, const struct gap *gap,       \
                               char *const *place) {                                                                   \
        write_gaps(call, queue, k, gap, place, writer);                                                                \
    }                                                                                                                  \
    _Static_assert(sizeof(type) <= sizeof(narc_manifold), "room for a row");                                           \
    static const struct question name##_question = {                                                                   \
        sizeof(type),                                                                                                  \
        normal,                                                                                                        \
        extra,                                                                                                         \
        nothing,                                                                                                       \
        name##_of_settled,                                                                                             \
        (second) ? name##_of_edges : NULL,                                                                             \
        NARC_SHORTCUTS ? name##_of_polygons : NULL,                                                                    \
        {NARC_SHORTCUTS ? name##_of_boxes : NULL, NARC_SHORTCUTS ? name##_of_capsules : NULL},                         \
        NARC_PIECES ? name##_of_gaps : NULL};

/* answer_name(): takes the pairs of a call through all that is before the search, and that. `type`: of rows in a list;
 * `end`: behind the last stage. */
#define NARC_ROWS(name, type, writer, end)                                                                             \
    INLINE vm triage_##name(const struct call *call, size_t pair, const struct filter *circles,                        \
                            const vf item[FIELDS]) {                                                                   \
        return triage_rows(call, pair, circles, item, writer);                                                         \
    }                                                                                                                  \
    INLINE vm detour_##name(const struct call *call, const struct pair_indices *indices, int k,                        \
                            const struct placement *placement, vm open, int32_t number) {                              \
        return take_detour(call, indices, k, placement, open, number, call->question->boxes);                          \
    }                                                                                                                  \
    NOINLINE size_t find_##name(const struct question *question, const narc_batch *batch, size_t first, size_t count,  \
                                size_t *skipped, const narc_rows *out, struct queue *concave) {                        \
        struct queue queues[end];                                                                                      \
        return find_rows(question, sizeof(type), end, triage_##name, detour_##name, batch, first, count, skipped, out, \
                         queues, concave);                                                                             \
    }                                                                                                                  \
    /* Only where there are pieces is their queue on the stack. */                                                     \
    NOINLINE size_t find_##name##_of_pieces(const struct question *question, const narc_batch *batch, size_t first,    \
                                            size_t count, size_t *skipped, const narc_rows *out) {                     \
        struct queue concave;                                                                                          \
        concave.count = 0;                                                                                             \
        return find_##name(question, batch, first, count, skipped, out, &concave);                                     \
    }                                                                                                                  \
    static size_t answer_##name(const struct question *question, const narc_batch *batch, size_t first, size_t count,  \
                                size_t *skipped, const narc_rows *out) {                                               \
        return has_pieces(batch) ? find_##name##_of_pieces(question, batch, first, count, skipped, out)                \
                                 : find_##name(question, batch, first, count, skipped, out, NULL);                     \
    }

#endif
