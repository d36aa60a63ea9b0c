/* SPDX-License-Identifier: MIT
 *
 * relative.inl - stage 1: a block of pairs from the caller's columns to B's pose in A's frame, and a first filter by
 * circles. The pairs that it leaves are packed densely into a queue, which the later stages read.
 *
 * With d = position B - position A and rotations as complex numbers, B's frame in A's is
 *     t = d / rotation A,   q = rotation B / rotation A,
 * so that a point p of B lies at t + scale_b q p where a point p of A lies at scale_a p. Both keep their scale: nothing
 * is divided.
 *
 * The filter may only say what the deciding formula (overlay.inl) would say after all its rounding. That formula is
 * within 32 e (D + E_a + E_b) of exact, e = 2^-24, D = |d|, E the extents; the bounding radii are 96 e E too large and
 * the inner ones 96 e E too small (store.h). Let s be the distance between two circles' centres, D <= s + E_a + E_b.
 *
 *   apart   s (1 - 2^-17) > sum of bounding radii + margin. Then the exact gap exceeds the margin by more than
 *           128 e s + 96 e (E_a + E_b), of which the formula can lose 32 e s + 64 e (E_a + E_b).
 *   deep    s (1 + 2^-17) < sum of inner radii. Then s + the distances of the centres from their origins are at most
 *           E_a + E_b, and so is D; the exact gap is below -96 e (E_a + E_b), and the formula can add 64 e (E_a + E_b).
 *
 * What is left over covers the rounding of s itself.
 */

/* Pairs in a block: enough to fill vectors after most pairs are settled, few enough for all stages to stay in the first
 * cache. Stages that few pairs reach wait for FLUSH of them. */
enum { BLOCK = 128, FLUSH = 32, STAGES = 4 };

/* Draining a queue leaves less than FLUSH pairs in it, and adds at most all that it held to the next one: so the first
 * of STAGES queues holds up to BLOCK pairs, and each one after it up to FLUSH more. Behind the last pair there may be
 * two vectors, of what push() and pad() write. */
enum { CAPACITY = BLOCK + (STAGES - 1) * FLUSH + 2 * V_WIDTH };

/* Pairs between stages, dense, structure of arrays. Integers are kept as their bits. */
enum {
    T_X, /* B's pose in A's frame */
    T_Y,
    Q_C,
    Q_S,
    SCALE_A,
    SCALE_B,
    AXIS_X, /* from the centre of A's inscribed circle to that of B's */
    AXIS_Y,
    CORE,    /* the sum of both inscribed radii */
    SLACK,   /* see slack_of() */
    BLOCK_A, /* the first two words of the shapes' heads (store.h) */
    BLOCK_B,
    BYTES_A,
    BYTES_B,
    PAIR,        /* counted from the first of the call, or of a group */
    DIRECTION_X, /* where to look next, at first along the axis */
    DIRECTION_Y,
    COSINE_A, /* A's rotation */
    SINE_A,
    SIZE, /* the sum of both bounding radii */
    FIELDS,
    OVERLAP_FIELDS = COSINE_A, /* who wants no contact needs no rotation */
    CONTACT_FIELDS = SIZE
};

struct queue {
    _Alignas(64) float item[FIELDS][CAPACITY];      /* so that whole vectors do not lie across cache lines */
    int32_t record_a[CAPACITY], record_b[CAPACITY]; /* not packed: written and read while the queue stands still */
    int32_t hinted[CAPACITY];
    int count;
};

INLINE vf get(const struct queue *q, int field, int k) { return v_load(q->item[field] + k); }

INLINE vi get_bits(const struct queue *q, int field, int k) { return vi_bits(get(q, field, k)); }

INLINE void get_item(const struct queue *q, int k, vf *item, int fields) {
    UNROLL
    for (int f = 0; f < fields; f++)
        item[f] = get(q, f, k);
}

/* Appends the lanes `keep` of `item`. */
INLINE void push(struct queue *q, vm keep, const vf *item, int fields) {
    const vp packing = vm_packing(keep);
    const int at = q->count;
    UNROLL
    for (int f = 0; f < fields; f++)
        v_store(q->item[f] + at, v_pack(packing, item[f]));
    q->count = at + __builtin_popcount(vm_bits(keep));
}

