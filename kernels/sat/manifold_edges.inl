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
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* One end of an edge: its place along t and across it, and the radius of the arc next to it. */
struct edge_end {
    vf along, across, radius;
};

struct edge {
    vm is_edge;                /* is it more than rounding? */
    vm offered;                /* and its normal within the flat angle of n? */
    vm parallel;               /* n is the edge's normal */
    struct edge_end low, high; /* in the order of t */
    vi before, after;          /* the numbers of the arcs at its start and at its counter-clockwise end */
    vf arc_radius;             /* of the touching arc */
};

/* Two bodies that touch along n with the arcs of these numbers, next to these edges. */
struct sides {
    struct edge a, b;
    vi number_a, number_b;
    vec2 n, to_world, position_b, place; /* place: of the contact point, across and along */
    vf margin;
    vm named; /* has an edge that touches its say in the id of an only point? */
};

INLINE struct edge_end find_edge_end(const struct arcs *arc, vec2 junction, vec2 n, bool is_b) {
    const vec2 point = find_point(arc, junction, is_b);
    return (struct edge_end){v2_cross(n, point), v2_dot(n, point), arc->radius};
}

INLINE struct edge_end select_edge_end(vm m, const struct edge_end *a, const struct edge_end *b) {
    return (struct edge_end){v_select(m, a->along, b->along), v_select(m, a->across, b->across),
                             v_select(m, a->radius, b->radius)};
}

/* An arc in its shape's own frame, and placed. */
struct own_arc {
    vec2 center, start, end;
    vf radius;
    struct arcs placed;
};

INLINE struct own_arc load_own_arc(const narc_record *records, vi record, const struct pose *pose, bool is_b) {
    vf field[8];
    load_records(records, record, field);
    return (struct own_arc){{field[0], field[1]},
                            {field[4], field[5]},
                            {field[6], field[7]},
                            field[2],
                            is_b ? place_b(field, pose) : place_a(field, pose)};
}

/* The same without normals. */
INLINE struct own_arc load_own_circle(const narc_record *records, vi record, const struct pose *pose, bool is_b) {
    int32_t index[V_WIDTH];
    vf field[4];
    vi_store(index, record);
    v_rows(records, sizeof *records, index, field);
    struct own_arc arc = {.center = {field[0], field[1]}, .radius = field[2]};
    arc.placed.center = is_b ? place_center_b(arc.center, pose) : v2_scale(arc.center, pose->scale_a);
    arc.placed.radius = v_mul(field[2], is_b ? pose->scale_b : pose->scale_a);
    return arc;
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
    const struct own_arc other = load_own_circle(records, next, pose, is_b);
    const vec2 junction = v2_select(at_end, arc->placed.end, arc->placed.start);
    const struct edge_end here = find_edge_end(&arc->placed, junction, n, is_b),
                          there = find_edge_end(&other.placed, junction, n, is_b);
    const vm here_is_low = is_b ? vm_not(at_end) : at_end;
    struct edge edge;
    edge.low = select_edge_end(here_is_low, &here, &there);
    edge.high = select_edge_end(here_is_low, &there, &here);
    edge.is_edge = vm_and(is_edge(arc, &other, v2_select(at_end, arc->end, arc->start), least_edge),
                          v_lt(edge.low.along, edge.high.along));
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
        edge.is_edge = vm_or(edge.is_edge, other.is_edge);
        edge.offered = vm_or(edge.offered, vm_and(again, other.offered));
        edge.parallel = vm_or(vm_and_not(edge.parallel, again), vm_and(again, other.parallel));
        edge.low = select_edge_end(again, &other.low, &edge.low);
        edge.high = select_edge_end(again, &other.high, &edge.high);
        edge.before = vi_select(again, other.before, edge.before);
        edge.after = vi_select(again, other.after, edge.after);
    }
    edge.before = find_number_of(queue, k, edge.before, is_b);
    edge.after = find_number_of(queue, k, edge.after, is_b);
    return edge;
}

/* The height of an edge above the place `along`. */
INLINE vf find_height(const struct edge *edge, vf along) {
    const vf rise = v_sub(edge->high.across, edge->low.across), run = v_sub(edge->high.along, edge->low.along);
    return v_add(edge->low.across, v_mul(v_sub(along, edge->low.along), v_div(rise, run)));
}

/* A point of a manifold. */
struct end_point {
    vf along, across, separation, radius_a, radius_b;
};

/* The point where the edges' common stretch ends, at its low end or its high one. The body whose edge ends there has
 * the arc next to it. */
INLINE struct end_point find_end_point(const struct edge *a, const struct edge *b, bool high) {
    const struct edge_end *end_a = high ? &a->high : &a->low, *end_b = high ? &b->high : &b->low;
    const vf flat = v_set(INFINITY);
    const vm a_ends = high ? v_le(end_a->along, end_b->along) : v_le(end_b->along, end_a->along);
    const vm b_ends = high ? v_le(end_b->along, end_a->along) : v_le(end_a->along, end_b->along);
    struct end_point p;
    p.along = v_select(a_ends, end_a->along, end_b->along);
    const vf height_a = find_height(a, p.along), height_b = find_height(b, p.along);
    p.separation = v_sub(height_b, height_a);
    p.across = v_mul(v_set(0.5f), v_add(height_a, height_b));
    p.radius_a = v_select(a_ends, end_a->radius, flat);
    p.radius_b = v_select(b_ends, end_b->radius, flat);
    return p;
}

