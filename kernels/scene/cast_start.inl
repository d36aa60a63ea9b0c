/* SPDX-License-Identifier: MIT
 *
 * cast_start.inl - where casts begin: the first times at which bounding circles touch, or boxes along the axes of both,
 * and what each cast is measured by.
 */
#ifndef NARC_SCENE_CAST_START_INL
#define NARC_SCENE_CAST_START_INL

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/shape.inl"
#include "kernels.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* What a separation without turning may be away from the target, of a distance and both radii: a quarter of what
 * rounding may do to it (NARC_ERROR_BOUND). */
#define ROUNDING 0x1p-21

/* Where turning moves outlines, a hit is by default no further from the target than this part of what it moves them by,
 * nor than this part of the radius of a circle within a body. */
#define MOVED_PART     0x1p-4
#define THICKNESS_PART 0x1p-6

/* A body: its bounding circle; and where something turns a circle within it, and whether it is a circle, 1 or 0: then
 * that is the one within. */
struct outline {
    float bound_x[V_WIDTH], bound_y[V_WIDTH], bound[V_WIDTH], inner_x[V_WIDTH], inner_y[V_WIDTH], inner[V_WIDTH];
    float round[V_WIDTH];
};

/* Those of casts k ... */
INLINE void load_outline(const narc_shapes *shapes, const int32_t *shape, bool turns, size_t k,
                         struct narc_cast_side *side, struct outline *out) {
    const struct headers h = load_headers(shapes->headers, shape);
    const vi first_arc = find_first_arc(h.first_record, h.info);
    v_store(side->record + k, v_of_bits(first_arc));
    v_store(side->info + k, v_of_bits(h.info));
    v_store(out->bound_x, h.bound_center.x);
    v_store(out->bound_y, h.bound_center.y);
    v_store(out->bound, h.bound_radius);
    if (!turns)
        return;
    const vm round = has_flag(h.info, NARC_SHAPE_CIRCLE);
    vf arc[4] = {h.inner_center.x, h.inner_center.y, h.inner_radius, h.inner_radius};
    if (vm_any(round)) {
        int32_t record[V_WIDTH];
        vi_store(record, first_arc);
        v_rows(shapes->records, sizeof *shapes->records, record, arc);
    }
    v_store(out->inner_x, v_select(round, arc[0], h.inner_center.x));
    v_store(out->inner_y, v_select(round, arc[1], h.inner_center.y));
    v_store(out->inner, v_select(round, arc[2], h.inner_radius));
    v_store(out->round, v_select(round, v_set(1), v_set(0)));
}

/* What is still to be added up of casts that are loaded: motions of A and B. */
struct loaded {
    float motion_x[2][V_WIDTH], motion_y[2][V_WIDTH];
    struct outline outline[2];
    struct box {
        float half_x[V_WIDTH], half_y[V_WIDTH], radius[V_WIDTH];
    } box[2];
    vm boxes;  /* have both a form (store.h, narc_box_form), of a box, or both of segments? */
    bool turn; /* does one of them turn? */
    vm fine;
};

/* Forms of shapes, where both have one. */
INLINE void load_forms(const narc_shapes *shapes, const int32_t *shape_a, const int32_t *shape_b, struct loaded *out) {
    const struct box_form form[] = {load_box_forms(shapes->boxes, shape_a), load_box_forms(shapes->boxes, shape_b)};
    const vm formed = vm_and(vi_lt(vi_set(0), form[0].info), vi_lt(vi_set(0), form[1].info));
    const vm box = vm_or(is_form(&form[0], NARC_IS_BOX), is_form(&form[1], NARC_IS_BOX));
    out->boxes = vm_and(formed, vm_or(box, v_le(v_add(form[0].radius, form[1].radius), v_set(0))));
    UNROLL
    for (int side = 0; side < 2; side++) {
        v_store(out->box[side].half_x, v_abs(form[side].half.x)); /* a zero of a capsule may have a sign */
        v_store(out->box[side].half_y, v_abs(form[side].half.y));
        v_store(out->box[side].radius, form[side].radius);
    }
}

/* Which bodies have no broken numbers? */
INLINE vm are_fine(const struct narc_cast_side *side, size_t k, const struct outline *outline) {
    const vm turned = is_rotation((vec2){v_load(side->cosine + k), v_load(side->sine + k)});
    const vm sized = is_size_in_range(v_mul(v_load(side->scale + k), v_load(outline->bound)));
    return vm_and(vm_and(sized, turned), v_lt(v_abs(v_load(side->angle + k)), v_set(INFINITY)));
}

