/* SPDX-License-Identifier: MIT
 *
 * way_out.inl - the place of a thing's outside that is nearest to a point within the thing.
 *
 * It is a foot of the point on an arc or an edge of a part, or where the outlines of two parts cross; a part's own corners
 * lie further away than what is beside them. It is outside if what lies just beyond it, seen from the point, is in no
 * part. So neither seams nor gaps that are hardly wider than rounding count.
 */
#ifndef NARC_SCENE_WAY_OUT_INL
#define NARC_SCENE_WAY_OUT_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "scene/body_frame.inl"
#include "scene/near_walk.inl"
#include "scene/part_walk.inl"

/* A thing, and the point. */
struct thing {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_index *index;
    const struct chosen *chosen;
    uint32_t owner;
    place point;
};

struct way_out {
    double distance;  /* infinite: none has been found */
    place at, normal; /* from the point */
    uint32_t body;
    unsigned feature;
    double radius;
};

/* An arc or an edge of a part, from the point: an edge begins at `center`. */
struct curve {
    place center, start, end; /* of an arc its first and last normal; of an edge its normal, and the way along it */
    double radius, length;    /* of an edge: infinite; and its length */
    double distance;          /* from the point, at least */
    unsigned feature;
    bool round; /* a whole circle */
};

/* What lies on a curve may be so far beyond its ends. */
#define END_ROOM_OF_CURVES 0x1p-20

/* And it may be nearer than that by this part of the numbers it is found from: normals are stored in single precision, and
 * circles that hardly miss each other count as crossing. So of places as near as each other all are looked at, whichever
 * comes first. */
#define ROOM_OF_CURVES 0x1p-20

INLINE place see_place(const struct thing *thing, const struct body_frame *frame, place own) {
    const place turned = turn_to_world(frame, own);
    return (place){frame->position.x - thing->point.x + frame->scale * turned.x,
                   frame->position.y - thing->point.y + frame->scale * turned.y};
}

/* By their crosses an arc of next to nothing holds the opposite of its normals, too; of half a turn the dots add up to 0. */
INLINE bool is_on_arc(const struct curve *arc, place n) {
    const double room = END_ROOM_OF_CURVES;
    return arc->round || (find_cross(arc->start, n) >= -room && find_cross(n, arc->end) >= -room &&
                          find_dot(arc->start, n) + find_dot(n, arc->end) > -1);
}

/* Curve 2k of a part is its arc k, and 2k + 1 the edge before that. False if there is none. */
INLINE bool see_curve(const struct thing *thing, const struct body_frame *frame, int number, struct curve *out) {
    const int k = number / 2, count = (int)frame->header->count;
    const narc_stored_arc *const arc = &frame->arcs[k].arc;
    const bool is_edge = number % 2, round = frame->header->flags & NARC_SHAPE_CIRCLE;
    const place center = see_place(thing, frame, get_center(arc)), start = turn_to_world(frame, get_start(arc));
    const double radius = frame->scale * (double)arc->radius;
    out->feature = find_feature_number(frame->header, k, is_edge);
    out->round = round;
    if (!is_edge) {
        const place end = turn_to_world(frame, get_end(arc));
        const double away = find_length(center);
        *out = (struct curve){center, start, end, radius, 0, fabs(away - radius), out->feature, round};
        if (!is_on_arc(out, (place){-center.x / away, -center.y / away})) {
            const place first = {center.x + radius * start.x, center.y + radius * start.y},
                        last = {center.x + radius * end.x, center.y + radius * end.y};
            out->distance =
                sqrt(find_least(find_dot(first, first), find_dot(last, last))) - 2 * END_ROOM_OF_CURVES * radius;
        }
        out->distance -= ROOM_OF_CURVES * (away + radius);
        return radius > 0;
    }
    if (round || !is_edge_before(frame, k))
        return false;
    const narc_stored_arc *const before = &frame->arcs[(k + count - 1) % count].arc;
    const place last = see_place(thing, frame, get_center(before));
    const double last_radius = frame->scale * (double)before->radius;
    const place from = {last.x + last_radius * start.x, last.y + last_radius * start.y},
                way = {center.x + radius * start.x - from.x, center.y + radius * start.y - from.y};
    const double length = find_length(way);
    const place along = {way.x / length, way.y / length};
    const double before_start = find_dot(from, along), behind_end = -before_start - length,
                 beside = find_most(before_start, behind_end) - 2 * END_ROOM_OF_CURVES * length,
                 height = fabs(find_dot(from, start));
    *out = (struct curve){from, start, along, INFINITY, length, height, out->feature, false};
    if (beside > 0)
        out->distance = sqrt(height * height + beside * beside);
    out->distance -= ROOM_OF_CURVES * (fabs(before_start) + length + height);
    return length > 0;
}

