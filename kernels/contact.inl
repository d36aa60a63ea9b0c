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

/* Where one shape touches its support line: its position across n, the stretch along it, and the record of the arc; of
 * an edge, the arc at its counter-clockwise end. */
struct touch {
    vf across, along_min, along_max;
    vi arc;
};

/* The position along a support line of the point of an arc with the normal n; `sign` is 1 for A, which is touched on its
 * side n, and -1 for B, touched on -n. `out_across` may be NULL. */
INLINE vf find_point(const struct arcs *arc, vf n_x, vf n_y, float sign, vf *out_across) {
    const vf reach = v_mul(v_set(sign), arc->radius);
    const vf p_x = v_add(arc->x, v_mul(reach, n_x)), p_y = v_add(arc->y, v_mul(reach, n_y));
    if (out_across)
        *out_across = dot(n_x, n_y, p_x, p_y);
    return cross(n_x, n_y, p_x, p_y);
}

/* Is n the normal of this junction? */
INLINE vm meets(vf j_x, vf j_y, vf n_x, vf n_y) {
    return vm_and(v_le(v_abs(cross(j_x, j_y, n_x, n_y)), v_set(PARALLEL)), v_lt(v_set(0), dot(j_x, j_y, n_x, n_y)));
}

/* The touch of the shape with the arc in `record`: a point, or up to the end of a neighbouring arc where n is the normal
 * of the junction with it. */
INLINE struct touch touch_of(const narc_record *records, struct ring ring, vi record, const struct pose *pose, vf n_x,
                             vf n_y, bool is_b) {
    const vi next = step_record(ring, record, vi_set(1));
    int32_t lanes[3][V_WIDTH];
    vi_store(lanes[0], step_record(ring, record, vi_set(-1)));
    vi_store(lanes[1], record);
    vi_store(lanes[2], next);
    struct arcs arc[3];
    for (int k = 0; k < 3; k++)
        arc[k] = is_b ? load_arcs_b(records, lanes[k], pose) : load_arcs_a(records, lanes[k], pose);
    const float sign = is_b ? -1.0f : 1.0f;
    struct touch t;
    t.along_min = t.along_max = find_point(&arc[1], n_x, n_y, sign, &t.across);
    const vm starts = meets(arc[1].start_x, arc[1].start_y, n_x, n_y), ends = meets(arc[1].end_x, arc[1].end_y, n_x, n_y);
    const vf before = find_point(&arc[0], n_x, n_y, sign, NULL), after = find_point(&arc[2], n_x, n_y, sign, NULL);
    t.along_min = v_select(starts, v_min(t.along_min, before), t.along_min);
    t.along_max = v_select(starts, v_max(t.along_max, before), t.along_max);
    t.along_min = v_select(ends, v_min(t.along_min, after), t.along_min);
    t.along_max = v_select(ends, v_max(t.along_max, after), t.along_max);
    t.arc = vi_select(ends, next, record);
    return t;
}

/* A contact while its place in the list is not known yet: a row for each pair of a group, found by the pair's number. */
enum { SEPARATION, CONTACT_NORMAL_X, CONTACT_NORMAL_Y, POINT_X, POINT_Y, ARCS, ROW = 8 };

enum { GROUP = 1024 };

/* The last of each array is for lanes that are of no use. */
struct results {
    _Alignas(64) float row[GROUP + 1][ROW];
    uint8_t keep[GROUP + 1];
    bool hinted; /* are hints wanted? */
    uint32_t hint[GROUP + 1];
};

/* Leaves a hint for the pairs k ... of a queue, of those lanes that `ended` says. */
INLINE void leave_hints(const struct queue *q, int k, vm ended, vi record_a, vi record_b, struct results *out) {
    int32_t place[V_WIDTH], hint[V_WIDTH];
    if (!out->hinted)
        return;
    vi_store(place, vi_select(ended, get_bits(q, PAIR, k), vi_set(GROUP)));
    vi_store(hint, hint_of(q, k, record_a, record_b));
    for (int lane = 0; lane < V_WIDTH; lane++)
        out->hint[place[lane]] = (uint32_t)hint[lane];
}

