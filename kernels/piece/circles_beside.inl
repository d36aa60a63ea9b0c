/* SPDX-License-Identifier: MIT
 *
 * circles_beside.inl - circles about their own origin on pieces of chains, by what the store keeps of these for circles
 * (store.h, narc_piece_form): right behind the indices, before a header or an arc is read.
 *
 * On a run, where the foot of the centre lies is looked for among the junctions, whose normals lie in the order of the
 * arcs: step by step, and by halving behind those that the form has. Let p be the centre of the circle. Without its radius
 * the gap is the distance of p from the closed run, where p lies outside of that. It rises towards the foot from all sides,
 * by at least as much as p lies beside the nearest normal of a junction, as these spread outwards; and where it is below 0 it
 * is less. So where p lies outside by two slacks, and by as much off the normals at both ends of the arc or the edge that
 * holds the foot, every sign of the formula is right (box/circles.inl). Where the foot lies by two slacks beyond an end of
 * the front, no contact is told.
 *   Of a concave arc the formula is a few lines (concave.inl). The circles around both need not be asked: what they tell
 * apart is further away than the margin, or deeper than twice the circle's radius. Other pairs are left.
 */
#ifndef NARC_PIECE_CIRCLES_BESIDE_INL
#define NARC_PIECE_CIRCLES_BESIDE_INL

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_pairs.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"
#include <stdbool.h>
#include <stdint.h>

/* A run in each lane, and the centre of a circle in its frame, at world scale. */
struct run_beside {
    struct ring ring;
    vi first; /* of the caller's arcs, the one that is stored first */
    vf scale;
    vec2 p;
};

/* The record of the caller's arc of a number. */
INLINE vi find_run_record(const struct run_beside *run, vi number) {
    const vi stored = vi_sub(number, run->first);
    return vi_add(run->ring.base, vi_select(vi_lt(stored, vi_set(0)), vi_add(stored, run->ring.count), stored));
}

/* From the centre of an arc, its first two fields, to p. */
INLINE vec2 look_from_arc(const struct run_beside *run, const vf *center) {
    return v2_sub(run->p, v2_scale((vec2){center[0], center[1]}, run->scale));
}

/* Is p behind the start of an arc? */
INLINE vm is_behind_start(const struct run_beside *run, const vf field[8]) {
    return v_le(v_set(0), v2_cross((vec2){field[4], field[5]}, look_from_arc(run, field)));
}

/* Goes on behind arc 2, whose end p is not clearly before, in the lanes `walks`: to the last arc of the front, up to the
 * corner `last` behind it, whose start p lies behind. Returns its number, and the fields of it and, but for the last one, of
 * the next. By halving, and then step by step. */
NOINLINE vi walk_on(const narc_shapes *shapes, const int32_t *shape, struct run_beside *run, vm walks, vi last,
                    vf here[8], vf next[8]) {
    const narc_record *const records = shapes->records;
    const vi one = vi_set(1);
    vf header[4];
    v_rows(shapes->headers, sizeof *shapes->headers, shape, header);
    const vi info = vi_bits(header[1]);
    const struct ring ring = make_ring(vi_bits(header[0]), info);
    /* Other lanes have the first records of all, of which there are as many as a run has. */
    run->ring = (struct ring){vi_select(walks, ring.base, vi_set(0)), vi_select(walks, ring.count, vi_set(6))};
    run->first = vi_select(walks, get_first_arc(info), vi_set(0));
    vi low = vi_set(2), high = vi_select(walks, vi_add(last, one), vi_set(3));
    for (;;) {
        const vm open = vi_lt(vi_add(low, vi_set(3)), high);
        if (!vm_any(open))
            break;
        const vi middle = vi_shift_right(vi_add(low, high), 1);
        load_records(records, find_run_record(run, middle), here);
        const vm behind = is_behind_start(run, here);
        low = vi_select(vm_and(open, behind), middle, low);
        high = vi_select(vm_and_not(open, behind), middle, high);
    }
    load_records(records, find_run_record(run, low), here);
    for (;;) {
        load_records(records, find_run_record(run, vi_add(low, one)), next);
        const vm moves = vm_and(vi_lt(vi_add(low, one), high), is_behind_start(run, next));
        if (!vm_any(moves))
            return low;
        for (int f = 0; f < 8; f++)
            here[f] = v_select(moves, next[f], here[f]);
        low = vi_select(moves, vi_add(low, one), low);
        if (!vm_any(vm_and(moves, vi_lt(low, last))))
            return low;
    }
}

/* How circles touch pieces: with the arc `touched`, the caller's `number`, or with the edge between that and the arc before. */
struct circles_on_pieces {
    vm concave, at_edge;
    vi info, number;
    vf radius, thickness; /* of the circle; of the solid */
    struct arcs touched, before;
    vec2 center; /* of the circle */
    vf separation;
    vec2 n;
};

