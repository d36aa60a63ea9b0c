/* SPDX-License-Identifier: MIT
 *
 * circles.inl - pairs with a circle about its own origin: two circles, and a circle and a box or a capsule (store.h,
 * narc_box_form), by clamping. They share a queue, with fields of boxes.
 *
 * Let p be the centre of the circle in the frame of the other shape, and h that one's half sizes; of two circles it is A,
 * and h is 0. Without the radii the gap g of a sharp box and a point has four junctions, with the values |p.x| - h.x, |p.y|
 * - h.y and two others, opposite to these. Its kinks and corners against the point lie in nine regions: beyond a corner in x
 * and y that corner answers, and elsewhere the edges on whose length p lies. Where p is by two slacks off the limits of its
 * region, and the values of two edges differ by as much, every sign of the formula is right: what is found here is its only
 * candidate, or the largest by more than rounding. u is longer than two slacks then, so that it is no loose one (faces.inl).
 * A capsule has two edges, and ends that answer wherever p is beyond them. The junctions of circles make no kink, as u is
 * the same on both sides; an interval without width, where u is opposite to it, gives a value that is less. Other pairs
 * are left to the search. docs/algorithm.md, section 9.
 */
#ifndef NARC_BOX_CIRCLES_INL
#define NARC_BOX_CIRCLES_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/rows.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_contact.inl"
#include "box/box_pairs.inl"
#include "box/box_rows.inl"
#include "kernels.h"
#include "simd/simd.h"

/* Of the shape beside the circle, the fields of A in BOX_HALF_A, not scaled, and BOX_RADIUS_A; its scale is BOX_SCALE_B.
 * BOX_RADIUS_B is the circle's radius. BOX_CODE: the number of the corner that touches, or of that behind the edge, bits
 * 0-1; the first arc, bits 4-5; and these. */
enum {
    TOUCHED_EDGE = 1 << 2,
    CIRCLE_IS_A = 1 << 3,
    BESIDE_CAPSULE = 1 << 6,
    BESIDE_SIDES = 1 << 7 /* not two circles */
};

/* The same out of the queue. */
struct circle_pair {
    vec2 position, rotation, to_world; /* B's pose in A's frame, and A's rotation in the world */
    vec2 half;                         /* of the shape beside the circle, not scaled */
    vf scale, radius, radius_circle;   /* its scale, its radius and the circle's, scaled */
    vm is_a, sides, capsule, edge; /* is A the circle; has the other one sides; is it a capsule; does its edge touch? */
    vi number, first;              /* of the corner that touches, or of that behind the edge; its first arc */
};

/* What is known of all pairs that are looked at: two circles; or one, and a shape with sides beside it. */
enum circle_pairs { ANY_CIRCLES, TWO_CIRCLES, CIRCLE_IS_FIRST, CIRCLE_IS_LAST };

/* One where A is the circle, and the other one elsewhere. */
INLINE vf choose_side(enum circle_pairs of, vm is_a, vf first, vf other) {
    return of == CIRCLE_IS_FIRST ? first : of == ANY_CIRCLES ? v_select(is_a, first, other) : other;
}

INLINE vi choose_side_bits(enum circle_pairs of, vm is_a, vi first, vi other) {
    return of == CIRCLE_IS_FIRST ? first : of == ANY_CIRCLES ? vi_select(is_a, first, other) : other;
}

INLINE vec2 choose_side_vec2(enum circle_pairs of, vm is_a, vec2 first, vec2 other) {
    return (vec2){choose_side(of, is_a, first.x, other.x), choose_side(of, is_a, first.y, other.y)};
}

INLINE vi choose_bit(vm m, int bit) { return vi_select(m, vi_set(bit), vi_set(0)); }

/* Pairs of a circle and any shape that has a form. */
INLINE vm are_with_circle(const struct box_form *a, const struct box_form *b) {
    const vi circle = vi_set((int32_t)NARC_IS_CIRCLE - 1), zero = vi_set(0); /* circles have the largest number */
    const vm a_is = vi_lt(circle, a->info), b_is = vi_lt(circle, b->info);
    return vm_or(vm_and(a_is, vi_lt(zero, b->info)), vm_and(b_is, vi_lt(zero, a->info)));
}

/* Pairs whose contact is that of the forms, for certain; with those that are apart besides; and without. */
struct circle_verdict {
    vm known, taken, near;
};

/* Sets the bits of pairs in the lanes `near` that overlap for certain, if nothing else is asked for; returns the others.
 * `square`: the centre's distance from the sharp shape, squared. */
