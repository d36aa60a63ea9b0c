/* SPDX-License-Identifier: MIT
 *
 * overlay.inl - stage 2, the deciding formula: the largest gap over all directions, exactly, for one pair in each lane.
 *
 * For a direction n (A to B) held by arc i of A, and -n by arc j of B, the gap between the support lines is
 *     g(n) = u.n - (r_i + r_j),   u = b_j - a_i.
 * Lay the junction normals of A and the negated ones of B over each other: they cut the circle of directions into m + n
 * intervals, each with one pair (i, j), walked once in the order of their angle (rotating calipers). The derivative of
 * g by the angle of n is n x u: where it turns from rising to falling, g has a local maximum. Within an interval from
 * lo to hi that is so if it rises at lo, lo x u >= 0, and falls at hi, u x hi >= 0: then u lies between them, and g is
 * largest along u, with the value |u| - (r_i + r_j). At the junction between two intervals it is so if g rises at the
 * end of the one and falls at the start of the next, each with its own u: a kink, which an edge makes; the value is u.n
 * - (r_i + r_j). The largest of all these values is the separation of the bodies.
 *
 * Edges cost nothing extra, hence one path for all shapes; for those without edges the test at junctions closes the
 * seams, where rounding puts u just outside both intervals. As every sign is used for what lies on either side of it,
 * no change from rising to falling can be lost, unless a sign is wrong. It can be where n x u is 0 up to rounding,
 * that is near a minimum or a maximum; this can make g seem to fall, or rise, all the way past a minimum and a
 * maximum next to it. If the two are close, so are their values. They are far apart only in an interval of nearly
 * half a turn with u near one of its ends: so in an interval wider than a right angle, it is enough that u points
 * less than a right angle into it from either end. Last, g may seem to rise or fall all around; then it is constant
 * up to rounding (two circles in one place), and its value at the first junction serves.
 *
 * In an interval that is empty up to rounding, u opposite to lo passes both tests, so in one up to a right angle u must
 * also have u.lo + u.hi > 0. Where it does not, or is too short to tell, the value at lo is taken: no value of g can do
 * harm.
 *
 * Error, in units of e = 2^-24, with D the distance between the positions and E the extents (largest |centre| + radius,
 * scaled); each line bounds what one step adds to g:
 *     storing centres and radii in single precision                           E_a +   E_b
 *     the rotations' rounding and what is left of their length         4 D +          8 E_b
 *     rounding and rotating the difference of positions                4 D
 *     the relative rotation, the rotation and scaling of centres              E_a + 8 E_b
 *     the difference of centres                                        2 D + 2 E_a + 2 E_b
 *     norm or dot product                                              3 D + 3 E_a + 3 E_b
 *     the sum of radii and the last subtraction                        3 D + 3 E_a + 3 E_b
 *     a junction normal off by 6 e moves a kink along a slope of at
 *     most |u|, or lets a neighbour answer beyond its end              6 D + 6 E_a + 6 E_b
 * Together at most 22 D + 16 E_a + 31 E_b: NARC_ERROR_BOUND, 32 (D + E_a + E_b), covers it.
 *
 * The angle that orders the junctions is the diamond angle, monotonic in the true one: 0 along +x, 1 along +y, at most
 * 4. It may swap junctions that agree up to rounding, which the line on junction normals covers. Junctions of one
 * shape never swap: their normals differ by more than NARC_TOLERANCE.
 */

/* The diamond angle of a direction of any length. */
INLINE vf turn_of(vf x, vf y) {
    const vf p = v_div(x, v_add(v_abs(x), v_abs(y)));
    return v_select(v_le(v_set(0), y), v_sub(v_set(1), p), v_add(v_set(3), p));
}

INLINE vf cross(vf a_x, vf a_y, vf b_x, vf b_y) { return v_sub(v_mul(a_x, b_y), v_mul(a_y, b_x)); }

INLINE vf dot(vf a_x, vf a_y, vf b_x, vf b_y) { return v_add(v_mul(a_x, b_x), v_mul(a_y, b_y)); }