/* Pairs that touch, for certain, in the lanes `which`, wait for the last stage, which knows whether that counts. `of_b`: the
 * piece is B. */
NOINLINE void pass_touching(const struct call *call, const struct pair_indices *in, int k,
                            const struct placement *placement, const struct circles_on_pieces *c, bool of_b, vm which,
                            int32_t number) {
    vf item[FIELDS];
    (void)set_up_pairs(call, in, k, placement, which, number - k, item);
    struct run_beside run[2];
    for (int side = 0; side < 2; side++) {
        const vi info = get_item_bits(item, INFO_A + side);
        run[side].ring = make_ring(get_item_bits(item, FIRST_RECORD_A + side), info);
        run[side].first = get_first_arc(info);
    }
    const vi of_piece = find_run_record(&run[of_b], c->number), of_circle = run[!of_b].ring.base;
    item[SEPARATION] = c->separation;
    set_vec2(item, NORMAL, c->n);
    item[RECORD_A] = v_of_bits(of_b ? of_circle : of_piece);
    item[RECORD_B] = v_of_bits(of_b ? of_piece : of_circle);
    push(call->settled, which, item, ROW_FIELDS);
}

/* Writes the rows of pairs in the lanes `keep`. */
INLINE void write_circles_on_pieces(const struct call *call, const struct placement *placement,
                                    const struct circles_on_pieces *c, bool of_b, vm keep, vi pairs) {
    const vec2 n = c->n;
    const vi none = vi_set(0);
    const struct touching_pair pair = {none,
                                       none,
                                       c->info,
                                       c->info,
                                       placement->pose.scale_a,
                                       placement->pose.scale_b,
                                       placement->rotation_a,
                                       .round_a = of_b,
                                       .round_b = !of_b};
    const vec2 point = find_point(&c->touched, n, of_b), other = find_point(&c->before, n, of_b);
    const vec2 on_circle = v2_add(c->center, v2_scale(n, of_b ? c->radius : v_neg(c->radius)));
    const vf along = v2_cross(n, point), along_before = v_select(c->at_edge, v2_cross(n, other), along);
    const vf size = find_magnitude(&c->touched), along_circle = v2_cross(n, on_circle);
    const struct feature of_run = {
        v2_dot(n, point),           v_min(along, along_before),
        v_max(along, along_before), vi_add(find_first_arc(none, c->info), c->number),
        c->touched.radius,          v_add(size, v_select(c->at_edge, find_magnitude(&c->before), size)),
        c->touched.start,           c->touched.end};
    const struct feature round = {v2_dot(n, on_circle), along_circle, along_circle, none, c->radius, v_set(0), n, n};
    const struct answer answer =
        tell_touch(&pair, c->separation, n, of_b ? &round : &of_run, of_b ? &of_run : &round, has_reaches(call));
    const vi feature = of_b ? vi_shift_right(answer.feature, 8) : answer.feature;
    char *place[V_WIDTH];
    find_places(call, pairs, vm_and(keep, is_front(c->info, feature)), place);
    write_rows(call, place, find_numbers(call, pairs), &answer);
}

/* Takes pairs of a circle and a piece in the lanes `which`: those that touch are answered, or go to the last stage. Returns
 * those that it took. */
