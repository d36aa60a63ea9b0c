/* SPDX-License-Identifier: MIT
 *
 * contact.inl - the contact kernel: separation, normal, point and arcs of the pairs closer than a margin, in their
 * order.
 *
 * Pairs pass through stages until one of them knows the answer that the deciding formula (overlay.inl) would give, to
 * the last bit: circles, a look along the axis (or at last call's arcs), another along u, a climb to a local maximum,
 * and the formula itself. A group's contacts are filed by the number of their pair as they come, and then listed.
 *
 * The normal n and the arcs are those of the highest local maximum of the gap. The contact point lies halfway between
 * the two support lines across n. Along them, A touches its line in a point or, where n is the normal of an edge, in a
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

/* The position along a support line of the point of an arc with the normal n; `sign` is 1 for A, which is touched on
 * its side n, and -1 for B, touched on -n. `out_across` may be NULL. */
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

/* The touch of the shape with the arc in `record`: a point, or up to the end of a neighbouring arc where n is the
 * normal of the junction with it. */
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
    const vm starts = meets(arc[1].start_x, arc[1].start_y, n_x, n_y),
             ends = meets(arc[1].end_x, arc[1].end_y, n_x, n_y);
    const vf before = find_point(&arc[0], n_x, n_y, sign, NULL), after = find_point(&arc[2], n_x, n_y, sign, NULL);
    t.along_min = v_select(starts, v_min(t.along_min, before), t.along_min);
    t.along_max = v_select(starts, v_max(t.along_max, before), t.along_max);
    t.along_min = v_select(ends, v_min(t.along_min, after), t.along_min);
    t.along_max = v_select(ends, v_max(t.along_max, after), t.along_max);
    t.arc = vi_select(ends, next, record);
    return t;
}

/* The same from the arcs after and before n, one and the same unless n is their junction's normal. */
INLINE struct touch touch_at(const struct arcs *after, const struct arcs *before, vf n_x, vf n_y, float sign,
                             vi record) {
    vf across;
    const vf along = find_point(after, n_x, n_y, sign, &across), old = find_point(before, n_x, n_y, sign, NULL);
    return (struct touch){across, v_min(along, old), v_max(along, old), record};
}

/* Contacts while their places in the list are not known yet: a row for each pair of a group. */
enum { SEPARATION, CONTACT_NORMAL_X, CONTACT_NORMAL_Y, POINT_X, POINT_Y, ARCS, ROW = 8 };

enum { GROUP = NARC_CONTACT_GROUP };

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
    v_put_rows((float *)out->row + 4, sizeof out->row[0], place, row + 4);
    for (int lane = 0; lane < V_WIDTH; lane++)
        out->keep[place[lane]] = 1;
}

INLINE vm closer_than(vf separation, float margin) {
    return margin == INFINITY ? vm_first(V_WIDTH) : v_lt(separation, v_set(margin));
}

/* Files the contacts that `gap` says, of the pairs k ... of a queue, where it is less than the margin. */
static void file_gap(const narc_shapes *shapes, const struct queue *q, int k, vm live, const struct gap *gap,
                     float margin, struct results *out) {
    const vm keep = vm_and(live, closer_than(gap->separation, margin));
    if (!vm_any(keep))
        return;
    const vf n_x = v_div(gap->n_x, gap->n_length), n_y = v_div(gap->n_y, gap->n_length);
    const struct pose pose = get_pose(q, k);
    const struct ring ring_a = get_ring(q, k, BLOCK_A, BYTES_A), ring_b = get_ring(q, k, BLOCK_B, BYTES_B);
    const struct touch on_a = touch_of(shapes->records, ring_a, gap->record_a, &pose, n_x, n_y, false);
    const struct touch on_b = touch_of(shapes->records, ring_b, gap->record_b, &pose, n_x, n_y, true);
    file_contacts(q, k, keep, gap->separation, n_x, n_y, &on_a, &on_b, out);
}

/* Finds the contacts of the pairs first ... of a queue by the formula and takes them out. */
static void decide_contacts(const narc_shapes *shapes, struct queue *q, int first, float margin, struct results *out) {
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct gap gap = overlay_gap(shapes, q, k, live, true);
        leave_hints(q, k, live, gap.record_a, gap.record_b, out);
        file_gap(shapes, q, k, live, &gap, margin, out);
    }
    q->count = first;
}

/* Climbs with the pairs first ... of a queue, along DIRECTION, and takes them out; those whose peak is not known to be
 * the highest go to `undecided`. */