/* An arc in each lane, in A's frame at world scale, normals from A to B: those of B point the other way. */
struct arcs {
    vf x, y, radius, inner, near; /* the last two: store.h */
    vf start_x, start_y, end_x, end_y;
};

/* B's pose in A's frame, and A's scale. */
struct pose {
    vf t_x, t_y, q_c, q_s, scale_b, scale_a;
};

INLINE struct pose get_pose(const struct queue *q, int k) {
    return (struct pose){get(q, T_X, k), get(q, T_Y, k),     get(q, Q_C, k),
                         get(q, Q_S, k), get(q, SCALE_B, k), get(q, SCALE_A, k)};
}

INLINE void load_records(const narc_record *records, const int32_t *record, vf row[8]) {
    v_rows(records, sizeof *records, record, row);
    v_rows(&records->arc.start_x, sizeof *records, record, row + 4);
}

/* Two floats that lack their lower halves, in one. */
INLINE vf upper_half(vf two) { return v_of_bits(vi_and(vi_bits(two), vi_set((int32_t)0xffff0000u))); }

INLINE vf lower_half(vf two) { return v_of_bits(vi_shift_left(vi_bits(two), 16)); }

INLINE struct arcs place_a(const vf row[8], const struct pose *p) {
    return (struct arcs){v_mul(row[0], p->scale_a),
                         v_mul(row[1], p->scale_a),
                         v_mul(row[2], p->scale_a),
                         v_mul(upper_half(row[3]), p->scale_a),
                         v_mul(lower_half(row[3]), p->scale_a),
                         row[4],
                         row[5],
                         row[6],
                         row[7]};
}

INLINE struct arcs place_b(const vf row[8], const struct pose *p) {
    const vf x = v_sub(v_mul(p->q_c, row[0]), v_mul(p->q_s, row[1]));
    const vf y = v_add(v_mul(p->q_s, row[0]), v_mul(p->q_c, row[1]));
    return (struct arcs){v_add(p->t_x, v_mul(x, p->scale_b)),
                         v_add(p->t_y, v_mul(y, p->scale_b)),
                         v_mul(row[2], p->scale_b),
                         v_mul(upper_half(row[3]), p->scale_b),
                         v_mul(lower_half(row[3]), p->scale_b),
                         v_sub(v_mul(p->q_s, row[5]), v_mul(p->q_c, row[4])),
                         v_neg(v_add(v_mul(p->q_s, row[4]), v_mul(p->q_c, row[5]))),
                         v_sub(v_mul(p->q_s, row[7]), v_mul(p->q_c, row[6])),
                         v_neg(v_add(v_mul(p->q_s, row[6]), v_mul(p->q_c, row[7])))};
}

/* The arcs of A, and of B, in each lane's record. */
INLINE struct arcs load_arcs_a(const narc_record *records, const int32_t *record, const struct pose *p) {
    vf row[8];
    load_records(records, record, row);
    return place_a(row, p);
}

INLINE struct arcs load_arcs_b(const narc_record *records, const int32_t *record, const struct pose *p) {
    vf row[8];
    load_records(records, record, row);
    return place_b(row, p);
}

INLINE struct arcs select_arcs(vm m, const struct arcs *a, const struct arcs *b) {
    return (struct arcs){v_select(m, a->x, b->x),
                         v_select(m, a->y, b->y),
                         v_select(m, a->radius, b->radius),
                         v_select(m, a->inner, b->inner),
                         v_select(m, a->near, b->near),
                         v_select(m, a->start_x, b->start_x),
                         v_select(m, a->start_y, b->start_y),
                         v_select(m, a->end_x, b->end_x),
                         v_select(m, a->end_y, b->end_y)};
}

/* The records of a shape's arcs in each lane. */
struct ring {
    vi first, count;
};

INLINE struct ring get_ring(const struct queue *q, int k, int block, int bytes) {
    return (struct ring){first_record(get_bits(q, block, k), get_bits(q, bytes, k)), head_count(get_bits(q, bytes, k))};
}

