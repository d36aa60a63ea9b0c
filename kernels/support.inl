/* SPDX-License-Identifier: MIT
 *
 * support.inl - what GJK and EPA ask of two bodies: the support points of both along a direction, and the geometry of
 * their difference; and how pairs take turns in the lanes of a vector.
 *
 * The difference B - A is the set of all b - a. It is convex, it holds the origin exactly if the bodies have a common
 * point, and its distance from the origin is the bodies' distance. For a unit direction m from A to B its point that
 * lies furthest towards -m is w = (b_j - r_j m) - (a_i + r_i m), i and j the arcs that hold m and -m: so w.m is the gap
 * g(m) of overlay.inl. Every direction gives a lower bound of the separation that way, whether the bodies collide or
 * not.
 */

/* What rounding may add to w or to g, relative to the numbers that go into them: overlay.inl's table, with |t| for D,
 * and for the extents the arcs' own |centre| + radius, comes to 53 roundings of the sum below. */
#define SUPPORT_NOISE 0x1p-20f

/* How far the ends of an edge that touches may seem to be off the support line by rounding, in terms of that: as a gap
 * may, at either end. */
#define NOISE_OF_EDGES 4

struct support {
    vf m_x, m_y; /* unit */
    vf w_x, w_y, gap;
    vf noise;
    vi record_a, record_b;
};

/* Which way along the ring an arc's neighbour is nearer to holding a direction: -1, 1, or 0 if the arc holds it. */
INLINE vi step_to(const struct arcs *arc, vf x, vf y) {
    const vm before = v_lt(cross(arc->start_x, arc->start_y, x, y), v_set(0));
    const vm behind = v_lt(cross(x, y, arc->end_x, arc->end_y), v_set(0));
    return vi_select(before, vi_set(-1), vi_select(behind, vi_set(1), vi_set(0)));
}

/* The support points of the pairs k ... of a queue along m, of any length. The look-up is right but for junctions
 * within 16 bits of m; where these matter, at edges, a few steps along the ring mend that. */
static inline struct support find_support(const narc_shapes *shapes, const struct queue *q, int k, vf m_x, vf m_y) {
    const narc_record *records = shapes->records;
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const vf length2 = dot(m_x, m_y, m_x, m_y), length = v_sqrt(length2);
    const vm is_short = v_lt(length2, v_set(0x1p-100f)); /* bodies in one place: any direction will do */
    const vf x = v_select(is_short, v_set(1), v_div(m_x, length)), y = v_select(is_short, v_set(0), v_div(m_y, length));
    const vf b_x = v_neg(v_add(v_mul(pose.q_c, x), v_mul(pose.q_s, y)));
    const vf b_y = v_sub(v_mul(pose.q_s, x), v_mul(pose.q_c, y));
    vi record_a = find_record(records, get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k), x, y);
    vi record_b = find_record(records, get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k), b_x, b_y);
    struct arcs a, b;
    for (int step = 0;; step++) {
        int32_t lanes[V_WIDTH];
        vi_store(lanes, record_a);
        a = load_arcs_a(records, lanes, &pose);
        vi_store(lanes, record_b);
        b = load_arcs_b(records, lanes, &pose);
        const vi to_a = step_to(&a, x, y), to_b = step_to(&b, x, y), zero = vi_set(0);
        const vm moves =
            vm_or(vm_or(vi_lt(to_a, zero), vi_lt(zero, to_a)), vm_or(vi_lt(to_b, zero), vi_lt(zero, to_b)));
        if (!vm_any(moves) || step == NARC_MAX_ARCS)
            break;
        record_a = step_record(ring_a, record_a, to_a);
        record_b = step_record(ring_b, record_b, to_b);
    }
    const vf u_x = v_sub(b.x, a.x), u_y = v_sub(b.y, a.y), radii = v_add(a.radius, b.radius);
    const vf of_a = v_add(v_add(v_abs(a.x), v_abs(a.y)), a.radius),
             of_b = v_add(v_add(v_abs(b.x), v_abs(b.y)), b.radius);
    const vf of_t = v_add(v_abs(pose.t_x), v_abs(pose.t_y));
    return (struct support){.m_x = x,
                            .m_y = y,
                            .w_x = v_sub(u_x, v_mul(radii, x)),
                            .w_y = v_sub(u_y, v_mul(radii, y)),
                            .gap = v_sub(dot(u_x, u_y, x, y), radii),
                            .noise = v_mul(v_set(SUPPORT_NOISE), v_add(v_add(of_a, of_b), of_t)),
                            .record_a = record_a,
                            .record_b = record_b};
}

/* The best of what support points have shown of a pair: the largest gap, and where. */
INLINE void keep_best(struct gap *best, const struct support *s, vm always) {
    const vm better = vm_or(always, v_lt(best->separation, s->gap));
    best->separation = v_select(better, s->gap, best->separation);
    best->n_x = v_select(better, s->m_x, best->n_x);
    best->n_y = v_select(better, s->m_y, best->n_y);
    best->record_a = vi_select(better, s->record_a, best->record_a);
    best->record_b = vi_select(better, s->record_b, best->record_b);
}