INLINE vm settle_circles_of(const struct call *call, const struct pair_indices *in, int k,
                            const struct placement *placement, const struct box_form *piece, vf radius, bool of_b,
                            vm which, int32_t number) {
    const narc_shapes *const shapes = call->batch->shapes;
    const struct pose *const pose = &placement->pose;
    const int32_t *const shape = (of_b ? in->shape_b : in->shape_a) + k;
    const vi zero = vi_set(0), one = vi_set(1), pairs = vi_add(vi_lanes(), vi_set(number));
    const vec2 origin = {v_set(0), v_set(0)};
    vf arc_0[4], arc_1[4], arc_2[4], behind[4];
    v_rows(shapes->fronts->center_0, sizeof *shapes->fronts, shape, arc_0);
    v_rows(shapes->fronts->center_1, sizeof *shapes->fronts, shape, arc_1);
    v_rows(shapes->fronts->normal_2, sizeof *shapes->fronts, shape, arc_2);
    v_rows(shapes->fronts->normal_3, sizeof *shapes->fronts, shape, behind);
    struct circles_on_pieces c;
    c.info = vi_bits(arc_1[3]);
    const vi last = vi_sub(get_arc_count(c.info), vi_set(5)), ratio = get_extent_ratio(c.info);
    struct run_beside run;
    run.scale = of_b ? pose->scale_b : pose->scale_a;
    c.concave = has_mark(c.info, NARC_PIECE_CONCAVE);
    c.radius = v_mul(radius, of_b ? pose->scale_a : pose->scale_b);
    c.thickness = v_mul(behind[3], run.scale);
    c.center = of_b ? origin : place_center_b(origin, pose);
    run.p = of_b ? v2_unrotate(pose->rotation, v2_sub(origin, pose->position)) : c.center;
    const vf size = v_mul(piece->radius, run.scale);
    const vf extents = v_add(v_mul(size, v_of_int(ratio)), c.radius);
    const vf known_slack =
        v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(pose->position.x), v_abs(pose->position.y)), extents));
    const vf slack = v_select(vi_lt(ratio, vi_set(255)), known_slack, v_set(INFINITY)), two = v_add(slack, slack);
    which = vm_and(which, vm_and(is_size_in_range(size), is_box_in_range(c.radius)));

    /* The arc whose start p lies behind, and the next one. A concave arc is like arc 1. */
    const vec2 normal_1 = {arc_0[2], arc_0[3]}, normal_2 = {arc_2[0], arc_2[1]}, normal_3 = {behind[0], behind[1]};
    const vf center_3[2] = {piece->half.x, piece->half.y};
    const vec2 u_2 = look_from_arc(&run, arc_2 + 2), u_3 = look_from_arc(&run, center_3);
    const vm past_1 = vm_or(c.concave, v_le(v_set(0), v2_cross(normal_1, look_from_arc(&run, arc_1))));
    const vm past_2 = vm_and(vm_and(past_1, vi_lt(one, last)), v_le(v_set(0), v2_cross(normal_2, u_2)));
    const vf none = v_set(0);
    vf here[8] = {v_select(past_2, arc_2[2], v_select(past_1, arc_1[0], arc_0[0])),
                  v_select(past_2, arc_2[3], v_select(past_1, arc_1[1], arc_0[1])),
                  v_select(past_2, behind[2], v_select(past_1, arc_1[2], none)),
                  none,
                  v_select(past_2, arc_2[0], arc_0[2]),
                  v_select(past_2, arc_2[1], arc_0[3]),
                  v_select(past_2, behind[0], v_select(past_1, arc_2[0], arc_0[2])),
                  v_select(past_2, behind[1], v_select(past_1, arc_2[1], arc_0[3]))};
    vf next[8] = {v_select(past_1, arc_2[2], arc_1[0]),
                  v_select(past_1, arc_2[3], arc_1[1]),
                  v_select(past_1, behind[2], arc_1[2]),
                  none,
                  here[6],
                  here[7],
                  v_select(past_1, behind[0], arc_2[0]),
                  v_select(past_1, behind[1], arc_2[1])};
    vi before = vi_select(past_2, vi_set(2), vi_select(past_1, one, zero));
    /* Arc 3 may be the corner where the front ends. */
    const vm before_3 = v_lt(two, v2_cross(u_2, normal_3)), is_end = vm_not(vi_lt(vi_set(3), last));
    const vm beyond_3 = vm_and(v_lt(two, v2_cross(normal_3, u_3)), v_lt(two, v2_dot(normal_3, u_3)));
    const vm past_3 = vm_and_not(vm_and(which, vm_and(past_2, vi_lt(vi_set(2), last))), before_3);
    const vm past_all = vm_and(past_3, vm_and(is_end, beyond_3)), walks = vm_and_not(past_3, past_all);
    if (vm_any(walks)) {
        struct run_beside walked = {.scale = run.scale, .p = run.p};
        vf there[8], beyond_there[8];
        const vi found = walk_on(shapes, shape, &walked, walks, last, there, beyond_there);
        before = vi_select(walks, found, before);
        for (int f = 0; f < 8; f++) {
            here[f] = v_select(walks, there[f], here[f]);
            next[f] = v_select(walks, beyond_there[f], next[f]);
        }
    }

    const vec2 u = look_from_arc(&run, here), start = {here[4], here[5]}, end = {here[6], here[7]};
    const vf behind_start = v2_cross(start, u), before_end = v2_cross(u, end);
    const vm is_first = vi_lt(before, one), is_last = vm_not(vi_lt(before, last));
    const vm within = vm_and(v_lt(two, behind_start), v_lt(two, before_end));
    const vm at_arc = vm_and_not(within, vm_or(is_first, is_last));
    const vm past_end = vm_and(v_lt(before_end, v_neg(two)), v_lt(two, v2_cross(look_from_arc(&run, next), end)));
    c.at_edge = vm_and_not(past_end, vm_or(is_last, c.concave));
    const vf distance = v_sub(v_select(c.at_edge, v2_dot(u, end), v2_length(u)), v_mul(here[2], run.scale));
    const vm beyond_begin = vm_and(is_first, v_lt(two, before_end)),
             beyond_end = vm_and(is_last, v_lt(two, behind_start));
    const vm ends = vm_and(vm_or(beyond_begin, beyond_end), v_lt(two, v2_dot(u, v2_select(is_first, end, start))));
    const vm beyond = vm_or(ends, past_all);
    const vm on_front = vm_and(vm_or(at_arc, c.at_edge), v_lt(two, distance));
    const vm runs = vm_and_not(vm_and(which, vm_or(beyond, on_front)), c.concave);
    const vm apart = v_lt(v_add(v_add(c.radius, placement->margin), slack), distance);
    vm taken = runs, near = vm_and_not(runs, vm_or(beyond, apart));
    if (!vm_any(vm_or(near, vm_and(which, c.concave))))
        return taken;

    /* As the formulas have it, with the arc that holds the foot, or lies behind its edge. */
    vf touched[8];
    for (int f = 0; f < 8; f++)
        touched[f] = v_select(c.at_edge, next[f], here[f]);
    c.number = vi_select(c.concave, zero, vi_add(before, vi_select(c.at_edge, one, zero)));
    c.touched = of_b ? place_b(touched, pose) : place_a(touched, pose);
    c.before = of_b ? place_b(here, pose) : place_a(here, pose);
    const vec2 from = of_b ? c.center : c.touched.center, to = of_b ? c.touched.center : c.center;
    vec2 way = v2_sub(to, from);
    const vf length = v2_length(way);
    c.separation = v_sub(v_select(c.at_edge, v2_dot(way, c.touched.start), length), v_add(c.touched.radius, c.radius));
    if (vm_any(c.concave)) {
        const vec2 back = v2_sub(from, to);
        const vm alike = v_lt(v2_dot(back, back), v_set(LEAST_SQUARE)),
                 known = vm_and(which, vm_and_not(c.concave, alike));
        const vf inside = v_sub(v_sub(v_neg(c.touched.radius), length), c.radius);
        taken = vm_or(taken, known);
        near = vm_or(near, vm_and(known, is_in_sector(&c.touched, back, c.radius)));
        c.separation = v_select(c.concave, inside, c.separation);
        way = v2_select(c.concave, back, way);
    }
    c.n = v2_select(c.at_edge, c.touched.start, v2_divide(way, length));
    const vm found = vm_and(near, is_below(c.separation, placement->margin));
    if (!vm_any(found))
        return taken;
    /* Twice the circle's inner radius, which lacks some roundings; if its middle must be in front, not more than once. */
    const vf inner = v_mul(v_set(1 - 0x1p-17f), c.radius),
             most = call->batch->query->front_only ? inner : v_add(inner, inner);
    const vm deep = vm_and_not(v_lt(c.separation, v_set(0)), is_shallow(most, c.thickness, c.separation));
    const vm at_end = vm_and_not(is_parallel(c.touched.end, c.n), c.concave);
    const vm left = vm_and(found, vm_or(deep, at_end)), keep = vm_and_not(found, left),
             waits = vm_and_not(left, c.concave);
    if (vm_any(waits)) {
        const struct circles_on_pieces copy = c;
        pass_touching(call, in, k, placement, &copy, of_b, waits, number);
    }
    if (vm_any(keep))
        write_circles_on_pieces(call, placement, &c, of_b, keep, pairs);
    return vm_and_not(taken, vm_and_not(left, waits));
}

