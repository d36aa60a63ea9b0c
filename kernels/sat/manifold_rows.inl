/* SPDX-License-Identifier: MIT
 *
 * manifold_rows.inl - manifolds, stored by the number of their pair as stages find their first points, and listed in
 * order at the end. Pairs that may have a second point are collected for manifold_edges.inl.
 *
 * Two shapes have a second point only if both have edges; so of smooth shapes, and all others that touch in one point
 * for certain, a manifold costs no more than a contact.
 */
#ifndef NARC_SAT_MANIFOLD_ROWS_INL
#define NARC_SAT_MANIFOLD_ROWS_INL

#include <math.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/contact_rows.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* What stands in the row of a manifold's first point, from separation to POINT_Y as in that of a contact, and in the
 * row of its second one. */
enum { FEATURES = ARCS, RADIUS_A, RADIUS_B };
enum { SECOND_SEPARATION, SECOND_X, SECOND_Y, SECOND_FEATURES, SECOND_RADIUS_A, SECOND_RADIUS_B };

/* Contact rows of first points, and rows of second ones. */
struct manifold_rows {
    struct contact_rows first;
    _Alignas(64) float second[GROUP + 1][ROW];
};

/* A stretch longer than this part of its magnitude is an edge: four times what two radii may differ by along a normal
 * that is PARALLEL to a junction's, and eight roundings of the coordinates. */
#define LEAST_STRETCH 0x1p-18f

/* Does a body touch with an edge? Its own coordinates may be far larger than those in A's frame: what they lost when
 * they were stored is no edge either. */
INLINE vm touches_edge(const struct feature *f, vi info, vf scale) {
    const vf length = v_sub(f->along_max, f->along_min), least = v_mul(scale, find_least_edge(info));
    const vm longer = v_lt(v_max(v_mul(v_set(LEAST_STRETCH), f->magnitude), least), length);
    return vm_and_not(longer, info_has(info, NARC_SHAPE_SMOOTH));
}

/* The fields of pairs that may have a second point, in place of those that are of no more use: what is known of the
 * deepest point. */
enum {
    DEEPEST_NORMAL = AXIS,
    DEEPEST_SEPARATION = CORE,
    DEEPEST_ACROSS = SLACK,
    DEEPEST_ALONG = DIRECTION,
    DEEPEST_RECORD_A = DIRECTION + 1,
    DEEPEST_RECORD_B = SIZE
};

/* Stores the deepest points of the pairs k ... of a queue in the lanes `keep`, and collects those where both bodies
 * have edges. */
INLINE void store_deepest(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n,
                          const struct feature *on_a, const struct feature *on_b) {
    const vi info_a = get_bits(queue, INFO_A, k), info_b = get_bits(queue, INFO_B, k), zero = vi_set(0);
    const vec2 to_world = get_vec2(queue, ROTATION_A, k), normal = v2_rotate(to_world, n);
    const vec2 place = find_contact_place(on_a, on_b), point = v2_rotate(to_world, v2_rotate(n, place));
    const vm edge_a = touches_edge(on_a, info_a, get(queue, SCALE_A, k));
    const vm edge_b = touches_edge(on_b, info_b, get(queue, SCALE_B, k));
    const vi number_a = find_arc_number(on_a->record, get_bits(queue, FIRST_RECORD_A, k), info_a);
    const vi number_b = find_arc_number(on_b->record, get_bits(queue, FIRST_RECORD_B, k), info_b);
    const vi feature_a = vi_add(number_a, vi_select(edge_a, vi_set(NARC_FEATURE_EDGE), zero));
    const vi feature_b = vi_add(number_b, vi_select(edge_b, vi_set(NARC_FEATURE_EDGE), zero));
    const vf field[ROW] = {separation,
                           normal.x,
                           normal.y,
                           point.x,
                           point.y,
                           v_of_bits(vi_add(feature_a, vi_shift_left(feature_b, 8))),
                           v_select(edge_a, v_set(INFINITY), on_a->radius),
                           v_select(edge_b, v_set(INFINITY), on_b->radius)};
    put_rows(call->rows, get_bits(queue, PAIR, k), keep, field);

    const vm smooth = vm_or(info_has(info_a, NARC_SHAPE_SMOOTH), info_has(info_b, NARC_SHAPE_SMOOTH));
    const vm edges = vm_and_not(keep, smooth);
    if (!vm_any(edges))
        return;
    vf item[FIELDS];
    get_item(queue, k, item, SIZE);
    set_vec2(item, DEEPEST_NORMAL, n);
    item[DEEPEST_SEPARATION] = separation;
    item[DEEPEST_ACROSS] = place.x;
    item[DEEPEST_ALONG] = place.y;
    item[DEEPEST_RECORD_A] = v_of_bits(on_a->record);
    item[DEEPEST_RECORD_B] = v_of_bits(on_b->record);
    push(call->edges, edges, item, FIELDS);
}

