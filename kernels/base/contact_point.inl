/* SPDX-License-Identifier: MIT
 *
 * contact_point.inl - where two bodies touch, and with what: all that a row of one point says.
 *
 * The contact point lies halfway between the two support lines across n. Along them, A touches its line in a point or,
 * where n is the normal of an edge, in a stretch, and so does B: the point is the middle of what the two have in
 * common.
 */
#ifndef NARC_BASE_CONTACT_POINT_INL
#define NARC_BASE_CONTACT_POINT_INL

#include <math.h>
#include <stdbool.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* An edge counts as lying on the support line if its normal is this close to n (radians): above the rounding of a
 * rotated normal, 6.35 * 2^-24, below any angle between two normals of a shape. */
#define PARALLEL 0x1p-20f

/* What one shape touches its support line with: its position across n, the stretch along it, and the record of the arc
 * and its radius; of an edge, those of the arc at its counter-clockwise end. */
struct feature {
    vf across, along_min, along_max;
    vi record;
    vf radius;
    vf magnitude;    /* what the stretch may be wrong by is in proportion to it */
    vec2 start, end; /* of the arc */
};

/* What a place along n is computed from: the radius, and an eighth of the centre's coordinates. */
INLINE vf find_magnitude(const struct arcs *arc) {
    return v_add(v_mul(v_set(0.125f), v_add(v_abs(arc->center.x), v_abs(arc->center.y))), arc->radius);
}

/* The point of an arc with the normal n. A is touched on its side n, B on its side -n. */
INLINE vec2 find_point(const struct arcs *arc, vec2 n, bool is_b) {
    const vf radius = v_mul(v_set(is_b ? -1.0f : 1.0f), arc->radius);
    return v2_add(arc->center, v2_scale(n, radius));
}

/* The feature between the arcs after and before n, one and the same unless n is their junction's normal. */
INLINE struct feature find_feature(const struct arcs *after, const struct arcs *before, vec2 n, vi record, bool is_b) {
    const vec2 point = find_point(after, n, is_b);
    const vf along = v2_cross(n, point), other = v2_cross(n, find_point(before, n, is_b));
    const vf magnitude = v_add(find_magnitude(after), find_magnitude(before));
    return (struct feature){v2_dot(n, point), v_min(along, other), v_max(along, other), record,
                            after->radius,    magnitude,           after->start,        after->end};
}

INLINE vm is_parallel(vec2 junction, vec2 n) {
    return vm_and(v_le(v_abs(v2_cross(junction, n)), v_set(PARALLEL)), v_lt(v_set(0), v2_dot(junction, n)));
}

/* The feature of the shape with this arc, the one in `record`: a point, or up to the end of a neighbouring arc where n is
 * the normal of the junction with it. */
INLINE struct feature find_feature_beside(const narc_record *records, struct ring ring, vi record,
                                          const struct arcs *arc, const struct pose *pose, vec2 n, bool is_b) {
    const vm starts = is_parallel(arc->start, n), ends = is_parallel(arc->end, n);
    const vm either = vm_or(starts, ends), both = vm_and(starts, ends);
    struct feature f = find_feature(arc, arc, n, record, is_b);
    if (!vm_any(either))
        return f;
    if (vm_any(both)) { /* of an arc that turns by less than that */
        const struct arcs before = load_arcs(records, step_record(ring, record, vi_set(-1)), pose, is_b);
        const vf along = v2_cross(n, find_point(&before, n, is_b));
        f.along_min = v_select(both, v_min(f.along_min, along), f.along_min);
        f.along_max = v_select(both, v_max(f.along_max, along), f.along_max);
    }
    const vi other = step_record(ring, record, vi_select(ends, vi_set(1), vi_set(-1)));
    const struct arcs beside = load_arcs(records, other, pose, is_b);
    const vf along = v2_cross(n, find_point(&beside, n, is_b));
    f.along_min = v_select(either, v_min(f.along_min, along), f.along_min);
    f.along_max = v_select(either, v_max(f.along_max, along), f.along_max);
    f.magnitude = v_select(either, v_add(find_magnitude(arc), find_magnitude(&beside)), f.magnitude);
    f.record = vi_select(ends, other, record);
    f.radius = v_select(ends, beside.radius, f.radius);
    f.start = v2_select(ends, beside.start, f.start);
    f.end = v2_select(ends, beside.end, f.end);
    return f;
}

INLINE struct feature find_feature_at(const narc_record *records, struct ring ring, vi record, const struct pose *pose,
                                      vec2 n, bool is_b) {
    const struct arcs arc = load_arcs(records, record, pose, is_b);
    return find_feature_beside(records, ring, record, &arc, pose, n, is_b);
}

/* A stretch longer than this part of its magnitude is an edge: four times what two radii may differ by along a normal
 * that is PARALLEL to a junction's, and eight roundings of the coordinates. */
#define LEAST_STRETCH 0x1p-18f

/* Does a body touch with an edge? Its own coordinates may be far larger than those in A's frame: what they lost when
 * they were stored is no edge either. */
INLINE vm touches_edge(const struct feature *f, vi info, vf scale) {
    const vf length = v_sub(f->along_max, f->along_min), least = v_mul(scale, find_least_edge(info));
    const vm longer = v_lt(v_max(v_mul(v_set(LEAST_STRETCH), f->magnitude), least), length);
    return vm_and_not(longer, has_flag(info, NARC_SHAPE_SMOOTH));
}

