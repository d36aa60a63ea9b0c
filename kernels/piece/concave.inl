/* SPDX-License-Identifier: MIT
 *
 * concave.inl - contacts of a body with a concave arc: a chain's piece with the solid outside its circle (store.h).
 *
 * Let the arc have the centre c and the radius R, and an arc of the body b and r. Of this the point farthest from c
 * lies in the direction of b - c. Where that is within the sector of the body's arc, and its opposite among the
 * normals of the concave one, both have a common normal there, and the separation is R - |b - c| - r. Each such arc
 * is a contact: a box in a bowl stands on two corners. A straight edge has none of its own, as its ends are farther
 * from c. With -R for the radius, which is how the piece is stored, all this is the gap of two arcs (normal_fan.inl)
 * along -u.
 *
 * Beyond its ends the piece has a contact where the centres lie no further than what is rounded: seams are for that, but
 * where the centres nearly coincide they are too narrow.
 *
 * A direction belongs to the arc that it does not lie behind the end of, and which either it does not lie before the
 * start of or the arc before has turned down: so whatever the rounding, none belongs to neither.
 */
#ifndef NARC_PIECE_CONCAVE_INL
#define NARC_PIECE_CONCAVE_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "sat/arc_lookup.inl"
#include "simd/simd.h"

/* Which arcs of the pairs k ... of a queue: of the piece the only one, of the body its arc i. */
struct concave_pairs {
    vm piece_is_a;
    vi info; /* of the body */
    struct ring ring_a, ring_b;
    struct pose pose;
};

/* An arc in a record, of the body, or that of the piece. */
INLINE struct arcs load_arc_of(const narc_record *records, const struct concave_pairs *pairs, vi record, bool piece) {
    vf field[8];
    load_records(records, record, field);
    return place_arc(field, &pairs->pose, piece ? pairs->piece_is_a : vm_not(pairs->piece_is_a));
}

/* From the centre of B's arc to that of A's. */
INLINE vec2 look_back(const struct concave_pairs *pairs, vec2 piece, vec2 body) {
    return v2_select(pairs->piece_is_a, v2_sub(piece, body), v2_sub(body, piece));
}

/* The gap of arc i of the body. In *out_touch, where it is one that counts; `ended`: where the normal lies behind the
 * end of the arc before, and then of this one. */
INLINE struct gap find_concave_gap(const narc_record *records, const struct concave_pairs *pairs, struct arcs piece,
                                   vi i, vm *ended, vm *out_touch, vec2 *out_end) {
    const vf zero = v_set(0);
    const vm piece_is_a = pairs->piece_is_a;
    struct gap gap;
    gap.record_a = vi_add(pairs->ring_a.base, vi_select(piece_is_a, vi_set(0), i));
    gap.record_b = vi_add(pairs->ring_b.base, vi_select(piece_is_a, i, vi_set(0)));
    const struct arcs body = load_arc_of(records, pairs, vi_select(piece_is_a, gap.record_b, gap.record_a), false);
    const vec2 back = look_back(pairs, piece.center, body.center);    /* -u */
    const vm centred = v_lt(v2_dot(back, back), v_set(LEAST_SQUARE)); /* then all directions are alike */
    const vec2 n = v2_select(centred, v2_add(piece.start, piece.end), back);
    gap.normal = n;
    gap.length = v2_length(n);
    const vf distance = v_select(centred, zero, gap.length);
    gap.separation = v_sub(v_sub(v_neg(piece.radius), distance), body.radius);
    const vm in_piece = is_in_sector(&piece, n, body.radius);
    const vf beyond = v2_cross(body.end, n); /* of half a turn, 0 is its start too */
    const vm at_start = vm_and(v_le(beyond, zero), v_lt(v2_dot(body.end, n), zero));
    const vm before_end = vm_or(v_lt(beyond, zero), at_start);
    const vm behind_start = vm_or(*ended, v_le(zero, v2_cross(body.start, n)));
    const vm round = has_flag(pairs->info, NARC_SHAPE_CIRCLE); /* its first half stands for both */
    *out_touch = vm_and(in_piece, vm_or(round, vm_and(behind_start, before_end)));
    *ended = vm_not(before_end);
    *out_end = body.end;
    return gap;
}

/* Which arcs of a body may touch. Where one does, the direction of its centre from the piece's is that of a point of the
 * outline, which lies between the tangents from there to the circle around the body: if `narrow`, only the arcs from
 * *out_first to that which does not end before `last`, as gaps' normals have it. */
struct arc_window {
    vm narrow;
    vec2 last;
};

/* Half of a window is that much wider, as a sine: junctions are looked up in 2^-13 radians. A window is narrow up to a
 * sine of WIDEST, and where the centre of the piece is not so near that directions lose digits. */
#define WINDOW_ROOM 0x1p-10f
#define WIDEST      0.9f
#define NEAREST     0x1p-8f

