/* SPDX-License-Identifier: MIT
 *
 * epa.inl - how deep two bodies are in each other: the expanding polytope algorithm (van den Bergen 2001), which
 * section II of "Using Piecewise Circular Curves as a 2D Collision Primitive" puts behind GJK.
 *
 * A polygon inside the difference that holds the origin: how far its nearest edge is from the origin is a lower bound
 * of the depth. The support point along that edge's normal gives an upper bound, the depth along that normal, and
 * splits the edge in two. A curved difference has no last edge: the search ends when the bounds agree within the
 * tolerance, when the nearest edge is one of the difference itself, or after batch->iterations steps.
 *
 * Edges lie in no order; what each needs is its distance.
 */

enum { EDGES = 3 + NARC_ITERATIONS };

/* Where a pair brings its triangle: fields that GJK is done with. */
static const int corner_fields[6] = {AXIS_X, AXIS_Y, CORE, SLACK, DIRECTION_X, DIRECTION_Y};

/* The polygon of each lane: edges from p to q, counter-clockwise. The last one is for lanes that write none. */
struct polytope {
    _Alignas(64) float edge[EDGES + 1][V_WIDTH][4];
    _Alignas(64) float distance[EDGES][V_WIDTH];
    int32_t count[V_WIDTH];
};

/* The state of the search in each lane. */
struct expansion {
    vi slot;     /* of the nearest edge */
    vf distance; /* of that from the origin: the depth is at least that */
    vf noise;    /* of the last support point */
    struct gap best;
};

/* The rows of edges number `slot` of each lane. */
INLINE void rows_of(vi slot, int32_t *out_row) {
    vi_store(out_row, slot);
    for (int lane = 0; lane < V_WIDTH; lane++)
        out_row[lane] = out_row[lane] * V_WIDTH + lane;
}

INLINE void put_edge(struct polytope *p, vi slot, vf p_x, vf p_y, vf q_x, vf q_y) {
    const vf row[4] = {p_x, p_y, q_x, q_y};
    int32_t place[V_WIDTH];
    rows_of(slot, place);
    v_put_rows(p->edge, sizeof p->edge[0][0], place, row);
}

/* In the lanes `fresh`: the triangle that a pair brings. */
INLINE void start_polytope(struct polytope *p, const struct queue *pair, vm fresh, struct expansion *e) {
    const vf p_x = get(pair, corner_fields[0], 0), p_y = get(pair, corner_fields[1], 0);
    const vf a_x = get(pair, corner_fields[2], 0), a_y = get(pair, corner_fields[3], 0);
    const vf b_x = get(pair, corner_fields[4], 0), b_y = get(pair, corner_fields[5], 0);
    const vm left = v_le(v_set(0), cross(v_sub(a_x, p_x), v_sub(a_y, p_y), v_sub(b_x, p_x), v_sub(b_y, p_y)));
    const vf x[4] = {p_x, v_select(left, a_x, b_x), v_select(left, b_x, a_x), p_x};
    const vf y[4] = {p_y, v_select(left, a_y, b_y), v_select(left, b_y, a_y), p_y};
    e->distance = v_select(fresh, v_set(INFINITY), e->distance);
    for (int k = 0; k < 3; k++) {
        const vf distance = nearest_of(x[k], y[k], x[k + 1], y[k + 1]).distance;
        const vm nearer = vm_and(fresh, v_lt(distance, e->distance));
        v_store(p->distance[k], v_select(fresh, distance, v_load(p->distance[k])));
        put_edge(p, vi_select(fresh, vi_set(k), vi_set(EDGES)), x[k], y[k], x[k + 1], y[k + 1]);
        e->slot = vi_select(nearer, vi_set(k), e->slot);
        e->distance = v_select(nearer, distance, e->distance);
    }
    vi_store(p->count, vi_select(fresh, vi_set(3), vi_load(p->count)));
}

INLINE vm is_number(vi number, int k) { return vm_and_not(vi_lt(number, vi_set(k + 1)), vi_lt(number, vi_set(k))); }

/* Splits edge `slot` of the lanes `splits` at w; finds the edge that is nearest to the origin in each lane, the first
 * of equals. Both in one pass over the distances, because a vector that is read after single lanes of it were written
 * is slow. */