/* The largest |point x normal| of an outline, at most: the rate at which its support function changes when the shape
 * turns by a radian. A point p of the outline is no further from the centre q of a circle in the shape than R, and
 * along its normal p - q is no shorter than that circle's radius r, so that |p x n| <= |q| + sqrt(R^2 - r^2). Of boxes
 * and regular polygons about their origins it is half an edge, and no less will do. Of a circle it is |q|: the bounding
 * circle, which has room for rounding, says nothing there. */
INLINE vd find_lever(const struct outline *outline, int h) {
    const dvec2 inner = get_dvec2(outline->inner_x + h, outline->inner_y + h);
    const dvec2 bound = get_dvec2(outline->bound_x + h, outline->bound_y + h);
    const vd off = find_length(inner), zero = d_set(0), radius = d_of_floats(outline->inner + h);
    const vd r = d_max(radius, zero);
    const vd far = d_of_floats(outline->bound + h) + find_length((dvec2){bound.x - inner.x, bound.y - inner.y});
    const vl round = d_lt(zero, d_of_floats(outline->round + h));
    return off + d_select(round, zero, d_sqrt(far * far - r * r));
}

/* Circles that hold the bodies all the time: their radii, and their centres from the positions; and by how much turning
 * moves the outlines, at most. What turns but moves nothing by it does not turn from here on. */
INLINE vd find_circle(struct narc_cast_side *side, size_t k, const struct outline *outline, int h, bool turns,
                      dvec2 *out_center, vd *out_moved) {
    const vd scale = d_of_floats(side->scale + k), angle = d_of_floats(side->angle + k), zero = d_set(0);
    const vd radius = scale * d_of_floats(outline->bound + h);
    const dvec2 bound = get_dvec2(outline->bound_x + h, outline->bound_y + h),
                center = {scale * bound.x, scale * bound.y};
    *out_moved = zero;
    *out_center = center;
    if (d_any(d_lt(zero, d_abs(bound.x) + d_abs(bound.y)))) /* not all about their positions */
        *out_center = turn(find_rotation(side->cosine + k, side->sine + k), center);
    if (!turns)
        return radius;
    const vl still = d_le(d_abs(angle), zero);
    const vd lever = d_select(still, zero, scale * find_lever(outline, h));
    const vl rests = d_le(lever, zero);
    d_put_floats(side->angle + k, d_select(rests, zero, angle));
    *out_moved = d_select(rests, zero, lever * d_abs(angle));
    *out_center = (dvec2){d_select(rests, out_center->x, zero), d_select(rests, out_center->y, zero)};
    return d_select(rests, radius, radius + find_length(center));
}

/* What a hit may be away from the target by default, as far as it is up to one of the bodies: a small part of its size,
 * and of its thickness. */
INLINE vd find_tolerance(const struct narc_cast_side *side, size_t k, const struct outline *outline, int h) {
    const vd by_size = d_set(NARC_TURNING_TOLERANCE) * d_of_floats(outline->bound + h),
             by_thickness = d_set(THICKNESS_PART) * d_of_floats(outline->inner + h);
    return d_of_floats(side->scale + k) * d_min(by_size, by_thickness);
}

/* When are two circles, that far apart, as near as `reach`? */
INLINE vl meet_circles(dvec2 apart, dvec2 motion, vd reach, vd *out_start, vd *out_end) {
    const vd zero = d_set(0), one = d_set(1), square = find_dot(motion, motion);
    const vd excess = find_dot(apart, apart) - reach * reach, along = find_dot(apart, motion),
             across = find_cross(apart, motion), height = reach * reach * square - across * across;
    const vd half = d_sqrt(d_max(zero, height));
    const vl rests = d_le(square, zero), touch = d_le(excess, zero);
    const vd divisor = d_select(rests, one, square), first = (-along - half) / divisor, last = (half - along) / divisor;
    const vl ahead = ~touch & ~rests & d_lt(zero, first); /* not where they are all but as near now */
    const vd start = d_select(ahead, first, zero), end = d_select(rests, one, d_min(last, one));
    const vl meet = ~d_lt(height, zero) & d_le(start, end) & d_le(zero, last) & (touch | d_lt(along, zero));
    *out_start = start;
    *out_end = end;
    return (rests & touch) | (~rests & meet);
}

/* When boxes are as near as the target along all axes so far; and when they may be within `enough` of that. */
struct passage {
    vd first, least, last;
};

/* Along an axis of one, on which the positions are `reach` from each other then. */
INLINE void pass_axis(vd way, vd motion, vd reach, vd enough, struct passage *passage) {
    const vd zero = d_set(0), speed = d_abs(motion), rest = d_set(1e-300);
    const vd inverse = d_set(1) / d_max(speed, rest), room = enough * inverse;
    const vd behind = d_select(d_lt(motion, zero), -way, way), first = (-reach - behind) * inverse,
             last = (reach - behind) * inverse, least = first - room;
    passage->first = d_max(first, passage->first);
    passage->least = d_max(least, passage->least);
    passage->last = d_min(passage->last, last + room);
}

