/* SPDX-License-Identifier: MIT
 *
 * overlap.c - the overlap kernel: one bit per pair, set where the separation is below 0.
 *
 * Circles settle some pairs, and two probes most others: one along the axis between the inscribed circles, and one
 * along u of the arcs that the first one found. A probe ends with a proof (certificates.inl) that the bodies are apart
 * or have a common point, or passes the pair on. The rest climb to a local maximum of the gap; of polygons with few
 * corners it is computed at all junctions. What is left then goes to the deciding formula.
 */
/* With a queue less there is room for more pairs in each. */
#define NARC_FEW_STAGES

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/pipeline.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_detour.inl"
#include "box/box_pairs.inl"
#include "box/box_walk.inl"
#include "box/capsules.inl"
#include "kernels.h"
#include "piece/overlaps.inl"
#include "polygon/polygon_edges.inl"
#include "sat/arc_lookup.inl"
#include "sat/certificates.inl"
#include "sat/normal_fan.inl"
#include "sat/search.inl"
#include "simd/simd.h"

INLINE vm triage_overlaps(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
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

/* That of stores with pieces where all else goes to the formula. */
INLINE vm triage_piece_overlaps(const struct call *call, size_t pair, const struct filter *circles,
                                const vf item[FIELDS]) {
    return take_pieces(call, pair, circles->valid, item);
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

/* Passes on the pairs k ... of a queue in the lanes `left`. */
INLINE void pass_on_overlaps(const struct queue *queue, int k, vm left, struct queue *next) {
    vf item[FIELDS];
    if (!vm_any(left))
        return;
    get_item(queue, k, item, OVERLAP_FIELDS);
    push(next, left, item, OVERLAP_FIELDS);
}

/* The difference of the support points of two arcs along DIRECTION n, times the length of n. */
INLINE vm touch_in_common(const struct queue *queue, int k, vec2 n, vec2 u, vf radii) {
    const vf length = v2_length(n);
    return has_common_point(queue, k, v2_sub(v2_scale(n, radii), v2_scale(u, length)), length);
}

/* What a probe along DIRECTION tells, in each lane. */
struct overlap_probe {
    vec2 u;
    vm apart, hit;
};

/* Tells by centres and radii alone. */
INLINE struct overlap_probe probe_circles(const narc_record *records, const struct queue *queue, int k, vec2 n) {
    vf radii;
    const vec2 u = load_circles(records, queue, k, &radii);
    return (struct overlap_probe){u, is_above(u, radii, n, find_lookup_slack(queue, k)),
                                  touch_in_common(queue, k, n, u, radii)};
}

/* Tells by whole arcs. */
INLINE struct overlap_probe probe_whole_arcs(const narc_record *records, const struct queue *queue, int k, vec2 n,
                                             vm live) {
    const struct probe p = probe_arcs(records, queue, k, live, v_set(0));
    const vm below = v_lt(p.separation, v_set(0)), above = is_above(p.u, p.radii, n, find_lookup_slack(queue, k));
    return (struct overlap_probe){p.u, vm_or(vm_or(p.far, above), vm_and_not(p.only, below)),
                                  vm_or(touch_in_common(queue, k, n, p.u, p.radii), vm_and(p.only, below))};
}

/* Stages that others pass pairs on to. */
enum { CLIMB = 2, DECIDE = 4 };

/* Probes along the axis. Smooth pairs are probed along u next. Near edges u leads astray: other pairs climb. Circles
 * settle what overlaps deeply or is well apart. Once they leave more than half of a vector, as among bodies that rest
 * on each other, whole arcs are worth their price for the rest of a block. */
static void probe_axis_overlaps(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    const narc_record *records = call->batch->shapes->records;
    look_up_arcs(records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k), smooth = find_smooth(queue, k);
        const vec2 n = get_vec2(queue, DIRECTION, k);
        const struct overlap_probe p =
            queue->whole ? probe_whole_arcs(records, queue, k, n, live) : probe_circles(records, queue, k, n);
        mark_overlaps(call, queue, k, vm_and(live, p.hit));
        const vm left = vm_and_not(live, vm_or(p.apart, p.hit));
        if (!queue->whole)
            queue->whole = 2 * COUNT_BITS(vm_bits(vm_and(left, smooth))) > V_WIDTH;
        store_vec2(queue, DIRECTION, k, v2_select(smooth, p.u, n));
        pass_on_overlaps(queue, k, vm_and(left, smooth), next);
        const vm edged = vm_and_not(left, smooth), polygons = select_polygons(queue, k, edged);
        pass_on_overlaps(queue, k, vm_and_not(edged, polygons), queue + CLIMB);
        pass_on_overlaps(queue, k, polygons, queue + POLYGONS);
        count_edged(queue, vm_and_not(live, smooth), vm_and_not(left, smooth));
    }
}

/* Probes along u, with whole arcs. */
static void probe_again_overlaps(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    const narc_record *records = call->batch->shapes->records;
    look_up_arcs(records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct overlap_probe p = probe_whole_arcs(records, queue, k, get_vec2(queue, DIRECTION, k), live);
        mark_overlaps(call, queue, k, vm_and(live, p.hit));
        store_vec2(queue, DIRECTION, k, p.u);
        pass_on_overlaps(queue, k, vm_and_not(live, vm_or(p.apart, p.hit)), next);
    }
}

/* Climbs from the arcs that hold DIRECTION. */
static void climb_from_overlaps(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    (void)next;
    const narc_record *records = call->batch->shapes->records;
    look_up_arcs(records, queue, begin, false);
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct certified_maximum top = climb_and_certify(records, queue, k, live, v_set(0));
        mark_overlaps(call, queue, k, vm_and(top.certain, v_lt(top.separation, v_set(0))));
        pass_on_overlaps(queue, k, vm_and_not(live, vm_or(top.apart, top.certain)), queue + (DECIDE - CLIMB));
    }
}

