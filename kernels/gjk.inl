/* SPDX-License-Identifier: MIT
 *
 * gjk.inl - do two bodies collide, and how far are they apart: the algorithm of Gilbert, Johnson and Keerthi (1988) on
 * support functions (Algorithm 4 of "Using Piecewise Circular Curves as a 2D Collision Primitive").
 *
 * A segment pq between two support points of the difference (support.inl) lies in the difference: its distance from the
 * origin is an upper bound of the bodies' distance. The support point w towards the origin, along the segment's normal
 * m, gives the lower bound w.m. If the triangle pqw holds the origin, the bodies collide; else its side nearest to the
 * origin is the next segment. The search ends when the two bounds agree within the tolerance, or when the gap along m
 * is as large as the caller asks for.
 *
 * Where the segment passes through the origin, but for rounding, its normal has no sign: both sides are looked at. If
 * the difference goes on beyond the segment on both, the bodies collide; if it ends there on one, they touch.
 *
 * Every step but these two brings the segment nearer to the origin, or raises the lower bound with a segment that is as
 * near, or is the last: so the search ends. It never takes more than batch->iterations steps.
 */

/* The state of the search in each lane. */
struct search {
    vf m_x, m_y;                           /* where to look next */
    vf p_x, p_y, q_x, q_y;                 /* the segment; a point at first */
    vf distance;                           /* of the segment from the origin */
    vf r_x, r_y;                           /* what lies on the first side of a segment through the origin */
    vf third_x, third_y;                   /* when it is known that they collide: what makes a triangle of p and q */
    vf p_turn, q_turn, r_turn, third_turn; /* the directions of the points' search, for hints */
    vi as_near;                            /* is the segment as near as the one before, but no nearer? */
    vi side;                               /* 0; 1 and 2: on which side of such a segment the search looks */
    vf noise;                              /* of the last support point */
    struct gap best;                       /* the largest gap of all directions */
};

/* ------------------------------------------------------------------------------------------------ hints */

/* A hint is a number of 30 bits and, in the lowest two, what it is: 1, the direction of the largest gap; 3, those of
 * the three points of a triangle around the origin, in 10 bits each. Directions are diamond angles in A's frame. */
enum { HINT_AXIS = 1, HINT_TRIANGLE = 3 };

INLINE void direction_of(vf turn, vf *out_x, vf *out_y) {
    const vm upper = v_le(turn, v_set(2));
    const vf x = v_select(upper, v_sub(v_set(1), turn), v_sub(turn, v_set(3))), y = v_sub(v_set(1), v_abs(x));
    *out_x = x;
    *out_y = v_select(upper, y, v_neg(y));
}

/* The direction of point number `point` of a triangle, or of the axis. */
INLINE void read_hint(vi hint, int point, vf *out_x, vf *out_y) {
    const vm triangle = vi_lt(vi_set(2), vi_and(hint, vi_set(3)));
    const vf small = v_of_int(vi_and(vi_shift_right(hint, 2 + 10 * point), vi_set(1023)));
    const vf whole = v_of_int(vi_shift_right(hint, 2));
    direction_of(v_select(triangle, v_mul(v_add(small, v_set(0.5f)), v_set(0x1p-8f)), v_mul(whole, v_set(0x1p-28f))),
                 out_x, out_y);
}

INLINE vi ten_bits(vf turn) { return vi_truncate(v_min(v_mul(turn, v_set(0x1p8f)), v_set(1023))); }

/* How many directions a hint has: 0, 1 or 3. */
INLINE vi hint_length(vi hint) {
    const vi tag = vi_and(hint, vi_set(3));
    const vm odd = vi_lt(vi_set(0), vi_and(tag, vi_set(1)));
    return vi_select(odd, tag, vi_set(0));
}

static void leave_simplex(uint32_t *hints, const struct lanes *lanes, const struct search *s, vm collides, vm done) {
    const vi triangle = vi_add(ten_bits(s->p_turn), vi_add(vi_shift_left(ten_bits(s->q_turn), 10),
                                                           vi_shift_left(ten_bits(s->third_turn), 20)));
    const vf axis = v_min(v_mul(turn_of(s->best.n_x, s->best.n_y), v_set(0x1p28f)), v_set(0x1p30f - 64));
    const vi hint = vi_select(collides, vi_add(vi_shift_left(triangle, 2), vi_set(HINT_TRIANGLE)),
                              vi_add(vi_shift_left(vi_truncate(axis), 2), vi_set(HINT_AXIS)));
    int32_t lane_hint[V_WIDTH], pair[V_WIDTH];
    vi_store(lane_hint, hint);
    vi_store(pair, get_bits(&lanes->pair, PAIR, 0));
    for (uint32_t bits = vm_bits(done); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits);
        hints[(uint32_t)pair[lane]] = (uint32_t)lane_hint[lane];
    }
}