static void climb_to_contacts(const narc_shapes *shapes, struct queue *q, int first, float margin,
                              struct queue *undecided, struct results *out) {
    look_up(shapes, q, first, false);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct top top = climb_to_top(shapes, q, k, live, margin);
        const struct peak *peak = &top.peak;
        leave_hints(q, k, vm_or(top.apart, top.sure), peak->record_a, peak->record_b, out);
        const vm keep = vm_and(top.sure, closer_than(top.separation, margin));
        if (vm_any(keep)) {
            const struct touch on_a = touch_at(&peak->after.a, &peak->before.a, top.n_x, top.n_y, 1, peak->record_a);
            const struct touch on_b = touch_at(&peak->after.b, &peak->before.b, top.n_x, top.n_y, -1, peak->record_b);
            file_contacts(q, k, keep, top.separation, top.n_x, top.n_y, &on_a, &on_b, out);
        }
        const vm left = vm_and_not(live, vm_or(top.apart, top.sure));
        if (vm_any(left)) {
            vf item[FIELDS];
            get_item(q, k, item, CONTACT_FIELDS);
            push(undecided, left, item, CONTACT_FIELDS);
        }
    }
    q->count = first;
}

/* Looks at the pairs first ... of a queue along DIRECTION, or at the arcs of their hints, and takes them
 * out. If u of these arcs lies between their junctions it is the direction of a local maximum, mostly the highest. The
 * others, unless they are apart, go to `undecided`: with u to search along, or the axis where there are edges, near
 * which u leads astray. */
INLINE void look_for_contacts(const narc_shapes *shapes, struct queue *q, int first, bool hints, float margin,
                              struct queue *undecided, struct results *out) {
    if (hints)
        read_hints(q, out->hint);
    look_up(shapes, q, first, hints);
    for (int k = first; k < q->count; k += V_WIDTH) {
        const vm live = vm_first(q->count - k);
        const struct pose pose = get_pose(q, k);
        const vi bytes_a = get_bits(q, BYTES_A, k), bytes_b = get_bits(q, BYTES_B, k);
        const struct arcs a = load_arcs_a(shapes->records, q->record_a + k, &pose);
        const struct arcs b = load_arcs_b(shapes->records, q->record_b + k, &pose);
        const vf u_x = v_sub(b.x, a.x), u_y = v_sub(b.y, a.y), length = v_sqrt(dot(u_x, u_y, u_x, u_y));
        const vf radii = v_add(a.radius, b.radius), separation = v_sub(length, radii), slack = get(q, SLACK, k);
        /* The sine of the angle from u to the nearest junction, times the length. */
        const vf from_a = v_min(cross(a.start_x, a.start_y, u_x, u_y), cross(u_x, u_y, a.end_x, a.end_y));
        const vf from_b = v_min(cross(b.start_x, b.start_y, u_x, u_y), cross(u_x, u_y, b.end_x, b.end_y));
        const vf least = v_min(v_select(head_is(bytes_a, NARC_SHAPE_CIRCLE), length, from_a),
                               v_select(head_is(bytes_b, NARC_SHAPE_CIRCLE), length, from_b));
        const vm inside = vm_and(live, v_lt(v_set(0), least)); /* u is long enough for the formula if is_only_peak() */
        const vm far = vm_and(inside, v_lt(v_add(v_set(margin), slack), separation));
        vm apart = vm_or(far, is_above(u_x, u_y, radii, get(q, DIRECTION_X, k), get(q, DIRECTION_Y, k),
                                       v_add(v_set(margin), apart_slack(q, k))));
        if (hints) /* whose arcs may not hold that direction */
            apart = vm_and_not(apart, vm_and_not(vi_lt(vi_set(0), vi_load(q->hinted + k)), far));
        const vm only = is_only_peak(v_add(a.inner, b.inner), separation, least, length, slack);
        const vm sure = vm_and_not(vm_and(inside, only), apart);
        leave_hints(q, k, vm_or(far, sure), vi_load(q->record_a + k), vi_load(q->record_b + k), out);
        const vm keep = vm_and(sure, closer_than(separation, margin));
        if (vm_any(keep)) {
            const vf n_x = v_div(u_x, length), n_y = v_div(u_y, length);
            const struct touch on_a = touch_at(&a, &a, n_x, n_y, 1, vi_load(q->record_a + k));
            const struct touch on_b = touch_at(&b, &b, n_x, n_y, -1, vi_load(q->record_b + k));
            file_contacts(q, k, keep, separation, n_x, n_y, &on_a, &on_b, out);
        }
        const vm left = vm_and_not(live, vm_or(apart, sure));
        if (vm_any(left)) {
            const vm smooth = head_is(vi_and(bytes_a, bytes_b), NARC_SHAPE_SMOOTH);
            vf item[FIELDS];
            get_item(q, k, item, CONTACT_FIELDS);
            item[DIRECTION_X] = v_select(smooth, u_x, item[AXIS_X]);
            item[DIRECTION_Y] = v_select(smooth, u_y, item[AXIS_Y]);
            push(undecided, left, item, CONTACT_FIELDS);
        }
    }
    q->count = first;
}

/* Where pairs wait for a stage. */
struct stages {
    struct queue again, climb, decide;
};
_Static_assert(1 + sizeof(struct stages) / sizeof(struct queue) <= STAGES, "queues are too short");

