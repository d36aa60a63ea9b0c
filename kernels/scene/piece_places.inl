/* SPDX-License-Identifier: MIT
 *
 * piece_places.inl - the place of a piece of a chain (store.h) nearest to a point: on the front of a run, as an open
 * curve, or on a concave arc, their ends among them; in double precision.
 *
 * Inside an arc or an edge the line to the nearest place is along the normal there. Where rounding takes a point from
 * both sides of a junction, the ends of arcs serve: they are all asked.
 */
#ifndef NARC_SCENE_PIECE_PLACES_INL
#define NARC_SCENE_PIECE_PLACES_INL

#include <math.h>
#include <stdbool.h>

#include "scene/body_frame.inl"

/* In the shape's coordinates. Of a half-plane both distances are below 0 in it. */
struct piece_place {
    place at, normal;
    double distance, separation; /* below 0 behind the tangent of the place; the other never, with END_ROOM */
    double radius;
    unsigned feature;
};

/* Of the point's distance from a place this part says nothing of the direction between them. */
#define PLACE_ROOM 0x1p-24

/* A piece reaches beyond its end, perhaps into the air: a concave arc by a seam of 2e-5 radians, a run where a corner is cut
 * by a fin, 2^-18 of the way to its first far corner (chain_pieces.c). So its ends count as further away by more than that:
 * what is beside them is nearer. */
#define CONCAVE_ROOM 0x1p-15
#define RUN_ROOM     0x1p-17

/* And all ends within a run by this part of that, which is more than what rounding moves them by: at a corner its own sector
 * tells the side, not the arc before it. */
#define CORNER_PART 0x1p-3

/* Takes a place with this outward normal, where it is nearer. At an end, which counts as further away by `room`, the normal
 * is turned to the point; below 0: it is none. */
INLINE void take_place(struct piece_place *best, place point, place at, place normal, double room, double radius,
                       unsigned feature) {
    const place d = add_scaled(point, -1, at);
    const double distance = find_length(d), separation = find_dot(d, normal) < 0 ? -distance : distance;
    const bool is_end = room >= 0;
    const double counted = is_end ? distance + room : distance;
    if (!(counted < best->distance))
        return;
    if (is_end && distance > PLACE_ROOM * (fabs(at.x) + fabs(at.y)))
        normal = (place){d.x / separation, d.y / separation};
    *best = (struct piece_place){at, normal, counted, separation, radius, feature};
}

/* An arc of the front, or a concave one. `room`: of its ends. */
INLINE void look_at_arc(struct piece_place *best, place point, const narc_stored_arc *arc, unsigned feature,
                        double room) {
    const double radius = (double)arc->radius;
    const place center = get_center(arc), u = add_scaled(point, -1, center);
    const place start = get_start(arc), end = get_end(arc);
    const double length = find_length(u), along = signbit(radius) ? -length : length;
    const place n = {u.x / along, u.y / along}; /* NaN at the centre, which is held by none */
    if (find_cross(start, n) >= 0 && find_cross(n, end) >= 0 && find_dot(start, n) + find_dot(end, n) > 0)
        take_place(best, point, add_scaled(center, radius, n), n, -1, radius, feature);
    if (signbit(radius) && !(radius < 0)) /* beside a valley's bottom lie lines that end there, which tell the side */
        return;
    take_place(best, point, add_scaled(center, radius, start), start, room, radius, feature);
    take_place(best, point, add_scaled(center, radius, end), end, room, radius, feature);
}

/* Arc `number` of the caller's, as it is stored. */
INLINE int find_stored(const struct body_frame *frame, int number) {
    const int count = frame->header->count, first = (int)(frame->header->first_arc & NARC_FIRST_ARC);
    return (number - first + count) % count;
}

INLINE double find_end_room(const struct body_frame *frame) {
    const int count = frame->header->count;
    const narc_stored_arc *const end = &frame->arcs[find_stored(frame, count - 5)].arc,
                                 *const far = &frame->arcs[find_stored(frame, count - 4)].arc;
    const place way = {(double)far->center_x - (double)end->center_x, (double)far->center_y - (double)end->center_y};
    return RUN_ROOM * find_length(way);
}

