/* SPDX-License-Identifier: MIT
 *
 * cast_lines.inl - casts where nothing turns: where outlines meet, and what contacts mean.
 *
 * With d the way from A's position to B's, w its change in a whole step, n a unit normal from A to B and f the separation:
 *
 * Along any n with n.w < 0 the gap g(t) = n.(d + t w) - h_A(n) - h_B(-n) is at the target at a time before which nothing is,
 * and the last of these times is the answer. There the way enters the set of differences, grown by the target, a chain
 * of arcs: for all n that arc i of A holds, and -n arc j of B, centre a_i - b_j and radius r_i + r_j + target. Along it,
 * counter-clockwise, what is to the left of the way comes nearer to it as long as the chain faces the way, n.w < 0; so
 * junctions of both are passed one by one until one is to the left, and the next to the right.
 *
 * What is found is as good as single precision, and a time before which nothing touches anyhow. From there on contacts tell:
 * f is convex in time, because it is the signed distance of a point on a line from a convex set. Its slope is n.w. So
 * the tangent never passes the first root (Newton).
 */
#ifndef NARC_SCENE_CAST_LINES_INL
#define NARC_SCENE_CAST_LINES_INL

#include <math.h>
#include <stdbool.h>

#include "base/shape.inl"
#include "base/vec2.inl"
#include "narc_scene.h"
#include "sat/arc_lookup.inl"
#include "scene/cast_fields.inl"
#include "scene/cast_lanes.inl"
#include "scene/cast_places.inl"
#include "scene/cast_start.inl"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* Junctions that are passed at most. */
enum { MOST_JUNCTIONS = 16 };

/* A normal that lies outside an arc's by no more than this is held by it: what that makes of an edge is rounding. */
#define ROOM_AT_JUNCTION 0x1p-22f

/* Where bodies come nearer by less than this part of their way, along a normal, they are taken to do so by this. */
#define LEAST_SLOPE 0x1p-40

/* Along which arcs casts meet, seen from A: their centres and radii, and normals from lo to hi, which both hold. */
struct meeting_arcs {
    float center_x[2][V_WIDTH], center_y[2][V_WIDTH], radius[2][V_WIDTH];
    float lo_x[V_WIDTH], lo_y[V_WIDTH], hi_x[V_WIDTH], hi_y[V_WIDTH];
};

/* Casts seen from A: B's position at the start, its rotation, and which way and how far it goes. */
struct flights {
    dvec2 from, rotation, along;
    vd way;
};

INLINE struct flights see_flights(const narc_casts *casts, size_t slot) {
    const dvec2 a = find_rotation(casts->side[0].cosine + slot, casts->side[0].sine + slot),
                b = find_rotation(casts->side[1].cosine + slot, casts->side[1].sine + slot),
                motion = turn_back(a, (dvec2){d_load(casts->motion_x + slot), d_load(casts->motion_y + slot)});
    const vd way = find_length(motion), divisor = d_select(d_lt(d_set(0), way), way, d_set(1));
    return (struct flights){turn_back(a, (dvec2){d_load(casts->x + slot), d_load(casts->y + slot)}),
                            turn_back(a, b),
                            {motion.x / divisor, motion.y / divisor},
                            way};
}

/* Which way B goes, and its pose where it is nearest to A. */
INLINE vec2 place_flights(const narc_casts *casts, size_t k, struct pose *out) {
    float x[V_WIDTH], y[V_WIDTH], cosine[V_WIDTH], sine[V_WIDTH], near_x[V_WIDTH], near_y[V_WIDTH];
    for (int h = 0; h < V_WIDTH; h += D_WIDTH) {
        const struct flights f = see_flights(casts, k + (size_t)h);
        const vd beside = find_cross(f.along, f.from);
        d_put_floats(x + h, f.along.x);
        d_put_floats(y + h, f.along.y);
        d_put_floats(cosine + h, f.rotation.x);
        d_put_floats(sine + h, f.rotation.y);
        d_put_floats(near_x + h, -beside * f.along.y);
        d_put_floats(near_y + h, beside * f.along.x);
    }
    *out = (struct pose){{v_load(near_x), v_load(near_y)},
                         {v_load(cosine), v_load(sine)},
                         v_load(casts->side[0].scale + k),
                         v_load(casts->side[1].scale + k)};
    return (vec2){v_load(x), v_load(y)};
}

