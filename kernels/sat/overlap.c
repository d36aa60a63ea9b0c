/* SPDX-License-Identifier: MIT
 *
 * overlap.c - the overlap kernel: one bit per pair, set where the separation is below 0.
 *
 * Circles settle some pairs, and two probes most others: one along the axis between the inscribed circles, and one
 * along u of the arcs that the first one found. A probe ends with a proof (certificates.inl) that the bodies are apart
 * or have a common point, or passes the pair on. The rest climb to a local maximum of the gap. What is left then goes to
 * the deciding formula.
 */
/* With two queues less there is room for more pairs in each. */
#define NARC_OVERLAPS

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/pipeline.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_detour.inl"
#include "box/box_pairs.inl"
#include "box/capsules.inl"
#include "box/circles.inl"
#include "kernels.h"
#include "piece/overlaps.inl"
#include "sat/certificates.inl"
#include "sat/normal_fan.inl"
#include "sat/search.inl"
#include "sat/stages.inl"
#include "simd/simd.h"

INLINE vm triage_overlaps(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    if (!NARC_SHORTCUTS)
        return call->pieces ? take_pieces(call, pair, circles->valid, item) : circles->valid;
    const vm near = vm_and_not(circles->valid, circles->apart);
    const vm mine = call->pieces ? take_pieces(call, pair, near, item) : near;
    const vm open = vm_and_not(mine, circles->deep);
    vm hits = vm_and(mine, circles->deep), left = open;
    if (are_discs(open, item)) {
        const struct probe p = probe_discs(call->batch->shapes->records, item, open, v_set(0));
        hits = vm_or(hits, vm_and(p.only, v_lt(p.separation, v_set(0))));
        left = vm_and_not(open, vm_or(p.far, p.only));
    }
    call->bits[pair / 64] |= (uint64_t)vm_bits(hits) << pair % 64;
    return left;
}

/* The centres and radii of the arcs that were looked up: u, and the sum of the radii. */
INLINE vec2 load_circles(const narc_record *records, const struct queue *queue, int k, vf *out_radii) {
    const struct pose pose = get_pose(queue, k);
    vf a[4], b[4];
    v_rows(records, sizeof *records, queue->record_a + k, a);
    v_rows(records, sizeof *records, queue->record_b + k, b);
    *out_radii = v_add(v_mul(pose.scale_a, a[2]), v_mul(pose.scale_b, b[2]));
    return find_circle_difference((vec2){a[0], a[1]}, (vec2){b[0], b[1]}, &pose);
}

/* The difference of the support points of two arcs along DIRECTION n, times the length of n. */
INLINE vm touch_in_common(const struct queue *queue, int k, vec2 n, vec2 u, vf radii) {
    const vf length = v2_length(n);
    return has_common_point(queue, k, v2_sub(v2_scale(n, radii), v2_scale(u, length)), length);
}

INLINE struct verdict judge_overlap(const struct call *call, struct queue *queue, int k, vm live) {
    const vec2 n = get_vec2(queue, DIRECTION, k);
    const struct probe p = probe_arcs(call->batch->shapes->records, queue, k, live, v_set(0));
    const vm below = v_lt(p.separation, v_set(0)), above = is_above(p.u, p.radii, n, find_lookup_slack(queue, k));
    const vm apart = vm_or(vm_or(p.far, above), vm_and_not(p.only, below)),
             hit = vm_or(touch_in_common(queue, k, n, p.u, p.radii), vm_and(p.only, below));
    return (struct verdict){.u = p.u, .settled = vm_or(apart, hit), .wanted = vm_and(live, hit)};
}

/* Circles settle what overlaps deeply or is well apart: along the axis, centres and radii alone are probed. Once that
 * leaves more than half of a vector, as among bodies that rest on each other, whole arcs are worth their price for the
 * rest of a block. */
INLINE struct verdict judge_overlap_along_axis(const struct call *call, struct queue *queue, int k, vm live) {
    if (queue->whole)
        return judge_overlap(call, queue, k, live);
    const vec2 n = get_vec2(queue, DIRECTION, k);
    vf radii;
    const vec2 u = load_circles(call->batch->shapes->records, queue, k, &radii);
    const vm apart = is_above(u, radii, n, find_lookup_slack(queue, k)), hit = touch_in_common(queue, k, n, u, radii);
    const vm left = vm_and(vm_and_not(live, vm_or(apart, hit)), find_smooth(queue, k));
    queue->whole = 2 * COUNT_BITS(vm_bits(left)) > V_WIDTH;
    return (struct verdict){.u = u, .settled = vm_or(apart, hit), .wanted = vm_and(live, hit)};
}

