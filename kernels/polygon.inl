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

/* The largest gap of the pairs k ... of a queue, or one that is at least `enough`; the arcs are not set. */
static struct gap polygon_gap(const narc_shapes *shapes, const struct queue *q, int k, vm live, float enough,
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
    struct arc_lists a, b;
    (void)first;
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        struct gap gap = polygon_gap(batch->shapes, q, k, live, margin, &a, &b);
        /* The cones say which vertices lie on the support lines; of edges that are parallel but for rounding either
         * end may, hence file_loosely(). */
        const struct support support = find_support(batch->shapes, q, k, gap.n_x, gap.n_y);
        gap.record_a = support.record_a;
        gap.record_b = support.record_b;
        const vf loose = v_mul(v_set(NOISE_OF_EDGES), support.noise);
        file_loosely(batch->shapes, q, k, live, &gap, margin, loose, out);
    }
}

static void overlap_polygon(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    overlap_by(mark_polygons, batch, first, count, out_bits);
}

static size_t contact_polygon(const narc_batch *batch, size_t first, size_t count, float margin,
                              const narc_contacts *out) {
    return contact_by(find_polygons, batch, first, count, margin, out);
}
