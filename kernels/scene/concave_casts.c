/* SPDX-License-Identifier: MIT
 *
 * concave_casts.c - the kernel of one time of impact with a concave arc of a chain.
 *
 * With u from the arc's centre to that of an arc of the other body, R and r their radii, the bodies are R - |u| - r
 * apart there, if u lies in both sectors; else an end of the concave arc is nearest. What does not turn is found at
 * once: u moves along a line, and leaves the circle of R - r - target at the larger root. What turns advances by what is
 * left, divided by the speed of the fastest point (Mirtich 1996).
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "elementary.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/concave.inl"

/* Contacts after which a cast that turns is unfinished. */
enum { MOST_CONTACTS = 1024 };

/* The bodies at a time, from A's position. */
struct scene {
    struct body_frame ground, body;
    struct concave_arc arc; /* from the ground's position */
};

/* Where they are nearest: on the ground, from its position; the normal points to the body. */
struct nearest {
    double separation;
    place normal, at;
    int arc; /* of the body, or the one behind its edge */
    bool on_edge, at_end;
    bool behind; /* what of the body is near is behind a run, and does not touch */
};

INLINE void place_side(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side, double time,
                       struct body_frame *out) {
    const struct narc_cast_side *const of = &casts->side[side];
    const double cosine = (double)of->cosine[slot], sine = (double)of->sine[slot];
    const double factor = find_inverse_length(cosine * cosine + sine * sine - 1);
    double turn_x = 1, turn_y = 0;
    if (of->angle[slot] != 0)
        narc_find_cosine((double)of->angle[slot] * time, &turn_x, &turn_y);
    out->position = side == 0 ? (place){0, 0}
                              : (place){casts->x[slot] + time * casts->motion_x[slot],
                                        casts->y[slot] + time * casts->motion_y[slot]};
    out->rotation = (place){factor * (turn_x * cosine - turn_y * sine), factor * (turn_y * cosine + turn_x * sine)};
    out->scale = (double)of->scale[slot];
    out->header = &shapes->headers[of->shape[slot]];
    out->arcs = narc_arcs_of(shapes, out->header);
}

INLINE bool is_concave(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side) {
    return (shapes->headers[casts->side[side].shape[slot]].first_arc & NARC_PIECE_CONCAVE) != 0;
}

/* `side`: which of them the ground is. */
INLINE struct scene place_scene(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side,
                                double time) {
    struct scene scene;
    place_side(shapes, casts, slot, side, time, &scene.ground);
    place_side(shapes, casts, slot, 1 - side, time, &scene.body);
    scene.arc = place_concave(&scene.ground);
    return scene;
}

/* From the concave arc's centre to that of an arc of the body. */
INLINE place find_way(const struct scene *scene, int arc) {
    const narc_stored_arc *const stored = &scene->body.arcs[arc].arc;
    const place center = turn_to_world(&scene->body, (place){scene->body.scale * (double)stored->center_x,
                                                             scene->body.scale * (double)stored->center_y});
    return (place){scene->body.position.x + center.x - scene->ground.position.x - scene->arc.center.x,
                   scene->body.position.y + center.y - scene->ground.position.y - scene->arc.center.y};
}

INLINE double get_radius(const struct scene *scene, int arc) {
    return scene->body.scale * (double)scene->body.arcs[arc].arc.radius;
}

/* Is this arc's place that is furthest along u one that may touch? */
INLINE bool may_touch(const struct scene *scene, int arc, place u) {
    const narc_shape_header *const header = scene->body.header;
    const narc_stored_arc *const stored = &scene->body.arcs[arc].arc;
    const place own = turn_to_shape(&scene->body, u);
    const bool held = find_cross((place){(double)stored->start_x, (double)stored->start_y}, own) >= 0 &&
                      find_cross(own, (place){(double)stored->end_x, (double)stored->end_y}) >= 0;
    return held && narc_touches(header, find_feature_number(header, arc, false)) &&
           holds_normal(&scene->arc, (place){-u.x, -u.y});
}