INLINE vm settle_deep(const struct call *call, int32_t number, vm near, vf square, vf radii, vf two) {
    if (!call->bits)
        return near;
    const vf core = v_max(v_sub(radii, two), v_set(0));
    return settle_overlaps(call, number, near, v_lt(square, v_mul(core, core)));
}

/* Two circles; see judge_circles(): the same values. */
INLINE struct circle_verdict judge_two_circles(const struct call *call, const struct box_form *a,
                                               const struct box_form *b, const struct placement *placement, vm which,
                                               int32_t number, struct circle_pair *out) {
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position;
    const vf zero = v_set(0), x = v_abs(t.x), y = v_abs(t.y);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf radii = v_add(radius_a, radius_b);
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(x, y), radii)), two = v_add(slack, slack);
    const vf square = v2_dot(t, t), limit = v_add(v_add(radii, placement->margin), slack);
    const vm apart = v_lt(v_mul(limit, limit), square), certain = v_lt(two, v_max(x, y));
    const vm sizes = vm_and(v_le(v_set(2 * (float)NARC_MIN_SIZE), v_min(radius_a, radius_b)),
                            v_le(radii, v_set(0.5f * (float)NARC_MAX_SIZE)));
    const vm valid = vm_and(which, sizes), known = vm_and(valid, certain), none = vm_front(0);
    const vm near = settle_deep(call, number, vm_and_not(known, apart), square, radii, two);
    *out = (struct circle_pair){t,
                                pose->rotation,
                                placement->rotation_a,
                                {zero, zero},
                                zero,
                                radius_a,
                                radius_b,
                                none,
                                none,
                                none,
                                none,
                                vi_set(0),
                                vi_set(0)};
    return (struct circle_verdict){known, vm_and(valid, vm_or(certain, apart)), near};
}

/* Pairs with a circle, in the lanes `which`; `out`: if any is near, and of two circles in any case. */
INLINE struct circle_verdict judge_circles(const struct call *call, const struct box_form *a, const struct box_form *b,
                                           const struct placement *placement, vm which, int32_t number,
                                           enum circle_pairs of, struct circle_pair *out) {
    if (of == TWO_CIRCLES)
        return judge_two_circles(call, a, b, placement, which, number, out);
    const vi last = vi_set((int32_t)NARC_IS_CIRCLE - 1);
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position, q = pose->rotation, t_b = v2_unrotate(q, t);
    const vf zero = v_set(0);
    const vm is_a = vm_and_not(is_form(a, NARC_IS_CIRCLE), is_form(b, NARC_IS_CIRCLE)); /* A is the circle, and B not */
    const vi info = choose_side_bits(of, is_a, b->info, a->info);
    const vm sides = vm_not(vi_lt(last, info));
    const vm capsule = vi_lt(vi_set(0), vi_and(info, vi_set((int32_t)NARC_IS_CAPSULE)));
    const vec2 half = choose_side_vec2(of, is_a, b->half, a->half);
    const vf scale = choose_side(of, is_a, pose->scale_b, pose->scale_a);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf radius = choose_side(of, is_a, radius_b, radius_a),
             radius_circle = choose_side(of, is_a, radius_a, radius_b);
    const vf radii = v_add(radius_a, radius_b);
    const vec2 size = v2_scale(half, scale), p = choose_side_vec2(of, is_a, (vec2){v_neg(t_b.x), v_neg(t_b.y)}, t);
    const vf beyond_x = v_sub(v_abs(p.x), size.x), beyond_y = v_sub(v_abs(p.y), size.y);
    const vf size_other = v_add(v_add(size.x, size.y), radius);
    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(v_abs(t.x), v_abs(t.y)), v_add(size_other, radius_circle)));
    const vf two = v_add(slack, slack), inside = v_neg(two);

    const vm off_x = v_lt(two, beyond_x), off_y = v_lt(two, beyond_y), on_x = v_lt(beyond_x, inside),
             on_y = v_lt(beyond_y, inside);
    const vm at_x = vm_and(vm_and(on_y, v_lt(two, v_sub(beyond_x, beyond_y))), v_lt(two, v_abs(p.x)));
    const vm at_y = vm_and(vm_and(on_x, v_lt(two, v_sub(beyond_y, beyond_x))), v_lt(two, v_abs(p.y)));
    vm at_corner = vm_and(off_x, vm_or(off_y, capsule));
    if (of == ANY_CIRCLES)
        at_corner = vm_or(at_corner, vm_and_not(vm_or(off_x, off_y), sides));
    const vec2 off = {v_max(beyond_x, zero), v_max(beyond_y, zero)};
    const vf square = v2_dot(off, off), limit = v_add(v_add(radii, placement->margin), slack);
    const vm apart = v_lt(v_mul(limit, limit), square);
    const vm at_edge = vm_or(at_x, at_y), certain = vm_or(at_edge, at_corner);
    const vm sizes = vm_and(is_box_in_range(size_other), is_box_in_range(radius_circle));
    const vm valid = vm_and(which, sizes), known = vm_and(valid, certain);
    const vm near = settle_deep(call, number, vm_and_not(known, apart), square, radii, two);
    if (vm_any(near)) {
        const vm left = v_lt(p.x, zero), below = v_lt(p.y, zero);
        /* Edges 0 to 3 lie at +x, +y, -x, -y; corners at +x +y, -x +y, -x -y, +x -y. Of a capsule corner 3 is its end at
         * +x, and corner 1 that at -x. */
        const vi edge = vi_select(at_x, choose_bit(left, 2), vi_select(below, vi_set(3), vi_set(1)));
        const vi end = vi_select(left, vi_set(1), vi_set(3));
        const vi corner = vi_select(below, vi_select(left, vi_set(2), vi_set(3)), choose_bit(left, 1));
        const vi touched = vi_select(at_edge, edge, vi_select(capsule, end, corner));
        *out = (struct circle_pair){
            t,       q,       placement->rotation_a,  half, scale, radius, radius_circle, is_a, sides, capsule,
            at_edge, touched, vi_and(info, vi_set(3))};
    }
    return (struct circle_verdict){known, vm_and(valid, vm_or(certain, apart)), near};
}

