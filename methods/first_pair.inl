/* SPDX-License-Identifier: MIT
 *
 * first_pair.inl - Algorithm 2 of "Using Piecewise Circular Curves as a 2D Collision Primitive", as its text reads: the
 * first pair of arcs that passes the test decides.
 *
 * With u from the centre of arc i of A to that of arc j of B: u must lie in the cone of arc i, -u in that of arc j,
 * each closed at its start and open at its end, and u must point along the vector between the centroids. Pairs are
 * taken in the caller's order, i outside, j inside; a lane leaves the loop with its first pair. narc_methods.h tells
 * where this is wrong.
 */
#ifndef NARC_METHODS_FIRST_PAIR_INL
#define NARC_METHODS_FIRST_PAIR_INL

#include <math.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "methods/arc_lists.inl"
#include "methods/boxes.inl"
#include "methods/outcomes.inl"
#include "methods/run.inl"
#include "simd/simd.h"

INLINE vm in_closed_cone(vec2 start, vec2 end, vec2 u) {
    const vf zero = v_set(0);
    return vm_and(v_le(zero, v2_cross(start, u)), v_le(zero, v2_cross(u, end)));
}

/* Does u, which lies in the closed cone from start to end, lie in the one without its end? In a cone of half a turn
 * both are on one line. */
INLINE vm in_half_open_cone(vec2 start, vec2 end, vec2 u) {
    const vf zero = v_set(0);
    const vm at_start = vm_and(v_le(v2_cross(start, u), zero), v_lt(zero, v2_dot(start, u)));
    return vm_or(v_lt(zero, v2_cross(u, end)), at_start);
}

/* Looks at arc i of A and all arcs of B, in the lanes `open`; returns those where none has passed. */
INLINE vm find_partner(const struct arc_list *a, const struct arc_list *b, int i, vec2 between, vm open,
                       struct gap *best, vi *arc_a, vi *arc_b) {
    const vec2 center = list_center(a, i), start = list_start(a, i), end = list_start(a, i + 1);
    const vf radius = v_load(a->radius[i]);
    for (int j = 0; j < b->most; j++) {
        const vec2 u = v2_sub(list_center(b, j), center), b_start = list_start(b, j), b_end = list_start(b, j + 1);
        const vm in_both = vm_and(in_closed_cone(start, end, u), in_closed_cone(b_start, b_end, u));
        const vm facing = v_lt(v_set(0), v2_dot(u, between));
        const vm exists = vm_and(vi_lt(vi_set(i), a->count), vi_lt(vi_set(j), b->count));
        const vm may = vm_and(vm_and(open, exists), vm_and(in_both, facing));
        if (!vm_any(may))
            continue;
        const vm passes = vm_and(may, vm_and(in_half_open_cone(start, end, u), in_half_open_cone(b_start, b_end, u)));
        const vf length = v_sqrt(v_max(v2_dot(u, u), v_set(LEAST_SQUARE)));
        const vf separation = v_sub(length, v_add(radius, v_load(b->radius[j])));
        best->separation = v_select(passes, separation, best->separation);
        best->normal = v2_select(passes, u, best->normal);
        best->length = v_select(passes, length, best->length);
        *arc_a = vi_select(passes, vi_set(i), *arc_a);
        *arc_b = vi_select(passes, vi_set(j), *arc_b);
        open = vm_and_not(open, passes);
        if (!vm_any(open))
            break;
    }
    return open;
}

/* The separation of the pairs k ... of a queue by the first pair of arcs that passes; +infinity, and `out_found` false,
 * where none does. */
INLINE struct gap find_first_gap(const narc_shapes *shapes, const struct queue *queue, int k, vm live, vm *out_found) {
    vf item[FIELDS];
    get_item(queue, k, item, FIELDS);
    const struct boxes boxes = load_boxes(shapes, item);
    const vec2 between = v2_sub(boxes.b.centroid, boxes.a.centroid);
    struct gap best = {v_set(INFINITY), {v_set(1), v_set(0)}, v_set(1), vi_set(0), vi_set(0)};
    struct arc_list a, b;
    vi arc_a = vi_set(0), arc_b = vi_set(0);
    vm open = live;
    list_arcs(shapes, queue, k, false, &a);
    list_arcs(shapes, queue, k, true, &b);
    for (int i = 0; i < a.most && vm_any(open); i++)
        open = find_partner(&a, &b, i, between, open, &best, &arc_a, &arc_b);
    best.record_a = find_record(&a, arc_a);
    best.record_b = find_record(&b, arc_b);
    *out_found = vm_and_not(live, open);
    return best;
}

/* Stores the contacts of the lanes `found` whose gap is below the margin. */
INLINE void store_first_gap(const struct call *call, const struct queue *queue, int k, vm found,
                            const struct gap *gap) {
    const vm keep = vm_and(found, is_below(gap->separation, get_margins(call, queue, k)));
    if (!vm_any(keep))
        return;
    const narc_record *records = call->batch->shapes->records;
    const struct pose pose = get_pose(queue, k);
    const vec2 n = v2_divide(gap->normal, gap->length);
    const struct feature on_a = find_feature_at(records, get_ring_a(queue, k), gap->record_a, &pose, n, false);
    const struct feature on_b = find_feature_at(records, get_ring_b(queue, k), gap->record_b, &pose, n, true);
    store_contacts(call, queue, k, keep, gap->separation, n, &on_a, &on_b);
}

static void find_first_pairs(const struct call *call, struct queue *queue, int begin) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        vm found;
        const vm live = vm_front(queue->count - k);
        const struct gap gap = find_first_gap(call->batch->shapes, queue, k, live, &found);
        const vm none = vm_and_not(live, found);
        note_outcome(call, queue, k, none, NARC_OUTCOME_NONE);
        if (call->bits) {
            mark_overlaps(call, queue, k, vm_and(found, v_lt(gap.separation, v_set(0))));
        } else {
            store_first_gap(call, queue, k, found, &gap);
            put_no_answer(call, get_bits(queue, PAIR, k), none);
        }
    }
}

static void overlap_first(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_overlap_method(find_first_pairs, batch, first, count, skipped, out_bits);
}

static size_t contact_first(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                            const narc_rows *out) {
    return run_contact_method(find_first_pairs, batch, first, count, skipped, out);
}

#endif