INLINE void compare_arc(const struct scene *scene, int arc, struct nearest *best) {
    place u = find_way(scene, arc);
    const double length = sqrt(find_dot(u, u)), separation = scene->arc.radius - length - get_radius(scene, arc);
    if (separation >= best->separation)
        return;
    if (length == 0) {
        const place middle = find_middle_normal(&scene->arc);
        u = (place){-middle.x, -middle.y};
    }
    if (!may_touch(scene, arc, u))
        return;
    const double size = sqrt(find_dot(u, u));
    const place n = {-u.x / size, -u.y / size};
    *best =
        (struct nearest){separation,
                         n,
                         {scene->arc.center.x - scene->arc.radius * n.x, scene->arc.center.y - scene->arc.radius * n.y},
                         arc,
                         false,
                         false,
                         false};
}

/* An end of the concave arc, where `normal` is its normal: how far is it from the body? The largest gap of all normals
 * of the body is at one of its arcs or junctions. */
INLINE void compare_end(const struct scene *scene, place normal, struct nearest *best) {
    const struct body_frame *const body = &scene->body;
    const place at = {scene->arc.center.x - scene->arc.radius * normal.x,
                      scene->arc.center.y - scene->arc.radius * normal.y};
    const place from = {scene->ground.position.x + at.x - body->position.x,
                        scene->ground.position.y + at.y - body->position.y};
    const place own = turn_to_shape(body, from);
    struct nearest found = {-INFINITY, {0, 0}, at, 0, false, true, false};
    for (int k = 0; k < body->header->count; k++) {
        const narc_stored_arc *const arc = &body->arcs[k].arc;
        const place u = {own.x - body->scale * (double)arc->center_x, own.y - body->scale * (double)arc->center_y};
        const place start = {(double)arc->start_x, (double)arc->start_y},
                    end = {(double)arc->end_x, (double)arc->end_y};
        const double length = sqrt(find_dot(u, u));
        const bool held = length > 0 && find_cross(start, u) >= 0 && find_cross(u, end) >= 0;
        const double gap = (held ? length : find_dot(u, start)) - get_radius(scene, k);
        if (gap <= found.separation)
            continue;
        found.separation = gap;
        found.normal = held ? (place){u.x / length, u.y / length} : start;
        found.arc = k;
        found.on_edge = !held && is_edge_before(body, k);
    }
    if (found.separation >= best->separation)
        return;
    const place n = turn_to_world(body, found.normal);
    *best = found;
    best->behind = !narc_touches(body->header, find_feature_number(body->header, found.arc, found.on_edge));
    best->normal = (place){-n.x, -n.y};
}

/* The least separation; infinite if nothing of them may touch. */
INLINE struct nearest find_nearest(const struct scene *scene, bool with_ends) {
    struct nearest best = {INFINITY, {0, 0}, {0, 0}, 0, false, false, false};
    for (int arc = 0; arc < scene->body.header->count; arc++)
        compare_arc(scene, arc, &best);
    if (with_ends) {
        compare_end(scene, scene->arc.start, &best);
        compare_end(scene, scene->arc.end, &best);
    }
    return best;
}

/* A float that is not above a time of 0 or more. */
INLINE float round_time(double time) {
    const float rounded = (float)time;
    return (double)rounded > time ? rounded - rounded * 0x1p-24f : rounded;
}

INLINE void write_contact(const struct scene *scene, const struct nearest *n, int side, narc_contact *out) {
    const bool round = scene->body.header->flags & NARC_SHAPE_CIRCLE;
    const unsigned feature = round ? 0 : find_feature_number(scene->body.header, n->arc, n->on_edge);
    const double sign = side == 0 ? 1 : -1, half = n->separation / 2;
    const float curved = n->on_edge ? INFINITY : (float)get_radius(scene, n->arc);
    const float hollow = n->at_end ? 0 : -(float)scene->arc.radius;
    *out = (narc_contact){.feature = (uint16_t)(side == 0 ? feature << 8 : feature),
                          .count = 1,
                          .separation = (float)n->separation,
                          .normal_x = (float)(sign * n->normal.x),
                          .normal_y = (float)(sign * n->normal.y),
                          .point_x = (float)(scene->ground.position.x + n->at.x + half * n->normal.x),
                          .point_y = (float)(scene->ground.position.y + n->at.y + half * n->normal.y),
                          .radius_a = side == 0 ? hollow : curved,
                          .radius_b = side == 0 ? curved : hollow};
}

