/* SPDX-License-Identifier: MIT
 *
 * outcomes.inl - how a method came to a pair's answer.
 */
#ifndef NARC_METHODS_OUTCOMES_INL
#define NARC_METHODS_OUTCOMES_INL

#include <stdint.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "methods/method_kernels.h"
#include "simd/simd.h"

/* Notes the outcome of the pairs k ... of a queue in the lanes `which`. */
INLINE void note_outcome(const struct call *call, const struct queue *queue, int k, vm which, narc_outcome outcome) {
    int32_t pair[V_WIDTH];
    uint8_t *const outcomes = narc_call_of(call->batch)->outcomes;
    if (!outcomes || !vm_any(which))
        return;
    get_pairs(queue, k, pair);
    for (uint32_t lanes = vm_bits(which); lanes; lanes &= lanes - 1)
        outcomes[find_number(call, pair[FIND_LOWEST(lanes)])] = (uint8_t)outcome;
}

#endif
