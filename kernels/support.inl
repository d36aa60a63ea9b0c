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
enum { FOUND_SEPARATION = CORE, FOUND_X = DIRECTION_X, FOUND_Y = DIRECTION_Y };

/* Appends the pairs of the lanes `which`, with what was found of them, to a queue. */
static void finish(const struct lanes *lanes, vm which, const struct gap *gap, struct queue *finished) {
    float value[3][V_WIDTH];
    int32_t record[2][V_WIDTH];
    v_store(value[0], gap->separation);
    v_store(value[1], gap->n_x);
    v_store(value[2], gap->n_y);
    vi_store(record[0], gap->record_a);
    vi_store(record[1], gap->record_b);
    for (uint32_t bits = vm_bits(which); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits), k = finished->count++;
        copy_item(&lanes->pair, lane, finished, k);
        finished->item[FOUND_SEPARATION][k] = value[0][lane];
        finished->item[FOUND_X][k] = value[1][lane];
        finished->item[FOUND_Y][k] = value[2][lane];
        finished->record_a[k] = record[0][lane];
        finished->record_b[k] = record[1][lane];
    }
}

/* A normal is that of an edge if it is this close (radians): the normals that GJK and EPA compute are off by the
 * rounding of support points, over an edge's length. */
#define NEARLY_PARALLEL 0x1p-12f

static void file_finished(const narc_shapes *shapes, const struct queue *q, float margin, struct results *out) {
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
        const struct gap gap = {get(q, FOUND_SEPARATION, k),
                                get(q, FOUND_X, k),
                                get(q, FOUND_Y, k),
                                v_set(1),
                                vi_select(live, vi_load(q->record_a + k), ring_a.first),
                                vi_select(live, vi_load(q->record_b + k), ring_b.first)};
        file_gap(shapes, q, k, live, &gap, margin, NEARLY_PARALLEL, out);
    }
}

/* What a step finds, in each lane. */
struct verdict {
    vm collides, separate; /* the search has ended well, or as well as it can */
    vm stuck;              /* ... and rounding left no way on */
    vm limit;              /* it has ended because there were enough steps */
};