/* The caller's number of an arc from its record; a circle's two halves are both arc 0. */
INLINE vi arc_number(vi record, vi block, vi bytes) {
    const vi place = vi_sub(record, first_record(block, bytes));
    const vi number = vi_add(place, head_first(bytes)), count = head_count(bytes);
    const vi wrapped = vi_select(vi_lt(number, count), number, vi_sub(number, count));
    return vi_select(head_is(bytes, NARC_SHAPE_CIRCLE), vi_set(0), wrapped);
}

/* From A's frame to world axes. */
INLINE void turn_back(const struct queue *q, int k, vf x, vf y, vf *out_x, vf *out_y) {
    const vf c = get(q, COSINE_A, k), s = get(q, SINE_A, k);
    *out_x = v_sub(v_mul(c, x), v_mul(s, y));
    *out_y = v_add(v_mul(s, x), v_mul(c, y));
}

/* Files the contacts of the pairs k ... of a queue, those lanes that `keep` says. */
INLINE void file_contacts(const struct queue *q, int k, vm keep, vf separation, vf n_x, vf n_y,
                                 const struct touch *on_a, const struct touch *on_b, struct results *out) {
    const vf half = v_set(0.5f);
    const vf across = v_mul(half, v_add(on_a->across, on_b->across));
    const vf along =
        v_mul(half, v_add(v_max(on_a->along_min, on_b->along_min), v_min(on_a->along_max, on_b->along_max)));
    vf row[ROW];
    row[SEPARATION] = separation;
    turn_back(q, k, n_x, n_y, &row[CONTACT_NORMAL_X], &row[CONTACT_NORMAL_Y]);
    turn_back(q, k, v_sub(v_mul(n_x, across), v_mul(n_y, along)), v_add(v_mul(n_y, across), v_mul(n_x, along)),
              &row[POINT_X], &row[POINT_Y]);
    const vi arc_a = arc_number(on_a->arc, get_bits(q, BLOCK_A, k), get_bits(q, BYTES_A, k));
    const vi arc_b = arc_number(on_b->arc, get_bits(q, BLOCK_B, k), get_bits(q, BYTES_B, k));
    row[ARCS] = v_of_bits(vi_add(arc_a, vi_shift_left(arc_b, 8)));
    row[6] = row[7] = v_set(0);
    const vi pair = get_bits(q, PAIR, k);
    int32_t place[V_WIDTH];
    vi_store(place, vi_select(keep, pair, vi_set(GROUP)));
    v_put_rows(out->row, sizeof out->row[0], place, row);
    v_put_rows(&out->row[0][4], sizeof out->row[0], place, row + 4);
    for (int lane = 0; lane < V_WIDTH; lane++)
        out->keep[place[lane]] = 1;
}

/* Finds the contacts of the last `count` pairs of a queue by the formula and takes them out. */
static void decide_contacts(const narc_shapes *shapes, struct queue *rest, int count, float margin,
                            struct results *out) {
    rest->count -= count;
    for (int i = 0; i < count; i += V_WIDTH) {
        const int k = rest->count + i;
        const vm live = vm_first(count - i);
        const struct gap gap = overlay_gap(shapes, rest, k, live, true);
        leave_hints(rest, k, live, gap.record_a, gap.record_b, out);
        const vm keep = margin == INFINITY ? live : v_lt(gap.separation, v_set(margin));
        if (!vm_any(keep))
            continue;
        const vf n_x = v_div(gap.n_x, gap.n_length), n_y = v_div(gap.n_y, gap.n_length);
        const struct pose pose = get_pose(rest, k);
        const struct ring ring_a = get_ring(rest, k, BLOCK_A, BYTES_A), ring_b = get_ring(rest, k, BLOCK_B, BYTES_B);
        const struct touch on_a = touch_of(shapes->records, ring_a, gap.record_a, &pose, n_x, n_y, false);
        const struct touch on_b = touch_of(shapes->records, ring_b, gap.record_b, &pose, n_x, n_y, true);
        file_contacts(rest, k, keep, gap.separation, n_x, n_y, &on_a, &on_b, out);
    }
}

