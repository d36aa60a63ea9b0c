/* SPDX-License-Identifier: MIT
 *
 * point_rows.inl - how far points are from bodies, and the rows that say so.
 *
 * The separation of a point p is the largest p.n - h(n) of all normals n, h the support function. Over an arc with the
 * centre c and the radius r, u = p - c, that is u.n - r: |u| - r if the arc holds the direction of u, else the larger
 * value at its two ends. The ends are normals of junctions, and so those of edges. Nothing is lost between two arcs: a
 * sign that rounding turns takes |u| for the value at the end of the arc, or that for |u|, and both are the same there.
 *
 * u is taken from the middle of the shape's bounding circle, where p is placed in double precision. So it has no error
 * but that in proportion to the body's own size and the distance to it.
 */
#ifndef NARC_SCENE_POINT_ROWS_INL
#define NARC_SCENE_POINT_ROWS_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/contact_point.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "column.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/concave.inl"
#include "scene/piece_places.inl"
#include "simd/simd.h"

/* Is a point within a body? In nearest.c. */
bool NARC_NAMED(is_within)(const struct body_frame *frame, place point);

/* ------------------------------------------------------------------------------------------------ separations */

/* From an arc's centre to a point: does u.n rise at the arc's start, and fall at its end; |u|, and u.n there. */
struct arc_view {
    vm rises, falls, holds;
    vf length, at_start, at_end;
};

/* Sweeps are at most half a turn, and far above a rounding: two signs tell that the arc holds the direction. Where
 * |u|^2 has lost its digits the ends serve: what they lack is less than any rounding of the body. */
INLINE struct arc_view view_arc(vec2 u, vec2 start, vec2 end) {
    const vf square = v2_dot(u, u), zero = v_set(0);
    const vm rises = v_le(zero, v2_cross(start, u)), falls = v_le(zero, v2_cross(u, end));
    const vm holds = vm_and(vm_and(rises, falls), v_le(v_set(LEAST_SQUARE), square));
    return (struct arc_view){rises, falls, holds, v_sqrt(square), v2_dot(u, start), v2_dot(u, end)};
}

INLINE vf find_arc_separation(const struct arc_view *view, vf radius) {
    return v_sub(v_select(view->holds, view->length, v_max(view->at_start, view->at_end)), radius);
}

/* A point as a body sees it: in its axes and the world's unit, from the middle of the bounding circle. False if
 * there is no answer. */
INLINE bool place_point(const struct body_frame *frame, place point, float *out_x, float *out_y) {
    const place from = {point.x - frame->position.x, point.y - frame->position.y};
    if (!(fabs(from.x) <= NARC_MAX_DISTANCE && fabs(from.y) <= NARC_MAX_DISTANCE)) /* or NaN */
        return false;
    const place turned = turn_to_shape(frame, from);
    *out_x = (float)(turned.x - frame->scale * (double)frame->header->bound_x);
    *out_y = (float)(turned.y - frame->scale * (double)frame->header->bound_y);
    return true;
}

INLINE place load_point(const narc_points *points, size_t k) {
    return (place){narc_position_at(points->x, k), narc_position_at(points->y, k)};
}

/* ------------------------------------------------------------------------------------------------ rows */

/* A point and a body that wait for their row: eight numbers for two vectors of rows. */
struct point_query {
    float x, y; /* see place_point() */
    float cosine, sine, scale;
    uint32_t shape, point, body;
    char *row;
};

struct point_queries {
    struct point_query item[V_WIDTH];
    int count;
};

/* Values of places that are far apart along the outline may be the same but for rounding, where normals turn little.
 * The place is seen from a point nearby, so signs choose: a PROPER place is an arc that holds the direction of u, or
 * a junction where u.n rises before it and falls behind. It counts for more by what a separation may be off by, 4 e
 * of the lengths in it, and any other for as much less. */
#define TIE 0x1p-22f

/* The nearest place of the outline. */
struct nearest {
    vf separation;
    vf value; /* with the tie */
    vec2 normal;
    vf length; /* of the normal */
    vi record; /* of the arc */
};

