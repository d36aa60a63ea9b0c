/* SPDX-License-Identifier: MIT
 *
 * search.inl - stage 2, written below.
 */

/* How many junctions of its shape come before a direction, in each lane. */
INLINE vi count_before(const narc_shapes *shapes, vi block, vi count, vf x, vf y) {
    const vi turn = vi_truncate(v_sub(v_mul(turn_of(x, y), v_set(NARC_TURN_SCALE)), v_set(NARC_TURN_OFFSET)));
    vi twice = vi_add(vi_and(turn, vi_set(0xffff)), vi_shift_left(turn, 16)), before = vi_set(0);
    int32_t record[V_WIDTH];
    vf row[4];
    for (int done = 0;; done += NARC_TURNS) {
        vi_store(record, block);
        v_rows(shapes->records->turns, sizeof(narc_record), record, row);
        for (int k = 0; k < 4; k++)
            before = vi_count16(before, twice, vi_bits(row[k]));
        if (vm_any(vi_lt(vi_set(done + 8), count))) {
            v_rows(&shapes->records->turns[8], sizeof(narc_record), record, row);
            for (int k = 0; k < 4; k++)
                before = vi_count16(before, twice, vi_bits(row[k]));
        }
        const vm more = vi_lt(vi_set(done + NARC_TURNS), count);
        if (!vm_any(more))
            break;
        block = vi_add(block, vi_select(more, vi_set(1), vi_set(0)));
        twice = vi_select(more, twice, vi_set((int32_t)0x80008000u)); /* nothing is below that */
    }
    return vi_add(vi_and(before, vi_set(0xffff)), vi_shift_right(before, 16));
}

/* The record of the arc that holds a direction, in each lane. */
INLINE vi find_records(const narc_shapes *shapes, vi block, vi bytes, vf x, vf y) {
    const vi count = head_count(bytes), before = count_before(shapes, block, count, x, y);
    const vi place = vi_sub(vi_select(vi_lt(vi_set(0), before), before, count), vi_set(1));
    return vi_add(first_record(block, bytes), place);
}

INLINE void load_circles(const narc_record *records, const int32_t *record, vf out[4]) {
    v_rows(records, sizeof *records, record, out);
}

/* Sets the bits of the pairs k ... of a queue that `hits` says. */
INLINE void mark(vi pairs, vm hits, uint64_t *out_bits) {
    int32_t pair[V_WIDTH];
    vi_store(pair, pairs);
    for (uint32_t bits = vm_bits(hits); bits; bits &= bits - 1) {
        const uint32_t number = (uint32_t)pair[__builtin_ctz(bits)];
        out_bits[number / 64] |= (uint64_t)1 << number % 64;
    }
}

/* The records of the arcs that hold a direction (fields `x` and x + 1), for the pairs first ... of a queue. */
INLINE void look_up(const narc_shapes *shapes, struct queue *q, int first, int x, bool hints) {
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm hinted = hints ? vi_lt(vi_set(0), vi_load(q->hinted + k)) : vm_first(0);
        if (hints && vm_bits(hinted) == vm_bits(vm_first(V_WIDTH)))
            continue;
        const vf q_c = get(q, Q_C, k), q_s = get(q, Q_S, k), n_x = get(q, x, k), n_y = get(q, x + 1, k);
        const vi record_a = find_records(shapes, get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k), n_x, n_y);
        const vi record_b = find_records(shapes, get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k),
                                         v_neg(v_add(v_mul(q_c, n_x), v_mul(q_s, n_y))),
                                         v_sub(v_mul(q_s, n_x), v_mul(q_c, n_y)));
        vi_store(q->record_a + k, hints ? vi_select(hinted, vi_load(q->record_a + k), record_a) : record_a);
        vi_store(q->record_b + k, hints ? vi_select(hinted, vi_load(q->record_b + k), record_b) : record_b);
    }
}

/* A hint for the next call: the arcs of A and B at which the last one ended, counted from 1 in the order of the store. Any
 * other value means none. */
INLINE vi hint_of(const struct queue *q, int k, vi record_a, vi record_b) {
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const vi a = vi_sub(record_a, ring_a.first), b = vi_sub(record_b, ring_b.first), one = vi_set(1);
    return vi_add(vi_add(a, one), vi_shift_left(vi_add(b, one), 8));
}