/* Boxes that do not turn are no nearer than they are along each of their four axes; sharp ones become as near as the target
 * along the last of these. */
INLINE struct passage pass_boxes(const narc_casts *casts, size_t k, const struct loaded *loaded, int h, dvec2 way,
                                 dvec2 motion, vd target, vd enough) {
    dvec2 axis[2], half[2];
    vd reach = target;
    struct passage passage = {d_set(0), d_set(0), d_set(INFINITY)};
    UNROLL
    for (int side = 0; side < 2; side++) {
        const struct narc_cast_side *const its = &casts->side[side];
        const struct box *const box = &loaded->box[side];
        const vd scale = d_of_floats(its->scale + k);
        axis[side] = find_rotation(its->cosine + k, its->sine + k);
        half[side] = (dvec2){scale * d_of_floats(box->half_x + h), scale * d_of_floats(box->half_y + h)};
        reach += scale * d_of_floats(box->radius + h);
    }
    const vd c = d_abs(find_dot(axis[0], axis[1])), s = d_abs(find_cross(axis[0], axis[1]));
    UNROLL
    for (int side = 0; side < 2; side++) {
        const dvec2 own = half[side], other = half[1 - side];
        const dvec2 from = turn_back(axis[side], way), by = turn_back(axis[side], motion);
        pass_axis(from.x, by.x, reach + own.x + (c * other.x + s * other.y), enough, &passage);
        pass_axis(from.y, by.y, reach + own.y + (s * other.x + c * other.y), enough, &passage);
    }
    return passage;
}

/* Casts k ..., of which half a vector is taken, h ... of it. `out_outcome`: goes on, misses or is broken. */
INLINE void begin_half(float tolerance, narc_casts *casts, size_t k, int h, const struct loaded *loaded,
                       float *out_outcome) {
    const struct outline *const outline = loaded->outline;
    const dvec2 from = {d_load(casts->x + k), d_load(casts->y + k)},
                motion = {d_of_floats(loaded->motion_x[1] + h) - d_of_floats(loaded->motion_x[0] + h),
                          d_of_floats(loaded->motion_y[1] + h) - d_of_floats(loaded->motion_y[0] + h)};
    const vd far = d_set(NARC_MAX_DISTANCE), zero = d_set(0), target = d_of_floats(casts->target + k);
    dvec2 center_a, center_b;
    vd start, end, moved_a, moved_b;
    const vd radius_a = find_circle(&casts->side[0], k, &outline[0], h, loaded->turn, &center_a, &moved_a),
             radius_b = find_circle(&casts->side[1], k, &outline[1], h, loaded->turn, &center_b, &moved_b),
             reach = radius_a + radius_b + target, moved = moved_a + moved_b;
    const dvec2 apart = {from.x + center_b.x - center_a.x, from.y + center_b.y - center_a.y};
    vl meet = d_le(zero, reach) & meet_circles(apart, motion, reach, &start, &end);
    const vl turns = d_lt(zero, moved);
    vd enough = d_set(ROUNDING) * (radius_a + radius_b + d_abs(target));
    if (loaded->turn) {
        const vd given = d_set((double)tolerance),
                 sizes = d_min(find_tolerance(&casts->side[0], k, &outline[0], h),
                               find_tolerance(&casts->side[1], k, &outline[1], h)),
                 part = d_min(d_set(MOVED_PART) * moved, sizes), usual = d_max(part, enough);
        enough = d_select(turns, d_select(d_lt(zero, given), given, usual), enough);
    }
    const vl boxes = meet & ~turns & d_of_lanes(loaded->boxes, h);
    if (d_any(boxes)) {
        const struct passage near = pass_boxes(casts, k, loaded, h, from, motion, target, enough);
        const vl later = boxes & d_lt(start, near.least) & d_le(near.first, end);
        meet &= ~boxes | (d_le(near.least, near.last) & d_le(near.least, end));
        start = d_select(later, near.first, start);
    }
    d_store(casts->motion_x + k, motion.x);
    d_store(casts->motion_y + k, motion.y);
    d_store(casts->end + k, end);
    d_store(casts->enough + k, enough);
    d_store(casts->moved + k, moved);
    d_put_floats(casts->time + k, round_down(start));
    const vd longest = d_set(INFINITY);
    const vl fine = d_le(d_abs(from.x), far) & d_le(d_abs(from.y), far) & d_lt(d_abs(motion.x), longest) &
                    d_lt(d_abs(motion.y), longest);
    const vd outcome = d_select(meet, d_set(CAST_GOES_ON), d_set(NARC_CAST_MISS));
    d_put_floats(out_outcome, d_select(fine, outcome, d_set(CAST_BROKEN)));
}

#endif
