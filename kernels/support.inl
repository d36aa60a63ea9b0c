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

/* When a search ends for want of precision, relative to the numbers that go into w: overlay.inl's table, with |t| for D
 * and the arcs' own |centre| + radius for the extents, comes to 53 roundings of their sum at worst; 16 are seldom
 * exceeded, and more would end searches that can still go on. */
#define SUPPORT_NOISE 0x1p-20f

struct support {
    vf m_x, m_y; /* unit */
    vf w_x, w_y, gap;
    vf middle_x, middle_y; /* of the two support points */
    vf noise;
    vi record_a, record_b;
};

/* Which way along the ring an arc's neighbour is nearer to holding a direction: -1, 1, or 0 if the arc holds it. */
INLINE vi step_to(const struct arcs *arc, vf x, vf y) {
    const vm before = v_lt(cross(arc->start_x, arc->start_y, x, y), v_set(0));
    const vm behind = v_lt(cross(x, y, arc->end_x, arc->end_y), v_set(0));
    return vi_select(before, vi_set(-1), vi_select(behind, vi_set(1), vi_set(0)));
}

/* The support points of the pairs k ... of a queue along m, of any length, in the lanes `live`. The look-up is right
 * but for junctions within 16 bits of m; where these matter, at edges, a few steps along the ring mend that. */
INLINE struct support find_support(const narc_shapes *shapes, const struct queue *q, int k, vm live, vf m_x, vf m_y) {
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
        if (!vm_any(vm_and(live, moves)) || step == NARC_MAX_ARCS)
            break;
        record_a = step_record(ring_a, record_a, to_a);
        record_b = step_record(ring_b, record_b, to_b);
    }
    const vf u_x = v_sub(b.x, a.x), u_y = v_sub(b.y, a.y), radii = v_add(a.radius, b.radius);
    const vf of_a = v_add(v_add(v_abs(a.x), v_abs(a.y)), a.radius),
             of_b = v_add(v_add(v_abs(b.x), v_abs(b.y)), b.radius);
    const vf half = v_set(0.5f), lean = v_sub(a.radius, b.radius);
    const vf of_t = v_add(v_abs(pose.t_x), v_abs(pose.t_y));
    return (struct support){.m_x = x,
                            .m_y = y,
                            .w_x = v_sub(u_x, v_mul(radii, x)),
                            .w_y = v_sub(u_y, v_mul(radii, y)),
                            .gap = v_sub(dot(u_x, u_y, x, y), radii),
                            .middle_x = v_mul(half, v_add(v_add(a.x, b.x), v_mul(lean, x))),
                            .middle_y = v_mul(half, v_add(v_add(a.y, b.y), v_mul(lean, y))),
                            .noise = v_mul(v_set(SUPPORT_NOISE), v_add(v_add(of_a, of_b), of_t)),
                            .record_a = record_a,
                            .record_b = record_b};
}

/* A support point of the difference, the middle between the bodies' own, and the direction it was found along. */
struct vertex {
    vf x, y, middle_x, middle_y, turn;
};

INLINE struct vertex select_vertex(vm m, const struct vertex *a, const struct vertex *b) {
    return (struct vertex){v_select(m, a->x, b->x), v_select(m, a->y, b->y), v_select(m, a->middle_x, b->middle_x),
                           v_select(m, a->middle_y, b->middle_y), v_select(m, a->turn, b->turn)};
}

/* The point of a segment between two vertices that is nearest to the origin, and what lies between the bodies there. */
struct nearest {
    vf distance;
    vf m_x, m_y; /* the direction from the origin to it: the segment's normal, which is more precise than the point, or
                  * an end */
    vf middle_x, middle_y;
    vm is_p, is_q; /* is it one of the ends? */
};

INLINE struct nearest nearest_of(const struct vertex *p, const struct vertex *q) {
    const vf zero = v_set(0), d_x = v_sub(q->x, p->x), d_y = v_sub(q->y, p->y);
    const vf from_p = v_neg(dot(p->x, p->y, d_x, d_y)), from_q = dot(q->x, q->y, d_x, d_y);
    const vf turn = cross(p->x, p->y, d_x, d_y), length = v_sqrt(dot(d_x, d_y, d_x, d_y));
    const vm left = v_lt(turn, zero), is_p = v_le(from_p, zero), is_q = vm_and_not(v_le(from_q, zero), is_p);
    const vf end_x = v_select(is_p, p->x, q->x), end_y = v_select(is_p, p->y, q->y);
    const vm at_end = vm_or(is_p, is_q);
    const vf part = v_select(is_p, zero, v_select(is_q, v_set(1), v_div(from_p, v_add(from_p, from_q))));
    return (struct nearest){.distance =
                                v_select(at_end, v_sqrt(dot(end_x, end_y, end_x, end_y)), v_div(v_abs(turn), length)),
                            .m_x = v_select(at_end, end_x, v_select(left, v_neg(d_y), d_y)),
                            .m_y = v_select(at_end, end_y, v_select(left, d_x, v_neg(d_x))),
                            .middle_x = v_add(p->middle_x, v_mul(part, v_sub(q->middle_x, p->middle_x))),
                            .middle_y = v_add(p->middle_y, v_mul(part, v_sub(q->middle_y, p->middle_y))),
                            .is_p = is_p,
                            .is_q = is_q};
}

