/* SPDX-License-Identifier: MIT
 *
 * contact_rows.inl - contacts, stored by the number of their pair as stages find them, and listed in order at the end.
 */
#ifndef NARC_BASE_CONTACT_ROWS_INL
#define NARC_BASE_CONTACT_ROWS_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/arcs.inl"
#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/gap.inl"
#include "base/hints.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

enum { SEPARATION, NORMAL_X, NORMAL_Y, POINT_X, POINT_Y, ARCS, ROW = 8 };

enum { GROUP = NARC_CONTACT_GROUP };

/* What is known of a pair. */
enum { NOT_LISTED, ONE_POINT, TWO_POINTS, NO_ANSWER };

/* What is known of the pairs of a call. The contacts of the first ones may be known in order: they are listed at once.
 * Each other pair has a row. The last row takes what lanes without a contact write. */
struct contact_rows {
    int done, listed; /* all pairs before `done` are answered, and have `listed` contacts */
    _Alignas(64) float list[ROW][GROUP + V_WIDTH];
    int32_t list_pair[GROUP + V_WIDTH];
    _Alignas(64) float row[GROUP + 1][ROW];
    int32_t keep[GROUP + 1]; /* one of the above */
    bool hinted;             /* are hints wanted? */
    uint32_t hint[GROUP + V_WIDTH];
};

/* The rows of pairs in the lanes `keep`. */
INLINE void find_rows(vi pairs, vm keep, int32_t row[V_WIDTH]) { vi_store(row, vi_select(keep, pairs, vi_set(GROUP))); }

/* Keeps the hints of pairs in the lanes `ended`. */
INLINE void put_hints(struct contact_rows *rows, vi pairs, vm ended, vi hints) {
    int32_t row[V_WIDTH], hint[V_WIDTH];
    find_rows(pairs, ended, row);
    vi_store(hint, hints);
    for (int lane = 0; lane < V_WIDTH; lane++)
        rows->hint[row[lane]] = (uint32_t)hint[lane];
}

/* Stores hints for the pairs k ... of a queue in the lanes `ended`. */
INLINE void store_hints(const struct call *call, const struct queue *queue, int k, vm ended, vi record_a, vi record_b) {
    if (call->rows->hinted)
        put_hints(call->rows, get_bits(queue, PAIR, k), ended, make_hint(queue, k, record_a, record_b));
}

/* The caller's number of an arc from its record; a circle's two halves are both arc 0. */
INLINE vi find_arc_number(vi record, vi first_record, vi info) {
    const vi index = vi_sub(record, first_arc_record(first_record, info));
    const vi number = vi_add(index, info_first_arc(info)), count = info_count(info);
    const vi wrapped = vi_select(vi_lt(number, count), number, vi_sub(number, count));
    return vi_select(info_has(info, NARC_SHAPE_CIRCLE), vi_set(0), wrapped);
}

INLINE void put_rows(struct contact_rows *rows, vi pairs, vm keep, const vf field[ROW]) {
    int32_t row[V_WIDTH];
    find_rows(pairs, keep, row);
    v_put_rows(rows->row, sizeof rows->row[0], row, field);
    v_put_rows((float *)rows->row + 4, sizeof rows->row[0], row, field + 4);
    for (int lane = 0; lane < V_WIDTH; lane++)
        rows->keep[row[lane]] = ONE_POINT;
}

/* Appends contacts to the list, in the lanes `keep`. */
INLINE void append_to_list(struct contact_rows *rows, vi pairs, vm keep, const vf field[ROW]) {
    const vp packing = vm_packing(keep);
    UNROLL
    for (int f = 0; f < ROW; f++)
        v_store(rows->list[f] + rows->listed, v_pack(packing, field[f]));
    vi_store(rows->list_pair + rows->listed, vi_bits(v_pack(packing, v_of_bits(pairs))));
    rows->listed += __builtin_popcount(vm_bits(keep));
}

/* Stores the contacts of the pairs k ... of a queue in the lanes `keep`. */
INLINE void store_contacts(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n,
                           const struct feature *on_a, const struct feature *on_b) {
    const vec2 to_world = get_vec2(queue, ROTATION_A, k), normal = v2_rotate(to_world, n);
    const vec2 point = v2_rotate(to_world, v2_rotate(n, find_contact_place(on_a, on_b)));
    const vi arc_a = find_arc_number(on_a->record, get_bits(queue, FIRST_RECORD_A, k), get_bits(queue, INFO_A, k));
    const vi arc_b = find_arc_number(on_b->record, get_bits(queue, FIRST_RECORD_B, k), get_bits(queue, INFO_B, k));
    const vf arcs = v_of_bits(vi_add(arc_a, vi_shift_left(arc_b, 8))), none = v_set(0);
    const vf field[ROW] = {separation, normal.x, normal.y, point.x, point.y, arcs, none, none};
    put_rows(call->rows, get_bits(queue, PAIR, k), keep, field);
}

