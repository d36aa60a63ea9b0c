/* SPDX-License-Identifier: MIT
 *
 * ray_entry.inl - where a ray enters one body, and where it leaves it.
 *
 * All is seen from the foot of the bounding circle's centre on the ray's line, in the shape's coordinates: nothing is
 * larger than the shape then, however far away the ray starts. Let v be the ray's unit direction, o the foot, and
 * s(p) = v x (p - o) a point's place to the left of the line. Where the outline faces the ray, v.n < 0, it runs from its
 * leftmost point to its rightmost one, and s falls all the way. The ray enters where s turns from >= 0 to < 0.
 *
 * So that no ray slips through between two features, both use the same bits at the point that they share: s there, and
 * at a junction whether its normal faces the ray. Arcs that hold the leftmost or rightmost point are cut there, at
 * centre + r v turned a quarter, where s is h + r and h - r with h = s(centre). Whatever the rounding, signs from + to -
 * change somewhere, and only there. A corner has no width, and what passes through it enters by one of its edges.
 *
 * Which feature it is, is decided in single precision, a lane for each arc. What is said of it, in double precision. So
 * a point is on its feature and on the ray up to one rounding, and beyond the feature's ends by no more than s is off.
 *
 * A touch counts. A line that enters nowhere, but passes some place by little, is asked again nearer to the middle by TOUCH,
 * which is more than s is off; or through the middle, if that is nearer. A convex shape is met by all lines between one
 * that meets it and its middle. So nothing that meets the shape misses it, and no ray through a point that two bodies
 * hold passes one of them. What is said of the feature is that of the ray's own line: the end of it that is near.
 */
#ifndef NARC_SCENE_RAY_ENTRY_INL
#define NARC_SCENE_RAY_ENTRY_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/vec2.inl"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/ray_features.inl"
#include "simd/simd.h"

/* The features by which a line enters. */
struct entries {
    uint64_t edges; /* a bit for each arc: the edge before it */
    uint64_t all;   /* that edge, or the arc */
    bool near;      /* is what is leftmost or rightmost of the outline near to the line? */
};

/* What is known of a line and arcs, a bit for each. */
struct arc_bits {
    uint64_t faces_at_start, starts_left, ends_left, entered, near;
};

INLINE struct arc_bits look_at_arcs(const narc_record *arcs, int count, vec2 o, vec2 v, vf near) {
    const struct own_arcs arc = load_own_arcs(arcs);
    const vf zero = v_set(0), h = v2_cross(v, v2_sub(arc.center, o));
    if (NARC_SHORTCUTS && !vm_any(vm_and(vm_front(count), v_lt(zero, arc.radius)))) { /* corners */
        const uint32_t left = (uint32_t)vm_bits(v_le(zero, h));
        return (struct arc_bits){(uint32_t)vm_bits(v_lt(v2_dot(v, arc.start), zero)), left, left, 0,
                                 (uint32_t)vm_bits(v_le(v_abs(h), near))};
    }
    const vf turn = v2_cross(v, arc.start);
    const vf start = v_add(h, v_mul(arc.radius, turn)), end = v_add(h, v_mul(arc.radius, v2_cross(v, arc.end)));
    const vm start_faces = v_lt(v2_dot(v, arc.start), zero), end_faces = v_lt(v2_dot(v, arc.end), zero);
    /* Both ends of half a turn may face the ray, or neither. Then a quarter turn behind its start decides. */
    const vm is_wide = v_lt(v2_dot(arc.start, arc.end), zero);
    const vm middle_faces = vm_or(vm_and(is_wide, v_lt(zero, turn)), vm_and_not(start_faces, is_wide));
    const vm faces = vm_or(vm_xor(start_faces, end_faces), middle_faces);
    const vf from = v_select(start_faces, start, v_add(h, arc.radius));
    const vf to = v_select(end_faces, end, v_sub(h, arc.radius));
    return (struct arc_bits){(uint32_t)vm_bits(start_faces), (uint32_t)vm_bits(v_le(zero, start)),
                             (uint32_t)vm_bits(v_le(zero, end)),
                             (uint32_t)vm_bits(vm_and(faces, vm_and(v_le(zero, from), v_lt(to, zero)))),
                             (uint32_t)vm_bits(v_le(v_min(v_abs(from), v_abs(to)), near))};
}

/* Those that the first lanes have no room for. */
NOINLINE struct arc_bits look_at_more_arcs(const narc_record *arcs, int count, place foot, place direction, float near,
                                           struct arc_bits bits) {
    const vec2 o = {v_set((float)foot.x), v_set((float)foot.y)};
    const vec2 v = {v_set((float)direction.x), v_set((float)direction.y)};
    for (int k = V_WIDTH; k < count; k += V_WIDTH) {
        const struct arc_bits more = look_at_arcs(arcs + k, count - k, o, v, v_set(near));
        bits.faces_at_start |= more.faces_at_start << k;
        bits.starts_left |= more.starts_left << k;
        bits.ends_left |= more.ends_left << k;
        bits.entered |= more.entered << k;
        bits.near |= more.near << k;
    }
    return bits;
}

