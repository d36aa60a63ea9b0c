/* SPDX-License-Identifier: MIT
 *
 * boxes.inl - bounding circles, axis-aligned and oriented boxes against each other: filters.
 *
 * Two boxes are apart exactly if they are so along one of their four sides (separating axis theorem). With d from the
 * middle of one to that of the other, along an axis m they are apart if |d.m| > the sum of what each reaches along m:
 * half_x |x.m| + half_y |y.m|, x and y its own axes. Half sides and radii are 96 roundings of the extents too large
 * (store.h). The positions' distance D adds 32 e D at most, and of bodies that overlap D is at most both extents.
 */

struct box {
    vf x, y, half_x, half_y, axis_x, axis_y; /* the middle; half sides at world scale; the first side's direction */
    vf centroid_x, centroid_y;
};

/* The box of a shape in its own frame. */
INLINE struct box load_box(const narc_record *records, struct ring ring, vf scale) {
    int32_t lanes[V_WIDTH];
    vf row[8];
    vi_store(lanes, vi_add(ring.first, ring.count));
    load_records(records, lanes, row);
    return (struct box){
        v_mul(row[0], scale), v_mul(row[1], scale), v_mul(row[2], scale), v_mul(row[3], scale), row[4], row[5],
        v_mul(row[6], scale), v_mul(row[7], scale)};
}

/* A vector turned by a rotation. */
INLINE void turn_by(vf c, vf s, vf *x, vf *y) {
    const vf old_x = *x;
    *x = v_sub(v_mul(c, old_x), v_mul(s, *y));
    *y = v_add(v_mul(s, old_x), v_mul(c, *y));
}

/* The boxes of A and B in A's frame. */
struct boxes {
    struct box a, b;
};

INLINE struct ring item_ring(vf block, vf bytes) {
    return (struct ring){first_record(vi_bits(block), vi_bits(bytes)), head_count(vi_bits(bytes))};
}

INLINE struct boxes load_boxes(const narc_shapes *shapes, const vf item[FIELDS]) {
    const struct pose p = {item[T_X], item[T_Y], item[Q_C], item[Q_S], item[SCALE_B], item[SCALE_A]};
    struct boxes both = {load_box(shapes->records, item_ring(item[BLOCK_A], item[BYTES_A]), p.scale_a),
                         load_box(shapes->records, item_ring(item[BLOCK_B], item[BYTES_B]), p.scale_b)};
    turn_by(p.q_c, p.q_s, &both.b.x, &both.b.y);
    turn_by(p.q_c, p.q_s, &both.b.axis_x, &both.b.axis_y);
    turn_by(p.q_c, p.q_s, &both.b.centroid_x, &both.b.centroid_y);
    both.b.x = v_add(both.b.x, p.t_x);
    both.b.y = v_add(both.b.y, p.t_y);
    both.b.centroid_x = v_add(both.b.centroid_x, p.t_x);
    both.b.centroid_y = v_add(both.b.centroid_y, p.t_y);
    return both;
}

/* How far a box reaches from its middle along a unit vector. */
INLINE vf reach_of(const struct box *box, vf x, vf y) {
    return v_add(v_mul(box->half_x, v_abs(dot(box->axis_x, box->axis_y, x, y))),
                 v_mul(box->half_y, v_abs(cross(box->axis_x, box->axis_y, x, y))));
}

INLINE vm apart_along(const struct boxes *both, vf x, vf y) {
    const vf reach = v_add(reach_of(&both->a, x, y), reach_of(&both->b, x, y));
    return v_lt(reach, v_abs(dot(v_sub(both->b.x, both->a.x), v_sub(both->b.y, both->a.y), x, y)));
}

INLINE vm obbs_apart(const narc_shapes *shapes, const struct filter *circles, const vf item[FIELDS]) {
    (void)circles;
    const struct boxes both = load_boxes(shapes, item);
    const vm along_a = vm_or(apart_along(&both, both.a.axis_x, both.a.axis_y),
                             apart_along(&both, v_neg(both.a.axis_y), both.a.axis_x));
    const vm along_b = vm_or(apart_along(&both, both.b.axis_x, both.b.axis_y),
                             apart_along(&both, v_neg(both.b.axis_y), both.b.axis_x));
    return vm_or(along_a, along_b);
}

/* The world's x axis in A's frame is (c, -s), its y axis (s, c). */
INLINE vm aabbs_apart(const narc_shapes *shapes, const struct filter *circles, const vf item[FIELDS]) {
    (void)circles;
    const vf c = item[COSINE_A], s = item[SINE_A];
    const struct boxes both = load_boxes(shapes, item);
    return vm_or(apart_along(&both, c, v_neg(s)), apart_along(&both, s, c));
}

/* Circles are what all kernels begin with. */
INLINE vm circles_apart(const narc_shapes *shapes, const struct filter *circles, const vf item[FIELDS]) {
    (void)shapes;
    (void)item;
    return circles->apart;
}

/* Are the pairs of a vector apart, in each lane? */
typedef vm apart_test(const narc_shapes *shapes, const struct filter *circles, const vf item[FIELDS]);

/* A filter kernel: sets the bits of all pairs but those that are apart. */
INLINE void filter_by(apart_test *apart, const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    memset(out_bits, 0, (count + 63) / 64 * sizeof *out_bits);
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_indices(batch, first + block, n, &indices);
        for (int k = 0; k < n; k += V_WIDTH) {
            vf item[FIELDS];
            const struct filter f = load_pairs(batch, &indices, k, n, rows, 0, 0, item);
            const size_t pair = block + (size_t)k;
            const vm passes = vm_and_not(f.valid, apart(batch->shapes, &f, item));
            out_bits[pair / 64] |= (uint64_t)vm_bits(passes) << pair % 64;
        }
    }
}

static void overlap_circle(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    filter_by(circles_apart, batch, first, count, out_bits);
}

static void overlap_aabb(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    filter_by(aabbs_apart, batch, first, count, out_bits);
}

static void overlap_obb(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    filter_by(obbs_apart, batch, first, count, out_bits);
}
