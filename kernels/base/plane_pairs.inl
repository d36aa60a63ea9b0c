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

#include "base/bodies.inl"
#include "broken.h"
#include "column.h"
#include "kernels.h"
#include "simd/simd.h"
#include "store.h"

/* Points of rows are seen from A's position. Where A is a half-plane, that is as far from where it was laid to as this, in
 * the world. */
INLINE bool find_plane_way(const narc_batch *batch, size_t number, double *out_x, double *out_y) {
    const narc_pairs *const pairs = batch->pairs;
    const size_t a = pairs->a.base ? narc_index_at(pairs->a, number) : number;
    const size_t b = pairs->b.base ? narc_index_at(pairs->b, number) : number;
    if (!narc_is_plane(&batch->shapes->headers[narc_index_at(batch->a->shape, a)]))
        return false;
    const double x = find_way(batch->a->x, batch->b->x, a, b, pairs->shift_x, number, false);
    const double y = find_way(batch->a->y, batch->b->y, a, b, pairs->shift_y, number, false);
    const double c = (double)narc_float_at(batch->a->cosine, a), s = (double)narc_float_at(batch->a->sine, a);
    const double error = c * c + s * s - 1, factor = NARC_INVERSE_LENGTH(error);
    const double cosine = c * factor, sine = s * factor, along = cosine * x + sine * y;
    *out_x = along * cosine;
    *out_y = along * sine;
    return true;
}

INLINE void move_coordinate(float *x, double by) { *x = (float)((double)*x + by); }

#endif