/* Is a place on a curve's line or circle on the curve? */
INLINE bool is_on_curve(const struct curve *curve, place at) {
    const place from = {at.x - curve->center.x, at.y - curve->center.y};
    if (curve->radius < INFINITY)
        return is_on_arc(curve, (place){from.x / curve->radius, from.y / curve->radius});
    const double along = find_dot(from, curve->end), room = END_ROOM_OF_CURVES * curve->length;
    return along >= -room && along <= curve->length + room;
}

/* Is what lies just beyond a place of a part in no part? */
NOINLINE bool is_way_out(const struct thing *thing, const struct body_frame *frame, place at, place n) {
    const double seam = find_seam(frame);
    const place from = {thing->point.x + at.x, thing->point.y + at.y};
    struct part_walk parts = begin_part_walk(thing->index, thing->chosen, thing->owner, from,
                                             8 * seam * find_length(n) + 0x1p-14 * find_length(at));
    struct body_frame other;
    uint32_t body;
    while (find_next_part(&parts, thing->shapes, thing->bodies, &body, &other)) {
        const double beyond = 4 * find_most(seam, find_seam(&other));
        const place there = {from.x + beyond * n.x, from.y + beyond * n.y};
        if (!narc_is_piece(other.header) && find_depth_in(&other, find_place_in(&other, there)) < 0)
            return false;
    }
    return true;
}

/* Takes a place, if it is nearer and `out` leads out of all parts there. */
INLINE void take_way_out(const struct thing *thing, const struct body_frame *frame, uint32_t body, place at, place n,
                         place out, const struct curve *curve, bool is_corner, struct way_out *best) {
    const double distance = find_length(at);
    const bool before =
        body != best->body ? body < best->body
        : curve->feature != best->feature
            ? curve->feature < best->feature
            : is_corner && best->radius == 0 && (at.x < best->at.x || (at.x == best->at.x && at.y < best->at.y));
    if ((distance < best->distance || (distance == best->distance && before)) && is_way_out(thing, frame, at, out))
        *best = (struct way_out){distance, at, n, body, curve->feature, is_corner ? 0 : curve->radius};
}

INLINE float find_reach_key(const struct way_out *best) {
    return find_limit_key((float)find_least(best->distance, (double)FARTHEST));
}

/* The feet on a part. */
INLINE void look_at_feet(const struct thing *thing, const struct body_frame *frame, uint32_t body,
                         struct way_out *best) {
    for (int k = 0; k < 2 * (int)frame->header->count; k++) {
        struct curve curve;
        if (!see_curve(thing, frame, k, &curve) || curve.distance > best->distance)
            continue;
        const place u = {-curve.center.x, -curve.center.y};
        const double length = find_length(u);
        place n = curve.start;
        double to = -find_dot(u, n);
        if (curve.radius < INFINITY) {
            n = length > 0 ? (place){u.x / length, u.y / length} : curve.round ? (place){1, 0} : n;
            to = curve.radius - length;
        }
        const place at = {to * n.x, to * n.y};
        if (to >= -find_seam(frame) && (curve.radius < INFINITY ? is_on_arc(&curve, n) : is_on_curve(&curve, at)))
            take_way_out(thing, frame, body, at, n, n, &curve, false, best);
    }
}

/* The places, two at most, where the lines or circles of two curves cross; how many. */
INLINE int cross_curves(const struct curve *a, const struct curve *b, place out[2]) {
    const struct curve *const circle = a->radius < INFINITY ? a : b, *const other = circle == a ? b : a;
    if (!(circle->radius < INFINITY)) {
        const place way = {b->center.x - a->center.x, b->center.y - a->center.y};
        const double sine = find_cross(a->end, b->end), along = find_cross(way, b->end) / sine;
        out[0] = (place){a->center.x + along * a->end.x, a->center.y + along * a->end.y};
        return fabs(sine) > END_ROOM_OF_CURVES;
    }
    const place way = {other->center.x - circle->center.x, other->center.y - circle->center.y};
    const double square = find_dot(way, way), radii = circle->radius * circle->radius;
    const bool both = other->radius < INFINITY;
    const double part =
        both ? (square + radii - other->radius * other->radius) / (2 * square) : find_dot(way, other->start);
    const place to = both ? way : other->start,
                foot = {part * to.x, part * to.y}; /* of the centre on the line of both */
    const double rest = radii - find_dot(foot, foot);
    if (!(rest > -END_ROOM_OF_CURVES * circle->radius * circle->radius)) /* or it is NaN */
        return 0;
    const double half = sqrt(find_most(rest, 0)), length = sqrt(square);
    const place across = both ? (place){-way.y / length, way.x / length} : other->end;
    for (int side = 0; side < 2; side++) {
        const double by = side ? half : -half;
        out[side] = (place){circle->center.x + foot.x + by * across.x, circle->center.y + foot.y + by * across.y};
    }
    return 2;
}

