/* SPDX-License-Identifier: MIT
 *
 * search.inl - stage 2: the arcs that hold a direction, and the local maximum of the gap near it.
 *
 * All directions n point from A to B in A's frame; A is asked for n and B for -n. Nothing here decides anything: what
 * is found is looked at in overlap.inl and contact.inl, and proof.inl says what it proves.
 */

/* How many junctions of its shape come before a direction, in each lane: up to the 16 bits of the angles. */
INLINE vi count_before(const narc_record *records, vi block, vi count, vf x, vf y) {
    const vi turn = vi_truncate(v_sub(v_mul(turn_of(x, y), v_set(NARC_TURN_SCALE)), v_set(NARC_TURN_OFFSET)));
    vi twice = vi_add(vi_and(turn, vi_set(0xffff)), vi_shift_left(turn, 16)), before = vi_set(0);
    for (int done = 0;; done += NARC_TURNS) {
        int32_t record[V_WIDTH];
        vf row[4];
        vi_store(record, block);
        v_rows(records->turns, sizeof *records, record, row);
        for (int k = 0; k < 4; k++)
            before = vi_count16(before, twice, vi_bits(row[k]));
        if (vm_any(vi_lt(vi_set(done + NARC_TURNS / 2), count))) {
            v_rows(&records->turns[NARC_TURNS / 2], sizeof *records, record, row);
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
INLINE vi find_record(const narc_record *records, vi block, vi bytes, vf x, vf y) {
    const vi count = head_count(bytes), before = count_before(records, block, count, x, y);
    const vi place = vi_sub(vi_select(vi_lt(vi_set(0), before), before, count), vi_set(1));
    return vi_add(first_record(block, bytes), place);
}

/* Finds the arcs that hold DIRECTION, for the pairs first ... of a queue. With `hints` those
 * lanes stay as they are that have one. */
INLINE void look_up(const narc_shapes *shapes, struct queue *q, int first, bool hints) {
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm hinted = hints ? vi_lt(vi_set(0), vi_load(q->hinted + k)) : vm_first(0);
        if (hints && vm_bits(hinted) == vm_bits(vm_first(V_WIDTH)))
            continue;
        const vf q_c = get(q, Q_C, k), q_s = get(q, Q_S, k), n_x = get(q, DIRECTION_X, k), n_y = get(q, DIRECTION_Y, k);
        const vf b_x = v_neg(v_add(v_mul(q_c, n_x), v_mul(q_s, n_y))), b_y = v_sub(v_mul(q_s, n_x), v_mul(q_c, n_y));
        vi a = find_record(shapes->records, get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k), n_x, n_y);
        vi b = find_record(shapes->records, get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k), b_x, b_y);
        if (hints) {
            a = vi_select(hinted, vi_load(q->record_a + k), a);
            b = vi_select(hinted, vi_load(q->record_b + k), b);
        }
        vi_store(q->record_a + k, a);
        vi_store(q->record_b + k, b);
    }
}

/* ------------------------------------------------------------------------------------------------ hints */

/* A hint for the next call: the arcs of A and B at which this one ends, counted from 1 in the order of the store. Any
 * other value means none. */
INLINE vi hint_of(const struct queue *q, int k, vi record_a, vi record_b) {
    const vi a = vi_sub(record_a, first_record(get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k))), one = vi_set(1);
    const vi b = vi_sub(record_b, first_record(get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k)));
    return vi_add(vi_add(a, one), vi_shift_left(vi_add(b, one), 8));
}

/* Starts from what the hints say, in lanes where they name arcs that exist. */
INLINE void read_hints(struct queue *q, const uint32_t *hints) {
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
        int32_t pair[V_WIDTH], lane[V_WIDTH];
        vi_store(pair, get_bits(q, PAIR, k));
        for (int l = 0; l < V_WIDTH; l++)
            lane[l] = (int32_t)hints[pair[l]];
        const vi hint = vi_load(lane), zero = vi_set(0), one = vi_set(1);
        const vi a = vi_and(hint, vi_set(0xff)), b = vi_shift_right(hint, 8);
        const vm of_a = vm_and_not(vi_lt(zero, a), vi_lt(ring_a.count, a));
        const vm of_b = vm_and_not(vi_lt(zero, b), vi_lt(ring_b.count, b));
        const vm exists = vm_and(of_a, of_b);
        vi_store(q->record_a + k, vi_add(ring_a.first, vi_select(exists, vi_sub(a, one), zero)));
        vi_store(q->record_b + k, vi_add(ring_b.first, vi_select(exists, vi_sub(b, one), zero)));
        vi_store(q->hinted + k, vi_select(exists, one, zero));
    }
}

/* ------------------------------------------------------------------------------------------------ local maxima */

/* Most climbs end at the first step, and nearly all within four. */
enum { CLIMB_STEPS = 8 };

/* An arc of A and one of B in each lane. */
struct couple {
    struct arcs a, b;
};

INLINE struct couple select_couple(vm m, const struct couple *a, const struct couple *b) {
    return (struct couple){select_arcs(m, &a->a, &b->a), select_arcs(m, &a->b, &b->b)};
}

/* A local maximum of the gap: between two junctions, where both couples are the arcs that hold it, or (`kink`) at a
 * junction, with the couple after it and the one before. */