/* Writes `lanes` feature ids, the lower halves of `field`, to items k ... of a column that is not NULL. */
INLINE void write_features(uint16_t *column, int k, int lanes, vf field) {
    int32_t lane[V_WIDTH];
    if (!column)
        return;
    vi_store(lane, vi_bits(field));
    for (int l = 0; l < lanes; l++)
        column[k + l] = (uint16_t)lane[l];
}

/* The second points of the rows `pair` ..., zeros where there is none. */
INLINE void load_second(const struct manifold_rows *rows, const int32_t *pair, vm two, vf field[ROW]) {
    UNROLL
    for (int f = 0; f < ROW; f++)
        field[f] = v_set(0);
    if (!vm_any(two))
        return;
    load_row(rows->second[0], pair, field);
    UNROLL
    for (int f = 0; f < ROW; f++)
        field[f] = v_select(two, field[f], v_set(0));
}

/* Writes the list of the first pairs' manifolds, all of circles; returns the columns behind it. */
static inline narc_manifolds copy_list(const struct call *call, const narc_manifolds *out) {
    const struct contact_rows *rows = call->rows;
    const int count = rows->listed;
    narc_manifolds rest = {
        .pair = out->pair ? out->pair + count : NULL,
        .point_count = fill_listed(out->point_count, count, 1, 1),
        .normal_x = copy_listed(rows, NORMAL_X, out->normal_x),
        .normal_y = copy_listed(rows, NORMAL_Y, out->normal_y),
        .separation = {copy_listed(rows, SEPARATION, out->separation[0])},
        .point_x = {copy_listed(rows, POINT_X, out->point_x[0])},
        .point_y = {copy_listed(rows, POINT_Y, out->point_y[0])},
        .radius_a = {copy_listed(rows, RADIUS_A, out->radius_a[0])},
        .radius_b = {copy_listed(rows, RADIUS_B, out->radius_b[0])},
    };
    write_pairs(call, rows->list_pair, count, out->pair);
    for (int i = 0; i < 2; i++)
        rest.feature[i] = fill_listed(out->feature[i], count, sizeof *rest.feature[i], 0);
    rest.separation[1] = fill_listed(out->separation[1], count, sizeof(float), 0);
    rest.point_x[1] = fill_listed(out->point_x[1], count, sizeof(float), 0);
    rest.point_y[1] = fill_listed(out->point_y[1], count, sizeof(float), 0);
    rest.radius_a[1] = fill_listed(out->radius_a[1], count, sizeof(float), 0);
    rest.radius_b[1] = fill_listed(out->radius_b[1], count, sizeof(float), 0);
    return rest;
}

/* Writes the stored manifolds of a call in the order of their pairs; returns how many. */
static inline size_t list_manifolds(const struct call *call, const narc_manifolds *out_manifolds) {
    const struct manifold_rows *rows = call->manifolds;
    const narc_manifolds rest = copy_list(call, out_manifolds), *out = &rest;
    int32_t pair[GROUP + V_WIDTH];
    const int n = find_listed(call, pair);
    for (int k = 0; k < n; k += V_WIDTH) {
        const int lanes = n - k < V_WIDTH ? n - k : V_WIDTH;
        int32_t known[V_WIDTH];
        vf first[ROW], second[ROW];
        for (int lane = 0; lane < V_WIDTH; lane++)
            known[lane] = lane < lanes ? rows->first.keep[pair[k + lane]] : NOT_LISTED;
        const vi points = vi_load(known);
        const vm two = vm_and(vi_lt(vi_set(ONE_POINT), points), vi_lt(points, vi_set(NO_ANSWER)));
        load_row(rows->first.row[0], pair + k, first);
        load_second(rows, pair + k, two, second);
        write_column(out->normal_x, k, lanes, first[NORMAL_X]);
        write_column(out->normal_y, k, lanes, first[NORMAL_Y]);
        write_column(out->separation[0], k, lanes, first[SEPARATION]);
        write_column(out->point_x[0], k, lanes, first[POINT_X]);
        write_column(out->point_y[0], k, lanes, first[POINT_Y]);
        write_features(out->feature[0], k, lanes, first[FEATURES]);
        write_column(out->radius_a[0], k, lanes, first[RADIUS_A]);
        write_column(out->radius_b[0], k, lanes, first[RADIUS_B]);
        write_column(out->separation[1], k, lanes, second[SECOND_SEPARATION]);
        write_column(out->point_x[1], k, lanes, second[SECOND_X]);
        write_column(out->point_y[1], k, lanes, second[SECOND_Y]);
        write_features(out->feature[1], k, lanes, second[SECOND_FEATURES]);
        write_column(out->radius_a[1], k, lanes, second[SECOND_RADIUS_A]);
        write_column(out->radius_b[1], k, lanes, second[SECOND_RADIUS_B]);
        vi_store(known, vi_select(vi_lt(points, vi_set(NO_ANSWER)), points, vi_set(0)));
        write_bytes(out->point_count, k, lanes, known, 0);
    }
    write_pairs(call, pair, n, out->pair);
    return (size_t)rows->first.listed + (size_t)n;
}

#endif
