/* SPDX-License-Identifier: MIT
 *
 * edges_below.inl - boxes and capsules that lie with a corner on an edge of a run's front, as all do on straight ground.
 *
 * Let n be the edge's normal, p the centre of the body's corner that is lowest along it, y the height of p above the edge,
 * and a how far p lies before the edge's next end. No gap is greater than that of the corner by itself, and the two agree
 * along n. Let a normal of the front be turned by f from n, to the next end: the place with which the front has it lies
 * beyond that end, as the front is convex, so that the gap falls there, by a cos f + y sin f or more. Between n and the last
 * normal, which m is behind the end of the front, this is least at either. So it falls all the way if a and
 * a cos + y sin of the angle to m exceed two slacks, and on the other side alike: the signs of the formula are right then
 * (base/pair_setup.inl), and its one maximum is at n. The front turns by less than a right angle beyond n.
 *   Behind m comes the closure (soa/chain_pieces.c). Let s be how far the front's ends lie from the origin, in the middle
 * between them. Its tangent goes on for 4 s or more, and the gap falls on at first; where it need not, it is below
 * -0.65 s, and along the bottom below -s, if p lies no further than 2 s from the origin. So p may be s / 4 below the edge.
 *   Where a side of the body is parallel to the edge, up to LEAST_ANGLE, the gap falls beyond both normals alike, with the
 * corner of that side which is farther from the end. What lies between them only the formula tells: it walks past the two
 * (search.inl). Such pairs go there with a slack below 0, which says so.
 *   The gap along n is a bound in any case: where it exceeds the margin by a slack, there is no contact.
 */
#ifndef NARC_PIECE_EDGES_BELOW_INL
#define NARC_PIECE_EDGES_BELOW_INL

#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/circles_beside.inl"
#include "piece/pieces.inl"
#include "sat/certificates.inl"
#include "simd/simd.h"

/* Edges of a front that are looked at. */
enum { MOST_EDGES = 3 };

/* A body with the form of a box or a capsule, in the frame of a run at world scale. */
struct edged_body {
    vec2 center, x_axis;
    vf half_x, half_y, radius;
    vm capsule;
};

/* What a body does above the edge before an arc of the front. */
struct edge_below {
    vm rests, lies; /* is the gap largest along its normal; along that, or of a side of the body that is parallel? */
    vm apart;       /* is it above the margin? */
    vi corner;      /* of the body: its record, less the first one */
};

/* The ends of a front: the normals behind them, and how far they are from the middle, squared. */
struct front_ends {
    vec2 begin, end;
    vf square;
};

/* `from`: where the edge begins; `field`: of the arc where it ends. */
INLINE struct edge_below look_below(const struct edged_body *body, const struct front_ends *ends, vec2 from,
                                    const vf field[8], vf scale, vf limit, vf two) {
    const vf zero = v_set(0), turn = v_set(LEAST_ANGLE);
    const vec2 n = {field[4], field[5]}, to = v2_scale((vec2){field[0], field[1]}, scale);
    const vf x_n = v2_dot(body->x_axis, n), y_n = v2_cross(body->x_axis, n);
    const vm left = v_lt(zero, x_n), below = v_lt(zero, y_n);
    const vf x = v_select(left, v_neg(body->half_x), body->half_x),
             y = v_select(below, v_neg(body->half_y), body->half_y);
    const vec2 p = v2_add(body->center, v2_rotate(body->x_axis, (vec2){x, y}));
    /* Along a side that is parallel to the edge both its corners are lowest. */
    const vm flat_x = v_lt(v_abs(x_n), turn), flat_y = vm_and_not(v_lt(v_abs(y_n), turn), body->capsule);
    const vec2 q = v2_add(
        body->center, v2_rotate(body->x_axis, (vec2){v_select(flat_x, v_neg(x), x), v_select(flat_y, v_neg(y), y)}));
    const vf height = v_sub(v_min(v2_dot(v2_sub(p, to), n), v2_dot(v2_sub(q, to), n)), v_mul(field[2], scale));
    const vf next = v_max(v2_cross(n, v2_sub(to, p)), v2_cross(n, v2_sub(to, q)));
    const vf last = v_max(v2_cross(n, v2_sub(p, from)), v2_cross(n, v2_sub(q, from)));
    const vf cosine_next = v2_dot(n, ends->end), cosine_last = v2_dot(n, ends->begin);
    const vf falls_next = v_add(v_mul(next, cosine_next), v_mul(height, v2_cross(n, ends->end)));
    const vf falls_last = v_add(v_mul(last, cosine_last), v_mul(height, v2_cross(ends->begin, n)));
    const vm within = v_lt(two, v_min(v_min(next, last), v_min(falls_next, falls_last)));
    const vm narrow = v_lt(zero, v_min(cosine_next, cosine_last));
    const vf depth = v_max(v_neg(height), zero), square = v_max(v2_dot(p, p), v2_dot(q, q));
    const vm near =
        vm_and(v_le(v_mul(v_set(16), v_mul(depth, depth)), ends->square), v_le(square, v_mul(v_set(4), ends->square)));
    const vm one_maximum = vm_and(vm_and(within, narrow), near);
    struct edge_below edge;
    edge.rests = vm_and_not(one_maximum, vm_or(flat_x, flat_y));
    edge.lies = vm_and(one_maximum, vm_xor(flat_x, flat_y));
    edge.apart = v_lt(limit, v_sub(height, body->radius));
    const vi of_box = vi_select(below, vi_select(left, vi_set(2), vi_set(3)), vi_select(left, vi_set(1), vi_set(0)));
    edge.corner = vi_select(body->capsule, vi_select(left, vi_set(0), vi_set(1)), of_box);
    return edge;
}