/* The unit normal of the gap of the pairs k ... of a queue, and what touches along it. */
INLINE vec2 find_gap_features(const struct call *call, const struct queue *queue, int k, const struct gap *gap,
                              struct feature *out_a, struct feature *out_b) {
    const narc_record *records = call->batch->shapes->records;
    const vec2 n = v2_divide(gap->normal, gap->length);
    const struct pose pose = get_pose(queue, k);
    *out_a = find_feature_at(records, get_ring_a(queue, k), gap->record_a, &pose, n, false);
    *out_b = find_feature_at(records, get_ring_b(queue, k), gap->record_b, &pose, n, true);
    return n;
}

/* With an infinite margin every pair has a contact. Stores that of pairs without an answer, in the lanes `which`. */
INLINE void store_no_contact(const struct call *call, vi pairs, vm which) {
    const float none[ROW] = {[SEPARATION] = INFINITY};
    int32_t pair[V_WIDTH];
    if (!vm_any(which))
        return;
    vi_store(pair, pairs);
    for (uint32_t lanes = vm_bits(which); lanes; lanes &= lanes - 1) {
        const int k = pair[__builtin_ctz(lanes)];
        if (!(find_margin(call, k) >= INFINITY))
            continue;
        memcpy(call->rows->row[k], none, sizeof none);
        call->rows->keep[k] = NO_ANSWER;
    }
}

/* The pairs of a call that are listed from rows, in order; returns how many. Behind them stands the last row. */
INLINE int find_listed(const struct call *call, int32_t pair[GROUP + V_WIDTH]) {
    const int count = (int)call->count;
    int n = 0;
    for (int k = call->rows->done; k < count; k += V_WIDTH) {
        const vm listed = vm_and(vm_front(count - k), vi_lt(vi_set(NOT_LISTED), vi_load(call->rows->keep + k)));
        const vf pairs = v_of_bits(vi_add(vi_lanes(), vi_set(k)));
        vi_store(pair + n, vi_bits(v_pack(vm_packing(listed), pairs)));
        n += __builtin_popcount(vm_bits(listed));
    }
    vi_store(pair + n, vi_set(GROUP));
    return n;
}

/* Writes `lanes` items k ... of a column that is not NULL. */
INLINE void write_column(float *column, int k, int lanes, vf field) {
    if (!column)
        return;
    if (lanes == V_WIDTH)
        v_store(column + k, field);
    else
        v_store_front(column + k, lanes, field);
}

INLINE void write_bytes(uint8_t *column, int k, int lanes, const int32_t lane[V_WIDTH], int shift) {
    if (!column)
        return;
    for (int l = 0; l < lanes; l++)
        column[k + l] = (uint8_t)(lane[l] >> shift);
}

/* The numbers of `count` pairs, counted from the start of the batch. */
INLINE void write_pairs(const struct call *call, const int32_t *pair, int count, uint32_t *column) {
    const uint32_t first = (uint32_t)call->first; /* a batch has fewer than 2^32 pairs */
    if (!column)
        return;
    for (int k = 0; k < count; k++)
        column[k] = first + (uint32_t)pair[k];
}

INLINE void load_row(const float *rows, const int32_t *row, vf field[ROW]) {
    v_rows(rows, ROW * sizeof *rows, row, field);
    v_rows(rows + 4, ROW * sizeof *rows, row, field + 4);
}

/* Copies a column of the list of the first pairs' contacts; returns the place behind it. */
INLINE float *copy_listed(const struct contact_rows *rows, int field, float *column) {
    if (!column)
        return NULL;
    if (rows->listed > 0)
        memcpy(column, rows->list[field], (size_t)rows->listed * sizeof *column);
    return column + rows->listed;
}

/* Fills `count` items of a column with one byte; returns the place behind them. */
INLINE void *fill_listed(void *column, int count, size_t size, int byte) {
    return column ? (char *)memset(column, byte, (size_t)count * size) + (size_t)count * size : NULL;
}

/* Writes the stored contacts of a call in the order of their pairs; returns how many. */
static inline size_t list_contacts(const struct call *call, const narc_contacts *out) {
    const struct contact_rows *rows = call->rows;
    int32_t pair[GROUP + V_WIDTH];
    float *const lists[] = {out->separation, out->normal_x, out->normal_y, out->point_x, out->point_y};
    float *columns[ARCS];
    for (int f = 0; f < ARCS; f++)
        columns[f] = copy_listed(rows, f, lists[f]);
    write_pairs(call, rows->list_pair, rows->listed, out->pair);
    uint8_t *const arc_a = fill_listed(out->arc_a, rows->listed, 1, 0);
    uint8_t *const arc_b = fill_listed(out->arc_b, rows->listed, 1, 0);
    const int n = find_listed(call, pair);
    for (int k = 0; k < n; k += V_WIDTH) {
        vf field[ROW];
        load_row(rows->row[0], pair + k, field);
        const int lanes = n - k < V_WIDTH ? n - k : V_WIDTH;
        UNROLL
        for (int f = 0; f < ARCS; f++)
            write_column(columns[f], k, lanes, field[f]);
        int32_t arcs[V_WIDTH];
        vi_store(arcs, vi_bits(field[ARCS]));
        write_bytes(arc_a, k, lanes, arcs, 0);
        write_bytes(arc_b, k, lanes, arcs, 8);
    }
    write_pairs(call, pair, n, out->pair ? out->pair + rows->listed : NULL);
    return (size_t)rows->listed + (size_t)n;
}

#endif
