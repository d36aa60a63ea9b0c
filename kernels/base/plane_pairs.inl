/* SPDX-License-Identifier: MIT
 *
 * plane_pairs.inl - one pair with a half-plane, in double precision: its way, and the points of its row.
 */
#ifndef NARC_BASE_PLANE_PAIRS_INL
#define NARC_BASE_PLANE_PAIRS_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "broken.h"
#include "column.h"
#include "kernels.h"
#include "simd/simd.h"
#include "store.h"

/* A pair's way from A's position to B's, and the rotations, in double precision. */
struct plane_pair {
    double x, y;
    double cosine[2], sine[2];
};

INLINE void load_plane_pair(const narc_bodies *a, const narc_bodies *b, const narc_pairs *pairs, size_t number,
                            size_t body_a, size_t body_b, struct plane_pair *out) {
    const narc_bodies *const set[2] = {a, b};
    const size_t body[2] = {body_a, body_b};
    out->x = narc_position_at(b->x, body_b) - narc_position_at(a->x, body_a) +
             (double)narc_float_or(pairs->shift_x, number, 0);
    out->y = narc_position_at(b->y, body_b) - narc_position_at(a->y, body_a) +
             (double)narc_float_or(pairs->shift_y, number, 0);
    for (int side = 0; side < 2; side++) {
        const double c = (double)narc_float_at(set[side]->cosine, body[side]);
        const double s = (double)narc_float_at(set[side]->sine, body[side]);
        const double error = c * c + s * s - 1, factor = NARC_INVERSE_LENGTH(error);
        out->cosine[side] = c * factor;
        out->sine[side] = s * factor;
    }
}

/* Points of rows are seen from A's position. Where A is a half-plane, that is as far from where it was laid to as this, in
 * the world. */
INLINE bool find_plane_way(const narc_batch *batch, size_t number, double *out_x, double *out_y) {
    const narc_pairs *const pairs = batch->pairs;
    const size_t a = pairs->a.base ? narc_index_at(pairs->a, number) : number;
    const size_t b = pairs->b.base ? narc_index_at(pairs->b, number) : number;
    struct plane_pair pair;
    if (!narc_is_plane(&batch->shapes->headers[narc_index_at(batch->a->shape, a)]))
        return false;
    load_plane_pair(batch->a, batch->b, pairs, number, a, b, &pair);
    const double along = pair.cosine[0] * pair.x + pair.sine[0] * pair.y;
    *out_x = along * pair.cosine[0];
    *out_y = along * pair.sine[0];
    return true;
}

INLINE void move_coordinate(float *x, double by) { *x = (float)((double)*x + by); }

#endif