/* Polygons: the largest gap at a junction has the answer's sign, if it is not 0 up to rounding. */
static void compare_polygon_overlaps(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const vf best = find_polygon_edge(call->batch->shapes->records, queue, k, false).best.gap,
                 slack = get(queue, SLACK, k);
        const vm deep = v_lt(best, v_neg(slack)), apart = v_lt(slack, best);
        mark_overlaps(call, queue, k, vm_and(live, deep));
        pass_on_overlaps(queue, k, vm_and_not(live, vm_or(deep, apart)), next);
    }
}

static void decide_overlaps(const struct call *call, struct queue *queue, int begin, struct queue *next) {
    (void)next;
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

static box_stage *const overlap_detours[BOX_QUEUES] = {answer_box_overlaps, answer_capsule_overlaps};

INLINE vm detour_overlaps(const struct call *call, const struct pair_indices *indices, int k,
                          const struct placement *placement, vm open, int32_t number) {
    return take_detour(call, indices, k, placement, open, number, overlap_detours);
}

/* All pairs; of those with a piece, which ones are near. */
NOINLINE void find_overlaps(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    static stage *const stages[] = {probe_axis_overlaps, probe_again_overlaps, climb_from_overlaps,
                                    compare_polygon_overlaps, decide_overlaps};
    struct queue queues[STAGES];
    struct call call = begin_overlaps(batch, first, count, skipped, out_bits);
    struct box_queue boxes[BOX_QUEUES];
    if (!NARC_SHORTCUTS) {
        run_pairs(&call, NULL, call.pieces ? triage_piece_overlaps : take_valid, OVERLAP_FIELDS, &stages[DECIDE], 1, 0,
                  queues);
    } else if (batch->shapes->box_count == 0) {
        run_pairs(&call, NULL, triage_overlaps, OVERLAP_FIELDS, stages, STAGES, CLIMB, queues);
    } else {
        start_boxes(&call, boxes);
        run_pairs(&call, detour_overlaps, triage_overlaps, OVERLAP_FIELDS, stages, STAGES, CLIMB, queues);
        end_boxes(&call, overlap_detours);
    }
}

void NARC_NAMED(overlap)(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    find_overlaps(batch, first, count, skipped, out_bits);
    if (NARC_PIECES && batch->shapes->piece_count > 0)
        decide_piece_overlaps(batch, first, count, out_bits);
}
