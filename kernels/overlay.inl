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
 * The angle that orders the junctions is the diamond angle, monotonic in the true one: 0 along +x, 1 along +y, at most 4.
 * It may swap junctions that agree up to rounding, which the line on junction normals covers. Junctions of one shape
 * never swap: their normals differ by more than NARC_TOLERANCE.
 */

/* One junction and the arc that starts there, for all lanes. */
enum { TURN, NORMAL_X, NORMAL_Y, CENTER_X, CENTER_Y, RADIUS, SLOT_FIELDS };
enum { SLOT = SLOT_FIELDS * V_WIDTH };

/* Both shapes of each lane in A's frame at world scale: A's slots, then B's with negated normals. */
struct overlay {
    float slots[2 * NARC_MAX_ARCS * SLOT];
};

/* A position in the slots of one shape, a float index for each lane, and where that shape begins and ends. */
struct cursor {
    vi at, begin, end;
};

INLINE vf field(const struct overlay *o, int which, vi at) { return v_gather(o->slots + which * V_WIDTH, at); }

INLINE vi next_slot(struct cursor c, vi at) {
    const vi next = vi_add(at, vi_set(SLOT));
    return vi_select(vi_lt(next, c.end), next, c.begin);
}

INLINE vi previous_slot(struct cursor c, vi at) {
    return vi_add(vi_select(vi_lt(c.begin, at), at, c.end), vi_set(-SLOT));
}

/* The diamond angle of a direction of any length. */
INLINE vf turn_of(vf x, vf y) {
    const vf p = v_div(x, v_add(v_abs(x), v_abs(y)));
    return v_select(v_le(v_set(0), y), v_sub(v_set(1), p), v_add(v_set(3), p));
}

INLINE vf cross(vf a_x, vf a_y, vf b_x, vf b_y) { return v_sub(v_mul(a_x, b_y), v_mul(a_y, b_x)); }

INLINE vf dot(vf a_x, vf a_y, vf b_x, vf b_y) { return v_add(v_mul(a_x, b_x), v_mul(a_y, b_y)); }

/* The largest of the lanes' counts. */
INLINE int max_lane(vi counts) {
    int32_t lane[V_WIDTH];
    int most = 0;
    vi_store(lane, counts);
    for (int k = 0; k < V_WIDTH; k++)
        most = lane[k] > most ? lane[k] : most;
    return most;
}

/* An arc in each lane, in A's frame at world scale, normals from A to B: those of B point the other way. */
struct arcs {
    vf x, y, radius, inner;
    vf start_x, start_y, end_x, end_y;
};

/* The arc of A in each lane's record. */
INLINE struct arcs load_arcs_a(const narc_record *records, const int32_t *record, vf scale) {
    vf row[8];
    v_rows(records, sizeof *records, record, row);
    v_rows(&records->arc.start_x, sizeof *records, record, row + 4);
    return (struct arcs){v_mul(row[0], scale), v_mul(row[1], scale), v_mul(row[2], scale), v_mul(row[3], scale), row[4],
                         row[5],               row[6],               row[7]};
}

/* B's pose in A's frame. */
struct pose {
    vf t_x, t_y, q_c, q_s, scale;
};

INLINE struct pose get_pose(const struct queue *q, int k) {
    return (struct pose){get(q, T_X, k), get(q, T_Y, k), get(q, Q_C, k), get(q, Q_S, k), get(q, SCALE_B, k)};
}

INLINE struct arcs load_arcs_b(const narc_record *records, const int32_t *record, const struct pose *p) {
    vf row[8];
    v_rows(records, sizeof *records, record, row);
    v_rows(&records->arc.start_x, sizeof *records, record, row + 4);
    const vf x = v_sub(v_mul(p->q_c, row[0]), v_mul(p->q_s, row[1]));
    const vf y = v_add(v_mul(p->q_s, row[0]), v_mul(p->q_c, row[1]));
    return (struct arcs){v_add(p->t_x, v_mul(x, p->scale)),
                         v_add(p->t_y, v_mul(y, p->scale)),
                         v_mul(row[2], p->scale),
                         v_mul(row[3], p->scale),
                         v_sub(v_mul(p->q_s, row[5]), v_mul(p->q_c, row[4])),
                         v_neg(v_add(v_mul(p->q_s, row[4]), v_mul(p->q_c, row[5]))),
                         v_sub(v_mul(p->q_s, row[7]), v_mul(p->q_c, row[6])),
                         v_neg(v_add(v_mul(p->q_s, row[6]), v_mul(p->q_c, row[7])))};
}