INLINE void push_circles(const struct circle_pair *pair, vm near, int32_t number, enum circle_pairs of,
                         struct box_queue *queue) {
    vi code = vi_set(0);
    if (of != TWO_CIRCLES) {
        code = vi_add(pair->number, vi_add(choose_bit(pair->edge, TOUCHED_EDGE), vi_set(BESIDE_SIDES)));
        code = vi_select(pair->sides, code, vi_set(0));
        code = vi_add(code, vi_add(choose_bit(pair->is_a, CIRCLE_IS_A), choose_bit(pair->capsule, BESIDE_CAPSULE)));
        code = vi_add(code, vi_shift_left(pair->first, 4));
    }
    vf item[BOX_FIELDS];
    set_vec2(item, BOX_POSITION, pair->position);
    set_vec2(item, BOX_ROTATION, pair->rotation);
    set_vec2(item, BOX_ROTATION_A, pair->to_world);
    set_vec2(item, BOX_HALF_A, pair->half);
    item[BOX_SCALE_B] = pair->scale;
    item[BOX_RADIUS_A] = pair->radius;
    item[BOX_RADIUS_B] = pair->radius_circle;
    item[BOX_CODE] = v_of_bits(code);
    item[BOX_PAIR] = v_of_bits(vi_add(vi_lanes(), vi_set(number)));
    push_boxes(queue, near, item, CIRCLE_FIELDS);
}

/* Takes pairs with a circle, in the lanes `which`: puts those that may have a contact into the queue. Returns the lanes
 * that it took. */
INLINE vm take_circles(const struct call *call, const struct box_form *a, const struct box_form *b,
                       const struct placement *placement, vm which, int32_t number, struct box_queue *queue) {
    const vi last = vi_set((int32_t)NARC_IS_CIRCLE - 1);
    struct circle_pair pair;
    struct circle_verdict verdict;
    if (!vm_any(vm_and_not(which, vm_and(vi_lt(last, a->info), vi_lt(last, b->info))))) {
        verdict = judge_circles(call, a, b, placement, which, number, TWO_CIRCLES, &pair);
        if (vm_any(verdict.near))
            push_circles(&pair, verdict.near, number, TWO_CIRCLES, queue);
    } else {
        verdict = judge_circles(call, a, b, placement, which, number, ANY_CIRCLES, &pair);
        if (vm_any(verdict.near))
            push_circles(&pair, verdict.near, number, ANY_CIRCLES, queue);
    }
    return verdict.taken;
}

INLINE struct circle_pair load_circle_pairs(const struct box_queue *queue, int k) {
    const struct box_pair pair = {queue, k, false};
    const vi code = get_box_code(&pair);
    return (struct circle_pair){.position = get_box_vec2(&pair, BOX_POSITION),
                                .rotation = get_box_vec2(&pair, BOX_ROTATION),
                                .to_world = get_box_vec2(&pair, BOX_ROTATION_A),
                                .half = get_box_vec2(&pair, BOX_HALF_A),
                                .scale = get_box_field(&pair, BOX_SCALE_B),
                                .radius = get_box_field(&pair, BOX_RADIUS_A),
                                .radius_circle = get_box_field(&pair, BOX_RADIUS_B),
                                .is_a = has_bit(code, CIRCLE_IS_A),
                                .sides = has_bit(code, BESIDE_SIDES),
                                .capsule = has_bit(code, BESIDE_CAPSULE),
                                .edge = has_bit(code, TOUCHED_EDGE),
                                .number = vi_and(code, vi_set(3)),
                                .first = vi_and(vi_shift_right(code, 4), vi_set(3))};
}

