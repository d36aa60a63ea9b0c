/* SPDX-License-Identifier: MIT
 *
 * certificates.inl - proofs that a value that a search has found is the one that the deciding formula (normal_fan.inl)
 * would give.
 *
 * Let K be all differences between a point of A and a point of B. Its support function is h = -g: the bodies collide if
 * the origin lies in K, and their depth d is the least h(n) over all directions n. K holds the circle around -axis with
 * the radius `core`, the sum of the two inscribed circles. Each arc of A and B that holds n gives a point of K on its
 * support line there.
 *
 * Rounding. e = 2^-24, S = D + E_a + E_b as in normal_fan.inl. Every value here comes from the same arithmetic as
 * there, and is within 32 e S of exact, as the formula is. `slack` is 128 e S, twice what both together can be off by.
 *
 * All this holds for outlines that are closed and convex. Where a caller's arcs fail to join by more than 32 e of the
 * extent, in all, slack is infinite and nothing is proved (store.h, `extent_ratio`); slack covers what is less.
 */
#ifndef NARC_SAT_CERTIFICATES_INL
#define NARC_SAT_CERTIFICATES_INL

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

/* A local maximum of the gap over all directions (normal_fan.inl). It lies between two junctions, where `after` and
 * `before` are both the arcs that hold it, or (`kink`) at a junction, with the arcs after it and those before. */
struct local_maximum {
    vm found, turned, kink; /* turned: not found, but near `direction` */
    vec2 direction;         /* not yet of length 1 */
    struct arc_pair after, before;
    vi record_a, record_b; /* of the arcs after it */
};

/* ------------------------------------------------------------------------------------------------ 1. apart
 *
 * If g(n) > margin + slack for one n, the formula's separation is above the margin. The arcs of a direction are looked
 * up by 16-bit angles, so they may be those behind junctions that are a little over 2^-13 radians away (diamond angles
 * change by half a radian or more in a radian; the bin at -x is twice as wide as the others, but there they change by
 * one). At a junction without an edge this changes h by some 2^-27 of a radius, less than the rounding; at an edge by
 * 2^-13 of its length, which is at most twice a bounding radius. LOOSE slacks, 2^-11 S, cover that and the rounding. */
#define LOOSE 64.0f

/* By how much g must exceed the margin, with arcs that were looked up. */
INLINE vf find_lookup_slack(const struct queue *queue, int k) {
    return v_mul(get(queue, SLACK, k), v_select(find_smooth(queue, k), v_set(1), v_set(LOOSE)));
}

/* Is g(d) above `limit`, for a direction d of any length, with u and the sum of radii of its arcs? In squares, so that
 * it takes no root. What overflows proves nothing, nor does a direction too short to keep its digits. */
INLINE vm is_above(vec2 u, vf radii, vec2 d, vf limit) {
    const vf along = v2_dot(u, d), least = v_add(radii, limit), square = v2_dot(d, d);
    const vm in_range = vm_and(v_le(v_set(LEAST_SQUARE), square), vm_and(v_lt(v_set(0), along), v_lt(v_set(0), least)));
    return vm_and(in_range, v_lt(v_mul(v_mul(least, least), square), v_mul(along, along)));
}

/* ------------------------------------------------------------------------------------------------ 2. collision
 *
 * Let p be a point of K that lies opposite to the circle: the ray from p through the origin hits the circle. If it
 * passes the centre within 7/8 of the core, K holds a circle of core / 8 around the foot of the centre on the ray, at
 * the distance a behind the origin, and so one of core / 8 * |p| / (|p| + a) around the origin. The arcs were looked
 * up, so where a junction is a sharp corner p may lie beyond the shape, by 2^-13 of both radii or 16 slacks. With the
 * rounding, that circle must exceed 16.5 slacks for the formula to be below 0. CORNER / 8 is 20. */
#define CORNER 160.0f

/* `p` and everything else that has its length come times `length`. */
INLINE vm has_common_point(const struct queue *queue, int k, vec2 p, vf length) {
    const vec2 axis = get_vec2(queue, AXIS, k);
    const vf core = get(queue, CORE, k), slack = get(queue, SLACK, k);
    const vf along = v2_dot(axis, p), across = v2_cross(axis, p), square = v2_dot(p, p);
    const vf width = v_mul(v_set(0.875f), core);
    const vm meets = vm_and(v_lt(v_set(0), along), v_lt(v_mul(across, across), v_mul(v_mul(width, width), square)));
    /* |p| core / 8 > CORNER / 8 slack (|p| + a), a = along / |p| */
    const vf needed = v_mul(v_mul(v_set(CORNER), slack), v_add(square, v_mul(length, along)));
    return vm_and(meets, v_lt(needed, v_mul(square, core)));
}

