/* SPDX-License-Identifier: MIT
 *
 * box_detour.inl - the way of pairs of two boxes, of two capsules, and of a circle and any of the three, beside that of all
 * others (pipeline.inl): a queue for each of these kinds, of which a few vectors are answered at a time.
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
#include "box/circles.inl"
#include "box/plane_forms.inl"
#include "kernels.h"
#include "simd/simd.h"

/* `answers`: of each queue. */
INLINE void start_boxes(struct call *call, struct box_queue queues[BOX_QUEUES], box_stage *const answers[BOX_QUEUES]) {
    for (int kind = 0; kind < BOX_QUEUES; kind++) {
        queues[kind].count = 0;
        queues[kind].answer = answers[kind];
    }
    call->boxes = queues;
}

INLINE bool boxes_wait(const struct call *call) {
    const struct box_queue *const queues = call->boxes;
    return queues && (queues[OF_BOXES].count | queues[OF_CAPSULES].count | queues[WITH_CIRCLE].count) > 0;
}

/* Takes pairs of two shapes that have forms, of those in the lanes `open`. */
INLINE vm take_forms(const struct call *call, const struct pair_indices *indices, int k,
                     const struct placement *placement, vm open, int32_t number) {
    const narc_box_form *forms = call->batch->shapes->boxes;
    const struct box_form a = load_box_forms(forms, indices->shape_a + k);
    const struct box_form b = load_box_forms(forms, indices->shape_b + k);
    const vm in_range = vm_and(open, placement->in_range), two_boxes = vm_and(in_range, are_forms(&a, &b, NARC_IS_BOX));
    vm left = open;
    if (vm_any(two_boxes))
        left = vm_and_not(left, take_boxes(call, &a, &b, placement, two_boxes, number, &call->boxes[OF_BOXES]));
    if (vm_any(left)) {
        const vm two_capsules = vm_and(in_range, are_forms(&a, &b, NARC_IS_CAPSULE));
        const vm with_circle = vm_and(in_range, are_with_circle(&a, &b));
        if (vm_any(two_capsules))
            left = vm_and_not(left,
                              take_capsules(call, &a, &b, placement, two_capsules, number, &call->boxes[OF_CAPSULES]));
        if (NARC_CIRCLE_FORMS && vm_any(with_circle))
            left =
                vm_and_not(left, take_circles(call, &a, &b, placement, with_circle, number, &call->boxes[WITH_CIRCLE]));
    }
    return left;
}

INLINE void run_full_boxes(const struct call *call) {
    const struct box_queue *const queues = call->boxes;
    _Static_assert((BOX_FLUSH & (BOX_FLUSH - 1)) == 0, "where one has reached it, the union of their bits has");
    if ((queues[OF_BOXES].count | queues[OF_CAPSULES].count | queues[WITH_CIRCLE].count) >= BOX_FLUSH)
        for (int kind = 0; kind < BOX_QUEUES; kind++)
            if (queues[kind].count >= BOX_FLUSH)
                run_boxes(call, &call->boxes[kind], false);
}

/* The same, and those of a half-plane and such a shape; answers them a few vectors at a time. Returns the other lanes.
 * `number`: of the first pair. */
INLINE vm take_detour(const struct call *call, const struct pair_indices *indices, int k,
                      const struct placement *placement, vm open, int32_t number) {
    const struct box_queue *const boxes = &call->boxes[OF_BOXES], *const capsules = &call->boxes[OF_CAPSULES],
                                  *const circles = &call->boxes[WITH_CIRCLE];
    vm left = open;
    if (NARC_PIECES && NARC_CIRCLE_FORMS && !LIKELY(!call->planes)) {
        const struct placement copy = *placement; /* so that the other one stays in registers */
        left = vm_and_not(open, take_planes(call, indices, k, &copy, vm_and(open, placement->in_range), number));
        if (vm_any(left) && vm_any(vm_and_not(open, left))) { /* the other lanes come behind, out of order */
            if (call->rows)
                call->rows->done = -1;
            run_full_boxes(call);
        }
    }
    if (vm_any(left))
        left = take_forms(call, indices, k, placement, left, number);
    const bool with_boxes = boxes->count > 0 && (capsules->count | circles->count) > 0;
    if (call->rows && (with_boxes || (capsules->count > 0 && circles->count > 0)))
        call->rows->done = -1; /* two queues are not in the order of their pairs */
    else if (call->rows && !vm_any(left) && !call->rows->dense && call->rows->done == number)
        call->rows->done += V_WIDTH;
    run_full_boxes(call);
    return left;
}

/* Answers all that wait. */
INLINE void end_boxes(const struct call *call) {
    for (int kind = 0; kind < BOX_QUEUES; kind++)
        run_boxes(call, &call->boxes[kind], true);
}

#endif
