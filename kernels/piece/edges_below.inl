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
 * corner of that side which is farther from the end. What lies between them two sides that face each other tell as those of
 * boxes do (box/box_contact.inl), if no other normal does: the arcs at the edge's ends turn by SIDE_ANGLE at least. Where
 * one corner faces another, or the side's normal is told and that is not the edge's, the pair is left.
 *   The gap along n is a bound in any case: where it exceeds the margin by a slack, there is no contact.
 *   Nor is there with a run beside whose front a body lies, as where ground is cut: it lies over two runs and touches one. The
 * other one's greatest gap is along the tangent beyond its front, whose normal m is that of the far edge there
 * (soa/chain_pieces.c). Let E be the end of the front, and p the body's deepest point along the normal n there. No gap along a
 * normal of the front exceeds (p - E) along that, the greatest of which is at one of the front's ends if p lies beyond n. So if
 * it is greater along m, by the slack (base/pair_setup.inl: the formula may be off by a quarter of it, twice, and this by
 * less), the formula tells of no front.
 */
#ifndef NARC_PIECE_EDGES_BELOW_INL
#define NARC_PIECE_EDGES_BELOW_INL

#include <string.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "piece/circles_beside.inl"
#include "piece/edge_rows.inl"
#include "piece/pieces.inl"
#include "sat/certificates.inl"
#include "simd/simd.h"

/* The least sine of what an arc turns by that is more than LEAST_ANGLE. */
#define SIDE_ANGLE (2 * LEAST_ANGLE)

/* A body with the form of a box or a capsule, in the frame of a run at world scale. */
struct edged_body {
    vec2 center, x_axis;
    vf half_x, half_y, radius;
    vm capsule;
};

/* Its corner that is lowest along n, in its own axes; *out_n: these along n. */
INLINE vec2 find_lowest_corner(const struct edged_body *body, vec2 n, vec2 *out_n) {
    const vf zero = v_set(0);
    *out_n = (vec2){v2_dot(body->x_axis, n), v2_cross(body->x_axis, n)};
    return (vec2){v_select(v_lt(zero, out_n->x), v_neg(body->half_x), body->half_x),
                  v_select(v_lt(zero, out_n->y), v_neg(body->half_y), body->half_y)};
}

/* Does it lie beside the end of the front? By the arc that turns there to the closure, or from it, and that at the other
 * end. */
INLINE vm is_beyond(const struct edged_body *body, const vf here[8], const vf other[8], vf scale, bool is_last,
                    vf slack) {
    const vec2 start = {here[4], here[5]}, stop = {here[6], here[7]}, n = is_last ? start : stop,
               m = is_last ? stop : start, other_n = {other[is_last ? 6 : 4], other[is_last ? 7 : 5]};
    vec2 axes;
    const vec2 way = v2_sub(body->center, v2_scale((vec2){here[0], here[1]}, scale)),
               corner = find_lowest_corner(body, n, &axes);
    const vec2 p = v2_sub(v2_add(way, v2_rotate(body->x_axis, corner)), v2_scale(n, body->radius));
    const vf beyond = is_last ? v2_cross(n, p) : v2_cross(p, n);
    const vf x_m = v_mul(body->half_x, v_abs(v2_dot(body->x_axis, m))),
             y_m = v_mul(body->half_y, v_abs(v2_cross(body->x_axis, m)));
    const vf along_m = v_sub(v2_dot(way, m), v_add(v_add(x_m, y_m), body->radius));
    return vm_and(v_le(v_set(0), beyond), v_lt(v_add(v_max(v2_dot(p, n), v2_dot(p, other_n)), slack), along_m));
}

/* What a body does above the edge. Is the gap largest along its normal, so that it rests; along that, or of a side that is
 * parallel: it lies? Returns whether it is above the margin. `first`, `end`: the arcs at the ends of the front. */
