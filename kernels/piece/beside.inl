/* SPDX-License-Identifier: MIT
 *
 * beside.inl - bodies that lie beside the front of a run, and have no contact with it.
 *
 * Where ground is cut, a body lies over two runs and touches one. The other one's greatest gap is along the tangent beyond
 * its front, whose normal m is that of the far edge there (soa/chain_pieces.c): it has no contact, and need not be asked. Let
 * E be the end of the front, and p the body's deepest point along the normal n there. No gap along a normal of the front
 * exceeds (p - E) along that, the greatest of which is at one of the front's ends if p lies beyond n. So if it is greater
 * along m, by the slack (base/pair_setup.inl: the formula may be off by a quarter of it, twice, and this by less), the
 * formula tells of no front.
 */
#ifndef NARC_PIECE_BESIDE_INL
#define NARC_PIECE_BESIDE_INL

#include <stdbool.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* A body with the form of a box, a capsule or a circle, in the frame of a run at world scale. */
struct plain_body {
    vec2 center, x_axis;
    vf half_x, half_y, radius;
    vm capsule;
};

/* An end of a front: of the arc that turns from it to the closure. n is the normal before the closure, m that behind. */
struct front_end {
    vec2 place, n, m;
};

/* A run and another body in the lanes `which`. */
struct body_beside {
    vm is_a, edged, known; /* is the run A? Has the body the form of a box or a capsule; or is it a circle, too? */
    struct ring ring;
    vi first, last; /* arcs of the caller's: that which is stored first, and the last one of the front */
    vi base;        /* the body's first record */
    vf scale;
    struct plain_body body;
    struct front_end begin, end;
};

/* The record of the caller's arc of a number. */
INLINE vi find_run_record(struct ring ring, vi first, vi number) {
    const vi stored = vi_sub(number, first);
    return vi_add(ring.base, vi_select(vi_lt(stored, vi_set(0)), vi_add(stored, ring.count), stored));
}

/* Other lanes have the first records of all, of which there are as many as a run has. */
INLINE struct body_beside load_body_beside(const narc_shapes *shapes, vm which, const vf item[FIELDS]) {
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B), zero = vi_set(0);
    const vi first_a = get_item_bits(item, FIRST_RECORD_A), first_b = get_item_bits(item, FIRST_RECORD_B);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN);
    const vi info = vi_select(is_a, info_a, info_b), other_info = vi_select(is_a, info_b, info_a);
    const struct ring ring = make_ring(vi_select(is_a, first_a, first_b), info);
    const vec2 position = {item[POSITION], item[POSITION + 1]}, rotation = {item[ROTATION], item[ROTATION + 1]};
    const vf other_scale = v_select(is_a, item[SCALE_B], item[SCALE_A]);
    struct body_beside out = {.is_a = is_a,
                              .ring = {vi_select(which, ring.base, zero), vi_select(which, ring.count, vi_set(6))},
                              .first = vi_select(which, get_first_arc(info), zero),
                              .base = find_first_arc(vi_select(is_a, first_b, first_a), other_info),
                              .scale = v_select(is_a, item[SCALE_A], item[SCALE_B])};
    vf form[4], begin[8], end[8];
    int32_t index[V_WIDTH];
    vi_store(index, get_item_bits(item, BODY_SHAPE));
    v_rows(shapes->boxes, sizeof *shapes->boxes, index, form);
    out.last = vi_sub(out.ring.count, vi_set(5));
    load_records(shapes->records, find_run_record(out.ring, out.first, zero), begin);
    load_records(shapes->records, find_run_record(out.ring, out.first, out.last), end);
    const vi kind = vi_bits(form[3]);
    const vm round = has_flag(other_info, NARC_SHAPE_CIRCLE);
    out.edged = vi_lt(zero, vi_and(kind, vi_set((int32_t)(NARC_IS_BOX | NARC_IS_CAPSULE))));
    out.known = vm_or(round, vi_lt(zero, kind));
    out.body = (struct plain_body){.center = v2_select(is_a, position, v2_unrotate_opposite(rotation, position)),
                                   .x_axis = {rotation.x, v_select(is_a, rotation.y, v_neg(rotation.y))},
                                   .capsule = vi_lt(zero, vi_and(kind, vi_set((int32_t)NARC_IS_CAPSULE)))};
    if (vm_any(round)) {
        vf circle[4];
        vi_store(index, out.base);
        v_rows(shapes->records, sizeof *shapes->records, index, circle);
        const vec2 offset = v2_scale((vec2){circle[0], circle[1]}, other_scale);
        out.body.center =
            v2_select(round, v2_add(out.body.center, v2_rotate(out.body.x_axis, offset)), out.body.center);
        for (int f = 0; f < 3; f++)
            form[f] = v_select(round, f < 2 ? v_set(0) : circle[2], form[f]);
    }
    out.body.half_x = v_mul(form[0], other_scale);
    out.body.half_y = v_select(out.body.capsule, v_set(0), v_mul(form[1], other_scale));
    out.body.radius = v_mul(form[2], other_scale);
    out.begin =
        (struct front_end){v2_scale((vec2){begin[0], begin[1]}, out.scale), {begin[6], begin[7]}, {begin[4], begin[5]}};
    out.end = (struct front_end){v2_scale((vec2){end[0], end[1]}, out.scale), {end[4], end[5]}, {end[6], end[7]}};
    return out;
}

INLINE vm is_beyond(const struct plain_body *body, const struct front_end *end, vec2 other_n, bool is_last, vf slack) {
    const vf zero = v_set(0);
    const vec2 n = end->n, axis = body->x_axis, way = v2_sub(body->center, end->place);
    const vec2 corner = {v_select(v_lt(zero, v2_dot(axis, n)), v_neg(body->half_x), body->half_x),
                         v_select(v_lt(zero, v2_cross(axis, n)), v_neg(body->half_y), body->half_y)};
    const vec2 p = v2_add(way, v2_sub(v2_rotate(axis, corner), v2_scale(n, body->radius)));
    const vf beyond = is_last ? v2_cross(n, p) : v2_cross(p, n);
    const vf x_m = v_mul(body->half_x, v_abs(v2_dot(axis, end->m))),
             y_m = v_mul(body->half_y, v_abs(v2_cross(axis, end->m)));
    const vf along_m = v_sub(v2_dot(way, end->m), v_add(v_add(x_m, y_m), body->radius));
    const vf most = v_max(v2_dot(p, n), v2_dot(p, other_n));
    return vm_and(v_le(zero, beyond), v_lt(v_add(most, slack), along_m));
}

/* Of pairs in the lanes `open`, those that are not known to lie beside the front of a run. */
INLINE vm drop_beside(const struct body_beside *pair, vm open, vf slack) {
    const vm beyond = vm_or(is_beyond(&pair->body, &pair->begin, pair->end.n, false, slack),
                            is_beyond(&pair->body, &pair->end, pair->begin.n, true, slack));
    return vm_and_not(open, vm_and(pair->known, beyond));
}

#endif
