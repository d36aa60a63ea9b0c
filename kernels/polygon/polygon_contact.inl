/* SPDX-License-Identifier: MIT
 *
 * polygon_contact.inl - how two polygons touch, sharp, or in one lane each with corners of one radius: the deciding
 * formula (normal_fan.inl), of which only that part is computed that can hold its answer.
 *
 * Let F be the junction with the largest gap, the normal of an edge of one shape, and c the corner of the other that is
 * closest to it (polygon_edges.inl). F is to lie within c's sector for certain, so that in the intervals of the fan
 * before and behind F the corners of the edge at F face c. The candidates are a kink at F, and a corner against a corner
 * in either interval; their signs and values are computed as the formula computes them. All others are less if the gap
 * at F exceeds those at all other junctions by CLEAR_EDGE slacks: docs/algorithm.md, section 9. Pairs with signs that
 * contradict each other or are not certain, with a corner that may as well be in the next interval, with short edges and
 * with very sharp corners are left to the formula.
 */
#ifndef NARC_POLYGON_POLYGON_CONTACT_INL
#define NARC_POLYGON_POLYGON_CONTACT_INL

#include <stdbool.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "polygon/polygon_edges.inl"
#include "simd/simd.h"

/* Of a pair, in place of SIZE: the edge with the largest gap in bits 0-3, as best_edge has it, and the closest corner
 * of the other shape from bit 4 on. */
enum { EDGE_CODE = SIZE };

/* Junctions further apart than this (radians) have the order in the fan that they have: 64 roundings, of which a turned
 * normal and a diamond angle take 10 each. */
#define IN_ORDER 0x1p-18f

/* An edge is longer than so many slacks, and the cosine of the angle that a corner turns by is more than this: so the
 * edge closer to n is at most 77 degrees off, and its ends, seen from there, have an order for certain. */
#define LEAST_SIDE   8.0f
#define LEAST_COSINE (-0.9f)

/* What a polygon touches the other one with: a corner, and the edge next to it that is closer to n. */
struct polygon_touch {
    vi record, next; /* of the corner, and of the edge's other one */
    struct arcs corner;
    vec2 other;  /* the edge's other corner */
    vec2 normal; /* of the edge */
    vm at_end;   /* does the edge lie behind the corner, counter-clockwise? */
    vf sine;     /* of the angle from the edge's normal to n */
};

/* Of two edges that are equally close it is the one at the corner's end, as in find_edge(). */
INLINE struct polygon_touch find_polygon_touch(const narc_record *records, struct ring ring, vi record,
                                               const struct arcs *corner, vec2 n, const struct pose *pose, bool is_b) {
    const vf start = v2_cross(corner->start, n), end = v2_cross(corner->end, n);
    struct polygon_touch t = {.record = record, .corner = *corner};
    t.at_end = vm_not(v_lt(v_abs(start), v_abs(end)));
    t.normal = v2_select(t.at_end, corner->end, corner->start);
    t.sine = v_select(t.at_end, end, start);
    t.next = step_record(ring, record, vi_select(t.at_end, vi_set(1), vi_set(-1)));
    vf field[4];
    load_circle(records, t.next, field);
    t.other = place_corner((vec2){field[0], field[1]}, pose, is_b);
    return t;
}

/* Is the edge long enough, and the corner blunt enough? */
INLINE vm is_usual(const struct polygon_touch *t, vi info, vf scale, vf slack) {
    const vf length = v_abs(v2_cross(t->normal, v2_sub(t->other, t->corner.center)));
    const vf least = v_add(v_mul(v_set(LEAST_SIDE), slack), v_mul(scale, find_least_edge(info)));
    return vm_and(v_lt(least, length), v_lt(v_set(LEAST_COSINE), v2_dot(t->corner.start, t->corner.end)));
}

struct polygon_contact {
    vf separation;
    vec2 normal;
    struct polygon_touch a, b;
    vm certain;
};

