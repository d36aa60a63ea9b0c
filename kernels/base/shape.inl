/* SPDX-License-Identifier: MIT
 *
 * shape.inl - the shape store (store.h) in vectors: headers, records and angles; an arc of A and of B in each lane, in
 * A's frame at world scale; and the gap along a direction.
 */
#ifndef NARC_BASE_SHAPE_INL
#define NARC_BASE_SHAPE_INL

#include <stdbool.h>

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

/* The form of a shape in each lane. */
struct box_form {
    vec2 half;
    vf radius;
    vi info;
};

INLINE struct box_form load_box_forms(const narc_box_form *forms, const int32_t *shape) {
    vf word[4];
    v_rows(forms, sizeof *forms, shape, word);
    return (struct box_form){{word[0], word[1]}, word[2], vi_bits(word[3])};
}

INLINE vm is_form(const struct box_form *form, uint32_t kind) {
    return vi_lt(vi_set(0), vi_and(form->info, vi_set((int32_t)kind)));
}

INLINE vi get_arc_count(vi info) { return vi_and(info, vi_set(0xff)); }

INLINE vi get_first_arc(vi info) { return vi_and(vi_shift_right(info, 8), vi_set(NARC_FIRST_ARC)); }

INLINE vm has_flag(vi info, int flag) { return vi_lt(vi_set(0), vi_and(info, vi_set(flag << 16))); }

/* The marks of a chain's piece, or of a half-plane, of which none is larger. */
INLINE vi get_marks(vi info) { return vi_and(info, vi_set((int32_t)(NARC_PIECE_MARKS << 8))); }

INLINE vm is_plane(vi info) { return vi_lt(vi_set((int32_t)(NARC_PIECE_PLANE << 8) - 1), get_marks(info)); }

/* A shape's straight parts that are no longer than this, in its own unit, are no edges (store.h, the size class). */
INLINE vf find_least_edge(vi info) {
    const vi size_class = vi_and(vi_shift_right(info, 20), vi_set(15));
    const vi exponent = vi_add(vi_add(vi_shift_left(size_class, 2), size_class), vi_set(127 - 47));
    return v_of_bits(vi_shift_left(exponent, 23));
}

INLINE vi get_extent_ratio(vi info) { return vi_shift_right(info, 24); }

/* The record of the shape's first arc, behind its junction angles. */
INLINE vi find_first_arc(vi first_record, vi info) {
    _Static_assert(NARC_RECORD_ANGLES == 16, "the shift divides by it");
    return vi_add(first_record, vi_shift_right(vi_add(get_arc_count(info), vi_set(NARC_RECORD_ANGLES - 1)), 4));
}

/* A record in each lane: the four fields that say where and how large its circle is; or all eight. */
INLINE void load_circle(const narc_record *records, vi record, vf field[4]) {
    int32_t index[V_WIDTH];
    vi_store(index, record);
    v_rows(records, sizeof *records, index, field);
}

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
    return (struct ring){find_first_arc(first_record, info), get_arc_count(info)};
}

/* A record after a step of -1, 0 or 1 along the ring. */
INLINE vi step_record(struct ring ring, vi record, vi step) {
    const vi end = vi_add(ring.base, ring.count), next = vi_add(record, step);
    const vi low = vi_select(vi_lt(next, ring.base), vi_sub(end, vi_set(1)), next);
    return vi_select(vi_lt(low, end), low, ring.base);
}

/* The diamond angle of a direction of any length: monotonic in the true angle, 0 along +x, 1 along +y, at most 4. */
INLINE vf find_diamond_angle(vec2 a) {
    const vf part = v_div(a.x, v_add(v_abs(a.x), v_abs(a.y)));
    return v_select(v_le(v_set(0), a.y), v_sub(v_set(1), part), v_add(v_set(3), part));
}

/* ------------------------------------------------------------------------------------------------ arcs, placed */

/* B's pose in A's frame, and both scales. */
struct pose {
    vec2 position, rotation;
    vf scale_a, scale_b;
};

