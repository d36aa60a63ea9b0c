/* SPDX-License-Identifier: MIT
 *
 * manifold_edges.inl - of manifolds, the second point, where a straight edge of A faces one of B, and the ids of both.
 *
 * Seen along the tangent t, the normal n turned a quarter turn counter-clockwise, A's upper outline is a concave height
 * function and B's lower one a convex one. Their distance is convex; its least value is the separation, at the deepest
 * point. It stays small along the common stretch of two edges that are nearly across n. So each body offers the edge
 * next to its touching arc whose normal is closest to n, if that is within the flat angle; the stretch of t that both
 * edges cover is joined with the deepest point, and its ends are the two points. On A t rises from an edge's start to
 * its end, and on B it falls.
 */
#ifndef NARC_SAT_MANIFOLD_EDGES_INL
#define NARC_SAT_MANIFOLD_EDGES_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/ends.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

struct edge {
    vm is_edge;             /* is it more than rounding? */
    vm offered;             /* and its normal within the flat angle of n? */
    vm parallel;            /* n is the edge's normal */
    end_pair along, across; /* in the order of t */
    end_pair radius;        /* of the arcs there */
    vi before, after;       /* the numbers of the arcs at its start and at its counter-clockwise end */
    vf arc_radius;          /* of the touching arc */
};

/* Two bodies that touch along n with the arcs of these numbers, next to these edges. */
struct sides {
    struct edge a, b;
    vi number_a, number_b;
    vec2 n, to_world, position_b, place; /* place: of the contact point, across and along */
    vf margin;
    vm named; /* has an edge that touches its say in the id of an only point? */
};

/* Outwards along n: B is touched on its side -n. */
INLINE vf turn_radius(vf radius, bool is_b) { return is_b ? v_neg(radius) : radius; }

/* The points of two arcs with a normal, seen along n: their places along t, and across it. */
INLINE end_pair find_along(vec2 low, vec2 high, vf radius_low, vf radius_high, vec2 normal, vec2 n, bool is_b,
                           end_pair *out_across) {
    const end_pair radius = join_ends(turn_radius(radius_low, is_b), turn_radius(radius_high, is_b));
    const end_pair n_x = both_ends(n.x), n_y = both_ends(n.y);
    const end_pair x = add_ends(join_ends(low.x, high.x), mul_ends(both_ends(normal.x), radius)),
                   y = add_ends(join_ends(low.y, high.y), mul_ends(both_ends(normal.y), radius));
    *out_across = add_ends(mul_ends(n_x, x), mul_ends(n_y, y));
    return sub_ends(mul_ends(n_x, y), mul_ends(n_y, x));
}

/* Where an edge with this normal lies, from the centre of one arc to that of another. */
INLINE void place_edge(struct edge *edge, vec2 low, vec2 high, vf radius_low, vf radius_high, vec2 normal, vec2 n,
                       bool is_b) {
    edge->along = find_along(low, high, radius_low, radius_high, normal, n, is_b, &edge->across);
    edge->radius = join_ends(radius_low, radius_high);
    edge->is_edge = v_lt(get_low(edge->along), get_high(edge->along));
}

/* Takes the places of another edge where this is none. */
INLINE void take_places(struct edge *edge, const struct edge *other) {
    const mask_pair keeps = join_masks(edge->is_edge, edge->is_edge);
    edge->along = select_ends(keeps, edge->along, other->along);
    edge->across = select_ends(keeps, edge->across, other->across);
    edge->radius = select_ends(keeps, edge->radius, other->radius);
    edge->is_edge = vm_or(edge->is_edge, other->is_edge);
}

/* An arc in its shape's own frame, and placed. */
struct own_arc {
    vec2 center, start, end;
    struct arcs placed;
};

INLINE struct own_arc load_own_arc(const narc_record *records, vi record, const struct pose *pose, bool is_b) {
    vf field[8];
    load_records(records, record, field);
    return (struct own_arc){{field[0], field[1]},
                            {field[4], field[5]},
                            {field[6], field[7]},
                            is_b ? place_b(field, pose) : place_a(field, pose)};
}

/* Is there an edge at the junction of two arcs, and not only rounding, or arcs that were given a little apart? */
INLINE vm is_edge(const struct own_arc *arc, const struct own_arc *other, vec2 junction, vf least_edge) {
    return v_lt(least_edge, v_abs(v2_cross(junction, v2_sub(other->center, arc->center))));
}

