/* SPDX-License-Identifier: MIT
 *
 * polygon_rows.inl - the last step of a pair of sharp polygons: contacts, and manifolds with their second point, ids,
 * radii and reaches. All is what base/contact_point.inl, base/rows.inl and sat/manifold_edges.inl define, and is computed
 * in the same way: the edge closer to n, of the two at the corner that touches, is never too short to be one.
 */
#ifndef NARC_POLYGON_POLYGON_ROWS_INL
#define NARC_POLYGON_POLYGON_ROWS_INL

#include <math.h>
#include <stdbool.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_rows.inl"
#include "piece/pieces.inl"
#include "polygon/polygon_contact.inl"
#include "sat/manifold_edges.inl"
#include "simd/simd.h"

/* The edge next to the corner that touches, as a side of a box. */
INLINE struct box_side find_polygon_side(const struct polygon_touch *t, bool is_b) {
    const vm here_is_low = is_b ? vm_not(t->at_end) : t->at_end;
    return (struct box_side){.normal = t->normal,
                             .low = v2_select(here_is_low, t->corner.center, t->other),
                             .high = v2_select(here_is_low, t->other, t->corner.center),
                             .behind = vm_not(t->at_end)};
}

INLINE struct side_arcs find_polygon_arcs(const struct queue *queue, int k, const struct polygon_touch *t, bool is_b) {
    const vf radius = t->corner.radius;
    const vi count = get_arc_count(get_bits(queue, is_b ? INFO_B : INFO_A, k));
    const vi before = find_number_of(queue, k, vi_select(t->at_end, t->record, t->next), is_b);
    const vi behind = vi_add(before, vi_set(1));
    return (struct side_arcs){radius, radius, radius, before, vi_select(vi_lt(behind, count), behind, vi_set(0))};
}

INLINE vi find_polygon_reach(const struct polygon_touch *t, vec2 n, vi info) {
    const struct feature corner = {.start = t->corner.start, .end = t->corner.end};
    return find_reach(&corner, n, info, v_le(v_abs(t->sine), v_set(PARALLEL)));
}

/* Writes the rows of the pairs k ... of a queue in the lanes `keep`. */
INLINE void write_polygons(const struct call *call, const struct queue *queue, int k, vm keep, vf margin,
                           const struct polygon_contact *c, bool edges) {
    const vec2 n = c->normal;
    const struct box_contact contact = {c->separation, n, find_polygon_side(&c->a, false),
                                        find_polygon_side(&c->b, true), keep};
    vi reaches[] = {vi_set(0), vi_set(0)};
    if (edges) {
        reaches[0] = find_polygon_reach(&c->a, n, get_bits(queue, INFO_A, k));
        reaches[1] = find_polygon_reach(&c->b, n, get_bits(queue, INFO_B, k));
    }
    const struct touching_sides sides = {.a = find_polygon_arcs(queue, k, &c->a, false),
                                         .b = find_polygon_arcs(queue, k, &c->b, true),
                                         .pairs = get_bits(queue, PAIR, k),
                                         .to_world = get_vec2(queue, ROTATION_A, k),
                                         .position_b = get_vec2(queue, POSITION, k),
                                         .reaches = reaches};
    struct told_sides told;
    tell_sides(&contact, &sides, &told);
    const vi feature = told.answer.feature;
    char *place[V_WIDTH];
    find_places(
        call, sides.pairs,
        keep_fronts(call, queue, k, keep, c->separation, n, vi_and(feature, vi_set(0xff)), vi_shift_right(feature, 8)),
        place);
    write_touching(call, &contact, &sides, &told, margin, place, edges);
}

#endif