/* A record after a step of -1, 0 or 1 along the ring. */
INLINE vi step_record(struct ring ring, vi record, vi step) {
    const vi end = vi_add(ring.first, ring.count), next = vi_add(record, step);
    const vi low = vi_select(vi_lt(next, ring.first), vi_sub(end, vi_set(1)), next);
    return vi_select(vi_lt(low, end), low, ring.first);
}

/* The arc of B whose junction, negated and in A's frame, is the first counter-clockwise from +x: the one with the
 * smallest turn, all others' being larger than those of the arcs before them. */
INLINE vi first_of_b(const narc_record *records, struct ring ring, const struct pose *p) {
    vi record = ring.first, first = record;
    vf least = v_set(INFINITY);
    for (int i = 0; vm_any(vi_lt(vi_set(i), ring.count)); i++, record = vi_add(record, vi_set(1))) {
        const vm exists = vi_lt(vi_set(i), ring.count);
        int32_t lanes[V_WIDTH];
        vf row[4];
        vi_store(lanes, vi_select(exists, record, ring.first));
        v_rows(&records->arc.start_x, sizeof *records, lanes, row);
        const vf x = v_sub(v_mul(p->q_s, row[1]), v_mul(p->q_c, row[0]));
        const vf y = v_neg(v_add(v_mul(p->q_s, row[0]), v_mul(p->q_c, row[1])));
        const vf turn = turn_of(x, y);
        const vm earlier = vm_and(exists, v_lt(turn, least));
        least = v_select(earlier, turn, least);
        first = vi_select(earlier, record, first);
    }
    return first;
}

/* The best candidate of each lane. */
struct gap {
    vf separation;
    vf n_x, n_y, n_length; /* the normal, not yet divided by its length */
    vi record_a, record_b;
};

/* The separation of the pairs k ... of a queue, of those lanes for which `live` holds (elsewhere +infinity). Without
 * `contact` only separation is set, and the walk ends as soon as every lane is known not to collide: then it is some
 * value >= 0. */