INLINE void put_slot(struct overlay *o, int slot, const struct arcs *arcs, vf turn) {
    float *out = o->slots + slot * SLOT;
    v_store(out + TURN * V_WIDTH, turn);
    v_store(out + NORMAL_X * V_WIDTH, arcs->start_x);
    v_store(out + NORMAL_Y * V_WIDTH, arcs->start_y);
    v_store(out + CENTER_X * V_WIDTH, arcs->x);
    v_store(out + CENTER_Y * V_WIDTH, arcs->y);
    v_store(out + RADIUS * V_WIDTH, arcs->radius);
}

/* The best candidate of each lane so far. */
struct gap {
    vf separation;
    vf n_x, n_y, n_length; /* the normal, not yet divided by its length */
    vi arc_a, arc_b;       /* slots */
};

/* The separation of each lane for which `live` holds (elsewhere +infinity). Without `contact` only separation is set,
 * and the walk ends as soon as every lane is known not to collide: then it is some value >= 0. */
static inline struct gap overlay_gap(const struct overlay *o, struct cursor a, struct cursor b, vi steps, vm live,
                                     bool contact) {
    const vf tiny = v_set(0x1p-126f); /* the least normal float: a smaller |u|^2 has lost its digits */
    const vf start = v_select(live, v_set(-INFINITY), v_set(INFINITY));
    struct gap best = {start, v_set(0), v_set(0), v_set(1), a.begin, b.begin};
    vi arc_a = previous_slot(a, a.at), arc_b = previous_slot(b, b.at);
    vf a_x = field(o, CENTER_X, arc_a), a_y = field(o, CENTER_Y, arc_a), a_r = field(o, RADIUS, arc_a);
    vf b_x = field(o, CENTER_X, arc_b), b_y = field(o, CENTER_Y, arc_b), b_r = field(o, RADIUS, arc_b);
    /* Angles of at least 0 have the order of their bits, as integers. Those of this turn, 0 to 4, are moved down so
     * that all of the next turn follow them; exactly, so that the last interval ends where the first one began. */
    const vi this_turn = vi_set(-0x40800001); /* the bits of 4.0f, and one more */
    vi a_turn = vi_add(vi_bits(field(o, TURN, a.at)), this_turn);
    vi b_turn = vi_add(vi_bits(field(o, TURN, b.at)), this_turn);
    vf a_nx = field(o, NORMAL_X, a.at), a_ny = field(o, NORMAL_Y, a.at);
    vf b_nx = field(o, NORMAL_X, b.at), b_ny = field(o, NORMAL_Y, b.at);
    /* Does g rise towards the first junction, at the end of the interval before it? */
    const vm first_is_a = vi_lt(a_turn, b_turn);
    vm rises = v_lt(
        cross(v_sub(b_x, a_x), v_sub(b_y, a_y), v_select(first_is_a, a_nx, b_nx), v_select(first_is_a, a_ny, b_ny)),
        v_set(0));
    vf first_value = v_set(0);
    for (int step = 0;; step++) {
        vm active = vm_and(live, vi_lt(vi_set(step), steps));
        if (!contact)
            active = vm_and(active, v_lt(best.separation, v_set(0)));
        if (!vm_any(active))
            break;

        /* Pass the nearer of the two junctions ahead: it is lo, and its arc takes over. */
        const vm is_a = vi_lt(a_turn, b_turn);
        const vf lo_x = v_select(is_a, a_nx, b_nx), lo_y = v_select(is_a, a_ny, b_ny);
        const vi passed = vi_select(is_a, a.at, b.at);
        const vf x = field(o, CENTER_X, passed), y = field(o, CENTER_Y, passed), r = field(o, RADIUS, passed);
        a_x = v_select(is_a, x, a_x);
        a_y = v_select(is_a, y, a_y);
        a_r = v_select(is_a, r, a_r);
        b_x = v_select(is_a, b_x, x);
        b_y = v_select(is_a, b_y, y);
        b_r = v_select(is_a, b_r, r);
        arc_a = vi_select(is_a, passed, arc_a);
        arc_b = vi_select(is_a, arc_b, passed);

        /* The junction ahead of it on that shape, a turn later where the list begins anew. */
        const vi next_a = next_slot(a, a.at), next_b = next_slot(b, b.at);
        const vi ahead = vi_select(is_a, next_a, next_b);
        const vf n_x = field(o, NORMAL_X, ahead), n_y = field(o, NORMAL_Y, ahead);
        const vi next_turn = vi_bits(field(o, TURN, ahead)), turn = vi_add(next_turn, this_turn);
        const vi later = vi_select(vi_lt(turn, vi_select(is_a, a_turn, b_turn)), next_turn, turn);
        a.at = vi_select(is_a, ahead, a.at);
        b.at = vi_select(is_a, b.at, ahead);
        a_turn = vi_select(is_a, later, a_turn);
        a_nx = v_select(is_a, n_x, a_nx);
        a_ny = v_select(is_a, n_y, a_ny);
        b_turn = vi_select(is_a, b_turn, later);
        b_nx = v_select(is_a, b_nx, n_x);
        b_ny = v_select(is_a, b_ny, n_y);
        const vm hi_is_a = vi_lt(a_turn, b_turn);
        const vf hi_x = v_select(hi_is_a, a_nx, b_nx), hi_y = v_select(hi_is_a, a_ny, b_ny);

        /* The largest g at lo or between lo and hi, if there is a local maximum. */
        const vf u_x = v_sub(b_x, a_x), u_y = v_sub(b_y, a_y);
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
        const vf length = v_sqrt(u2);
        const vf value = v_sub(v_select(inside, length, along_lo), v_add(a_r, b_r));
        const vm better = vm_and(vm_and(active, vm_or(between, kink)), v_lt(best.separation, value));
        rises = v_lt(before_hi, v_set(0));
        if (step == 0) {
            first_value = v_sub(along_lo, v_add(a_r, b_r));
            best.n_x = lo_x;
            best.n_y = lo_y;
            best.arc_a = arc_a;
            best.arc_b = arc_b;
        }
        best.separation = v_select(better, value, best.separation);
        if (contact) {
            best.n_x = v_select(better, v_select(inside, u_x, lo_x), best.n_x);
            best.n_y = v_select(better, v_select(inside, u_y, lo_y), best.n_y);
            best.n_length = v_select(better, v_select(inside, length, v_set(1)), best.n_length);
            best.arc_a = vi_select(better, arc_a, best.arc_a);
            best.arc_b = vi_select(better, arc_b, best.arc_b);
        }
    }
    const vm none = v_lt(best.separation, v_set(-FLT_MAX));
    best.separation = v_select(none, first_value, best.separation);
    return best;
}