/* Normals point from A to B: those of B's arcs are turned round. */
struct arcs {
    vec2 center;
    vf radius, inner, near; /* the last two: store.h */
    vec2 start, end;
};

/* Two floats that lack their lower halves, in one. */
INLINE vf get_upper_half(vf two) { return v_of_bits(vi_and(vi_bits(two), vi_set((int32_t)0xffff0000u))); }

INLINE vf get_lower_half(vf two) { return v_of_bits(vi_shift_left(vi_bits(two), 16)); }

INLINE struct arcs place_a(const vf field[8], const struct pose *pose) {
    return (struct arcs){v2_scale((vec2){field[0], field[1]}, pose->scale_a),
                         v_mul(field[2], pose->scale_a),
                         v_mul(get_upper_half(field[3]), pose->scale_a),
                         v_mul(get_lower_half(field[3]), pose->scale_a),
                         {field[4], field[5]},
                         {field[6], field[7]}};
}

INLINE vec2 place_center_b(vec2 center, const struct pose *pose) {
    return v2_add(pose->position, v2_scale(v2_rotate(pose->rotation, center), pose->scale_b));
}

INLINE struct arcs place_b(const vf field[8], const struct pose *pose) {
    return (struct arcs){place_center_b((vec2){field[0], field[1]}, pose),
                         v_mul(field[2], pose->scale_b),
                         v_mul(get_upper_half(field[3]), pose->scale_b),
                         v_mul(get_lower_half(field[3]), pose->scale_b),
                         v2_rotate_opposite(pose->rotation, (vec2){field[4], field[5]}),
                         v2_rotate_opposite(pose->rotation, (vec2){field[6], field[7]})};
}

/* The arcs in each lane's record. */
INLINE struct arcs load_arcs(const narc_record *records, vi record, const struct pose *pose, bool is_b) {
    vf field[8];
    load_records(records, record, field);
    return is_b ? place_b(field, pose) : place_a(field, pose);
}

INLINE struct arcs select_arcs(vm m, const struct arcs *a, const struct arcs *b) {
    return (struct arcs){v2_select(m, a->center, b->center), v_select(m, a->radius, b->radius),
                         v_select(m, a->inner, b->inner),    v_select(m, a->near, b->near),
                         v2_select(m, a->start, b->start),   v2_select(m, a->end, b->end)};
}

/* Where `is_a`, the arc is A's. */
INLINE struct arcs place_arc(const vf field[8], const struct pose *pose, vm is_a) {
    const struct arcs of_a = place_a(field, pose), of_b = place_b(field, pose);
    return select_arcs(is_a, &of_a, &of_b);
}

/* An arc of A and one of B. */
struct arc_pair {
    struct arcs a, b;
};

INLINE struct arc_pair load_arc_pair(const narc_record *records, vi record_a, vi record_b, const struct pose *pose) {
    return (struct arc_pair){load_arcs(records, record_a, pose, false), load_arcs(records, record_b, pose, true)};
}

INLINE struct arc_pair select_arc_pair(vm m, const struct arc_pair *a, const struct arc_pair *b) {
    if (V_WIDTH == 1)
        return vm_any(m) ? *a : *b;
    return (struct arc_pair){select_arcs(m, &a->a, &b->a), select_arcs(m, &a->b, &b->b)};
}

/* u, from the centre of A's arc to that of B's. */
INLINE vec2 find_center_difference(const struct arc_pair *arcs) { return v2_sub(arcs->b.center, arcs->a.center); }

/* The least normal float: a smaller square has lost its digits. */
#define LEAST_SQUARE 0x1p-126f

/* The largest gap that a search has found in each lane, with its direction and arcs. */
struct gap {
    vf separation;
    vec2 normal; /* not yet divided by its length */
    vf length;
    vi record_a, record_b;
};

INLINE struct gap select_gap(vm m, const struct gap *a, const struct gap *b) {
    return (struct gap){v_select(m, a->separation, b->separation), v2_select(m, a->normal, b->normal),
                        v_select(m, a->length, b->length), vi_select(m, a->record_a, b->record_a),
                        vi_select(m, a->record_b, b->record_b)};
}

#endif