/* The point of a segment that is nearest to the origin. */
struct nearest {
    vf distance;
    vf m_x, m_y;   /* the direction from the origin to it: the segment's normal, which is more precise than the point,
                     * or an end */
    vm is_p, is_q; /* is it one of the ends? */
};

INLINE struct nearest nearest_of(vf p_x, vf p_y, vf q_x, vf q_y) {
    const vf zero = v_set(0), d_x = v_sub(q_x, p_x), d_y = v_sub(q_y, p_y);
    const vf from_p = v_neg(dot(p_x, p_y, d_x, d_y)), from_q = dot(q_x, q_y, d_x, d_y);
    const vf turn = cross(p_x, p_y, d_x, d_y), length = v_sqrt(dot(d_x, d_y, d_x, d_y));
    const vm left = v_lt(turn, zero), is_p = v_le(from_p, zero), is_q = vm_and_not(v_le(from_q, zero), is_p);
    const vf end_x = v_select(is_p, p_x, q_x), end_y = v_select(is_p, p_y, q_y);
    const vm at_end = vm_or(is_p, is_q);
    return (struct nearest){.distance =
                                v_select(at_end, v_sqrt(dot(end_x, end_y, end_x, end_y)), v_div(v_abs(turn), length)),
                            .m_x = v_select(at_end, end_x, v_select(left, v_neg(d_y), d_y)),
                            .m_y = v_select(at_end, end_y, v_select(left, d_x, v_neg(d_x))),
                            .is_p = is_p,
                            .is_q = is_q};
}

/* ------------------------------------------------------------------------------------------------ lanes */

/* Pairs need different numbers of steps. Each lane of a vector works on one pair, and takes the next of a queue when it
 * is done: so all lanes are busy until the queue is empty. */
struct lanes {
    struct queue pair;    /* the first V_WIDTH items */
    int32_t age[V_WIDTH]; /* steps done; -1: the lane is idle */
    int next;             /* the first pair of the queue that no lane has taken */
};

static void copy_item(const struct queue *from, int i, struct queue *to, int k) {
    for (int f = 0; f < FIELDS; f++)
        to->item[f][k] = from->item[f][i];
}

static void start_lanes(struct lanes *lanes) {
    lanes->next = 0;
    lanes->pair.count = 0;
    pad(&lanes->pair);
    for (int lane = 0; lane < V_WIDTH; lane++)
        lanes->age[lane] = -1;
}

/* Gives the idle lanes something to do. False if none has. */
static bool fill_lanes(struct lanes *lanes, const struct queue *q) {
    bool busy = false;
    for (int lane = 0; lane < V_WIDTH; lane++) {
        if (lanes->age[lane] < 0 && lanes->next < q->count) {
            copy_item(q, lanes->next++, &lanes->pair, lane);
            lanes->age[lane] = 0;
        }
        busy = busy || lanes->age[lane] >= 0;
    }
    return busy;
}

/* Another step is done; the lanes `done` are idle. */
INLINE void end_step(struct lanes *lanes, vm done) {
    const vi age = vi_load(lanes->age), idle = vi_set(-1);
    vi_store(lanes->age, vi_select(vm_or(done, vi_lt(age, vi_set(0))), idle, vi_add(age, vi_set(1))));
}

/* Fields of a pair that a search has no more use for: what it has found. The arcs go to record_a and record_b. */
enum { FOUND_SEPARATION = CORE, FOUND_NOISE = SLACK, FOUND_X = DIRECTION_X, FOUND_Y = DIRECTION_Y };

/* Appends the pairs of the lanes `which`, with what was found of them, to a queue. */
static void finish(const struct lanes *lanes, vm which, const struct gap *gap, vf noise, struct queue *finished) {
    float value[4][V_WIDTH];
    int32_t record[2][V_WIDTH];
    v_store(value[0], gap->separation);
    v_store(value[1], gap->n_x);
    v_store(value[2], gap->n_y);
    v_store(value[3], noise);
    vi_store(record[0], gap->record_a);
    vi_store(record[1], gap->record_b);
    for (uint32_t bits = vm_bits(which); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits), k = finished->count++;
        copy_item(&lanes->pair, lane, finished, k);
        finished->item[FOUND_SEPARATION][k] = value[0][lane];
        finished->item[FOUND_X][k] = value[1][lane];
        finished->item[FOUND_Y][k] = value[2][lane];
        finished->item[FOUND_NOISE][k] = value[3][lane];
        finished->record_a[k] = record[0][lane];
        finished->record_b[k] = record[1][lane];
    }
}

/* How far a shape's outline goes on beside its support point, along the edges there, and the angles of these edges with
 * the support line: `low` towards smaller positions along that line, `high` towards larger ones. */
struct slopes {
    vf low, high, low_angle, high_angle;
};

/* The sine of the angle between two directions; 1 if that is more than a right one. */
INLINE vf angle_to(vf j_x, vf j_y, vf n_x, vf n_y) {
    return v_select(v_lt(v_set(0), dot(j_x, j_y, n_x, n_y)), v_abs(cross(j_x, j_y, n_x, n_y)), v_set(1));
}