/* What a search has found of a pair: a gap, its direction and arcs, and the point between the bodies, halfway between
 * the support lines (`across`, its position along n) and where a segment says (`along` them). */
struct best {
    vf separation, n_x, n_y;
    vf across, along;
    vi record_a, record_b;
};

/* Keeps the largest gap, or in the lanes `always` the last; (x, y) is the point of its segment. */
INLINE void keep_best(struct best *best, const struct support *s, vf x, vf y, vm always) {
    const vm better = vm_or(always, v_lt(best->separation, s->gap));
    best->separation = v_select(better, s->gap, best->separation);
    best->n_x = v_select(better, s->m_x, best->n_x);
    best->n_y = v_select(better, s->m_y, best->n_y);
    best->across = v_select(better, dot(s->m_x, s->m_y, s->middle_x, s->middle_y), best->across);
    best->along = v_select(better, cross(s->m_x, s->m_y, x, y), best->along);
    best->record_a = vi_select(better, s->record_a, best->record_a);
    best->record_b = vi_select(better, s->record_b, best->record_b);
}

/* ------------------------------------------------------------------------------------------------ lanes */

/* Pairs need different numbers of steps. Each lane of a vector works on one pair, and takes the next of a queue when it
 * is done: so all lanes are busy until the queue is empty. */
struct lanes {
    struct queue pair;    /* the first V_WIDTH items */
    int32_t age[V_WIDTH]; /* steps done; -1: the lane is idle */
    int from[V_WIDTH];    /* the place in the queue */
    bool begins[V_WIDTH]; /* has the lane just taken a pair? */
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
        lanes->begins[lane] = lanes->age[lane] < 0 && lanes->next < q->count;
        if (lanes->begins[lane]) {
            lanes->from[lane] = lanes->next;
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
enum {
    FOUND_SEPARATION = CORE,
    FOUND_X = DIRECTION_X,
    FOUND_Y = DIRECTION_Y,
    FOUND_ACROSS = AXIS_X,
    FOUND_ALONG = AXIS_Y
};

/* Appends the pairs of the lanes `which`, with what was found of them, to a queue. */
INLINE void finish(const struct lanes *lanes, vm which, const struct best *best, struct queue *finished) {
    static const int fields[] = {FOUND_SEPARATION, FOUND_X, FOUND_Y, FOUND_ACROSS, FOUND_ALONG};
    const vf found[] = {best->separation, best->n_x, best->n_y, best->across, best->along};
    enum { COUNT = sizeof fields / sizeof fields[0] };
    float value[COUNT][V_WIDTH];
    int32_t record[2][V_WIDTH];
    for (int f = 0; f < COUNT; f++)
        v_store(value[f], found[f]);
    vi_store(record[0], best->record_a);
    vi_store(record[1], best->record_b);
    for (uint32_t bits = vm_bits(which); bits; bits &= bits - 1) {
        const int lane = __builtin_ctz(bits), k = finished->count++;
        copy_item(&lanes->pair, lane, finished, k);
        for (int f = 0; f < COUNT; f++)
            finished->item[fields[f]][k] = value[f][lane];
        finished->record_a[k] = record[0][lane];
        finished->record_b[k] = record[1][lane];
    }
}

/* The contacts of what GJK and EPA have found. */
static void file_finished(const struct queue *q, float margin, struct results *out) {
    for (int k = 0; k < q->count; k += V_WIDTH) {
        const vf separation = get(q, FOUND_SEPARATION, k), n_x = get(q, FOUND_X, k), n_y = get(q, FOUND_Y, k);
        const vf across = get(q, FOUND_ACROSS, k), along = get(q, FOUND_ALONG, k);
        const struct touch on_a = {across, along, along, vi_load(q->record_a + k)};
        const struct touch on_b = {across, along, along, vi_load(q->record_b + k)};
        const vm keep = vm_and(vm_first(q->count - k), closer_than(separation, margin));
        file_contacts(q, k, keep, separation, n_x, n_y, &on_a, &on_b, out);
    }
}