INLINE vi find_circle_numbers(const struct box_queue *queue, int k) {
    return vi_bits(v_load(queue->item[BOX_PAIR] + k));
}

/* How the shape beside a circle touches it. */
struct circle_contact {
    vf separation;
    vec2 normal, center; /* of the circle */
    vec2 corner, start;  /* of the other one: the corner that touches, and the normal of the edge before it */
};

/* Corner i of the shapes beside circles, placed, and the normal of edge i. */
INLINE vec2 place_form_corner(const struct circle_pair *pair, enum circle_pairs of, vi i) {
    const vec2 half = pair->half, q = pair->rotation, t = pair->position;
    const vf zero = v_set(0);
    const vec2 corner = {v_mul(half.x, find_sign(vi_add(i, vi_set(1)))),
                         v_select(pair->capsule, zero, v_mul(half.y, find_sign(i)))};
    /* By what leaves it as it is, where it is A's. */
    const struct pose pose = {.position = choose_side_vec2(of, pair->is_a, t, (vec2){zero, zero}),
                              .rotation = choose_side_vec2(of, pair->is_a, q, (vec2){v_set(1), zero}),
                              .scale_b = pair->scale};
    return place_center_b(corner, &pose);
}

INLINE vec2 place_form_normal(const struct circle_pair *pair, enum circle_pairs of, vi i) {
    const vf sign = find_sign(i), zero = v_set(0);
    const vm odd = vi_lt(vi_set(0), vi_and(i, vi_set(1)));
    const vec2 n = {v_select(odd, v_select(pair->capsule, v_mul(pair->half.y, sign), zero), sign),
                    v_select(odd, sign, zero)};
    return choose_side_vec2(of, pair->is_a, v2_rotate_opposite(pair->rotation, n), n);
}

/* The centre of B. Nothing but the signs of zeros: as if it had been turned. */
INLINE vec2 place_origin(const struct circle_pair *pair) {
    const vec2 t = pair->position, origin = {v_set(0), v_set(0)};
    if (BLOCK == 1 && !vm_any(v_le(v_min(v_abs(t.x), v_abs(t.y)), v_set(0))))
        return t;
    return v2_add(t, v2_rotate(pair->rotation, origin));
}

INLINE struct circle_contact find_circle_contact(const struct circle_pair *pair, enum circle_pairs of) {
    const vec2 origin = {v_set(0), v_set(0)}, b = place_origin(pair);
    const vf radii = v_add(pair->radius, pair->radius_circle);
    struct circle_contact c = {.center = b, .corner = origin, .start = origin};
    vec2 u = b;
    if (of != TWO_CIRCLES) {
        c.center = choose_side_vec2(of, pair->is_a, origin, b);
        c.corner = place_form_corner(pair, of, pair->number);
        c.start = place_form_normal(pair, of, pair->number);
        u = v2_sub(choose_side_vec2(of, pair->is_a, c.corner, c.center),
                   choose_side_vec2(of, pair->is_a, c.center, c.corner));
        if (!vm_any(vm_not(pair->edge))) { /* no root, and no quotient */
            c.separation = v_sub(v2_dot(u, c.start), radii);
            c.normal = c.start;
            return c;
        }
    }
    const vf length = v2_length(u);
    c.separation = v_sub(of == TWO_CIRCLES ? length : v_select(pair->edge, v2_dot(u, c.start), length), radii);
    c.normal = v2_divide(u, length);
    if (of != TWO_CIRCLES)
        c.normal = v2_select(pair->edge, c.start, c.normal);
    return c;
}

/* How far normals may turn on the shape beside a circle. */
INLINE vi find_form_reach(const struct circle_pair *pair, enum circle_pairs of, const struct circle_contact *c) {
    const vi next = vi_add(pair->number, vi_select(pair->capsule, vi_set(2), vi_set(1)));
    const struct feature arc = {.start = c->start, .end = place_form_normal(pair, of, next)};
    return find_reach(&arc, c->normal, vi_set(0), pair->edge);
}

