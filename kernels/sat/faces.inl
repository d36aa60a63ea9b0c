/* SPDX-License-Identifier: MIT
 *
 * faces.inl - the normal of a contact whose direction rounding has made.
 *
 * Where the centres of the two arcs that touch lie in one place up to rounding, as of corner on corner, u is a vector of
 * rounding's size, and its direction says nothing. All directions that both arcs hold have the same gap then, up to |u|,
 * and the ends of what they hold are normals of junctions. If one of these is the normal of an edge, and the gap along it,
 * u.n less the radii, is within rounding of the largest, |u| less the radii, it is told: so a box that comes along a row
 * of tiles is told of their faces. Of several it is the one with the largest gap. The separation stays the largest.
 *
 * Other contacts keep their normals. Of arcs whose centres are apart the direction of u is known, and changes steadily as
 * one rolls on the other.
 */
#ifndef NARC_SAT_FACES_INL
#define NARC_SAT_FACES_INL

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* What the gap of two arcs may be off by, in proportion to the coordinates that it was computed from: so much of their
 * sums (in which a coordinate counts up to 1.42 times) that it is below NARC_ERROR_BOUND. It depends on nothing but the
 * arcs, whichever stage asks. */
#define GAP_ROOM 0x1.6p-20f

/* u is of rounding's size up to so many rooms. That is less than two slacks, below which no stage but the deciding
 * formula, and its walks, takes a corner for its answer (certificates.inl; box_contact.inl, polygon_contact.inl). */
#define LOOSE_ROOMS 6.0f

INLINE vf add_sizes(vec2 p) { return v_add(v_abs(p.x), v_abs(p.y)); }

INLINE vf find_gap_room(const struct arc_pair *arcs, vec2 position_b) {
    const vf sizes =
        v_add(add_sizes(position_b), v_add(add_sizes(arcs->a.center), add_sizes(v2_sub(arcs->b.center, position_b))));
    return v_mul(v_set(GAP_ROOM), v_add(sizes, v_add(arcs->a.radius, arcs->b.radius)));
}

INLINE vm are_equal(vec2 p, vec2 q) {
    return vm_and(vm_and(v_le(p.x, q.x), v_le(q.x, p.x)), vm_and(v_le(p.y, q.y), v_le(q.y, p.y)));
}

/* Are the centres in one place up to rounding? Then a normal that is no face's is made of rounding: along u, or at a
 * junction where signs have made a kink. */
INLINE vm is_loose(const struct arc_pair *arcs, vec2 position_b) {
    const vec2 u = find_center_difference(arcs);
    const vf most = v_mul(v_set(LOOSE_ROOMS), find_gap_room(arcs, position_b));
    return v_le(v2_dot(u, u), v_mul(most, most));
}

/* Does an arc hold the normal of a junction, at an end as well? */
INLINE vm holds_junction(const struct arcs *arc, vec2 n, vm circle) {
    const vf least = v_set(-PARALLEL);
    const vm between = vm_and(v_le(least, v2_cross(arc->start, n)), v_le(least, v2_cross(n, arc->end)));
    return vm_or(circle, vm_and(between, v_le(v_set(0), v2_dot(n, v2_add(arc->start, arc->end)))));
}

/* The junctions at the ends of two arcs that touch: starts, then ends; of A, then B. */
enum { JUNCTIONS = 4 };

INLINE vec2 get_junction(const struct arc_pair *arcs, int junction) {
    const struct arcs *const arc = junction % 2 ? &arcs->b : &arcs->a;
    return junction < 2 ? arc->start : arc->end;
}

/* In the lanes `loose`, the unit normal that is told. `faces`: which junctions are edges. */
INLINE vec2 choose_face(const struct arc_pair *arcs, vec2 position_b, vm loose, const vm faces[JUNCTIONS], vm circle_a,
                        vm circle_b, vec2 normal) {
    const vec2 u = find_center_difference(arcs);
    vf most = v_sub(v2_length(u), find_gap_room(arcs, position_b));
    vec2 told = normal;
    vm open = loose;
    for (int k = 0; k < JUNCTIONS; k++) {
        const vec2 n = get_junction(arcs, k);
        const vm held = k % 2 ? holds_junction(&arcs->a, n, circle_a) : holds_junction(&arcs->b, n, circle_b);
        const vf along = v2_dot(u, n);
        const vm better = vm_and(vm_and(faces[k], held), k == 0 ? v_le(most, along) : v_lt(most, along));
        open = vm_and_not(open, vm_and(faces[k], are_equal(normal, n))); /* it is a face's already */
        most = v_select(better, along, most);
        told = v2_select(better, n, told);
    }
    return v2_select(open, told, normal);
}

/* The normals of the pairs k ... of a queue in the lanes `loose`, which touch with these arcs. Of runs of chains only
 * what may touch counts. */
NOINLINE void tell_faces(const struct call *call, const struct queue *queue, int k, const struct gap *gap, vm loose,
                         vec2 *normal) {
    const narc_record *const records = call->batch->shapes->records;
    const struct pose pose = get_pose(queue, k);
    const struct arc_pair arcs = load_arc_pair(records, gap->record_a, gap->record_b, &pose);
    vm faces[JUNCTIONS], circle[2];
    for (int j = 0; j < JUNCTIONS; j++) {
        const bool is_b = j % 2;
        const vi info = get_bits(queue, is_b ? INFO_B : INFO_A, k),
                 first = get_bits(queue, is_b ? FIRST_RECORD_B : FIRST_RECORD_A, k),
                 record = is_b ? gap->record_b : gap->record_a;
        const struct feature f = find_feature_at(records, is_b ? get_ring_b(queue, k) : get_ring_a(queue, k), record,
                                                 &pose, get_junction(&arcs, j), is_b);
        faces[j] = touches_edge(&f, info, is_b ? pose.scale_b : pose.scale_a);
        circle[j % 2] = has_flag(info, NARC_SHAPE_CIRCLE);
        if (NARC_PIECES && vm_any(has_mark(info, NARC_PIECE_MARKS))) {
            const vi edge = vi_add(find_arc_number(f.record, first, info), vi_set(NARC_FEATURE_EDGE));
            loose = vm_and(loose, is_front(info, find_arc_number(record, first, info)));
            faces[j] = vm_and(faces[j], is_front(info, edge));
        }
    }
    *normal = choose_face(&arcs, pose.position, loose, faces, circle[0], circle[1], *normal);
}

INLINE vm find_loose(const struct call *call, const struct queue *queue, int k, vm which, const struct gap *gap) {
    const struct pose pose = get_pose(queue, k);
    const struct arc_pair arcs = load_arc_pair(call->batch->shapes->records, gap->record_a, gap->record_b, &pose);
    return vm_and(which, is_loose(&arcs, pose.position));
}

/* The unit normal of the gap of the pairs k ... of a queue, in the lanes `which`. */
INLINE vec2 find_normal(const struct call *call, const struct queue *queue, int k, vm which, const struct gap *gap) {
    const vm loose = find_loose(call, queue, k, which, gap);
    vec2 n = v2_divide(gap->normal, gap->length);
    if (vm_any(loose))
        tell_faces(call, queue, k, gap, loose, &n);
    return n;
}

#endif
