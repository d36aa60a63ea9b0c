/* SPDX-License-Identifier: MIT
 *
 * contact.inl - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their
 * order.
 *
 * The normal n and the arcs come from the deciding formula (overlay.inl). The contact point lies halfway between the
 * two support lines across n. Along them, A touches its line in a point or, where n is the normal of an edge, in a
 * stretch, and so does B: the point is the middle of what the two have in common.
 */

/* An edge counts as lying on the support line if its normal is this close to n (radians): above the rounding of a
 * rotated normal, 6 * 2^-24, below any angle between two normals of a shape. */
#define PARALLEL 0x1p-20f

/* Where one shape touches its support line: its position across n, the stretch along it, and the slot of the arc; of an
 * edge, the arc at its counter-clockwise end. */
struct touch {
    vf across, along_min, along_max;
    vi arc;
};

/* Widens a stretch by the end of a neighbouring arc, in lanes where n is the normal of the junction between them;
 * returns those lanes. */
static inline vm widen(const struct overlay *o, struct touch *t, vi junction, vi arc, vf n_x, vf n_y, vf reach) {
    const vf j_x = field(o, NORMAL_X, junction), j_y = field(o, NORMAL_Y, junction);
    const vf off = v_abs(cross(j_x, j_y, n_x, n_y));
    const vm meets = vm_and(v_le(off, v_set(PARALLEL)), v_lt(v_set(0), dot(j_x, j_y, n_x, n_y)));
    const vf p_x = v_add(field(o, CENTER_X, arc), v_mul(reach, n_x)),
             p_y = v_add(field(o, CENTER_Y, arc), v_mul(reach, n_y));
    const vf along = cross(n_x, n_y, p_x, p_y);
    t->along_min = v_select(meets, v_min(t->along_min, along), t->along_min);
    t->along_max = v_select(meets, v_max(t->along_max, along), t->along_max);
    return meets;
}

/* `sign` is 1 for A, which is touched on its side n, and -1 for B, touched on -n. */
static inline struct touch touch_of(const struct overlay *o, struct cursor c, vi arc, vf n_x, vf n_y, float sign) {
    const vi previous = previous_slot(c, arc), next = next_slot(c, arc);
    const vf reach = v_mul(v_set(sign), field(o, RADIUS, arc));
    const vf p_x = v_add(field(o, CENTER_X, arc), v_mul(reach, n_x)),
             p_y = v_add(field(o, CENTER_Y, arc), v_mul(reach, n_y));
    const vf along = cross(n_x, n_y, p_x, p_y);
    struct touch t = {dot(n_x, n_y, p_x, p_y), along, along, arc};
    widen(o, &t, arc, previous, n_x, n_y, v_mul(v_set(sign), field(o, RADIUS, previous)));
    const vm ends = widen(o, &t, next, next, n_x, n_y, v_mul(v_set(sign), field(o, RADIUS, next)));
    t.arc = vi_select(ends, next, arc);
    return t;
}

/* One contact for each lane, in memory. */
struct contact_lanes {
    float separation[V_WIDTH], normal_x[V_WIDTH], normal_y[V_WIDTH], point_x[V_WIDTH], point_y[V_WIDTH];
    int32_t arc_a[V_WIDTH], arc_b[V_WIDTH];
};

/* From A's frame to world axes. */
static inline void turn_back(const struct pair_block *p, vi lanes, vf x, vf y, float *out_x, float *out_y) {
    const vf c = v_gather(p->cosine_a, lanes), s = v_gather(p->sine_a, lanes);
    v_store(out_x, v_sub(v_mul(c, x), v_mul(s, y)));
    v_store(out_y, v_add(v_mul(s, x), v_mul(c, y)));
}

static inline void describe_contacts(const struct overlay *o, const struct pair_block *p, vi lanes, struct cursor a,
                                     struct cursor b, const struct gap *gap, struct contact_lanes *out) {
    const vf n_x = v_div(gap->n_x, gap->n_length), n_y = v_div(gap->n_y, gap->n_length);
    const struct touch on_a = touch_of(o, a, gap->arc_a, n_x, n_y, 1), on_b = touch_of(o, b, gap->arc_b, n_x, n_y, -1);
    const vf half = v_set(0.5f);
    const vf across = v_mul(half, v_add(on_a.across, on_b.across));
    const vf along = v_mul(half, v_add(v_max(on_a.along_min, on_b.along_min), v_min(on_a.along_max, on_b.along_max)));
    v_store(out->separation, gap->separation);
    turn_back(p, lanes, n_x, n_y, out->normal_x, out->normal_y);
    turn_back(p, lanes, v_sub(v_mul(n_x, across), v_mul(n_y, along)), v_add(v_mul(n_y, across), v_mul(n_x, along)),
              out->point_x, out->point_y);
    vi_store(out->arc_a, on_a.arc);
    vi_store(out->arc_b, on_b.arc);
}

/* The number of an arc from its slot; a circle's two halves are both arc 0. */
static inline uint8_t arc_number(int32_t slot, int first_slot, bool is_circle) {
    return (uint8_t)(is_circle ? 0 : slot / SLOT - first_slot);
}

static size_t contact(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    struct pair_block block;
    struct overlay overlay;
    struct contact_lanes found;
    size_t total = 0;
    const bool every = margin == INFINITY;
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t n = count - done < BLOCK ? count - done : BLOCK;
        load_pairs(batch, first + done, n, &block);
        const struct pair_masks masks = classify(&block, n, margin);

        int32_t lanes[BLOCK + V_WIDTH];
        const int left = list_lanes(every ? ~(uint64_t)0 >> (BLOCK - n) : masks.valid & ~masks.apart, lanes);
        for (int k = 0; k < left; k += V_WIDTH) {
            const vi in = vi_load(lanes + k);
            const vm live = vi_lt(vi_lanes(), vi_set(left - k));
            struct cursor a, b;
            vi steps;
            place_pairs(&overlay, batch->shapes, &block, in, &a, &b, &steps);
            const struct gap gap = overlay_gap(&overlay, a, b, steps, live, true);
            const uint32_t keep = vm_bits(every ? live : v_lt(gap.separation, v_set(margin)));
            if (!keep)
                continue;
            describe_contacts(&overlay, &block, in, a, b, &gap, &found);
            int32_t slot_b[V_WIDTH];
            vi_store(slot_b, b.begin);
            for (uint32_t bits = keep; bits; bits &= bits - 1, total++) {
                const int lane = __builtin_ctz(bits), pair = lanes[k + lane];
                const bool valid = masks.valid >> pair & 1;
                out->pair[total] = (uint32_t)(first + done + (size_t)pair);
                out->separation[total] = valid ? found.separation[lane] : INFINITY;
                out->normal_x[total] = valid ? found.normal_x[lane] : 0;
                out->normal_y[total] = valid ? found.normal_y[lane] : 0;
                out->point_x[total] = valid ? found.point_x[lane] : 0;
                out->point_y[total] = valid ? found.point_y[lane] : 0;
                out->arc_a[total] = valid ? arc_number(found.arc_a[lane], 0, block.a.is_circle[pair]) : 0;
                out->arc_b[total] =
                    valid ? arc_number(found.arc_b[lane], slot_b[lane] / SLOT, block.b.is_circle[pair]) : 0;
            }
        }
    }
    return total;
}
