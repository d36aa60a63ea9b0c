/* SPDX-License-Identifier: MIT
 *
 * box_rows.inl - the last step of a pair of boxes: contacts, and manifolds with their second point, ids, radii and
 * reaches. All is what base/contact_point.inl, base/rows.inl and sat/manifold_edges.inl define, and is computed in
 * the same way: of a box the edge closest to the normal is one of the two next to the corner that touches, and it is
 * never too short to be one. Capsules differ in that their arcs go half a turn.
 *
 * Rows are listed at once while all pairs before them are answered (rows.inl).
 */
#ifndef NARC_BOX_BOX_ROWS_INL
#define NARC_BOX_BOX_ROWS_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/rows.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_pairs.inl"
#include "box/capsules.inl"
#include "kernels.h"
#include "sat/manifold_edges.inl"
#include "simd/simd.h"

/* What a box touches the other one with: a corner, or its edge. */
struct box_touch {
    vf radius;           /* outwards along n: of B, which is touched on its side -n, below 0 */
    vm parallel;         /* n is the edge's normal */
    vf sine, cosine;     /* from the edge's normal to n */
    vf across, min, max; /* as of a feature */
};

INLINE struct box_touch find_touch(const struct box_side *side, vec2 n, vf radius, bool is_b) {
    struct box_touch touch = {.radius = radius, .sine = v2_cross(side->normal, n), .cosine = v2_dot(side->normal, n)};
    const vec2 step = v2_scale(n, radius), low = v2_add(side->low, step), high = v2_add(side->high, step);
    const vm at_low = is_b ? side->behind : vm_not(side->behind);
    const vf along_low = v2_cross(n, low), along_high = v2_cross(n, high);
    touch.parallel = v_le(v_abs(touch.sine), v_set(PARALLEL));
    touch.across = v_select(at_low, v2_dot(n, low), v2_dot(n, high));
    touch.min = v_select(vm_or(at_low, touch.parallel), along_low, along_high);
    touch.max = v_select(vm_and_not(at_low, touch.parallel), along_low, along_high);
    return touch;
}

/* The caller's number of corner i, or of the edge before it. `shift`: of the first arc in the code. Of a capsule
 * the arc at -x, its corners 1 and 2, is stored first. */
INLINE vi find_box_arc(const struct box_pair *pair, vi i, int shift) {
    const vi first = vi_shift_right(get_box_code(pair), shift);
    if (pair->capsules)
        return vi_and(vi_add(vi_shift_right(vi_add(i, vi_set(3)), 1), first), vi_set(1));
    return vi_and(vi_add(i, first), vi_set(3));
}

/* What touches, as a contact has it. */
INLINE vi find_box_feature(const struct box_pair *pair, const struct box_side *side, const struct box_touch *touch,
                           int shift) {
    const vi edge = vi_add(find_box_arc(pair, side->edge, shift), vi_set(NARC_FEATURE_EDGE));
    return vi_select(touch->parallel, edge, find_box_arc(pair, find_box_touching(side), shift));
}

/* The reaches of a corner, as find_reach() has them, with the edge next to it. */
INLINE vi find_box_reach(const struct box_pair *pair, const struct box_side *side, const struct box_touch *touch) {
    const vf zero = v_set(0), one = v_set(1), full = v_set(NARC_REACH_ONE);
    if (!vm_any(vm_not(touch->parallel)))
        return vi_set(0);
    const vf turn = v_select(side->behind, touch->sine, v_neg(touch->sine)); /* away from the edge */
    vf sine = v_min(v_max(turn, zero), one), other = v_select(v_lt(zero, turn), v_min(touch->cosine, one), one);
    if (pair->capsules) { /* the other edge is half a turn away */
        sine = v_select(v_lt(zero, touch->cosine), sine, one);
        other = one;
    }
    const vf near = v_select(touch->parallel, zero, v_mul(full, sine));
    other = v_mul(full, other);
    const vf far = v_select(touch->parallel, zero, other);
    return pack_halves(vi_truncate(v_select(side->behind, near, far)), vi_truncate(v_select(side->behind, far, near)));
}

/* Places of an edge whose outward normal is `normal`, seen along n. */
INLINE void place_box_edge(struct edge *edge, const struct box_side *side, vec2 normal, vf radius, vec2 n,
                           vf arc_radius, bool turned) {
    const vec2 step = v2_scale(normal, radius);
    const vec2 low = v2_add(turned ? side->high : side->low, step),
               high = v2_add(turned ? side->low : side->high, step);
    edge->low = (struct edge_end){v2_cross(n, low), v2_dot(n, low), arc_radius};
    edge->high = (struct edge_end){v2_cross(n, high), v2_dot(n, high), arc_radius};
}

/* The edge of a box as find_manifold_points() takes it. That of a capsule may lie along n, and then not look like an edge
 * from there: the one on the other side is asked. */
