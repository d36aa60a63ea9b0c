/* SPDX-License-Identifier: MIT
 *
 * pipeline.inl - what all kernels do with the pairs of a call: block by block through one stage after another.
 *
 * A pair is set up, and its circles are compared. A triage then answers it or puts it into the queue of the first
 * stage, or of a later one (enter()). Each stage answers pairs of its queue, or passes them on to the next one. The
 * first stage takes all pairs of a block. The others, which few pairs reach, wait for FLUSH of them, so that vectors
 * are full; after the last block they take what is left.
 */
#ifndef NARC_BASE_PIPELINE_INL
#define NARC_BASE_PIPELINE_INL

#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/contact_rows.inl"
#include "base/pair_setup.inl"
#include "base/queue.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Answers what it can of a vector of pairs, the first of which has the number `pair`, and returns the other lanes. */
typedef vm triage(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]);

/* Answers the pairs `begin` ... of a queue, or pushes them to the next stage's. */
typedef void stage(const struct call *call, struct queue *queue, int begin, struct queue *next);

/* Triage for methods that treat all pairs alike. */
INLINE vm take_valid(const struct call *call, size_t pair, const struct filter *circles, const vf item[FIELDS]) {
    (void)pair;
    if (call->rows)
        store_no_contact(call, vi_bits(item[PAIR]), circles->invalid);
    return circles->valid;
}

/* Pairs after which the first stage is tried anew with pairs that have edges: later ones may lie otherwise. */
enum { REMEMBERED = 16 * BLOCK };

/* Appends the lanes `open` of `item` to the first stage's queue. Where that one can't answer most of the pairs that have
 * edges, as among bodies that rest on each other, these go to the stage that can. */
INLINE void enter(struct queue *queues, vm open, const vf item[FIELDS], int fields, int edged_stage) {
    vm here = open;
    if (edged_stage > 0 && 4 * queues->edged_left > 3 * queues->edged) {
        const vm edged = vm_and_not(open, both_have(item, NARC_SHAPE_SMOOTH));
        here = vm_and_not(open, edged);
        if (vm_any(edged))
            push(&queues[edged_stage], edged, item, fields);
    }
    if (vm_any(here))
        push(queues, here, item, fields);
}

INLINE void run_stages(const struct call *call, stage *const *stages, int stage_count, struct queue *queues, bool end) {
    for (int s = 0; s < stage_count; s++) {
        struct queue *queue = &queues[s];
        const bool all = end || s == 0;
        const int begin = all ? 0 : queue->count % V_WIDTH;
        if (queue->count == 0 || (!all && queue->count < FLUSH))
            continue;
        if (queue->count % V_WIDTH != 0 && all)
            pad(queue);
        stages[s](call, queue, begin, queue + 1);
        queue->count = begin;
    }
}

/* Runs all pairs of a call. `queues`: one for each stage. `edged_stage`: where pairs with edges may begin instead of at
 * the first stage, or 0. */
INLINE void run_pairs(const struct call *call, triage *settle, int fields, stage *const *stages, int stage_count,
                      int edged_stage, struct queue *queues) {
    const narc_batch *batch = call->batch;
    const enum pose_layout layout = find_pose_layout(batch->bodies);
    struct pair_indices indices;
    for (int s = 0; s < stage_count; s++)
        queues[s].count = 0;
    for (size_t block = 0; block < call->count; block += BLOCK) {
        const int n = (int)(call->count - block < BLOCK ? call->count - block : BLOCK);
        load_indices(batch, call->first + block, n, &indices);
        if (edged_stage > 0 && block % REMEMBERED == 0)
            queues->edged = queues->edged_left = 0;
        for (int k = 0; k < n; k += V_WIDTH) {
            vf item[FIELDS];
            const struct filter circles = set_up_pairs(call, &indices, k, n, layout, (int32_t)(uint32_t)block, item);
            if (batch->skipped)
                *batch->skipped += (size_t)__builtin_popcount(vm_bits(circles.invalid));
            const vm open = settle(call, block + (size_t)k, &circles, item);
            if (stage_count > 0 && vm_any(open))
                enter(queues, open, item, fields, edged_stage);
        }
        run_stages(call, stages, stage_count, queues, false);
    }
    run_stages(call, stages, stage_count, queues, true);
}

static inline struct call begin_overlaps(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    memset(out_bits, 0, (count + 63) / 64 * sizeof *out_bits);
    return (struct call){.batch = batch, .first = first, .count = count, .bits = out_bits};
}

static inline struct call begin_contacts(const narc_batch *batch, size_t first, size_t count, float margin,
                                         struct contact_rows *rows) {
    rows->hinted = false;
    rows->done = rows->listed = 0;
    /* NOT_LISTED is 0. Lists are read by whole vectors. */
    memset(rows->keep, 0, (count + V_WIDTH - 1) / V_WIDTH * V_WIDTH * sizeof *rows->keep);
    return (struct call){.batch = batch,
                         .first = first,
                         .count = count,
                         .margin = margin,
                         .margins = batch->pairs->margin,
                         .rows = rows};
}

/* The kernels of a method with one stage. */
INLINE void run_overlap_method(stage *find, const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits) {
    struct queue queue;
    const struct call call = begin_overlaps(batch, first, count, out_bits);
    run_pairs(&call, take_valid, FIELDS, &find, 1, 0, &queue);
}

INLINE size_t run_contact_method(stage *find, const narc_batch *batch, size_t first, size_t count, float margin,
                                 const narc_contacts *out) {
    struct queue queue;
    struct contact_rows rows;
    const struct call call = begin_contacts(batch, first, count, margin, &rows);
    run_pairs(&call, take_valid, FIELDS, &find, 1, 0, &queue);
    return list_contacts(&call, out);
}

#endif
