/* SPDX-License-Identifier: MIT
 *
 * box_contact.inl - how two boxes touch: the deciding formula (normal_fan.inl), of which only that part is computed
 * that can hold its answer.
 *
 * Let F and G be the normals of the edge of A and of the edge of B that face each other (box_pairs.inl), in the order
 * in which the formula meets them. In the interval before F the corners before both edges answer, between F and G the
 * one behind F and the one before the other edge, and beyond G the corners behind both edges. The candidates are a kink
 * at F, a kink at G, and a corner against a corner in each of the intervals; their signs and values are computed as
 * the formula computes them. What it looks at elsewhere is less, or rises or falls throughout: docs/algorithm.md,
 * section 9. Where signs contradict each other, and where a corner may just as well be in the next interval, the fan is
 * walked (box_walk.c).
 */
#ifndef NARC_BOX_BOX_CONTACT_INL
#define NARC_BOX_BOX_CONTACT_INL

#include <stdbool.h>

#include "base/shape.inl"
#include "base/vec2.inl"
#include "box/box_pairs.inl"
#include "kernels.h"
#include "simd/simd.h"

/* A pair in each lane, as it lies in the queue: registers are too few to hold it. */
struct box_pair {
    const struct box_queue *queue;
    int k;
    bool capsules; /* capsules.inl, not boxes */
};

INLINE vf get_box_field(const struct box_pair *pair, int field) { return v_load(pair->queue->item[field] + pair->k); }

INLINE vec2 get_box_vec2(const struct box_pair *pair, int field) {
    return (vec2){get_box_field(pair, field), get_box_field(pair, field + 1)};
}

INLINE vi get_box_code(const struct box_pair *pair) { return vi_bits(get_box_field(pair, BOX_CODE)); }

/* B's in A's frame, where A is scaled. */
INLINE struct pose get_box_pose(const struct box_pair *pair) {
    return (struct pose){get_box_vec2(pair, BOX_POSITION), get_box_vec2(pair, BOX_ROTATION), v_set(1),
                         get_box_field(pair, BOX_SCALE_B)};
}

/* 1, or -1 where bit 1 of a number is set. */
INLINE vf find_sign(vi number) {
    return v_of_bits(vi_add(vi_set(0x3f800000), vi_and(vi_shift_left(number, 30), vi_set(INT32_MIN))));
}

/* Corner i of A or B, in its own frame, and the normal of its edge i; `half`: the field with its half sizes. i counts
 * on beyond 3. Of a capsule's edges there are 1 and 3 (store.h). */
INLINE vec2 find_box_corner(const struct box_pair *pair, int half, vi i) {
    const vec2 size = get_box_vec2(pair, half);
    const vf y = pair->capsules ? v_set(0) : v_mul(size.y, find_sign(i));
    return (vec2){v_mul(size.x, find_sign(vi_add(i, vi_set(1)))), y};
}

INLINE vec2 find_box_normal(const struct box_pair *pair, int half, vi i) {
    const vf sign = find_sign(i), zero = v_set(0);
    const vm odd = vi_lt(vi_set(0), vi_and(i, vi_set(1)));
    if (pair->capsules)
        return (vec2){v_mul(get_box_field(pair, half + 1), sign), sign};
    return (vec2){v_select(odd, zero, sign), v_select(odd, sign, zero)};
}

/* An edge of a box with the centres of both its corners; along the tangent, n turned a quarter turn counter-clockwise,
 * `low` comes first. One of the corners touches: the one behind the edge, counter-clockwise, or the one before it. */
struct box_side {
    vi edge;
    vec2 normal, low, high;
    vm behind;
};

INLINE struct box_side find_side_a(const struct box_pair *pair, vi edge) {
    return (struct box_side){.edge = edge,
                             .normal = find_box_normal(pair, BOX_HALF_A, edge),
                             .low = find_box_corner(pair, BOX_HALF_A, vi_sub(edge, vi_set(1))),
                             .high = find_box_corner(pair, BOX_HALF_A, edge)};
}

INLINE struct box_side find_side_b(const struct box_pair *pair, vi edge) {
    const struct pose pose = get_box_pose(pair);
    const vec2 before = find_box_corner(pair, BOX_HALF_B, vi_sub(edge, vi_set(1))),
               behind = find_box_corner(pair, BOX_HALF_B, edge);
    return (struct box_side){
        .edge = edge,
        .normal = v2_rotate_opposite(get_box_vec2(pair, BOX_ROTATION), find_box_normal(pair, BOX_HALF_B, edge)),
        .low = place_center_b(behind, &pose),
        .high = place_center_b(before, &pose)};
}

