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
#include "simd/simd.h"

/* The place on a ray's line, behind the foot, where it enters. */
struct entry {
    double along;
    place normal; /* of the outline, unit */
    int arc;      /* the feature: this arc or, `on_edge`, what lies between the one before and it */
    bool on_edge;
};

/* A bit for each arc: signs at its ends and whether it is entered itself. */
struct outline_signs {
    uint64_t faces;       /* does the normal where it starts face the ray? */
    uint64_t starts_left; /* s >= 0 where it starts */
    uint64_t ends_left;   /* and where it ends */
    uint64_t entered;
};

INLINE struct outline_signs find_signs(const struct body_frame *frame, place foot, place direction) {
    const int count = frame->header->count;
    const vec2 o = {v_set((float)foot.x), v_set((float)foot.y)};
    const vec2 v = {v_set((float)direction.x), v_set((float)direction.y)};
    const vf zero = v_set(0);
    struct outline_signs signs = {0, 0, 0, 0};
    for (int k = 0; k < count; k += V_WIDTH) {
        const struct own_arcs arc = load_own_arcs(frame, k);
        const vf h = v2_cross(v, v2_sub(arc.center, o)), turn = v2_cross(v, arc.start);
        const vf start = v_add(h, v_mul(arc.radius, turn)), end = v_add(h, v_mul(arc.radius, v2_cross(v, arc.end)));
        const vm start_faces = v_lt(v2_dot(v, arc.start), zero), end_faces = v_lt(v2_dot(v, arc.end), zero);
        /* Both ends of half a turn may face the ray, or neither. Then a quarter turn behind its start decides. */
        const vm is_wide = v_lt(v2_dot(arc.start, arc.end), zero);
        const vm middle_faces = vm_or(vm_and(is_wide, v_lt(zero, turn)), vm_and_not(start_faces, is_wide));
        const vm faces = vm_or(vm_xor(start_faces, end_faces), middle_faces);
        const vf from = v_select(start_faces, start, v_add(h, arc.radius));
        const vf to = v_select(end_faces, end, v_sub(h, arc.radius));
        signs.faces |= (uint64_t)vm_bits(start_faces) << k;
        signs.starts_left |= (uint64_t)vm_bits(v_le(zero, start)) << k;
        signs.ends_left |= (uint64_t)vm_bits(v_le(zero, end)) << k;
        signs.entered |= (uint64_t)vm_bits(vm_and(faces, vm_and(v_le(zero, from), v_lt(to, zero)))) << k;
    }
    return signs;
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

/* Does the line enter the shape, and where? It leaves where the one the other way round enters. */
INLINE bool find_entry(const struct body_frame *frame, place foot, place direction, struct entry *out) {
    const int count = frame->header->count;
    const struct outline_signs signs = find_signs(frame, foot, direction);
    const uint64_t before = signs.ends_left << 1 | (signs.ends_left >> (count - 1) & 1);
    const uint64_t edges = signs.faces & before & ~signs.starts_left;
    const uint64_t entered = (signs.entered | edges) & UINT64_MAX >> (64 - count);
    if (entered == 0)
        return false;
    out->arc = FIND_LOWEST_64(entered);
    out->on_edge = edges >> out->arc & 1;
    const narc_stored_arc *const arc = &frame->arcs[out->arc].arc;
    if (out->on_edge)
        enter_edge(&frame->arcs[out->arc > 0 ? out->arc - 1 : count - 1].arc, arc, foot, direction, out);
    else
        enter_arc(arc, foot, direction, out);
    return true;
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
INLINE bool find_first_entry(const struct body_frame *frame, place foot, place v, struct entry *out) {
    const narc_shape_header *const header = frame->header;
    if (has_any_mark(frame, NARC_PIECE_CONCAVE))
        return enter_concave(frame, foot, v, out);
    if (!find_entry(frame, foot, v, out))
        return false;
    return !NARC_PIECES || narc_touches(header, find_feature_number(header, out->arc, out->on_edge));
}

/* ------------------------------------------------------------------------------------------------ one ray, one body */

/* A ray in the world. */
struct ray {
    place origin, direction; /* the latter a unit vector */
    place inverse;           /* 1 / direction, perhaps infinite */
    double length;           /* of its motion */
    double inverse_length;
};

/* Where the line is within a box: from .. to, along the direction. */
struct stretch {
    double from, to;
};

INLINE void cut_stretch(double low, double high, double origin, double inverse, struct stretch *stretch) {
    const double a = (low - origin) * inverse, b = (high - origin) * inverse; /* NaN on a side that the line lies in */
    const double from = inverse < 0 ? b : a, to = inverse < 0 ? a : b;
    stretch->from = from > stretch->from ? from : stretch->from;
    stretch->to = to < stretch->to ? to : stretch->to;
}

INLINE struct stretch find_box_stretch(const struct ray *ray, const narc_box *box) {
    struct stretch stretch = {-INFINITY, INFINITY};
    cut_stretch((double)box->min_x, (double)box->max_x, ray->origin.x, ray->inverse.x, &stretch);
    cut_stretch((double)box->min_y, (double)box->max_y, ray->origin.y, ray->inverse.y, &stretch);
    return stretch;
}

/* The ray starts in the body. */
INLINE void stop_inside(place way, narc_ray_hit *out) {
    out->fraction = 0;
    out->feature = 0;
    out->normal_x = out->normal_y = out->radius = 0;
    out->point_x = (float)-way.x;
    out->point_y = (float)-way.y;
}

/* Fills a row, but for the ray and the body, if the ray meets the body at no more than `limit` of its motion. What a body
 * is made of counts within its box alone: it should not reach beyond, but for rounding, and so boxes that the line
 * misses, or meets later, can never hold an answer. A ray that starts in the ground does not meet it. */
INLINE bool cast_at_body(const struct body_frame *frame, const struct ray *ray, narc_inside inside, const narc_box *box,
                         float limit, narc_ray_hit *out) {
    struct entry entry;
    const narc_shape_header *const header = frame->header;
    const place way = {frame->position.x - ray->origin.x, frame->position.y - ray->origin.y};
    const place v = turn_to_shape(frame, ray->direction), turned = turn_to_shape(frame, way);
    const place middle = {(double)header->bound_x, (double)header->bound_y};
    const place center = {turned.x * frame->inverse_scale + middle.x, turned.y * frame->inverse_scale + middle.y};
    const double beside = find_cross(v, center), ahead = find_dot(v, center);
    const double radius = (double)header->bound_radius;
    if (!(fabs(beside) <= radius) || ahead < -radius)
        return false;
    const place foot = {middle.x + beside * v.y, middle.y - beside * v.x};
    if (!find_first_entry(frame, foot, v, &entry))
        return false;
    const struct stretch in_box = find_box_stretch(ray, box);
    double distance = find_most((ahead + entry.along) * frame->scale, in_box.from);
    if (!(in_box.from <= in_box.to && distance <= in_box.to))
        return false;
    if (distance <= 0) {
        if (inside == NARC_INSIDE_IGNORES || narc_is_piece(header)) /* or it is behind */
            return false;
        struct entry exit;
        const double from = distance;
        const bool leaves = find_entry(frame, foot, (place){-v.x, -v.y}, &exit);
        distance = find_least(leaves ? (ahead - exit.along) * frame->scale : from, in_box.to);
        if (!(distance >= 0))
            return false;
        if (inside == NARC_INSIDE_STOPS) {
            stop_inside(way, out);
            return true;
        }
        if (leaves)
            entry = exit;
    }
    const double fraction = distance * ray->inverse_length, along = distance * frame->inverse_scale - ahead;
    if (!(fraction <= (double)FLT_MAX) || !(fabs(along) <= 2 * radius)) /* or its box is another's */
        return false;
    out->fraction = (float)fraction;
    if (out->fraction > limit)
        return false;
    const bool is_edge = entry.on_edge && is_edge_before(frame, entry.arc);
    const place point = turn_to_world(frame, (place){foot.x + along * v.x, foot.y + along * v.y});
    const place normal = turn_to_world(frame, entry.normal);
    out->feature = (uint16_t)find_feature_number(header, entry.arc, is_edge);
    out->normal_x = (float)normal.x;
    out->normal_y = (float)normal.y;
    out->point_x = (float)(point.x * frame->scale);
    out->point_y = (float)(point.y * frame->scale);
    out->radius = is_edge ? INFINITY : (float)((double)frame->arcs[entry.arc].arc.radius * frame->scale);
    return true;
}

#endif