INLINE vf length_beside(const struct arcs *arc, const struct arcs *neighbour, vf j_x, vf j_y, vf angle) {
    const vf edge = cross(j_x, j_y, v_sub(neighbour->x, arc->x), v_sub(neighbour->y, arc->y));
    return v_add(v_abs(edge), v_mul(arc->radius, angle));
}

INLINE struct slopes slopes_of(const narc_record *records, struct ring ring, vi record, const struct pose *pose, vf n_x,
                               vf n_y, bool is_b) {
    struct arcs arc[3];
    for (int k = 0; k < 3; k++) {
        int32_t lanes[V_WIDTH];
        vi_store(lanes, step_record(ring, record, vi_set(k - 1)));
        arc[k] = is_b ? load_arcs_b(records, lanes, pose) : load_arcs_a(records, lanes, pose);
    }
    const vf start_angle = angle_to(arc[1].start_x, arc[1].start_y, n_x, n_y);
    const vf end_angle = angle_to(arc[1].end_x, arc[1].end_y, n_x, n_y);
    const vf start = length_beside(&arc[1], &arc[0], arc[1].start_x, arc[1].start_y, start_angle);
    const vf end = length_beside(&arc[1], &arc[2], arc[1].end_x, arc[1].end_y, end_angle);
    return is_b ? (struct slopes){end, start, end_angle, start_angle}
                : (struct slopes){start, end, start_angle, end_angle};
}

/* By how much a stretch may grow towards another one, `gap` away: as far as its edge goes on and stays within `loose`
 * of the support line. */
INLINE vf growth(const struct touch *touch, vf gap, vf length, vf angle, vf loose) {
    const vf rest = v_sub(length, v_sub(touch->along_max, touch->along_min));
    const vf near = v_div(loose, v_max(angle, v_set(PARALLEL)));
    return v_max(v_min(gap, v_min(rest, near)), v_set(0));
}

/* Files contacts as file_gap() does, but where normals are off so far that an edge's ends are off the support line by
 * up to `loose`, the support points of A and B may be at far ends of what touches. So each stretch grows towards the
 * other, as far as that allows. */
static void file_loosely(const narc_shapes *shapes, const struct queue *q, int k, vm live, const struct gap *gap,
                         float margin, vf loose, struct results *out) {
    const narc_record *records = shapes->records;
    const vf n_x = gap->n_x, n_y = gap->n_y;
    const vm keep = vm_and(live, closer_than(gap->separation, margin));
    if (!vm_any(keep))
        return;
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    struct touch on_a = touch_of(records, ring_a, gap->record_a, &pose, n_x, n_y, false);
    struct touch on_b = touch_of(records, ring_b, gap->record_b, &pose, n_x, n_y, true);
    const struct slopes a = slopes_of(records, ring_a, gap->record_a, &pose, n_x, n_y, false);
    const struct slopes b = slopes_of(records, ring_b, gap->record_b, &pose, n_x, n_y, true);
    const vf b_above = v_sub(on_b.along_min, on_a.along_max), a_above = v_sub(on_a.along_min, on_b.along_max);
    const vf a_up = growth(&on_a, b_above, a.high, a.high_angle, loose);
    const vf a_down = growth(&on_a, a_above, a.low, a.low_angle, loose);
    const vf b_up = growth(&on_b, a_above, b.high, b.high_angle, loose);
    const vf b_down = growth(&on_b, b_above, b.low, b.low_angle, loose);
    on_a.along_max = v_add(on_a.along_max, a_up);
    on_a.along_min = v_sub(on_a.along_min, a_down);
    on_b.along_max = v_add(on_b.along_max, b_up);
    on_b.along_min = v_sub(on_b.along_min, b_down);
    file_contacts(q, k, keep, gap->separation, n_x, n_y, &on_a, &on_b, out);
}

/* The contacts of what GJK and EPA have found: their normals are off as far as the tolerance allows. */
static void file_finished(const narc_batch *batch, const struct queue *q, float margin, struct results *out) {
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
        const struct gap gap = {get(q, FOUND_SEPARATION, k),
                                get(q, FOUND_X, k),
                                get(q, FOUND_Y, k),
                                v_set(1),
                                vi_select(live, vi_load(q->record_a + k), ring_a.first),
                                vi_select(live, vi_load(q->record_b + k), ring_b.first)};
        const vf tolerance = v_mul(v_set(batch->tolerance), get(q, SIZE, k));
        const vf loose = v_max(tolerance, v_mul(v_set(NOISE_OF_EDGES), get(q, FOUND_NOISE, k)));
        file_loosely(batch->shapes, q, k, live, &gap, margin, loose, out);
    }
}

/* What a step finds, in each lane. */
struct verdict {
    vm collides, separate; /* the search has ended well, or as well as it can */
    vm stuck;              /* ... and rounding left no way on */
    vm limit;              /* it has ended because there were enough steps */
};