/* The last vector of a queue may have lanes behind the last pair: harmless ones, with one arc, the first of all. */
static void pad(struct queue *q) {
    for (int f = 0; f < FIELDS; f++)
        v_store(q->item[f] + q->count, v_set(0));
    v_store(q->item[BYTES_A] + q->count, v_of_bits(vi_set(1)));
    v_store(q->item[BYTES_B] + q->count, v_of_bits(vi_set(1)));
}

/* How the bodies' columns lie: if x, y, cosine and sine follow each other, four floats are read at once. */
static bool poses_are_rows(const narc_bodies *bodies) {
    const char *x = bodies->x.base;
    const size_t stride = bodies->x.stride;
    return bodies->position_precision == NARC_FLOAT32 && bodies->y.base == (const void *)(x + sizeof(float)) &&
           bodies->cosine.base == (const void *)(x + 2 * sizeof(float)) &&
           bodies->sine.base == (const void *)(x + 3 * sizeof(float)) && bodies->y.stride == stride &&
           bodies->cosine.stride == stride && bodies->sine.stride == stride;
}

/* Position of b minus position of a, rounded once. */
INLINE float difference(narc_precision precision, narc_column column, size_t a, size_t b) {
    if (precision == NARC_FLOAT64)
        return (float)(narc_double_at(column, b) - narc_double_at(column, a));
    return narc_float_at(column, b) - narc_float_at(column, a);
}

INLINE vf column_lanes(narc_column column, const int32_t *index) {
    float lane[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++)
        lane[k] = narc_float_at(column, (uint32_t)index[k]);
    return v_load(lane);
}

/* Two bodies in each lane: the difference of their positions, and their rotations. */
struct poses {
    vf d_x, d_y, c_a, s_a, c_b, s_b;
};

INLINE struct poses load_poses(const narc_bodies *bodies, bool rows, const int32_t *a, const int32_t *b) {
    if (rows) {
        vf of_a[4], of_b[4];
        v_rows(bodies->x.base, bodies->x.stride, a, of_a);
        v_rows(bodies->x.base, bodies->x.stride, b, of_b);
        return (struct poses){v_sub(of_b[0], of_a[0]), v_sub(of_b[1], of_a[1]), of_a[2], of_a[3], of_b[2], of_b[3]};
    }
    float d_x[V_WIDTH], d_y[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++) {
        d_x[k] = difference(bodies->position_precision, bodies->x, (uint32_t)a[k], (uint32_t)b[k]);
        d_y[k] = difference(bodies->position_precision, bodies->y, (uint32_t)a[k], (uint32_t)b[k]);
    }
    return (struct poses){v_load(d_x),
                          v_load(d_y),
                          column_lanes(bodies->cosine, a),
                          column_lanes(bodies->sine, a),
                          column_lanes(bodies->cosine, b),
                          column_lanes(bodies->sine, b)};
}

/* The head of a shape in each lane. */
struct heads {
    vi block, bytes;
    vf bound_x, bound_y, bound_radius, inner_x, inner_y, inner_radius;
};

INLINE struct heads load_heads(const narc_head *heads, const int32_t *shape) {
    vf row[8];
    v_rows(heads, sizeof *heads, shape, row);
    v_rows(&heads->bound_radius, sizeof *heads, shape, row + 4);
    return (struct heads){vi_bits(row[0]), vi_bits(row[1]), row[2], row[3], row[4], row[5], row[6], row[7]};
}

INLINE vi head_count(vi bytes) { return vi_and(bytes, vi_set(0xff)); }

/* The record of the first arc, see store.h. */
INLINE vi first_record(vi block, vi bytes) {
    return vi_add(block, vi_shift_right(vi_add(head_count(bytes), vi_set(NARC_TURNS - 1)), 4));
}

INLINE vi head_first(vi bytes) { return vi_and(vi_shift_right(bytes, 8), vi_set(0xff)); }

INLINE vm head_is(vi bytes, int flag) { return vi_lt(vi_set(0), vi_and(bytes, vi_set(flag << 16))); }

