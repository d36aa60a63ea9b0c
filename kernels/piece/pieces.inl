/* SPDX-License-Identifier: MIT
 *
 * pieces.inl - the marks of a chain's pieces (store.h), and what of a run can touch.
 */
#ifndef NARC_PIECE_PIECES_INL
#define NARC_PIECE_PIECES_INL

#include "base/shape.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Does a shape have one of these marks? */
INLINE vm has_mark(vi info, unsigned marks) { return vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)(marks << 8)))); }

/* narc_touches() (store.h) in lanes: may a shape touch with this feature, as a contact has it? Of a run only front ones
 * count: arcs 1 to count - 6 and edges 1 to count - 5. */
INLINE vm is_front(vi info, vi feature) {
    _Static_assert(NARC_FEATURE_EDGE == 64, "the shift divides by it");
    const vi number = vi_and(feature, vi_set(NARC_FEATURE_EDGE - 1));
    const vi edge = vi_and(vi_shift_right(feature, 6), vi_set(1));
    const vi end = vi_add(vi_sub(get_arc_count(info), vi_set(5)), edge);
    const vm front = vm_and(vi_lt(vi_set(0), number), vi_lt(number, end));
    return vm_or(vm_not(has_mark(info, NARC_PIECE_RUN)), front);
}

#endif
