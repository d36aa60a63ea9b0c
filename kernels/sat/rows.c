/* SPDX-License-Identifier: MIT
 *
 * rows.c - the way of all pairs that get rows, whatever the question: pairs of circles are answered as they are set up, of
 * boxes, capsules and concave arcs by their detours, all others by the search (search.c), whose last stages are here.
 */
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
#include "box/circles.inl"
#include "kernels.h"
#include "piece/circles_beside.inl"
#include "piece/concave_detour.inl"
#include "piece/edges_below.inl"
#include "piece/pieces.inl"
#include "sat/answers.inl"
#include "sat/search.inl"
#include "simd/simd.h"

INLINE vm triage_rows(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
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
    const vm left = are_discs(open, item) ? answer_discs(call, open, circles->margin, item, in_order) : open;
    if (due && !vm_any(left) && (in_order || !vm_any(open)))
        rows->done += V_WIDTH;
    return left;
}

/* The last stages of rows of one point. */
static void answer_rows(const struct call *call, struct queue *queues, int begin) {
    answer_settled(call, queues, begin, false);
}

static vm answer_rows_on_edges(const struct call *call, const struct edge_contact *contact) {
    return answer_on_edges(call, contact, false);
}

static vm settle_runs(const struct call *call, vm open, vf margin, vf item[FIELDS]) {
    edge_answer *const second = call->question->on_edges;
    return call->batch->shapes->box_count == 0
               ? open
               : settle_above_edges(call, second ? second : answer_rows_on_edges, open, margin, item);
}

/* Pairs of a circle and a piece of a chain come before those of two forms. Others come behind, out of order. */
INLINE vm take_detours(const struct call *call, const struct pair_indices *indices, int k,
                       const struct placement *placement, vm open, int32_t number) {
    vm left = open;
    if (NARC_PIECES && NARC_CIRCLE_FORMS && !LIKELY(!call->concave) && call->batch->shapes->fronts) {
        const struct placement copy = *placement; /* so that the other one stays in registers */
        left = vm_and_not(open, take_circles_on_pieces(call, indices, k, &copy, open, number));
        if (vm_any(vm_and_not(open, left)))
            call->rows->done = -1;
        if (call->settled->count >= FLUSH)
            run_stage(call, answer_rows, call->settled - ANSWER, ANSWER);
    }
    return vm_any(left) ? take_detour(call, indices, k, placement, left, number) : left;
}

static void answer_rows_of_polygons(const struct call *call, struct queue *queues, int begin) {
    answer_polygons(call, queues, begin, false);
}

static void answer_rows_of_boxes(const struct call *call, const struct box_queue *queue, int k, int live) {
    answer_boxes(call, queue, k, live, false, false);
}

static void answer_rows_of_capsules(const struct call *call, const struct box_queue *queue, int k, int live) {
    answer_boxes(call, queue, k, live, true, false);
}

static void answer_circle_rows(const struct call *call, const struct box_queue *queue, int k, int live) {
    answer_circles(call, queue, k, live);
}

/* Takes the pairs through `end` stages, each with a queue. `pieces`: two for pairs with concave arcs and with runs, or NULL
 * if there are no pieces. */
NOINLINE void run_rows(const struct call *given, struct queue *queues, int end, struct queue *pieces) {
    const struct row_search *const search = &NARC_NAMED(search);
    const struct question *const question = given->question;
    const bool second = question->edges != NULL;
    stage *const polygons = second ? question->polygons : NARC_SHORTCUTS ? answer_rows_of_polygons : NULL;
    stage *const stages[STAGES] = {search->stages[PROBE],  search->stages[PROBE_AGAIN],
                                   search->stages[CLIMB],  polygons,
                                   search->stages[DECIDE], answer_rows,
                                   question->edges};
    const struct course course = {.take = NARC_SHORTCUTS ? take_detours : NULL,
                                  .settle = triage_rows,
                                  .runs = NARC_PIECES && NARC_CIRCLE_FORMS ? settle_runs : NULL,
                                  .fields = NARC_SHORTCUTS ? ROW_FIELDS : FIELDS,
                                  .stages = stages,
                                  .first = NARC_SHORTCUTS ? PROBE : DECIDE,
                                  .edged = NARC_SHORTCUTS ? CLIMB : 0,
                                  .end = end};
    struct box_queue boxes[BOX_QUEUES];
    struct call call = *given;
    call.concave = pieces;
    call.runs = pieces ? pieces + 1 : NULL;
    call.settled = &queues[ANSWER];
    box_stage *const answers[BOX_QUEUES] = {second ? question->boxes : answer_rows_of_boxes,
                                            second ? question->capsules : answer_rows_of_capsules,
                                            NARC_CIRCLE_FORMS ? answer_circle_rows : NULL};
    if (NARC_SHORTCUTS && call.batch->shapes->box_count > 0)
        start_boxes(&call, boxes, answers);
    run_pairs(&call, &course, queues);
    if (NARC_SHORTCUTS && call.boxes)
        end_boxes(&call);
    while (NARC_PIECES && pieces && pieces->count > 0)
        search->concave(&call);
}

/* What nobody asks for is not on the stack: second points, */
NOINLINE void find_points(const struct call *call, struct queue *pieces) {
    struct queue queues[ANSWER_EDGES];
    run_rows(call, queues, ANSWER_EDGES, pieces);
}

NOINLINE void find_second_points(const struct call *call, struct queue *pieces) {
    struct queue queues[STAGES];
    run_rows(call, queues, STAGES, pieces);
}

INLINE void find_all(const struct call *call, struct queue *pieces) {
    if (call->question->edges)
        find_second_points(call, pieces);
    else
        find_points(call, pieces);
}

/* and pairs with pieces. */
NOINLINE void find_all_of_pieces(const struct call *call) {
    struct queue pieces[2];
    pieces[0].count = pieces[1].count = 0;
    find_all(call, pieces);
}

void NARC_NAMED(find_rows)(const struct call *call) {
    if (NARC_PIECES && call->pieces)
        find_all_of_pieces(call);
    else
        find_all(call, NULL);
}
