/* SPDX-License-Identifier: MIT
 *
 * proof.inl - what makes a value that was found the one that the deciding formula (overlay.inl) would give.
 *
 * Let K be all differences between a point of A and a point of B. Its support function is h = -g: the bodies collide if
 * the origin lies in K, and their depth d is the least h(n) over all directions n. K holds the circle around -axis with
 * the radius `core`, the sums of the two inscribed circles. Each arc of A and B that holds n gives a point of K on its
 * support line there.
 *
 * Rounding. e = 2^-24, S = D + E_a + E_b as in overlay.inl; every value here comes from the same arithmetic as there,
 * and is within 32 e S of exact, as the formula is. `slack` is 128 e S, twice what both together can be off by.
 *
 * All this is about outlines that are closed and convex. Where a caller's arcs do not join up to 32 e of the extent, in
 * all, slack is infinite, and nothing is proved (store.h, `reach`); what is less than that, slack covers, too.
 *
 * 1. Apart. If g(n) > margin + slack for one n, then the formula's separation is above the margin. A direction's arcs
 *    are looked up by 16-bit angles, so that they may be those behind junctions that are a little over 2^-13 radians
 *    away (diamond angles change by half a radian or more in a radian; the bin at -x is twice as wide as the others,
 *    but there they change by one). At a junction without an edge this changes h by some 2^-27 of a radius, less than
 *    the rounding; at an edge by 2^-13 of its length, that is of at most twice a bounding radius. LOOSE slacks, 2^-11
 *    S, cover that and the rounding.
 *
 * 2. Collision, by a point p of K that lies opposite to the circle: a ray from p through the origin hits the circle. If
 *    it passes the centre within 7/8 of the core, K holds a circle of core / 8 around the foot of the centre on the
 *    ray, at the distance a behind the origin, and so one of core / 8 * |p| / (|p| + a) around the origin. The arcs
 *    were looked up, so where a junction is a sharp corner p may lie beyond the shape, by 2^-13 of both radii or 16
 *    slacks; with the rounding, 16.5 slacks are what that circle must exceed for the formula to be below 0. CORNER / 8
 *    is 20.
 *
 * 3. Depth, by circles inside the arcs that touch. Let n be a local maximum of g between junctions, -d its value. The
 *    circles of radius `inner` (store.h) that touch the arcs from inside at the support points lie in the shapes, so K
 *    holds one of radius t, their sum, that touches K's outline at d n. In a direction at an angle x from n this gives
 *        h >= d + (t - d) (1 - cos x),
 *    so if t > d, n is the only place with the least h: no other candidate of the formula counts, provided that
 *    rounding cannot make one of about the same value. Beyond an angle of NARC_INNER_WINDOW the inequality keeps
 *    values apart if t - d > CLEAR slacks, because 1 - cos 0.1 > 1 / CLEAR. Up to there no radius of curvature of K is
 *    below t, so that |g'| >= (t - d) sin x: with n at an angle of y from the nearest junction, all signs that the
 *    formula sees at junctions are right if (t - d) sin y > slack, and then it has no candidate there but this one.
 *    Last, y > 2^-12, so that n is no junction's normal up to rounding (contact.inl's PARALLEL).
 *
 * 4. Depth, for kinks, and where t is too small. Directions outside a fan around the axis are out of the question: the
 *    circle in K reaches further there, h >= core - |axis| cos(their angle to the axis). On each side of n, up to the
 *    fan's end at an angle f < 120 degrees from n, let each shape's arc of that side end at an angle y_a, y_b, with
 *    radius r, and let the edge at n (of a kink) reach l beyond the foot of n. With c = 2 sin(f / 2), the chord,
 *        h >= d + (s - d) (1 - cos x),   s = l cot(f / 2) + s_a + s_b,
 *        s_a = the larger of inner_a and near_a + (r_a - near_a) min(1, sin y_a / c)   (near_a: only up to 60 degrees),
 *    because an arc of radius r that ends at y adds r (1 - cos x) up to y, and beyond it r (cos(x - y) - cos x), which
 *    is at least r (1 - cos x) sin(y / 2) / sin(x / 2); and sin y <= 2 sin(y / 2), the chord. So s > d proves this
 *    side. Rounding: as in 3, or, if (s - d) (1 - cos y) > slack for the nearer end, by values alone. At a kink the
 *    edges must reach l > slack to both sides, so that the signs next to it are right.
 */

/* Slacks. */
#define LOOSE  64.0f
#define CLEAR  256.0f
#define CORNER 160.0f

/* The least angle from a junction, or its sine. */
#define LEAST_ANGLE 0x1p-12f

/* Is g(d) above `limit`, for a direction d of any length with u and the sum of radii of its arcs? In squares, so that
 * it takes no root; what overflows proves nothing, nor does a direction too short to keep its digits. */
