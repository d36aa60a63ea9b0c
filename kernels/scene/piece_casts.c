/* SPDX-License-Identifier: MIT
 *
 * piece_casts.c - the kernel of one time of impact with a piece of a chain: with a concave arc, or with a run from
 * where it is met from elsewhere than its front.
 *
 * A cast hits when the first contact is told whose separation is the target, or less. It goes on by times before which
 * there can be none (Mirtich 1996):
 *
 * With u from a concave arc's centre to that of an arc of the other body, R and r their radii, the bodies are R - |u|
 * - r apart there, if u lies in both sectors. So there is none before all of this can be, each by the speed of what
 * moves. What does not turn is found at once: u moves along a line, and leaves the circle of R - r - target at the
 * larger root.
 *
 * Of a run let f be the greatest gap of the closed shape, and g that along normals of the front. There is a contact
 * where f = g, and none before f - g can be 0, nor before f can be the target.
 *
 * What lies behind a piece, so that there is a contact which does not reach it (soa/piece.h), comes from behind until
 * there is none.
 */
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "chain.h"
#include "elementary.h"
#include "kernels.h"
#include "piece.h"
#include "scene/body_frame.inl"
#include "scene/cast_fields.inl"
#include "scene/concave.inl"

/* Contacts after which a cast that turns is unfinished. */
enum { MOST_CONTACTS = 1024, HALVINGS = 8 };

/* So much of a step behind a time signs are not those of rounding. */
#define JUST_BEHIND 0x1p-20

/* What goes along a side of a sector, within this angle, is within rounding of it for the whole step: which side of it is
 * chance, and so is when it would enter. */
#define ALONG_A_SIDE 1e-9

/* Is an arc, or the edge before it, what touches? */
static bool may_touch_at(const struct body_frame *frame, int arc, bool at_edge) {
    return narc_touches(frame->header, find_feature_number(frame->header, arc, at_edge));
}

/* The bodies at a time, from A's position. */
struct scene {
    struct body_frame ground, body;
    struct concave_arc arc; /* from the ground's position */
    bool front_only;        /* the caller's */
};

/* Where they are nearest: on the ground, from its position; the normal points to the body. */
struct nearest {
    double separation;
    place normal, at;
    int arc; /* of the body, or the one behind its edge */
    bool on_edge, at_end;
    bool unreached; /* is there a contact that does not reach the piece? */
};

/* One of two bodies with a contact along a normal of the world, as soa/piece.h wants it. */
static narc_contact_side make_contact_side(const struct body_frame *frame, const struct body_frame *other,
                                           place normal) {
    const place n = turn_to_shape(frame, normal),
                way = turn_to_shape(frame, subtract(other->position, frame->position));
    return (narc_contact_side){frame->header, frame->arcs, frame->scale, n.x, n.y, way.x, way.y};
}

static bool reach_each_other(const struct body_frame *a, const struct body_frame *b, place normal, double separation,
                             bool front_only) {
    const narc_contact_side of_a = make_contact_side(a, b, normal), of_b = make_contact_side(b, a, normal);
    return narc_is_reached(&of_a, &of_b, separation, front_only);
}

static void place_side(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side, double time,
                       struct body_frame *out) {
    const struct narc_cast_side *const of = &casts->side[side];
    const place start = {casts->x[slot], casts->y[slot]}, motion = {casts->motion_x[slot], casts->motion_y[slot]};
    out->position = side == 0 ? (place){0, 0} : add_scaled(start, time, motion);
    out->rotation = (place){1, 0};
    if (of->angle[slot] != 0)
        narc_find_cosine((double)of->angle[slot] * time, &out->rotation.x, &out->rotation.y);
    out->rotation = turn_to_world(out, find_rotation(of->cosine[slot], of->sine[slot]));
    out->scale = (double)of->scale[slot];
    out->header = &shapes->headers[of->shape[slot]];
    out->arcs = narc_arcs_of(shapes, out->header);
}

static bool is_concave(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side) {
    return narc_is_concave(&shapes->headers[casts->side[side].shape[slot]]);
}

/* `side`: which of them the ground is. */
static struct scene place_scene(const narc_shapes *shapes, const narc_casts *casts, size_t slot, int side,
                                double time) {
    struct scene scene;
    place_side(shapes, casts, slot, side, time, &scene.ground);
    place_side(shapes, casts, slot, 1 - side, time, &scene.body);
    scene.arc = place_concave(&scene.ground);
    scene.front_only = casts->front_only;
    return scene;
}

