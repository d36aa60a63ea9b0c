/* SPDX-License-Identifier: MIT
 *
 * overlap.inl - the overlap kernel: one bit per pair, set where the separation is below 0.
 */

/* Decides the last `count` pairs of a queue by the formula and takes them out. */
static void decide_overlaps(const narc_shapes *shapes, struct queue *rest, int count, uint64_t *out_bits) {
    rest->count -= count;
    for (int i = 0; i < count; i += V_WIDTH) {
        const int k = rest->count + i;
        const vm live = vm_first(count - i);
        const struct gap gap = overlay_gap(shapes, rest, k, live, false);
        mark(get_bits(rest, PAIR, k), v_lt(gap.separation, v_set(0)), out_bits);
    }
}

/* Looks at the last pairs of a queue along a direction; those undecided go to `rest`, the others out. */
INLINE void settle(const narc_shapes *shapes, struct queue *q, int first, int x, struct queue *rest, uint64_t *out_bits) {
    look_up(shapes, q, first, x, false);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct verdict v = glance(shapes, q, k, x, 0, false);
        mark(get_bits(q, PAIR, k), vm_and(live, v.hit), out_bits);
        const vm left = vm_and_not(live, vm_or(v.apart, v.hit));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item);
            item[DIRECTION_X] = v.u_x;
            item[DIRECTION_Y] = v.u_y;
            push(rest, left, item, DIRECTION_Y + 1);
        }
    }
    q->count = first;
}

enum { LOOKS = 3 };

static void overlap(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    struct queue fresh, near[LOOKS];
    struct queue *const rest = &near[LOOKS - 1];
    for (int k = 0; k < LOOKS; k++)
        near[k].count = 0;
    memset(out_bits, 0, (count + 63) / 64 * sizeof *out_bits);
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_indices(batch, first + block, n, &indices);
        fresh.count = 0;
        for (int k = 0; k < n; k += V_WIDTH) {
            vf item[FIELDS];
            const struct filter f = load_pairs(batch, &indices, k, n, rows, 0, (int32_t)(uint32_t)block, item);
            if (!NARC_SHORTCUTS) {
                push(rest, f.valid, item, PAIR + 1);
                continue;
            }
            push(&fresh, vm_and_not(f.valid, vm_or(f.apart, f.deep)), item, PAIR + 1);
            out_bits[(block + (size_t)k) / 64] |= (uint64_t)vm_bits(vm_and(f.valid, f.deep)) << (block + (size_t)k) % 64;
        }
        pad(&fresh);
        settle(batch->shapes, &fresh, 0, AXIS_X, &near[0], out_bits);
        for (int k = 0; k < LOOKS - 1; k++)
            if (near[k].count >= FLUSH)
                settle(batch->shapes, &near[k], near[k].count % V_WIDTH, DIRECTION_X, &near[k + 1], out_bits);
        if (rest->count >= FLUSH)
            decide_overlaps(batch->shapes, rest, rest->count / V_WIDTH * V_WIDTH, out_bits);
    }
    for (int k = 0; k < LOOKS - 1; k++) {
        pad(&near[k]);
        settle(batch->shapes, &near[k], 0, DIRECTION_X, &near[k + 1], out_bits);
    }
    pad(rest);
    decide_overlaps(batch->shapes, rest, rest->count, out_bits);
}
