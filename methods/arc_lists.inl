/* SPDX-License-Identifier: MIT
 *
 * arc_lists.inl - all arcs of two bodies, for methods that look at every pair of arcs or edges.
 */
#ifndef NARC_METHODS_ARC_LISTS_INL
#define NARC_METHODS_ARC_LISTS_INL

#include <stdbool.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* All arcs of a shape in each lane, in the caller's order, as struct arcs has them; arc number `count` is arc 0 again,
 * so that arc i ends where arc i + 1 starts. */
struct arc_list {
    _Alignas(64) float x[NARC_MAX_ARCS][V_WIDTH], y[NARC_MAX_ARCS][V_WIDTH], radius[NARC_MAX_ARCS][V_WIDTH];
    float start_x[NARC_MAX_ARCS + 1][V_WIDTH], start_y[NARC_MAX_ARCS + 1][V_WIDTH];
    int most;         /* arcs in any lane */
    vi count, record; /* arcs in each lane, and the record of arc 0 */
    struct ring ring;
};

INLINE vec2 list_center(const struct arc_list *list, int i) { return (vec2){v_load(list->x[i]), v_load(list->y[i])}; }

INLINE vec2 list_start(const struct arc_list *list, int i) {
    return (vec2){v_load(list->start_x[i]), v_load(list->start_y[i])};
}

static inline void list_arcs(const narc_shapes *shapes, const struct queue *queue, int k, bool is_b,
                             struct arc_list *out) {
    const struct pose pose = get_pose(queue, k);
    const vi info = get_bits(queue, is_b ? INFO_B : INFO_A, k), one = vi_set(1);
    out->ring = is_b ? get_ring_b(queue, k) : get_ring_a(queue, k);
    out->count = out->ring.count;
    /* The caller's arc 0 lies `first_arc` places before the end of the ring. */
    const vi first_arc = get_first_arc(info);
    vi record = vi_add(out->ring.base, vi_sub(out->count, first_arc));
    record = vi_select(vi_lt(vi_set(0), first_arc), record, out->ring.base);
    out->record = record;
    for (int i = 0; i <= NARC_MAX_ARCS; i++) {
        const struct arcs arc = load_arcs(shapes->records, record, &pose, is_b);
        v_store(out->start_x[i], arc.start.x);
        v_store(out->start_y[i], arc.start.y);
        out->most = i;
        if (!vm_any(vi_lt(vi_set(i), out->count)))
            break;
        v_store(out->x[i], arc.center.x);
        v_store(out->y[i], arc.center.y);
        v_store(out->radius[i], arc.radius);
        record = step_record(out->ring, record, one);
    }
}

/* The record of the caller's arc `number`. */
INLINE vi find_record(const struct arc_list *list, vi number) {
    const vi record = vi_add(list->record, number), end = vi_add(list->ring.base, list->count);
    return vi_select(vi_lt(record, end), record, vi_sub(record, list->count));
}

#endif
