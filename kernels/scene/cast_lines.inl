/* SPDX-License-Identifier: MIT
 *
 * cast_lines.inl - what contacts of casts mean where nothing turns.
 *
 * With d the way from A's position to B's, w its change in a whole step, n the contact normal and f the separation:
 *
 * f is convex in time, because it is the signed distance of a point on a line from a convex set. Its
 * slope is n.w. So the tangent never passes the first root (Newton). The circles that touch may be followed further, to
 * the root of their distance: where f still falls at that time, and is not below the target, no root was passed.
 */
#ifndef NARC_SCENE_CAST_LINES_INL
#define NARC_SCENE_CAST_LINES_INL

#include <math.h>
#include <stdbool.h>

#include "narc_scene.h"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

/* When, from now on, the circles of two arcs that are nearest to each other are at the target; false if never, or if
 * other arcs would be nearest then. */
INLINE vl find_touch(const narc_casts *casts, const struct touch *touch, size_t k, int h,
                     const struct held_arcs arcs[2], const struct outline_part parts[2], vd *out_duration) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), radii = d_of_floats(touch->radius_a + h) + d_of_floats(touch->radius_b + h),
             goal = radii + d_of_floats(casts->target + slot), way = radii + d_of_floats(touch->separation + h);
    const dvec2 n = get_dvec2(touch->normal_x + h, touch->normal_y + h), u = {way * n.x, way * n.y},
                motion = {d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)};
    const vd across = find_cross(u, motion), height = goal * goal * find_dot(motion, motion) - across * across;
    const vd duration = (find_dot(u, u) - goal * goal) / (d_sqrt(d_abs(height)) - find_dot(u, motion));
    vl found = d_lt(radii, d_set(INFINITY)) & d_lt(zero, goal) & d_le(zero, height);
    UNROLL
    for (int side = 0; side < 2; side++) {
        const vl round = d_of_lanes(parts[side].round, h);
        if (!d_any(~round))
            continue;
        const dvec2 then = {u.x + duration * motion.x, u.y + duration * motion.y}, back = {-then.x, -then.y};
        const dvec2 normal = turn_back(find_rotation(casts->side[side].cosine + slot, casts->side[side].sine + slot),
                                       side == 0 ? then : back);
        const dvec2 start = get_dvec2(arcs[side].start_x + h, arcs[side].start_y + h),
                    end = get_dvec2(arcs[side].end_x + h, arcs[side].end_y + h);
        found &= round | (d_le(zero, find_cross(start, normal)) & d_le(zero, find_cross(normal, end)));
    }
    *out_duration = duration;
    return found;
}

/* Newton's steps. Returns which may be tried to go further; `out_next`: than there, infinity for the others. */
INLINE vl advance_line(const narc_casts *casts, const struct touch *touch, size_t k, int h, struct step *out,
                       double *out_next) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), time = d_of_floats(casts->time + slot), back = d_of_floats(casts->back + slot),
             rounds = d_of_floats(casts->rounds + slot) + d_set(1), enough = d_load(casts->enough + slot);
    const vd gap = d_of_floats(touch->separation + h) - d_of_floats(casts->target + slot),
             slope = d_of_floats(touch->normal_x + h) * d_load(casts->motion_x + slot) +
                     d_of_floats(touch->normal_y + h) * d_load(casts->motion_y + slot);
    const vl parts = d_le(zero, slope), tried = d_le(zero, back), direct = d_le(back, d_set((double)CAST_DIRECT));
    const vl passed = tried & (parts | d_lt(gap, -enough)); /* it may have passed the first root */
    const vl there = d_le(gap, zero) | (d_le(gap, enough) & ~parts);
    const vd next = time - gap / slope, safe = round_down(next), hit = d_set(NARC_CAST_HIT), on = d_set(CAST_GOES_ON);
    vd outcome = d_select(d_le(d_set(MOST_ROUNDS), rounds), d_set(NARC_CAST_UNFINISHED), on);
    outcome = d_select(parts | d_lt(d_load(casts->end + slot), next), d_set(NARC_CAST_MISS),
                       d_select(d_le(safe, time), hit, outcome));
    outcome = d_select(passed, on, d_select(there, hit, outcome));
    const vl goes_on = d_lt(d_set(NARC_CAST_UNFINISHED), outcome);
    const vl free = goes_on & ~(passed | direct);
    d_store(out_next, d_select(free, next, d_set(INFINITY)));
    put_step(out, h, outcome, d_select(goes_on, d_select(passed, back, safe), time),
             d_select(passed | direct, d_set((double)CAST_DIRECT), d_set((double)CAST_FREE)),
             d_select(passed, rounds - d_set(1), rounds));
    return free;
}

/* Goes on to where circles touch, where that is later than Newton's step. */
INLINE void try_ahead(const narc_casts *casts, const struct touch *touch, size_t k, int h,
                      const struct held_arcs arcs[2], const struct outline_part parts[2], const double *next,
                      struct step *out) {
    const size_t slot = k + (size_t)h;
    vd duration;
    const vl found = find_touch(casts, touch, k, h, arcs, parts, &duration);
    const vd ahead = d_of_floats(casts->time + slot) + duration, safe = d_of_floats(out->time + h);
    const vl tries = found & d_lt(d_load(next), ahead) & d_le(ahead, d_load(casts->end + slot));
    d_put_floats(out->time + h, d_select(tries, round_down(ahead), safe));
    d_put_floats(out->back + h, d_select(tries, safe, d_of_floats(out->back + h)));
}

INLINE void advance_lines(const narc_shapes *shapes, const narc_casts *casts, const struct touch *touch, size_t k,
                          vm live, struct step *out) {
    struct held_arcs arcs[2];
    struct outline_part parts[2];
    double next[V_WIDTH];
    const vf radii = v_add(v_load(touch->radius_a), v_load(touch->radius_b));
    const vm round = vm_and(live, v_lt(radii, v_set(INFINITY)));
    int any = 0;
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        any |= d_any(d_of_lanes(round, h) & advance_line(casts, touch, k, h, out, next + h));
    if (!any)
        return;
    UNROLL
    for (int side = 0; side < 2; side++) {
        parts[side] = find_part(&casts->side[side], k, side, live, touch);
        load_held(shapes, &parts[side], parts[side].arc, &arcs[side]);
    }
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        try_ahead(casts, touch, k, h, arcs, parts, next + h, out);
}

#endif