/* The corner that touches. */
INLINE vi find_box_touching(const struct box_side *side) {
    return vi_sub(side->edge, vi_select(side->behind, vi_set(0), vi_set(1)));
}

struct box_contact {
    vf separation;
    vec2 normal;
    struct box_side a, b;
    vm left; /* of one pair by itself: that there is no answer here */
};

/* The sums of the radii of two arcs: behind both edges, or before both; and of A's behind its edge with B's there. */
struct facing_radii {
    vf behind_a, behind_b, beyond;
};

/* What the edges of two sides tell. Sets where signs contradict each other, and where a corner touches a corner: then other
 * edges may be closer to the normal. `of_run`: one is no box's, and A's axes are not those of its normals. Like all that a
 * pair by itself goes through, it copies no large structure: compilers do that through memory. */
INLINE void find_facing_of(struct box_contact *c, vf angle_a, const struct facing_radii *radii, vf slack, bool of_run,
                           vm *out_left, vm *out_corners) {
    const vf zero = v_set(0);
    /* The order in the walk, which begins at +x: an edge there comes after one just before it. */
    const vf angle_b = find_diamond_angle(c->b.normal);
    const vm b_wraps =
        of_run ? v_lt(v_set(2), v_sub(angle_b, angle_a)) : vm_and(v_le(angle_a, zero), v_lt(v_set(2), angle_b));
    const vm a_wraps = of_run ? v_lt(v_set(2), v_sub(angle_a, angle_b)) : vm_front(0);
    const vm wraps = vm_or(a_wraps, b_wraps), a_first = vm_or(a_wraps, vm_and_not(v_lt(angle_a, angle_b), b_wraps));
    const vec2 f = v2_select(a_first, c->a.normal, c->b.normal), g = v2_select(a_first, c->b.normal, c->a.normal);
    const vec2 u_before = v2_sub(c->b.high, c->a.low), u_beyond = v2_sub(c->b.low, c->a.high);
    const vec2 u = v2_sub(v2_select(a_first, c->b.high, c->b.low), v2_select(a_first, c->a.high, c->a.low));
    const vf radii_f = of_run ? v_select(a_first, radii->behind_a, radii->behind_b) : radii->beyond;

    const vf after_f = v2_cross(f, u), before_g = v2_cross(u, g), along_f = v2_dot(u, f), along_g = v2_dot(u_beyond, g);
    const vm rises = v_lt(v2_cross(u_before, f), zero), falls = v_lt(v2_cross(g, u_beyond), zero);
    const vm between = vm_and(v_le(zero, after_f), v_le(zero, before_g));
    const vm at_f = vm_or(between, vm_and(rises, v_lt(after_f, zero))); /* or in the interval from there on */
    const vm at_g = vm_and(v_lt(before_g, zero), falls);
    const vm inside = vm_and(between, v_lt(zero, v_add(along_f, v2_dot(u, g))));
    const vm beyond = vm_and_not(vm_not(falls), at_f), before = vm_and_not(vm_not(rises), vm_or(at_f, at_g));
    const vf value_f = v_sub(along_f, radii_f), value_g = v_sub(along_g, radii->beyond);
    const vm better = vm_or(v_lt(value_f, value_g), vm_and(wraps, v_le(value_f, value_g)));
    const vm takes_g = vm_and(at_g, vm_or(vm_not(at_f), better));
    c->separation = v_select(takes_g, value_g, value_f);
    c->normal = v2_select(takes_g, g, f);

    vm left = vm_or(vm_and(beyond, before), vm_not(vm_or(vm_or(at_f, at_g), vm_or(beyond, before))));
    const vm corners = vm_or(inside, vm_or(beyond, before));
    if (!of_run && vm_any(corners)) {
        const vec2 w = v2_select(beyond, u_beyond, v2_select(before, u_before, u));
        const vf length = v2_length(w);
        const vf room = v_select(beyond, v2_dot(w, f), v_select(before, v2_dot(w, g), length));
        left = vm_or(left, vm_and_not(corners, v_lt(v_add(slack, slack), room)));
        c->separation = v_select(corners, v_sub(length, radii->beyond), c->separation);
        c->normal = v2_select(corners, v2_divide(w, length), c->normal);
    }
    const vm behind_both = vm_or(takes_g, beyond);
    c->a.behind = vm_or(behind_both, vm_and_not(a_first, before));
    c->b.behind = vm_or(behind_both, vm_and_not(vm_not(a_first), before));
    *out_left = left;
    *out_corners = corners;
}

