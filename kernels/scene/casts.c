/* SPDX-License-Identifier: MIT
 *
 * casts.c - the kernels of times of impact, a pair in each lane: where it begins, where its bodies are at a time, and
 * what the contact there means. What is not proved by docs/algorithm.md is not relied upon: a pair never goes past a
 * time at which its separation could have come down to the target, or goes back there if it may have. What contacts
 * mean is in cast_lines.inl and cast_turns.inl.
 */
#include <math.h>
#include <stdint.h>

#include "base/bodies.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "elementary.h"
#include "kernels.h"
#include "narc_scene.h"
#include "scene/cast_lanes.inl"
#include "scene/cast_lines.inl"
#include "scene/cast_turns.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* What a separation without turning may be away from the target, of a distance and both radii: a quarter of what
 * rounding may do to it (NARC_ERROR_BOUND). */
#define ROUNDING 0x1p-21

/* Where turning moves outlines, a hit is by default no further from the target than this part of what it moves them by,
 * nor than this part of the radius of a circle within a body. */
#define MOVED_PART     0x1p-4
#define THICKNESS_PART 0x1p-6

/* ------------------------------------------------------------------------------------------------ the start */

/* A body: its bounding circle, a circle within it, and whether it is a circle, 1 or 0: then that is the one within. */
struct outline {
    float bound_x[V_WIDTH], bound_y[V_WIDTH], bound[V_WIDTH], inner_x[V_WIDTH], inner_y[V_WIDTH], inner[V_WIDTH];
    float round[V_WIDTH];
};

INLINE void load_outline(const narc_shapes *shapes, const struct narc_cast_side *side, const int32_t *slot,
                         struct outline *out) {
    int32_t shape[V_WIDTH];
    vi_store(shape, get_shapes(side, slot));
    const struct headers h = load_headers(shapes->headers, shape);
    const vm round = has_flag(h.info, NARC_SHAPE_CIRCLE);
    vf arc[4] = {h.inner_center.x, h.inner_center.y, h.inner_radius, h.inner_radius};
    if (vm_any(round)) {
        vi_store(shape, find_first_arc(h.first_record, h.info));
        v_rows(shapes->records, sizeof *shapes->records, shape, arc);
    }
    v_store(out->bound_x, h.bound_center.x);
    v_store(out->bound_y, h.bound_center.y);
    v_store(out->bound, h.bound_radius);
    v_store(out->inner_x, v_select(round, arc[0], h.inner_center.x));
    v_store(out->inner_y, v_select(round, arc[1], h.inner_center.y));
    v_store(out->inner, v_select(round, arc[2], h.inner_radius));
    v_store(out->round, v_select(round, v_set(1), v_set(0)));
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
    const spot inner = get_spot(outline->inner_x + h, outline->inner_y + h);
    const spot bound = get_spot(outline->bound_x + h, outline->bound_y + h);
    const vd off = find_length(inner), zero = d_set(0), radius = d_of_floats(outline->inner + h);
    const vd r = d_select(d_lt(zero, radius), radius, zero);
    const vd far = d_of_floats(outline->bound + h) + find_length((spot){bound.x - inner.x, bound.y - inner.y});
    const vl round = d_lt(zero, d_of_floats(outline->round + h));
    return off + d_select(round, zero, d_sqrt(far * far - r * r));
}

/* Circles that hold the bodies all the time: their radii, and their centres from the positions. What turns but moves
 * nothing by it does not turn from here on. */
INLINE vd find_circle(struct narc_cast_side *side, size_t k, const struct outline *outline, int h, spot *out_center) {
    const vd scale = d_of_floats(side->scale + k), angle = d_of_floats(side->angle + k), zero = d_set(0);
    const vd radius = scale * d_of_floats(outline->bound + h);
    const spot bound = get_spot(outline->bound_x + h, outline->bound_y + h),
               center = {scale * bound.x, scale * bound.y};
    const spot turned = turn(find_rotation(side->cosine + k, side->sine + k), center);
    const vl still = d_le(d_abs(angle), zero);
    vd lever = zero;
    if (d_any(~still))
        lever = d_select(still, zero, scale * find_lever(outline, h));
    const vl rests = d_le(lever, zero);
    d_store(side->lever + k, lever);
    d_put_floats(side->angle + k, d_select(rests, zero, angle));
    *out_center = (spot){d_select(rests, turned.x, zero), d_select(rests, turned.y, zero)};
    return d_select(rests, radius, radius + find_length(center));
}

