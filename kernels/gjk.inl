static void overlap_gjk(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    overlap(batch, first, count, out_bits);
}

static size_t contact_gjk(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    return contact(batch, first, count, margin, out);
}