struct peak {
    vm found, kink;
    vf n_x, n_y; /* its direction, not yet of length 1 */
    struct couple after, before;
    vi record_a, record_b; /* of the arcs after it */
};

/* Climbs from the arcs in record_a and record_b to a local maximum. Each step looks at one interval of directions, the
 * common part of the two arcs' sectors, from lo to hi, with u from the centre of A's arc to that of B's (overlay.inl).
 * If u lies in it, that is the maximum. Else the gap rises beyond hi, or beyond lo, and the search crosses that
 * junction; if it would cross back the one it has just come over, that junction is the maximum. Where the sectors have
 * no common part (a hint that is stale) steps lead anywhere: who uses the result checks that the arcs hold its
 * direction. */
INLINE struct peak climb(const narc_shapes *shapes, const struct queue *q, int k, vm live) {
    const vf zero = v_set(0), tiny = v_set(0x1p-126f);
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const vm none = vm_first(0);
    vi record_a = vi_load(q->record_a + k), record_b = vi_load(q->record_b + k), old_a = record_a, old_b = record_b;
    vm was_up = none, was_down = none, moved_a = none, open = live;
    struct couple last;
    struct peak peak;
    for (int step = 0;; step++) {
        struct couple now;
        int32_t lanes[V_WIDTH];
        vi_store(lanes, record_a);
        now.a = load_arcs_a(shapes->records, lanes, &pose);
        vi_store(lanes, record_b);
        now.b = load_arcs_b(shapes->records, lanes, &pose);
        if (step == 0)
            last = now;
        const vf u_x = v_sub(now.b.x, now.a.x), u_y = v_sub(now.b.y, now.a.y);
        const vf start_a = cross(now.a.start_x, now.a.start_y, u_x, u_y);
        const vf start_b = cross(now.b.start_x, now.b.start_y, u_x, u_y);
        const vf end_a = cross(u_x, u_y, now.a.end_x, now.a.end_y), end_b = cross(u_x, u_y, now.b.end_x, now.b.end_y);
        const vm lo_is_a = v_le(zero, cross(now.b.start_x, now.b.start_y, now.a.start_x, now.a.start_y));
        const vm hi_is_a = v_le(zero, cross(now.a.end_x, now.a.end_y, now.b.end_x, now.b.end_y));
        const vf least = v_min(v_min(start_a, end_a), v_min(start_b, end_b));
        const vm inside = vm_and(v_le(zero, least), v_le(tiny, dot(u_x, u_y, u_x, u_y)));
        const vm down = v_lt(v_select(lo_is_a, start_a, start_b), zero);
        const vm up = v_lt(v_select(hi_is_a, end_a, end_b), zero);
        /* Back over the junction that the last step crossed: the one at this end, and of the shape that moved. */
        const vm at_lo = vm_and_not(vm_and_not(vm_and(was_up, down), vm_xor(lo_is_a, moved_a)), inside);
        const vm at_hi = vm_and_not(vm_and_not(vm_and(was_down, up), vm_xor(hi_is_a, moved_a)), inside);
        if (step == 0) {
            peak = (struct peak){none, none, u_x, u_y, now, now, record_a, record_b};
        } else {
            const struct couple after = select_couple(at_hi, &last, &now), before = select_couple(at_lo, &last, &now);
            const vf lo_x = v_select(lo_is_a, now.a.start_x, now.b.start_x);
            const vf lo_y = v_select(lo_is_a, now.a.start_y, now.b.start_y);
            const vf hi_x = v_select(hi_is_a, now.a.end_x, now.b.end_x);
            const vf hi_y = v_select(hi_is_a, now.a.end_y, now.b.end_y);
            peak.after = select_couple(open, &after, &peak.after);
            peak.before = select_couple(open, &before, &peak.before);
            peak.record_a = vi_select(open, vi_select(at_hi, old_a, record_a), peak.record_a);
            peak.record_b = vi_select(open, vi_select(at_hi, old_b, record_b), peak.record_b);
            peak.n_x = v_select(open, v_select(at_lo, lo_x, v_select(at_hi, hi_x, u_x)), peak.n_x);
            peak.n_y = v_select(open, v_select(at_lo, lo_y, v_select(at_hi, hi_y, u_y)), peak.n_y);
            peak.kink = vm_or(peak.kink, vm_and(open, vm_or(at_lo, at_hi)));
        }
        const vm here = vm_and(open, vm_or(inside, vm_or(at_lo, at_hi)));
        peak.found = vm_or(peak.found, here);
        open = vm_and_not(open, here);
        if (step + 1 == CLIMB_STEPS || !vm_any(open))
            return peak;
        last = now;
        old_a = record_a;
        old_b = record_b;
        was_up = up;
        was_down = vm_and_not(down, up);
        moved_a = vm_or(vm_and(was_up, hi_is_a), vm_and(was_down, lo_is_a));
        const vi by = vi_select(was_up, vi_set(1), vi_select(was_down, vi_set(-1), vi_set(0)));
        record_a = step_record(ring_a, record_a, vi_select(moved_a, by, vi_set(0)));
        record_b = step_record(ring_b, record_b, vi_select(moved_a, vi_set(0), by));
    }
}
