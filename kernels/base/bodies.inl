/* SPDX-License-Identifier: MIT
 *
 * bodies.inl - the two bodies of a pair in each lane, or a body alone, from the caller's columns.
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

/* The numbers of a block's pairs, their bodies and shapes. The lanes behind the last pair repeat it. */
struct pair_indices {
    _Alignas(64) int32_t number[BLOCK], a[BLOCK], b[BLOCK], shape_a[BLOCK], shape_b[BLOCK];
};

/* What pairs are loaded from: copies of what the caller gave. Nothing that is written could change them, so that compilers
 * keep them in registers. */
struct sources {
    narc_bodies a, b;
    narc_pairs pairs;
    narc_index_column selection;
};

INLINE struct sources copy_sources(const narc_batch *batch) {
    return (struct sources){*batch->a, *batch->b, *batch->pairs, batch->query->selection};
}

INLINE void load_shapes_of(const struct sources *given, int k, struct pair_indices *out) {
    out->shape_a[k] = (int32_t)narc_index_at(given->a.shape, (uint32_t)out->a[k]);
    out->shape_b[k] = (int32_t)narc_index_at(given->b.shape, (uint32_t)out->b[k]);
}

/* Pairs `first` ... of those that are asked of, and their bodies; `shapes`: and those, if no poses bring them. */
INLINE void load_pairs(const struct sources *given, size_t first, int count, bool shapes, struct pair_indices *out) {
    const narc_index_column a = given->pairs.a, b = given->pairs.b, list = given->selection;
    const bool arrays = a.base && b.base && a.stride == sizeof *a.base && b.stride == sizeof *b.base;
    if (LIKELY(arrays && !list.base && count == BLOCK)) {
        UNROLL
        for (int k = 0; k < BLOCK; k += V_WIDTH) {
            vi_store(out->number + k, vi_add(vi_lanes(), vi_set((int32_t)(uint32_t)first + k)));
            vi_store(out->a + k, vi_load((const int32_t *)a.base + first + k));
            vi_store(out->b + k, vi_load((const int32_t *)b.base + first + k));
        }
        if (shapes) {
            UNROLL_FEW
            for (int k = 0; k < BLOCK; k++)
                load_shapes_of(given, k, out);
        }
        return;
    }
    if (LIKELY(arrays && list.base && list.stride == sizeof *list.base && count == BLOCK)) {
        UNROLL_FEW
        for (int k = 0; k < BLOCK; k++) {
            const uint32_t number = list.base[first + (size_t)k];
            out->number[k] = (int32_t)number;
            out->a[k] = (int32_t)a.base[number];
            out->b[k] = (int32_t)b.base[number];
            if (shapes)
                load_shapes_of(given, k, out);
        }
        return;
    }
    if (LIKELY(a.base && b.base && !list.base)) {
        UNROLL_FEW
        for (size_t k = 0; k < (size_t)count; k++) {
            out->number[k] = (int32_t)(uint32_t)(first + k);
            out->a[k] = (int32_t)narc_index_at(a, first + k);
            out->b[k] = (int32_t)narc_index_at(b, first + k);
            if (shapes)
                load_shapes_of(given, (int)k, out);
        }
    } else {
        for (int k = 0; k < count; k++) {
            const size_t place = first + (size_t)k, number = list.base ? narc_index_at(list, place) : place;
            out->number[k] = (int32_t)(uint32_t)number;
            out->a[k] = (int32_t)(uint32_t)(a.base ? narc_index_at(a, number) : number);
            out->b[k] = (int32_t)(uint32_t)(b.base ? narc_index_at(b, number) : number);
            if (shapes)
                load_shapes_of(given, k, out);
        }
    }
    for (int k = count; k % V_WIDTH != 0; k++) { /* lanes behind the last pair repeat it */
        out->number[k] = out->number[count - 1];
        out->a[k] = out->a[count - 1];
        out->b[k] = out->b[count - 1];
        if (shapes)
            load_shapes_of(given, k, out);
    }
}

