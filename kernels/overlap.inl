/* SPDX-License-Identifier: MIT
 *
 * overlap.inl - the overlap kernel: one bit per pair, set where the separation is below 0.
 *
 * Circles settle some pairs, two looks most others: one along the axis between the inscribed circles, and one along u
 * of the arcs that the first one found. A look ends with a proof (proof.inl) that the bodies are apart or have a common
 * point, or passes the pair on. The rest climb to a local maximum of the gap. What is left then goes to the deciding
 * formula.
 */

/* Sets the bits of the pairs k ... of a queue that `hits` says. */
INLINE void mark(const struct queue *q, int k, vm hits, uint64_t *out_bits) {
    int32_t pair[V_WIDTH];
    vi_store(pair, get_bits(q, PAIR, k));
    for (uint32_t bits = vm_bits(hits); bits; bits &= bits - 1) {
        const uint32_t number = (uint32_t)pair[__builtin_ctz(bits)];
        out_bits[number / 64] |= (uint64_t)1 << number % 64;
    }
}

/* Notes an outcome of the pairs k ... of a queue, in those lanes that `which` says. */
INLINE void note_outcome(const narc_batch *batch, size_t first, const struct queue *q, int k, vm which, int outcome) {
    int32_t pair[V_WIDTH];
    if (!batch->outcomes || !vm_any(which))
        return;
    vi_store(pair, get_bits(q, PAIR, k));
    for (uint32_t bits = vm_bits(which); bits; bits &= bits - 1)
        batch->outcomes[first + (uint32_t)pair[__builtin_ctz(bits)]] = (uint8_t)outcome;
}

/* Looks at the pairs first ... of a queue along DIRECTION and takes them out; those that it does not
 * settle go to `undecided`, with the direction to look along next. */
INLINE void look_for_overlaps(const narc_shapes *shapes, struct queue *q, int first, struct queue *undecided,
                              uint64_t *out_bits) {
    look_up(shapes, q, first, false);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct pose p = get_pose(q, k);
        vf a[4], b[4]; /* centres and radii */
        v_rows(shapes->records, sizeof(narc_record), q->record_a + k, a);
        v_rows(shapes->records, sizeof(narc_record), q->record_b + k, b);
        const vf b_x = v_sub(v_mul(p.q_c, b[0]), v_mul(p.q_s, b[1]));
        const vf b_y = v_add(v_mul(p.q_s, b[0]), v_mul(p.q_c, b[1]));
        const vf u_x = v_sub(v_add(p.t_x, v_mul(p.scale_b, b_x)), v_mul(p.scale_a, a[0]));
        const vf u_y = v_sub(v_add(p.t_y, v_mul(p.scale_b, b_y)), v_mul(p.scale_a, a[1]));
        const vf radii = v_add(v_mul(p.scale_a, a[2]), v_mul(p.scale_b, b[2]));
        const vf n_x = get(q, DIRECTION_X, k), n_y = get(q, DIRECTION_Y, k), length = v_sqrt(dot(n_x, n_y, n_x, n_y));
        const vm apart = is_above(u_x, u_y, radii, n_x, n_y, apart_slack(q, k));
        /* The difference of the support points, times the direction's length. */
        const vf p_x = v_sub(v_mul(radii, n_x), v_mul(length, u_x));
        const vf p_y = v_sub(v_mul(radii, n_y), v_mul(length, u_y));
        const vm hit = has_common_point(q, k, p_x, p_y, length);
        mark(q, k, vm_and(live, hit), out_bits);
        const vm left = vm_and_not(live, vm_or(apart, hit));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item, OVERLAP_FIELDS);
            item[DIRECTION_X] = u_x;
            item[DIRECTION_Y] = u_y;
            push(undecided, left, item, OVERLAP_FIELDS);
        }
    }
    q->count = first;
}

/* Climbs with the pairs first ... of a queue, along DIRECTION, and takes them out; those whose maximum is not known to
 * be the highest go to `undecided`. */