/* Out of both curves where they cross: between their normals. */
INLINE place lead_out(const struct curve *a, const struct curve *b, place at) {
    place sum = {0, 0};
    for (int k = 0; k < 2; k++) {
        const struct curve *const of = k ? b : a;
        const bool edge = !(of->radius < INFINITY);
        sum.x += edge ? of->start.x : (at.x - of->center.x) / of->radius;
        sum.y += edge ? of->start.y : (at.y - of->center.y) / of->radius;
    }
    const double by = 1 / find_most(find_length(sum), 0x1p-60);
    return (place){by * sum.x, by * sum.y};
}

/* Where the outline of a part crosses those of others with higher numbers. */
NOINLINE void look_at_crossings(const struct thing *thing, const struct body_frame *frame, uint32_t body,
                                struct way_out *best) {
    struct curve own[2 * NARC_MAX_ARCS];
    int count = 0;
    for (int k = 0; k < 2 * (int)frame->header->count; k++)
        count += see_curve(thing, frame, k, &own[count]) && own[count].distance <= best->distance;
    if (count == 0)
        return;
    const double radius = frame->scale * (double)frame->header->bound_radius * (1 + 0x1p-12);
    place around = {0, 0};
    if (radius < best->distance)
        around = see_place(thing, frame, (place){(double)frame->header->bound_x, (double)frame->header->bound_y});
    struct part_walk others = begin_part_walk(thing->index, thing->chosen, thing->owner,
                                              (place){thing->point.x + around.x, thing->point.y + around.y},
                                              find_least(radius, best->distance * (1 + 0x1p-20)));
    struct body_frame other;
    uint32_t next;
    while (find_next_part(&others, thing->shapes, thing->bodies, &next, &other)) {
        if (next <= body || narc_is_piece(other.header))
            continue;
        for (int i = 0; i < 2 * (int)other.header->count; i++) {
            struct curve curve;
            if (!see_curve(thing, &other, i, &curve))
                continue;
            for (int k = 0; k < count && curve.distance <= best->distance; k++) {
                place at[2];
                if (own[k].distance > best->distance)
                    continue;
                for (int found = cross_curves(&own[k], &curve, at) - 1; found >= 0; found--) {
                    const double length = find_length(at[found]);
                    const place n = length > 0 ? (place){at[found].x / length, at[found].y / length} : own[k].start;
                    if (length <= best->distance && is_on_curve(&own[k], at[found]) && is_on_curve(&curve, at[found]))
                        take_way_out(thing, frame, body, at[found], n, lead_out(&own[k], &curve, at[found]), &own[k],
                                     true, best);
                }
            }
        }
    }
}

/* The nearest place outside of a point that lies in this part of a thing. False if none is found. */
NOINLINE bool find_way_out(const struct thing *thing, uint32_t part, struct way_out *out) {
    struct body_frame frame;
    struct near_walk walk;
    uint32_t body;
    *out = (struct way_out){.distance = INFINITY, .body = UINT32_MAX};
    if (load_body_frame(thing->shapes, thing->bodies, part, &frame)) /* often its feet lie outside */
        look_at_feet(thing, &frame, part, out);
    if (!begin_near_walk(&walk, thing->index, thing->chosen, thing->point, find_reach_key(out)))
        return out->distance < INFINITY;
    while (find_next_near(&walk, &body)) {
        if (find_owner(thing->chosen, body) != thing->owner || !is_chosen(thing->chosen, body) ||
            !load_body_frame(thing->shapes, thing->bodies, body, &frame) || narc_is_piece(frame.header))
            continue;
        if (body != part)
            look_at_feet(thing, &frame, body, out);
        look_at_crossings(thing, &frame, body, out);
        walk.limit_key = find_reach_key(out);
    }
    return out->distance < INFINITY;
}

#endif