/* The bodies and shapes of a pair in each lane. Lanes from `count` on repeat the first. */
struct pair_indices {
    _Alignas(64) int32_t a[BLOCK], b[BLOCK], shape_a[BLOCK], shape_b[BLOCK];
};

INLINE void load_indices(const narc_batch *batch, size_t first, int count, struct pair_indices *out) {
    const narc_column column_a = batch->pairs->a, column_b = batch->pairs->b, shape = batch->bodies->shape;
    for (int k = 0; k < count; k++) {
        const uint32_t a = narc_index_at(column_a, first + (size_t)k), b = narc_index_at(column_b, first + (size_t)k);
        out->a[k] = (int32_t)a;
        out->b[k] = (int32_t)b;
        out->shape_a[k] = (int32_t)narc_index_at(shape, a);
        out->shape_b[k] = (int32_t)narc_index_at(shape, b);
    }
    for (int k = count; k % V_WIDTH != 0; k++) {
        out->a[k] = out->a[0];
        out->b[k] = out->b[0];
        out->shape_a[k] = out->shape_a[0];
        out->shape_b[k] = out->shape_b[0];
    }
}

/* One over the length of a rotation that is nearly 1: one step of Newton's method for the inverse root of the square,
 * from 1, which leaves 3/8 of the square's error squared, 1.5 e at most. In lanes where the square is off by more than
 * NARC_ROTATION_TOLERANCE, `out_valid` is false. */
INLINE vf inverse_length(vf c, vf s, vm *out_valid) {
    const vf off = v_sub(v_add(v_mul(c, c), v_mul(s, s)), v_set(1));
    *out_valid = v_le(v_abs(off), v_set((float)NARC_ROTATION_TOLERANCE));
    return v_sub(v_set(1), v_mul(v_set(0.5f), off));
}

INLINE vm within(vf value, float limit) { return v_le(v_abs(value), v_set(limit)); }

/* The bounding radius has 96 e of the extent in it, so this keeps scaled coordinates below 2e14, too. */
INLINE vm size_in_range(vf size) {
    return vm_and(v_le(v_set((float)NARC_MIN_SIZE), size), v_le(size, v_set((float)NARC_HEAD_MAX_RADIUS)));
}

/* 128 e (D + E_a + E_b), four times what the deciding formula can be off by: what a value from the same arithmetic must
 * be clear of, before it can stand for the formula's. Infinite where an extent is not known. */
INLINE vf slack_of(vf t_x, vf t_y, vi bytes_a, vi bytes_b, vf size_a, vf size_b) {
    const vi unknown = vi_set(255), reach_a = vi_shift_right(bytes_a, 24), reach_b = vi_shift_right(bytes_b, 24);
    const vf extents = v_add(v_mul(size_a, v_of_int(reach_a)), v_mul(size_b, v_of_int(reach_b)));
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(t_x), v_abs(t_y)), extents));
    return v_select(vm_and(vi_lt(reach_a, unknown), vi_lt(reach_b, unknown)), slack, v_set(INFINITY));
}

/* What stage 1 knows of its pairs. */
struct filter {
    vm valid; /* all numbers in range: the pair has an answer */
    vm apart; /* separation above the margin, for certain */
    vm deep;  /* colliding, for certain */
};

