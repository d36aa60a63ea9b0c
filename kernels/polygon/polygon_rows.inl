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
#include "piece/pieces.inl"
#include "polygon/polygon_contact.inl"
#include "sat/manifold_edges.inl"
#include "simd/simd.h"

/* Is n the edge's normal? */
INLINE vm lies_on_edge(const struct polygon_touch *t) { return v_le(v_abs(t->sine), v_set(PARALLEL)); }

/* As find_feature_at() has it. */
INLINE struct feature find_polygon_feature(const struct polygon_touch *t, vec2 n, bool is_b) {
    const vm parallel = lies_on_edge(t);
    const struct arcs other = {.center = t->other, .radius = t->corner.radius};
    const vec2 point = find_point(&t->corner, n, is_b);
    const vf along = v2_cross(n, point), there = v2_cross(n, find_point(&other, n, is_b));
    return (struct feature){.across = v2_dot(n, point),
                            .along_min = v_select(parallel, v_min(along, there), along),
                            .along_max = v_select(parallel, v_max(along, there), along),
                            .record = vi_select(vm_and(parallel, t->at_end), t->next, t->record),
                            .radius = t->corner.radius,
                            .start = t->corner.start,
                            .end = t->corner.end};
}

/* As find_edge() has it. */
INLINE struct edge find_touching_edge(const struct call *call, const struct queue *queue, int k,
                                      const struct polygon_touch *t, vec2 n, bool is_b) {
    const struct arcs other = {.center = t->other, .radius = t->corner.radius};
    const struct edge_end here = find_edge_end(&t->corner, t->normal, n, is_b),
                          there = find_edge_end(&other, t->normal, n, is_b);
    const vm here_is_low = is_b ? vm_not(t->at_end) : t->at_end;
    return (struct edge){
        .is_edge = vm_front(V_WIDTH),
        .offered = v_le(v_abs(t->sine), v_set(call->batch->flat_sine)),
        .parallel = lies_on_edge(t),
        .low = select_edge_end(here_is_low, &here, &there),
        .high = select_edge_end(here_is_low, &there, &here),
        .before = find_number_of(queue, k, vi_select(t->at_end, t->record, t->next), is_b),
        .after = find_number_of(queue, k, vi_select(t->at_end, t->next, t->record), is_b),
        .arc_radius = t->corner.radius,
    };
}

/* Writes the rows of the pairs k ... of a queue in the lanes `keep`. */
INLINE void write_polygons(const struct call *call, const struct queue *queue, int k, vm keep, vf margin,
                           const struct polygon_contact *c, bool edges) {
    const vec2 n = c->normal, to_world = get_vec2(queue, ROTATION_A, k);
    const struct feature on_a = find_polygon_feature(&c->a, n, false), on_b = find_polygon_feature(&c->b, n, true);
    const vec2 place = find_contact_place(&on_a, &on_b);
    const vm edge_a = lies_on_edge(&c->a), edge_b = lies_on_edge(&c->b);
    const vi pairs = get_bits(queue, PAIR, k);
    const vi number_a = find_number_of(queue, k, on_a.record, false),
             number_b = find_number_of(queue, k, on_b.record, true);
    const vi of_edge = vi_set(NARC_FEATURE_EDGE), zero = vi_set(0);
    const vi feature_a = vi_add(number_a, vi_select(edge_a, of_edge, zero));
    const vi feature_b = vi_add(number_b, vi_select(edge_b, of_edge, zero));
    const vf flat = v_set(INFINITY);
    const struct answer answer = {.separation = c->separation,
                                  .normal = v2_rotate(to_world, n),
                                  .point = v2_rotate(to_world, v2_rotate(n, place)),
                                  .feature = vi_add(feature_a, vi_shift_left(feature_b, 8)),
                                  .radius_a = v_select(edge_a, flat, on_a.radius),
                                  .radius_b = v_select(edge_b, flat, on_b.radius),
                                  .reach_a = find_reach(&on_a, n, get_bits(queue, INFO_A, k), edge_a),
                                  .reach_b = find_reach(&on_b, n, get_bits(queue, INFO_B, k), edge_b)};
    char *to[V_WIDTH];
    find_places(call, pairs, keep_fronts(call, queue, k, keep, c->separation, n, feature_a, feature_b), to);
    if (edges) {
        const struct sides sides = {.a = find_touching_edge(call, queue, k, &c->a, n, false),
                                    .b = find_touching_edge(call, queue, k, &c->b, n, true),
                                    .number_a = number_a,
                                    .number_b = number_b,
                                    .n = n,
                                    .to_world = to_world,
                                    .position_b = get_vec2(queue, POSITION, k),
                                    .place = place,
                                    .margin = margin,
                                    .named = vm_front(V_WIDTH)};
        write_sides(call, to, pairs, &answer, &sides);
    } else {
        write_rows(call, to, find_numbers(call, pairs), &answer);
    }
}

#endif