/* The normal where the bounding circles meet. */
INLINE vec2 guess_normal(const struct pose *pose, const struct outline outline[2], vec2 v, vf target) {
    const vec2 from = {v_load(outline[0].bound_x), v_load(outline[0].bound_y)},
               to = {v_load(outline[1].bound_x), v_load(outline[1].bound_y)};
    const vf radii =
        v_add(v_mul(pose->scale_a, v_load(outline[0].bound)), v_mul(pose->scale_b, v_load(outline[1].bound)));
    const vf beside = v2_cross(v, v2_sub(place_center_b(to, pose), v2_scale(from, pose->scale_a)));
    const vf one = v_set(1), sine = v_max(v_set(-1), v_min(v_div(beside, v_add(radii, target)), one));
    return v2_sub(v2_scale(v2_left(v), sine), v2_scale(v, v_sqrt(v_sub(one, v_mul(sine, sine)))));
}

/* Do both arcs hold n, but for rounding? */
INLINE vm hold_normal(const struct arc_pair *arcs, vec2 n) {
    const vf of_a = v_min(v2_cross(arcs->a.start, n), v2_cross(n, arcs->a.end)),
             of_b = v_min(v2_cross(arcs->b.start, n), v2_cross(n, arcs->b.end));
    return v_le(v_set(-ROOM_AT_JUNCTION), v_min(of_a, of_b));
}

/* Which of two directions, both at most half a turn on from n, counter-clockwise where it goes `up`, comes first? */
INLINE vm is_first(vec2 a, vec2 b, vec2 n, vm up) {
    const vf turn = v2_cross(a, b), on = v_select(up, turn, v_neg(turn));
    const vf nearer = v_sub(v2_dot(n, a), v2_dot(n, b)); /* tells directions that are opposite, or nearly */
    return v_le(v_set(0), v_select(v_lt(v2_dot(a, b), v_set(0)), nearer, on));
}