static void climb_to_overlaps(const narc_shapes *shapes, struct queue *q, int first, struct queue *undecided,
                              uint64_t *out_bits) {
    look_up(shapes, q, first, false);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct top top = climb_to_top(shapes, q, k, live, 0);
        mark(q, k, vm_and(top.sure, v_lt(top.separation, v_set(0))), out_bits);
        const vm left = vm_and_not(live, vm_or(top.apart, top.sure));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item, OVERLAP_FIELDS);
            push(undecided, left, item, OVERLAP_FIELDS);
        }
    }
    q->count = first;
}

/* Decides the pairs first ... of a queue by the formula and takes them out. */
static void decide_overlaps(const narc_shapes *shapes, struct queue *q, int first, uint64_t *out_bits) {
    for (int k = first; k < q->count; k += V_WIDTH) {
        const struct gap gap = overlay_gap(shapes, q, k, vm_first(q->count - k), false);
        mark(q, k, v_lt(gap.separation, v_set(0)), out_bits);
    }
    q->count = first;
}

/* Passes what waits on through the stages: whole vectors of the queues that are long enough, or all. */
static void drain_overlaps(const narc_shapes *shapes, struct stages *s, bool all, uint64_t *out_bits) {
    struct queue *const queues[] = {&s->again, &s->climb, &s->decide};
    for (int k = 0; k < 3; k++) {
        const int first = all ? 0 : queues[k]->count % V_WIDTH;
        if (!all && queues[k]->count < FLUSH)
            continue;
        if (all)
            pad(queues[k]);
        if (k == 0)
            look_for_overlaps(shapes, &s->again, first, &s->climb, out_bits);
        else if (k == 1)
            climb_to_overlaps(shapes, &s->climb, first, &s->decide, out_bits);
        else
            decide_overlaps(shapes, &s->decide, first, out_bits);
    }
}

/* How a method finds overlaps: those of the pairs of a queue, whose numbers count from `first` of the batch; sets their
 * bits. */
typedef void overlap_method(const narc_batch *batch, size_t first, struct queue *q, uint64_t *out_bits);

/* An overlap kernel that goes about all pairs alike. */
static void overlap_by(overlap_method *find, const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    struct queue q;
    memset(out_bits, 0, (count + 63) / 64 * sizeof *out_bits);
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_indices(batch, first + block, n, &indices);
        q.count = 0;
        for (int k = 0; k < n; k += V_WIDTH) {
            vf item[FIELDS];
            const struct filter f = load_pairs(batch, &indices, k, n, rows, 0, (int32_t)(uint32_t)block, item);
            push(&q, f.valid, item, FIELDS);
        }
        pad(&q);
        find(batch, first, &q, out_bits);
    }
}

static void mark_plain(const narc_batch *batch, size_t first, struct queue *q, uint64_t *out_bits) {
    (void)first;
    decide_overlaps(batch->shapes, q, 0, out_bits);
}

static void overlap(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    if (!NARC_SHORTCUTS) {
        overlap_by(mark_plain, batch, first, count, out_bits);
        return;
    }
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    struct queue fresh;
    struct stages stages;
    stages.again.count = stages.climb.count = stages.decide.count = 0;
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_indices(batch, first + block, n, &indices);
        for (int k = 0; k < n; k += 64)
            out_bits[(block + (size_t)k) / 64] = 0;
        fresh.count = 0;
        for (int k = 0; k < n; k += V_WIDTH) {
            const size_t pair = block + (size_t)k;
            vf item[FIELDS];
            const struct filter f = load_pairs(batch, &indices, k, n, rows, 0, (int32_t)(uint32_t)block, item);
            push(&fresh, vm_and_not(f.valid, vm_or(f.apart, f.deep)), item, OVERLAP_FIELDS);
            out_bits[pair / 64] |= (uint64_t)vm_bits(vm_and(f.valid, f.deep)) << pair % 64;
        }
        pad(&fresh);
        look_for_overlaps(batch->shapes, &fresh, 0, &stages.again, out_bits);
        drain_overlaps(batch->shapes, &stages, false, out_bits);
    }
    drain_overlaps(batch->shapes, &stages, true, out_bits);
}
