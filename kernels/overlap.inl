/* SPDX-License-Identifier: MIT
 *
 * overlap.inl - the overlap kernel: one bit per pair, set where the separation is below 0.
 *
 * Blocks of 64 pairs, so that each block owns one word of the answer: circles first (relative.inl), then the pairs that
 * these leave, packed densely, through the deciding formula (overlay.inl).
 */

static void overlap(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    struct pair_block block;
    struct overlay overlay;
    for (size_t done = 0; done < count; done += BLOCK) {
        const size_t n = count - done < BLOCK ? count - done : BLOCK;
        load_pairs(batch, first + done, n, &block);
        const struct pair_masks masks = classify(&block, n, 0);
        uint64_t hits = masks.valid & masks.deep;

        int32_t lanes[BLOCK + V_WIDTH];
        const int left = list_lanes(masks.valid & ~masks.apart & ~masks.deep, lanes);
        for (int k = 0; k < left; k += V_WIDTH) {
            const vm live = vi_lt(vi_lanes(), vi_set(left - k));
            struct cursor a, b;
            vi steps;
            place_pairs(&overlay, batch->shapes, &block, vi_load(lanes + k), &a, &b, &steps);
            const struct gap gap = overlay_gap(&overlay, a, b, steps, live, false);
            for (uint32_t bits = vm_bits(v_lt(gap.separation, v_set(0))); bits; bits &= bits - 1)
                hits |= (uint64_t)1 << lanes[k + __builtin_ctz(bits)];
        }
        out_bits[done / BLOCK] = hits;
    }
}