INLINE struct end_point select_end_point(vm m, const struct end_point *a, const struct end_point *b) {
    return (struct end_point){v_select(m, a->along, b->along), v_select(m, a->across, b->across),
                              v_select(m, a->separation, b->separation), v_select(m, a->radius_a, b->radius_a),
                              v_select(m, a->radius_b, b->radius_b)};
}

/* The coordinates that a stretch was computed from, seen from an origin. */
INLINE vf add_coordinates(const struct end_point *low, const struct end_point *high, vf along, vf across) {
    const vf ends = v_add(v_abs(v_sub(low->along, along)), v_abs(v_sub(high->along, along)));
    return v_add(ends, v_abs(v_sub(low->across, across)));
}

/* Is the common stretch more than rounding? Where two corners face each other both edges end there, and it is not. Both
 * bodies' origins count, so that it is the same with A and B swapped. */
INLINE vm is_stretch(const struct end_point *low, const struct end_point *high, vf separation, vec2 n,
                     vec2 position_b) {
    const vf of_a = add_coordinates(low, high, v_set(0), v_set(0));
    const vf of_b = add_coordinates(low, high, v2_cross(n, position_b), v2_dot(n, position_b));
    const vf sizes = v_add(v_add(of_a, of_b), v_abs(separation));
    return v_lt(v_mul(v_set(LEAST_STRETCH), sizes), v_sub(high->along, low->along));
}

/* Ids. A point is at the low or the high end of both bodies' edges. A byte of its id names what of a body lies there:
 * the arc at that end of its edge, if the point is no further from it than this part of the edge, or else the edge.
 * That much is for two corners that face each other, as in a stack of equal boxes: either may end the common stretch,
 * as rounding has it, and so both are named. */
#define AT_END 0x1p-5f

/* The byte of a body's edge, of a point at `along`, at the low end in the lanes `low`. */
INLINE vi find_edge_feature(const struct edge *edge, vf along, vm low, bool is_b) {
    const vf least = v_mul(v_set(AT_END), v_sub(edge->high.along, edge->low.along));
    const vf inside = v_select(low, v_sub(along, edge->low.along), v_sub(edge->high.along, along));
    const vm on_edge = v_lt(least, inside), at_start = is_b ? vm_not(low) : low;
    const vi of_edge = vi_add(edge->after, vi_set(NARC_FEATURE_EDGE));
    return vi_select(on_edge, of_edge, vi_select(at_start, edge->before, edge->after));
}

/* The id of a point. */
INLINE vi find_point_id(const struct edge *a, const struct edge *b, vf along, vm low) {
    return vi_add(find_edge_feature(a, along, low, false), vi_shift_left(find_edge_feature(b, along, low, true), 8));
}

/* Does a body touch the other one with its edge? */
INLINE vm touches(const struct edge *edge) { return vm_and(edge->is_edge, edge->parallel); }

INLINE vm is_nearer_low(const struct edge *edge, vf along) {
    return v_le(v_abs(v_sub(along, edge->low.along)), v_abs(v_sub(edge->high.along, along)));
}

/* The byte of the body with `edge`, of the only point of two bodies, at `along`, where it has the arc `number`. A body
 * that touches with its edge does so at the end where the other one's corner has its own edge beside it: so the id is
 * that of the same point with the other edge within the flat angle. */
INLINE vi find_touching_feature(const struct edge *edge, const struct edge *other, vf along, vi number, bool is_b) {
    const vm corner = vm_and_not(other->is_edge, other->parallel);
    const vm low = vm_or(vm_and(corner, is_nearer_low(other, along)), vm_and_not(is_nearer_low(edge, along), corner));
    return vi_select(touches(edge), find_edge_feature(edge, along, low, is_b), number);
}

/* The id of the only point of two bodies. */
INLINE vi find_touching_id(const struct edge *a, const struct edge *b, vf along, vi number_a, vi number_b) {
    return vi_add(find_touching_feature(a, b, along, number_a, false),
                  vi_shift_left(find_touching_feature(b, a, along, number_b, true), 8));
}

/* The points of two edges that face each other, in the lanes `two` both, elsewhere the first only, which is the deepest
 * then. */
struct facing_points {
    vm two;
    struct end_point first, second, deepest;
    vi first_id, second_id;
};

/* Those of two edges with a stretch from `low` to `high` in common, seen along n. `exact`: the deepest point; `margin`:
 * of the other one. */