static inline struct gap overlay_gap(const narc_shapes *shapes, const struct queue *q, int k, vm live, bool contact) {
    const vf tiny = v_set(0x1p-126f); /* the least normal float: a smaller |u|^2 has lost its digits */
    const narc_record *records = shapes->records;
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const vi steps = vi_add(ring_a.count, ring_b.count);
    vi record_a = step_record(ring_a, ring_a.first, vi_set(-1));
    vi record_b = step_record(ring_b, first_of_b(records, ring_b, &pose), vi_set(-1));
    int32_t lanes[V_WIDTH];
    vi_store(lanes, record_a);
    struct arcs a = load_arcs_a(records, lanes, &pose);
    vi_store(lanes, record_b);
    struct arcs b = load_arcs_b(records, lanes, &pose);
    struct gap best = {
        v_select(live, v_set(-INFINITY), v_set(INFINITY)), v_set(0), v_set(0), v_set(1), record_a, record_b};
    /* Angles of at least 0 have the order of their bits, as integers. Those of this turn, 0 to 4, are moved down so
     * that all of the next turn follow them; exactly, so that the last interval ends where the first one began. */
    const vi this_turn = vi_set(-0x40800001); /* the bits of 4.0f, and one more */
    vi a_turn = vi_add(vi_bits(turn_of(a.end_x, a.end_y)), this_turn);
    vi b_turn = vi_add(vi_bits(turn_of(b.end_x, b.end_y)), this_turn);
    /* Does g rise towards the first junction, at the end of the interval before it? */
    vm is_a = vi_lt(a_turn, b_turn);
    vf lo_x = v_select(is_a, a.end_x, b.end_x), lo_y = v_select(is_a, a.end_y, b.end_y);
    vm rises = v_lt(cross(v_sub(b.x, a.x), v_sub(b.y, a.y), lo_x, lo_y), v_set(0));
    vf first_value = v_set(0);
    for (int step = 0;; step++) {
        vm active = vm_and(live, vi_lt(vi_set(step), steps));
        if (!contact)
            active = vm_and(active, v_lt(best.separation, v_set(0)));
        if (!vm_any(active))
            break;

        /* Pass the nearer of the two junctions ahead, lo: the arc that starts there takes over. The junction ahead of
         * it on that shape comes a turn later where the list begins anew. */
        const vi passed =
            vi_select(is_a, step_record(ring_a, record_a, vi_set(1)), step_record(ring_b, record_b, vi_set(1)));
        vf row[8];
        vi_store(lanes, passed);
        load_records(records, lanes, row);
        const struct arcs new_a = place_a(row, &pose), new_b = place_b(row, &pose);
        a = select_arcs(is_a, &new_a, &a);
        b = select_arcs(is_a, &b, &new_b);
        record_a = vi_select(is_a, passed, record_a);
        record_b = vi_select(is_a, record_b, passed);
        const vi next_turn = vi_bits(turn_of(v_select(is_a, a.end_x, b.end_x), v_select(is_a, a.end_y, b.end_y)));
        const vi turn = vi_add(next_turn, this_turn);
        const vi later = vi_select(vi_lt(turn, vi_select(is_a, a_turn, b_turn)), next_turn, turn);
        a_turn = vi_select(is_a, later, a_turn);
        b_turn = vi_select(is_a, b_turn, later);
        is_a = vi_lt(a_turn, b_turn);
        const vf hi_x = v_select(is_a, a.end_x, b.end_x), hi_y = v_select(is_a, a.end_y, b.end_y);

        /* The largest g at lo or between lo and hi, if there is a local maximum. */
        const vf u_x = v_sub(b.x, a.x), u_y = v_sub(b.y, a.y);
        const vf u2 = dot(u_x, u_y, u_x, u_y);
        const vf after_lo = cross(lo_x, lo_y, u_x, u_y), before_hi = cross(u_x, u_y, hi_x, hi_y);
        const vf along_lo = dot(u_x, u_y, lo_x, lo_y), along_hi = dot(u_x, u_y, hi_x, hi_y);
        const vm rises_at_lo = v_le(v_set(0), after_lo), falls_at_hi = v_le(v_set(0), before_hi);
        const vm wide = v_lt(dot(lo_x, lo_y, hi_x, hi_y), v_set(0));
        const vm near_lo = vm_and(rises_at_lo, v_lt(v_set(0), along_lo));
        const vm near_hi = vm_and(falls_at_hi, v_lt(v_set(0), along_hi));
        const vm between = vm_or(vm_and(rises_at_lo, falls_at_hi), vm_and(wide, vm_or(near_lo, near_hi)));
        const vm kink = vm_and(rises, v_lt(after_lo, v_set(0)));
        const vm forward = vm_or(wide, v_lt(v_set(0), v_add(along_lo, along_hi)));
        const vm inside = vm_and(between, vm_and(forward, v_le(tiny, u2)));
        const vf length = v_sqrt(u2), radii = v_add(a.radius, b.radius);
        const vf value = v_sub(v_select(inside, length, along_lo), radii);
        const vm better = vm_and(vm_and(active, vm_or(between, kink)), v_lt(best.separation, value));
        rises = v_lt(before_hi, v_set(0));
        if (step == 0) {
            first_value = v_sub(along_lo, radii);
            best.n_x = lo_x;
            best.n_y = lo_y;
            best.record_a = record_a;
            best.record_b = record_b;
        }
        best.separation = v_select(better, value, best.separation);
        if (contact) {
            best.n_x = v_select(better, v_select(inside, u_x, lo_x), best.n_x);
            best.n_y = v_select(better, v_select(inside, u_y, lo_y), best.n_y);
            best.n_length = v_select(better, v_select(inside, length, v_set(1)), best.n_length);
            best.record_a = vi_select(better, record_a, best.record_a);
            best.record_b = vi_select(better, record_b, best.record_b);
        }
        lo_x = hi_x;
        lo_y = hi_y;
    }
    const vm none = v_lt(best.separation, v_set(-FLT_MAX));
    best.separation = v_select(none, first_value, best.separation);
    return best;
}
