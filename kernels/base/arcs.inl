/* SPDX-License-Identifier: MIT
 *
 * arcs.inl - an arc of A and of B in each lane, in A's frame at world scale; and the gap along a direction.
 */
#ifndef NARC_BASE_ARCS_INL
#define NARC_BASE_ARCS_INL

#include <stdbool.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* B's pose in A's frame, and both scales. */
struct pose {
    vec2 position, rotation;
    vf scale_a, scale_b;
};

INLINE struct pose get_pose(const struct queue *queue, int k) {
    return (struct pose){get_vec2(queue, POSITION, k), get_vec2(queue, ROTATION, k), get(queue, SCALE_A, k),
                         get(queue, SCALE_B, k)};
}

/* Normals point from A to B: those of B's arcs are turned round. */
struct arcs {
    vec2 center;
    vf radius, inner, near; /* the last two: store.h */
    vec2 start, end;
};

/* Two floats that lack their lower halves, in one. */
INLINE vf upper_half(vf two) { return v_of_bits(vi_and(vi_bits(two), vi_set((int32_t)0xffff0000u))); }

INLINE vf lower_half(vf two) { return v_of_bits(vi_shift_left(vi_bits(two), 16)); }

INLINE struct arcs place_a(const vf field[8], const struct pose *pose) {
    return (struct arcs){v2_scale((vec2){field[0], field[1]}, pose->scale_a),
                         v_mul(field[2], pose->scale_a),
                         v_mul(upper_half(field[3]), pose->scale_a),
                         v_mul(lower_half(field[3]), pose->scale_a),
                         {field[4], field[5]},
                         {field[6], field[7]}};
}

INLINE vec2 place_center_b(vec2 center, const struct pose *pose) {
    return v2_add(pose->position, v2_scale(v2_rotate(pose->rotation, center), pose->scale_b));
}

INLINE struct arcs place_b(const vf field[8], const struct pose *pose) {
    return (struct arcs){place_center_b((vec2){field[0], field[1]}, pose),
                         v_mul(field[2], pose->scale_b),
                         v_mul(upper_half(field[3]), pose->scale_b),
                         v_mul(lower_half(field[3]), pose->scale_b),
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

/* An arc of A and one of B. */
struct arc_pair {
    struct arcs a, b;
};

INLINE struct arc_pair load_arc_pair(const narc_record *records, vi record_a, vi record_b, const struct pose *pose) {
    return (struct arc_pair){load_arcs(records, record_a, pose, false), load_arcs(records, record_b, pose, true)};
}

INLINE struct arc_pair select_arc_pair(vm m, const struct arc_pair *a, const struct arc_pair *b) {
    return (struct arc_pair){select_arcs(m, &a->a, &b->a), select_arcs(m, &a->b, &b->b)};
}

/* u, from the centre of A's arc to that of B's. */
INLINE vec2 center_difference(const struct arc_pair *arcs) { return v2_sub(arcs->b.center, arcs->a.center); }

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