/* ------------------------------------------------------------------------------------------------ the search */

INLINE vm all_positive(vf a, vf b, vf c) { return v_lt(v_set(0), v_min(a, v_min(b, c))); }

/* Where to look: along a hint's directions first, or else along the axis between the inscribed circles, and then where
 * the search says. */
INLINE void choose_direction(const struct search *s, const struct lanes *lanes, vi hint, vi age, vf *out_x, vf *out_y) {
    const vi length = hint_length(hint);
    const vm fresh = vi_lt(age, vi_set(1));
    *out_x = v_select(fresh, get(&lanes->pair, AXIS_X, 0), s->m_x);
    *out_y = v_select(fresh, get(&lanes->pair, AXIS_Y, 0), s->m_y);
    for (int point = 0; point < 3; point++) {
        vf x, y;
        const vm at = vm_and_not(vi_lt(age, vi_set(point + 1)), vi_lt(age, vi_set(point)));
        const vm here = vm_and(at, vi_lt(vi_set(point), length));
        if (!vm_any(here))
            continue;
        read_hint(hint, point, &x, &y);
        *out_x = v_select(here, x, *out_x);
        *out_y = v_select(here, y, *out_y);
    }
}

/* Makes the side of the triangle pqw that is nearest to the origin the next segment, in the lanes `open`. Beside a long
 * edge the direction of a point may be off by much more than its distance: so a side is also taken that is as near, but
 * for rounding, if this step has raised the lower bound (`raised`) or the one before was nearer. Returns the lanes
 * without such a side. */
INLINE vm take_nearest(struct search *s, const struct support *w, vf w_turn, vm open, vm raised) {
    const struct nearest by_p = nearest_of(s->p_x, s->p_y, w->w_x, w->w_y);
    const struct nearest by_q = nearest_of(s->q_x, s->q_y, w->w_x, w->w_y);
    const vm use_p = v_le(by_p.distance, by_q.distance);
    const vf distance = v_select(use_p, by_p.distance, by_q.distance);
    const vm closer = v_lt(distance, s->distance), kept = vm_or(vm_and(use_p, by_p.is_p), vm_and_not(by_q.is_p, use_p));
    const vm another = vm_and_not(v_le(distance, v_add(s->distance, w->noise)), kept);
    const vm may = vm_or(raised, vi_lt(s->as_near, vi_set(1)));
    const vm nearer = vm_and(open, vm_or(closer, vm_and(another, may)));
    s->as_near = vi_select(vm_and_not(nearer, closer), vi_set(1), vi_set(0));
    const vm at_w = vm_or(vm_and(use_p, by_p.is_q), vm_and_not(by_q.is_q, use_p));
    const vf p_x = v_select(use_p, s->p_x, s->q_x), p_y = v_select(use_p, s->p_y, s->q_y);
    const vf p_turn = v_select(use_p, s->p_turn, s->q_turn);
    s->p_x = v_select(nearer, v_select(at_w, w->w_x, p_x), s->p_x);
    s->p_y = v_select(nearer, v_select(at_w, w->w_y, p_y), s->p_y);
    s->p_turn = v_select(nearer, v_select(at_w, w_turn, p_turn), s->p_turn);
    s->q_x = v_select(nearer, w->w_x, s->q_x);
    s->q_y = v_select(nearer, w->w_y, s->q_y);
    s->q_turn = v_select(nearer, w_turn, s->q_turn);
    s->distance = v_select(nearer, v_min(distance, s->distance), s->distance);
    s->m_x = v_select(nearer, v_select(use_p, by_p.m_x, by_q.m_x), s->m_x);
    s->m_y = v_select(nearer, v_select(use_p, by_p.m_y, by_q.m_y), s->m_y);
    return vm_and_not(open, nearer);
}

/* A first point, or the second one of a hint's triangle. */
INLINE void take_point(struct search *s, const struct support *w, vf w_turn, vm first, vm second) {
    const struct nearest between = nearest_of(s->p_x, s->p_y, w->w_x, w->w_y);
    const vm either = vm_or(first, second);
    s->p_x = v_select(first, w->w_x, s->p_x);
    s->p_y = v_select(first, w->w_y, s->p_y);
    s->p_turn = v_select(first, w_turn, s->p_turn);
    s->q_x = v_select(either, w->w_x, s->q_x);
    s->q_y = v_select(either, w->w_y, s->q_y);
    s->q_turn = v_select(either, w_turn, s->q_turn);
    const vf length = v_sqrt(dot(w->w_x, w->w_y, w->w_x, w->w_y));
    s->distance = v_select(first, length, v_select(second, between.distance, s->distance));
    s->m_x = v_select(first, w->w_x, v_select(second, between.m_x, s->m_x));
    s->m_y = v_select(first, w->w_y, v_select(second, between.m_y, s->m_y));
    s->side = vi_select(first, vi_set(0), s->side);
}