/* The same from the arcs after and before n, one and the same unless n is their junction's normal. */
INLINE struct touch touch_at(const struct arcs *after, const struct arcs *before, vf n_x, vf n_y, float sign, vi record) {
    vf across;
    const vf along = find_point(after, n_x, n_y, sign, &across), old = find_point(before, n_x, n_y, sign, NULL);
    return (struct touch){across, v_min(along, old), v_max(along, old), record};
}

/* Is a side clear */
INLINE vm side_is_clear(vf edge, const struct couple *c, vf sine_a, vf sine_b, vf depth, vf cosine, vf slack, vm kink) {
    const vf chord2 = v_sub(v_set(2.0001f), v_add(cosine, cosine)), chord = v_sqrt(v_max(chord2, v_set(0)));
    const vf near = v_min(sine_a, sine_b), inner = v_add(c->a.inner, c->b.inner);
    const vm in_window = v_le(chord2, v_set(1));
    const vf near_a = v_select(in_window, c->a.near, v_set(0)), near_b = v_select(in_window, c->b.near, v_set(0));
    const vf sum_a = v_max(v_mul(c->a.inner, chord), v_add(v_mul(near_a, chord), v_mul(v_sub(c->a.radius, near_a), v_min(chord, sine_a))));
    const vf sum_b = v_max(v_mul(c->b.inner, chord), v_add(v_mul(near_b, chord), v_mul(v_sub(c->b.radius, near_b), v_min(chord, sine_b))));
    const vf sum = v_sub(v_add(v_mul(edge, v_sub(v_set(1.999f), v_mul(v_set(0.5f), chord2))), v_add(sum_a, sum_b)), v_mul(depth, chord));
    const vm square = v_lt(v_mul(v_mul(v_set(2), slack), chord), v_mul(sum, v_mul(near, near)));
    const vm linear = vm_and(v_lt(slack, v_mul(v_sub(inner, depth), near)), v_lt(v_mul(v_mul(v_set(256), slack), chord), sum));
    const vm clear = vm_and(vm_and(v_le(v_set(-0.49f), cosine), v_le(v_set(0x1p-12f), near)), vm_or(square, linear));
    const vm edge_is_clear = vm_or(vm_and_not(vm_first(V_WIDTH), kink), v_lt(slack, edge));
    return vm_and(clear, edge_is_clear);
}