/* The nearest place on an arc, or at its ends. `rises`: u.n rises at the end of the arc before. */
INLINE struct nearest find_nearest_on(const narc_record *records, vi record, vec2 point, vec2 middle, vf scale,
                                      vm *rises) {
    vf field[8];
    load_records(records, record, field);
    const vec2 center = {field[0], field[1]}, start = {field[4], field[5]}, end = {field[6], field[7]};
    const vec2 u = v2_sub(point, v2_scale(v2_sub(center, middle), scale));
    const struct arc_view view = view_arc(u, start, end);
    const vf radius = v_mul(field[2], scale), separation = find_arc_separation(&view, radius);
    const vm kink = vm_and_not(*rises, view.rises), at_start = vm_or(kink, v_le(view.at_end, view.at_start));
    const vf size = v_mul(v_add(v_add(v_abs(center.x), v_abs(center.y)), field[2]), scale);
    const vf tie = v_mul(v_set(TIE), v_add(view.length, size));
    const vf value = v_select(kink, v_sub(view.at_start, radius), separation);
    *rises = vm_not(view.falls);
    return (struct nearest){separation, v_add(value, v_select(vm_or(kink, view.holds), tie, v_neg(tie))),
                            v2_select(view.holds, u, v2_select(at_start, start, end)),
                            v_select(view.holds, view.length, v_set(1)), record};
}

/* That of the whole outline; of equal ones, that on the first arc. */
INLINE struct nearest find_nearest_place(const narc_record *records, struct ring ring, vec2 point, vec2 middle,
                                         vf scale) {
    vm rises = vm_front(0);
    const vi last = vi_sub(vi_add(ring.base, ring.count), vi_set(1));
    struct nearest best = find_nearest_on(records, last, point, middle, scale, &rises);
    best.value = best.separation = v_set(-INFINITY); /* it comes again: here it tells whether u.n rises */
    for (int k = 0; k < NARC_MAX_ARCS; k++) {
        const vm more = vi_lt(vi_set(k), ring.count);
        if (!vm_any(more))
            break;
        const vi record = vi_select(more, vi_add(ring.base, vi_set(k)), last);
        const struct nearest next = find_nearest_on(records, record, point, middle, scale, &rises);
        const vm better = vm_and(more, v_lt(best.value, next.value)); /* its last arc again would be another one's */
        best = (struct nearest){v_select(more, v_max(next.separation, best.separation), best.separation),
                                v_select(better, next.value, best.value), v2_select(better, next.normal, best.normal),
                                v_select(better, next.length, best.length), vi_select(better, record, best.record)};
    }
    return best;
}

INLINE void put_nothing(narc_distance *row, size_t point) { *row = (narc_distance){.point = (uint32_t)point}; }

/* Takes rows back whose point is nearest to what closes a run behind (store.h). */
INLINE void take_back(const narc_shapes *shapes, const struct point_query *item, int count) {
    for (int k = 0; NARC_PIECES && k < count; k++) {
        narc_distance *const row = (narc_distance *)(void *)item[k].row;
        if (!narc_touches(&shapes->headers[item[k].shape], row->feature))
            put_nothing(row, item[k].point);
    }
}

/* The row of a point and a concave arc, if the line from the centre through the point meets the arc. */
INLINE void answer_concave(const struct body_frame *frame, place point, uint32_t number, uint32_t body,
                           narc_distance *row) {
    const struct concave_arc arc = place_concave(frame);
    const place from = {point.x - frame->position.x, point.y - frame->position.y};
    const place u = {from.x - arc.center.x, from.y - arc.center.y};
    const double length = sqrt(find_dot(u, u));
    const place normal = length > 0 ? (place){-u.x / length, -u.y / length} : find_middle_normal(&arc);
    put_nothing(row, number);
    if (!holds_normal(&arc, normal))
        return;
    *row = (narc_distance){.point = number,
                           .body = body,
                           .count = 1,
                           .separation = (float)(arc.radius - length),
                           .normal_x = (float)normal.x,
                           .normal_y = (float)normal.y,
                           .place_x = (float)(arc.center.x - arc.radius * normal.x),
                           .place_y = (float)(arc.center.y - arc.radius * normal.y),
                           .radius = -(float)arc.radius};
}