/* By how much turning moves an outline, at most. */
INLINE vd find_moved(const struct narc_cast_side *side, size_t k) {
    return d_load(side->lever + k) * d_abs(d_of_floats(side->angle + k));
}

/* What a hit may be away from the target by default, as far as it is up to one of the bodies: a small part of its size,
 * and of its thickness. */
INLINE vd find_tolerance(const struct narc_cast_side *side, size_t k, const struct outline *outline, int h) {
    const vd by_size = d_set(NARC_TURNING_TOLERANCE) * d_of_floats(outline->bound + h),
             by_thickness = d_set(THICKNESS_PART) * d_of_floats(outline->inner + h);
    return d_of_floats(side->scale + k) * d_min(by_size, by_thickness);
}

/* When are two circles, that far apart, as near as `reach`? */
INLINE vl meet_circles(spot apart, spot motion, vd reach, vd *out_start, vd *out_end) {
    const vd zero = d_set(0), one = d_set(1), square = find_dot(motion, motion);
    const vd excess = find_dot(apart, apart) - reach * reach, along = find_dot(apart, motion),
             across = find_cross(apart, motion), height = reach * reach * square - across * across;
    const vd half = d_sqrt(d_select(d_lt(height, zero), zero, height));
    const vl rests = d_le(square, zero), touch = d_le(excess, zero);
    const vd divisor = d_select(rests, one, square), first = (-along - half) / divisor, last = (half - along) / divisor;
    const vl ahead = ~touch & ~rests & d_lt(zero, first); /* not where they are all but as near now */
    const vd start = d_select(ahead, first, zero), end = d_select(rests, one, d_min(last, one));
    const vl meet = ~d_lt(height, zero) & d_le(start, end) & d_le(zero, last) & (touch | d_lt(along, zero));
    *out_start = start;
    *out_end = end;
    return (rests & touch) | (~rests & meet);
}

INLINE void begin_half(narc_casts *casts, size_t k, int h, struct outline outline[2], float *out_outcome) {
    const spot from = {d_load(casts->x + k), d_load(casts->y + k)},
               motion = {d_load(casts->motion_x + k), d_load(casts->motion_y + k)};
    const vd far = d_set(NARC_MAX_DISTANCE), zero = d_set(0), target = d_of_floats(casts->target + k);
    spot center_a, center_b;
    vd start, end;
    const vd radius_a = find_circle(&casts->side[0], k, &outline[0], h, &center_a),
             radius_b = find_circle(&casts->side[1], k, &outline[1], h, &center_b),
             reach = radius_a + radius_b + target;
    const spot apart = {from.x + center_b.x - center_a.x, from.y + center_b.y - center_a.y};
    const vl meet = d_le(zero, reach) & meet_circles(apart, motion, reach, &start, &end);
    const vd moved = find_moved(&casts->side[0], k) + find_moved(&casts->side[1], k);
    const vl turns = d_lt(zero, moved);
    vd enough = d_set(ROUNDING) * (radius_a + radius_b + d_abs(target));
    if (d_any(turns)) {
        const vd given = d_set((double)casts->tolerance),
                 sizes = d_min(find_tolerance(&casts->side[0], k, &outline[0], h),
                               find_tolerance(&casts->side[1], k, &outline[1], h)),
                 part = d_min(d_set(MOVED_PART) * moved, sizes), usual = d_select(d_lt(enough, part), part, enough);
        enough = d_select(turns, d_select(d_lt(zero, given), given, usual), enough);
    }
    d_store(casts->end + k, end);
    d_store(casts->enough + k, enough);
    d_put_floats(casts->time + k, round_down(start));
    d_put_floats(casts->turning + k, d_select(turns, d_set(1), zero));
    const vd longest = d_set(INFINITY);
    const vl fine = d_le(d_abs(from.x), far) & d_le(d_abs(from.y), far) & d_lt(d_abs(motion.x), longest) &
                    d_lt(d_abs(motion.y), longest);
    const vd outcome = d_select(meet, d_set(NARC_CAST_GOES_ON), d_set(NARC_CAST_MISS));
    d_put_floats(out_outcome, d_select(fine, outcome, d_set(NARC_CAST_BROKEN)));
}