INLINE vm is_above(vf u_x, vf u_y, vf radii, vf d_x, vf d_y, vf limit) {
    const vf along = dot(u_x, u_y, d_x, d_y), reach = v_add(radii, limit), d2 = dot(d_x, d_y, d_x, d_y);
    const vm in_range = vm_and(v_le(v_set(0x1p-126f), d2), vm_and(v_lt(v_set(0), along), v_lt(v_set(0), reach)));
    return vm_and(in_range, v_lt(v_mul(v_mul(reach, reach), d2), v_mul(along, along)));
}

/* What g must exceed the margin by, with arcs that were looked up. */
INLINE vf apart_slack(const struct queue *q, int k) {
    const vm smooth = head_is(vi_and(get_bits(q, BYTES_A, k), get_bits(q, BYTES_B, k)), NARC_SHAPE_SMOOTH);
    return v_mul(get(q, SLACK, k), v_select(smooth, v_set(1), v_set(LOOSE)));
}

/* Proof 2, with p and everything else that has its length times `length`. */
INLINE vm has_common_point(const struct queue *q, int k, vf p_x, vf p_y, vf length) {
    const vf axis_x = get(q, AXIS_X, k), axis_y = get(q, AXIS_Y, k), core = get(q, CORE, k), slack = get(q, SLACK, k);
    const vf along = dot(axis_x, axis_y, p_x, p_y), across = cross(axis_x, axis_y, p_x, p_y);
    const vf p2 = dot(p_x, p_y, p_x, p_y), reach = v_mul(v_set(0.875f), core);
    const vm meets = vm_and(v_lt(v_set(0), along), v_lt(v_mul(across, across), v_mul(v_mul(reach, reach), p2)));
    /* |p| core / 8 > CORNER / 8 slack (|p| + a), a = along / |p| */
    return vm_and(meets, v_lt(v_mul(v_mul(v_set(CORNER), slack), v_add(p2, v_mul(length, along))), v_mul(p2, core)));
}

/* Proof 3: `least` is the sine of the angle to the nearest junction, times `length`. */
INLINE vm is_only_peak(vf inner, vf separation, vf least, vf length, vf slack) {
    const vf spare = v_add(inner, separation);
    const vm clear = vm_and(v_lt(v_mul(v_set(CLEAR), slack), spare), v_lt(v_mul(slack, length), v_mul(spare, least)));
    return vm_and(clear, v_le(v_mul(v_set(LEAST_ANGLE), length), least));
}

/* What an arc adds to s in proof 4, times the chord. */
INLINE vf side_sum(const struct arcs *arc, vf sine, vf chord) {
    const vf near = v_select(v_le(chord, v_set(1)), arc->near, v_set(0));
    const vf far = v_add(v_mul(near, chord), v_mul(v_sub(arc->radius, near), v_min(chord, sine)));
    return v_max(v_mul(arc->inner, chord), far);
}

/* Proof 4 for one side: `edge` is l, `cosine` that of f. Tiny changes of f and of its cotangent, 2 cos(f / 2) / c and
 * cos(f / 2) > 1 - c^2 / 4, are on the safe side. */
INLINE vm side_is_clear(const struct couple *side, vf sine_a, vf sine_b, vf edge, vm kink, vf cosine, vf depth,
                        vf slack) {
    const vf chord2 = v_sub(v_set(2.0001f), v_add(cosine, cosine)), chord = v_sqrt(v_max(chord2, v_set(0)));
    const vf cotangent = v_sub(v_set(1.999f), v_mul(v_set(0.5f), chord2));
    const vf sums = v_add(side_sum(&side->a, sine_a, chord), side_sum(&side->b, sine_b, chord));
    const vf spare = v_sub(v_add(v_mul(edge, cotangent), sums), v_mul(depth, chord));
    const vf least = v_min(sine_a, sine_b), inner = v_add(side->a.inner, side->b.inner);
    const vm by_value = v_lt(v_mul(v_mul(v_set(2), slack), chord), v_mul(spare, v_mul(least, least)));
    const vm by_slope =
        vm_and(v_lt(v_mul(v_mul(v_set(CLEAR), slack), chord), spare), v_lt(slack, v_mul(v_sub(inner, depth), least)));
    const vm in_range = vm_and(v_le(v_set(-0.49f), cosine), v_le(v_set(LEAST_ANGLE), least));
    return vm_and(vm_and(in_range, vm_or(by_value, by_slope)), vm_or(vm_not(kink), v_lt(slack, edge)));
}

/* The sine of the angle from n to the end of an arc, at most a right angle of it: 1 above that, and for circles, whose
 * junctions mean nothing. Negative if n is not on this side of the end. */
INLINE vf sine_to(vf n_x, vf n_y, vf end_x, vf end_y, vm circle) {
    const vf sine = cross(n_x, n_y, end_x, end_y);
    const vm far = vm_and(v_le(v_set(0), sine), v_lt(dot(n_x, n_y, end_x, end_y), v_set(0)));
    return v_select(vm_or(circle, far), v_set(1), sine);
}

/* The sines of the angles from a peak to the ends of its arcs. */
struct sines {
    vf start_a, end_a, start_b, end_b, least;
};