/* Writes the rows of those that wait. The lanes behind the last one repeat the first, and its row. */
NOINLINE void answer(const narc_shapes *shapes, struct point_queries *waiting) {
    const narc_record *records = shapes->records;
    int32_t item[V_WIDTH], shape[V_WIDTH];
    char *row[V_WIDTH];
    vf pose_words[4], words[4];
    if (waiting->count == 0)
        return;
    for (int k = 0; k < V_WIDTH; k++) {
        item[k] = k < waiting->count ? k : 0;
        shape[k] = (int32_t)waiting->item[item[k]].shape;
        row[k] = waiting->item[item[k]].row;
    }
    const int count = waiting->count;
    waiting->count = 0;
    v_rows(&waiting->item[0].x, sizeof waiting->item[0], item, pose_words);
    v_rows(&waiting->item[0].scale, sizeof waiting->item[0], item, words);
    const struct headers header = load_headers(shapes->headers, shape);
    const vec2 point = {pose_words[0], pose_words[1]}, to_world = {pose_words[2], pose_words[3]};
    const vec2 middle = header.bound_center;
    const vf scale = words[0];
    const struct ring ring = make_ring(header.first_record, header.info);
    const struct pose pose = {.scale_a = scale};
    const struct nearest found = find_nearest_place(records, ring, point, middle, scale);
    const vec2 n = v2_divide(found.normal, found.length);
    const struct feature f = find_feature_at(records, ring, found.record, &pose, n, false);
    const vm edge = touches_edge(&f, header.info, scale);
    /* The foot of the point on the edge, and not beyond its ends. */
    const vf along = v2_cross(n, v2_add(point, v2_scale(middle, scale)));
    const vec2 foot = {f.across, v_min(v_max(along, f.along_min), f.along_max)};
    const vec2 nearest = v2_rotate(to_world, v2_rotate(n, foot)), normal = v2_rotate(to_world, n);
    const vi number = find_arc_number(f.record, header.first_record, header.info);
    const vi feature = vi_add(number, vi_select(edge, vi_set(NARC_FEATURE_EDGE), vi_set(0)));
    const vf front[4] = {words[2], words[3], v_of_bits(pack_halves(feature, vi_set(1))), found.separation};
    const vf rest[4] = {normal.x, normal.y, nearest.x, nearest.y};
    float radius[V_WIDTH];
    v_store(radius, v_select(edge, v_set(INFINITY), f.radius));
    _Static_assert(sizeof(narc_distance) == 36 && offsetof(narc_distance, normal_x) == 16, "two writes and a float");
    v_put_rows(row, 0, front);
    v_put_rows(row, 16, rest);
    for (int k = 0; k < V_WIDTH; k++)
        memcpy(row[k] + 32, &radius[k], sizeof radius[k]);
    take_back(shapes, waiting->item, count);
}

/* Sees to it that the row of a point and a body is written, now or when others have come. */
INLINE void ask(const narc_point_batch *batch, size_t point, size_t body, narc_distance *row,
                struct point_queries *waiting) {
    struct body_frame frame;
    float x, y;
    if (!load_body_frame(batch->shapes, batch->bodies, body, &frame) ||
        !place_point(&frame, load_point(batch->points, point), &x, &y)) {
        put_nothing(row, point);
        return;
    }
    if (has_mark_of(&frame, NARC_PIECE_PLANE)) {
        struct piece_place nearest;
        put_nothing(row, point);
        if (find_piece_place(&frame, load_point(batch->points, point), &nearest))
            *row = make_piece_row(&frame, &nearest, point, (uint32_t)body);
        return;
    }
    if (has_mark_of(&frame, NARC_PIECE_CONCAVE)) {
        answer_concave(&frame, load_point(batch->points, point), (uint32_t)point, (uint32_t)body, row);
        return;
    }
    waiting->item[waiting->count++] = (struct point_query){x,
                                                           y,
                                                           (float)frame.rotation.x,
                                                           (float)frame.rotation.y,
                                                           (float)frame.scale,
                                                           (uint32_t)(frame.header - batch->shapes->headers),
                                                           (uint32_t)point,
                                                           (uint32_t)body,
                                                           (char *)row};
    if (waiting->count == V_WIDTH)
        answer(batch->shapes, waiting);
}

#endif
