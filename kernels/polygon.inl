/* SPDX-License-Identifier: MIT
 *
 * polygon.inl - the separating axis test of two convex polygons over the edge normals of both (Algorithm 3 of "Using
 * Piecewise Circular Curves as a 2D Collision Primitive", its indices put right).
 *
 * Along the normal n of A's edge before vertex i the gap is the least of n.(b_j - a_i) over B's vertices b_j; along
 * that of an edge of B, whose normals are stored pointing from A to B, the least of n.(b_j - a_i) over A's vertices.
 * The separation is the largest of all gaps. A lane is done when one reaches `enough`.
 */

/* The gap along edge normal i of one polygon against all vertices of the other; `sign` is 1 where the edge is A's. */
INLINE vf gap_of_edge(const struct arc_lists *own, const struct arc_lists *other, int i, float sign) {
    const vf n_x = v_mul(v_set(sign), v_load(own->start_x[i])), n_y = v_mul(v_set(sign), v_load(own->start_y[i]));
    vf least = v_set(INFINITY);
    for (int j = 0; j < other->most; j++) {
        const vf height = dot(v_load(other->x[j]), v_load(other->y[j]), n_x, n_y);
        least = v_select(vi_lt(vi_set(j), other->count), v_min(least, height), least);
    }
    return v_sub(least, dot(v_load(own->x[i]), v_load(own->y[i]), n_x, n_y));
}

/* The largest gap of the pairs k ... of a queue, or one that is at least `enough`; its arcs are not looked for. */
INLINE struct gap polygon_gap(const narc_shapes *shapes, const struct queue *q, int k, vm live, float enough,
                              struct arc_lists *a, struct arc_lists *b) {
    struct gap best = {v_set(-INFINITY), v_set(1), v_set(0), v_set(1), vi_set(0), vi_set(0)};
    list_arcs(shapes, q, k, false, a);
    list_arcs(shapes, q, k, true, b);
    for (int side = 0; side < 2; side++) {
        const struct arc_lists *own = side ? b : a, *other = side ? a : b;
        for (int i = 0; i < own->most; i++) {
            const vm open = vm_and(live, v_lt(best.separation, v_set(enough)));
            if (!vm_any(open))
                break;
            const vf gap = gap_of_edge(own, other, i, side ? -1 : 1);
            const vm better = vm_and(vm_and(open, vi_lt(vi_set(i), own->count)), v_lt(best.separation, gap));
            best.separation = v_select(better, gap, best.separation);
            best.n_x = v_select(better, v_load(own->start_x[i]), best.n_x);
            best.n_y = v_select(better, v_load(own->start_y[i]), best.n_y);
        }
    }
    return best;
}

/* Of two edges that are parallel but for rounding, the support vertex of one may be its far end, beside the other. Then
 * they touch at the end of the longer stretch. */
INLINE void move_together(struct touch *a, struct touch *b) {
    const vm a_longer = v_lt(v_sub(b->along_max, b->along_min), v_sub(a->along_max, a->along_min));
    const vm b_above = v_lt(a->along_max, b->along_min), a_above = v_lt(b->along_max, a->along_min);
    const vf low = v_select(a_longer, a->along_max, b->along_min),
             high = v_select(a_longer, a->along_min, b->along_max);
    a->along_max = v_select(b_above, low, a->along_max);
    b->along_min = v_select(b_above, low, b->along_min);
    a->along_min = v_select(a_above, high, a->along_min);
    b->along_max = v_select(a_above, high, b->along_max);
}

static void mark_polygons(const narc_batch *batch, size_t first, struct queue *q, uint64_t *out_bits) {
    struct arc_lists a, b;
    (void)first;
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct gap gap = polygon_gap(batch->shapes, q, k, live, 0, &a, &b);
        mark(q, k, vm_and(live, v_lt(gap.separation, v_set(0))), out_bits);
    }
}

static void find_polygons(const narc_batch *batch, size_t first, struct queue *q, float margin, struct results *out) {
    const narc_record *records = batch->shapes->records;
    struct arc_lists a, b;
    (void)first;
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct gap gap = polygon_gap(batch->shapes, q, k, live, margin, &a, &b);
        const vm keep = vm_and(live, closer_than(gap.separation, margin));
        if (!vm_any(keep))
            continue;
        const struct support s = find_support(batch->shapes, q, k, live, gap.n_x, gap.n_y);
        const struct pose pose = get_pose(q, k);
        struct touch on_a = touch_of(records, a.ring, s.record_a, &pose, gap.n_x, gap.n_y, false);
        struct touch on_b = touch_of(records, b.ring, s.record_b, &pose, gap.n_x, gap.n_y, true);
        move_together(&on_a, &on_b);
        file_contacts(q, k, keep, gap.separation, gap.n_x, gap.n_y, &on_a, &on_b, out);
    }
}

static void overlap_polygon(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    overlap_by(mark_polygons, batch, first, count, out_bits);
}

static size_t contact_polygon(const narc_batch *batch, size_t first, size_t count, float margin,
                              const narc_contacts *out) {
    return contact_by(find_polygons, batch, first, count, margin, out);
}