/* Pairs in the lanes `lies` go to the walk past the edge's normal and that of a side of the body. */
INLINE void pass_to_walk(struct queue *queues, vm lies, vec2 normal, const vf item[FIELDS]) {
    vf own[FIELDS];
    memcpy(own, item, sizeof own);
    set_vec2(own, DIRECTION, normal);
    own[SLACK] = v_neg(item[SLACK]);
    push(&queues[DECIDE], lies, own, ROW_FIELDS);
}

/* Tells the last stages that pairs in the lanes `which` touch: the run with an arc and its record, the body with a corner. */
INLINE void settle_on_edges(const struct call *call, struct queue *queues, vm is_a, vm which, vf margin,
                            const struct pose *pose, const struct arcs *arc, vi arc_record, vi corner_record,
                            const vf item[FIELDS]) {
    const narc_record *const records = call->batch->shapes->records;
    int32_t index[V_WIDTH];
    vf corner[4], own[FIELDS];
    vi_store(index, vi_select(which, corner_record, vi_set(0)));
    v_rows(records, sizeof *records, index, corner);
    const vec2 center = {corner[0], corner[1]};
    const vec2 of_body = v2_select(is_a, place_center_b(center, pose), v2_scale(center, pose->scale_a));
    const vf radius = v_mul(corner[2], v_select(is_a, pose->scale_b, pose->scale_a));
    const vec2 u = v2_sub(v2_select(is_a, of_body, arc->center), v2_select(is_a, arc->center, of_body));
    const vf separation = v_sub(v2_dot(u, arc->start), v_add(arc->radius, radius));
    const vm found = vm_and(which, is_below(separation, margin));
    if (!vm_any(found))
        return;
    memcpy(own, item, sizeof own);
    own[SEPARATION] = separation;
    set_vec2(own, NORMAL, arc->start);
    own[RECORD_A] = v_of_bits(vi_select(is_a, arc_record, corner_record));
    own[RECORD_B] = v_of_bits(vi_select(is_a, corner_record, arc_record));
    push(&queues[call->question->kind == MANIFOLD_ROWS ? ANSWER_EDGES : ANSWER], found, own, ROW_FIELDS);
}

