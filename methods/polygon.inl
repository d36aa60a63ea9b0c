/* SPDX-License-Identifier: MIT
 *
 * polygon.inl - the separating axis test of two convex polygons over the edge normals of both (Algorithm 3 of "Using
 * Piecewise Circular Curves as a 2D Collision Primitive", its indices put right).
 *
 * Along the normal n of A's edge before vertex i the gap is the least of n.(b_j - a_i) over B's vertices b_j; along
 * that of an edge of B, whose normals are stored pointing from A to B, the least of n.(b_j - a_i) over A's vertices.
 * The separation is the largest of all gaps. A lane is done when one reaches the margin.
 */
#ifndef NARC_METHODS_POLYGON_INL
#define NARC_METHODS_POLYGON_INL

#include <math.h>
#include <stdbool.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "methods/arc_lists.inl"
#include "methods/run.inl"
#include "methods/support.inl"
#include "simd/simd.h"

/* The gap along edge normal i of one polygon against all vertices of the other. */
INLINE vf find_edge_gap(const struct arc_list *own, const struct arc_list *other, int i, bool own_is_b) {
    const vec2 n = v2_scale(list_start(own, i), v_set(own_is_b ? -1.0f : 1.0f));
    vf least = v_set(INFINITY);
    for (int j = 0; j < other->most; j++) {
        const vf height = v2_dot(list_center(other, j), n);
        least = v_select(vi_lt(vi_set(j), other->count), v_min(least, height), least);
    }
    return v_sub(least, v2_dot(list_center(own, i), n));
}

/* The largest gap of the pairs k ... of a queue, or one that is at least `enough`, and its normal; not its arcs. */
INLINE struct gap find_polygon_gap(const narc_shapes *shapes, const struct queue *queue, int k, vm live, vf enough) {
    struct gap best = {v_set(-INFINITY), {v_set(1), v_set(0)}, v_set(1), vi_set(0), vi_set(0)};
    struct arc_list lists[2];
    list_arcs(shapes, queue, k, false, &lists[0]);
    list_arcs(shapes, queue, k, true, &lists[1]);
    for (int is_b = 0; is_b < 2; is_b++) {
        const struct arc_list *own = &lists[is_b], *other = &lists[1 - is_b];
        for (int i = 0; i < own->most; i++) {
            const vm open = vm_and(live, v_lt(best.separation, enough));
            if (!vm_any(open))
                break;
            const vf gap = find_edge_gap(own, other, i, is_b);
            const vm better = vm_and(vm_and(open, vi_lt(vi_set(i), own->count)), v_lt(best.separation, gap));
            best.separation = v_select(better, gap, best.separation);
            best.normal = v2_select(better, list_start(own, i), best.normal);
        }
    }
    return best;
}

/* Of two edges that are parallel but for rounding, the support vertex of one may be its far end, beside the other. Then
 * they touch at the end of the longer stretch. */
INLINE void move_together(struct feature *a, struct feature *b) {
    const vm a_longer = v_lt(v_sub(b->along_max, b->along_min), v_sub(a->along_max, a->along_min));
    const vm b_above = v_lt(a->along_max, b->along_min), a_above = v_lt(b->along_max, a->along_min);
    const vf low = v_select(a_longer, a->along_max, b->along_min);
    const vf high = v_select(a_longer, a->along_min, b->along_max);
    a->along_max = v_select(b_above, low, a->along_max);
    b->along_min = v_select(b_above, low, b->along_min);
    a->along_min = v_select(a_above, high, a->along_min);
    b->along_max = v_select(a_above, high, b->along_max);
}

INLINE void store_polygon_contacts(const struct call *call, const struct queue *queue, int k, vm live,
                                   const struct gap *gap) {
    const narc_record *records = call->batch->shapes->records;
    const vm keep = vm_and(live, is_below(gap->separation, get_margins(call, queue, k)));
    if (!vm_any(keep))
        return;
    const vec2 n = gap->normal;
    const struct support s = find_support(call->batch->shapes, queue, k, live, n);
    const struct pose pose = get_pose(queue, k);
    struct feature on_a = find_feature_at(records, get_ring_a(queue, k), s.record_a, &pose, n, false);
    struct feature on_b = find_feature_at(records, get_ring_b(queue, k), s.record_b, &pose, n, true);
    move_together(&on_a, &on_b);
    store_contacts(call, queue, k, keep, gap->separation, n, &on_a, &on_b);
}

static void find_polygons(const struct call *call, struct queue *queue, int begin) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        const vm live = vm_front(queue->count - k);
        const struct gap gap = find_polygon_gap(call->batch->shapes, queue, k, live, get_margins(call, queue, k));
        if (call->bits)
            mark_overlaps(call, queue, k, vm_and(live, v_lt(gap.separation, v_set(0))));
        else
            store_polygon_contacts(call, queue, k, live, &gap);
    }
}

static void overlap_polygon(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_overlap_method(find_polygons, batch, first, count, skipped, out_bits);
}

static size_t contact_polygon(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                              const narc_rows *out) {
    return run_contact_method(find_polygons, batch, first, count, skipped, out);
}

#endif