/* A segment through the origin, but for rounding: looks on its one side, then on the other. Returns the lanes where the
 * difference ends there: the bodies touch. */
INLINE vm take_side(struct search *s, const struct support *w, vf w_turn, vm through) {
    const vi zero = vi_set(0), one = vi_set(1), two = vi_set(2);
    const vf d_x = v_sub(s->q_x, s->p_x), d_y = v_sub(s->q_y, s->p_y), length2 = dot(d_x, d_y, d_x, d_y);
    const vm looked = vi_lt(zero, s->side), first = vm_and(looked, vi_lt(s->side, two));
    const vm ends = vm_and(looked, v_le(v_set(0), w->gap));
    const vm is_point = vm_and(through, v_le(length2, v_mul(w->noise, w->noise)));
    s->r_x = v_select(first, w->w_x, s->r_x);
    s->r_y = v_select(first, w->w_y, s->r_y);
    s->r_turn = v_select(first, w_turn, s->r_turn);
    s->m_x = v_select(first, d_y, v_select(through, v_neg(d_y), s->m_x));
    s->m_y = v_select(first, v_neg(d_x), v_select(through, d_x, s->m_y));
    s->side = vi_select(looked, vi_add(s->side, one), vi_select(through, one, zero));
    return vm_or(ends, is_point);
}

/* One step in every lane. `enough`: a separation of that much need not be known better. */
static inline struct verdict step_search(const narc_batch *batch, const struct lanes *lanes, struct search *s, vi hint,
                                         float enough) {
    const vf zero = v_set(0);
    const vi age = vi_load(lanes->age), seeds = hint_length(hint);
    const vm busy = vi_lt(vi_set(-1), age), fresh = vi_lt(age, vi_set(1));
    vf m_x, m_y;
    choose_direction(s, lanes, hint, age, &m_x, &m_y);
    const struct support w = find_support(batch->shapes, &lanes->pair, 0, m_x, m_y);
    const vf w_turn = batch->hints ? turn_of(w.m_x, w.m_y) : zero;
    const vm raised = v_lt(s->best.separation, w.gap);
    keep_best(&s->best, &w, fresh);
    s->noise = w.noise;
    const vm apart = v_le(v_set(enough), s->best.separation);

    /* What the step was for: a first point, a hint's second one, a side of a segment through the origin, or the rule.
     * */
    const vm seeded = vi_lt(age, seeds), second = vm_and_not(vm_and(seeded, vi_lt(age, vi_set(2))), fresh);
    const vm looked = vm_and_not(vi_lt(vi_set(0), s->side), fresh);
    const vm rule = vm_and_not(busy, vm_or(looked, vm_or(fresh, second)));
    const vf pq = cross(s->p_x, s->p_y, s->q_x, s->q_y), qw = cross(s->q_x, s->q_y, w.w_x, w.w_y);
    const vf wp = cross(w.w_x, w.w_y, s->p_x, s->p_y);
    const vm around = vm_or(all_positive(pq, qw, wp), all_positive(v_neg(pq), v_neg(qw), v_neg(wp)));
    const vm inside = vm_and(vm_and(rule, around), v_lt(s->best.separation, zero));
    const vm both_sides = vm_and(looked, vi_lt(vi_set(1), s->side));
    s->third_x = v_select(both_sides, s->r_x, w.w_x);
    s->third_y = v_select(both_sides, s->r_y, w.w_y);
    s->third_turn = v_select(both_sides, s->r_turn, w_turn);

    take_point(s, &w, w_turn, fresh, second);
    const vm stayed = vm_and_not(take_nearest(s, &w, w_turn, vm_and_not(rule, inside), raised), seeded);
    const vm through = vm_and_not(vm_and(busy, v_le(s->distance, w.noise)), vm_or(looked, vm_or(second, inside)));
    const vm touches = take_side(s, &w, w_turn, through);

    const vf left = v_sub(s->distance, v_max(s->best.separation, zero));
    const vf tolerance = v_max(v_mul(v_set(batch->tolerance), get(&lanes->pair, SIZE, 0)), w.noise);
    const vm known = vm_and(v_le(zero, s->best.separation), v_le(left, tolerance));
    const vm ends = vm_and(busy, vm_or(vm_or(apart, known), vm_or(touches, stayed)));
    const vm old = vm_and_not(busy, vi_lt(age, vi_set(batch->iterations - 1)));
    struct verdict verdict;
    verdict.collides = vm_and_not(vm_or(inside, both_sides), vm_or(apart, touches));
    verdict.separate = vm_and_not(ends, verdict.collides);
    verdict.limit = vm_and_not(old, vm_or(ends, verdict.collides));
    verdict.stuck = vm_and_not(vm_and_not(verdict.separate, vm_or(vm_or(apart, known), touches)), v_le(left, w.noise));
    return verdict;
}