/* How the caller's poses lie in memory. In rows, what belongs to a body is read at once. */
enum pose_layout {
    POSE_COLUMNS,
    POSE_ROWS,        /* x, y, cosine and sine follow each other, all float */
    POSE_DOUBLE_ROWS, /* double x, y; float cosine, sine, scale; shape: 32 bytes */
    POSE_LANES        /* arrays of whole vectors, all float; bodies follow each other as pairs do */
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

/* That of both sets of a batch, where it is the same. */
static inline enum pose_layout find_layout(const struct sources *given) {
    const enum pose_layout a = find_pose_layout(&given->a), b = find_pose_layout(&given->b);
    return a == b ? a : POSE_COLUMNS;
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

/* The item of a pair's column in each lane. Without a column, `none`. */
INLINE vf load_column_or(narc_float_column column, const int32_t *number, float none) {
    return column.base ? load_column(column, number) : v_set(none);
}

/* Position of b minus position of a, plus a shift if there is one, in the precision of the positions (with a shift, or
 * where one set has doubles, in double precision), then rounded. dispatch/pair.c has the same bits of one pair. */
INLINE float find_difference(narc_position_column of_a, narc_position_column of_b, size_t a, size_t b,
                             const float *shift) {
    if (of_a.precision == NARC_FLOAT32 && of_b.precision == NARC_FLOAT32 && !shift)
        return narc_single_at(of_b, b) - narc_single_at(of_a, a);
    const double from = narc_position_at(of_a, a), to = narc_position_at(of_b, b);
    return (float)(shift ? to - from + (double)*shift : to - from);
}

INLINE vec2 load_differences(const struct sources *given, const int32_t *a, const int32_t *b, const vec2 *shift) {
    float x[V_WIDTH], y[V_WIDTH], shift_x[V_WIDTH], shift_y[V_WIDTH];
    if (shift) {
        v_store(shift_x, shift->x);
        v_store(shift_y, shift->y);
    }
    for (int k = 0; k < V_WIDTH; k++) {
        const uint32_t from = (uint32_t)a[k], to = (uint32_t)b[k];
        x[k] = find_difference(given->a.x, given->b.x, from, to, shift ? shift_x + k : NULL);
        y[k] = find_difference(given->a.y, given->b.y, from, to, shift ? shift_y + k : NULL);
    }
    return (vec2){v_load(x), v_load(y)};
}

/* From A's position to B's along one axis. `plain`: both are double, and there is no shift. */
INLINE double find_way(narc_position_column of_a, narc_position_column of_b, size_t a, size_t b,
                       narc_float_column shift, size_t number, bool plain) {
    if (plain)
        return narc_double_at(of_b, b) - narc_double_at(of_a, a) + 0;
    return narc_position_at(of_b, b) - narc_position_at(of_a, a) + (double)narc_float_or(shift, number, 0);
}

INLINE bool are_double(const narc_bodies *bodies) {
    return bodies->x.precision == NARC_FLOAT64 && bodies->y.precision == NARC_FLOAT64;
}

/* From A's positions to B's in double precision, of pairs k ... of a block. */
INLINE void load_ways_from(const narc_bodies *of_a, const narc_bodies *of_b, const narc_pairs *pairs,
                           const struct pair_indices *in, int k, bool plain, double *x, double *y) {
    const narc_bodies a = *of_a, b = *of_b;
    const narc_float_column shift_x = pairs->shift_x, shift_y = pairs->shift_y;
    UNROLL_FEW
    for (int l = 0; l < V_WIDTH; l++) {
        const size_t number = (uint32_t)in->number[k + l], from = (uint32_t)in->a[k + l], to = (uint32_t)in->b[k + l];
        x[l] = find_way(a.x, b.x, from, to, shift_x, number, plain);
        y[l] = find_way(a.y, b.y, from, to, shift_y, number, plain);
    }
}

INLINE void load_ways(const narc_bodies *a, const narc_bodies *b, const narc_pairs *pairs,
                      const struct pair_indices *in, int k, double x[V_WIDTH], double y[V_WIDTH]) {
    if (LIKELY(are_double(a) && are_double(b) && !pairs->shift_x.base && !pairs->shift_y.base))
        load_ways_from(a, b, pairs, in, k, true, x, y);
    else
        load_ways_from(a, b, pairs, in, k, false, x, y);
}

/* The difference of the bodies' positions, their rotations and scales. */
struct body_pair {
    vec2 difference, rotation_a, rotation_b;
    vf scale_a, scale_b;
};

INLINE void load_double_rows(const struct sources *given, const int32_t *a, const int32_t *b, const vec2 *shift,
                             struct body_pair *out, int32_t *const out_shapes[2]) {
    const struct double_rows rows = {given->a.x.base, given->b.x.base, given->a.x.stride, given->b.x.stride};
    const vf shifts[2] = {shift ? shift->x : v_set(0), shift ? shift->y : v_set(0)};
    vf of_a[4], of_b[4], difference[2];
    v_rows(rows.a + 2 * sizeof(double), rows.stride_a, a, of_a);
    v_rows(rows.b + 2 * sizeof(double), rows.stride_b, b, of_b);
    v_double_differences(&rows, a, b, shift ? shifts : NULL, difference);
    *out = (struct body_pair){{difference[0], difference[1]}, {of_a[0], of_a[1]}, {of_b[0], of_b[1]}, of_a[2], of_b[2]};
    if (out_shapes) {
        vi_store(out_shapes[0], vi_bits(of_a[3]));
        vi_store(out_shapes[1], vi_bits(of_b[3]));
    }
}

INLINE void load_columns(const struct sources *given, const int32_t *a, const int32_t *b, const vec2 *shift,
                         struct body_pair *out) {
    out->difference = load_differences(given, a, b, shift);
    out->rotation_a = (vec2){load_column(given->a.cosine, a), load_column(given->a.sine, a)};
    out->rotation_b = (vec2){load_column(given->b.cosine, b), load_column(given->b.sine, b)};
    out->scale_a = load_column_or(given->a.scale, a, 1);
    out->scale_b = load_column_or(given->b.scale, b, 1);
}

INLINE vec2 load_vec2(const float *x, const float *y, size_t k) { return (vec2){v_load(x + k), v_load(y + k)}; }

/* Bodies k ... of both sets. */
INLINE struct body_pair load_lanes(const narc_bodies *a, const narc_bodies *b, size_t k) {
    return (struct body_pair){v2_sub(load_vec2(b->x.base, b->y.base, k), load_vec2(a->x.base, a->y.base, k)),
                              load_vec2(a->cosine.base, a->sine.base, k), load_vec2(b->cosine.base, b->sine.base, k),
                              v_load(a->scale.base + k), v_load(b->scale.base + k)};
}

/* `shift`: of B, or NULL. `out_shapes`: where those of POSE_DOUBLE_ROWS go, or NULL. */
INLINE struct body_pair load_bodies(const struct sources *given, enum pose_layout layout, const int32_t *a,
                                    const int32_t *b, const vec2 *shift, int32_t *const out_shapes[2]) {
    struct body_pair pair;
    if (LIKELY(layout == POSE_ROWS && !shift)) { /* or compilers keep the vectors of all three in memory */
        vf of_a[4], of_b[4];
        v_rows(given->a.x.base, given->a.x.stride, a, of_a);
        v_rows(given->b.x.base, given->b.x.stride, b, of_b);
        pair = (struct body_pair){{v_sub(of_b[0], of_a[0]), v_sub(of_b[1], of_a[1])},
                                  {of_a[2], of_a[3]},
                                  {of_b[2], of_b[3]},
                                  load_column_or(given->a.scale, a, 1),
                                  load_column_or(given->b.scale, b, 1)};
    } else if (layout == POSE_DOUBLE_ROWS) {
        load_double_rows(given, a, b, shift, &pair, out_shapes);
    } else if (layout == POSE_LANES) {
        pair = load_lanes(&given->a, &given->b, (uint32_t)*a);
    } else {
        load_columns(given, a, b, shift, &pair);
    }
    return pair;
}

/* Bodies in the world, one in each lane. A position is the sum of a float and what that lacks of a double. */
struct placed_bodies {
    vec2 position, rest, rotation;
    vf scale;
};

/* Splits the positions along one axis, less the origin. */
INLINE void split_positions(narc_position_column column, double origin, const int32_t *index, vf *out_high,
                            vf *out_low) {
    float high[V_WIDTH], low[V_WIDTH];
    for (int l = 0; l < V_WIDTH; l++) {
        const double whole = narc_position_at(column, (uint32_t)index[l]) - origin;
        high[l] = (float)whole;
        low[l] = (float)(whole - (double)high[l]);
    }
    *out_high = v_load(high);
    *out_low = v_load(low);
}

/* Positions are less the origin; NULL: as they are. */
INLINE struct placed_bodies load_placed_bodies(const narc_bodies *bodies, enum pose_layout layout,
                                               const narc_point *origin, const int32_t *index) {
    struct placed_bodies out = {.rest = {v_set(0), v_set(0)}};
    vf row[4];
    if (layout == POSE_ROWS && !origin) {
        v_rows(bodies->x.base, bodies->x.stride, index, row);
        out.position = (vec2){row[0], row[1]};
        out.rotation = (vec2){row[2], row[3]};
        out.scale = load_column_or(bodies->scale, index, 1);
        return out;
    }
    if (bodies->x.precision == NARC_FLOAT64 || origin) {
        split_positions(bodies->x, origin ? origin->x : 0, index, &out.position.x, &out.rest.x);
        split_positions(bodies->y, origin ? origin->y : 0, index, &out.position.y, &out.rest.y);
    } else {
        out.position = (vec2){load_column(get_singles(bodies->x), index), load_column(get_singles(bodies->y), index)};
    }
    if (layout == POSE_DOUBLE_ROWS) {
        v_rows(bodies->cosine.base, bodies->cosine.stride, index, row);
        out.rotation = (vec2){row[0], row[1]};
        out.scale = row[2];
        return out;
    }
    out.rotation = (vec2){load_column(bodies->cosine, index), load_column(bodies->sine, index)};
    out.scale = load_column_or(bodies->scale, index, 1);
    return out;
}

/* ------------------------------------------------------------------------------------------------ ranges */

/* In lanes what soa/broken.h says of one body. Here a rotation's length becomes 1 by one step of Newton's method for the
 * inverse root of its square, from 1, which leaves 3/8 of the square's error squared, 1.5 e at most. */
INLINE vf find_square_error(vec2 rotation) { return v_sub(v2_dot(rotation, rotation), v_set(1)); }

INLINE vm is_rotation(vec2 rotation) {
    return v_le(v_abs(find_square_error(rotation)), v_set((float)NARC_ROTATION_TOLERANCE));
}

INLINE vec2 normalise_rotation(vec2 rotation, vm *out_valid) {
    *out_valid = is_rotation(rotation);
    return v2_scale(rotation, v_sub(v_set(1), v_mul(v_set(0.5f), find_square_error(rotation))));
}

INLINE vm is_distance_in_range(vec2 difference) {
    const vf limit = v_set((float)NARC_MAX_DISTANCE);
    return vm_and(v_le(v_abs(difference.x), limit), v_le(v_abs(difference.y), limit));
}

/* The bounding radius has 96 e of the extent in it, so this keeps scaled coordinates below 2e14, too. */
INLINE vm is_size_in_range(vf size) {
    return vm_and(v_le(v_set((float)NARC_MIN_SIZE), size), v_le(size, v_set((float)NARC_MAX_BOUND_RADIUS)));
}

#endif