INLINE struct edge find_box_edge(const struct box_pair *pair, const struct box_side *side,
                                 const struct box_touch *touch, vec2 n, vf flat_sine, int shift, bool is_b) {
    const vf radius = is_b ? v_neg(touch->radius) : touch->radius;
    struct edge edge = {.is_edge = vm_front(V_WIDTH),
                        .offered = v_le(v_abs(touch->sine), flat_sine),
                        .parallel = touch->parallel,
                        .before = find_box_arc(pair, vi_sub(side->edge, vi_set(1)), shift),
                        .after = find_box_arc(pair, side->edge, shift),
                        .arc_radius = radius};
    place_box_edge(&edge, side, side->normal, touch->radius, n, radius, false);
    if (pair->capsules) {
        edge.is_edge = v_lt(edge.low.along, edge.high.along);
        edge.offered = vm_and(edge.offered, edge.is_edge);
        const vm again = vm_not(edge.is_edge);
        if (vm_any(again)) {
            struct edge other;
            place_box_edge(&other, side, (vec2){v_neg(side->normal.x), v_neg(side->normal.y)}, touch->radius, n, radius,
                           true);
            edge.low = select_edge_end(again, &other.low, &edge.low);
            edge.high = select_edge_end(again, &other.high, &edge.high);
            edge.is_edge = v_lt(edge.low.along, edge.high.along);
        }
    }
    return edge;
}

INLINE struct sides find_box_sides(const struct call *call, const struct box_pair *pair, const struct box_contact *c,
                                   const struct box_touch *on_a, const struct box_touch *on_b, vec2 place, vf margin) {
    const vf flat_sine = v_set(call->batch->flat_sine);
    return (struct sides){.a = find_box_edge(pair, &c->a, on_a, c->normal, flat_sine, 4, false),
                          .b = find_box_edge(pair, &c->b, on_b, c->normal, flat_sine, 6, true),
                          .number_a = find_box_arc(pair, find_box_touching(&c->a), 4),
                          .number_b = find_box_arc(pair, find_box_touching(&c->b), 6),
                          .n = c->normal,
                          .to_world = get_box_vec2(pair, BOX_ROTATION_A),
                          .position_b = get_box_vec2(pair, BOX_POSITION),
                          .place = place,
                          .margin = margin,
                          .named = vm_front(V_WIDTH)};
}

/* The places of rows: behind those that are listed if all pairs before the last one are answered. From the first vector
 * on of which that is not so no row is listed. */
INLINE void find_box_places(const struct call *call, const struct box_queue *queue, int last, vi pairs, vm keep,
                            char *place[V_WIDTH]) {
    struct rows *rows = call->rows;
    int32_t pair;
    memcpy(&pair, &queue->item[BOX_PAIR][last], sizeof pair);
    if (pair < rows->done) {
        find_next_places(rows, keep, place);
    } else {
        rows->done = -1;
        find_places(call, pairs, keep, place);
    }
}

/* Writes the rows of pairs in the lanes `keep`, of which the first `live` are asked of. */
INLINE void write_boxes(const struct call *call, const struct box_pair *pair, const struct box_contact *c, int live,
                        vm keep, vf margin, bool edges) {
    const vi pairs = vi_bits(get_box_field(pair, BOX_PAIR));
    const vec2 n = c->normal, to_world = get_box_vec2(pair, BOX_ROTATION_A);
    const struct box_touch on_a = find_touch(&c->a, n, get_box_field(pair, BOX_RADIUS_A), false);
    const struct box_touch on_b = find_touch(&c->b, n, v_neg(get_box_field(pair, BOX_RADIUS_B)), true);
    const vf half = v_set(0.5f), flat = v_set(INFINITY), across = v_mul(half, v_add(on_a.across, on_b.across));
    const vec2 place = {across, v_mul(half, v_add(v_max(on_a.min, on_b.min), v_min(on_a.max, on_b.max)))};
    const vi of_a = find_box_feature(pair, &c->a, &on_a, 4), of_b = find_box_feature(pair, &c->b, &on_b, 6);
    struct answer answer = {.separation = c->separation,
                            .normal = v2_rotate(to_world, n),
                            .point = v2_rotate(to_world, v2_rotate(n, place)),
                            .feature = vi_add(of_a, vi_shift_left(of_b, 8)),
                            .radius_a = v_select(on_a.parallel, flat, get_box_field(pair, BOX_RADIUS_A)),
                            .radius_b = v_select(on_b.parallel, flat, get_box_field(pair, BOX_RADIUS_B))};
    char *to[V_WIDTH];
    find_box_places(call, pair->queue, pair->k + live - 1, pairs, keep, to);
    if (edges) {
        const struct sides sides = find_box_sides(call, pair, c, &on_a, &on_b, place, margin);
        answer.reach_a = find_box_reach(pair, &c->a, &on_a);
        answer.reach_b = find_box_reach(pair, &c->b, &on_b);
        write_sides(call, to, pairs, &answer, &sides);
    } else {
        write_rows(call, to, find_numbers(call, pairs), &answer);
    }
}

/* Answers the pairs k ... of a queue, or returns false. `edges`: are second points asked for? */
INLINE bool answer_boxes(const struct call *call, const struct box_queue *queue, int k, int live, bool capsules,
                         bool edges) {
    const struct box_pair pair = {queue, k, capsules};
    const vf margin = find_margins(call, vi_bits(get_box_field(&pair, BOX_PAIR)));
    const vm open = vm_front(live);
    const struct box_contact c = capsules ? find_capsule_contact(&pair, open) : find_box_contact(&pair, open);
    const vm keep = vm_and(open, is_below(c.separation, margin));
    if (BLOCK == 1 && vm_any(c.left))
        return false;
    if (vm_any(keep))
        write_boxes(call, &pair, &c, live, keep, margin, edges);
    return true;
}

#endif
