/* SPDX-License-Identifier: MIT
 *
 * first.inl - Algorithm 2 of "Using Piecewise Circular Curves as a 2D Collision Primitive", as its text reads: the
 * first pair of arcs that passes the test decides.
 *
 * With u from the centre of arc i of A to that of arc j of B: u must lie in the cone of arc i, -u in that of arc j,
 * each closed at its start and open at its end, and u must point along the vector between the centroids. Pairs are
 * taken in the caller's order, i outside, j inside; a lane leaves the loop with its first pair. Where this is wrong is
 * told in narc_methods.h.
 */

/* Does u, which lies in the closed cone from start to end, lie in the one without its end? In a cone of half a turn
 * both are on one line. */
INLINE vm in_cone(vf start_x, vf start_y, vf end_x, vf end_y, vf u_x, vf u_y) {
    const vf zero = v_set(0), after = cross(start_x, start_y, u_x, u_y);
    const vm at_start = vm_and(v_le(after, zero), v_lt(zero, dot(start_x, start_y, u_x, u_y)));
    return vm_or(v_lt(zero, cross(u_x, u_y, end_x, end_y)), at_start);
}

/* The separation of the pairs k ... of a queue by the first pair of arcs that passes; +infinity, and `out_found` false,
 * where none does. */
INLINE struct gap first_gap(const narc_shapes *shapes, const struct queue *q, int k, vm live, struct arc_lists *a,
                            struct arc_lists *b, vm *out_found) {
    const vf zero = v_set(0), tiny = v_set(0x1p-126f);
    vf item[FIELDS];
    get_item(q, k, item, FIELDS);
    const struct boxes boxes = load_boxes(shapes, item);
    const vf c_x = v_sub(boxes.b.centroid_x, boxes.a.centroid_x), c_y = v_sub(boxes.b.centroid_y, boxes.a.centroid_y);
    struct gap best = {v_set(INFINITY), v_set(1), zero, v_set(1), vi_set(0), vi_set(0)};
    vi arc_a = vi_set(0), arc_b = vi_set(0);
    vm open = live;
    list_arcs(shapes, q, k, false, a);
    list_arcs(shapes, q, k, true, b);
    for (int i = 0; i < a->most && vm_any(open); i++) {
        const vf a_x = v_load(a->x[i]), a_y = v_load(a->y[i]), radius = v_load(a->radius[i]);
        const vf start_x = v_load(a->start_x[i]), start_y = v_load(a->start_y[i]);
        const vf end_x = v_load(a->start_x[i + 1]), end_y = v_load(a->start_y[i + 1]);
        for (int j = 0; j < b->most; j++) {
            const vf u_x = v_sub(v_load(b->x[j]), a_x), u_y = v_sub(v_load(b->y[j]), a_y);
            const vm in_a =
                vm_and(v_le(zero, cross(start_x, start_y, u_x, u_y)), v_le(zero, cross(u_x, u_y, end_x, end_y)));
            const vf b_start_x = v_load(b->start_x[j]), b_start_y = v_load(b->start_y[j]);
            const vf b_end_x = v_load(b->start_x[j + 1]), b_end_y = v_load(b->start_y[j + 1]);
            const vm in_b = vm_and(v_le(zero, cross(b_start_x, b_start_y, u_x, u_y)),
                                   v_le(zero, cross(u_x, u_y, b_end_x, b_end_y)));
            const vm facing = v_lt(zero, dot(u_x, u_y, c_x, c_y));
            const vm exists = vm_and(vi_lt(vi_set(i), a->count), vi_lt(vi_set(j), b->count));
            const vm may = vm_and(vm_and(open, exists), vm_and(vm_and(in_a, in_b), facing));
            if (!vm_any(may))
                continue;
            const vm passes = vm_and(may, vm_and(in_cone(start_x, start_y, end_x, end_y, u_x, u_y),
                                                 in_cone(b_start_x, b_start_y, b_end_x, b_end_y, u_x, u_y)));
            const vf u2 = dot(u_x, u_y, u_x, u_y), length = v_sqrt(v_max(u2, tiny));
            best.separation = v_select(passes, v_sub(length, v_add(radius, v_load(b->radius[j]))), best.separation);
            best.n_x = v_select(passes, u_x, best.n_x);
            best.n_y = v_select(passes, u_y, best.n_y);
            best.n_length = v_select(passes, length, best.n_length);
            arc_a = vi_select(passes, vi_set(i), arc_a);
            arc_b = vi_select(passes, vi_set(j), arc_b);
            open = vm_and_not(open, passes);
            if (!vm_any(open))
                break;
        }
    }
    best.record_a = record_of(a, arc_a);
    best.record_b = record_of(b, arc_b);
    *out_found = vm_and_not(live, open);
    return best;
}

static void mark_first(const narc_batch *batch, size_t first, struct queue *q, uint64_t *out_bits) {
    struct arc_lists a, b;
    for (int k = 0; k < q->count; k += V_WIDTH) {
        vm found;
        const vm live = vm_first(q->count - k);
        const struct gap gap = first_gap(batch->shapes, q, k, live, &a, &b, &found);
        mark(q, k, vm_and(found, v_lt(gap.separation, v_set(0))), out_bits);
        note_outcome(batch, first, q, k, vm_and_not(live, found), NARC_OUTCOME_NONE);
    }
}

/* Where every pair is to have an item: those of the pairs k ... of a queue that have no answer. */
INLINE void file_without(const struct queue *q, int k, vm none, struct results *out) {
    int32_t pair[V_WIDTH];
    vi_store(pair, get_bits(q, PAIR, k));
    for (uint32_t bits = vm_bits(none); bits; bits &= bits - 1)
        file_none(pair[__builtin_ctz(bits)], out);
}

static void find_first(const narc_batch *batch, size_t first, struct queue *q, float margin, struct results *out) {
    struct arc_lists a, b;
    for (int k = 0; k < q->count; k += V_WIDTH) {
        vm found;
        const vm live = vm_first(q->count - k);
        const struct gap gap = first_gap(batch->shapes, q, k, live, &a, &b, &found);
        file_gap(batch->shapes, q, k, found, &gap, margin, out);
        note_outcome(batch, first, q, k, vm_and_not(live, found), NARC_OUTCOME_NONE);
        if (margin == INFINITY)
            file_without(q, k, vm_and_not(live, found), out);
    }
}

static void overlap_first(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    overlap_by(mark_first, batch, first, count, out_bits);
}

static size_t contact_first(const narc_batch *batch, size_t first, size_t count, float margin,
                            const narc_contacts *out) {
    return contact_by(find_first, batch, first, count, margin, out);
}
