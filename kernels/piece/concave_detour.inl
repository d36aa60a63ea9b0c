/* SPDX-License-Identifier: MIT
 *
 * concave_detour.inl - the way of pairs with a concave arc, beside that of all others (pipeline.inl): a queue, which
 * concave.inl answers.
 */
#ifndef NARC_PIECE_CONCAVE_DETOUR_INL
#define NARC_PIECE_CONCAVE_DETOUR_INL

#include <string.h>

#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

INLINE vm has_concave(const vf item[FIELDS]) {
    return vm_or(has_mark(get_item_bits(item, INFO_A), NARC_PIECE_CONCAVE),
                 has_mark(get_item_bits(item, INFO_B), NARC_PIECE_CONCAVE));
}

/* Takes the pairs with a concave arc of those in the lanes `valid`, and returns the others of `near`. What is apart by
 * its circles has no contact with a separation below 0, whatever the margin: a body may then be deep under the arc, but
 * not on it. So negative margins count as 0 here, and where circles are apart SLACK tells so. */
INLINE vm take_concave(const struct call *call, vm valid, vm near, const struct filter *circles,
                       const vf item[FIELDS]) {
    const vm concave = vm_and(valid, has_concave(item));
    if (!vm_any(concave))
        return near;
    const vf zero = v_set(0), reach = v_add(circles->size, v_max(circles->margin, zero));
    const vm apart = v_lt(v_mul(reach, reach), circles->square);
    const vm beside = v_lt(v_mul(circles->size, circles->size), circles->square);
    const vm waits = vm_and_not(concave, apart);
    vf own[FIELDS];
    memcpy(own, item, sizeof own);
    own[SLACK] = v_select(beside, v_set(1), zero);
    own[CORE] = circles->size; /* it, and what joins the circles, for find_window() */
    set_vec2(own, AXIS, circles->between);
    push(call->concave, waits, own, ROW_FIELDS);
    if (call->concave->count >= FLUSH)
        NARC_NAMED(search).concave(call);
    return vm_and_not(near, concave);
}

#endif