INLINE struct entries find_entries(const struct body_frame *frame, place foot, place direction, double touch) {
    const int count = frame->header->count;
    const vec2 o = {v_set((float)foot.x), v_set((float)foot.y)};
    const vec2 v = {v_set((float)direction.x), v_set((float)direction.y)};
    const float near = (float)(2 * touch);
    struct arc_bits bits = look_at_arcs(frame->arcs, count, o, v, v_set(near));
    if (count > V_WIDTH)
        bits = look_at_more_arcs(frame->arcs, count, foot, direction, near, bits);
    const uint64_t left_before = bits.ends_left << 1 | (bits.ends_left >> (count - 1) & 1);
    const uint64_t edges = bits.faces_at_start & left_before & ~bits.starts_left, all = UINT64_MAX >> (64 - count);
    return (struct entries){edges, (bits.entered | edges) & all, (bits.near & all) != 0};
}

/* Where the line crosses an arc's circle: the place nearest to the centre, and half a chord before that. What is beyond
 * an end, by rounding, counts as that end: of a line that grazes, rounding moves the place by its root. */
INLINE void enter_arc(const narc_stored_arc *arc, place foot, place v, struct entry *out) {
    const place center = {(double)arc->center_x - foot.x, (double)arc->center_y - foot.y};
    const place start = {(double)arc->start_x, (double)arc->start_y}, end = {(double)arc->end_x, (double)arc->end_y};
    const double radius = (double)arc->radius, beside = find_cross(v, center) / radius;
    const double capped = beside < -1 ? -1 : beside > 1 ? 1 : beside, half = sqrt((1 - capped) * (1 + capped));
    const place n = {capped * v.y - half * v.x, -capped * v.x - half * v.y};
    const bool behind = find_cross(start, n) >= 0, before = find_cross(n, end) >= 0, is_within = behind && before;
    const bool is_start = !behind && (before || find_dot(start, n) > find_dot(end, n)); /* neither: half a turn */
    out->normal = is_within ? n : is_start ? start : end;
    out->along = find_dot(v, center) + radius * (is_within ? -half : find_dot(v, out->normal));
}

/* Where the line crosses an edge, between its ends: along an edge nearly in the line, nothing else is known. */
INLINE void enter_edge(const narc_stored_arc *before, const narc_stored_arc *after, place foot, place v,
                       struct entry *out) {
    const place n = {(double)after->start_x, (double)after->start_y};
    const double r = (double)before->radius, q = (double)after->radius;
    const place from = {(double)before->center_x + r * n.x - foot.x, (double)before->center_y + r * n.y - foot.y};
    const place to = {(double)after->center_x + q * n.x - foot.x, (double)after->center_y + q * n.y - foot.y};
    const double left = find_cross(v, from), right = find_cross(v, to), start = find_dot(v, from);
    const double part = left <= 0 ? 0 : right >= 0 ? 1 : left / (left - right);
    out->along = start + part * (find_dot(v, to) - start);
    out->normal = n;
}

/* The line of a ray, in the shape's coordinates. */
struct line {
    place foot;      /* of the bounding circle's middle */
    place direction; /* a unit vector */
    double beside;   /* how far the middle is to the left */
    double touch;    /* see find_touch() */
};

/* A shape that has no width beside the line, as far as rounding can tell, such as a segment along it: the end that the line
 * meets first. */
INLINE void enter_end(const struct body_frame *frame, const struct line *line, struct entry *out) {
    const place back = {-line->direction.x, -line->direction.y};
    *out = (struct entry){.along = INFINITY};
    for (int k = 0; k < (int)frame->header->count; k++) {
        const narc_stored_arc *const arc = &frame->arcs[k].arc;
        const place center = {(double)arc->center_x - line->foot.x, (double)arc->center_y - line->foot.y};
        const place start = {(double)arc->start_x, (double)arc->start_y},
                    end = {(double)arc->end_x, (double)arc->end_y};
        const bool holds = find_cross(start, back) >= 0 && find_cross(back, end) >= 0;
        const place n = holds ? back : find_dot(start, back) > find_dot(end, back) ? start : end;
        const double along = -find_dot(back, center) - (double)arc->radius * find_dot(back, n);
        if (along < out->along)
            *out = (struct entry){along, n, k, false};
    }
}

