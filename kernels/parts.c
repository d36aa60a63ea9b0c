/* SPDX-License-Identifier: MIT
 *
 * parts.c - the kernel of parts: their poses in the world, from those of the bodies that they are of.
 *
 * All is computed in double precision, rotations of length 1 but for its rounding: parts that share an edge share it
 * wherever their body is, as far as the rounded rotations of either let them. A part that is not turned in its body has
 * the body's rotation, to the bit.
 */
#include <float.h>
#include <math.h>

#include "base/bodies.inl"
#include "broken.h"
#include "column.h"
#include "kernels.h"
#include "simd/doubles.h"
#include "simd/simd.h"

/* Poses of a block of parts. They are gathered whole before any is computed: a vector that is loaded from lanes just
 * stored waits for all of them. */
enum { PARTS = 64 };
struct poses {
    double x[PARTS], y[PARTS];
    float cosine[PARTS], sine[PARTS], scale[PARTS];
    float is_fine[PARTS]; /* 1: its rotation is one; 0 */
};

INLINE void load_positions(narc_position_column column, const uint32_t *item, int count, double *out) {
    for (int k = 0; k < count; k++)
        out[k] = narc_position_at(column, item[k]);
}

/* Without a column, `none`. */
INLINE void load_numbers(narc_float_column column, const uint32_t *item, int count, float none, float *out) {
    const narc_float_column from = column.base ? column : (narc_float_column){&none, 0};
    for (int k = 0; k < count; k++)
        out[k] = narc_float_at(from, item[k]);
}

INLINE void load_poses(const narc_bodies *bodies, const uint32_t *item, int count, struct poses *out) {
    load_positions(bodies->x, item, count, out->x);
    load_positions(bodies->y, item, count, out->y);
    load_numbers(bodies->cosine, item, count, 1, out->cosine);
    load_numbers(bodies->sine, item, count, 0, out->sine);
    load_numbers(bodies->scale, item, count, 1, out->scale);
    for (int k = 0; k < count; k += V_WIDTH) {
        const vm fine = is_rotation((vec2){v_load(out->cosine + k), v_load(out->sine + k)});
        v_store(out->is_fine + k, v_select(fine, v_set(1), v_set(0)));
    }
}

/* Makes a rotation's length 1. */
INLINE void normalise(vd *cosine, vd *sine) {
    const vd error = *cosine * *cosine + *sine * *sine - d_set(1), factor = NARC_INVERSE_LENGTH(error);
    *cosine *= factor;
    *sine *= factor;
}

INLINE void store_lanes(double *lane, vl valid, vd a) { d_store(lane, d_select(valid, a, d_set(0))); }
INLINE void put_lanes(float *lane, vl valid, vd a) { d_put_floats(lane, d_select(valid, a, d_set(0))); }

/* A vector of a block's parts, from number k on, in the place of their poses in their owners. */
INLINE void place_lanes(const struct poses *owners, int k, struct poses *parts) {
    const vd zero = d_set(0), own_c = d_of_floats(owners->cosine + k), own_s = d_of_floats(owners->sine + k);
    vd c = own_c, s = own_s, cosine = d_of_floats(parts->cosine + k), sine = d_of_floats(parts->sine + k);
    const vl unturned = d_le(d_abs(sine), zero) & d_lt(zero, cosine);
    normalise(&c, &s);
    normalise(&cosine, &sine);
    const vd at_scale = d_of_floats(owners->scale + k), scale = at_scale * d_of_floats(parts->scale + k);
    const vd part_x = d_load(parts->x + k), part_y = d_load(parts->y + k);
    const vd x = d_load(owners->x + k) + at_scale * (c * part_x - s * part_y);
    const vd y = d_load(owners->y + k) + at_scale * (s * part_x + c * part_y);
    const vl placed = d_le(d_abs(x), d_set(DBL_MAX)) & d_le(d_abs(y), d_set(DBL_MAX));
    const vl turned = d_lt(zero, d_of_floats(owners->is_fine + k) * d_of_floats(parts->is_fine + k));
    const vl sized = d_lt(zero, at_scale) & d_le(d_set(FLT_MIN), scale) & d_le(scale, d_set(FLT_MAX));
    const vl valid = turned & placed & sized;
    store_lanes(parts->x + k, valid, x);
    store_lanes(parts->y + k, valid, y);
    put_lanes(parts->cosine + k, valid, d_select(unturned, own_c, c * cosine - s * sine));
    put_lanes(parts->sine + k, valid, d_select(unturned, own_s, s * cosine + c * sine));
    put_lanes(parts->scale + k, valid, scale);
}

/* Parts first .. first + count - 1, a block at most. The lanes behind the last part repeat the first. */
static void place_block(const narc_part_batch *batch, size_t first, int count) {
    struct poses owners, parts;
    uint32_t item[PARTS], owner[PARTS];
    int k = 0;
    for (; k < count || k % V_WIDTH != 0; k++) {
        item[k] = (uint32_t)first + (uint32_t)(k < count ? k : 0);
        owner[k] = narc_index_at(batch->owner, item[k]);
    }
    load_poses(&batch->owners, owner, k, &owners);
    load_poses(&batch->parts, item, k, &parts);
    for (k = 0; k < count; k += D_WIDTH)
        place_lanes(&owners, k, &parts);
    for (k = 0; k < count; k++)
        batch->out[first + (size_t)k] =
            (narc_body){parts.x[k],    parts.y[k],     parts.cosine[k],
                        parts.sine[k], parts.scale[k], narc_index_at(batch->parts.shape, first + (size_t)k)};
}

void NARC_NAMED(parts)(const narc_part_batch *given, size_t first, size_t end) {
    const narc_part_batch batch = *given; /* a copy, which nothing that is written could change */
    for (size_t k = first; k < end; k += PARTS)
        place_block(&batch, k, end - k < PARTS ? (int)(end - k) : PARTS);
}
