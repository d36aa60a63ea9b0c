/* SPDX-License-Identifier: MIT
 *
 * simplex.inl - points and segments of the difference of two bodies (support.inl), and the largest gap that GJK and EPA
 * have found with them.
 */
#ifndef NARC_METHODS_SIMPLEX_INL
#define NARC_METHODS_SIMPLEX_INL

#include "base/vec2.inl"
#include "methods/support.inl"
#include "simd/simd.h"

/* A support point of the difference, the middle between the bodies' own, and the angle of the direction it was found
 * along. */
struct vertex {
    vec2 point, middle;
    vf angle;
};

INLINE struct vertex select_vertex(vm m, const struct vertex *a, const struct vertex *b) {
    return (struct vertex){v2_select(m, a->point, b->point), v2_select(m, a->middle, b->middle),
                           v_select(m, a->angle, b->angle)};
}

/* The point of a segment between two vertices that is nearest to the origin, and what lies between the bodies there. */
struct nearest {
    vf distance;
    vec2 direction; /* from the origin to it: the segment's normal, which is more precise than the point, or an end */
    vec2 middle;
    vm is_p, is_q; /* is it one of the ends? */
};

INLINE struct nearest find_nearest(const struct vertex *p, const struct vertex *q) {
    const vf zero = v_set(0);
    const vec2 d = v2_sub(q->point, p->point);
    const vf from_p = v_neg(v2_dot(p->point, d)), from_q = v2_dot(q->point, d), turn = v2_cross(p->point, d);
    const vm is_p = v_le(from_p, zero), is_q = vm_and_not(v_le(from_q, zero), is_p), at_end = vm_or(is_p, is_q);
    const vec2 end = v2_select(is_p, p->point, q->point);
    const vec2 normal = v2_select(v_lt(turn, zero), v2_left(d), v2_right(d));
    const vf part = v_select(is_p, zero, v_select(is_q, v_set(1), v_div(from_p, v_add(from_p, from_q))));
    return (struct nearest){.distance = v_select(at_end, v2_length(end), v_div(v_abs(turn), v2_length(d))),
                            .direction = v2_select(at_end, end, normal),
                            .middle = v2_add(p->middle, v2_scale(v2_sub(q->middle, p->middle), part)),
                            .is_p = is_p,
                            .is_q = is_q};
}

/* What a search has found of a pair: a gap, its direction and arcs, and the point between the bodies, halfway between
 * the support lines (`across`, its position along n) and where a segment says (`along` them). */
struct best {
    vf separation;
    vec2 n;
    vf across, along;
    vi record_a, record_b;
};

/* Keeps the largest gap, or in the lanes `always` the last; `point` is the point of its segment. */
INLINE void keep_best(struct best *best, const struct support *s, vec2 point, vm always) {
    const vm better = vm_or(always, v_lt(best->separation, s->gap));
    best->separation = v_select(better, s->gap, best->separation);
    best->n = v2_select(better, s->m, best->n);
    best->across = v_select(better, v2_dot(s->m, s->middle), best->across);
    best->along = v_select(better, v2_cross(s->m, point), best->along);
    best->record_a = vi_select(better, s->record_a, best->record_a);
    best->record_b = vi_select(better, s->record_b, best->record_b);
}

#endif