/* Places casts first .. end - 1 at the first times at which bounding circles touch, or says that they never do:
 * NARC_CAST_MISS. */
void NARC_NAMED(begin)(const narc_shapes *shapes, narc_casts *casts, size_t first, size_t end) {
    for (size_t k = first; k < end; k += V_WIDTH) {
        int32_t slot[V_WIDTH];
        float outcome[V_WIDTH];
        struct outline outline[2];
        vm fine = vm_front(V_WIDTH);
        get_slots(k, end, slot);
        for (int side = 0; side < 2; side++) {
            load_outline(shapes, &casts->side[side], slot, &outline[side]);
            fine = vm_and(fine, are_fine(&casts->side[side], k, &outline[side]));
        }
        for (int h = 0; h < V_WIDTH; h += D_WIDTH)
            begin_half(casts, k + (size_t)h, h, outline, outcome + h);
        v_store(casts->back + k, v_set(NARC_CAST_FREE));
        v_store(casts->rounds + k, v_set(0));
        vi_store(casts->outcome + k, vi_select(fine, vi_truncate(v_load(outcome)), vi_set(NARC_CAST_BROKEN)));
    }
}

/* ------------------------------------------------------------------------------------------------ places */

/* Cosines and sines of angles, to some 1e-14: quarter turns and the series of the rest. They are rounded to floats. */
INLINE spot find_directions(vd angle) {
    const vd whole = d_set(0x1.8p52); /* what is added to it is rounded to an integer */
    const vd quarters = (angle * d_set(0.63661977236758134) + whole) - whole; /* 2 / pi */
    const vd part = quarters - d_set(4) * ((quarters * d_set(0.25) + whole) - whole), size = d_abs(part);
    const vd x = (angle - quarters * d_set(0x1.921fb544p+0)) - quarters * d_set(0x1.0b4611a626331p-34), z = x * x;
    const vd one = d_set(1);
    vd s = d_set(-1.0 / 39916800), c = d_set(1.0 / 479001600);
    s = d_set(-1.0 / 6) + z * (d_set(1.0 / 120) + z * (d_set(-1.0 / 5040) + z * (d_set(1.0 / 362880) + z * s)));
    c = d_set(1.0 / 24) + z * (d_set(-1.0 / 720) + z * (d_set(1.0 / 40320) + z * (d_set(-1.0 / 3628800) + z * c)));
    s = x + x * z * s;
    c = one - z * (d_set(0.5) - z * c);
    const vl odd = d_le(size, one) & d_le(one, size), opposite = d_lt(one, size) | d_lt(part, d_set(0));
    const spot p = {d_select(odd, -s, c), d_select(odd, c, s)};
    spot direction = {d_select(opposite, -p.x, p.x), d_select(opposite, -p.y, p.y)};
    const vl small = d_lt(d_abs(angle), d_set(0x1p20));
    if (d_any(~small)) {
        double angles[D_WIDTH], cosine[D_WIDTH], sine[D_WIDTH];
        d_store(angles, angle);
        for (int l = 0; l < D_WIDTH; l++)
            narc_find_cosine(angles[l], &cosine[l], &sine[l]);
        direction = (spot){d_select(small, direction.x, d_load(cosine)), d_select(small, direction.y, d_load(sine))};
    }
    return direction;
}