/* Contacts by climbing; those undecided go to `rest`. */
static void settle_contacts(const narc_shapes *shapes, struct queue *q, int first, float margin, struct queue *rest, struct results *out) {
    look_up(shapes, q, first, DIRECTION_X, false);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct peak peak = climb(shapes, q, k, live, STEPS);
        const vf slack = get(q, SLACK, k);
        const vf u_x = v_sub(peak.after.b.x, peak.after.a.x), u_y = v_sub(peak.after.b.y, peak.after.a.y);
        const vf radii = v_add(peak.after.a.radius, peak.after.b.radius);
        const vf length = v_sqrt(dot(u_x, u_y, u_x, u_y));
        const vf separation = v_sub(v_select(peak.kink, dot(u_x, u_y, peak.n_x, peak.n_y), length), radii);
        const vf one = v_set(1), n_length = v_select(peak.kink, one, length);
        const vf n_x = v_div(peak.n_x, n_length), n_y = v_div(peak.n_y, n_length);

        const vm circle_a = head_is(get_bits(q, BYTES_A, k), NARC_SHAPE_CIRCLE), circle_b = head_is(get_bits(q, BYTES_B, k), NARC_SHAPE_CIRCLE);
        const vf end_a = sine_to(n_x, n_y, peak.after.a.end_x, peak.after.a.end_y, circle_a);
        const vf end_b = sine_to(n_x, n_y, peak.after.b.end_x, peak.after.b.end_y, circle_b);
        const vf start_a = sine_to(n_x, v_neg(n_y), peak.before.a.start_x, v_neg(peak.before.a.start_y), circle_a);
        const vf start_b = sine_to(n_x, v_neg(n_y), peak.before.b.start_x, v_neg(peak.before.b.start_y), circle_b);
        const vm holds = v_le(v_set(0), v_min(v_min(start_a, end_a), v_min(start_b, end_b)));
        const vm found = vm_and(peak.found, holds);
        const vm apart = vm_and(found, v_le(v_add(v_set(margin), slack), separation));

        /* fan */
        const vf axis_x = get(q, AXIS_X, k), axis_y = get(q, AXIS_Y, k), core = get(q, CORE, k);
        const vf axis2 = dot(axis_x, axis_y, axis_x, axis_y), axis_length = v_sqrt(axis2);
        const vf fan = v_min(axis_length, v_sub(v_add(core, separation), slack));
        const vf fan_across = v_sqrt(v_max(v_set(0), v_sub(axis2, v_mul(fan, fan))));
        const vf along = dot(axis_x, axis_y, n_x, n_y), across = cross(axis_x, axis_y, n_x, n_y);
        const vf even = v_mul(fan, along), odd = v_mul(fan_across, across);
        const vm narrow = vm_and(v_lt(v_set(0), along), v_le(v_mul(v_set(-0.5f), axis_length), fan));
        const vf cosine_after = v_div(v_add(even, odd), axis2), cosine_before = v_div(v_sub(even, odd), axis2);
        const vf depth = v_neg(separation);
        const vf before_x = v_sub(peak.before.b.x, peak.before.a.x), before_y = v_sub(peak.before.b.y, peak.before.a.y);
        const vf edge_after = v_select(peak.kink, cross(u_x, u_y, n_x, n_y), v_set(0));
        const vf edge_before = v_select(peak.kink, cross(n_x, n_y, before_x, before_y), v_set(0));
        const vf inner = v_add(v_add(peak.after.a.inner, peak.after.b.inner), separation);
        const vf in = v_min(v_min(start_a, end_a), v_min(start_b, end_b));
        const vm round = vm_and(vm_and(v_lt(v_mul(v_set(256), slack), inner), v_lt(slack, v_mul(inner, in))), v_le(v_set(0x1p-12f), in));
        vm sure = vm_and(found, narrow);
        sure = vm_and(sure, side_is_clear(edge_after, &peak.after, end_a, end_b, depth, cosine_after, slack, peak.kink));
        sure = vm_and(sure, side_is_clear(edge_before, &peak.before, start_a, start_b, depth, cosine_before, slack, peak.kink));
        sure = vm_or(sure, vm_and(found, vm_and_not(round, peak.kink)));
        sure = vm_and_not(sure, apart);

        leave_hints(q, k, vm_and(live, vm_or(apart, sure)), peak.record_a, peak.record_b, out);
        const vm keep = margin == INFINITY ? sure : vm_and(sure, v_lt(separation, v_set(margin)));
        if (vm_any(keep)) {
            const struct touch on_a = touch_at(&peak.after.a, &peak.before.a, n_x, n_y, 1, peak.record_a);
            const struct touch on_b = touch_at(&peak.after.b, &peak.before.b, n_x, n_y, -1, peak.record_b);
            file_contacts(q, k, keep, separation, n_x, n_y, &on_a, &on_b, out);
        }
        const vm left = vm_and_not(live, vm_or(apart, sure));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item);
            push(rest, left, item, SINE_A + 1);
        }
    }
    q->count = first;
}

/* Contacts that the arcs along a direction tell at once; the others, but for those that are apart, go to `near` with the
 * direction to search on in. */