INLINE vm look_below(const struct edged_body *body, const vf first[8], const vf end[8], vf scale, vf least_edge,
                     vf slack, struct edge_contact *e) {
    const vf *const before = e->before, *const field = e->behind;
    const vf zero = v_set(0), turn = v_set(LEAST_ANGLE);
    const vec2 n = {field[4], field[5]}, to = v2_scale((vec2){field[0], field[1]}, scale);
    const vec2 from = v2_scale((vec2){before[0], before[1]}, scale),
               middle = v2_scale((vec2){first[0], first[1]}, scale);
    const vec2 n_first = {first[4], first[5]}, n_end = {end[6], end[7]}; /* behind the ends */
    const vf far = v2_dot(middle, middle);
    const vec2 corner = find_lowest_corner(body, n, &e->axes),
               p = v2_add(body->center, v2_rotate(body->x_axis, corner));
    const vf x = corner.x, y = corner.y, x_n = e->axes.x, y_n = e->axes.y;
    /* Along a side that is parallel to the edge both its corners are lowest. */
    const vm flat_x = v_lt(v_abs(x_n), turn), flat_y = vm_and_not(v_lt(v_abs(y_n), turn), body->capsule);
    const vec2 q = v2_add(
        body->center, v2_rotate(body->x_axis, (vec2){v_select(flat_x, v_neg(x), x), v_select(flat_y, v_neg(y), y)}));
    const vf height = v_sub(v_min(v2_dot(v2_sub(p, to), n), v2_dot(v2_sub(q, to), n)), v_mul(field[2], scale));
    const vf next = v_max(v2_cross(n, v2_sub(to, p)), v2_cross(n, v2_sub(to, q)));
    const vf last = v_max(v2_cross(n, v2_sub(p, from)), v2_cross(n, v2_sub(q, from)));
    const vf cosine_next = v2_dot(n, n_end), cosine_last = v2_dot(n, n_first);
    const vf falls_next = v_add(v_mul(next, cosine_next), v_mul(height, v2_cross(n, n_end)));
    const vf falls_last = v_add(v_mul(last, cosine_last), v_mul(height, v2_cross(n_first, n)));
    const vf sure = v_min(v_min(next, last), v_min(falls_next, falls_last));
    /* Nor is the edge, or a side of the body, what rounding may have made. */
    const vf side = v_min(body->half_x, v_select(body->capsule, body->half_x, body->half_y));
    const vf length = v2_cross(n, v2_sub(to, from)), least = v_min(v_min(sure, side), length);
    const vm within = vm_and(v_lt(v_add(slack, slack), least), v_lt(least_edge, length));
    const vm narrow = v_lt(zero, v_min(cosine_next, cosine_last));
    const vf depth = v_max(v_neg(height), zero), square = v_max(v2_dot(p, p), v2_dot(q, q));
    const vm near = vm_and(v_le(v_mul(v_set(16), v_mul(depth, depth)), far), v_le(square, v_mul(v_set(4), far)));
    const vm one_maximum = vm_and(vm_and(within, narrow), near), flat = vm_or(flat_x, flat_y);
    const vf turned = v_min(v2_cross((vec2){before[4], before[5]}, n), v2_cross(n, (vec2){field[6], field[7]}));
    const vm parts = vm_and_not(v_lt(v_set(SIDE_ANGLE), turned), vm_and(flat_x, flat_y));
    /* Of two sides that are equally near none is told, nor of a capsule that stands upright. */
    const vf off = v_select(body->capsule, v_set(0x1p-7f), v_abs(x_n)), by = v_abs(y_n);
    const vm nearer = vm_or(v_lt(off, by), vm_and_not(v_lt(by, off), body->capsule));
    const vm apart = v_lt(v_add(e->margin, slack), v_sub(height, body->radius));
    const vm touches = vm_and_not(one_maximum, apart);
    e->rests = vm_and(vm_and_not(touches, flat), nearer);
    e->lies = vm_and(touches, vm_and(flat, parts));
    return apart;
}

/* Settles pairs of a body with a form of those in the lanes `open`, each with a run; returns the others, whose search
 * begins where they are next to the run. Looked at is the edge behind the last arc whose start the body's middle lies behind. */