/* Loads `count` pairs, at most a vector, and compares their circles; fills `item`. */
INLINE struct filter load_pairs(const narc_batch *batch, const struct pair_indices *in, int k, int count, bool rows,
                                float margin, int32_t number, vf item[FIELDS]) {
    const float shrink = 1.0f - 0x1p-16f, grow = 1.0f + 0x1p-16f; /* of a square: 2^-17 of the distance */
    const narc_column scale = batch->bodies->scale;
    const struct poses p = load_poses(batch->bodies, rows, in->a + k, in->b + k);
    const struct heads a = load_heads(batch->shapes->heads, in->shape_a + k);
    const struct heads b = load_heads(batch->shapes->heads, in->shape_b + k);
    const vf scale_a = scale.base ? column_lanes(scale, in->a + k) : v_set(1);
    const vf scale_b = scale.base ? column_lanes(scale, in->b + k) : v_set(1);
    struct filter filter;
    vm valid_a, valid_b;
    const vf shrink_a = inverse_length(p.c_a, p.s_a, &valid_a), shrink_b = inverse_length(p.c_b, p.s_b, &valid_b);
    const vf c_a = v_mul(p.c_a, shrink_a), s_a = v_mul(p.s_a, shrink_a);
    const vf c_b = v_mul(p.c_b, shrink_b), s_b = v_mul(p.s_b, shrink_b);
    const vf size_a = v_mul(scale_a, a.bound_radius), size_b = v_mul(scale_b, b.bound_radius);
    const vm near = vm_and(within(p.d_x, (float)NARC_MAX_DISTANCE), within(p.d_y, (float)NARC_MAX_DISTANCE));
    const vm sizes = vm_and(size_in_range(size_a), size_in_range(size_b));
    filter.valid = vm_and(vm_and(vm_first(count - k), near), vm_and(vm_and(valid_a, valid_b), sizes));

    const vf t_x = v_add(v_mul(c_a, p.d_x), v_mul(s_a, p.d_y)), t_y = v_sub(v_mul(c_a, p.d_y), v_mul(s_a, p.d_x));
    const vf q_c = v_add(v_mul(c_a, c_b), v_mul(s_a, s_b)), q_s = v_sub(v_mul(c_a, s_b), v_mul(s_a, c_b));
    const vf bound_x = v_sub(v_mul(q_c, b.bound_x), v_mul(q_s, b.bound_y));
    const vf bound_y = v_add(v_mul(q_s, b.bound_x), v_mul(q_c, b.bound_y));
    const vf far_x = v_sub(v_add(t_x, v_mul(scale_b, bound_x)), v_mul(scale_a, a.bound_x));
    const vf far_y = v_sub(v_add(t_y, v_mul(scale_b, bound_y)), v_mul(scale_a, a.bound_y));
    const vf inner_x = v_sub(v_mul(q_c, b.inner_x), v_mul(q_s, b.inner_y));
    const vf inner_y = v_add(v_mul(q_s, b.inner_x), v_mul(q_c, b.inner_y));
    const vf axis_x = v_sub(v_add(t_x, v_mul(scale_b, inner_x)), v_mul(scale_a, a.inner_x));
    const vf axis_y = v_sub(v_add(t_y, v_mul(scale_b, inner_y)), v_mul(scale_a, a.inner_y));

    const vf size = v_add(size_a, size_b), reach = v_add(size, v_set(margin));
    const vf far2 = v_add(v_mul(far_x, far_x), v_mul(far_y, far_y));
    const vf core = v_add(v_mul(scale_a, a.inner_radius), v_mul(scale_b, b.inner_radius));
    const vf axis2 = v_add(v_mul(axis_x, axis_x), v_mul(axis_y, axis_y));
    filter.apart = vm_or(v_lt(reach, v_set(0)), v_lt(v_mul(reach, reach), v_mul(far2, v_set(shrink))));
    filter.deep = v_lt(v_mul(axis2, v_set(grow)), v_mul(core, core));
    item[T_X] = t_x;
    item[T_Y] = t_y;
    item[Q_C] = q_c;
    item[Q_S] = q_s;
    item[SCALE_A] = scale_a;
    item[SCALE_B] = scale_b;
    item[COSINE_A] = c_a;
    item[SINE_A] = s_a;
    item[DIRECTION_X] = axis_x;
    item[DIRECTION_Y] = axis_y;
    item[AXIS_X] = axis_x;
    item[AXIS_Y] = axis_y;
    item[CORE] = core;
    item[SIZE] = size;
    item[SLACK] = slack_of(t_x, t_y, a.bytes, b.bytes, size_a, size_b);
    item[BLOCK_A] = v_of_bits(a.block);
    item[BLOCK_B] = v_of_bits(b.block);
    item[BYTES_A] = v_of_bits(a.bytes);
    item[BYTES_B] = v_of_bits(b.bytes);
    item[PAIR] = v_of_bits(vi_add(vi_lanes(), vi_set(number + k)));
    return filter;
}