INLINE struct arc_window find_window(const narc_record *records, const struct queue *queue, int k,
                                     const struct concave_pairs *pairs, const struct arcs *piece, vi first_record,
                                     vi *out_first) {
    const vf half = v_set(0.5f), reach = v_neg(piece->radius);
    /* The circle around the piece has its middle in that of the chord, and no smaller radius than half of that: what is
     * left of the sum is the body's. */
    const vec2 middle = v2_scale(v2_add(piece->start, piece->end), v_mul(half, reach));
    const vec2 back = v2_sub(middle, get_vec2(queue, AXIS, k)), chord = v2_sub(piece->end, piece->start);
    const vf sizes = get(queue, CORE, k), room = v_mul(reach, v_set(0x1p-18f));
    const vf bound = v_add(v_sub(sizes, v_mul(v_mul(half, reach), v2_length(chord))), room);
    const vf distance = v2_length(back), sine = v_add(v_div(bound, distance), v_set(WINDOW_ROOM));
    const vm known = vi_lt(get_extent_ratio(pairs->info), vi_set(255));
    const vm clear = vm_and(v_lt(v_mul(reach, v_set(NEAREST)), distance), v_lt(sine, v_set(WIDEST)));
    const vm narrow = vm_and_not(vm_and(known, clear), has_flag(pairs->info, NARC_SHAPE_CIRCLE));
    const vec2 turn = {v_sqrt(v_sub(v_set(1), v_mul(sine, sine))), sine}, first = v2_unrotate(turn, back);
    const vec2 own = v2_select(pairs->piece_is_a, v2_unrotate_opposite(pairs->pose.rotation, first), first);
    const vi record = find_arc(records, first_record, pairs->info, own);
    *out_first = vi_select(narrow, vi_sub(record, find_first_arc(first_record, pairs->info)), vi_set(0));
    return (struct arc_window){narrow, v2_rotate(turn, back)};
}

/* Writes the rows of gaps to these places. */
NOINLINE void write_gaps(const struct call *call, const struct queue *queue, int k, const struct gap *gap,
                         char *const *place) {
    const struct pose pose = get_pose(queue, k);
    const struct arc_pair arcs = load_arc_pair(call->batch->shapes->records, gap->record_a, gap->record_b, &pose);
    const vec2 n = v2_divide(gap->normal, gap->length);
    const struct feature on_a = find_feature(&arcs.a, &arcs.a, n, gap->record_a, false);
    const struct feature on_b = find_feature(&arcs.b, &arcs.b, n, gap->record_b, true);
    const struct answer answer = find_answer(queue, k, gap->separation, n, &on_a, &on_b, has_reaches(call));
    write_rows(call, place, find_numbers(call, get_bits(queue, PAIR, k)), &answer);
}

/* Puts the last of a pair's rows among those before it: they are in the order of their normals, counter-clockwise. */
INLINE void sort_last_row(const struct call *call, char *rows, ptrdiff_t stride, int last) {
    const size_t size = call->batch->row_size, normal_at = call->question->normal_at;
    char row[sizeof(narc_manifold)];
    float normal[2], other[2];
    int k = last;
    memcpy(row, rows + last * stride, size);
    memcpy(normal, row + normal_at, sizeof normal);
    for (; k > 0; k--) {
        const char *const before = rows + (k - 1) * stride;
        memcpy(other, before + normal_at, sizeof other);
        if (!(other[0] * normal[1] - other[1] * normal[0] < 0))
            break;
        memcpy(rows + k * stride, before, size);
    }
    memcpy(rows + k * stride, row, size);
}

/* A call that asks for all rows of pairs: lists another of each in the lanes `keep`. */
INLINE void list_gaps(const struct call *call, const struct queue *queue, int k, vm keep, const struct gap *gap) {
    struct rows *const rows = call->rows;
    const uint32_t kept = vm_bits(keep);
    char *place[V_WIDTH];
    int32_t pair[V_WIDTH];
    get_pairs(queue, k, pair);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        const narc_row_list *const list = &rows->out.lists[kept >> lane & 1 ? pair[lane] : 0];
        const bool has_room = (kept >> lane & 1) && list->count < list->room;
        const ptrdiff_t next = (ptrdiff_t)list->first + (ptrdiff_t)list->count;
        place[lane] = has_room ? rows->out.base + next * rows->out.stride : rows->spare;
    }
    write_gaps(call, queue, k, gap, place);
    for (uint32_t lanes = kept; lanes; lanes &= lanes - 1) {
        narc_row_list *const list = &rows->out.lists[pair[FIND_LOWEST(lanes)]];
        char *const first = rows->out.base + (ptrdiff_t)list->first * rows->out.stride;
        if (list->count == list->room)
            continue;
        sort_last_row(call, first, rows->out.stride, (int)list->count++);
    }
    rows->done = (int)call->count;
}

/* Notes in pairs' rows how many there are besides, of `counts` in all. */
INLINE void note_more_rows(const struct call *call, vi counts, char *const *place) {
    int32_t count[V_WIDTH];
    if (call->rows->dense)
        return;
    vi_store(count, counts);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        const uint8_t more = count[lane] > 1 ? (uint8_t)(count[lane] - 1) : 0;
        if (more == 0)
            continue;
        memcpy(place[lane] + call->batch->more_at, &more, sizeof more);
        *call->rows->out.more += more;
    }
}