/* Lays out the pairs k ... of a queue; the cursors stand at the first junctions counter-clockwise from +x. */
static void place_pairs(struct overlay *o, const narc_shapes *shapes, const struct queue *q, int k,
                               struct cursor *out_a, struct cursor *out_b, vi *out_steps) {
    const vi count_a = head_count(get_bits(q, BYTES_A, k)), count_b = head_count(get_bits(q, BYTES_B, k));
    const vi record_a = first_record(get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k));
    const vi record_b = first_record(get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k));
    const vf scale_a = get(q, SCALE_A, k);
    const struct pose pose = get_pose(q, k);
    const int most_a = max_lane(count_a), most_b = max_lane(count_b);
    vi at = vi_lanes(), end = at;
    for (int i = 0; i < most_a; i++) {
        const vm exists = vi_lt(vi_set(i), count_a);
        int32_t record[V_WIDTH];
        vi_store(record, vi_add(record_a, vi_select(exists, vi_set(i), vi_set(0))));
        const struct arcs arcs = load_arcs_a(shapes->records, record, scale_a);
        put_slot(o, i, &arcs, turn_of(arcs.start_x, arcs.start_y));
        at = vi_add(at, vi_set(SLOT));
        end = vi_select(exists, at, end);
    }
    *out_a = (struct cursor){vi_lanes(), vi_lanes(), end};

    at = vi_add(vi_set(most_a * SLOT), vi_lanes());
    struct cursor c = {at, at, at};
    vf first_turn = v_set(INFINITY);
    for (int i = 0; i < most_b; i++) {
        const vm exists = vi_lt(vi_set(i), count_b);
        int32_t record[V_WIDTH];
        vi_store(record, vi_add(record_b, vi_select(exists, vi_set(i), vi_set(0))));
        const struct arcs arcs = load_arcs_b(shapes->records, record, &pose);
        const vf turn = turn_of(arcs.start_x, arcs.start_y);
        put_slot(o, most_a + i, &arcs, turn);
        const vm earlier = vm_and(exists, v_lt(turn, first_turn));
        first_turn = v_select(earlier, turn, first_turn);
        c.at = vi_select(earlier, at, c.at);
        at = vi_add(at, vi_set(SLOT));
        c.end = vi_select(exists, at, c.end);
    }
    *out_b = c;
    *out_steps = vi_add(count_a, count_b);
}
