/* SPDX-License-Identifier: MIT
 *
 * pair.h - calls that have a few items, whose checks are short: pairs are gathered from the caller's columns and asked one
 * by one. Internal.
 */
#ifndef NARC_PAIR_H
#define NARC_PAIR_H

#include <stdbool.h>
#include <stddef.h>

#include "column.h"
#include "kernels.h"
#include "narc_pairs.h"
#include "store.h"

/* The bodies of a pair, moved together so that A is at the origin. */
typedef struct narc_gathered {
    narc_body a, b;
} narc_gathered;

/* Are positions there, of a known type? */
static inline bool narc_has_positions(const narc_position_column *x, const narc_position_column *y) {
    return x->base && y->base && x->precision == y->precision &&
           (x->precision == NARC_FLOAT32 || x->precision == NARC_FLOAT64);
}

/* Has a set all columns, and nothing that this version does not know? */
static inline bool narc_has_columns(const narc_bodies *set) {
    return narc_has_positions(&set->x, &set->y) && set->cosine.base && set->sine.base && set->shape.base &&
           !set->reserved[0] && !set->reserved[1];
}

/* Has a call one ray or point, whose body is there? Else the call's checks say what is wrong. */
static inline bool narc_is_one(const narc_shapes *shapes, const narc_bodies *bodies, size_t count,
                               const narc_index_column *body) {
    const size_t named = body && body->base ? narc_index_at(*body, 0) : 0;
    return count == 1 && narc_has_columns(bodies) && named < bodies->count &&
           narc_index_at(bodies->shape, named) < shapes->count;
}

/* Does a call have a few pairs, whose columns are as most are? Else a batch is begun, which says what is wrong. */
static inline bool narc_are_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs) {
    return shapes && bodies && pairs && pairs->count - 1 < NARC_FEW && !pairs->reserved[0] && !pairs->reserved[1] &&
           narc_has_columns(bodies) &&
           (pairs->other_bodies ? narc_has_columns(pairs->other_bodies) : !pairs->a.base == !pairs->b.base);
}

static inline narc_body narc_gather_body(const narc_bodies *set, size_t k) {
    return (narc_body){0,
                       0,
                       narc_float_at(set->cosine, k),
                       narc_float_at(set->sine, k),
                       narc_float_or(set->scale, k, 1),
                       narc_index_at(set->shape, k)};
}

/* Gathers a pair of bodies of two sets; `own`: pairs bring theirs, both in one set. False if one, or its shape, does not exist.
 * B's place seen from A is as kernels have it (base/bodies.inl), as a difference of floats, rounded from double, is that in
 * single precision. */
static inline bool narc_gather_pair(const narc_shapes *shapes, const narc_bodies *of_a, const narc_bodies *of_b,
                                    const narc_pairs *pairs, bool own, size_t pair, narc_gathered *out) {
    const size_t a = own ? 2 * pair : pairs->a.base ? narc_index_at(pairs->a, pair) : pair;
    const size_t b = own ? 2 * pair + 1 : pairs->b.base ? narc_index_at(pairs->b, pair) : pair;
    if (a >= of_a->count || b >= of_b->count)
        return false;
    out->a = narc_gather_body(of_a, a);
    out->b = narc_gather_body(of_b, b);
    out->b.x = narc_position_at(of_b->x, b) - narc_position_at(of_a->x, a);
    out->b.y = narc_position_at(of_b->y, b) - narc_position_at(of_a->y, a);
    if (pairs->shift_x.base || pairs->shift_y.base) {
        out->b.x += (double)narc_float_or(pairs->shift_x, pair, 0);
        out->b.y += (double)narc_float_or(pairs->shift_y, pair, 0);
    }
    return out->a.shape < shapes->count && out->b.shape < shapes->count;
}

#endif