/* Replaces what look_up() found by what the hints say, in lanes where they name arcs that exist. */
INLINE void look_up_hints(struct queue *q, const uint32_t *hints) {
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
        int32_t pair[V_WIDTH], lane[V_WIDTH];
        vi_store(pair, get_bits(q, PAIR, k));
        for (int l = 0; l < V_WIDTH; l++)
            lane[l] = (int32_t)hints[pair[l]];
        const vi hint = vi_load(lane), low = vi_set(0xff);
        const vi a = vi_sub(vi_and(hint, low), vi_set(1)), b = vi_sub(vi_shift_right(hint, 8), vi_set(1));
        const vi none = vi_set(-1);
        const vm exists = vm_and(vm_and(vi_lt(none, a), vi_lt(a, ring_a.count)), vm_and(vi_lt(none, b), vi_lt(b, ring_b.count)));
        vi_store(q->record_a + k, vi_add(ring_a.first, vi_select(exists, a, vi_set(0))));
        vi_store(q->record_b + k, vi_add(ring_b.first, vi_select(exists, b, vi_set(0))));
        vi_store(q->hinted + k, vi_select(exists, vi_set(1), vi_set(0)));
    }
}

struct verdict { vm apart, hit; vf u_x, u_y; };

/* One look along a direction (any length) */
INLINE struct verdict glance(const narc_shapes *shapes, const struct queue *q, int k, int x, float margin, bool contact) {
    const struct pose p = get_pose(q, k);
    const vf scale_a = p.scale_a, n_x = get(q, x, k), n_y = get(q, x + 1, k);
    vf a[4], b[4];
    load_circles(shapes->records, q->record_a + k, a);
    load_circles(shapes->records, q->record_b + k, b);
    const vf b_x = v_sub(v_mul(p.q_c, b[0]), v_mul(p.q_s, b[1])), b_y = v_add(v_mul(p.q_s, b[0]), v_mul(p.q_c, b[1]));
    struct verdict v;
    v.u_x = v_sub(v_add(p.t_x, v_mul(p.scale_b, b_x)), v_mul(scale_a, a[0]));
    v.u_y = v_sub(v_add(p.t_y, v_mul(p.scale_b, b_y)), v_mul(scale_a, a[1]));
    const vf radii = v_add(v_mul(scale_a, a[2]), v_mul(p.scale_b, b[2]));
    const vf length = v_sqrt(dot(n_x, n_y, n_x, n_y));
    const vf slack = get(q, SLACK, k);
    /* All times length. */
    const vf gap = v_sub(dot(v.u_x, v.u_y, n_x, n_y), v_mul(radii, length));
    const vm smooth = head_is(vi_and(get_bits(q, BYTES_A, k), get_bits(q, BYTES_B, k)), NARC_SHAPE_SMOOTH);
    const vf room = v_mul(v_select(smooth, v_set(1), v_set(64)), slack);
    v.apart = v_lt(v_mul(length, v_add(v_set(margin), room)), gap);
    if (contact)
        return v;
    const vf p_x = v_sub(v_mul(radii, n_x), v_mul(length, v.u_x)), p_y = v_sub(v_mul(radii, n_y), v_mul(length, v.u_y));
    const vf axis_x = get(q, AXIS_X, k), axis_y = get(q, AXIS_Y, k), core = get(q, CORE, k);
    const vf p2 = dot(p_x, p_y, p_x, p_y), across = cross(axis_x, axis_y, p_x, p_y), along = dot(axis_x, axis_y, p_x, p_y);
    const vf reach = v_mul(v_set(0.875f), core);
    const vm hit = vm_and(v_lt(v_set(0), along), v_lt(v_mul(across, across), v_mul(v_mul(reach, reach), p2)));
    v.hit = vm_and(hit, v_lt(v_mul(v_mul(v_set(4), slack), v_add(p2, v_mul(length, along))), v_mul(p2, core)));
    return v;
}

INLINE void get_item(const struct queue *q, int k, vf item[FIELDS]) {
    UNROLL
    for (int f = 0; f < FIELDS; f++)
        item[f] = get(q, f, k);
}


/* ---------------------------------------------------------------------------------------------- local maxima */

/* Steps of a climb */
enum { STEPS = 8 };

/* An arc of A and one of B in each lane. */
struct couple {
    struct arcs a, b;
};

/* A local maximum of the gap: the arcs that hold its direction, or where that is a junction, those after it and before
 * it. */
struct peak {
    vm found;
    vm kink;
    vf n_x, n_y;              /* not yet of length 1 */
    struct couple after, before;
    vi record_a, record_b;    /* of the arcs after it */
};

INLINE struct couple select_couple(vm m, const struct couple *a, const struct couple *b) {
    return (struct couple){select_arcs(m, &a->a, &b->a), select_arcs(m, &a->b, &b->b)};
}