/* Finds the arcs, and the normals among which the one that is searched for is. Returns the lanes that have some. */
INLINE vm find_meeting_arcs(const narc_record *records, const narc_casts *casts, size_t k,
                            const struct outline outline[2], vm live, struct meeting_arcs *out) {
    struct pose pose;
    struct ring ring[2];
    vi record[2];
    const vec2 v = place_flights(casts, k, &pose);
    const vf zero = v_set(0), target = v_load(casts->target + k);
    vec2 n = guess_normal(&pose, outline, v, target);
    UNROLL
    for (int side = 0; side < 2; side++) {
        const vi info = vi_select(live, vi_bits(v_load(casts->side[side].info + k)), vi_set(1)),
                 arc = vi_select(live, vi_bits(v_load(casts->side[side].record + k)), find_first_arc(vi_set(0), info)),
                 first = vi_sub(arc, find_first_arc(vi_set(0), info));
        ring[side] = (struct ring){arc, get_arc_count(info)};
        record[side] = find_arc(records, first, info, side == 0 ? n : v2_unrotate_opposite(pose.rotation, n));
    }
    vm up = vm_front(0);
    for (int step = 0;; step++) {
        const struct arc_pair arcs = load_arc_pair(records, record[0], record[1], &pose);
        const vf middle = v2_cross(find_center_difference(&arcs), v),
                 radius = v_add(v_add(arcs.a.radius, arcs.b.radius), target);
        const vm is_left = v_lt(zero, v_add(middle, v_mul(radius, v2_cross(v, n))));
        if (step == 0) {
            up = is_left;
            live = vm_and(live, hold_normal(&arcs, n));
        }
        const vec2 of_a = v2_select(up, arcs.a.end, arcs.a.start), of_b = v2_select(up, arcs.b.end, arcs.b.start);
        const vm a_is_next = is_first(of_a, of_b, n, up);
        const vec2 next = v2_select(a_is_next, of_a, of_b);
        const vm faces = v_lt(v2_dot(v, next), zero);
        const vf across = v_select(faces, v2_cross(v, next), v_select(up, v_set(-1), v_set(1)));
        const vm passed = vm_xor(is_left, up), ends = vm_xor(v_lt(zero, v_add(middle, v_mul(radius, across))), up);
        const vm goes_on = vm_and_not(vm_and(live, faces), vm_or(passed, ends));
        if (step == MOST_JUNCTIONS || !vm_any(goes_on)) {
            const vec2 far = v2_select(passed, n, next), lo = v2_select(up, n, far), hi = v2_select(up, far, n);
            v_store(out->lo_x, lo.x);
            v_store(out->lo_y, lo.y);
            v_store(out->hi_x, hi.x);
            v_store(out->hi_y, hi.y);
            break;
        }
        const vi none = vi_set(0), by = vi_select(goes_on, vi_select(up, vi_set(1), vi_set(-1)), none);
        n = v2_select(goes_on, next, n);
        record[0] = step_record(ring[0], record[0], vi_select(a_is_next, by, none));
        record[1] = step_record(ring[1], record[1], vi_select(a_is_next, none, by));
    }
    UNROLL
    for (int side = 0; side < 2; side++) {
        int32_t index[V_WIDTH];
        vf field[4];
        vi_store(index, record[side]);
        v_rows(records, sizeof *records, index, field);
        v_store(out->center_x[side], field[0]);
        v_store(out->center_y[side], field[1]);
        v_store(out->radius[side], field[2]);
    }
    return live;
}

/* Moves casts to when they meet along these arcs; those that do not, miss. */
INLINE void meet(narc_casts *casts, size_t k, int h, const struct meeting_arcs *arcs, vl live, float *outcome) {
    const size_t slot = k + (size_t)h;
    const struct flights f = see_flights(casts, slot);
    const vd zero = d_set(0), one = d_set(1);
    const vd scale_a = d_of_floats(casts->side[0].scale + slot), scale_b = d_of_floats(casts->side[1].scale + slot);
    const dvec2 v = f.along, a = get_dvec2(arcs->center_x[0] + h, arcs->center_y[0] + h),
                b = turn(f.rotation, get_dvec2(arcs->center_x[1] + h, arcs->center_y[1] + h)),
                u = {f.from.x + scale_b * b.x - scale_a * a.x, f.from.y + scale_b * b.y - scale_a * a.y},
                lo = get_dvec2(arcs->lo_x + h, arcs->lo_y + h), hi = get_dvec2(arcs->hi_x + h, arcs->hi_y + h);
    const vd radius = scale_a * d_of_floats(arcs->radius[0] + h) + scale_b * d_of_floats(arcs->radius[1] + h) +
                      d_of_floats(casts->target + slot);
    const vl round = d_lt(zero, radius);
    const vd part = find_cross(v, u) / d_select(round, radius, one), most = d_max(-one, d_min(part, one));
    const vd sine = d_select(round, most, zero), cosine = d_sqrt((one - sine) * (one + sine));
    const dvec2 inner = {-sine * v.y - cosine * v.x, sine * v.x - cosine * v.y};
    const vl within = d_le(zero, find_cross(lo, inner)) & d_le(zero, find_cross(inner, hi)),
             first = d_lt(find_dot(hi, inner), find_dot(lo, inner));
    const dvec2 end = {d_select(first, lo.x, hi.x), d_select(first, lo.y, hi.y)},
                m = {d_select(within, inner.x, end.x), d_select(within, inner.y, end.y)};
    const vd error = find_dot(m, m) - one, factor = NARC_INVERSE_LENGTH(error);
    const dvec2 n = {factor * m.x, factor * m.y};
    const vd slope = -find_dot(n, v), least = d_set(LEAST_SLOPE), falls = f.way * d_max(slope, least);
    const vd gap = find_dot(n, u) - radius, start = gap / falls, sure = (gap - d_load(casts->enough + slot)) / falls;
    const vd latest = d_load(casts->end + slot);
    const vl moves = live & d_lt(zero, f.way),
             later = moves & d_lt(d_of_floats(casts->time + slot), sure) & d_le(start, latest);
    d_put_floats(casts->time + slot, d_select(later, round_down(start), d_of_floats(casts->time + slot)));
    d_put_floats(outcome + h, d_select(moves & d_lt(latest, sure), d_set(NARC_CAST_MISS), d_of_floats(outcome + h)));
}