/* The same of a pair. Sets where the answer is not certain. */
INLINE struct box_contact find_facing(const struct box_pair *pair, vm *out_left, vm *out_corners) {
    const vi code = get_box_code(pair), edge_a = vi_and(code, vi_set(3));
    struct box_contact c = {.a = find_side_a(pair, edge_a),
                            .b = find_side_b(pair, vi_and(vi_shift_right(code, 2), vi_set(3)))};
    const vf radii = v_add(get_box_field(pair, BOX_RADIUS_A), get_box_field(pair, BOX_RADIUS_B));
    const struct facing_radii sums = {radii, radii, radii};
    find_facing_of(&c, v_of_int(edge_a), &sums, get_box_field(pair, BOX_SLACK), false, out_left, out_corners);
    *out_left = vm_or(*out_left, vi_lt(vi_set(0), vi_and(code, vi_set(BOX_TIE))));
    return c;
}

INLINE struct box_side find_side(const struct box_pair *pair, vi edge, bool is_b) {
    return is_b ? find_side_b(pair, edge) : find_side_a(pair, edge);
}

INLINE vec2 find_side_normal(const struct box_pair *pair, vi edge, bool is_b) {
    const vec2 normal = find_box_normal(pair, is_b ? BOX_HALF_B : BOX_HALF_A, edge);
    return is_b ? v2_rotate_opposite(get_box_vec2(pair, BOX_ROTATION), normal) : normal;
}

/* Of a capsule, the edge before the end that a corner is: there its arc starts. */
INLINE vi find_own_edge(vi corner) { return vi_add(vi_and(vi_add(corner, vi_set(3)), vi_set(2)), vi_set(1)); }

/* The edge next to a corner that is closer to n; of equals the one behind the corner. A capsule has two, opposite to
 * each other, at either of its ends. */
INLINE struct box_side find_closest_side(const struct box_pair *pair, vi corner, vec2 n, bool is_b) {
    const vi next = vi_add(corner, vi_set(1));
    vm behind;
    vi edge;
    if (pair->capsules) {
        const vi own = find_own_edge(corner);
        behind = v_lt(v_set(0), v2_dot(find_side_normal(pair, own, is_b), n));
        edge = vi_select(behind, own, vi_sub(vi_set(4), own));
    } else {
        const vf start = v2_cross(find_side_normal(pair, corner, is_b), n),
                 end = v2_cross(find_side_normal(pair, next, is_b), n);
        behind = v_lt(v_abs(start), v_abs(end));
        edge = vi_select(behind, corner, next);
    }
    struct box_side side = find_side(pair, edge, is_b);
    side.behind = behind;
    return side;
}

INLINE struct box_side select_box_side(vm m, const struct box_side *a, const struct box_side *b) {
    return (struct box_side){vi_select(m, a->edge, b->edge), v2_select(m, a->normal, b->normal),
                             v2_select(m, a->low, b->low), v2_select(m, a->high, b->high),
                             vm_or(vm_and(m, a->behind), vm_and_not(b->behind, m))};
}

/* Takes the edges that are closest to n, in the lanes `which`, with the corners that touch. */
INLINE void find_closest_sides(const struct box_pair *pair, vm which, vi corner_a, vi corner_b,
                               struct box_contact *contact) {
    const struct box_side a = find_closest_side(pair, corner_a, contact->normal, false);
    const struct box_side b = find_closest_side(pair, corner_b, contact->normal, true);
    contact->a = select_box_side(which, &a, &contact->a);
    contact->b = select_box_side(which, &b, &contact->b);
}

/* The deciding formula, for pairs that more than two edges may answer (box_walk.c): the largest gap, with a normal of unit
 * length, and the numbers of the corners in place of records. */
void NARC_NAMED(walk_boxes)(const struct box_pair *given, struct gap *out_best);
void NARC_NAMED(walk_capsules)(const struct box_pair *given, struct gap *out_best);

/* How the boxes of a pair touch, in the lanes `open`. */
INLINE struct box_contact find_box_contact(const struct box_pair *pair, vm open) {
    vm left, corners;
    struct box_contact c = find_facing(pair, &left, &corners);
    c.left = left = vm_and(open, left);
    if (vm_any(vm_or(left, vm_and(open, corners)))) {
        vi corner_a = find_box_touching(&c.a), corner_b = find_box_touching(&c.b);
        if (BLOCK > 1 && vm_any(left)) {
            struct gap gap;
            NARC_NAMED(walk_boxes)(pair, &gap);
            c.separation = v_select(left, gap.separation, c.separation);
            c.normal = v2_select(left, gap.normal, c.normal);
            corner_a = vi_select(left, gap.record_a, corner_a);
            corner_b = vi_select(left, gap.record_b, corner_b);
        }
        find_closest_sides(pair, vm_or(left, corners), corner_a, corner_b, &c);
    }
    return c;
}

#endif