/* Is the normal of a junction within the flat angle of n? */
INLINE vm is_flat(vec2 junction, vec2 n, vf flat_sine) {
    return vm_and(v_le(v_abs(v2_cross(junction, n)), flat_sine), v_lt(v_set(0), v2_dot(junction, n)));
}

/* The edge at the end of an arc, in the lanes `at_end`, or at its start. */
INLINE struct edge find_edge_of(const narc_record *records, struct ring ring, vi record, const struct own_arc *arc,
                                const struct pose *pose, vec2 n, vm at_end, vf least_edge, vf flat_sine, bool is_b) {
    const vi next = step_record(ring, record, vi_select(at_end, vi_set(1), vi_set(-1)));
    const struct own_arc other = load_own_arc(records, next, pose, is_b);
    const vec2 junction = v2_select(at_end, arc->placed.end, arc->placed.start);
    const vm here_is_low = is_b ? vm_not(at_end) : at_end;
    const struct arcs *const here = &arc->placed, *const there = &other.placed;
    struct edge edge;
    place_edge(&edge, v2_select(here_is_low, here->center, there->center),
               v2_select(here_is_low, there->center, here->center), v_select(here_is_low, here->radius, there->radius),
               v_select(here_is_low, there->radius, here->radius), junction, n, is_b);
    edge.is_edge = vm_and(edge.is_edge, is_edge(arc, &other, v2_select(at_end, arc->end, arc->start), least_edge));
    edge.offered = vm_and(edge.is_edge, is_flat(junction, n, flat_sine));
    edge.parallel = is_parallel(junction, n);
    edge.before = vi_select(at_end, record, next);
    edge.after = vi_select(at_end, next, record);
    edge.arc_radius = arc->placed.radius;
    return edge;
}

/* The caller's number of an arc of A or B. */
INLINE vi find_number_of(const struct queue *queue, int k, vi record, bool is_b) {
    return find_arc_number(record, get_bits(queue, is_b ? FIRST_RECORD_B : FIRST_RECORD_A, k),
                           get_bits(queue, is_b ? INFO_B : INFO_A, k));
}

/* The edge next to the arc in `record`: of two the one closer to n, of equals the one at the arc's end. Where that is
 * none, because the arc and its neighbour have a common tangent, the other one. */
SHARED struct edge find_edge(const struct call *call, const struct queue *queue, int k, vi record, vec2 n, bool is_b) {
    const narc_record *records = call->batch->shapes->records;
    const struct ring ring = is_b ? get_ring_b(queue, k) : get_ring_a(queue, k);
    const struct pose pose = get_pose(queue, k);
    const struct own_arc arc = load_own_arc(records, record, &pose, is_b);
    const vf least_edge = find_least_edge(get_bits(queue, is_b ? INFO_B : INFO_A, k));
    const vf flat_sine = v_set(call->batch->flat_sine), zero = v_set(0);
    const vec2 start = arc.placed.start, end = arc.placed.end;
    const vm start_faces = v_lt(zero, v2_dot(start, n)), end_faces = v_lt(zero, v2_dot(end, n));
    const vm start_closer = v_lt(v_abs(v2_cross(start, n)), v_abs(v2_cross(end, n)));
    const vm at_end = vm_not(vm_and_not(start_faces, vm_and_not(end_faces, start_closer)));
    struct edge edge = find_edge_of(records, ring, record, &arc, &pose, n, at_end, least_edge, flat_sine, is_b);
    const vm again = vm_not(edge.is_edge);
    if (vm_any(again)) {
        const struct edge other =
            find_edge_of(records, ring, record, &arc, &pose, n, vm_not(at_end), least_edge, flat_sine, is_b);
        edge.offered = vm_or(edge.offered, vm_and(again, other.offered));
        edge.parallel = vm_or(vm_and_not(edge.parallel, again), vm_and(again, other.parallel));
        take_places(&edge, &other);
        edge.before = vi_select(again, other.before, edge.before);
        edge.after = vi_select(again, other.after, edge.after);
    }
    edge.before = find_number_of(queue, k, edge.before, is_b);
    edge.after = find_number_of(queue, k, edge.after, is_b);
    return edge;
}

/* The heights of an edge above places. */
INLINE end_pair find_edge_heights(const struct edge *edge, end_pair along) {
    const vf low = get_low(edge->along), across = get_low(edge->across);
    const vf slope = v_div(v_sub(get_high(edge->across), across), v_sub(get_high(edge->along), low));
    return add_ends(both_ends(across), mul_ends(sub_ends(along, both_ends(low)), both_ends(slope)));
}

