/* SPDX-License-Identifier: MIT
 *
 * parts.c - the kernel of parts: their poses in the world, from those of the bodies that they are of.
 *
 * All is computed in double precision, rotations of length 1 but for its rounding: parts that share an edge share it
 * wherever their body is, as far as the rounded rotations of either let them.
 */
#include <float.h>
#include <math.h>

#include "column.h"
#include "kernels.h"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Poses of a block of parts. They are gathered whole before any is computed: a vector that is loaded from lanes just
 * stored waits for all of them. */
enum { BLOCK = 64 };
struct poses {
    double x[BLOCK], y[BLOCK], cosine[BLOCK], sine[BLOCK], scale[BLOCK];
};

INLINE void load_positions(narc_position_column column, const uint32_t *item, int count, double *out) {
    for (int k = 0; k < count; k++)
        out[k] = narc_position_at(column, item[k]);
}

/* Without a column, `none`. */
INLINE void load_numbers(narc_float_column column, const uint32_t *item, int count, float none, double *out) {
    const narc_float_column from = column.base ? column : (narc_float_column){&none, 0};
    for (int k = 0; k < count; k++)
        out[k] = (double)narc_float_at(from, item[k]);
}

INLINE void load_poses(const narc_bodies *bodies, const uint32_t *item, int count, struct poses *out) {
    load_positions(bodies->x, item, count, out->x);
    load_positions(bodies->y, item, count, out->y);
    load_numbers(bodies->cosine, item, count, 1, out->cosine);
    load_numbers(bodies->sine, item, count, 0, out->sine);
    load_numbers(bodies->scale, item, count, 1, out->scale);
}

/* Is that a rotation? Makes its length 1. */
INLINE vl normalise(vd *cosine, vd *sine) {
    const vd square = *cosine * *cosine + *sine * *sine, inverse = d_set(1) / d_sqrt(square);
    *cosine *= inverse;
    *sine *= inverse;
    return d_le(d_set(1 - NARC_ROTATION_TOLERANCE), square) & d_le(square, d_set(1 + NARC_ROTATION_TOLERANCE));
}

INLINE void store_lanes(double *lane, vl valid, vd a) { d_store(lane, d_select(valid, a, d_set(0))); }

/* A vector of a block's parts, from number k on, in the place of their poses in their owners. */
INLINE void place_lanes(const struct poses *owners, int k, struct poses *parts) {
    vd c = d_load(owners->cosine + k), s = d_load(owners->sine + k), cosine = d_load(parts->cosine + k),
       sine = d_load(parts->sine + k);
    const vl turned = normalise(&c, &s) & normalise(&cosine, &sine);
    const vd at_scale = d_load(owners->scale + k), scale = at_scale * d_load(parts->scale + k);
    const vd part_x = d_load(parts->x + k), part_y = d_load(parts->y + k);
    const vd x = d_load(owners->x + k) + at_scale * (c * part_x - s * part_y);
    const vd y = d_load(owners->y + k) + at_scale * (s * part_x + c * part_y);
    const vl placed = d_le(d_abs(x), d_set(DBL_MAX)) & d_le(d_abs(y), d_set(DBL_MAX));
    const vl sized = d_lt(d_set(0), at_scale) & d_le(d_set(FLT_MIN), scale) & d_le(scale, d_set(FLT_MAX));
    const vl valid = turned & placed & sized;
    store_lanes(parts->x + k, valid, x);
    store_lanes(parts->y + k, valid, y);
    store_lanes(parts->cosine + k, valid, c * cosine - s * sine);
    store_lanes(parts->sine + k, valid, s * cosine + c * sine);
    store_lanes(parts->scale + k, valid, scale);
}

/* Parts first .. first + count - 1, a block at most. The lanes behind the last part repeat the first. */
static void place_block(const narc_part_batch *batch, size_t first, int count) {
    struct poses owners, parts;
    uint32_t item[BLOCK], owner[BLOCK];
    int k = 0;
    for (; k < count || k % D_WIDTH != 0; k++) {
        item[k] = (uint32_t)first + (uint32_t)(k < count ? k : 0);
        owner[k] = narc_index_at(batch->owner, item[k]);
    }
    load_poses(&batch->owners, owner, k, &owners);
    load_poses(&batch->parts, item, k, &parts);
    for (k = 0; k < count; k += D_WIDTH)
        place_lanes(&owners, k, &parts);
    for (k = 0; k < count; k++)
        batch->out[first + (size_t)k] = (narc_body){parts.x[k],
                                                    parts.y[k],
                                                    (float)parts.cosine[k],
                                                    (float)parts.sine[k],
                                                    (float)parts.scale[k],
                                                    narc_index_at(batch->parts.shape, first + (size_t)k)};
}

void NARC_NAMED(parts)(const narc_part_batch *given, size_t first, size_t end) {
    const narc_part_batch batch = *given; /* a copy, which nothing that is written could change */
    for (size_t k = first; k < end; k += BLOCK)
        place_block(&batch, k, end - k < BLOCK ? (int)(end - k) : BLOCK);
}
