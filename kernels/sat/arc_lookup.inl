/* SPDX-License-Identifier: MIT
 *
 * arc_lookup.inl - the arcs that hold a direction.
 *
 * All directions n point from A to B in A's frame; A is asked for n and B for -n.
 */
#ifndef NARC_SAT_ARC_LOOKUP_INL
#define NARC_SAT_ARC_LOOKUP_INL

#include <stdint.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* Counts half the angles of a record that are below `angle`, which both halves of a lane hold. */
INLINE vi count_below(vi count, const int16_t *angles, const int32_t *record, vi angle) {
    vf four[4];
    v_rows(angles, sizeof(narc_record), record, four);
    for (int k = 0; k < 4; k++)
        count = vi_count16(count, angle, vi_bits(four[k]));
    return count;
}

/* How many junctions of its shape come before a direction, in each lane: up to the 16 bits of the angles. */
INLINE vi count_junctions(const narc_record *records, vi record, vi count, vi angle) {
    vi twice = vi_add(vi_and(angle, vi_set(0xffff)), vi_shift_left(angle, 16)), before = vi_set(0);
    for (int done = 0;; done += NARC_RECORD_ANGLES) {
        int32_t index[V_WIDTH];
        vi_store(index, record);
        before = count_below(before, records->angles, index, twice);
        if (vm_any(vi_lt(vi_set(done + NARC_RECORD_ANGLES / 2), count)))
            before = count_below(before, &records->angles[NARC_RECORD_ANGLES / 2], index, twice);
        const vm more = vi_lt(vi_set(done + NARC_RECORD_ANGLES), count);
        if (!vm_any(more))
            break;
        record = vi_add(record, vi_select(more, vi_set(1), vi_set(0)));
        twice = vi_select(more, twice, vi_set((int32_t)0x80008000u)); /* nothing is below that */
    }
    return vi_add(vi_and(before, vi_set(0xffff)), vi_shift_right(before, 16));
}

/* The record of the arc that holds a direction, in each lane. */
INLINE vi find_arc(const narc_record *records, vi first_record, vi info, vec2 direction) {
    const vf scaled = v_mul(find_diamond_angle(direction), v_set(NARC_ANGLE_SCALE));
    const vi angle = vi_truncate(v_sub(scaled, v_set(NARC_ANGLE_OFFSET))), count = get_arc_count(info);
#ifdef V_COUNT_EIGHT /* angles follow each other from record to record; integers stay out of vectors */
    int32_t first, all, below = 0, done = 0;
    vi_store(&first, first_record);
    vi_store(&all, count);
    do
        below += V_COUNT_EIGHT(records[(uint32_t)first].angles + done, angle);
    while ((done += 8) < all);
    return vi_set(first + (int32_t)narc_angle_records((size_t)all) + (below > 0 ? below : all) - 1);
#else
    const vi before = count_junctions(records, first_record, count, angle);
    const vi index = vi_sub(vi_select(vi_lt(vi_set(0), before), before, count), vi_set(1));
    return vi_add(find_first_arc(first_record, info), index);
#endif
}

/* The arcs of the pairs k ... of a queue that hold n and -n. */
SHARED void find_arcs(const narc_record *records, const struct queue *queue, int k, vec2 n, vi *out_a, vi *out_b) {
    const vec2 n_b = v2_unrotate_opposite(get_vec2(queue, ROTATION, k), n);
    *out_a = find_arc(records, get_bits(queue, FIRST_RECORD_A, k), get_bits(queue, INFO_A, k), n);
    *out_b = find_arc(records, get_bits(queue, FIRST_RECORD_B, k), get_bits(queue, INFO_B, k), n_b);
}

/* Finds the arcs that hold DIRECTION for the pairs `begin` ... of a queue. */
INLINE void look_up_arcs(const narc_record *records, struct queue *queue, int begin) {
    for (int k = begin; k < queue->count; k += V_WIDTH) {
        vi a, b;
        find_arcs(records, queue, k, get_vec2(queue, DIRECTION, k), &a, &b);
        vi_store(queue->record_a + k, a);
        vi_store(queue->record_b + k, b);
    }
}

#endif
