/* SPDX-License-Identifier: MIT
 *
 * box_detour.inl - the way of pairs of two boxes or two capsules, beside that of all others (pipeline.inl): a queue for
 * each of the two kinds, of which a few vectors are answered at a time.
 */
#ifndef NARC_BOX_BOX_DETOUR_INL
#define NARC_BOX_BOX_DETOUR_INL

#include <stdbool.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/rows.inl"
#include "box/box_pairs.inl"
#include "box/capsules.inl"
#include "kernels.h"
#include "simd/simd.h"

INLINE void start_boxes(struct call *call, struct box_queue queues[BOX_QUEUES], box_stage *boxes, box_stage *capsules) {
    queues[OF_BOXES].count = queues[OF_CAPSULES].count = 0;
    queues[OF_BOXES].answer = boxes;
    queues[OF_CAPSULES].answer = capsules;
    call->boxes = queues;
}

INLINE bool boxes_wait(const struct call *call) {
    return call->boxes && (call->boxes[OF_BOXES].count > 0 || call->boxes[OF_CAPSULES].count > 0);
}

/* Takes pairs of boxes or capsules, of those in the lanes `open`, and answers them a few vectors at a time. Returns the
 * other lanes. `number`: of the first pair. */
INLINE vm take_detour(const struct call *call, const struct pair_indices *indices, int k,
                      const struct placement *placement, vm open, int32_t number) {
    const narc_box_form *forms = call->batch->shapes->boxes;
    struct box_queue *const boxes = &call->boxes[OF_BOXES], *const capsules = &call->boxes[OF_CAPSULES];
    const struct box_form a = load_box_forms(forms, indices->shape_a + k);
    const struct box_form b = load_box_forms(forms, indices->shape_b + k);
    const vm in_range = vm_and(open, placement->in_range), two_boxes = vm_and(in_range, are_forms(&a, &b, NARC_IS_BOX));
    vm left = open;
    if (vm_any(two_boxes))
        left = vm_and_not(left, take_boxes(call, &a, &b, placement, two_boxes, number, boxes));
    if (vm_any(left)) {
        const vm two_capsules = vm_and(in_range, are_forms(&a, &b, NARC_IS_CAPSULE));
        if (vm_any(two_capsules))
            left = vm_and_not(left, take_capsules(call, &a, &b, placement, two_capsules, number, capsules));
    }
    if (call->rows && boxes->count > 0 && capsules->count > 0)
        call->rows->done = -1; /* two queues are not in the order of their pairs */
    else if (call->rows && !vm_any(left) && !call->rows->dense && call->rows->done == number)
        call->rows->done += V_WIDTH;
    if (boxes->count >= BOX_FLUSH)
        run_boxes(call, boxes, false);
    if (capsules->count >= BOX_FLUSH)
        run_boxes(call, capsules, false);
    return left;
}

/* Answers all that wait. */
INLINE void end_boxes(const struct call *call) {
    for (int kind = 0; kind < BOX_QUEUES; kind++)
        run_boxes(call, &call->boxes[kind], true);
}

#endif
