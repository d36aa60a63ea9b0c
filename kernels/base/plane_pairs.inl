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

/* A pair's way from A's position to B's, and the rotation of one of them, not yet of length 1. */
struct plane_pair {
    double x, y, cosine, sine;
};

INLINE struct plane_pair load_plane_pair(const narc_batch *batch, size_t number, size_t body_a, size_t body_b,
                                         bool plane_is_a) {
    const narc_bodies *const a = batch->a, *const b = batch->b, *const of = plane_is_a ? a : b;
    const narc_pairs *const pairs = batch->pairs;
    const size_t plane = plane_is_a ? body_a : body_b;
    return (struct plane_pair){narc_position_at(b->x, body_b) - narc_position_at(a->x, body_a) +
                                   (double)narc_float_or(pairs->shift_x, number, 0),
                               narc_position_at(b->y, body_b) - narc_position_at(a->y, body_a) +
                                   (double)narc_float_or(pairs->shift_y, number, 0),
                               (double)narc_float_at(of->cosine, plane), (double)narc_float_at(of->sine, plane)};
}

/* Points of rows are seen from A's position. Where A is a half-plane, that is as far from where it was laid to as this, in
 * the world. */
INLINE bool find_plane_way(const narc_batch *batch, size_t number, double *out_x, double *out_y) {
    const narc_pairs *const pairs = batch->pairs;
    const size_t a = pairs->a.base ? narc_index_at(pairs->a, number) : number;
    const size_t b = pairs->b.base ? narc_index_at(pairs->b, number) : number;
    if (!narc_is_plane(&batch->shapes->headers[narc_index_at(batch->a->shape, a)]))
        return false;
    const struct plane_pair pair = load_plane_pair(batch, number, a, b, true);
    const double error = pair.cosine * pair.cosine + pair.sine * pair.sine - 1, factor = NARC_INVERSE_LENGTH(error);
    const double cosine = pair.cosine * factor, sine = pair.sine * factor, along = cosine * pair.x + sine * pair.y;
    *out_x = along * cosine;
    *out_y = along * sine;
    return true;
}

INLINE void move_coordinate(float *x, double by) { *x = (float)((double)*x + by); }

#endif
