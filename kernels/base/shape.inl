/* SPDX-License-Identifier: MIT
 *
 * shape.inl - the shape store (store.h) in vectors: headers, records and angles.
 */
#ifndef NARC_BASE_SHAPE_INL
#define NARC_BASE_SHAPE_INL

#include "base/vec2.inl"
#include "simd/simd.h"
#include "store.h"

/* The header of a shape in each lane. `info` is its second word: count, first arc, flags, extent ratio, from the
 * lowest byte on. */
struct headers {
    vi first_record, info;
    vec2 bound_center;
    vf bound_radius;
    vec2 inner_center;
    vf inner_radius;
};

INLINE struct headers load_headers(const narc_shape_header *headers, const int32_t *shape) {
    vf word[8];
    v_rows(headers, sizeof *headers, shape, word);
    v_rows(&headers->bound_radius, sizeof *headers, shape, word + 4);
    return (struct headers){vi_bits(word[0]), vi_bits(word[1]),   {word[2], word[3]},
                            word[4],          {word[5], word[6]}, word[7]};
}

INLINE vi info_count(vi info) { return vi_and(info, vi_set(0xff)); }

INLINE vi info_first_arc(vi info) { return vi_and(vi_shift_right(info, 8), vi_set(0xff)); }

INLINE vm info_has(vi info, int flag) { return vi_lt(vi_set(0), vi_and(info, vi_set(flag << 16))); }

/* A shape's straight parts that are no longer than this, in its own unit, are no edges (store.h, the size class). */
INLINE vf find_least_edge(vi info) {
    const vi size_class = vi_and(vi_shift_right(info, 20), vi_set(15));
    const vi exponent = vi_add(vi_add(vi_shift_left(size_class, 2), size_class), vi_set(127 - 47));
    return v_of_bits(vi_shift_left(exponent, 23));
}

INLINE vi info_extent_ratio(vi info) { return vi_shift_right(info, 24); }

/* The record of the shape's first arc, behind its junction angles. */
INLINE vi first_arc_record(vi first_record, vi info) {
    _Static_assert(NARC_RECORD_ANGLES == 16, "the shift divides by it");
    return vi_add(first_record, vi_shift_right(vi_add(info_count(info), vi_set(NARC_RECORD_ANGLES - 1)), 4));
}

/* A record in each lane: eight fields. */
INLINE void load_records(const narc_record *records, vi record, vf field[8]) {
    int32_t index[V_WIDTH];
    vi_store(index, record);
    v_rows(records, sizeof *records, index, field);
    v_rows(&records->arc.start_x, sizeof *records, index, field + 4);
}

/* The records of a shape's arcs in each lane, a cycle. */
struct ring {
    vi base, count;
};

INLINE struct ring make_ring(vi first_record, vi info) {
    return (struct ring){first_arc_record(first_record, info), info_count(info)};
}

/* A record after a step of -1, 0 or 1 along the ring. */
INLINE vi step_record(struct ring ring, vi record, vi step) {
    const vi end = vi_add(ring.base, ring.count), next = vi_add(record, step);
    const vi low = vi_select(vi_lt(next, ring.base), vi_sub(end, vi_set(1)), next);
    return vi_select(vi_lt(low, end), low, ring.base);
}

/* The diamond angle of a direction of any length: monotonic in the true angle, 0 along +x, 1 along +y, at most 4. */
INLINE vf diamond_angle(vec2 a) {
    const vf part = v_div(a.x, v_add(v_abs(a.x), v_abs(a.y)));
    return v_select(v_le(v_set(0), a.y), v_sub(v_set(1), part), v_add(v_set(3), part));
}

#endif