/* Writes rows to their places, all of one point. */
INLINE void write_circles(const struct call *call, const struct circle_pair *pair, const struct circle_contact *c,
                          vi pairs, enum circle_pairs of, char *const *to) {
    const vec2 n = c->normal, to_world = pair->to_world;
    const vm is_a = pair->is_a;
    /* Outwards along n: of B, which is touched on its side -n, below 0. */
    const vf radius = choose_side(of, is_a, v_neg(pair->radius), pair->radius),
             radius_circle = choose_side(of, is_a, pair->radius_circle, v_neg(pair->radius_circle));
    const vec2 on_circle = v2_add(c->center, v2_scale(n, radius_circle)), step = v2_scale(n, radius),
               on_other = v2_add(c->corner, step);
    const vf half = v_set(0.5f), along = v2_cross(n, on_circle), touched = v2_cross(n, on_other);
    vf before = touched;
    if (of != TWO_CIRCLES && vm_any(pair->edge)) { /* from the corner before the edge on */
        const vec2 corner = place_form_corner(pair, of, vi_sub(pair->number, vi_set(1)));
        before = v_select(pair->edge, v2_cross(n, v2_add(corner, step)), touched);
    }
    const vf min = of == TWO_CIRCLES ? touched : v_min(touched, before),
             max = of == TWO_CIRCLES ? touched : v_max(touched, before);
    const vf most = v_max(choose_side(of, is_a, along, min), choose_side(of, is_a, min, along)),
             least = v_min(choose_side(of, is_a, along, max), choose_side(of, is_a, max, along));
    const vec2 place = {v_mul(half, v_add(v2_dot(n, on_circle), v2_dot(n, on_other))), v_mul(half, v_add(most, least))};
    const vi all_round = vi_set(-1); /* NARC_REACH_ONE twice */
    struct answer answer = {.separation = c->separation,
                            .normal = v2_rotate(to_world, n),
                            .point = v2_rotate(to_world, v2_rotate(n, place)),
                            .feature = vi_set(0),
                            .radius_a = pair->radius,
                            .radius_b = pair->radius_circle,
                            .reach_a = all_round,
                            .reach_b = all_round};
    if (of != TWO_CIRCLES) {
        const vi number = pair->number, end = vi_and(vi_add(vi_shift_right(number, 1), pair->first), vi_set(1));
        const vi arc = vi_select(pair->capsule, end, vi_and(vi_add(number, pair->first), vi_set(3)));
        vi other = vi_add(arc, choose_bit(pair->edge, NARC_FEATURE_EDGE));
        if (of == ANY_CIRCLES)
            other = vi_select(pair->sides, other, vi_set(0));
        const vf curved = v_select(pair->edge, v_set(INFINITY), pair->radius);
        answer.feature = choose_side_bits(of, is_a, vi_shift_left(other, 8), other);
        answer.radius_a = choose_side(of, is_a, pair->radius_circle, curved);
        answer.radius_b = choose_side(of, is_a, curved, pair->radius_circle);
    }
    if (of != TWO_CIRCLES && call->kind == MANIFOLD_ROWS) {
        vi reach = vi_set(0); /* of an edge */
        if (vm_any(vm_not(pair->edge)))
            reach = find_form_reach(pair, of, c);
        if (of == ANY_CIRCLES)
            reach = vi_select(pair->sides, reach, all_round);
        answer.reach_a = choose_side_bits(of, is_a, all_round, reach);
        answer.reach_b = choose_side_bits(of, is_a, reach, all_round);
    }
    write_rows(call, to, find_numbers(call, pairs), &answer);
}

/* Answers the pairs k ... of a queue. */
INLINE void answer_circle_pairs(const struct call *call, const struct box_queue *queue, int k, int live,
                                const struct circle_pair *pair, enum circle_pairs of) {
    const vi pairs = find_circle_numbers(queue, k);
    const struct circle_contact c = find_circle_contact(pair, of);
    const vm keep = vm_and(vm_front(live), is_below(c.separation, find_margins(call, pairs)));
    char *to[V_WIDTH];
    if (!vm_any(keep))
        return;
    find_box_places(call, queue, k + live - 1, pairs, keep, to);
    write_circles(call, pair, &c, pairs, of, to);
}

INLINE void answer_circles(const struct call *call, const struct box_queue *queue, int k, int live) {
    const struct circle_pair pair = load_circle_pairs(queue, k);
    if (vm_any(pair.sides))
        answer_circle_pairs(call, queue, k, live, &pair, ANY_CIRCLES);
    else
        answer_circle_pairs(call, queue, k, live, &pair, TWO_CIRCLES);
}

#endif
