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
    const narc_index_column column_a = batch->pairs->a, column_b = batch->pairs->b, shape = batch->bodies->shape;
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

static inline bool follows(const void *base, ptrdiff_t stride, narc_position_column first, size_t offset) {
    return base == (const void *)((const char *)first.base + offset) && stride == first.stride;
}

static inline enum pose_layout find_pose_layout(const narc_bodies *bodies) {
    const narc_position_column x = bodies->x, y = bodies->y;
    const narc_float_column cosine = bodies->cosine, sine = bodies->sine, scale = bodies->scale;
    const bool doubles = x.precision == NARC_FLOAT64;
    const size_t position = doubles ? sizeof(double) : sizeof(float), item = sizeof(float);
    if (!follows(y.base, y.stride, x, position) || !follows(cosine.base, cosine.stride, x, 2 * position) ||
        !follows(sine.base, sine.stride, x, 2 * position + item))
        return POSE_COLUMNS;
    if (!doubles)
        return POSE_ROWS;
    const bool is_row = follows(scale.base, scale.stride, x, 6 * item) &&
                        follows(bodies->shape.base, bodies->shape.stride, x, 7 * item);
    return is_row ? POSE_DOUBLE_ROWS : POSE_COLUMNS;
}

/* Positions that are float. */
INLINE narc_float_column get_singles(narc_position_column column) {
    return (narc_float_column){column.base, column.stride};
}

INLINE vf load_column(narc_float_column column, const int32_t *index) {
    float lane[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++)
        lane[k] = narc_float_at(column, (uint32_t)index[k]);
    return v_load(lane);
}

/* The item of a pair's column in each lane, from pair `first` on; the lanes behind `count` repeat the last pair.
 * Without a column, `none`. */
INLINE vf load_pair_column(narc_float_column column, size_t first, int count, float none) {
    float lane[V_WIDTH];
    if (!column.base)
        return v_set(none);
    if (column.stride == sizeof(float) && count >= V_WIDTH)
        return v_load(column.base + first);
    for (int l = 0; l < V_WIDTH; l++)
        lane[l] = narc_float_at(column, first + (size_t)(l < count ? l : count - 1));
    return v_load(lane);
}

/* Position of b minus position of a, plus a shift if there is one, in the precision of the positions (with a shift, in
 * double precision), then rounded. */
INLINE float find_difference(narc_position_column column, size_t a, size_t b, const float *shift) {
    const bool doubles = column.precision == NARC_FLOAT64;
    if (!doubles && !shift)
        return narc_single_at(column, b) - narc_single_at(column, a);
    const double from = doubles ? narc_double_at(column, a) : (double)narc_single_at(column, a);
    const double to = doubles ? narc_double_at(column, b) : (double)narc_single_at(column, b);
    return (float)(shift ? to - from + (double)*shift : to - from);
}

INLINE vec2 load_differences(const narc_bodies *bodies, const int32_t *a, const int32_t *b, const vec2 *shift) {
    float x[V_WIDTH], y[V_WIDTH], shift_x[V_WIDTH], shift_y[V_WIDTH];
    if (shift) {
        v_store(shift_x, shift->x);
        v_store(shift_y, shift->y);
    }
    for (int k = 0; k < V_WIDTH; k++) {
        const uint32_t from = (uint32_t)a[k], to = (uint32_t)b[k];
        x[k] = find_difference(bodies->x, from, to, shift ? shift_x + k : NULL);
        y[k] = find_difference(bodies->y, from, to, shift ? shift_y + k : NULL);
    }
    return (vec2){v_load(x), v_load(y)};
}

/* The difference of the bodies' positions, their rotations and scales. */
struct body_pair {
    vec2 difference, rotation_a, rotation_b;
    vf scale_a, scale_b;
};

INLINE void load_double_rows(const narc_bodies *bodies, const int32_t *a, const int32_t *b, const vec2 *shift,
                             struct body_pair *out) {
    const char *row = bodies->x.base, *half = row + 2 * sizeof(double);
    const ptrdiff_t stride = bodies->x.stride;
    const vf shifts[2] = {shift ? shift->x : v_set(0), shift ? shift->y : v_set(0)};
    vf of_a[4], of_b[4], difference[2];
    v_rows(half, stride, a, of_a);
    v_rows(half, stride, b, of_b);
    v_double_differences(row, stride, a, b, shift ? shifts : NULL, difference);
    *out = (struct body_pair){{difference[0], difference[1]}, {of_a[0], of_a[1]}, {of_b[0], of_b[1]}, of_a[2], of_b[2]};
}

INLINE void load_columns(const narc_bodies *bodies, const int32_t *a, const int32_t *b, const vec2 *shift,
                         struct body_pair *out) {
    const narc_float_column scale = bodies->scale;
    out->difference = load_differences(bodies, a, b, shift);
    out->rotation_a = (vec2){load_column(bodies->cosine, a), load_column(bodies->sine, a)};
    out->rotation_b = (vec2){load_column(bodies->cosine, b), load_column(bodies->sine, b)};
    out->scale_a = scale.base ? load_column(scale, a) : v_set(1);
    out->scale_b = scale.base ? load_column(scale, b) : v_set(1);
}

/* `shift`: of B, or NULL. */
INLINE struct body_pair load_bodies(const narc_bodies *bodies, enum pose_layout layout, const int32_t *a,
                                    const int32_t *b, const vec2 *shift) {
    const narc_float_column scale = bodies->scale;
    struct body_pair pair;
    if (__builtin_expect(layout == POSE_ROWS && !shift, 1)) { /* or compilers keep the vectors of all three in memory */
        vf of_a[4], of_b[4];
        v_rows(bodies->x.base, bodies->x.stride, a, of_a);
        v_rows(bodies->x.base, bodies->x.stride, b, of_b);
        pair = (struct body_pair){{v_sub(of_b[0], of_a[0]), v_sub(of_b[1], of_a[1])},
                                  {of_a[2], of_a[3]},
                                  {of_b[2], of_b[3]},
                                  v_set(1),
                                  v_set(1)};
        if (scale.base) {
            pair.scale_a = load_column(scale, a);
            pair.scale_b = load_column(scale, b);
        }
    } else if (layout == POSE_DOUBLE_ROWS) {
        load_double_rows(bodies, a, b, shift, &pair);
    } else {
        load_columns(bodies, a, b, shift, &pair);
    }
    return pair;
}

#endif