/* What is in front of a run's arc `number` of the caller's, 1 ... count - 5: the edge before it, and the arc itself, but
 * for the last one, which is the end. `room`: of the run's ends, as of its last arc: that may be at the end of a fin. */
INLINE void look_at_front(struct piece_place *best, place point, const struct body_frame *frame, int number,
                          double room) {
    const int count = frame->header->count, stored = find_stored(frame, number);
    const narc_stored_arc *const arc = &frame->arcs[stored].arc;
    const narc_stored_arc *const before = &frame->arcs[(stored + count - 1) % count].arc;
    const place normal = get_start(arc);
    const place from = add_scaled(get_center(before), (double)before->radius, normal);
    const place to = add_scaled(get_center(arc), (double)arc->radius, normal);
    const place edge = add_scaled(to, -1, from);
    const double part = find_dot(add_scaled(point, -1, from), edge) / find_dot(edge, edge);
    const bool is_edge = is_edge_before(frame, stored), is_last = number + 5 == count;
    const unsigned own = (unsigned)number, feature = is_edge ? own + NARC_FEATURE_EDGE : is_last ? own - 1 : own;
    const double radius = is_edge ? INFINITY : (double)(is_last ? before : arc)->radius;
    if (is_edge && part > 0 && part < 1)
        take_place(best, point, add_scaled(from, part, edge), normal, -1, radius, feature);
    if (number == 1)
        take_place(best, point, from, normal, room, radius, feature);
    if (is_last)
        take_place(best, point, to, normal, room, radius, feature);
    else
        look_at_arc(best, point, arc, own, number + 6 == count ? room : CORNER_PART * room);
}

/* The nearest place of a piece. False if there is no answer. */
INLINE bool find_piece_place(const struct body_frame *frame, place point, struct piece_place *out) {
    const place from = {point.x - frame->position.x, point.y - frame->position.y};
    if (!(fabs(from.x) <= NARC_MAX_DISTANCE && fabs(from.y) <= NARC_MAX_DISTANCE)) /* or NaN */
        return false;
    const place turned = turn_to_shape(frame, from);
    const place own = {turned.x * frame->inverse_scale, turned.y * frame->inverse_scale};
    *out = (struct piece_place){.distance = INFINITY};
    if (has_mark_of(frame, NARC_PIECE_PLANE))
        *out = (struct piece_place){{own.x, 0}, {0, 1}, own.y, own.y, INFINITY, NARC_FEATURE_EDGE};
    if (has_mark_of(frame, NARC_PIECE_CONCAVE))
        look_at_arc(out, own, &frame->arcs[0].arc, 0, CONCAVE_ROOM * fabs((double)frame->arcs[0].arc.radius));
    const bool is_run = has_mark_of(frame, NARC_PIECE_RUN);
    const double room = is_run ? find_end_room(frame) : 0;
    for (int number = 1; is_run && number + 5 <= frame->header->count; number++)
        look_at_front(out, own, frame, number, room);
    return out->distance < INFINITY;
}

/* Its row. */
INLINE narc_distance make_piece_row(const struct body_frame *frame, const struct piece_place *nearest, size_t point,
                                    uint32_t body) {
    const place normal = turn_to_world(frame, nearest->normal), at = turn_to_world(frame, nearest->at);
    return (narc_distance){.point = (uint32_t)point,
                           .body = body,
                           .feature = (uint16_t)nearest->feature,
                           .count = 1,
                           .separation = (float)(frame->scale * nearest->separation),
                           .normal_x = (float)normal.x,
                           .normal_y = (float)normal.y,
                           .place_x = (float)(frame->scale * at.x),
                           .place_y = (float)(frame->scale * at.y),
                           .radius = (float)(frame->scale * nearest->radius)};
}

#endif