INLINE struct facing_points find_facing_points(const struct edge *a, const struct edge *b, struct end_point low,
                                               struct end_point high, const struct end_point *exact, vf margin) {
    /* The end that is the deepest point. Where the edges touch, the places are the stretch's ends. */
    const vm touch = vm_and(a->parallel, b->parallel);
    const vm nearer_low = v_le(v_abs(v_sub(exact->along, low.along)), v_abs(v_sub(high.along, exact->along)));
    const vm lower_low = v_le(low.separation, high.separation);
    const vm at_low = vm_or(vm_and(touch, lower_low), vm_and_not(nearer_low, touch));
    const vm exact_low = vm_and_not(at_low, touch), exact_high = vm_and_not(vm_not(at_low), touch);
    const vf least = exact->separation; /* rounding may not make the other one less */
    const vf above_low = v_max(low.separation, least), above_high = v_max(high.separation, least);
    const vm two = is_below(v_select(at_low, above_high, above_low), margin);
    const vm keeps_low = vm_or(two, at_low); /* the first point that is listed is the low one */
    low = select_end_point(exact_low, exact, &low);
    high = select_end_point(exact_high, exact, &high);
    low.separation = v_select(at_low, least, above_low);
    high.separation = v_select(at_low, above_high, least);
    const vm none = vm_xor(two, two);
    struct facing_points points = {.two = two, .second = high, .deepest = select_end_point(at_low, &low, &high)};
    points.first = select_end_point(keeps_low, &low, &high);
    points.first_id = find_point_id(a, b, points.first.along, keeps_low);
    points.second_id = find_point_id(a, b, high.along, none);
    return points;
}

/* The words of both points in a row. */
INLINE void write_facing_points(const struct facing_points *p, vec2 to_world, vec2 n, vf out_first[4],
                                vf out_second[4]) {
    const vec2 first = v2_rotate(to_world, v2_rotate(n, (vec2){p->first.across, p->first.along}));
    const vec2 second = v2_rotate(to_world, v2_rotate(n, (vec2){p->second.across, p->second.along}));
    const vf zero = v_set(0);
    out_first[0] = first.x;
    out_first[1] = first.y;
    out_first[2] = p->first.separation;
    out_first[3] = v_of_bits(p->first_id);
    out_second[0] = v_select(p->two, second.x, zero);
    out_second[1] = v_select(p->two, second.y, zero);
    out_second[2] = v_select(p->two, p->second.separation, zero);
    out_second[3] = v_select(p->two, v_of_bits(p->second_id), zero);
}

/* The point that is known already. */
INLINE struct end_point get_deepest(const struct edge *a, const struct edge *b, vf along, vf across, vf separation) {
    const vf flat = v_set(INFINITY);
    return (struct end_point){along, across, separation, v_select(a->parallel, flat, a->arc_radius),
                              v_select(b->parallel, flat, b->arc_radius)};
}

/* The margin of second points. */
INLINE vf find_second_margin(const struct call *call, vf margin) {
    const float asked = call->batch->query->second_margin;
    return v_max(margin, v_set(asked == 0 ? -INFINITY : asked));
}

INLINE struct manifold_points find_manifold_points(const struct call *call, const struct answer *answer,
                                                   const struct sides *s) {
    const struct edge *const a = &s->a, *const b = &s->b;
    const vm offered = vm_and(a->offered, b->offered);
    if (!vm_any(offered)) {
        const vi id = find_touching_id(a, b, s->place.y, s->number_a, s->number_b);
        const vf zero = v_set(0);
        return (struct manifold_points){
            vi_set(1),
            answer->radius_a,
            answer->radius_b,
            {answer->point.x, answer->point.y, answer->separation, v_of_bits(vi_select(s->named, id, answer->feature))},
            {zero, zero, zero, zero}};
    }
    const struct end_point low = find_end_point(a, b, false), high = find_end_point(a, b, true);
    const vm stretch = is_stretch(&low, &high, answer->separation, s->n, s->position_b);
    const vm faces = vm_and(offered, stretch);
    const struct end_point exact = get_deepest(a, b, s->place.y, s->place.x, answer->separation);
    struct facing_points p = find_facing_points(a, b, low, high, &exact, find_second_margin(call, s->margin));
    struct manifold_points m = {.radius_a = p.deepest.radius_a, .radius_b = p.deepest.radius_b};
    if (vm_any(vm_not(faces))) {
        const vi id = find_touching_id(a, b, s->place.y, s->number_a, s->number_b);
        p.two = vm_and(p.two, faces);
        p.first = select_end_point(faces, &p.first, &exact);
        p.first_id = vi_select(faces, p.first_id, vi_select(s->named, id, answer->feature));
        m.radius_a = v_select(faces, m.radius_a, answer->radius_a);
        m.radius_b = v_select(faces, m.radius_b, answer->radius_b);
    }
    m.count = vi_select(p.two, vi_set(2), vi_set(1));
    write_facing_points(&p, s->to_world, s->n, m.first, m.second);
    return m;
}

/* Writes the rows of manifolds that may have second points. */
SHARED void write_sides(const struct call *call, char *const *place, vi pairs, const struct answer *answer,
                        const struct sides *sides) {
    const struct manifold_points points = find_manifold_points(call, answer, sides);
    write_manifolds(place, find_numbers(call, pairs), answer, &points);
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
