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

/* The arcs at both ends of a side, in the order of `low` and `high`, and that of the two that touches: their radii, and
 * the caller's numbers of the one before the edge and of the one behind it. */
struct side_arcs {
    vf radius_low, radius_high, radius;
    vi before, behind;
};

/* What a side touches the other one with: a corner, or its edge. */
struct box_touch {
    const struct side_arcs *arcs;
    vm parallel;         /* n is the edge's normal */
    vf sine, cosine;     /* from the edge's normal to n */
    vf across, min, max; /* as of a feature */
};

INLINE void find_touch(const struct box_side *side, vec2 n, const struct side_arcs *arcs, bool is_b,
                       struct box_touch *out) {
    end_pair across;
    const end_pair along = find_along(side->low, side->high, arcs->radius_low, arcs->radius_high, n, n, is_b, &across);
    const vm at_low = is_b ? side->behind : vm_not(side->behind);
    out->arcs = arcs;
    out->sine = v2_cross(side->normal, n);
    out->cosine = v2_dot(side->normal, n);
    out->parallel = v_le(v_abs(out->sine), v_set(PARALLEL));
    out->across = v_select(at_low, get_low(across), get_high(across));
    out->min = v_select(vm_or(at_low, out->parallel), get_low(along), get_high(along));
    out->max = v_select(vm_and_not(at_low, out->parallel), get_low(along), get_high(along));
}

/* The caller's number of corner i, or of the edge before it. Of a capsule the arc at -x, its corners 1 and 2, is stored
 * first. */
INLINE vi number_box_arc(vi i, vi first, bool capsules) {
    return capsules ? vi_and(vi_add(vi_shift_right(vi_add(i, vi_set(3)), 1), first), vi_set(1))
                    : vi_and(vi_add(i, first), vi_set(3));
}

/* Of both boxes the radius of all corners. */
INLINE struct side_arcs find_box_arcs(const struct box_pair *pair, const struct box_side *side, bool is_b) {
    const vf radius = get_box_field(pair, is_b ? BOX_RADIUS_B : BOX_RADIUS_A);
    const vi first = vi_shift_right(get_box_code(pair), is_b ? 6 : 4);
    return (struct side_arcs){radius, radius, radius,
                              number_box_arc(vi_sub(side->edge, vi_set(1)), first, pair->capsules),
                              number_box_arc(side->edge, first, pair->capsules)};
}

INLINE vi find_touching_arc(const struct box_side *side, const struct box_touch *touch) {
    return vi_select(side->behind, touch->arcs->behind, touch->arcs->before);
}

/* What touches, as a contact has it. */
INLINE vi find_box_feature(const struct box_side *side, const struct box_touch *touch) {
    return vi_select(touch->parallel, vi_add(touch->arcs->behind, vi_set(NARC_FEATURE_EDGE)),
                     find_touching_arc(side, touch));
}

/* The reaches of a corner, as find_reach() has them, with the edge next to it. */
INLINE vi find_box_reach(const struct box_side *side, const struct box_touch *touch, bool capsules) {
    const vf zero = v_set(0), one = v_set(1), full = v_set(NARC_REACH_ONE);
    if (BLOCK > 1 && !vm_any(vm_not(touch->parallel))) /* of one pair it can't be foreseen */
        return vi_set(0);
    const vf turn = v_select(side->behind, touch->sine, v_neg(touch->sine)); /* away from the edge */
    vf sine = v_min(v_max(turn, zero), one), other = v_select(v_lt(zero, turn), v_min(touch->cosine, one), one);
    if (capsules) { /* the other edge is half a turn away */
        sine = v_select(v_lt(zero, touch->cosine), sine, one);
        other = one;
    }
    const vf near = v_select(touch->parallel, zero, v_mul(full, sine));
    other = v_mul(full, other);
    const vf far = v_select(touch->parallel, zero, other);
    return pack_halves(vi_truncate(v_select(side->behind, near, far)), vi_truncate(v_select(side->behind, far, near)));
}

/* The edge of a side as write_sides() takes it. That of a capsule may lie along n, and then not look like an edge
 * from there: the one on the other side is asked. */
INLINE struct edge find_box_edge(const struct box_side *side, const struct box_touch *touch, vec2 n, vf flat_sine,
                                 bool capsules, bool is_b) {
    const struct side_arcs *const arcs = touch->arcs;
    struct edge edge = {.offered = v_le(v_abs(touch->sine), flat_sine),
                        .parallel = touch->parallel,
                        .before = arcs->before,
                        .after = arcs->behind,
                        .arc_radius = arcs->radius};
    place_edge(&edge, side->low, side->high, arcs->radius_low, arcs->radius_high, side->normal, n, is_b);
    if (!capsules)
        edge.is_edge = vm_front(V_WIDTH);
    edge.offered = vm_and(edge.offered, edge.is_edge);
    if (capsules && vm_any(vm_not(edge.is_edge))) {
        const vec2 back = {v_neg(side->normal.x), v_neg(side->normal.y)};
        struct edge other;
        place_edge(&other, side->high, side->low, arcs->radius_low, arcs->radius_high, back, n, is_b);
        take_places(&edge, &other);
    }
    return edge;
}

