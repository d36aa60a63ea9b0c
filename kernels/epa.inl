/* SPDX-License-Identifier: MIT
 *
 * epa.inl - how deep two bodies are in each other: the expanding polytope algorithm (van den Bergen 2001), which section
 * II of "Using Piecewise Circular Curves as a 2D Collision Primitive" puts behind GJK.
 *
 * A polygon inside the difference that holds the origin: how far its nearest edge is from the origin is a lower bound of
 * the depth. The support point along that edge's normal gives an upper bound, the depth along that normal, and splits
 * the edge in two. A curved difference has no last edge: the search ends when the bounds agree within the tolerance,
 * when the nearest edge is one of the difference itself, or after batch->iterations steps.
 *
 * Edges lie in no order; what each needs is its distance.
 */

enum { EDGES = 3 + NARC_ITERATIONS };

/* A normal is that of an edge here if it is this close (radians). The normals that GJK and EPA compute are off by the
 * rounding of support points, over an edge's length. */
#define NEARLY_PARALLEL 0x1p-12f

/* Where a pair brings its triangle: fields that GJK is done with. */
static const int corner_fields[6] = {AXIS_X, AXIS_Y, CORE, SLACK, DIRECTION_X, DIRECTION_Y};

/* The polygon of each lane: edges from p to q, counter-clockwise. The last one is for lanes that write none. */
struct polytope {
    _Alignas(64) float edge[EDGES + 1][V_WIDTH][4];
    float distance[EDGES + 1][V_WIDTH];
    int32_t count[V_WIDTH];
};

/* Puts an edge into slot number `slot` of each lane. */
INLINE void put_edge(struct polytope *p, vi slot, vf p_x, vf p_y, vf q_x, vf q_y) {
    const vf distance = nearest_of(p_x, p_y, q_x, q_y).distance, row[4] = {p_x, p_y, q_x, q_y};
    int32_t place[V_WIDTH];
    float lane_distance[V_WIDTH];
    vi_store(place, slot);
    v_store(lane_distance, distance);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        const int at = place[lane];
        place[lane] = at * V_WIDTH + lane;
        p->distance[at][lane] = lane_distance[lane];
    }
    v_put_rows(p->edge, sizeof p->edge[0][0], place, row);
}

/* In the lanes `fresh`: the triangle that a pair brings. */
INLINE void start_polytope(struct polytope *p, const struct queue *pair, vm fresh) {
    const vf p_x = get(pair, corner_fields[0], 0), p_y = get(pair, corner_fields[1], 0);
    const vf a_x = get(pair, corner_fields[2], 0), a_y = get(pair, corner_fields[3], 0);
    const vf b_x = get(pair, corner_fields[4], 0), b_y = get(pair, corner_fields[5], 0);
    const vm left = v_le(v_set(0), cross(v_sub(a_x, p_x), v_sub(a_y, p_y), v_sub(b_x, p_x), v_sub(b_y, p_y)));
    const vf q_x = v_select(left, a_x, b_x), q_y = v_select(left, a_y, b_y);
    const vf r_x = v_select(left, b_x, a_x), r_y = v_select(left, b_y, a_y);
    const vi spare = vi_set(EDGES);
    put_edge(p, vi_select(fresh, vi_set(0), spare), p_x, p_y, q_x, q_y);
    put_edge(p, vi_select(fresh, vi_set(1), spare), q_x, q_y, r_x, r_y);
    put_edge(p, vi_select(fresh, vi_set(2), spare), r_x, r_y, p_x, p_y);
    vi_store(p->count, vi_select(fresh, vi_set(3), vi_load(p->count)));
}

/* The edge that is nearest to the origin in each lane, of the first among equals. */
INLINE vi find_nearest_edge(const struct polytope *p, vf *out_distance) {
    const vi count = vi_load(p->count);
    vf least = v_set(INFINITY);
    vi slot = vi_set(0);
    for (int i = 0; vm_any(vi_lt(vi_set(i), count)); i++) {
        const vf distance = v_load(p->distance[i]);
        const vm nearer = vm_and(vi_lt(vi_set(i), count), v_lt(distance, least));
        least = v_select(nearer, distance, least);
        slot = vi_select(nearer, vi_set(i), slot);
    }
    *out_distance = least;
    return slot;
}

INLINE vm is_near(vf a_x, vf a_y, vf b_x, vf b_y, vf distance) {
    return vm_and(v_le(v_abs(v_sub(a_x, b_x)), distance), v_le(v_abs(v_sub(a_y, b_y)), distance));
}

/* The state of the search in each lane. */
struct expansion {
    vi slot;     /* of the nearest edge */
    vf distance; /* of that from the origin: the depth is at least that */
    struct gap best;
};

/* One step in every lane: splits the nearest edge. `stuck`: bad reasons to end. */
INLINE struct verdict step_expansion(const narc_batch *batch, const struct lanes *lanes, struct polytope *p,
                                     struct expansion *e, float enough) {
    const vi age = vi_load(lanes->age);
    const vm busy = vi_lt(vi_set(-1), age), fresh = vm_and(busy, vi_lt(age, vi_set(1)));
    if (vm_any(fresh)) {
        start_polytope(p, &lanes->pair, fresh);
        e->slot = find_nearest_edge(p, &e->distance);
    }
    int32_t place[V_WIDTH];
    vf edge[4];
    vi_store(place, e->slot);
    for (int lane = 0; lane < V_WIDTH; lane++)
        place[lane] = place[lane] * V_WIDTH + lane;
    v_rows(p->edge, sizeof p->edge[0][0], place, edge);
    const vf p_x = edge[0], p_y = edge[1], q_x = edge[2], q_y = edge[3];
    /* The outward normal, (d_y, -d_x), and from A to B is the other way. */
    const struct support w = find_support(batch->shapes, &lanes->pair, 0, v_sub(p_y, q_y), v_sub(q_x, p_x));
    keep_best(&e->best, &w, fresh);
    const vm final = vm_or(is_near(w.w_x, w.w_y, p_x, p_y, w.noise), is_near(w.w_x, w.w_y, q_x, q_y, w.noise));

    const vi spare = vi_set(EDGES), count = vi_load(p->count);
    const vm splits = vm_and_not(busy, final);
    put_edge(p, vi_select(splits, e->slot, spare), p_x, p_y, w.w_x, w.w_y);
    put_edge(p, vi_select(splits, count, spare), w.w_x, w.w_y, q_x, q_y);
    vi_store(p->count, vi_select(splits, vi_add(count, vi_set(1)), count));
    e->slot = find_nearest_edge(p, &e->distance);

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
                       struct results *out) {
    struct lanes lanes;
    struct polytope polytope;
    const vf zero = v_set(0);
    struct expansion e = {vi_set(0), zero, {zero, zero, zero, v_set(1), vi_set(0), vi_set(0)}};
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
        file_gap(batch->shapes, &lanes.pair, 0, done, &gap, margin, NEARLY_PARALLEL, out);
    }
}