INLINE void settle_overlap(const struct call *call, struct queue *queues, const struct queue *queue, int k, vm which,
                           vf separation, vec2 n, vi record_a, vi record_b) {
    (void)queues, (void)separation, (void)n, (void)record_a, (void)record_b;
    mark_overlaps(call, queue, k, which);
}

static const struct search overlaps = {OVERLAP_FIELDS, false, judge_overlap_along_axis, judge_overlap, settle_overlap};

static void probe_overlaps(const struct call *call, struct queue *queues, int begin) {
    probe_axis(&overlaps, call, queues, begin);
}

static void probe_overlaps_again(const struct call *call, struct queue *queues, int begin) {
    probe_again(&overlaps, call, queues, begin);
}

static void climb_overlaps(const struct call *call, struct queue *queues, int begin) {
    climb_from(&overlaps, call, queues, begin);
}

static void decide_overlaps(const struct call *call, struct queue *queues, int begin) {
    const struct queue *const queue = &queues[DECIDE];
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const struct gap gap = find_gap(call->batch->shapes, queue, k, vm_front(queue->count - k), false);
        mark_overlaps(call, queue, k, v_lt(gap.separation, v_set(0)));
    }
}

/* Answers whether the pairs k ... of a queue overlap. */
INLINE void mark_box_overlaps(const struct call *call, const struct box_queue *queue, int k, int live, bool capsules) {
    const struct box_pair pair = {queue, k, capsules};
    const vm open = vm_front(live);
    const struct box_contact c = capsules ? find_capsule_contact(&pair, open) : find_box_contact(&pair, open);
    mark_pairs(call, vi_bits(get_box_field(&pair, BOX_PAIR)), vm_and(open, v_lt(c.separation, v_set(0))));
}

static void answer_box_overlaps(const struct call *call, const struct box_queue *queue, int k, int live) {
    mark_box_overlaps(call, queue, k, live, false);
}

static void answer_capsule_overlaps(const struct call *call, const struct box_queue *queue, int k, int live) {
    mark_box_overlaps(call, queue, k, live, true);
}

static void answer_circle_overlaps(const struct call *call, const struct box_queue *queue, int k, int live) {
    const struct circle_pair pair = load_circle_pairs(queue, k);
    const struct circle_contact c =
        vm_any(pair.sides) ? find_circle_contact(&pair, ANY_CIRCLES) : find_circle_contact(&pair, TWO_CIRCLES);
    mark_pairs(call, find_circle_numbers(queue, k), vm_and(vm_front(live), v_lt(c.separation, v_set(0))));
}

/* All pairs; of those with a piece, which ones are near. */
NOINLINE void find_overlaps(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    static stage *const stages[STAGES] = {NARC_SHORTCUTS ? probe_overlaps : NULL,
                                          NARC_SHORTCUTS ? probe_overlaps_again : NULL,
                                          NARC_SHORTCUTS ? climb_overlaps : NULL, decide_overlaps};
    const struct course course = {.take = NARC_SHORTCUTS ? take_detour : NULL,
                                  .settle = triage_overlaps,
                                  .fields = OVERLAP_FIELDS,
                                  .stages = stages,
                                  .first = NARC_SHORTCUTS ? PROBE : DECIDE,
                                  .edged = NARC_SHORTCUTS ? CLIMB : 0,
                                  .end = STAGES};
    static box_stage *const answers[BOX_QUEUES] = {answer_box_overlaps, answer_capsule_overlaps,
                                                   NARC_CIRCLE_FORMS ? answer_circle_overlaps : NULL};
    struct queue queues[STAGES];
    struct call call = begin_overlaps(batch, first, count, skipped, out_bits);
    struct box_queue boxes[BOX_QUEUES];
    if (NARC_SHORTCUTS && batch->shapes->box_count > 0)
        start_boxes(&call, boxes, answers);
    run_pairs(&call, &course, queues);
    if (NARC_SHORTCUTS && call.boxes)
        end_boxes(&call);
}

void NARC_NAMED(overlap)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    find_overlaps(batch, first, count, skipped, out_bits);
    if (NARC_PIECES && batch->shapes->piece_count > 0)
        decide_piece_overlaps(batch, first, count, out_bits);
}