/* The points where the edges' common stretch ends. The body whose edge ends there has the arc next to it. */
struct end_points {
    end_pair along, across, separation, radius_a, radius_b;
};

INLINE struct end_points find_end_points(const struct edge *a, const struct edge *b) {
    const end_pair a_then_b = pick_ends(a->along, b->along), b_then_a = pick_ends(b->along, a->along);
    const mask_pair a_ends = ends_are_at_most(b_then_a, a_then_b), b_ends = ends_are_at_most(a_then_b, b_then_a);
    const end_pair half = both_ends(v_set(0.5f)), flat = both_ends(v_set(INFINITY));
    struct end_points p = {.along = select_ends(a_ends, a->along, b->along)};
    const end_pair height_a = find_edge_heights(a, p.along), height_b = find_edge_heights(b, p.along);
    p.separation = sub_ends(height_b, height_a);
    p.across = mul_ends(half, add_ends(height_a, height_b));
    p.radius_a = select_ends(a_ends, a->radius, flat);
    p.radius_b = select_ends(b_ends, b->radius, flat);
    return p;
}

/* The coordinates that a stretch was computed from, seen from an origin. */
INLINE vf add_coordinates(const struct end_points *p, vf along, vf across) {
    const end_pair from_origin = find_distances(p->along, both_ends(along));
    return v_add(v_add(get_low(from_origin), get_high(from_origin)), find_distance(get_low(p->across), across));
}

/* Is the common stretch more than rounding? Where two corners face each other both edges end there, and it is not. Both
 * bodies' origins count, so that it is the same with A and B swapped. */
INLINE vm is_stretch(const struct end_points *p, vf separation, vec2 n, vec2 position_b) {
    const vf of_a = add_coordinates(p, v_set(0), v_set(0));
    const vf of_b = add_coordinates(p, v2_cross(n, position_b), v2_dot(n, position_b));
    const vf sizes = v_add(v_add(of_a, of_b), v_abs(separation));
    return v_lt(v_mul(v_set(LEAST_STRETCH), sizes), v_sub(get_high(p->along), get_low(p->along)));
}

/* Ids. A point is at the low or the high end of both bodies' edges. A byte of its id names what of a body lies there:
 * the arc at that end of its edge, if the point is no further from it than this part of the edge, or else the edge.
 * That much is for two corners that face each other, as in a stack of equal boxes: either may end the common stretch,
 * as rounding has it, and so both are named. */
#define AT_END 0x1p-5f

/* The bytes of a body's edge, of points at its low end and at its high one. */
INLINE end_pair find_edge_features(const struct edge *edge, end_pair along, bool is_b) {
    const vf length = v_sub(get_high(edge->along), get_low(edge->along)), before = v_of_bits(edge->before),
             after = v_of_bits(edge->after);
    const end_pair inside = sub_ends(pick_ends(along, edge->along), pick_ends(edge->along, along));
    const mask_pair on_edge = ends_are_less(both_ends(v_mul(v_set(AT_END), length)), inside);
    const end_pair of_edge = both_ends(v_of_bits(vi_add(edge->after, vi_set(NARC_FEATURE_EDGE))));
    return select_ends(on_edge, of_edge, is_b ? join_ends(after, before) : join_ends(before, after));
}

/* Both bodies' bytes in one id. */
INLINE vf join_bytes(vf a, vf b) { return v_of_bits(vi_add(vi_bits(a), vi_shift_left(vi_bits(b), 8))); }

OF_ENDS(end_pair, end_pair, find_ids, join_bytes)

/* Does a body touch the other one with its edge? */
INLINE vm touches(const struct edge *edge) { return vm_and(edge->is_edge, edge->parallel); }

INLINE vm is_nearer_low(end_pair along, vf place) {
    const end_pair away = find_distances(along, both_ends(place));
    return v_le(get_low(away), get_high(away));
}

/* The byte of the body with `edge`, of the only point of two bodies, at `along`, where it has the arc `number`. A body
 * that touches with its edge does so at the end where the other one's corner has its own edge beside it: so the id is
 * that of the same point with the other edge within the flat angle. */
INLINE vf find_touching_feature(const struct edge *edge, const struct edge *other, vf along, vi number, bool is_b) {
    const vm corner = vm_and_not(other->is_edge, other->parallel), near_low = is_nearer_low(edge->along, along);
    const vm low = vm_or(vm_and(corner, is_nearer_low(other->along, along)), vm_and_not(near_low, corner));
    const end_pair features = find_edge_features(edge, both_ends(along), is_b);
    return v_select(touches(edge), v_select(low, get_low(features), get_high(features)), v_of_bits(number));
}