INLINE vi split_edge(struct polytope *p, vi slot, vm splits, const vf edge[4], vf w_x, vf w_y, vf *out_distance) {
    const vi old_count = vi_load(p->count), spare = vi_set(EDGES);
    const vi changed = vi_select(splits, slot, spare), added = vi_select(splits, old_count, spare);
    const vi count = vi_select(splits, vi_add(old_count, vi_set(1)), old_count);
    const vf before = nearest_of(edge[0], edge[1], w_x, w_y).distance;
    const vf behind = nearest_of(w_x, w_y, edge[2], edge[3]).distance;
    put_edge(p, changed, edge[0], edge[1], w_x, w_y);
    put_edge(p, added, w_x, w_y, edge[2], edge[3]);
    vi_store(p->count, count);
    vf least = v_set(INFINITY);
    vi nearest = vi_set(0);
    for (int i = 0; vm_any(vi_lt(vi_set(i), count)); i++) {
        vf distance = v_select(is_number(changed, i), before, v_load(p->distance[i]));
        distance = v_select(is_number(added, i), behind, distance);
        v_store(p->distance[i], distance);
        const vm nearer = vm_and(vi_lt(vi_set(i), count), v_lt(distance, least));
        least = v_select(nearer, distance, least);
        nearest = vi_select(nearer, vi_set(i), nearest);
    }
    *out_distance = least;
    return nearest;
}

INLINE vm is_near(vf a_x, vf a_y, vf b_x, vf b_y, vf distance) {
    return vm_and(v_le(v_abs(v_sub(a_x, b_x)), distance), v_le(v_abs(v_sub(a_y, b_y)), distance));
}

/* One step in every lane: splits the nearest edge. `stuck`: bad reasons to end. */
INLINE struct verdict step_expansion(const narc_batch *batch, const struct lanes *lanes, struct polytope *p,
                                     struct expansion *e, float enough) {
    const vi age = vi_load(lanes->age);
    const vm busy = vi_lt(vi_set(-1), age), fresh = vm_and(busy, vi_lt(age, vi_set(1)));
    int32_t place[V_WIDTH];
    vf edge[4];
    if (vm_any(fresh))
        start_polytope(p, &lanes->pair, fresh, e);
    rows_of(e->slot, place);
    v_rows(p->edge, sizeof p->edge[0][0], place, edge);
    /* The outward normal is (d_y, -d_x); from A to B is the other way. */
    const vf m_x = v_sub(edge[1], edge[3]), m_y = v_sub(edge[2], edge[0]);
    const struct support w = find_support(batch->shapes, &lanes->pair, 0, m_x, m_y);
    keep_best(&e->best, &w, fresh);
    e->noise = w.noise;
    const vm final =
        vm_or(is_near(w.w_x, w.w_y, edge[0], edge[1], w.noise), is_near(w.w_x, w.w_y, edge[2], edge[3], w.noise));
    e->slot = split_edge(p, e->slot, vm_and_not(busy, final), edge, w.w_x, w.w_y, &e->distance);

    const vf left = v_sub(v_neg(e->best.separation), e->distance);
    const vf tolerance = v_max(v_mul(v_set(batch->tolerance), get(&lanes->pair, SIZE, 0)), w.noise);
    const vm known = vm_or(v_le(left, tolerance), v_le(v_set(enough), e->best.separation));
    const vm old = vm_and_not(busy, vi_lt(age, vi_set(batch->iterations - 1)));
    struct verdict verdict;
    verdict.collides = vm_and(busy, vm_or(known, final));
    verdict.separate = vm_first(0);
    verdict.limit = vm_and_not(old, verdict.collides);
    verdict.stuck = vm_and_not(verdict.collides, known);
    return verdict;
}

/* The contacts of all pairs of a queue that GJK found to collide. */
static void expand_all(const narc_batch *batch, size_t first, const struct queue *q, float margin,
                       struct queue *finished) {
    struct lanes lanes;
    struct polytope polytope;
    struct expansion e;
    memset(&e, 0, sizeof e);
    memset(polytope.count, 0, sizeof polytope.count);
    start_lanes(&lanes);
    while (fill_lanes(&lanes, q)) {
        struct verdict verdict;
        vm done;
        do {
            verdict = step_expansion(batch, &lanes, &polytope, &e, margin);
            done = vm_or(verdict.collides, verdict.limit);
            end_step(&lanes, done);
        } while (!vm_any(done));
        note_outcome(batch, first, &lanes.pair, 0, verdict.limit, NARC_OUTCOME_LIMIT);
        note_outcome(batch, first, &lanes.pair, 0, verdict.stuck, NARC_OUTCOME_ROUNDING);
        struct gap gap = e.best;
        gap.separation = v_min(gap.separation, v_set(-FLT_MIN)); /* GJK decides whether, EPA how deep */
        finish(&lanes, done, &gap, e.noise, finished);
    }
}