/* When does an arc that moves along a line leave the circle of `goal`, where it may touch? Infinite: never. */
INLINE double find_leaving(const struct scene *scene, int arc, double goal, place motion) {
    const place u = find_way(scene, arc);
    const double square = find_dot(motion, motion), across = find_cross(u, motion);
    const double height = goal * goal * square - across * across;
    if (!(goal >= 0) || !(square > 0) || height < 0)
        return INFINITY;
    const double time = (sqrt(height) - find_dot(u, motion)) / square;
    const place then = {u.x + time * motion.x, u.y + time * motion.y};
    return time >= 0 && may_touch(scene, arc, then) ? time : INFINITY;
}

INLINE int cast_straight(const narc_shapes *shapes, narc_casts *casts, size_t slot, int side) {
    const double sign = side == 0 ? 1 : -1, target = (double)casts->target;
    const place motion = {sign * casts->motion_x[slot], sign * casts->motion_y[slot]};
    struct scene scene = place_scene(shapes, casts, slot, side, 0);
    struct nearest nearest = find_nearest(&scene, false);
    double least = nearest.separation <= target ? 0 : INFINITY;
    for (int arc = 0; arc < scene.body.header->count; arc++)
        least =
            find_least(least, find_leaving(&scene, arc, scene.arc.radius - get_radius(&scene, arc) - target, motion));
    if (!(least <= 1))
        return NARC_CAST_MISS;
    casts->time[slot] = round_time(least);
    scene = place_scene(shapes, casts, slot, side, (double)casts->time[slot]);
    nearest = find_nearest(&scene, false);
    if (!(nearest.separation < INFINITY)) /* at the very end of a sector */
        nearest = find_nearest(&scene, true);
    write_contact(&scene, &nearest, side, &casts->contact[slot]);
    return nearest.separation < INFINITY && !nearest.behind ? NARC_CAST_HIT : NARC_CAST_MISS;
}

/* How fast the fastest point of a body moves because it turns. */
INLINE double find_turning_speed(const struct body_frame *frame, float angle) {
    const double x = (double)frame->header->bound_x, y = (double)frame->header->bound_y;
    return fabs((double)angle) * frame->scale * (sqrt(x * x + y * y) + (double)frame->header->bound_radius);
}

INLINE int cast_turning(const narc_shapes *shapes, narc_casts *casts, size_t slot, int side) {
    struct scene scene = place_scene(shapes, casts, slot, side, 0);
    const place motion = {casts->motion_x[slot], casts->motion_y[slot]};
    const double speed = sqrt(find_dot(motion, motion)) +
                         find_turning_speed(&scene.ground, casts->side[side].angle[slot]) +
                         find_turning_speed(&scene.body, casts->side[1 - side].angle[slot]);
    const double enough = (double)casts->target + casts->enough[slot];
    float time = casts->time[slot];
    for (int round = 0; round < MOST_CONTACTS; round++) {
        scene = place_scene(shapes, casts, slot, side, (double)time);
        const struct nearest nearest = find_nearest(&scene, true);
        write_contact(&scene, &nearest, side, &casts->contact[slot]);
        casts->time[slot] = time;
        if (nearest.separation <= enough)
            return nearest.behind ? NARC_CAST_UNFINISHED : NARC_CAST_HIT;
        const double next = (double)time + (nearest.separation - (double)casts->target) / speed;
        if (!(next <= 1))
            return NARC_CAST_MISS;
        if (round_time(next) <= time)
            return nearest.behind ? NARC_CAST_UNFINISHED : NARC_CAST_HIT;
        time = round_time(next);
    }
    return NARC_CAST_UNFINISHED;
}

/* Of a cast that has begun: the whole of it. Returns what becomes of it; time and contact are then the answer's. */
int NARC_NAMED(concave)(const narc_shapes *shapes, narc_casts *casts, size_t slot) {
    const int side = is_concave(shapes, casts, slot, 0) ? 0 : 1;
    if (is_concave(shapes, casts, slot, 1 - side))
        return NARC_CAST_MISS;
    return casts->turning[slot] > 0 ? cast_turning(shapes, casts, slot, side)
                                    : cast_straight(shapes, casts, slot, side);
}