/* Passes what waits on through the stages: whole vectors of the queues that are long enough, or all. */
static void drain_contacts(const narc_shapes *shapes, struct stages *s, bool all, float margin, struct results *out) {
    struct queue *const queues[] = {&s->again, &s->climb, &s->decide};
    for (int k = 0; k < 3; k++) {
        const int first = all ? 0 : queues[k]->count % V_WIDTH;
        if (!all && queues[k]->count < FLUSH)
            continue;
        if (all)
            pad(queues[k]);
        if (k == 0)
            look_for_contacts(shapes, &s->again, first, false, margin, &s->climb, out);
        else if (k == 1)
            climb_to_contacts(shapes, &s->climb, first, margin, &s->decide, out);
        else
            decide_contacts(shapes, &s->decide, first, margin, out);
    }
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
        v_rows((const float *)results->row + 4, sizeof results->row[0], pair + k, row + 4);
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

/* Pairs without an answer, where every pair is to have one. */
static void file_none(int pair, struct results *out) {
    const float none[ROW] = {[SEPARATION] = INFINITY};
    memcpy(out->row[pair], none, sizeof none);
    out->keep[pair] = 1;
}

/* The lanes `invalid` of the pairs `number` ... */
INLINE void file_invalid(vm invalid, int number, struct results *out) {
    for (uint32_t bits = vm_bits(invalid); bits; bits &= bits - 1)
        file_none(number + __builtin_ctz(bits), out);
}

/* How a method finds contacts: those of the pairs of a queue, whose numbers count from `first` of the batch. */
typedef void contact_method(const narc_batch *batch, size_t first, struct queue *q, float margin, struct results *out);

/* A contact kernel that goes about all pairs alike. */
static size_t contact_by(contact_method *find, const narc_batch *batch, size_t first, size_t count, float margin,
                         const narc_contacts *out) {
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    struct queue q;
    struct results results;
    size_t total = 0;
    results.hinted = false;
    for (size_t group = 0; group < count; group += GROUP) {
        const int in_group = (int)(count - group < GROUP ? count - group : GROUP);
        memset(results.keep, 0, sizeof results.keep);
        for (int block = 0; block < in_group; block += BLOCK) {
            const int n = in_group - block < BLOCK ? in_group - block : BLOCK;
            load_indices(batch, first + group + (size_t)block, n, &indices);
            q.count = 0;
            for (int k = 0; k < n; k += V_WIDTH) {
                vf item[FIELDS];
                const struct filter f = load_pairs(batch, &indices, k, n, rows, margin, block, item);
                if (margin == INFINITY)
                    file_invalid(vm_and_not(vm_first(n - k), f.valid), block + k, &results);
                push(&q, f.valid, item, FIELDS);
            }
            pad(&q);
            find(batch, first + group, &q, margin, &results);
        }
        total += list_contacts(&results, in_group, first + group, out, total);
    }
    return total;
}

static void find_plain(const narc_batch *batch, size_t first, struct queue *q, float margin, struct results *out) {
    (void)first;
    decide_contacts(batch->shapes, q, 0, margin, out);
}

static size_t contact(const narc_batch *batch, size_t first, size_t count, float margin, const narc_contacts *out) {
    if (!NARC_SHORTCUTS)
        return contact_by(find_plain, batch, first, count, margin, out);
    const bool rows = poses_are_rows(batch->bodies);
    struct pair_indices indices;
    struct queue fresh;
    struct stages stages;
    struct results results;
    size_t total = 0;
    results.hinted = batch->hints != NULL;
    stages.again.count = stages.climb.count = stages.decide.count = 0;
    for (size_t group = 0; group < count; group += GROUP) {
        const int in_group = (int)(count - group < GROUP ? count - group : GROUP);
        memset(results.keep, 0, sizeof results.keep);
        if (batch->hints)
            memcpy(results.hint, batch->hints + first + group, (size_t)in_group * sizeof *results.hint);
        for (int block = 0; block < in_group; block += BLOCK) {
            const int n = in_group - block < BLOCK ? in_group - block : BLOCK;
            load_indices(batch, first + group + (size_t)block, n, &indices);
            fresh.count = 0;
            for (int k = 0; k < n; k += V_WIDTH) {
                vf item[FIELDS];
                const struct filter f = load_pairs(batch, &indices, k, n, rows, margin, block, item);
                if (margin == INFINITY)
                    file_invalid(vm_and_not(vm_first(n - k), f.valid), block + k, &results);
                push(&fresh, vm_and_not(f.valid, f.apart), item, CONTACT_FIELDS);
            }
            pad(&fresh);
            if (batch->hints)
                look_for_contacts(batch->shapes, &fresh, 0, true, margin, &stages.again, &results);
            else
                look_for_contacts(batch->shapes, &fresh, 0, false, margin, &stages.again, &results);
            drain_contacts(batch->shapes, &stages, false, margin, &results);
        }
        drain_contacts(batch->shapes, &stages, true, margin, &results);
        if (batch->hints)
            memcpy(batch->hints + first + group, results.hint, (size_t)in_group * sizeof *results.hint);
        total += list_contacts(&results, in_group, first + group, out, total);
    }
    return total;
}