INLINE void look(const narc_shapes *shapes, struct queue *q, int first, int x, bool hints, float margin, struct queue *near, struct results *out) {
    if (hints)
        look_up_hints(q, out->hint);
    look_up(shapes, q, first, x, hints);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct pose pose = get_pose(q, k);
        const vi bytes_a = get_bits(q, BYTES_A, k), bytes_b = get_bits(q, BYTES_B, k);
        const struct arcs a = load_arcs_a(shapes->records, q->record_a + k, &pose);
        const struct arcs b = load_arcs_b(shapes->records, q->record_b + k, &pose);
        const vf axis_x = get(q, AXIS_X, k), axis_y = get(q, AXIS_Y, k), slack = get(q, SLACK, k);
        const vf u_x = v_sub(b.x, a.x), u_y = v_sub(b.y, a.y), radii = v_add(a.radius, b.radius);
        const vf d_x = get(q, x, k), d_y = get(q, x + 1, k), gap = dot(u_x, u_y, d_x, d_y), d2 = dot(d_x, d_y, d_x, d_y);
        const vf length = v_sqrt(dot(u_x, u_y, u_x, u_y));
        const vm smooth = head_is(vi_and(bytes_a, bytes_b), NARC_SHAPE_SMOOTH);

        /* Between the ends? */
        const vm circle_a = head_is(bytes_a, NARC_SHAPE_CIRCLE), circle_b = head_is(bytes_b, NARC_SHAPE_CIRCLE);
        const vf in_a = v_select(circle_a, length, v_min(cross(a.start_x, a.start_y, u_x, u_y), cross(u_x, u_y, a.end_x, a.end_y)));
        const vf in_b = v_select(circle_b, length, v_min(cross(b.start_x, b.start_y, u_x, u_y), cross(u_x, u_y, b.end_x, b.end_y)));
        const vf in = v_min(in_a, in_b);
        const vf separation = v_sub(length, radii), limit = v_add(v_set(margin), slack);
        const vf least = v_mul(v_set(0x1p-12f), length);
        vm inside = v_lt(least, in);
        /* g along the axis, times its length: squares */
        const vf reach = v_add(v_add(radii, limit), v_mul(v_select(smooth, v_set(0), v_set(63)), slack));
        vm beyond = vm_and(vm_and(v_lt(v_set(0), gap), v_lt(v_set(0), reach)), v_lt(v_mul(v_mul(reach, reach), d2), v_mul(gap, gap)));
        if (hints)
            beyond = vm_and_not(beyond, vi_lt(vi_set(0), vi_load(q->hinted + k)));
        const vm far = vm_and(inside, v_le(limit, separation)), apart = vm_or(far, beyond);
        const vf inner = v_add(v_add(a.inner, b.inner), separation);
        const vm clear = vm_and(v_lt(v_mul(v_set(256), slack), inner), v_lt(v_mul(slack, length), v_mul(inner, in)));
        const vm sure = vm_and_not(vm_and(vm_and(live, inside), clear), apart);

        leave_hints(q, k, vm_and(live, vm_or(far, sure)), vi_load(q->record_a + k), vi_load(q->record_b + k), out);
        const vm keep = margin == INFINITY ? sure : vm_and(sure, v_lt(separation, v_set(margin)));
        if (vm_any(keep)) {
            const vf n_x = v_div(u_x, length), n_y = v_div(u_y, length);
            const struct touch on_a = touch_at(&a, &a, n_x, n_y, 1, vi_load(q->record_a + k));
            const struct touch on_b = touch_at(&b, &b, n_x, n_y, -1, vi_load(q->record_b + k));
            file_contacts(q, k, keep, separation, n_x, n_y, &on_a, &on_b, out);
        }
        const vm left = vm_and_not(live, vm_or(apart, sure));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item);
            item[DIRECTION_X] = v_select(smooth, u_x, axis_x);
            item[DIRECTION_Y] = v_select(smooth, u_y, axis_y);
            push(near, left, item, DIRECTION_Y + 1);
        }
    }
    q->count = first;
}

/* Writes the kept contacts of a group in their order, from item `at` on; returns how many. `first` is the number of the
 * group's first pair in the batch. */