/* How the polygons of the pairs k ... of a queue touch. */
INLINE struct polygon_contact find_polygon_contact(const narc_record *records, const struct queue *queue, int k) {
    const struct pose pose = get_pose(queue, k);
    const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
    const vi code = get_bits(queue, EDGE_CODE, k), back = vi_set(-1);
    const vi edge = vi_and(code, vi_set(MAX_CORNERS - 1)), closest = vi_shift_right(code, 4);
    const vm of_a = vi_lt(vi_and(code, vi_set(MAX_CORNERS)), vi_set(1));
    vi record_a = vi_add(ring_a.base, vi_select(of_a, edge, closest)),
       record_b = vi_add(ring_b.base, vi_select(of_a, closest, edge));
    const vf slack = get(queue, SLACK, k), none = v_set(0);
    struct arc_pair corners = load_arc_pair(records, record_a, record_b, &pose);
    const vec2 f = v2_select(of_a, corners.a.start, corners.b.start),
               start = v2_select(of_a, corners.b.start, corners.a.start),
               end = v2_select(of_a, corners.b.end, corners.a.end);
    /* The corner before the edge. */
    const vi previous = vi_select(of_a, step_record(ring_a, record_a, back), step_record(ring_b, record_b, back));
    vf field[4];
    load_circle(records, previous, field);
    const vec2 own = {field[0], field[1]},
               other = v2_select(of_a, place_corner(own, &pose, false), place_corner(own, &pose, true));
    /* Slopes of g before F and behind it, towards F where above 0. */
    vec2 u = find_center_difference(&corners);
    const vec2 last = v2_sub(v2_select(of_a, corners.b.center, other), v2_select(of_a, other, corners.a.center));
    const vf before = v2_cross(f, last), behind = v2_cross(u, f);
    const vm rises = v_lt(none, before), falls = v_lt(none, behind), at_corners = vm_not(vm_and(rises, falls));
    const vf radii = v_add(corners.a.radius, corners.b.radius);
    struct polygon_contact c = {.separation = v_sub(v2_dot(u, f), radii), .normal = f};
    c.certain = v_lt(v_set(IN_ORDER), v_min(v2_cross(start, f), v2_cross(f, end)));
    c.certain = vm_and(c.certain, v_lt(slack, v_min(v_abs(before), v_abs(behind))));
    c.certain = vm_and(c.certain, vm_or(rises, falls));
    if (vm_any(at_corners)) { /* a corner against a corner: which g rises to */
        const vm moves = vm_and_not(at_corners, rises);
        record_a = vi_select(vm_and(moves, of_a), previous, record_a);
        record_b = vi_select(vm_and_not(moves, of_a), previous, record_b);
        corners = load_arc_pair(records, record_a, record_b, &pose);
        u = find_center_difference(&corners);
        const vf length = v2_length(u);
        const vf starts = v_min(v2_cross(corners.a.start, u), v2_cross(corners.b.start, u));
        const vf ends = v_min(v2_cross(u, corners.a.end), v2_cross(u, corners.b.end));
        const vm inside = vm_and(v_lt(slack, v_min(starts, ends)), v_lt(v_add(slack, slack), length));
        c.certain = vm_and_not(c.certain, vm_and_not(at_corners, inside));
        c.separation = v_select(at_corners, v_sub(length, v_add(corners.a.radius, corners.b.radius)), c.separation);
        c.normal = v2_select(at_corners, v2_divide(u, length), f);
    }
    c.a = find_polygon_touch(records, ring_a, record_a, &corners.a, c.normal, &pose, false);
    c.b = find_polygon_touch(records, ring_b, record_b, &corners.b, c.normal, &pose, true);
    c.certain = vm_and(c.certain, is_usual(&c.a, get_bits(queue, INFO_A, k), pose.scale_a, slack));
    c.certain = vm_and(c.certain, is_usual(&c.b, get_bits(queue, INFO_B, k), pose.scale_b, slack));
    return c;
}

#endif
