/* SPDX-License-Identifier: MIT
 *
 * relative.inl - stage 1: 64 pairs from the caller's columns to B's pose in A's frame, and a first filter by circles.
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

enum { BLOCK = 64 };

/* One circle for each pair, in its shape's own coordinates. */
struct circles {
    float x[BLOCK], y[BLOCK], radius[BLOCK];
};

struct pair_block {
    /* B's pose in A's frame (before classify(): the difference of positions and B's own rotation) */
    float t_x[BLOCK], t_y[BLOCK], q_c[BLOCK], q_s[BLOCK];
    float cosine_a[BLOCK], sine_a[BLOCK];
    float scale_a[BLOCK], scale_b[BLOCK];
    struct loaded_shape {
        struct circles bound, inner;
        int32_t arcs[BLOCK], stride[BLOCK], count[BLOCK]; /* where its arcs are, see store.h */
        bool is_circle[BLOCK];
    } a, b;
};

/* What stage 1 knows of its pairs, one bit each. */
struct pair_masks {
    uint64_t valid; /* all numbers in range: the pair has an answer */
    uint64_t apart; /* separation above the margin, for certain */
    uint64_t deep;  /* colliding, for certain */
};

/* Position of b minus position of a, rounded once. */
static inline float difference(narc_precision precision, narc_column column, size_t a, size_t b) {
    if (precision == NARC_FLOAT64)
        return (float)(narc_double_at(column, b) - narc_double_at(column, a));
    return narc_float_at(column, b) - narc_float_at(column, a);
}

static inline void load_shape(const narc_head *head, size_t k, struct loaded_shape *out) {
    out->bound.x[k] = head->bound_x;
    out->bound.y[k] = head->bound_y;
    out->bound.radius[k] = head->bound_radius;
    out->inner.x[k] = head->inner_x;
    out->inner.y[k] = head->inner_y;
    out->inner.radius[k] = head->inner_radius;
    out->arcs[k] = (int32_t)head->block;
    out->stride[k] = head->stride;
    out->count[k] = head->count;
    out->is_circle[k] = (head->flags & NARC_SHAPE_CIRCLE) != 0;
}

/* Loads `count` (1 .. 64) pairs; the rest of the last vector repeats the first of them. */
static void load_pairs(const narc_batch *batch, size_t first, size_t count, struct pair_block *p) {
    const narc_bodies *bodies = batch->bodies;
    for (size_t k = 0; k < BLOCK; k++) {
        if (k >= count && k % V_WIDTH == 0)
            break;
        const size_t pair = first + (k < count ? k : 0);
        const uint32_t a = narc_index_at(batch->pairs->a, pair), b = narc_index_at(batch->pairs->b, pair);
        p->t_x[k] = difference(bodies->position_precision, bodies->x, a, b);
        p->t_y[k] = difference(bodies->position_precision, bodies->y, a, b);
        p->cosine_a[k] = narc_float_at(bodies->cosine, a);
        p->sine_a[k] = narc_float_at(bodies->sine, a);
        p->q_c[k] = narc_float_at(bodies->cosine, b);
        p->q_s[k] = narc_float_at(bodies->sine, b);
        p->scale_a[k] = bodies->scale.base ? narc_float_at(bodies->scale, a) : 1.0f;
        p->scale_b[k] = bodies->scale.base ? narc_float_at(bodies->scale, b) : 1.0f;
        load_shape(&batch->shapes->heads[narc_index_at(bodies->shape, a)], k, &p->a);
        load_shape(&batch->shapes->heads[narc_index_at(bodies->shape, b)], k, &p->b);
    }
}

/* One over the length of a rotation that is nearly 1: one step of Newton's method for the inverse root of the square,
 * from 1, which leaves 3/8 of the square's error squared, 1.5 e at most. In lanes where the square is off by more than
 * NARC_ROTATION_TOLERANCE, `out_valid` is false. */
static inline vf inverse_length(vf c, vf s, vm *out_valid) {
    const vf off = v_sub(v_add(v_mul(c, c), v_mul(s, s)), v_set(1));
    *out_valid = v_le(v_abs(off), v_set((float)NARC_ROTATION_TOLERANCE));
    return v_sub(v_set(1), v_mul(v_set(0.5f), off));
}

static inline vm within(vf value, float limit) { return v_le(v_abs(value), v_set(limit)); }

/* The bounding radius has 96 e of the extent in it, so this keeps scaled coordinates below 2e14, too. */
static inline vm size_in_range(vf scale, const struct circles *bound, int k) {
    const vf size = v_mul(scale, v_load(bound->radius + k));
    return vm_and(v_le(v_set((float)NARC_MIN_SIZE), size), v_le(size, v_set((float)NARC_HEAD_MAX_RADIUS)));
}