/* The same when the body has moved. */
static struct scene move_body(const struct scene *scene, double time, place motion) {
    struct scene then = *scene;
    then.body.position = add_scaled(then.body.position, time, motion);
    return then;
}

/* From the concave arc's centre to that of an arc of the body. */
static place find_way(const struct scene *scene, int arc) {
    const struct body_frame *const body = &scene->body;
    const place own = get_center(&body->arcs[arc].arc),
                center = turn_to_world(body, (place){body->scale * own.x, body->scale * own.y});
    return subtract(subtract(add_scaled(body->position, 1, center), scene->ground.position), scene->arc.center);
}

static double get_radius(const struct scene *scene, int arc) {
    return scene->body.scale * (double)scene->body.arcs[arc].arc.radius;
}

/* What the contact kernel rounds a direction by, of the sizes that it comes from: of either body a coordinate of a centre
 * is a sum of two products, and its position is added; each of these, and the difference, is rounded to 2^-24 of its
 * size. So a coordinate of u is off by at most 6 of these, the vector by 9, and as the normals with which it is compared
 * were rotated like that as well, what it is across them by 2^-24 * (9 + 5) or less. */
#define DIRECTION_ROOM 0x1p-20

/* How large the coordinates are from which u is computed. */
static double measure_way(const struct scene *scene, int arc) {
    const narc_stored_arc *const a = &scene->ground.arcs[0].arc, *const b = &scene->body.arcs[arc].arc;
    const place between = subtract(scene->body.position, scene->ground.position);
    return scene->ground.scale * (fabs((double)a->center_x) + fabs((double)a->center_y)) +
           scene->body.scale * (fabs((double)b->center_x) + fabs((double)b->center_y)) + fabs(between.x) +
           fabs(between.y);
}

/* Is this arc's place that is furthest along u one that may touch? Where two arcs of the body meet rounding decides which
 * of them it belongs to; beyond an arc's end by so little the separation is the same but for the square of that. */
static bool may_touch(const struct scene *scene, int arc, place u) {
    const narc_stored_arc *const stored = &scene->body.arcs[arc].arc;
    const place own = turn_to_shape(&scene->body, u);
    const double room = DIRECTION_ROOM * measure_way(scene, arc);
    return find_cross(get_start(stored), own) >= -room && find_cross(own, get_end(stored)) >= -room &&
           may_touch_at(&scene->body, arc, false) && holds_normal(&scene->arc, find_back(u));
}

/* The bodies' bounding circles: from the ground's to the body's, and the sum of their radii. */
static place find_circles(const struct scene *scene, double *out_size) {
    place center[2];
    *out_size = 0;
    for (int side = 0; side < 2; side++) {
        const struct body_frame *const frame = side ? &scene->body : &scene->ground;
        const narc_shape_header *const header = frame->header;
        const place own = turn_to_world(frame, (place){(double)header->bound_x, (double)header->bound_y});
        center[side] = add_scaled(frame->position, frame->scale, own);
        *out_size += frame->scale * (double)header->bound_radius;
    }
    return subtract(center[1], center[0]);
}

/* How far the circles are apart. While they are, no contact with a separation below 0 is told (piece/concave.inl). */
static double find_circle_gap(const struct scene *scene) {
    double size;
    const double apart = find_length(find_circles(scene, &size));
    return apart - size;
}

static void compare_arc(const struct scene *scene, int arc, struct nearest *best) {
    place u = find_way(scene, arc);
    const double length = find_length(u), separation = scene->arc.radius - length - get_radius(scene, arc);
    if (separation >= best->separation)
        return;
    if (length == 0)
        u = find_back(find_middle_normal(&scene->arc));
    if (!may_touch(scene, arc, u) || (separation < 0 && find_circle_gap(scene) > 0))
        return;
    const place n = divide(find_back(u), find_length(u));
    if (!reach_each_other(&scene->ground, &scene->body, n, separation, scene->front_only)) {
        best->unreached = true;
        return;
    }
    const place at = add_scaled(scene->arc.center, -scene->arc.radius, n);
    *best = (struct nearest){separation, n, at, arc, false, false, best->unreached};
}

/* An end of the concave arc, where `normal` is its normal: how far is it from the body? The largest gap of all normals
 * of the body is at one of its arcs or junctions. */
