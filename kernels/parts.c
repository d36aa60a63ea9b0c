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

/* Poses, one in each lane. */
struct poses {
    vd x, y, cosine, sine, scale;
    vl valid;
};

INLINE vd load_positions(narc_position_column column, const size_t *item) {
    double lane[D_WIDTH];
    for (int l = 0; l < D_WIDTH; l++)
        lane[l] = narc_position_at(column, item[l]);
    return d_load(lane);
}

/* Without a column, `none`. */
INLINE vd load_numbers(narc_float_column column, const size_t *item, double none) {
    double lane[D_WIDTH];
    for (int l = 0; l < D_WIDTH; l++)
        lane[l] = column.base ? (double)narc_float_at(column, item[l]) : none;
    return d_load(lane);
}

INLINE struct poses load_poses(const narc_bodies *bodies, const size_t *item) {
    const vd cosine = load_numbers(bodies->cosine, item, 1), sine = load_numbers(bodies->sine, item, 0);
    const vd square = cosine * cosine + sine * sine, length = d_sqrt(square);
    const vl valid = d_le(d_abs(square - d_set(1)), d_set(NARC_ROTATION_TOLERANCE));
    return (struct poses){load_positions(bodies->x, item),
                          load_positions(bodies->y, item),
                          cosine / length,
                          sine / length,
                          load_numbers(bodies->scale, item, 1),
                          valid};
}

INLINE struct poses place_poses(const struct poses *at, const struct poses *part) {
    const vd c = at->cosine, s = at->sine, scale = at->scale;
    struct poses out = {.x = at->x + scale * (c * part->x - s * part->y),
                        .y = at->y + scale * (s * part->x + c * part->y),
                        .cosine = c * part->cosine - s * part->sine,
                        .sine = s * part->cosine + c * part->sine,
                        .scale = scale * part->scale};
    const vl whole = d_le(d_abs(out.x), d_set(DBL_MAX)) & d_le(d_abs(out.y), d_set(DBL_MAX));
    const vl sized = d_lt(d_set(0), at->scale) & d_le(d_set(FLT_MIN), out.scale) & d_le(out.scale, d_set(FLT_MAX));
    out.valid = at->valid & part->valid & whole & sized;
    return out;
}

INLINE void store_lanes(double *lane, vl valid, vd a) { d_store(lane, d_select(valid, a, d_set(0))); }

/* Parts first .. first + count - 1, a vector at most. The lanes behind the last part repeat the first. */
INLINE void place_parts(const narc_part_batch *batch, size_t first, int count) {
    size_t item[D_WIDTH], owner[D_WIDTH];
    double x[D_WIDTH], y[D_WIDTH], cosine[D_WIDTH], sine[D_WIDTH], scale[D_WIDTH];
    for (int l = 0; l < D_WIDTH; l++) {
        item[l] = first + (size_t)(l < count ? l : 0);
        owner[l] = narc_index_at(batch->owner, item[l]);
    }
    const struct poses at = load_poses(&batch->owners, owner), part = load_poses(&batch->parts, item);
    const struct poses out = place_poses(&at, &part);
    store_lanes(x, out.valid, out.x);
    store_lanes(y, out.valid, out.y);
    store_lanes(cosine, out.valid, out.cosine);
    store_lanes(sine, out.valid, out.sine);
    store_lanes(scale, out.valid, out.scale);
    for (int l = 0; l < count; l++)
        batch->out[item[l]] = (narc_body){
            x[l], y[l], (float)cosine[l], (float)sine[l], (float)scale[l], narc_index_at(batch->parts.shape, item[l])};
}

void NARC_NAMED(parts)(const narc_part_batch *given, size_t first, size_t end) {
    const narc_part_batch batch = *given; /* a copy, which nothing that is written could change */
    for (size_t k = first; k < end; k += D_WIDTH)
        place_parts(&batch, k, end - k < D_WIDTH ? (int)(end - k) : D_WIDTH);
}