/* The rotations of slots k ... at their times; what does not turn keeps its own, to the bit. */
INLINE void turn_bodies(struct narc_cast_side *side, const float *time, size_t k, float *out_cosine, float *out_sine) {
    for (size_t h = k; h < k + V_WIDTH; h += D_WIDTH) {
        const spot direction = find_directions(d_of_floats(time + h) * d_of_floats(side->angle + h));
        const spot turned = turn(direction, find_rotation(side->cosine + h, side->sine + h));
        d_store(side->turned_x + h, turned.x);
        d_store(side->turned_y + h, turned.y);
        d_put_floats(out_cosine + (h - k), turned.x);
        d_put_floats(out_sine + (h - k), turned.y);
    }
    const vm turns = v_lt(v_set(0), v_abs(v_load(side->angle + k)));
    v_store(out_cosine, v_select(turns, v_load(out_cosine), v_load(side->cosine + k)));
    v_store(out_sine, v_select(turns, v_load(out_sine), v_load(side->sine + k)));
}

void NARC_NAMED(place)(narc_casts *casts, size_t count) {
    for (size_t k = 0; k < count; k += V_WIDTH) {
        const vm live = vm_front(count - k < V_WIDTH ? (int)(count - k) : V_WIDTH);
        const vf angles = v_max(v_abs(v_load(casts->side[0].angle + k)), v_abs(v_load(casts->side[1].angle + k)));
        const int any_turns = vm_any(vm_and(live, v_lt(v_set(0), angles)));
        float x[V_WIDTH], y[V_WIDTH], cosine[V_WIDTH], sine[V_WIDTH];
        for (size_t h = 0; h < V_WIDTH; h += D_WIDTH) {
            const vd time = d_of_floats(casts->time + k + h);
            d_put_floats(x + h, d_load(casts->x + k + h) + time * d_load(casts->motion_x + k + h));
            d_put_floats(y + h, d_load(casts->y + k + h) + time * d_load(casts->motion_y + k + h));
        }
        for (int side = 0; side < 2; side++) {
            char *place[V_WIDTH];
            vf row[4] = {v_set(0), v_set(0), v_load(casts->side[side].cosine + k), v_load(casts->side[side].sine + k)};
            if (any_turns) {
                turn_bodies(&casts->side[side], casts->time, k, cosine, sine);
                row[2] = v_load(cosine);
                row[3] = v_load(sine);
            }
            if (side == 1) {
                row[0] = v_load(x);
                row[1] = v_load(y);
            }
            for (size_t l = 0; l < V_WIDTH; l++)
                place[l] = (char *)casts->pose[side][k + l];
            v_put_rows(place, 0, row);
        }
    }
}

/* ------------------------------------------------------------------------------------------------ all */

/* Of casts 0 .. count - 1: takes the contacts at their times and finds what they mean, and where to look next. Of
 * NARC_CAST_HIT and NARC_CAST_UNFINISHED contact and time are the answer's. */
void NARC_NAMED(advance)(const narc_shapes *shapes, narc_casts *casts, size_t count) {
    for (size_t k = 0; k < count; k += V_WIDTH) {
        const vm live = vm_front(count - k < V_WIDTH ? (int)(count - k) : V_WIDTH);
        const vm turning = v_lt(v_set(0), v_load(casts->turning + k));
        const struct touch touch = load_contacts(casts->contact, k, count);
        struct step lines, turns;
        const bool any_turns = vm_any(vm_and(live, turning));
        const struct step *from = any_turns ? &turns : &lines;
        if (any_turns)
            advance_turns(shapes, casts, &touch, k, vm_and(live, turning), &turns);
        const vm straight = vm_and_not(live, turning);
        if (vm_any(straight))
            advance_lines(shapes, casts, &touch, k, straight, &lines);
        else
            lines = turns;
        vi_store(casts->outcome + k, vi_truncate(v_select(straight, v_load(lines.outcome), v_load(from->outcome))));
        v_store(casts->time + k, v_select(straight, v_load(lines.time), v_load(from->time)));
        v_store(casts->back + k, v_select(straight, v_load(lines.back), v_load(from->back)));
        v_store(casts->rounds + k, v_select(straight, v_load(lines.rounds), v_load(from->rounds)));
    }
}