/* Squared distance between the centres of the circles of A and B, and the sum of their radii, for lanes k ... */
static inline vf circle_distance2(const struct pair_block *p, const struct circles *a, const struct circles *b, int k,
                                  vf *out_radii) {
    const vf q_c = v_load(p->q_c + k), q_s = v_load(p->q_s + k);
    const vf scale_a = v_load(p->scale_a + k), scale_b = v_load(p->scale_b + k);
    const vf b_x = v_load(b->x + k), b_y = v_load(b->y + k);
    const vf x = v_sub(v_mul(q_c, b_x), v_mul(q_s, b_y)), y = v_add(v_mul(q_s, b_x), v_mul(q_c, b_y));
    const vf s_x = v_sub(v_add(v_load(p->t_x + k), v_mul(scale_b, x)), v_mul(scale_a, v_load(a->x + k)));
    const vf s_y = v_sub(v_add(v_load(p->t_y + k), v_mul(scale_b, y)), v_mul(scale_a, v_load(a->y + k)));
    *out_radii = v_add(v_mul(scale_a, v_load(a->radius + k)), v_mul(scale_b, v_load(b->radius + k)));
    return v_add(v_mul(s_x, s_x), v_mul(s_y, s_y));
}

/* Turns the loaded poses into relative ones and sorts the pairs into masks. */
static struct pair_masks classify(struct pair_block *p, size_t count, float margin) {
    const float shrink = 1.0f - 0x1p-16f, grow = 1.0f + 0x1p-16f; /* of a square: 2^-17 of the distance */
    struct pair_masks masks = {0, 0, 0};
    for (int k = 0; k < (int)count; k += V_WIDTH) {
        const vf d_x = v_load(p->t_x + k), d_y = v_load(p->t_y + k);
        vm valid_a, valid_b;
        vf c_a = v_load(p->cosine_a + k), s_a = v_load(p->sine_a + k);
        vf c_b = v_load(p->q_c + k), s_b = v_load(p->q_s + k);
        const vf shrink_a = inverse_length(c_a, s_a, &valid_a), shrink_b = inverse_length(c_b, s_b, &valid_b);
        c_a = v_mul(c_a, shrink_a);
        s_a = v_mul(s_a, shrink_a);
        c_b = v_mul(c_b, shrink_b);
        s_b = v_mul(s_b, shrink_b);
        v_store(p->cosine_a + k, c_a);
        v_store(p->sine_a + k, s_a);
        const vf scale_a = v_load(p->scale_a + k), scale_b = v_load(p->scale_b + k);
        vm valid = vm_and(within(d_x, (float)NARC_MAX_DISTANCE), within(d_y, (float)NARC_MAX_DISTANCE));
        valid = vm_and(valid, vm_and(valid_a, valid_b));
        valid = vm_and(valid, vm_and(size_in_range(scale_a, &p->a.bound, k), size_in_range(scale_b, &p->b.bound, k)));

        v_store(p->t_x + k, v_add(v_mul(c_a, d_x), v_mul(s_a, d_y)));
        v_store(p->t_y + k, v_sub(v_mul(c_a, d_y), v_mul(s_a, d_x)));
        v_store(p->q_c + k, v_add(v_mul(c_a, c_b), v_mul(s_a, s_b)));
        v_store(p->q_s + k, v_sub(v_mul(c_a, s_b), v_mul(s_a, c_b)));

        vf radii;
        const vf bound2 = circle_distance2(p, &p->a.bound, &p->b.bound, k, &radii);
        const vf reach = v_add(radii, v_set(margin));
        const vm apart = vm_or(v_lt(reach, v_set(0)), v_lt(v_mul(reach, reach), v_mul(bound2, v_set(shrink))));
        const vf inner2 = circle_distance2(p, &p->a.inner, &p->b.inner, k, &radii);
        const vm deep = v_lt(v_mul(inner2, v_set(grow)), v_mul(radii, radii));
        masks.valid |= (uint64_t)vm_bits(valid) << k;
        masks.apart |= (uint64_t)vm_bits(apart) << k;
        masks.deep |= (uint64_t)vm_bits(deep) << k;
    }
    masks.valid &= ~(uint64_t)0 >> (BLOCK - count);
    return masks;
}

/* The positions of the bits of `mask` to `out_lanes`, filled up to a whole vector with the first; returns how many
 * bits. */
static int list_lanes(uint64_t mask, int32_t out_lanes[BLOCK + V_WIDTH]) {
    int n = 0;
    for (; mask; mask &= mask - 1)
        out_lanes[n++] = __builtin_ctzll(mask);
    for (int k = 0; n && k < V_WIDTH; k++)
        out_lanes[n + k] = out_lanes[0];
    return n;
}