/* ------------------------------------------------------------------------------------------------ 3. depth, smooth
 *
 * Depth by circles inside the arcs that touch. Let n be a local maximum of g between junctions, -d its value. The
 * circles of radius `inner` (store.h) that touch the arcs from inside at the support points lie in the shapes, so K
 * holds one of radius t, their sum, that touches K's outline at d n. In a direction at an angle x from n this gives
 *     h >= d + (t - d) (1 - cos x),
 * so if t > d, n is the only place with the least h: no other candidate of the formula counts, provided that rounding
 * cannot make one of about the same value. Beyond an angle of NARC_INNER_WINDOW the inequality keeps values apart if
 * t - d > CLEAR slacks, because 1 - cos 0.1 > 1 / CLEAR. Up to there no radius of curvature of K is below t, so that
 * |g'| >= (t - d) sin x: with n at an angle of y from the nearest junction, all signs that the formula sees at
 * junctions are right if (t - d) sin y > slack, and then it has no candidate there but this one. Last,
 * y > LEAST_ANGLE, so that n is no junction's normal up to rounding (contact_point.inl's PARALLEL). */
#define CLEAR       256.0f
#define LEAST_ANGLE 0x1p-12f

/* `least` is the sine of the angle to the nearest junction, times `length`. */
INLINE vm is_only_maximum(vf inner, vf separation, vf least, vf length, vf slack) {
    const vf spare = v_add(inner, separation);
    const vm clear = vm_and(v_lt(v_mul(v_set(CLEAR), slack), spare), v_lt(v_mul(slack, length), v_mul(spare, least)));
    return vm_and(clear, v_le(v_mul(v_set(LEAST_ANGLE), length), least));
}

/* ------------------------------------------------------------------------------------------------ 4. depth, any
 *
 * Depth at kinks, and where t is too small. Directions outside a fan around the axis are out of the question: the
 * circle in K reaches further there, h >= core - |axis| cos(their angle to the axis). On each side of n, up to the
 * fan's end at an angle f < 120 degrees from n, let each shape's arc of that side end at an angle y_a, y_b, with radius
 * r, and let the edge at n (of a kink) reach l beyond the foot of n. With c = 2 sin(f / 2), the chord,
 *     h >= d + (s - d) (1 - cos x),   s = l cot(f / 2) + s_a + s_b,
 *     s_a = the larger of inner_a and near_a + (r_a - near_a) min(1, sin y_a / c)   (near_a: only up to 60 degrees),
 * because an arc of radius r that ends at y adds r (1 - cos x) up to y, and beyond it r (cos(x - y) - cos x), which is
 * at least r (1 - cos x) sin(y / 2) / sin(x / 2); and sin y <= 2 sin(y / 2), the chord. So s > d proves this side.
 * Rounding: as in 3, or, if (s - d) (1 - cos y) > slack for the nearer end, by values alone. At a kink the edges must
 * reach l > slack to both sides, so that the signs next to it are right. */

/* What an arc adds to s, times the chord. */
INLINE vf find_side_sum(const struct arcs *arc, vf sine, vf chord) {
    const vf near = v_select(v_le(chord, v_set(1)), arc->near, v_set(0));
    const vf far = v_add(v_mul(near, chord), v_mul(v_sub(arc->radius, near), v_min(chord, sine)));
    return v_max(v_mul(arc->inner, chord), far);
}

/* One side: `edge` is l, `cosine` that of f. The tiny changes of f and of its cotangent, 2 cos(f / 2) / c and
 * cos(f / 2) > 1 - c^2 / 4, are on the safe side. */
INLINE vm is_side_clear(const struct arc_pair *side, vf sine_a, vf sine_b, vf edge, vm kink, vf cosine, vf depth,
                        vf slack) {
    const vf square = v_sub(v_set(2.0001f), v_add(cosine, cosine)), chord = v_sqrt(v_max(square, v_set(0)));
    const vf cotangent = v_sub(v_set(1.999f), v_mul(v_set(0.5f), square));
    const vf sums = v_add(find_side_sum(&side->a, sine_a, chord), find_side_sum(&side->b, sine_b, chord));
    const vf spare = v_sub(v_add(v_mul(edge, cotangent), sums), v_mul(depth, chord));
    const vf least = v_min(sine_a, sine_b), inner = v_add(side->a.inner, side->b.inner);
    const vm by_value = v_lt(v_mul(v_mul(v_set(2), slack), chord), v_mul(spare, v_mul(least, least)));
    const vm by_slope =
        vm_and(v_lt(v_mul(v_mul(v_set(CLEAR), slack), chord), spare), v_lt(slack, v_mul(v_sub(inner, depth), least)));
    const vm in_range = vm_and(v_le(v_set(-0.49f), cosine), v_le(v_set(LEAST_ANGLE), least));
    return vm_and(vm_and(in_range, vm_or(by_value, by_slope)), vm_or(vm_not(kink), v_lt(slack, edge)));
}

