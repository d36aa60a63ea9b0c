/* SPDX-License-Identifier: MIT
 *
 * run.inl - the kernels of a method with one stage, and how it writes contacts.
 */
#ifndef NARC_METHODS_RUN_INL
#define NARC_METHODS_RUN_INL

#include <stddef.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pipeline.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Writes the contacts of the pairs k ... of a queue in the lanes `keep`. */
INLINE void store_contacts(const struct call *call, const struct queue *queue, int k, vm keep, vf separation, vec2 n,
                           const struct feature *on_a, const struct feature *on_b) {
    const struct answer answer = find_answer(queue, k, separation, n, on_a, on_b, true);
    const vi pairs = get_bits(queue, PAIR, k);
    char *place[V_WIDTH];
    find_places(call, pairs, keep, place);
    write_contacts(place, find_numbers(call, pairs), &answer);
}

/* Compiled once for all. */
NOINLINE void run_method(const struct call *call, stage *find) {
    const struct course course = {.settle = take_valid, .fields = QUEUE_FIELDS, .stages = &find, .end = STAGES};
    struct queue queue;
    run_pairs(call, &course, &queue);
}

static void run_overlap_method(stage *find, const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                               uint64_t *out_bits) {
    const struct call call = begin_overlaps(batch, first, count, skipped, out_bits);
    run_method(&call, find);
}

static size_t run_contact_method(stage *find, const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                                 const narc_rows *out) {
    static const struct question contacts = {.none = write_no_contact};
    struct rows rows;
    const struct call call = begin_rows(&contacts, batch, first, count, skipped, out, &rows);
    run_method(&call, find);
    return end_rows(&call, sizeof(narc_contact));
}

/* Of a method whose triage answers all pairs. */
INLINE void run_filter(triage *settle, const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                       uint64_t *out_bits) {
    const struct call call = begin_overlaps(batch, first, count, skipped, out_bits);
    const struct course course = {.settle = settle};
    run_pairs(&call, &course, NULL);
}

#endif