/* The contact point's place across n and along it. */
INLINE vec2 find_contact_place(const struct feature *on_a, const struct feature *on_b) {
    const vf half = v_set(0.5f), across = v_mul(half, v_add(on_a->across, on_b->across));
    const vf along =
        v_mul(half, v_add(v_max(on_a->along_min, on_b->along_min), v_min(on_a->along_max, on_b->along_max)));
    return (vec2){across, along};
}

/* ------------------------------------------------------------------------------------------------ what a row says */

/* Two halves of a word, the one at the lower address first. */
INLINE vi pack_halves(vi low, vi high) {
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    return vi_add(high, vi_shift_left(low, 16));
#else
    return vi_add(low, vi_shift_left(high, 16));
#endif
}

/* What is known of a pair's only point, or its deepest one. */
struct answer {
    vf separation;
    vec2 normal, point; /* in the world's axes */
    vi feature;
    vf radius_a, radius_b;
    vi reach_a, reach_b; /* as in a manifold's row */
};

/* The caller's number of an arc from its record; a circle's two halves are both arc 0. */
INLINE vi find_arc_number(vi record, vi first_record, vi info) {
    const vi index = vi_sub(record, find_first_arc(first_record, info));
    const vi number = vi_add(index, get_first_arc(info)), count = get_arc_count(info);
    const vi wrapped = vi_select(vi_lt(number, count), number, vi_sub(number, count));
    return vi_select(has_flag(info, NARC_SHAPE_CIRCLE), vi_set(0), wrapped);
}

/* The sine of the angle from one unit vector to another, counter-clockwise and up to half a turn, of a quarter turn at
 * most. */
INLINE vf find_capped_sine(vec2 from, vec2 to) {
    const vf one = v_set(1), sine = v_max(v2_cross(from, to), v_set(0));
    return v_select(v_lt(v_set(0), v2_dot(from, to)), v_min(sine, one), one);
}

/* How far n may turn on the arc of a feature, as a manifold's row has it. */
INLINE vi find_reach(const struct feature *f, vec2 n, vi info, vm edge) {
    const vf one = v_set(NARC_REACH_ONE), none = v_set(0);
    const vm circle = has_flag(info, NARC_SHAPE_CIRCLE);
    const vf back = v_mul(one, find_capped_sine(f->start, n)), ahead = v_mul(one, find_capped_sine(n, f->end));
    return pack_halves(vi_truncate(v_select(circle, one, v_select(edge, none, back))),
                       vi_truncate(v_select(circle, one, v_select(edge, none, ahead))));
}

/* What is told of both bodies of a pair beside how they touch: the first two words of their headers, their scales, and A's
 * rotation in the world. */
struct touching_pair {
    vi first_a, first_b, info_a, info_b;
    vf scale_a, scale_b;
    vec2 to_world;
    bool round_a, round_b; /* is it a circle, for certain, in all lanes? Constants */
};

/* What a body touches with: of a circle the arc 0, of another one an arc or the edge before it. Where that is an edge,
 * *out_edge. */
INLINE vi tell_feature(const struct feature *f, vi first_record, vi info, vf scale, bool round, vm *out_edge) {
    *out_edge = round ? vm_front(0) : touches_edge(f, info, scale);
    if (round)
        return vi_set(0);
    return vi_add(find_arc_number(f->record, first_record, info),
                  vi_select(*out_edge, vi_set(NARC_FEATURE_EDGE), vi_set(0)));
}

INLINE vi tell_reach(const struct feature *f, vec2 n, vi info, vm edge, bool round) {
    return round ? vi_set(-1) : find_reach(f, n, info, edge); /* NARC_REACH_ONE twice */
}

/* The answer to pairs that touch along n, in A's frame. `reaches`: are they asked for? */
INLINE struct answer tell_touch(const struct touching_pair *pair, vf separation, vec2 n, const struct feature *on_a,
                                const struct feature *on_b, bool reaches) {
    const vi info_a = pair->info_a, info_b = pair->info_b, zero = vi_set(0);
    const vec2 to_world = pair->to_world;
    vm edge_a, edge_b;
    const vi feature_a = tell_feature(on_a, pair->first_a, info_a, pair->scale_a, pair->round_a, &edge_a);
    const vi feature_b = tell_feature(on_b, pair->first_b, info_b, pair->scale_b, pair->round_b, &edge_b);
    return (struct answer){.separation = separation,
                           .normal = v2_rotate(to_world, n),
                           .point = v2_rotate(to_world, v2_rotate(n, find_contact_place(on_a, on_b))),
                           .feature = vi_add(feature_a, vi_shift_left(feature_b, 8)),
                           .radius_a = v_select(edge_a, v_set(INFINITY), on_a->radius),
                           .radius_b = v_select(edge_b, v_set(INFINITY), on_b->radius),
                           .reach_a = reaches ? tell_reach(on_a, n, info_a, edge_a, pair->round_a) : zero,
                           .reach_b = reaches ? tell_reach(on_b, n, info_b, edge_b, pair->round_b) : zero};
}

/* The same of the pairs k ... of a queue. */
INLINE struct answer find_answer(const struct queue *queue, int k, vf separation, vec2 n, const struct feature *on_a,
                                 const struct feature *on_b, bool reaches) {
    const struct touching_pair pair = {get_bits(queue, FIRST_RECORD_A, k),
                                       get_bits(queue, FIRST_RECORD_B, k),
                                       get_bits(queue, INFO_A, k),
                                       get_bits(queue, INFO_B, k),
                                       get(queue, SCALE_A, k),
                                       get(queue, SCALE_B, k),
                                       get_vec2(queue, ROTATION_A, k),
                                       false,
                                       false};
    return tell_touch(&pair, separation, n, on_a, on_b, reaches);
}

#endif