INLINE struct peak climb(const narc_shapes *shapes, const struct queue *q, int k, vm live, int steps) {
    const vf zero = v_set(0), tiny = v_set(0x1p-126f);
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const vm none = vm_first(0);
    vi record_a = vi_load(q->record_a + k);
    vi record_b = vi_load(q->record_b + k);
    vi old_a = record_a, old_b = record_b;
    vm was_up = none, was_down = none, moved_a = none, open = live;
    struct couple last;
    struct peak peak;
    for (int step = 0;; step++) {
        struct couple now;
        int32_t lanes_a[V_WIDTH], lanes_b[V_WIDTH];
        vi_store(lanes_a, record_a);
        vi_store(lanes_b, record_b);
        now.a = load_arcs_a(shapes->records, lanes_a, &pose);
        now.b = load_arcs_b(shapes->records, lanes_b, &pose);
        if (step == 0)
            last = now;
        const vf u_x = v_sub(now.b.x, now.a.x), u_y = v_sub(now.b.y, now.a.y);
        const vf start_a = cross(now.a.start_x, now.a.start_y, u_x, u_y), end_a = cross(u_x, u_y, now.a.end_x, now.a.end_y);
        const vf start_b = cross(now.b.start_x, now.b.start_y, u_x, u_y), end_b = cross(u_x, u_y, now.b.end_x, now.b.end_y);
        const vm lo_is_a = v_le(zero, cross(now.b.start_x, now.b.start_y, now.a.start_x, now.a.start_y));
        const vm hi_is_a = v_le(zero, cross(now.a.end_x, now.a.end_y, now.b.end_x, now.b.end_y));
        const vm inside = vm_and(v_le(zero, v_min(v_min(start_a, end_a), v_min(start_b, end_b))), v_le(tiny, dot(u_x, u_y, u_x, u_y)));
        const vm down = v_lt(v_select(lo_is_a, start_a, start_b), zero);
        const vm up = v_lt(v_select(hi_is_a, end_a, end_b), zero);
        const vm down_over_last = vm_and(down, vm_or(vm_and(lo_is_a, moved_a), vm_and_not(vm_first(V_WIDTH), vm_or(lo_is_a, moved_a))));
        const vm up_over_last = vm_and(up, vm_or(vm_and(hi_is_a, moved_a), vm_and_not(vm_first(V_WIDTH), vm_or(hi_is_a, moved_a))));
        const vm at_lo = vm_and_not(vm_and(was_up, down_over_last), inside), at_hi = vm_and_not(vm_and(was_down, up_over_last), inside);
        if (step == 0) {
            peak = (struct peak){.found = none, .kink = none, .n_x = u_x, .n_y = u_y, .after = now, .before = now, .record_a = record_a, .record_b = record_b};
        } else {
            const struct couple after = select_couple(at_hi, &last, &now), before = select_couple(at_lo, &last, &now);
            peak.after = select_couple(open, &after, &peak.after);
            peak.before = select_couple(open, &before, &peak.before);
            peak.record_a = vi_select(open, vi_select(at_hi, old_a, record_a), peak.record_a);
            peak.record_b = vi_select(open, vi_select(at_hi, old_b, record_b), peak.record_b);
            const vf lo_x = v_select(lo_is_a, now.a.start_x, now.b.start_x), lo_y = v_select(lo_is_a, now.a.start_y, now.b.start_y);
            const vf hi_x = v_select(hi_is_a, now.a.end_x, now.b.end_x), hi_y = v_select(hi_is_a, now.a.end_y, now.b.end_y);
            peak.n_x = v_select(open, v_select(at_lo, lo_x, v_select(at_hi, hi_x, u_x)), peak.n_x);
            peak.n_y = v_select(open, v_select(at_lo, lo_y, v_select(at_hi, hi_y, u_y)), peak.n_y);
            peak.kink = vm_or(peak.kink, vm_and(open, vm_or(at_lo, at_hi)));
        }
        const vm here = vm_and(open, vm_or(inside, vm_or(at_lo, at_hi)));
        peak.found = vm_or(peak.found, here);
        open = vm_and_not(open, here);
        if (step + 1 == steps || !vm_any(open))
            break;
        last = now;
        old_a = record_a;
        old_b = record_b;
        was_up = up;
        was_down = vm_and_not(down, up);
        moved_a = vm_or(vm_and(was_up, hi_is_a), vm_and(was_down, lo_is_a));
        const vi step_by = vi_select(was_up, vi_set(1), vi_select(was_down, vi_set(-1), vi_set(0)));
        record_a = step_record(ring_a, record_a, vi_select(moved_a, step_by, vi_set(0)));
        record_b = step_record(ring_b, record_b, vi_select(moved_a, vi_set(0), step_by));
    }
    return peak;
}

/* The sine of the angle from a direction to the end of an arc, both unit; above a right angle 1. */
INLINE vf sine_to(vf n_x, vf n_y, vf end_x, vf end_y, vm is_circle) {
    const vf sine = cross(n_x, n_y, end_x, end_y);
    const vm far = vm_or(is_circle, vm_and(v_le(v_set(0), sine), v_lt(dot(n_x, n_y, end_x, end_y), v_set(0))));
    return v_select(far, v_set(1), sine);
}