INLINE struct sines find_sines(const struct queue *q, int k, const struct peak *p, vf n_x, vf n_y) {
    const vm circle_a = head_is(get_bits(q, BYTES_A, k), NARC_SHAPE_CIRCLE);
    const vm circle_b = head_is(get_bits(q, BYTES_B, k), NARC_SHAPE_CIRCLE);
    struct sines s;
    s.end_a = sine_to(n_x, n_y, p->after.a.end_x, p->after.a.end_y, circle_a);
    s.end_b = sine_to(n_x, n_y, p->after.b.end_x, p->after.b.end_y, circle_b);
    /* Clockwise: the same mirrored. */
    s.start_a = sine_to(n_x, v_neg(n_y), p->before.a.start_x, v_neg(p->before.a.start_y), circle_a);
    s.start_b = sine_to(n_x, v_neg(n_y), p->before.b.start_x, v_neg(p->before.b.start_y), circle_b);
    s.least = v_min(v_min(s.start_a, s.end_a), v_min(s.start_b, s.end_b));
    return s;
}

/* Is a peak with the unit normal n, whose arcs hold n, the formula's answer? Proofs 3 and 4. */
INLINE vm is_highest(const struct queue *q, int k, const struct peak *p, const struct sines *s, vf n_x, vf n_y,
                     vf separation) {
    const vf one = v_set(1), zero = v_set(0), slack = get(q, SLACK, k), depth = v_neg(separation);
    const vf axis_x = get(q, AXIS_X, k), axis_y = get(q, AXIS_Y, k);
    const vf axis2 = dot(axis_x, axis_y, axis_x, axis_y), axis_length = v_sqrt(axis2);
    /* The cosine of half the fan, and then those of its ends seen from n, all times the axis' length or its square. */
    const vf fan = v_min(axis_length, v_sub(v_add(get(q, CORE, k), separation), slack));
    const vf fan_sine = v_sqrt(v_max(zero, v_sub(axis2, v_mul(fan, fan))));
    const vf along = dot(axis_x, axis_y, n_x, n_y), across = cross(axis_x, axis_y, n_x, n_y);
    const vf even = v_mul(fan, along), odd = v_mul(fan_sine, across);
    const vf cosine_after = v_div(v_add(even, odd), axis2), cosine_before = v_div(v_sub(even, odd), axis2);
    const vm narrow = vm_and(v_lt(zero, along), v_le(v_mul(v_set(-0.5f), axis_length), fan));

    const vf after_x = v_sub(p->after.b.x, p->after.a.x), after_y = v_sub(p->after.b.y, p->after.a.y);
    const vf before_x = v_sub(p->before.b.x, p->before.a.x), before_y = v_sub(p->before.b.y, p->before.a.y);
    const vf edge_after = v_select(p->kink, cross(after_x, after_y, n_x, n_y), zero);
    const vf edge_before = v_select(p->kink, cross(n_x, n_y, before_x, before_y), zero);
    const vm after = side_is_clear(&p->after, s->end_a, s->end_b, edge_after, p->kink, cosine_after, depth, slack);
    const vm before =
        side_is_clear(&p->before, s->start_a, s->start_b, edge_before, p->kink, cosine_before, depth, slack);

    const vf inner = v_add(p->after.a.inner, p->after.b.inner);
    const vm only = vm_and_not(is_only_peak(inner, separation, s->least, one, slack), p->kink);
    return vm_or(only, vm_and(narrow, vm_and(after, before)));
}

/* The local maximum near DIRECTION of the pairs k ... of a queue, climbed to from the arcs in record_a and record_b,
 * and what it proves: that the separation is above the margin, or that it is this. */
struct top {
    struct peak peak;
    vf separation, n_x, n_y;
    vm apart, sure;
};

INLINE struct top climb_to_top(const narc_shapes *shapes, const struct queue *q, int k, vm live, float margin) {
    struct top top;
    const struct peak peak = top.peak = climb(shapes, q, k, live);
    const vf u_x = v_sub(peak.after.b.x, peak.after.a.x), u_y = v_sub(peak.after.b.y, peak.after.a.y);
    const vf radii = v_add(peak.after.a.radius, peak.after.b.radius), length = v_sqrt(dot(u_x, u_y, u_x, u_y));
    const vf value = v_select(peak.kink, dot(u_x, u_y, peak.n_x, peak.n_y), length);
    const vf n_length = v_select(peak.kink, v_set(1), length);
    top.separation = v_sub(value, radii);
    top.n_x = v_div(peak.n_x, n_length);
    top.n_y = v_div(peak.n_y, n_length);
    const struct sines sines = find_sines(q, k, &peak, top.n_x, top.n_y);
    const vm found = vm_and(vm_and(live, peak.found), v_le(v_set(0), sines.least));
    top.apart = vm_and(found, v_lt(v_add(v_set(margin), get(q, SLACK, k)), top.separation));
    top.sure = vm_and(vm_and_not(found, top.apart), is_highest(q, k, &peak, &sines, top.n_x, top.n_y, top.separation));
    return top;
}