/* Does all of the shape lie so near to the line? */
INLINE bool is_thin(const struct body_frame *frame, const struct line *line) {
    bool thin = true;
    for (int k = 0; thin && k < (int)frame->header->count; k++) {
        const narc_stored_arc *const arc = &frame->arcs[k].arc;
        const place center = {(double)arc->center_x - line->foot.x, (double)arc->center_y - line->foot.y};
        thin = fabs(find_cross(line->direction, center)) + (double)arc->radius <= line->touch;
    }
    return thin;
}

/* What a line touches, if its own entries are none or it passes the middle: features, or else an end; or neither, which is
 * -INFINITY along the line. A shape beside a line through its middle has an end at least. */
struct touched {
    struct entries entries;
    struct entry end;
};

NOINLINE struct touched find_touched(struct body_frame frame, struct line line, struct entries entries) {
    const double touch = line.touch, beside = line.beside;
    const place v = line.direction;
    const double nearer = beside < 0 ? find_least(touch, -beside) : -find_least(touch, beside);
    struct touched touched = {entries, {.along = -INFINITY}};
    if (entries.all == 0)
        touched.entries =
            find_entries(&frame, (place){line.foot.x + nearer * v.y, line.foot.y - nearer * v.x}, v, touch);
    if (fabs(beside) <= touch && (touched.entries.all == 0 || is_thin(&frame, &line))) {
        touched.entries.all = 0;
        enter_end(&frame, &line, &touched.end);
    }
    return touched;
}

/* Does the line enter the shape, and where? It leaves where the one the other way round enters. */
INLINE bool find_entry(const struct body_frame *frame, const struct line *line, struct entry *out) {
    const place foot = line->foot, direction = line->direction;
    struct entries entries = find_entries(frame, foot, direction, line->touch);
    if (entries.near && (entries.all == 0 || fabs(line->beside) <= line->touch)) {
        const struct touched touched = find_touched(*frame, *line, entries);
        if (touched.entries.all == 0) {
            *out = touched.end;
            return out->along > -INFINITY;
        }
        entries = touched.entries;
    }
    if (entries.all == 0)
        return false;
    out->arc = FIND_LOWEST_64(entries.all);
    out->on_edge = entries.edges >> out->arc & 1;
    const narc_stored_arc *const arc = &frame->arcs[out->arc].arc;
    if (out->on_edge)
        enter_edge(&frame->arcs[out->arc > 0 ? out->arc - 1 : frame->header->count - 1].arc, arc, foot, direction, out);
    else
        enter_arc(arc, foot, direction, out);
    return true;
}

/* Where the line leaves. */
NOINLINE bool find_exit(struct body_frame frame, struct line line, struct entry *out) {
    line.direction = (place){-line.direction.x, -line.direction.y};
    line.beside = -line.beside;
    return find_entry(&frame, &line, out);
}

/* ------------------------------------------------------------------------------------------------ pieces of chains */

/* Where the line leaves the circle of a concave arc, whose normals point to the centre: coming from the air. */
INLINE bool enter_concave(const struct body_frame *frame, place foot, place v, struct entry *out) {
    const narc_stored_arc *const arc = &frame->arcs->arc;
    const place center = {(double)arc->center_x - foot.x, (double)arc->center_y - foot.y};
    const place start = {(double)arc->start_x, (double)arc->start_y}, end = {(double)arc->end_x, (double)arc->end_y};
    const double radius = -(double)arc->radius, beside = find_cross(v, center) / radius;
    if (!(fabs(beside) <= 1)) /* or it is the bottom of a valley, and has no width */
        return false;
    const double half = sqrt((1 - beside) * (1 + beside));
    const place n = {-beside * v.y - half * v.x, beside * v.x - half * v.y};
    *out = (struct entry){find_dot(v, center) + radius * half, n, 0, false};
    return find_cross(start, n) >= 0 && find_cross(n, end) >= 0;
}

/* The same as find_entry() for any shape. Of a run only what lies in front is met (store.h). */
INLINE bool find_first_entry(const struct body_frame *frame, const struct line *line, struct entry *out) {
    const narc_shape_header *const header = frame->header;
    if (has_mark_of(frame, NARC_PIECE_CONCAVE))
        return enter_concave(frame, line->foot, line->direction, out);
    if (!find_entry(frame, line, out))
        return false;
    return !has_mark_of(frame, NARC_PIECE_RUN) ||
           narc_touches(header, find_feature_number(header, out->arc, out->on_edge));
}

/* ------------------------------------------------------------------------------------------------ one ray, one body */

/* Where a ray meets a body. */
struct meeting {
    place foot, direction; /* of the line, in the shape's coordinates */
    struct entry entry;
    double ahead;    /* the middle, along the line, from the start */
    double distance; /* in the world's unit */
    bool is_within;  /* the ray starts in the body */
    bool is_start;   /* and stops there */
};

