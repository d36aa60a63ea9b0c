/* SPDX-License-Identifier: MIT
 *
 * points.c - the kernels of points that name their bodies: how far each is from one, and whether it is within.
 */
#include <stdbool.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/contact_point.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/piece_places.inl"
#include "scene/point_rows.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

void NARC_NAMED(distance)(const narc_point_batch *batch, size_t first, size_t end) {
    struct point_queries waiting;
    waiting.count = 0;
    for (size_t k = first; k < end; k++)
        ask(batch, k, batch->body.base ? narc_index_at(batch->body, k) : k, batch->out + k, &waiting);
    answer(batch->shapes, &waiting);
}

/* ------------------------------------------------------------------------------------------------ within */

/* As place_point(), points from k on, in lanes. One without an answer lies outside of all that there is. */
INLINE vec2 place_points(const struct body_frame *frame, const narc_points *points, size_t k, int lanes) {
    double x[V_WIDTH], y[V_WIDTH];
    vd out_x[V_WIDTH / D_WIDTH], out_y[V_WIDTH / D_WIDTH];
    const vd limit = d_set(NARC_MAX_DISTANCE), nowhere = d_set(8 * NARC_MAX_DISTANCE);
    const vd c = d_set(frame->rotation.x), s = d_set(frame->rotation.y);
    const vd middle_x = d_set(frame->scale * (double)frame->header->bound_x);
    const vd middle_y = d_set(frame->scale * (double)frame->header->bound_y);
    for (int l = 0; l < V_WIDTH; l++) {
        const place point = load_point(points, k + (size_t)(l < lanes ? l : 0));
        x[l] = point.x;
        y[l] = point.y;
    }
    UNROLL
    for (int h = 0; h < V_WIDTH / D_WIDTH; h++) {
        const int l = h * D_WIDTH;
        const vd from_x = d_load(x + l) - d_set(frame->position.x), from_y = d_load(y + l) - d_set(frame->position.y);
        const vl near = d_le(d_abs(from_x), limit) & d_le(d_abs(from_y), limit);
        out_x[h] = d_select(near, c * from_x + s * from_y - middle_x, nowhere);
        out_y[h] = d_select(near, c * from_y - s * from_x - middle_y, nowhere);
    }
    return (vec2){d_join_floats(out_x), d_join_floats(out_y)};
}

/* Is the separation of points below 0? As find_separation(), with points in lanes. */
INLINE vm are_within(const struct body_frame *frame, vec2 point) {
    const vec2 middle = {v_set(frame->header->bound_x), v_set(frame->header->bound_y)};
    const vf scale = v_set((float)frame->scale), zero = v_set(0);
    vm within = vm_front(V_WIDTH);
    for (int k = 0; k < (int)frame->header->count && vm_any(within); k++) {
        const narc_stored_arc *const arc = &frame->arcs[k].arc;
        const vec2 center = {v_set(arc->center_x), v_set(arc->center_y)};
        const vec2 u = v2_sub(point, v2_scale(v2_sub(center, middle), scale));
        const struct arc_view view =
            view_arc(u, (vec2){v_set(arc->start_x), v_set(arc->start_y)}, (vec2){v_set(arc->end_x), v_set(arc->end_y)});
        within = vm_and(within, v_lt(find_arc_separation(&view, v_mul(v_set(arc->radius), scale)), zero));
    }
    return within;
}

/* Points that follow each other and ask of one body go in lanes. */
void NARC_NAMED(inside)(const narc_point_batch *batch, size_t first, size_t end, uint64_t *out_bits) {
    enum { LEAST = V_WIDTH > 1 ? 3 : 1 };
    for (size_t word = first / 64; 64 * word < end; word++)
        out_bits[word] = 0;
    for (size_t k = first, next; k < end; k = next) {
        const narc_index_column column = batch->body;
        const size_t body = column.base ? narc_index_at(column, k) : k;
        struct body_frame frame;
        for (next = k + 1; next < end && column.base && narc_index_at(column, next) == body;)
            next++;
        if (!load_body_frame(batch->shapes, batch->bodies, body, &frame))
            continue;
        for (struct piece_place at; has_mark_of(&frame, NARC_PIECE_PLANE) && k < next; k++)
            out_bits[k / 64] |=
                (uint64_t)(find_piece_place(&frame, load_point(batch->points, k), &at) && at.separation < 0) << k % 64;
        if (narc_is_piece(frame.header))
            continue;
        for (int lanes; k < next; k += (size_t)lanes) {
            const size_t left = next - k;
            const bool alone = left < LEAST;
            lanes = alone ? 1 : left < V_WIDTH ? (int)left : V_WIDTH;
            const vm within = alone ? vm_front(0) : are_within(&frame, place_points(&frame, batch->points, k, lanes));
            const uint64_t bits = alone ? NARC_NAMED(is_within)(&frame, load_point(batch->points, k))
                                        : vm_bits(vm_and(within, vm_front(lanes)));
            out_bits[k / 64] |= bits << k % 64;
            if (k % 64 + (size_t)lanes > 64)
                out_bits[k / 64 + 1] |= bits >> (64 - k % 64);
        }
    }
}