/* The id of the only point of two bodies. */
INLINE vi find_only_id(const struct sides *s, const struct answer *answer) {
    const vf id = join_bytes(find_touching_feature(&s->a, &s->b, s->place.y, s->number_a, false),
                             find_touching_feature(&s->b, &s->a, s->place.y, s->number_b, true));
    return vi_select(s->named, vi_bits(id), answer->feature);
}

/* Writes the rows of manifolds that may have second points. */
SHARED void write_sides(const struct call *call, char *const *place, vi pairs, const struct answer *answer,
                        const struct sides *s) {
    const struct edge *const a = &s->a, *const b = &s->b;
    const vi numbers = find_numbers(call, pairs);
    const vm offered = vm_and(a->offered, b->offered);
    if (!vm_any(offered)) {
        struct answer only = *answer;
        only.point = v2_rotate(s->to_world, v2_rotate(s->n, s->place));
        only.feature = find_only_id(s, answer);
        write_only_points(place, numbers, &only);
        return;
    }
    struct end_points p = find_end_points(a, b);
    const vf along = s->place.y, least = answer->separation, flat = v_set(INFINITY);
    const vm alone = vm_not(vm_and(offered, is_stretch(&p, least, s->n, s->position_b)));
    /* The end that is the deepest point. Where the edges touch, the places are the stretch's ends. */
    const vm touch = vm_and_not(vm_and(a->parallel, b->parallel), alone);
    const vm lower_low = v_le(get_low(p.separation), get_high(p.separation)), near_low = is_nearer_low(p.along, along);
    const vm at_low = vm_or(alone, vm_or(vm_and(touch, lower_low), vm_and_not(near_low, touch))),
             at_high = vm_not(at_low);
    const end_pair above = max_ends(p.separation, both_ends(least)); /* rounding may not make the other one less */
    const float asked = call->batch->query->second_margin;
    const vf margin = v_max(s->margin, v_set(asked == 0 ? -INFINITY : asked));
    const vm near = is_below(v_select(at_low, get_high(above), get_low(above)), margin);
    const vm two = vm_and_not(near, alone);
    const mask_pair exact = join_masks(vm_and_not(at_low, touch), vm_and_not(at_high, touch));
    p.along = select_ends(exact, both_ends(along), p.along);
    p.across = select_ends(exact, both_ends(s->place.x), p.across);
    end_pair ids = find_ids(find_edge_features(a, p.along, false), find_edge_features(b, p.along, true));
    if (vm_any(alone)) {
        const vf id = v_of_bits(find_only_id(s, answer));
        ids = join_ends(v_select(alone, id, get_low(ids)), get_high(ids));
    }
    end_pair words[4] = {p.across, p.along, select_ends(join_masks(at_low, at_high), both_ends(least), above), ids};
    rotate_ends(s->n, &words[0], &words[1]);
    rotate_ends(s->to_world, &words[0], &words[1]);
    v_put_ends(place, FIRST_POINT, words, vm_or(two, at_low), two);
    const vf radius_a = v_select(touch, v_select(at_low, get_low(p.radius_a), get_high(p.radius_a)),
                                 v_select(a->parallel, flat, a->arc_radius)),
             radius_b = v_select(touch, v_select(at_low, get_low(p.radius_b), get_high(p.radius_b)),
                                 v_select(b->parallel, flat, b->arc_radius));
    write_heads(place, numbers, answer, vi_select(two, vi_set(2), vi_set(1)),
                v_select(alone, answer->radius_a, radius_a), v_select(alone, answer->radius_b, radius_b));
}

/* The edges of the pairs k ... of a queue that touch along n with the arcs in these records. */
INLINE void find_sides(const struct call *call, const struct queue *queue, int k, vi record_a, vi record_b, vec2 n,
                       vec2 place, struct sides *s) {
    s->a = find_edge(call, queue, k, record_a, n, false);
    s->b = find_edge(call, queue, k, record_b, n, true);
    s->number_a = find_number_of(queue, k, record_a, false);
    s->number_b = find_number_of(queue, k, record_b, true);
    s->n = n;
    s->to_world = get_vec2(queue, ROTATION_A, k);
    s->position_b = get_vec2(queue, POSITION, k);
    s->place = place;
    s->margin = get_margins(call, queue, k);
    s->named = vm_or(touches(&s->a), touches(&s->b));
}

#endif