static size_t list_contacts(const struct results *results, int count, size_t first, const narc_contacts *out,
                            size_t at) {
    int32_t pair[GROUP + V_WIDTH];
    int n = 0;
    for (int k = 0; k < count; k++) {
        pair[n] = k;
        n += results->keep[k];
    }
    for (int k = 0; k < V_WIDTH; k++)
        pair[n + k] = GROUP;
    for (int k = 0; k < n; k += V_WIDTH) {
        vf row[ROW];
        v_rows(results->row, sizeof results->row[0], pair + k, row);
        v_rows(&results->row[0][4], sizeof results->row[0], pair + k, row + 4);
        float rest[ROW][V_WIDTH];
        const bool whole = k + V_WIDTH <= n;
        v_store(whole ? out->separation + at + k : rest[SEPARATION], row[SEPARATION]);
        v_store(whole ? out->normal_x + at + k : rest[CONTACT_NORMAL_X], row[CONTACT_NORMAL_X]);
        v_store(whole ? out->normal_y + at + k : rest[CONTACT_NORMAL_Y], row[CONTACT_NORMAL_Y]);
        v_store(whole ? out->point_x + at + k : rest[POINT_X], row[POINT_X]);
        v_store(whole ? out->point_y + at + k : rest[POINT_Y], row[POINT_Y]);
        int32_t arcs[V_WIDTH];
        vi_store(arcs, vi_bits(row[ARCS]));
        const int lanes = whole ? V_WIDTH : n - k;
        for (int lane = 0; lane < lanes; lane++) {
            out->pair[at + (size_t)(k + lane)] = (uint32_t)(first + (size_t)pair[k + lane]);
            out->arc_a[at + (size_t)(k + lane)] = (uint8_t)arcs[lane];
            out->arc_b[at + (size_t)(k + lane)] = (uint8_t)(arcs[lane] >> 8);
        }
        if (!whole) {
            float *const to[] = {out->separation, out->normal_x, out->normal_y, out->point_x, out->point_y};
            for (int f = 0; f < 5; f++)
                memcpy(to[f] + at + k, rest[f], (size_t)lanes * sizeof(float));
        }
    }
    return (size_t)n;
}

static size_t contact(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    uint32_t *const hints = batch->hints;
    const bool rows = poses_are_rows(batch->bodies), every = margin == INFINITY;
    struct pair_indices indices;
    struct queue fresh, again, near, rest;
    struct results results;
    size_t total = 0;
    fresh.count = again.count = near.count = rest.count = 0;
    for (size_t done = 0; done < count; done += GROUP) {
        const int in_group = (int)(count - done < GROUP ? count - done : GROUP);
        memset(results.keep, 0, sizeof results.keep);
        results.hinted = hints != NULL;
        if (hints)
            memcpy(results.hint, hints + first + done, (size_t)in_group * sizeof *hints);
        for (int start = 0; start < in_group; start += BLOCK) {
            const int n = in_group - start < BLOCK ? in_group - start : BLOCK;
            load_indices(batch, first + done + (size_t)start, n, &indices);
            fresh.count = 0;
            for (int k = 0; k < n; k += V_WIDTH) {
                vf item[FIELDS];
                const struct filter f = load_pairs(batch, &indices, k, n, rows, margin, start, item);
                for (uint32_t bits = every ? ~vm_bits(f.valid) & vm_bits(vm_first(n - k)) : 0; bits; bits &= bits - 1) {
                    const int number = start + k + __builtin_ctz(bits);
                    const float none[ROW] = {[SEPARATION] = INFINITY};
                    memcpy(results.row[number], none, sizeof none);
                    results.keep[number] = 1;
                }
                push(NARC_SHORTCUTS ? &fresh : &rest, NARC_SHORTCUTS ? vm_and_not(f.valid, f.apart) : f.valid, item,
                     SINE_A + 1);
            }
            pad(&fresh);
            if (hints)
                look(batch->shapes, &fresh, 0, AXIS_X, true, margin, &again, &results);
            else
                look(batch->shapes, &fresh, 0, AXIS_X, false, margin, &again, &results);
            if (again.count >= FLUSH)
                look(batch->shapes, &again, again.count % V_WIDTH, DIRECTION_X, false, margin, &near, &results);
            if (near.count >= FLUSH)
                settle_contacts(batch->shapes, &near, near.count % V_WIDTH, margin, &rest, &results);
            if (rest.count >= FLUSH)
                decide_contacts(batch->shapes, &rest, rest.count / V_WIDTH * V_WIDTH, margin, &results);
        }
        pad(&again);
        look(batch->shapes, &again, 0, DIRECTION_X, false, margin, &near, &results);
        pad(&near);
        settle_contacts(batch->shapes, &near, 0, margin, &rest, &results);
        pad(&rest);
        decide_contacts(batch->shapes, &rest, rest.count, margin, &results);
        if (hints)
            memcpy(hints + first + done, results.hint, (size_t)in_group * sizeof *hints);
        total += list_contacts(&results, in_group, first + done, out, total);
    }
    return total;
}