/* Answers the pairs k ... of a queue, in the lanes `live`. */
NOINLINE void answer_concave_pairs(const struct call *call, const struct queue *queue, int k, vm live) {
    const narc_record *const records = call->batch->shapes->records;
    const vi info_a = get_bits(queue, INFO_A, k), info_b = get_bits(queue, INFO_B, k), zero = vi_set(0);
    const vm piece_is_a = has_mark(info_a, NARC_PIECE_CONCAVE);
    const vi info = vi_select(piece_is_a, info_b, info_a);
    const struct concave_pairs pairs = {piece_is_a, info, get_ring_a(queue, k), get_ring_b(queue, k),
                                        get_pose(queue, k)};
    const vi body_base = vi_select(piece_is_a, pairs.ring_b.base, pairs.ring_a.base);
    const vi first_record =
        vi_select(piece_is_a, get_bits(queue, FIRST_RECORD_B, k), get_bits(queue, FIRST_RECORD_A, k));
    const vi all = get_arc_count(info), one = vi_set(1);
    const vm round = has_flag(info, NARC_SHAPE_CIRCLE);
    const vi count = vi_select(round, one, all); /* of its halves one counts */
    const vf margin = get_margins(call, queue, k);
    const vm open = vm_and_not(live, has_mark(info, NARC_PIECE_CONCAVE)); /* concave against concave: none */
    const vm beside = v_lt(v_set(0), get(queue, SLACK, k));
    const bool lists = call->rows->out.lists;
    struct gap deepest = {v_set(INFINITY), {v_set(0), v_set(0)}, v_set(1), pairs.ring_a.base, pairs.ring_b.base};
    vi found = zero, first = zero, lowest = zero; /* lowest: the number of the deepest one's arc */
    const struct arcs piece =
        load_arc_of(records, &pairs, vi_select(piece_is_a, pairs.ring_a.base, pairs.ring_b.base), true);
    struct arc_window window = {vm_front(0), {v_set(0), v_set(0)}};
    if (!lists && vm_any(vm_and_not(open, round)))
        window = find_window(records, queue, k, &pairs, &piece, first_record, &first);
    const bool runs = vm_any(has_mark(info, NARC_PIECE_RUN));
    vm ended = open, touch, left = open;
    vec2 end;
    if (vm_any(vm_and_not(vm_and_not(open, round), window.narrow)))
        (void)find_concave_gap(records, &pairs, piece, vi_sub(all, one), &ended, &touch, &end);
    ended = vm_and_not(ended, window.narrow); /* its first arc starts before all directions */
    for (int i = 0; vm_any(left = vm_and(left, vi_lt(vi_set(i), count))); i++) {
        const vi next = vi_add(first, vi_set(i)), arc = vi_select(vi_lt(next, all), next, vi_sub(next, all));
        const vi own = vi_select(left, arc, zero);
        const struct gap gap = find_concave_gap(records, &pairs, piece, own, &ended, &touch, &end);
        const vm real = vm_not(vm_and(beside, v_lt(gap.separation, v_set(0))));
        vm keep = vm_and(vm_and(left, touch), vm_and(real, is_below(gap.separation, margin)));
        left = vm_and_not(left, vm_and(window.narrow, v_le(v_set(0), v2_cross(window.last, end))));
        if (runs)
            keep = vm_and(keep, is_front(info, find_arc_number(vi_add(body_base, own), first_record, info)));
        if (vm_any(keep))
            keep = keep_reached(call, queue, k, keep, gap.separation, v2_divide(gap.normal, gap.length));
        if (!vm_any(keep))
            continue;
        const vm tie = vm_and(vi_lt(own, lowest), v_le(gap.separation, deepest.separation));
        const vm deeper = vm_and(keep, vm_or(tie, v_lt(gap.separation, deepest.separation)));
        deepest = select_gap(deeper, &gap, &deepest);
        lowest = vi_select(deeper, own, lowest);
        found = vi_add(found, vi_select(keep, one, zero));
        if (lists)
            list_gaps(call, queue, k, keep, &gap);
    }
    const vm any = vi_lt(zero, found);
    if (lists || !vm_any(any))
        return;
    char *place[V_WIDTH];
    find_places(call, get_bits(queue, PAIR, k), any, place);
    write_gaps(call, queue, k, &deepest, place);
    note_more_rows(call, found, place);
}

/* Answers the last pairs that wait: while there are others, whole vectors. */
static void answer_concave(const struct call *call) {
    struct queue *const queue = call->concave;
    const int begin = queue->count > STEP ? queue->count - STEP : 0;
    if (queue->count % V_WIDTH != 0 && begin == 0)
        pad(queue);
    for (int k = begin; k < queue->count; k += V_WIDTH)
        answer_concave_pairs(call, queue, k, vm_front(queue->count - k));
    queue->count = begin;
}

#endif
