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
#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "piece/pieces.inl"
#include "simd/simd.h"

/* A body with the form of a box, a capsule or a circle, in the frame of a run at world scale. */
struct plain_body {
    vec2 center, x_axis; /* that is as long as the half side along it */
    vec2 y_axis;
    vf radius;
};

/* An end of a front: of the arc that turns from it to the closure. */
INLINE vm is_beyond(const struct plain_body *body, vec2 end, vec2 n, vec2 m, vec2 other_n, bool is_last, vf slack) {
    const vf zero = v_set(0);
    const vf x_n = v2_dot(body->x_axis, n), y_n = v2_dot(body->y_axis, n);
    const vf x_m = v_abs(v2_dot(body->x_axis, m)), y_m = v_abs(v2_dot(body->y_axis, m));
    const vec2 way = v2_sub(body->center, end);
    const vec2 x = v2_scale(body->x_axis, v_select(v_lt(zero, x_n), v_set(-1), v_set(1)));
    const vec2 y = v2_scale(body->y_axis, v_select(v_lt(zero, y_n), v_set(-1), v_set(1)));
    const vec2 p = v2_add(way, v2_sub(v2_add(x, y), v2_scale(n, body->radius)));
    const vf beyond = is_last ? v2_cross(n, p) : v2_cross(p, n);
    const vf along_m = v_sub(v2_dot(way, m), v_add(v_add(x_m, y_m), body->radius));
    const vf most = v_max(v2_dot(p, n), v2_dot(p, other_n));
    return vm_and(v_le(zero, beyond), v_lt(v_add(most, slack), along_m));
}

/* Of pairs in the lanes `open`, those that are not known to lie beside the front of a run. */
NOINLINE vm drop_beside(const struct call *call, vm open, const vf item[FIELDS]) {
    const narc_shapes *const shapes = call->batch->shapes;
    const vi info_a = get_item_bits(item, INFO_A), info_b = get_item_bits(item, INFO_B);
    const vm is_a = has_mark(info_a, NARC_PIECE_RUN), run = vm_xor(is_a, has_mark(info_b, NARC_PIECE_RUN));
    if (!vm_any(vm_and(open, run)))
        return open;
    const vf scale = v_select(is_a, item[SCALE_A], item[SCALE_B]);
    const vf other_scale = v_select(is_a, item[SCALE_B], item[SCALE_A]);
    const vi first_a = get_item_bits(item, FIRST_RECORD_A), first_b = get_item_bits(item, FIRST_RECORD_B);
    const vi info = vi_select(is_a, info_a, info_b);
    const vi base = find_first_arc(vi_select(is_a, first_a, first_b), info), count = get_arc_count(info);
    const vec2 position = {item[POSITION], item[POSITION + 1]}, rotation = {item[ROTATION], item[ROTATION + 1]};

    vf form[4], field[2][8];
    int32_t index[V_WIDTH];
    vi_store(index, get_item_bits(item, BODY_SHAPE));
    v_rows(shapes->boxes, sizeof *shapes->boxes, index, form);
    for (int last = 0; last < 2; last++) { /* the arcs 0 and count - 5 of the caller's */
        const vi number = vi_sub(last ? vi_sub(count, vi_set(5)) : vi_set(0), get_first_arc(info));
        const vi stored = vi_select(vi_lt(number, vi_set(0)), vi_add(number, count), number);
        load_records(shapes->records, vi_select(run, vi_add(base, stored), base), field[last]);
    }

    const vm known = vi_lt(vi_set(0), vi_bits(form[3]));
    const vec2 x = {rotation.x, v_select(is_a, rotation.y, v_neg(rotation.y))};
    const vec2 at = v2_select(is_a, position, v2_unrotate_opposite(rotation, position));
    const struct plain_body body = {.center = at,
                                    .x_axis = v2_scale(x, v_mul(form[0], other_scale)),
                                    .y_axis = v2_scale((vec2){v_neg(x.y), x.x}, v_mul(form[1], other_scale)),
                                    .radius = v_mul(form[2], other_scale)};
    const vec2 begin = v2_scale((vec2){field[0][0], field[0][1]}, scale);
    const vec2 end = v2_scale((vec2){field[1][0], field[1][1]}, scale);
    const vec2 n_begin = {field[0][6], field[0][7]}, m_begin = {field[0][4], field[0][5]};
    const vec2 n_end = {field[1][4], field[1][5]}, m_end = {field[1][6], field[1][7]};
    const vm beyond = vm_or(is_beyond(&body, begin, n_begin, m_begin, n_end, false, item[SLACK]),
                            is_beyond(&body, end, n_end, m_end, n_begin, true, item[SLACK]));
    return vm_and_not(open, vm_and(vm_and(run, known), beyond));
}

#endif
