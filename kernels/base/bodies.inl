/* SPDX-License-Identifier: MIT
 *
 * bodies.inl - the two bodies of a pair in each lane, from the caller's columns.
 */
#ifndef NARC_BASE_BODIES_INL
#define NARC_BASE_BODIES_INL

#include <stdbool.h>
#include <stdint.h>

#include "base/queue.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "simd/simd.h"

/* The bodies and shapes of a block's pairs. The lanes behind the last pair repeat the first. */
struct pair_indices {
    _Alignas(64) int32_t a[BLOCK], b[BLOCK], shape_a[BLOCK], shape_b[BLOCK];
};

INLINE void load_indices(const narc_batch *batch, size_t first, int count, struct pair_indices *out) {
    const narc_column column_a = batch->pairs->a, column_b = batch->pairs->b, shape = batch->bodies->shape;
    for (int k = 0; k < count; k++) {
        const uint32_t a = narc_index_at(column_a, first + (size_t)k), b = narc_index_at(column_b, first + (size_t)k);
        out->a[k] = (int32_t)a;
        out->b[k] = (int32_t)b;
        out->shape_a[k] = (int32_t)narc_index_at(shape, a);
        out->shape_b[k] = (int32_t)narc_index_at(shape, b);
    }
    for (int k = count; k % V_WIDTH != 0; k++) {
        out->a[k] = out->a[0];
        out->b[k] = out->b[0];
        out->shape_a[k] = out->shape_a[0];
        out->shape_b[k] = out->shape_b[0];
    }
}

/* How the caller's poses lie in memory. In rows, what belongs to a body is read at once. */
enum pose_layout {
    POSE_COLUMNS,
    POSE_ROWS,       /* x, y, cosine and sine follow each other, all float */
    POSE_DOUBLE_ROWS /* double x, y; float cosine, sine, scale; shape: 32 bytes */
};

static inline bool follows(narc_column column, narc_column first, size_t offset) {
    return column.base == (const void *)((const char *)first.base + offset) && column.stride == first.stride;
}

static inline enum pose_layout find_pose_layout(const narc_bodies *bodies) {
    const narc_column x = bodies->x;
    const bool doubles = bodies->position_precision == NARC_FLOAT64;
    const size_t position = doubles ? sizeof(double) : sizeof(float), item = sizeof(float);
    if (!follows(bodies->y, x, position) || !follows(bodies->cosine, x, 2 * position) ||
        !follows(bodies->sine, x, 2 * position + item))
        return POSE_COLUMNS;
    if (!doubles)
        return POSE_ROWS;
    return follows(bodies->scale, x, 6 * item) && follows(bodies->shape, x, 7 * item) ? POSE_DOUBLE_ROWS : POSE_COLUMNS;
}

INLINE vf load_column(narc_column column, const int32_t *index) {
    float lane[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++)
        lane[k] = narc_float_at(column, (uint32_t)index[k]);
    return v_load(lane);
}

/* The item of a pair's column in each lane, from pair `first` on; the lanes behind `count` repeat the last pair.
 * Without a column, `none`. */
INLINE vf load_pair_column(narc_column column, size_t first, int count, float none) {
    float lane[V_WIDTH];
    if (!column.base)
        return v_set(none);
    for (int l = 0; l < V_WIDTH; l++)
        lane[l] = narc_float_at(column, first + (size_t)(l < count ? l : count - 1));
    return v_load(lane);
}

/* The shifts of B in pairs from `first` on, x and y of each lane in turn; the lanes behind `count` repeat the last
 * pair. */
INLINE void load_shifts(const narc_pairs *pairs, size_t first, int count, float out[2 * V_WIDTH]) {
    for (int l = 0; l < V_WIDTH; l++) {
        const size_t pair = first + (size_t)(l < count ? l : count - 1);
        out[2 * l] = pairs->shift_x.base ? narc_float_at(pairs->shift_x, pair) : 0;
        out[2 * l + 1] = pairs->shift_y.base ? narc_float_at(pairs->shift_y, pair) : 0;
    }
}

/* Position of b minus position of a, plus a shift if there is one, in the precision of the positions (with a shift, in
 * double precision), then rounded. */
INLINE float find_difference(narc_precision precision, narc_column column, size_t a, size_t b, const float *shift) {
    const bool doubles = precision == NARC_FLOAT64;
    if (!doubles && !shift)
        return narc_float_at(column, b) - narc_float_at(column, a);
    const double from = doubles ? narc_double_at(column, a) : (double)narc_float_at(column, a);
    const double to = doubles ? narc_double_at(column, b) : (double)narc_float_at(column, b);
    return (float)(shift ? to - from + (double)*shift : to - from);
}

INLINE vec2 load_differences(const narc_bodies *bodies, const int32_t *a, const int32_t *b, const float *shifts) {
    const narc_precision precision = bodies->position_precision;
    float x[V_WIDTH], y[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++) {
        const uint32_t from = (uint32_t)a[k], to = (uint32_t)b[k];
        x[k] = find_difference(precision, bodies->x, from, to, shifts ? shifts + 2 * k : NULL);
        y[k] = find_difference(precision, bodies->y, from, to, shifts ? shifts + 2 * k + 1 : NULL);
    }
    return (vec2){v_load(x), v_load(y)};
}

/* The difference of the bodies' positions, their rotations and scales. */
struct body_pair {
    vec2 difference, rotation_a, rotation_b;
    vf scale_a, scale_b;
};

/* The second half of a row with doubles. */
INLINE void load_half_rows(const narc_bodies *bodies, const int32_t *index, vf half[4]) {
    v_rows((const char *)bodies->x.base + 2 * sizeof(double), bodies->x.stride, index, half);
}

/* `shifts`: of load_shifts(), or NULL. */
INLINE struct body_pair load_bodies(const narc_bodies *bodies, enum pose_layout layout, const int32_t *a,
                                    const int32_t *b, const float *shifts) {
    struct body_pair pair;
    if (layout == POSE_DOUBLE_ROWS) {
        vf of_a[4], of_b[4], difference[2];
        load_half_rows(bodies, a, of_a);
        load_half_rows(bodies, b, of_b);
        v_double_differences(bodies->x.base, bodies->x.stride, a, b, shifts, difference);
        return (struct body_pair){
            {difference[0], difference[1]}, {of_a[0], of_a[1]}, {of_b[0], of_b[1]}, of_a[2], of_b[2]};
    }
    const narc_column scale = bodies->scale;
    pair.scale_a = scale.base ? load_column(scale, a) : v_set(1);
    pair.scale_b = scale.base ? load_column(scale, b) : v_set(1);
    if (layout == POSE_ROWS) {
        vf of_a[4], of_b[4];
        v_rows(bodies->x.base, bodies->x.stride, a, of_a);
        v_rows(bodies->x.base, bodies->x.stride, b, of_b);
        pair.difference = (vec2){v_sub(of_b[0], of_a[0]), v_sub(of_b[1], of_a[1])};
        pair.rotation_a = (vec2){of_a[2], of_a[3]};
        pair.rotation_b = (vec2){of_b[2], of_b[3]};
        if (shifts)
            pair.difference = load_differences(bodies, a, b, shifts);
        return pair;
    }
    pair.difference = load_differences(bodies, a, b, shifts);
    pair.rotation_a = (vec2){load_column(bodies->cosine, a), load_column(bodies->sine, a)};
    pair.rotation_b = (vec2){load_column(bodies->cosine, b), load_column(bodies->sine, b)};
    return pair;
}

#endif