/* ------------------------------------------------------------------------------------------------ depth */

/* The sine of the angle from n to the end of an arc, at most a right angle of it: 1 above that, and for circles, whose
 * junctions mean nothing. Negative if n is not on this side of the end. */
INLINE vf find_sine(vec2 n, vec2 end, vm circle) {
    const vf sine = v2_cross(n, end);
    const vm far = vm_and(v_le(v_set(0), sine), v_lt(v2_dot(n, end), v_set(0)));
    return v_select(vm_or(circle, far), v_set(1), sine);
}

/* The sines of the angles from a local maximum to the ends of its arcs. */
struct sines {
    vf start_a, end_a, start_b, end_b, least;
};

INLINE vec2 mirror(vec2 a) { return (vec2){a.x, v_neg(a.y)}; }

INLINE struct sines find_sines(const struct queue *queue, int k, const struct local_maximum *m, vec2 n) {
    const vm circle_a = has_flag(get_bits(queue, INFO_A, k), NARC_SHAPE_CIRCLE);
    const vm circle_b = has_flag(get_bits(queue, INFO_B, k), NARC_SHAPE_CIRCLE);
    struct sines s;
    s.end_a = find_sine(n, m->after.a.end, circle_a);
    s.end_b = find_sine(n, m->after.b.end, circle_b);
    s.start_a = find_sine(mirror(n), mirror(m->before.a.start), circle_a); /* clockwise */
    s.start_b = find_sine(mirror(n), mirror(m->before.b.start), circle_b);
    s.least = v_min(v_min(s.start_a, s.end_a), v_min(s.start_b, s.end_b));
    return s;
}

/* Where the fan ends on both sides of n: the cosines of the angles, and whether it is narrow enough. */
struct fan_ends {
    vf after, before;
    vm narrow;
};

INLINE struct fan_ends find_fan_ends(const struct queue *queue, int k, vec2 n, vf separation) {
    const vf zero = v_set(0), slack = get(queue, SLACK, k);
    const vec2 axis = get_vec2(queue, AXIS, k);
    const vf axis_square = v2_dot(axis, axis), axis_length = v_sqrt(axis_square);
    /* The cosine of half the fan, and then those of its ends seen from n, all times the axis' length or its square. */
    const vf fan = v_min(axis_length, v_sub(v_add(get(queue, CORE, k), separation), slack));
    const vf fan_sine = v_sqrt(v_max(zero, v_sub(axis_square, v_mul(fan, fan))));
    const vf along = v2_dot(axis, n), across = v2_cross(axis, n);
    const vf even = v_mul(fan, along), odd = v_mul(fan_sine, across);
    return (struct fan_ends){v_div(v_add(even, odd), axis_square), v_div(v_sub(even, odd), axis_square),
                             vm_and(v_lt(zero, along), v_le(v_mul(v_set(-0.5f), axis_length), fan))};
}

/* Is a local maximum with the unit normal n, whose arcs hold n, the formula's answer? Certificates 3 and 4. */
INLINE vm is_global_maximum(const struct queue *queue, int k, const struct local_maximum *m, const struct sines *s,
                            vec2 n, vf separation) {
    const vf zero = v_set(0), slack = get(queue, SLACK, k), depth = v_neg(separation);
    const struct fan_ends ends = find_fan_ends(queue, k, n, separation);
    const vf edge_after = v_select(m->kink, v2_cross(find_center_difference(&m->after), n), zero);
    const vf edge_before = v_select(m->kink, v2_cross(n, find_center_difference(&m->before)), zero);
    const vm after = is_side_clear(&m->after, s->end_a, s->end_b, edge_after, m->kink, ends.after, depth, slack);
    const vm before =
        is_side_clear(&m->before, s->start_a, s->start_b, edge_before, m->kink, ends.before, depth, slack);

    const vf inner = v_add(m->after.a.inner, m->after.b.inner);
    const vm only = vm_and_not(is_only_maximum(inner, separation, s->least, v_set(1), slack), m->kink);
    return vm_or(only, vm_and(ends.narrow, vm_and(after, before)));
}

#endif
