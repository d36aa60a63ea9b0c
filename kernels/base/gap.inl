/* SPDX-License-Identifier: MIT
 *
 * gap.inl - the gap between two bodies along a direction, as searches find it.
 */
#ifndef NARC_BASE_GAP_INL
#define NARC_BASE_GAP_INL

#include "base/vec2.inl"
#include "simd/simd.h"

/* The least normal float: a smaller square has lost its digits. */
#define LEAST_SQUARE 0x1p-126f

/* The largest gap that a search has found in each lane, with its direction and arcs. */
struct gap {
    vf separation;
    vec2 normal; /* not yet divided by its length */
    vf length;
    vi record_a, record_b;
};

INLINE struct gap select_gap(vm m, const struct gap *a, const struct gap *b) {
    return (struct gap){v_select(m, a->separation, b->separation), v2_select(m, a->normal, b->normal),
                        v_select(m, a->length, b->length), vi_select(m, a->record_a, b->record_a),
                        vi_select(m, a->record_b, b->record_b)};
}

#endif
