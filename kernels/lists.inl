/* SPDX-License-Identifier: MIT
 *
 * lists.inl - all arcs of two bodies, for methods that look at every pair of arcs or edges.
 */

/* All arcs of a shape in each lane, in the caller's order, as struct arcs has them; arc number `count` is the first. */
struct arc_lists {
    _Alignas(64) float x[NARC_MAX_ARCS][V_WIDTH], y[NARC_MAX_ARCS][V_WIDTH], radius[NARC_MAX_ARCS][V_WIDTH];
    float start_x[NARC_MAX_ARCS + 1][V_WIDTH], start_y[NARC_MAX_ARCS + 1][V_WIDTH];
    int most;         /* arcs in any lane */
    vi count, record; /* arcs in each lane, and the record of the first */
    struct ring ring;
};

static void list_arcs(const narc_shapes *shapes, const struct queue *q, int k, bool is_b, struct arc_lists *out) {
    const struct pose pose = get_pose(q, k);
    const vi bytes = get_bits(q, is_b ? BYTES_B : BYTES_A, k), one = vi_set(1);
    out->ring = is_b ? get_ring(q, k, BLOCK_B, BYTES_B) : get_ring(q, k, BLOCK_A, BYTES_A);
    out->count = out->ring.count;
    /* Arc 0 of the caller lies `first` places before the end of the list. */
    const vi first = head_first(bytes);
    vi record = vi_add(out->ring.first, vi_sub(out->count, first));
    record = vi_select(vi_lt(vi_set(0), first), record, out->ring.first);
    out->record = record;
    for (int i = 0; i <= NARC_MAX_ARCS; i++) {
        int32_t lanes[V_WIDTH];
        vi_store(lanes, record);
        const struct arcs arc =
            is_b ? load_arcs_b(shapes->records, lanes, &pose) : load_arcs_a(shapes->records, lanes, &pose);
        v_store(out->start_x[i], arc.start_x);
        v_store(out->start_y[i], arc.start_y);
        out->most = i;
        if (!vm_any(vi_lt(vi_set(i), out->count)))
            break;
        v_store(out->x[i], arc.x);
        v_store(out->y[i], arc.y);
        v_store(out->radius[i], arc.radius);
        record = step_record(out->ring, record, one);
    }
}

/* The record of arc number `arc` of the caller. */
INLINE vi record_of(const struct arc_lists *list, vi arc) {
    const vi record = vi_add(list->record, arc), end = vi_add(list->ring.first, list->count);
    return vi_select(vi_lt(record, end), record, vi_sub(record, list->count));
}