/* Takes pairs of a circle about its own origin and a piece of a chain, in the lanes `which`. Returns those that it took.
 * `number`: of the first. */
NOINLINE vm take_circles_on_pieces(const struct call *call, const struct pair_indices *in, int k,
                                   const struct placement *placement, vm which, int32_t number) {
    const narc_box_form *const forms = call->batch->shapes->boxes;
    const struct box_form a = load_box_forms(forms, in->shape_a + k), b = load_box_forms(forms, in->shape_b + k);
    const vm of_a = vm_and(is_form(&a, NARC_HAS_FRONT), is_form(&b, NARC_IS_CIRCLE)),
             of_b = vm_and(is_form(&b, NARC_HAS_FRONT), is_form(&a, NARC_IS_CIRCLE));
    const vm asked = vm_and(vm_and(which, placement->in_range), vm_or(of_a, of_b));
    vm taken = vm_front(0);
    if (vm_any(vm_and(asked, of_b)))
        taken = settle_circles_of(call, in, k, placement, &b, a.radius, true, vm_and(asked, of_b), number);
    if (vm_any(vm_and(asked, of_a)))
        taken =
            vm_or(taken, settle_circles_of(call, in, k, placement, &a, b.radius, false, vm_and(asked, of_a), number));
    return taken;
}

#endif