/* ------------------------------------------------------------------------------------------------ kernels */

INLINE vm is_done(const struct verdict *v) { return vm_or(v->collides, vm_or(v->separate, v->limit)); }

/* The hints of the pairs that lanes begin with. */
INLINE void read_hints_of(const narc_batch *batch, size_t first, const struct lanes *lanes, int32_t *hint) {
    int32_t pair[V_WIDTH];
    vi_store(pair, get_bits(&lanes->pair, PAIR, 0));
    for (int lane = 0; lane < V_WIDTH; lane++)
        if (batch->hints && lanes->age[lane] == 0)
            hint[lane] = (int32_t)batch->hints[first + (uint32_t)pair[lane]];
}

/* A search that rounding has ended may go better without the hint that it began with. */
static void begin_again(struct lanes *lanes, int32_t *hint, struct verdict *verdict) {
    const vi old = vi_load(hint), none = vi_set(0);
    const vm again = vm_and(verdict->stuck, vi_lt(none, hint_length(old)));
    vi_store(hint, vi_select(again, none, old));
    vi_store(lanes->age, vi_select(again, none, vi_load(lanes->age)));
    verdict->separate = vm_and_not(verdict->separate, again);
    verdict->stuck = vm_and_not(verdict->stuck, again);
}

/* Passes the pairs that collide on to EPA, each with the triangle that holds the origin. */
static void pass_on(const struct lanes *lanes, const struct search *s, vm collides, struct queue *to) {
    float corner[6][V_WIDTH];
    v_store(corner[0], s->p_x);
    v_store(corner[1], s->p_y);
    v_store(corner[2], s->q_x);
    v_store(corner[3], s->q_y);
    v_store(corner[4], s->third_x);
    v_store(corner[5], s->third_y);
    for (uint32_t bits = vm_bits(collides); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits), k = to->count++;
        copy_item(&lanes->pair, lane, to, k);
        for (int c = 0; c < 6; c++)
            to->item[corner_fields[c]][k] = corner[c][lane];
    }
}

/* Searches with all pairs of a queue. For overlaps, sets their bits. For contacts, those that are apart go to
 * `finished`, and those that collide to `colliding`. */
INLINE void search_all(const narc_batch *batch, size_t first, const struct queue *q, float enough, uint64_t *out_bits,
                       struct queue *colliding, struct queue *finished) {
    struct lanes lanes;
    struct search s;
    int32_t hint[V_WIDTH] = {0};
    memset(&s, 0, sizeof s);
    start_lanes(&lanes);
    while (fill_lanes(&lanes, q)) {
        struct verdict verdict;
        read_hints_of(batch, first, &lanes, hint);
        do {
            verdict = step_search(batch, &lanes, &s, vi_load(hint), enough);
            end_step(&lanes, is_done(&verdict));
            if (vm_any(verdict.stuck))
                begin_again(&lanes, hint, &verdict);
        } while (!vm_any(is_done(&verdict)));
        note_outcome(batch, first, &lanes.pair, 0, verdict.limit, NARC_OUTCOME_LIMIT);
        note_outcome(batch, first, &lanes.pair, 0, verdict.stuck, NARC_OUTCOME_ROUNDING);
        if (batch->hints)
            leave_simplex(batch->hints + first, &lanes, &s, verdict.collides, is_done(&verdict));
        if (!finished) {
            mark(&lanes.pair, 0, verdict.collides, out_bits);
            continue;
        }
        struct gap gap = s.best;
        gap.separation = v_max(gap.separation, v_set(0));
        finish(&lanes, vm_or(verdict.separate, verdict.limit), &gap, s.noise, finished);
        pass_on(&lanes, &s, verdict.collides, colliding);
    }
}

static void mark_gjk(const narc_batch *batch, size_t first, struct queue *q, uint64_t *out_bits) {
    search_all(batch, first, q, 0, out_bits, NULL, NULL);
}

static void find_gjk(const narc_batch *batch, size_t first, struct queue *q, float margin, struct results *out) {
    struct queue colliding, finished;
    colliding.count = finished.count = 0;
    search_all(batch, first, q, margin, NULL, &colliding, &finished);
    expand_all(batch, first, &colliding, margin, &finished);
    pad(&finished);
    file_finished(batch, &finished, margin, out);
}

static void overlap_gjk(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    overlap_by(mark_gjk, batch, first, count, out_bits);
}

static size_t contact_gjk(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    return contact_by(find_gjk, batch, first, count, margin, out);
}