static void compare_end(const struct scene *scene, place normal, struct nearest *best) {
    const struct body_frame *const body = &scene->body;
    const place at = add_scaled(scene->arc.center, -scene->arc.radius, normal),
                own = turn_to_shape(body, subtract(add_scaled(scene->ground.position, 1, at), body->position));
    struct nearest found = {-INFINITY, {0, 0}, at, 0, false, true, best->unreached};
    for (int k = 0; k < body->header->count; k++) {
        const narc_stored_arc *const arc = &body->arcs[k].arc;
        const place u = add_scaled(own, -body->scale, get_center(arc)), start = get_start(arc);
        const double length = find_length(u);
        const bool held = length > 0 && find_cross(start, u) >= 0 && find_cross(u, get_end(arc)) >= 0;
        const double gap = (held ? length : find_dot(u, start)) - get_radius(scene, k);
        if (gap <= found.separation)
            continue;
        found.separation = gap;
        found.normal = held ? divide(u, length) : start;
        found.arc = k;
        found.on_edge = !held && is_edge_before(body, k);
    }
    if (found.separation >= best->separation || !may_touch_at(body, found.arc, found.on_edge))
        return;
    *best = found;
    best->normal = find_back(turn_to_world(body, found.normal));
}

/* The least separation; infinite if nothing of them may touch. */
static struct nearest find_nearest(const struct scene *scene, bool with_ends) {
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
static float round_time(double time) {
    const float rounded = (float)time;
    return (double)rounded > time ? rounded - rounded * 0x1p-24f : rounded;
}

static void write_contact(const struct scene *scene, const struct nearest *n, int side, narc_contact *out) {
    const bool round = scene->body.header->flags & NARC_SHAPE_CIRCLE;
    const unsigned feature = round ? 0 : find_feature_number(scene->body.header, n->arc, n->on_edge);
    const double sign = side == 0 ? 1 : -1, half = n->separation / 2;
    const float curved = n->on_edge ? INFINITY : (float)get_radius(scene, n->arc);
    const float concave = n->at_end ? 0 : -(float)scene->arc.radius;
    *out = (narc_contact){.feature = (uint16_t)(side == 0 ? feature << 8 : feature),
                          .count = 1,
                          .separation = (float)n->separation,
                          .normal_x = (float)(sign * n->normal.x),
                          .normal_y = (float)(sign * n->normal.y),
                          .point_x = (float)(scene->ground.position.x + n->at.x + half * n->normal.x),
                          .point_y = (float)(scene->ground.position.y + n->at.y + half * n->normal.y),
                          .radius_a = side == 0 ? concave : curved,
                          .radius_b = side == 0 ? curved : concave};
}

/* When does an arc that moves along a line leave the circle of `goal`, where it may touch? Infinite: never. */
static double find_leaving(const struct scene *scene, int arc, double goal, place motion) {
    const place u = find_way(scene, arc);
    const double square = find_dot(motion, motion), across = find_cross(u, motion);
    const double height = goal * goal * square - across * across;
    if (!(goal >= 0) || !(square > 0) || height < 0)
        return INFINITY;
    const double time = (sqrt(height) - find_dot(u, motion)) / square;
    return time >= 0 && may_touch(scene, arc, add_scaled(u, time, motion)) ? time : INFINITY;
}

/* When do the circles come to meet? */
static double find_meeting(const struct scene *scene, place motion) {
    double size;
    const place from = find_circles(scene, &size);
    const double square = find_dot(motion, motion), across = find_cross(from, motion);
    return (-find_dot(from, motion) - sqrt(size * size * square - across * across)) / square;
}

/* When does an arc that moves along a line come to be where it may touch, and is beyond the target then? It has come
 * past an end: into a sector, as what leaves one may still be told of just behind that time, by rounding. */
static double find_entering(const struct scene *scene, int arc, double target, place motion, double meeting) {
    const narc_stored_arc *const stored = &scene->body.arcs[arc].arc;
    const place u = find_way(scene, arc);
    const place sides[4] = {scene->arc.start, scene->arc.end, turn_to_world(&scene->body, get_start(stored)),
                            turn_to_world(&scene->body, get_end(stored))};
    /* Of what is across a side, if its arc comes in; the ground's normals are -u. */
    const double inward[4] = {-1, 1, 1, -1}, along = ALONG_A_SIDE * find_length(motion);
    double least = INFINITY;
    for (int k = 0; k < 5; k++) {
        const double across = k < 4 ? inward[k] * find_cross(sides[k], motion) : INFINITY;
        const double time = (k < 4 ? -inward[k] * find_cross(sides[k], u) / across : meeting) + JUST_BEHIND;
        struct nearest nearest = {.separation = INFINITY};
        if (!(across > along && time >= 0 && time < least))
            continue;
        const struct scene then = move_body(scene, time, motion);
        compare_arc(&then, arc, &nearest);
        least = nearest.separation <= target ? time : least;
    }
    return least;
}

/* Is one that was let go seen clear of a target before a time: is no contact at it, or within `room`? */
static bool is_seen_clear(const struct scene *scene, double time, double target, double room, place motion) {
    enum { LOOKS = 16 };
    bool clear = false;
    for (int k = 1; k < LOOKS && !clear; k++) {
        const struct scene then = move_body(scene, time * k / LOOKS, motion);
        const struct nearest nearest = find_nearest(&then, false);
        clear = nearest.separation > target + room && !nearest.unreached;
    }
    return clear;
}

/* When has it a contact that is at a target, and was not at the start? */
static double find_contact_time(const struct scene *scene, double target, place motion) {
    const double meeting = find_meeting(scene, motion);
    double least = INFINITY;
    for (int arc = 0; arc < scene->body.header->count; arc++) {
        const double goal = scene->arc.radius - get_radius(scene, arc) - target;
        least = find_least(least, find_leaving(scene, arc, goal, motion));
        least = find_least(least, find_entering(scene, arc, target, motion, meeting));
    }
    return least;
}

static int cast_straight(const narc_shapes *shapes, narc_casts *casts, size_t slot, int side, double wanted) {
    const double sign = side == 0 ? 1 : -1, target = (double)casts->target[slot];
    const place motion = {sign * casts->motion_x[slot], sign * casts->motion_y[slot]};
    struct scene scene = place_scene(shapes, casts, slot, side, 0);
    struct nearest nearest = find_nearest(&scene, false);
    double least = nearest.separation <= target ? 0 : find_contact_time(&scene, target, motion);
    if (!(least <= 1))
        return NARC_CAST_MISS;
    if (target < wanted) {
        const double again = find_contact_time(&scene, wanted, motion);
        if (again < least && round_time(again) > 0 &&
            is_seen_clear(&scene, again, wanted, casts->enough[slot], motion)) {
            casts->target[slot] = (float)wanted;
            least = again;
        }
    }
    casts->time[slot] = round_time(least);
    scene = place_scene(shapes, casts, slot, side, (double)casts->time[slot]);
    nearest = find_nearest(&scene, false);
    if (!(nearest.separation < INFINITY)) /* at the very end of a sector */
        nearest = find_nearest(&scene, true);
    write_contact(&scene, &nearest, side, &casts->contact[slot]);
    return nearest.separation < INFINITY ? NARC_CAST_HIT : NARC_CAST_MISS;
}

/* ------------------------------------------------------------------------------------------------ steps in time */

/* What is known of a contact at a time: for how long there is none yet; below 0: for how long there is one. In
 * `separation` what it has, if there is one; does it reach the piece? `apart`: how far the bodies are from each other at
 * least, whatever is told of them. */
struct outlook {
    double wait, separation, apart;
    bool reached;
};

/* How fast things move, at most: what does in the world by turning, and in another body's axes. */
struct speeds {
    double motion, turn[2], reach[2], apart; /* `reach`: of points from the positions; `apart`: of the positions */
};

static struct speeds find_speeds(const struct body_frame bodies[2], const narc_casts *casts, size_t slot) {
    const place motion = {casts->motion_x[slot], casts->motion_y[slot]}, from = {casts->x[slot], casts->y[slot]};
    struct speeds s = {.motion = find_length(motion)};
    s.apart = find_length(from) + s.motion;
    for (int side = 0; side < 2; side++) {
        const narc_shape_header *const h = bodies[side].header;
        const place center = {(double)h->bound_x, (double)h->bound_y};
        s.turn[side] = fabs((double)casts->side[side].angle[slot]);
        s.reach[side] = bodies[side].scale * (find_length(center) + (double)h->bound_radius);
    }
    return s;
}

/* The speed of points of a body in the axes of the other one; of any point that is no further from that. */
static double find_speed_seen(const struct speeds *s, int body, double reach) {
    return s->motion + s->turn[body] * reach + s->turn[1 - body] * (s->apart + reach);
}

/* Goes on from a cast's time by what `look` says, until there is a contact that reaches a piece and did not come from
 * behind. What is nearer than `enough` is as good as there. */
typedef struct outlook look_at_time(const narc_shapes *shapes, narc_casts *casts, size_t slot, double time);

/* A contact may be deep when it is told at last: of what has passed an end. Finds the first time, between one without
 * and this one. */
static void find_first_time(const narc_shapes *shapes, narc_casts *casts, size_t slot, look_at_time *look,
                            float before) {
    float after = casts->time[slot];
    const double enough = (double)casts->target[slot] + casts->enough[slot];
    for (int halving = 0; halving < HALVINGS; halving++) {
        const float middle = (float)(((double)before + (double)after) / 2);
        const struct outlook o = look(shapes, casts, slot, (double)middle);
        *(o.reached && o.separation <= enough ? &after : &before) = middle;
    }
    casts->time[slot] = after;
    (void)look(shapes, casts, slot, (double)after);
}

static int advance_in_time(const narc_shapes *shapes, narc_casts *casts, size_t slot, look_at_time *look, double speed,
                           double size, float wanted) {
    const double enough = casts->enough[slot], least = NARC_TURNING_TOLERANCE * size / speed;
    const double end =
        casts->target[slot] < 0 ? 1 : casts->end[slot]; /* circles say nothing of how deep it is in a hollow */
    double time = (double)casts->time[slot];
    float before = casts->time[slot];
    bool behind = false, told = false;
    for (int round = 0; round < MOST_CONTACTS; round++) {
        casts->time[slot] = round_time(time);
        struct outlook o = look(shapes, casts, slot, (double)casts->time[slot]);
        if (casts->target[slot] < wanted && o.apart > (double)wanted + enough) { /* it was let go, and is clear */
            casts->target[slot] = wanted;
            o = look(shapes, casts, slot, (double)casts->time[slot]);
        }
        const double target = (double)casts->target[slot];
        const bool near = o.separation <= target + enough;
        told = o.reached && o.separation < INFINITY;
        if (near && o.reached && !behind) {
            if (o.separation < target && before < casts->time[slot])
                find_first_time(shapes, casts, slot, look, before);
            return NARC_CAST_HIT;
        }
        behind = near && (behind || !o.reached);
        if (behind && !(casts->moved[slot] > 0)) /* it leaves the piece once */
            return NARC_CAST_MISS;
        before = casts->time[slot];
        const bool comes = o.separation > target && o.separation < INFINITY; /* then it goes by what is left alone */
        time = (double)before + find_most(fabs(o.wait), comes ? 0 : least);
        if (!(time <= end))
            return NARC_CAST_MISS;
        if (round_time(time) <= before)
            time = (double)before * (1 + 0x1p-23) + 0x1p-126;
    }
    if (!told)
        casts->contact[slot] = (narc_contact){.count = 0};
    return NARC_CAST_UNFINISHED;
}

/* ------------------------------------------------------------------------------------------------ turning, concave */

/* When can an arc of the body have a contact, or no more? The circles are `between` apart. */
static double find_arc_wait(const struct scene *scene, int arc, double target, double between, const struct speeds *s,
                            int side) {
    const narc_stored_arc *const stored = &scene->body.arcs[arc].arc;
    const place u = find_way(scene, arc), own = turn_to_shape(&scene->body, u), back = find_back(u);
    const bool round = scene->body.header->flags & NARC_SHAPE_CIRCLE;
    const double separation = scene->arc.radius - find_length(u) - get_radius(scene, arc),
                 apart = find_most(separation - target, find_least(-separation, between));
    const double beside = find_most(-find_cross(scene->arc.start, back), -find_cross(back, scene->arc.end)),
                 beyond = round ? -INFINITY
                                : find_most(-find_cross(get_start(stored), own), -find_cross(own, get_end(stored)));
    const double speed = find_speed_seen(s, 1 - side, s->reach[1 - side]),
                 its = find_speed_seen(s, side, find_length(scene->arc.center));
    return find_most(find_most(apart, beside) / speed, beyond / its);
}

static struct outlook look_at_concave(const narc_shapes *shapes, narc_casts *casts, size_t slot, double time) {
    const int side = is_concave(shapes, casts, slot, 0) ? 0 : 1;
    const struct scene scene = place_scene(shapes, casts, slot, side, time);
    const struct body_frame both[2] = {side ? scene.body : scene.ground, side ? scene.ground : scene.body};
    const struct speeds s = find_speeds(both, casts, slot);
    const struct nearest nearest = find_nearest(&scene, false);
    const bool reached = nearest.separation < INFINITY;
    const double target = (double)casts->target[slot], between = find_circle_gap(&scene);
    const double separation = !reached && nearest.unreached ? -INFINITY : nearest.separation;
    struct outlook out = {INFINITY, separation, separation, reached};
    for (int arc = 0; arc < scene.body.header->count; arc++)
        if (may_touch_at(&scene.body, arc, false))
            out.wait = find_least(out.wait, find_arc_wait(&scene, arc, target, between, &s, side));
    if (reached)
        write_contact(&scene, &nearest, side, &casts->contact[slot]);
    return out;
}

/* ------------------------------------------------------------------------------------------------ runs */

/* The outline of a body in the world's axes, from A's position; normals point out of the body. */
struct outline {
    int count;
    place center[NARC_MAX_ARCS], start[NARC_MAX_ARCS], end[NARC_MAX_ARCS];
    double radius[NARC_MAX_ARCS];
};

static void place_outline(const struct body_frame *frame, struct outline *out) {
    out->count = frame->header->count;
    for (int k = 0; k < out->count; k++) {
        const narc_stored_arc *const a = &frame->arcs[k].arc;
        out->center[k] = add_scaled(frame->position, frame->scale, turn_to_world(frame, get_center(a)));
        out->radius[k] = frame->scale * (double)a->radius;
        out->start[k] = turn_to_world(frame, get_start(a));
        out->end[k] = turn_to_world(frame, get_end(a));
    }
}

static bool is_held(const struct outline *o, int arc, place n) {
    return find_cross(o->start[arc], n) >= 0 && find_cross(n, o->end[arc]) >= 0 &&
           find_dot(n, o->start[arc]) + find_dot(n, o->end[arc]) >= 0;
}

/* The arc that reaches furthest along a unit vector, and how far: one that holds it, as of a corner's arcs all reach as
 * far, but not all may touch. By rounding none may hold it. */
static int find_furthest(const struct outline *o, place n, double *out_height) {
    int best = 0;
    bool best_holds = false;
    *out_height = -INFINITY;
    for (int k = 0; k < o->count; k++) {
        const bool holds = is_held(o, k, n);
        const double turn = holds ? 1 : find_most(find_dot(o->start[k], n), find_dot(o->end[k], n));
        const double height = find_dot(o->center[k], n) + o->radius[k] * turn;
        if (holds < best_holds || (holds == best_holds && !(height > *out_height)))
            continue;
        *out_height = height;
        best_holds = holds;
        best = k;
    }
    return best;
}

/* Gaps of closed shapes: the greatest, its normal from A to B, the sum of the arcs' radii, the arcs; and the greatest along
 * normals of each front. */
struct gaps {
    double most, of_front[2];
    place normal, normal_of[2];
    double radii, radii_of[2];
    int arc[2];
    bool front[2];
};

/* Compares a gap; at the start of an arc its junction is what touches. */
static void compare_gap(const struct body_frame bodies[2], double gap, place n, int a, int b, int at_start,
                        struct gaps *out) {
    const bool front[2] = {may_touch_at(&bodies[0], a, at_start == 0), may_touch_at(&bodies[1], b, at_start == 1)};
    const double radii =
        bodies[0].scale * (double)bodies[0].arcs[a].arc.radius + bodies[1].scale * (double)bodies[1].arcs[b].arc.radius;
    for (int side = 0; side < 2; side++)
        if (front[side] && gap > out->of_front[side]) {
            out->of_front[side] = gap;
            out->normal_of[side] = n;
            out->radii_of[side] = radii;
        }
    if (gap < out->most || (gap == out->most && !(front[0] && front[1])))
        return;
    out->most = gap;
    out->normal = n;
    out->radii = radii;
    for (int side = 0; side < 2; side++) {
        out->arc[side] = side ? b : a;
        out->front[side] = front[side];
    }
}

static struct gaps find_gaps(const struct body_frame bodies[2], const struct outline *a, const struct outline *b) {
    struct gaps out = {.most = -INFINITY, .of_front = {-INFINITY, -INFINITY}};
    double height;
    for (int i = 0; i < a->count; i++)
        for (int j = 0; j < b->count; j++) {
            const place u = subtract(b->center[j], a->center[i]);
            const double length = find_length(u);
            if (length > 0 && is_held(a, i, u) && is_held(b, j, find_back(u)))
                compare_gap(bodies, length - a->radius[i] - b->radius[j], divide(u, length), i, j, -1, &out);
        }
    for (int i = 0; i < a->count; i++) {
        const place n = a->start[i];
        const int j = find_furthest(b, find_back(n), &height);
        compare_gap(bodies, -find_dot(a->center[i], n) - a->radius[i] - height, n, i, j, 0, &out);
    }
    for (int j = 0; j < b->count; j++) {
        const place n = find_back(b->start[j]);
        const int i = find_furthest(a, n, &height);
        compare_gap(bodies, find_dot(b->center[j], n) - b->radius[j] - height, n, i, j, 1, &out);
    }
    return out;
}

/* What a body touches with along its outward normal: how far it reaches along n, the stretch across it, and what it
 * is. */
struct stretch {
    double across, low, high;
    unsigned feature;
    float radius;
};

/* Edges whose normal is nearer to n than this lie along it, as in base/contact_point.inl. */
#define ALONG_EDGE 0x1p-20

static struct stretch find_stretch(const struct body_frame *frame, const struct outline *o, place n, double sign,
                                   int arc) {
    const place out = {sign * n.x, sign * n.y};
    struct stretch s = {.low = INFINITY,
                        .high = -INFINITY,
                        .feature = find_feature_number(frame->header, arc, false),
                        .radius = (float)o->radius[arc]};
    for (int k = 0; k < o->count; k++) {
        const double from = find_cross(o->start[k], out), to = find_cross(out, o->end[k]);
        const place p = add_scaled(o->center[k], o->radius[k], out);
        const double along = find_cross(n, p);
        if (!(from >= -ALONG_EDGE && to >= -ALONG_EDGE && find_dot(out, o->start[k]) + find_dot(out, o->end[k]) >= 0))
            continue;
        s.low = find_least(s.low, along);
        s.high = find_most(s.high, along);
        if (k == arc)
            s.across = find_dot(n, p);
        if (fabs(from) <= ALONG_EDGE && is_edge_before(frame, k) && may_touch_at(frame, k, true)) {
            s.feature = find_feature_number(frame->header, k, true);
            s.radius = INFINITY;
        }
    }
    return s;
}

static void write_run_contact(const struct body_frame bodies[2], const struct outline *a, const struct outline *b,
                              const struct gaps *g, narc_contact *out) {
    const place n = g->normal;
    const struct stretch on_a = find_stretch(&bodies[0], a, n, 1, g->arc[0]),
                         on_b = find_stretch(&bodies[1], b, n, -1, g->arc[1]);
    const double across = (on_a.across + on_b.across) / 2,
                 along = (find_most(on_a.low, on_b.low) + find_least(on_a.high, on_b.high)) / 2;
    *out = (narc_contact){.feature = (uint16_t)(on_a.feature + (on_b.feature << 8)),
                          .count = 1,
                          .separation = (float)g->most,
                          .normal_x = (float)n.x,
                          .normal_y = (float)n.y,
                          .point_x = (float)(across * n.x - along * n.y),
                          .point_y = (float)(across * n.y + along * n.x),
                          .radius_a = on_a.radius,
                          .radius_b = on_b.radius};
}

/* A direction so far beyond the normal at an end of a front: a body that is past the end is further from the end in it
 * than along the front's normals, but for one that is deep, and then by next to nothing. */
#define BESIDE_COSINE 0.96891242171064478 /* of 1/4 */
#define BESIDE_SINE   0.24740395925452293

/* How far an arc of a body is beyond a run's front along a unit vector. */
static double find_gap_from(const struct outline *body, int arc, place n, const struct body_frame *run) {
    double size;
    const place own = turn_to_shape(run, n);
    const double reach = find_dot(run->position, n) +
                         run->scale * narc_find_front_height(run->header, run->arcs, own.x, own.y, 0, &size);
    return find_dot(body->center[arc], n) - body->radius[arc] - reach;
}

/* How far a body is from a run's front alone, at least. In *out_beside, the greatest gap beside its ends. */
static double find_front_distance(const struct body_frame *run, const struct outline *of_run,
                                  const struct outline *body, double *out_beside) {
    const int count = run->header->count, first = run->header->first_arc & NARC_FIRST_ARC;
    double most = -INFINITY, height;
    *out_beside = -INFINITY;
    for (int end = 0; end < 2; end++) {
        const int corner = (2 * count - (end ? 5 : 0) - first) % count;
        const place p = of_run->center[corner], n = end ? of_run->start[corner] : of_run->end[corner];
        const double sine = end ? BESIDE_SINE : -BESIDE_SINE;
        const place beside = {BESIDE_COSINE * n.x - sine * n.y, BESIDE_COSINE * n.y + sine * n.x};
        (void)find_furthest(body, find_back(beside), &height);
        *out_beside = find_most(*out_beside, -find_dot(p, beside) - height);
        for (int k = 0; k < body->count; k++) {
            const place u = subtract(body->center[k], p);
            if (find_length(u) > 0 && is_held(body, k, find_back(u)))
                most = find_most(most, find_gap_from(body, k, divide(u, find_length(u)), run));
        }
    }
    for (int k = 0; k < body->count; k++)
        most = find_most(most, find_gap_from(body, k, find_back(body->start[k]), run));
    return most;
}

/* A front's gap that is less than the greatest by no more than rounding is as great, if its normal is the same, too. Both
 * bodies have their normals in float, with coordinates that are off by 2^-25, so that where an edge of the body lies along
 * the front neither is exactly that of the other. The gap along a normal is the way between two centres along it, less the
 * radii: it is off by at most sqrt(2) * 2^-25 of that way, which is no longer than the bodies reach and both radii.
 *   Normals are the same that are no further apart than parts of a cut arc have in common: a body whose edge lies along
 * the tangent there may have its normal beyond the end of either part. What the closure of a run turns by at an end of
 * the front (chain_pieces.c) is 24 times as much. So are those for which contacts tell of an edge along the front, however
 * far that goes on. */
#define LEVEL 0x1p-24
#define SAME  (2 * NARC_CHAIN_SEAM + 0x1p-22)

static bool is_of_front(const struct gaps *g, int side, double reach) {
    const double ways = 2 * reach + g->radii + g->radii_of[side],
                 turn = fabs(find_cross(g->normal_of[side], g->normal));
    return find_dot(g->normal_of[side], g->normal) > 0 &&
           (turn <= ALONG_EDGE || (turn <= SAME && g->of_front[side] >= g->most - LEVEL * ways));
}

static struct outlook look_at_run(const narc_shapes *shapes, narc_casts *casts, size_t slot, double time) {
    struct body_frame bodies[2];
    struct outline outlines[2];
    for (int side = 0; side < 2; side++) {
        place_side(shapes, casts, slot, side, time, &bodies[side]);
        place_outline(&bodies[side], &outlines[side]);
    }
    const struct gaps g = find_gaps(bodies, &outlines[0], &outlines[1]);
    const struct speeds s = find_speeds(bodies, casts, slot);
    const double speed = s.motion + s.turn[0] * s.reach[0] + s.turn[1] * s.reach[1],
                 target = (double)casts->target[slot];
    struct outlook out = {(g.most - target) / speed, INFINITY, g.most, true};
    bool told = true;
    for (int side = 0; side < 2; side++) {
        if (!(bodies[side].header->first_arc & NARC_PIECE_RUN) || is_of_front(&g, side, s.reach[0] + s.reach[1]))
            continue;
        const double seen = find_speed_seen(&s, 1 - side, s.reach[1 - side]);
        double beside;
        const double away = find_front_distance(&bodies[side], &outlines[side], &outlines[1 - side], &beside);
        out.wait = find_most(out.wait, (find_most(g.most, beside) - g.of_front[side]) / (speed + seen));
        out.wait = find_most(out.wait, (away - find_most(target, 0)) / seen);
        told = false;
    }
    if (!told)
        return out;
    out.separation = g.most;
    out.reached = reach_each_other(&bodies[0], &bodies[1], g.normal, g.most, casts->front_only);
    write_run_contact(bodies, &outlines[0], &outlines[1], &g, &casts->contact[slot]);
    return out;
}

/* ------------------------------------------------------------------------------------------------ the kernel */

int NARC_NAMED(piece)(const narc_shapes *shapes, narc_casts *casts, size_t slot, float wanted) {
    const bool of_a = is_concave(shapes, casts, slot, 0), of_b = is_concave(shapes, casts, slot, 1);
    const place motion = {casts->motion_x[slot], casts->motion_y[slot]};
    const double speed = find_length(motion) + casts->moved[slot];
    double size = INFINITY;
    for (int side = 0; side < 2; side++)
        size = find_least(size, (double)casts->side[side].scale[slot] *
                                    (double)shapes->headers[casts->side[side].shape[slot]].bound_radius);
    if (of_a && of_b)
        return NARC_CAST_MISS;
    if (!of_a && !of_b)
        return advance_in_time(shapes, casts, slot, look_at_run, speed, size, wanted);
    if (casts->moved[slot] > 0)
        return advance_in_time(shapes, casts, slot, look_at_concave, speed, size, wanted);
    return cast_straight(shapes, casts, slot, of_a ? 0 : 1, (double)wanted);
}