/* Casts k ... that go on and do not turn, and are of other shapes than boxes alone, begin where their outlines meet. */
INLINE void begin_lines(const narc_shapes *shapes, narc_casts *casts, size_t k, const struct loaded *loaded,
                        float *outcome) {
    struct meeting_arcs arcs;
    const vi concave = vi_set((int32_t)(NARC_PIECE_CONCAVE << 8));
    vm live = vm_and_not(vm_and_not(loaded->fine, loaded->boxes), find_turning(casts, k));
    if (!vm_any(live))
        return;
    const vi info[] = {vi_bits(v_load(casts->side[0].info + k)), vi_bits(v_load(casts->side[1].info + k))};
    live = vm_and(live, v_le(v_set(CAST_GOES_ON), v_load(outcome)));
    live = vm_and(
        live, vi_lt(vi_set(2), vi_add(get_arc_count(info[0]), get_arc_count(info[1])))); /* else bounds have told it */
    for (int side = 0; NARC_PIECES && side < 2; side++)
        live = vm_and_not(live, vi_lt(vi_set(0), vi_and(info[side], concave)));
    if (!vm_any(live))
        return;
    live = find_meeting_arcs(shapes->records, casts, k, loaded->outline, live, &arcs);
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        meet(casts, k, h, &arcs, d_of_lanes(live, h), outcome);
}

/* ------------------------------------------------------------------------------------------------ Newton's steps */

INLINE void advance_line(const narc_casts *casts, const struct touch *touch, size_t k, int h, struct step *out) {
    const size_t slot = k + (size_t)h;
    const vd zero = d_set(0), time = d_of_floats(casts->time + slot),
             rounds = d_of_floats(casts->rounds + slot) + d_set(1), enough = d_load(casts->enough + slot);
    const vd gap = d_of_floats(touch->separation + h) - d_of_floats(casts->target + slot),
             slope = d_of_floats(touch->normal_x + h) * d_load(casts->motion_x + slot) +
                     d_of_floats(touch->normal_y + h) * d_load(casts->motion_y + slot);
    const vl parts = d_le(zero, slope), there = d_le(gap, zero) | (d_le(gap, enough) & ~parts);
    const vd next = time - gap / slope, safe = round_down(next), hit = d_set(NARC_CAST_HIT);
    vd outcome = d_select(d_le(d_set(MOST_ROUNDS), rounds), d_set(NARC_CAST_UNFINISHED), d_set(CAST_GOES_ON));
    outcome = d_select(parts | d_lt(d_load(casts->end + slot), next), d_set(NARC_CAST_MISS),
                       d_select(d_le(safe, time), hit, outcome));
    outcome = d_select(there, hit, outcome);
    put_step(out, h, outcome, d_select(d_lt(d_set(NARC_CAST_UNFINISHED), outcome), safe, time), rounds);
}

INLINE void advance_lines(const narc_casts *casts, const struct touch *touch, size_t k, struct step *out) {
    for (int h = 0; h < V_WIDTH; h += D_WIDTH)
        advance_line(casts, touch, k, h, out);
}

#endif