/* Settles pairs of a body with a form of those in the lanes `open`, each with a run; returns the others. */
NOINLINE vm settle_above_edges(const struct call *call, struct queue *queues, vm open, vf margin,
                               const vf item[FIELDS]) {
    const narc_shapes *const shapes = call->batch->shapes;
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B), one = vi_set(1);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN);
    const vi info = vi_select(is_a, info_a, info_b), other_info = vi_select(is_a, info_b, info_a);
    const vi last = vi_sub(get_arc_count(info), vi_set(5));
    const vm which = vm_and(open, vi_lt(last, vi_set(MOST_EDGES + 1)));
    if (!vm_any(which))
        return open;
    const vi first_a = get_item_bits(item, FIRST_RECORD_A), first_b = get_item_bits(item, FIRST_RECORD_B);
    const struct ring ring = make_ring(vi_select(is_a, first_a, first_b), info);
    const vi body_base = find_first_arc(vi_select(is_a, first_b, first_a), other_info);
    const vf scale = v_select(is_a, item[SCALE_A], item[SCALE_B]),
             other_scale = v_select(is_a, item[SCALE_B], item[SCALE_A]);
    const struct run_beside run = {
        .ring = {vi_select(which, ring.base, vi_set(0)), vi_select(which, ring.count, vi_set(6))},
        .first = vi_select(which, get_first_arc(info), vi_set(0))};
    int32_t index[V_WIDTH];
    vf form[4], field[8], behind[8], touched[8];
    vi_store(index, get_item_bits(item, BODY_SHAPE));
    v_rows(shapes->boxes, sizeof *shapes->boxes, index, form);
    const vi kind = vi_bits(form[3]), zero = vi_set(0);
    const vm capsule = vi_lt(zero, vi_and(kind, vi_set((int32_t)NARC_IS_CAPSULE)));
    const vm tried = vm_and(which, vi_lt(zero, vi_and(kind, vi_set((int32_t)(NARC_IS_BOX | NARC_IS_CAPSULE)))));
    if (!vm_any(tried))
        return open;
    const vec2 position = {item[POSITION], item[POSITION + 1]}, rotation = {item[ROTATION], item[ROTATION + 1]};
    const struct edged_body body = {.center = v2_select(is_a, position, v2_unrotate_opposite(rotation, position)),
                                    .x_axis = {rotation.x, v_select(is_a, rotation.y, v_neg(rotation.y))},
                                    .half_x = v_mul(form[0], other_scale),
                                    .half_y = v_select(capsule, v_set(0), v_mul(form[1], other_scale)),
                                    .radius = v_mul(form[2], other_scale),
                                    .capsule = capsule};
    load_records(shapes->records, find_run_record(&run, zero), field);
    load_records(shapes->records, find_run_record(&run, vi_select(tried, last, one)), behind);
    vec2 from = v2_scale((vec2){field[0], field[1]}, scale);
    const struct front_ends ends = {{field[4], field[5]}, {behind[6], behind[7]}, v2_dot(from, from)};
    const vf slack = item[SLACK], two = v_add(slack, slack), limit = v_add(margin, slack);
    vm rests = vm_front(0), lies = rests, apart = rests;
    vi arc_record = zero, corner_record = zero;
    memcpy(touched, field, sizeof touched);
    for (int i = 1; i <= MOST_EDGES; i++) {
        const vm here = vm_and_not(vm_and(tried, vi_lt(vi_set(i - 1), last)), vm_or(vm_or(rests, lies), apart));
        if (!vm_any(here))
            break;
        const vi record = find_run_record(&run, vi_select(here, vi_set(i), one));
        load_records(shapes->records, record, field);
        const struct edge_below edge = look_below(&body, &ends, from, field, scale, limit, two);
        const vm at = vm_and(here, vm_or(edge.rests, edge.lies));
        apart = vm_or(apart, vm_and(here, edge.apart));
        rests = vm_or(rests, vm_and(here, edge.rests));
        lies = vm_or(lies, vm_and(here, edge.lies));
        arc_record = vi_select(at, record, arc_record);
        corner_record = vi_select(at, vi_add(body_base, edge.corner), corner_record);
        for (int f = 0; f < 8; f++)
            touched[f] = v_select(at, field[f], touched[f]);
        from = v2_scale((vec2){field[0], field[1]}, scale);
    }
    rests = vm_and_not(rests, apart);
    lies = vm_and_not(lies, apart);
    if (!vm_any(vm_or(rests, lies)))
        return vm_and_not(open, apart);
    const struct pose pose = {position, rotation, item[SCALE_A], item[SCALE_B]};
    const struct arcs arc = place_arc(touched, &pose, is_a);
    if (vm_any(lies))
        pass_to_walk(queues, lies, arc.start, item);
    if (vm_any(rests))
        settle_on_edges(call, queues, is_a, rests, margin, &pose, &arc, arc_record, corner_record, item);
    return vm_and_not(open, vm_or(vm_or(rests, lies), apart));
}

#endif
