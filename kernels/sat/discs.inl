/* SPDX-License-Identifier: MIT
 *
 * discs.inl - pairs of circles. There is nothing to search: the gap is largest from centre to centre. They are answered
 * as they are set up, without a queue.
 */
#ifndef NARC_SAT_DISCS_INL
#define NARC_SAT_DISCS_INL

#include <stdbool.h>

#include "base/arcs.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "sat/probe.inl"
#include "simd/simd.h"

/* Are there pairs in the lanes `open`, all of two circles? */
INLINE bool are_discs(vm open, const vf item[FIELDS]) {
    return vm_any(open) && !vm_any(vm_and_not(open, both_have(item, NARC_SHAPE_CIRCLE)));
}

/* A circle in each lane: half of it, without its ends, which mean nothing. */
INLINE struct arcs load_disc(const narc_record *records, vi first_record, vi info, const struct pose *pose, bool is_b) {
    const vf none = v_set(0);
    vf field[8] = {none, none, none, none, none, none, none, none};
    int32_t index[V_WIDTH];
    vi_store(index, first_arc_record(first_record, info));
    v_rows(records, sizeof *records, index, field);
    return is_b ? place_b(field, pose) : place_a(field, pose);
}

/* What two circles tell of the gap, in the lanes `live`. */
INLINE struct probe probe_discs(const narc_record *records, const vf item[FIELDS], vm live, vf margin) {
    const struct pose pose = {
        {item[POSITION], item[POSITION + 1]}, {item[ROTATION], item[ROTATION + 1]}, item[SCALE_A], item[SCALE_B]};
    const struct arc_pair arcs = {
        load_disc(records, item_bits(item, FIRST_RECORD_A), item_bits(item, INFO_A), &pose, false),
        load_disc(records, item_bits(item, FIRST_RECORD_B), item_bits(item, INFO_B), &pose, true)};
    struct probe p = measure_gap(&arcs);
    certify_gap(&p, p.length, item[SLACK], live, margin);
    return p;
}

#endif