NOINLINE vm settle_above_edges(const struct call *call, edge_answer *answer, vm open, vf margin, vf item[FIELDS]) {
    const narc_shapes *const shapes = call->batch->shapes;
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B), one = vi_set(1);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN);
    const vi info = vi_select(is_a, info_a, info_b), zero = vi_set(0);
    const vi first_a = get_item_bits(item, FIRST_RECORD_A), first_b = get_item_bits(item, FIRST_RECORD_B);
    const struct ring ring = make_ring(vi_select(is_a, first_a, first_b), info);
    const vf scale = v_select(is_a, item[SCALE_A], item[SCALE_B]),
             other_scale = v_select(is_a, item[SCALE_B], item[SCALE_A]);
    struct edge_contact e = {.item = item, .is_a = is_a, .margin = margin, .solid = vi_add(ring.base, ring.count)};
    int32_t index[V_WIDTH];
    vf first[8], end[8];
    vi_store(index, get_item_bits(item, BODY_SHAPE));
    v_rows(shapes->boxes, sizeof *shapes->boxes, index, e.form);
    const vi kind = vi_bits(e.form[3]);
    e.capsule = vi_lt(zero, vi_and(kind, vi_set((int32_t)NARC_IS_CAPSULE)));
    e.first_arc = vi_and(kind, vi_set(3));
    const vm tried = vm_and(open, vi_lt(zero, vi_and(kind, vi_set((int32_t)(NARC_IS_BOX | NARC_IS_CAPSULE)))));
    if (!vm_any(tried))
        return open;
    const vec2 position = {item[POSITION], item[POSITION + 1]}, rotation = {item[ROTATION], item[ROTATION + 1]};
    const struct edged_body body = {.center = v2_select(is_a, position, v2_unrotate_opposite(rotation, position)),
                                    .x_axis = {rotation.x, v_select(is_a, rotation.y, v_neg(rotation.y))},
                                    .half_x = v_mul(e.form[0], other_scale),
                                    .half_y = v_select(e.capsule, v_set(0), v_mul(e.form[1], other_scale)),
                                    .radius = v_mul(e.form[2], other_scale),
                                    .capsule = e.capsule};
    const struct run_beside run = {.ring = {vi_select(tried, ring.base, zero), vi_select(tried, ring.count, vi_set(6))},
                                   .first = vi_select(tried, get_first_arc(info), zero),
                                   .scale = scale,
                                   .p = body.center};
    e.last = vi_sub(run.ring.count, vi_set(5));
    e.number = one;
    load_records(shapes->records, find_run_record(&run, zero), first);
    load_records(shapes->records, find_run_record(&run, e.last), end);
    memcpy(e.before, first, sizeof first);
    memcpy(e.behind, end, sizeof end);
    if (vm_any(vi_lt(one, e.last))) {
        vi low = zero, high = e.last; /* arcs whose starts the middle lies behind, and does not */
        for (vm halves = vi_lt(one, high); vm_any(halves); halves = vi_lt(vi_add(low, one), high)) {
            const vi arc = vi_shift_right(vi_add(low, high), 1);
            load_records(shapes->records, find_run_record(&run, arc), e.before);
            const vm behind = is_behind_start(&run, e.before);
            low = vi_select(vm_and(halves, behind), arc, low);
            high = vi_select(vm_and_not(halves, behind), arc, high);
        }
        e.number = high;
        load_records(shapes->records, find_run_record(&run, low), e.before);
        load_records(shapes->records, find_run_record(&run, high), e.behind);
    }
    const vf slack = item[SLACK], least_edge = v_mul(v_set(2), v_mul(scale, find_least_edge(info)));
    vm settled = vm_and(tried, look_below(&body, first, end, scale, least_edge, slack, &e));
    const vm left = vm_and_not(tried, vm_or(settled, vm_or(e.rests, e.lies)));
    if (V_WIDTH > 4 && vm_any(left)) /* in few lanes a look costs what it saves */
        settled = vm_or(settled, vm_and(tried, vm_or(is_beyond(&body, first, end, scale, false, slack),
                                                     is_beyond(&body, end, first, scale, true, slack))));
    e.rests = vm_and_not(vm_and(tried, e.rests), settled);
    e.lies = vm_and_not(vm_and(tried, e.lies), settled);
    if (vm_any(vm_or(e.rests, e.lies)))
        settled = vm_or(settled, answer(call, &e));
    open = vm_and_not(open, settled);
    if (!vm_any(open))
        return open;
    /* From the arc before the edge to what of the body is nearest, but not beyond the edge's normal. */
    const vec2 n = {e.behind[4], e.behind[5]}, way = look_from_arc(&run, e.before);
    const vf x = v2_dot(body.x_axis, way), y = v2_cross(body.x_axis, way);
    const vec2 near = v2_rotate(body.x_axis, (vec2){v_sub(x, v_max(v_min(x, body.half_x), v_neg(body.half_x))),
                                                    v_sub(y, v_max(v_min(y, body.half_y), v_neg(body.half_y)))}),
               from = v2_select(v_lt(v_set(0), v2_cross(near, n)), near, n),
               axis = {item[DIRECTION], item[DIRECTION + 1]};
    set_vec2(item, DIRECTION, v2_select(tried, v2_select(is_a, from, v2_rotate_opposite(rotation, from)), axis));
    return open;
}

#endif
