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

/* Do x, y, cosine and sine of a body follow each other? Then they are read as one row of four floats. */
static inline bool poses_are_adjacent(const narc_bodies *bodies) {
    const char *x = bodies->x.base;
    const size_t stride = bodies->x.stride;
    return bodies->position_precision == NARC_FLOAT32 && bodies->y.base == (const void *)(x + sizeof(float)) &&
           bodies->cosine.base == (const void *)(x + 2 * sizeof(float)) &&
           bodies->sine.base == (const void *)(x + 3 * sizeof(float)) && bodies->y.stride == stride &&
           bodies->cosine.stride == stride && bodies->sine.stride == stride;
}

/* Position of b minus position of a, rounded once. */
INLINE float find_difference(narc_precision precision, narc_column column, size_t a, size_t b) {
    if (precision == NARC_FLOAT64)
        return (float)(narc_double_at(column, b) - narc_double_at(column, a));
    return narc_float_at(column, b) - narc_float_at(column, a);
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

/* Position of b plus a shift minus position of a, rounded once. */
INLINE float find_shifted_difference(narc_precision precision, narc_column column, size_t a, size_t b, float shift) {
    const bool is_double = precision == NARC_FLOAT64;
    const double from = is_double ? narc_double_at(column, a) : (double)narc_float_at(column, a);
    const double to = is_double ? narc_double_at(column, b) : (double)narc_float_at(column, b);
    return (float)(to - from + (double)shift);
}

/* The difference of the bodies' positions where B's are shifted. */
INLINE vec2 load_shifted_difference(const narc_bodies *bodies, vec2 shift, const int32_t *a, const int32_t *b) {
    float x[V_WIDTH], y[V_WIDTH];
    v_store(x, shift.x);
    v_store(y, shift.y);
    for (int k = 0; k < V_WIDTH; k++) {
        x[k] = find_shifted_difference(bodies->position_precision, bodies->x, (uint32_t)a[k], (uint32_t)b[k], x[k]);
        y[k] = find_shifted_difference(bodies->position_precision, bodies->y, (uint32_t)a[k], (uint32_t)b[k], y[k]);
    }
    return (vec2){v_load(x), v_load(y)};
}

/* The difference of the bodies' positions, and their rotations. */
struct body_pair {
    vec2 difference, rotation_a, rotation_b;
};

INLINE struct body_pair load_bodies(const narc_bodies *bodies, bool adjacent, const int32_t *a, const int32_t *b) {
    if (adjacent) {
        vf of_a[4], of_b[4];
        v_rows(bodies->x.base, bodies->x.stride, a, of_a);
        v_rows(bodies->x.base, bodies->x.stride, b, of_b);
        return (struct body_pair){
            {v_sub(of_b[0], of_a[0]), v_sub(of_b[1], of_a[1])}, {of_a[2], of_a[3]}, {of_b[2], of_b[3]}};
    }
    float x[V_WIDTH], y[V_WIDTH];
    for (int k = 0; k < V_WIDTH; k++) {
        x[k] = find_difference(bodies->position_precision, bodies->x, (uint32_t)a[k], (uint32_t)b[k]);
        y[k] = find_difference(bodies->position_precision, bodies->y, (uint32_t)a[k], (uint32_t)b[k]);
    }
    return (struct body_pair){{v_load(x), v_load(y)},
                              {load_column(bodies->cosine, a), load_column(bodies->sine, a)},
                              {load_column(bodies->cosine, b), load_column(bodies->sine, b)}};
}

#endif