/* The same as find_meeting() of a half-plane, which a ray leaves only where it goes up. */
NOINLINE bool find_plane_meeting(struct body_frame frame, const struct ray *ray, narc_inside inside, bool passes,
                                 struct meeting *out) {
    const place from = {ray->origin.x - frame.position.x, ray->origin.y - frame.position.y};
    const place v = turn_to_shape(&frame, ray->direction), start = turn_to_shape(&frame, from);
    const bool above = start.y > 0, leaves = v.y > 0;
    const double distance = start.y / -v.y;
    *out = (struct meeting){.foot = {start.x * frame.inverse_scale, start.y * frame.inverse_scale},
                            .direction = v,
                            .entry = {.normal = {0, 1}, .arc = PLANE_ARC, .on_edge = true},
                            .distance = distance};
    if (above && !passes)
        return v.y < 0;
    if (inside == NARC_INSIDE_IGNORES)
        return false;
    out->is_within = true;
    out->is_start = inside == NARC_INSIDE_STOPS;
    return out->is_start ? !above : leaves && distance >= 0;
}

/* False if it does not. A ray that starts in the ground does not meet it. `passes`: where it leaves counts, wherever it
 * starts. */
INLINE bool find_meeting(const struct body_frame *frame, const struct ray *ray, narc_inside inside, bool passes,
                         struct meeting *out) {
    const narc_shape_header *const header = frame->header;
    if (has_mark_of(frame, NARC_PIECE_PLANE)) {
        struct meeting met;
        const bool meets = find_plane_meeting(*frame, ray, inside, passes, &met);
        *out = met;
        return meets;
    }
    const place way = {frame->position.x - ray->origin.x, frame->position.y - ray->origin.y};
    const place v = turn_to_shape(frame, ray->direction), turned = turn_to_shape(frame, way);
    const place middle = {(double)header->bound_x, (double)header->bound_y};
    const place center = {turned.x * frame->inverse_scale + middle.x, turned.y * frame->inverse_scale + middle.y};
    const double beside = find_cross(v, center), ahead = find_dot(v, center);
    const double radius = (double)header->bound_radius;
    if (!(fabs(beside) <= radius) || ahead < -radius)
        return false;
    const place foot = {middle.x + beside * v.y, middle.y - beside * v.x};
    const struct line line = {foot, v, beside, find_touch(header)};
    struct entry entry;
    out->is_within = out->is_start = false;
    if (!find_first_entry(frame, &line, &entry))
        return false;
    double distance = (ahead + entry.along) * frame->scale;
    if (!(distance > 0) || passes) {
        if (inside == NARC_INSIDE_IGNORES || narc_is_piece(header)) /* or it is behind */
            return false;
        struct entry exit;
        const bool leaves = find_exit(*frame, line, &exit);
        distance = leaves ? (ahead - exit.along) * frame->scale : distance;
        if (!(distance >= 0))
            return false;
        if (leaves)
            entry = exit;
        out->is_within = true;
        out->is_start = inside == NARC_INSIDE_STOPS;
    }
    out->foot = foot;
    out->direction = v;
    out->entry = entry;
    out->ahead = ahead;
    out->distance = distance;
    return true;
}

/* Fills a row, but for the ray, the body and a feature. False if the meeting is beyond `limit` of the ray's motion. */
INLINE bool put_place(const struct body_frame *frame, const struct ray *ray, const struct meeting *met, float limit,
                      narc_ray_hit *out) {
    const place foot = met->foot, v = met->direction;
    if (met->is_start) {
        out->fraction = 0;
        out->feature = 0;
        out->normal_x = out->normal_y = out->radius = 0;
        out->point_x = (float)-(frame->position.x - ray->origin.x);
        out->point_y = (float)-(frame->position.y - ray->origin.y);
        return true;
    }
    const double fraction = met->distance * ray->inverse_length;
    const double along = met->distance * frame->inverse_scale - met->ahead;
    if (!(fraction <= (double)FLT_MAX))
        return false;
    out->fraction = (float)fraction;
    if (out->fraction > limit)
        return false;
    const place point = turn_to_world(frame, (place){foot.x + along * v.x, foot.y + along * v.y});
    const place normal = turn_to_world(frame, met->entry.normal);
    out->normal_x = (float)normal.x;
    out->normal_y = (float)normal.y;
    out->point_x = (float)(point.x * frame->scale);
    out->point_y = (float)(point.y * frame->scale);
    return true;
}

/* All but the ray and the body. */
INLINE bool put_meeting(const struct body_frame *frame, const struct ray *ray, const struct meeting *met, float limit,
                        narc_ray_hit *out) {
    if (!put_place(frame, ray, met, limit, out))
        return false;
    if (!met->is_start)
        put_feature(frame, &met->entry, out);
    return true;
}

#endif