/* Two sides that touch: their arcs, the pairs, A's rotation in the world, and B's position in A's frame. */
struct touching_sides {
    struct side_arcs a, b;
    vi pairs;
    vec2 to_world, position_b;
    bool capsules;
    const vi *reaches; /* of both, as rows have them; NULL: of capsules, or boxes */
};

/* What rows say of them; the answer's point is only found where it is written. */
struct told_sides {
    struct box_touch a, b;
    vec2 place;
    struct answer answer;
};

INLINE void tell_sides(const struct box_contact *c, const struct touching_sides *t, struct told_sides *out) {
    const vec2 n = c->normal;
    find_touch(&c->a, n, &t->a, false, &out->a);
    find_touch(&c->b, n, &t->b, true, &out->b);
    const struct box_touch *const on_a = &out->a, *const on_b = &out->b;
    const vf half = v_set(0.5f), flat = v_set(INFINITY), across = v_mul(half, v_add(on_a->across, on_b->across));
    out->place = (vec2){across, v_mul(half, v_add(v_max(on_a->min, on_b->min), v_min(on_a->max, on_b->max)))};
    out->answer.separation = c->separation;
    out->answer.normal = v2_rotate(t->to_world, n);
    out->answer.feature = vi_add(find_box_feature(&c->a, on_a), vi_shift_left(find_box_feature(&c->b, on_b), 8));
    out->answer.radius_a = v_select(on_a->parallel, flat, t->a.radius);
    out->answer.radius_b = v_select(on_b->parallel, flat, t->b.radius);
    out->answer.reach_a = out->answer.reach_b = vi_set(0);
}

/* Writes them. `edges`: are second points asked for? */
INLINE void write_touching(const struct call *call, const struct box_contact *c, const struct touching_sides *t,
                           const struct told_sides *told, vf margin, char *const *place, bool edges) {
    const vec2 n = c->normal;
    struct answer answer = told->answer; /* what is known so far stays in registers */
    if (!edges) {
        answer.point = v2_rotate(t->to_world, v2_rotate(n, told->place));
        write_rows(call, place, find_numbers(call, t->pairs), &answer);
        return;
    }
    const vf flat_sine = v_set(call->batch->flat_sine);
    const struct sides sides = {.a = find_box_edge(&c->a, &told->a, n, flat_sine, t->capsules, false),
                                .b = find_box_edge(&c->b, &told->b, n, flat_sine, t->capsules, true),
                                .number_a = find_touching_arc(&c->a, &told->a),
                                .number_b = find_touching_arc(&c->b, &told->b),
                                .n = n,
                                .to_world = t->to_world,
                                .position_b = t->position_b,
                                .place = told->place,
                                .margin = margin,
                                .named = vm_front(V_WIDTH)};
    answer.reach_a = t->reaches ? t->reaches[0] : find_box_reach(&c->a, &told->a, t->capsules);
    answer.reach_b = t->reaches ? t->reaches[1] : find_box_reach(&c->b, &told->b, t->capsules);
    write_sides(call, place, t->pairs, &answer, &sides);
}

/* The places of rows: behind those that are listed if all pairs before the last one are answered. From the first vector
 * on of which that is not so no row is listed. */
INLINE void find_box_places(const struct call *call, const struct box_queue *queue, int last, vi pairs, vm keep,
                            char *place[V_WIDTH]) {
    struct rows *rows = call->rows;
    int32_t pair;
    memcpy(&pair, &queue->item[BOX_PAIR][last], sizeof pair);
    if (BLOCK > 1 && pair < rows->done) {
        find_next_places(rows, keep, place);
    } else {
        rows->done = -1;
        find_places(call, pairs, keep, place);
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
    if (!vm_any(keep))
        return true;
    const struct touching_sides sides = {.a = find_box_arcs(&pair, &c.a, false),
                                         .b = find_box_arcs(&pair, &c.b, true),
                                         .pairs = vi_bits(get_box_field(&pair, BOX_PAIR)),
                                         .to_world = get_box_vec2(&pair, BOX_ROTATION_A),
                                         .position_b = get_box_vec2(&pair, BOX_POSITION),
                                         .capsules = capsules};
    char *place[V_WIDTH];
    struct told_sides told;
    tell_sides(&c, &sides, &told);
    find_box_places(call, queue, k + live - 1, sides.pairs, keep, place);
    write_touching(call, &c, &sides, &told, margin, place, edges);
    return true;
}

#endif
