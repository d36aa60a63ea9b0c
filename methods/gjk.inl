/* SPDX-License-Identifier: MIT
 *
 * gjk.inl - do two bodies collide, and how far are they apart: the algorithm of Gilbert, Johnson and Keerthi (1988) on
 * support functions (Algorithm 4 of "Using Piecewise Circular Curves as a 2D Collision Primitive").
 *
 * A segment pq between two support points of the difference (support.inl) lies in the difference: its distance from the
 * origin is an upper bound of the bodies' distance. The support point w towards the origin, along the segment's normal
 * m, gives the lower bound w.m. If the triangle pqw holds the origin, the bodies collide; else its side nearest to the
 * origin is the next segment. The search ends when the two bounds agree within the tolerance, or when the gap along m
 * is as large as the caller asks for.
 *
 * Where the segment passes through the origin, but for rounding, its normal has no sign: both sides are looked at. If
 * the difference goes on beyond the segment on both, the bodies collide; if it ends there on one, they touch.
 *
 * Every step but these two brings the segment nearer to the origin, or raises the lower bound with a segment that is as
 * near, or is the last: so the search ends. It never takes more than the call's iterations.
 */
#ifndef NARC_METHODS_GJK_INL
#define NARC_METHODS_GJK_INL

#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "methods/epa.inl"
#include "methods/gjk_simplexes.inl"
#include "methods/lanes.inl"
#include "methods/method_kernels.h"
#include "methods/outcomes.inl"
#include "methods/run.inl"
#include "methods/simplex.inl"
#include "methods/support.inl"
#include "simd/simd.h"

/* What a step finds, in each lane. */
struct verdict {
    vm collides, separate; /* the search has ended well, or as well as it can */
    vm stuck;              /* ... and rounding left no way on */
    vm limit;              /* it has ended because there were enough steps */
};

/* The state of the search in each lane. */
struct search {
    vec2 m;                 /* where to look next */
    vec2 middle;            /* the point between the bodies that goes with it */
    struct vertex p, q;     /* the segment; a point at first */
    vf distance;            /* of the segment from the origin */
    struct vertex one_side; /* what lies on the first side of a segment through the origin */
    struct vertex third;    /* when it is known that they collide: makes a triangle of p and q */
    vi as_near;             /* is the segment as near as the one before, but no nearer? */
    vi side;                /* 0; 1 and 2: on which side of such a segment the search looks */
    struct best best;
};

INLINE vm all_positive(vf a, vf b, vf c) { return v_lt(v_set(0), v_min(a, v_min(b, c))); }

/* Where to look: along a cached simplex's directions first, or else along the axis between the inscribed circles, and then where
 * the search says. */
INLINE vec2 choose_direction(const struct search *s, const struct lanes *lanes, vi simplex, vi age) {
    const vi length = simplex_length(simplex);
    const vm fresh = vi_lt(age, vi_set(1));
    vec2 direction = v2_select(fresh, get_vec2(&lanes->pair, AXIS, 0), s->m);
    for (int point = 0; point < 3; point++) {
        const vm at = vm_and_not(vi_lt(age, vi_set(point + 1)), vi_lt(age, vi_set(point)));
        const vm here = vm_and(at, vi_lt(vi_set(point), length));
        if (!vm_any(here))
            continue;
        direction = v2_select(here, get_simplex_direction(simplex, point), direction);
    }
    return direction;
}

INLINE void aim(struct search *s, vm here, const struct nearest *at) {
    s->m = v2_select(here, at->direction, s->m);
    s->middle = v2_select(here, at->middle, s->middle);
}

/* Makes the side of the triangle pqw that is nearest to the origin the next segment, in the lanes `open`. Beside a long
 * edge the direction of a point may be off by much more than its distance: so a side is also taken that is as near, but
 * for `noise`, if this step has raised the lower bound (`raised`) or the one before was nearer. Returns the lanes
 * without such a side. */
INLINE vm take_nearest(struct search *s, const struct vertex *w, vf noise, vm open, vm raised) {
    const struct nearest by_p = find_nearest(&s->p, w), by_q = find_nearest(&s->q, w);
    const vm use_p = v_le(by_p.distance, by_q.distance);
    const vf distance = v_select(use_p, by_p.distance, by_q.distance);
    const vm closer = v_lt(distance, s->distance), kept = vm_or(vm_and(use_p, by_p.is_p), vm_and_not(by_q.is_p, use_p));
    const vm another = vm_and_not(v_le(distance, v_add(s->distance, noise)), kept);
    const vm may = vm_or(raised, vi_lt(s->as_near, vi_set(1)));
    const vm nearer = vm_and(open, vm_or(closer, vm_and(another, may)));
    const vm at_w = vm_or(vm_and(use_p, by_p.is_q), vm_and_not(by_q.is_q, use_p));
    const struct vertex other = select_vertex(use_p, &s->p, &s->q), p = select_vertex(at_w, w, &other);
    s->as_near = vi_select(vm_and_not(nearer, closer), vi_set(1), vi_set(0));
    s->p = select_vertex(nearer, &p, &s->p);
    s->q = select_vertex(nearer, w, &s->q);
    s->distance = v_select(nearer, v_min(distance, s->distance), s->distance);
    aim(s, vm_and(nearer, use_p), &by_p);
    aim(s, vm_and_not(nearer, use_p), &by_q);
    return vm_and_not(open, nearer);
}

/* A first point, or the second one of a cached triangle. */
INLINE void take_point(struct search *s, const struct vertex *w, vm first, vm second) {
    s->p = select_vertex(first, w, &s->p);
    s->q = select_vertex(vm_or(first, second), w, &s->q);
    s->side = vi_select(first, vi_set(0), s->side);
    const struct nearest between = find_nearest(&s->p, w); /* of a first point: that */
    s->distance = v_select(vm_or(first, second), between.distance, s->distance);
    aim(s, vm_or(first, second), &between);
}

/* A segment through the origin, but for rounding: looks on its one side, then on the other. Returns the lanes where the
 * difference ends there: the bodies touch. */
INLINE vm take_side(struct search *s, const struct vertex *w, const struct support *support, vm through) {
    const vi zero = vi_set(0), one = vi_set(1), two = vi_set(2);
    const vec2 d = v2_sub(s->q.point, s->p.point);
    const vf square = v2_dot(d, d);
    const vm looked = vi_lt(zero, s->side), first = vm_and(looked, vi_lt(s->side, two));
    const vm ends = vm_and(looked, v_le(v_set(0), support->gap));
    const vm is_point = vm_and(through, v_le(square, v_mul(support->noise, support->noise)));
    s->one_side = select_vertex(first, w, &s->one_side);
    s->m = v2_select(first, v2_right(d), v2_select(through, v2_left(d), s->m));
    s->side = vi_select(looked, vi_add(s->side, one), vi_select(through, one, zero));
    return vm_or(ends, is_point);
}

INLINE vm is_around(const struct vertex *p, const struct vertex *q, const struct vertex *w) {
    const vf pq = v2_cross(p->point, q->point), qw = v2_cross(q->point, w->point), wp = v2_cross(w->point, p->point);
    return vm_or(all_positive(pq, qw, wp), all_positive(v_neg(pq), v_neg(qw), v_neg(wp)));
}

/* One step in every lane. `enough`: a separation of that much need not be known better. */
INLINE struct verdict step_search(const narc_batch *batch, const struct lanes *lanes, struct search *s, vi simplex,
                                  vf enough) {
    const vf zero = v_set(0);
    const vi age = vi_load(lanes->age), seeds = simplex_length(simplex);
    const vm busy = vi_lt(vi_set(-1), age), fresh = vi_lt(age, vi_set(1));
    const vec2 direction = choose_direction(s, lanes, simplex, age);
    const struct support found = find_support(batch->shapes, &lanes->pair, 0, busy, direction);
    const struct vertex w = {found.w, found.middle,
                             narc_call_of(batch)->simplexes ? find_diamond_angle(found.m) : zero};

    /* What the step was for: a first point, a triangle's second, a side of a segment through the origin, or the rule. */
    const vm seeded = vi_lt(age, seeds), second = vm_and_not(vm_and(seeded, vi_lt(age, vi_set(2))), fresh);
    const vm looked = vm_and_not(vi_lt(vi_set(0), s->side), fresh);
    const vm rule = vm_and_not(busy, vm_or(looked, vm_or(fresh, second)));

    /* Known is the separation where the gap along m is as large as the distance of the point that m was the direction
     * of: not where m was the axis or a cached simplex's. */
    const vf tolerance = v_max(v_mul(v_set(narc_call_of(batch)->tolerance), get(&lanes->pair, SIZE, 0)), found.noise);
    const vm reached = vm_and(v_le(zero, found.gap), v_le(v_sub(s->distance, found.gap), tolerance));
    const vm known = vm_and_not(reached, vm_or(fresh, seeded));
    const vm raised = v_lt(s->best.separation, found.gap);
    keep_best(&s->best, &found, s->middle, vm_or(fresh, known));
    const vm apart = v_le(enough, s->best.separation);

    const vm inside = vm_and(vm_and(rule, is_around(&s->p, &s->q, &w)), v_lt(s->best.separation, zero));
    const vm both_sides = vm_and(looked, vi_lt(vi_set(1), s->side));
    s->third = select_vertex(both_sides, &s->one_side, &w);
    take_point(s, &w, fresh, second);
    const vm stayed = vm_and_not(take_nearest(s, &w, found.noise, vm_and_not(rule, inside), raised), seeded);
    const vm through = vm_and_not(vm_and(busy, v_le(s->distance, found.noise)), vm_or(looked, vm_or(second, inside)));
    const vm touches = take_side(s, &w, &found, through);

    /* Where the best direction is an older one, the last segment tells the point. */
    s->best.along = v_select(known, s->best.along, v2_cross(s->best.n, s->middle));
    const vf left = v_sub(s->distance, v_max(s->best.separation, zero));
    const vm positive = v_le(zero, s->best.separation);
    const vm doubtful = v_lt(s->best.separation, v_mul(v_set(-4), found.noise)); /* that they only touch */
    const vm meets_none = vm_and(positive, v_le(s->distance, found.noise));
    const vm well = vm_or(vm_or(apart, known), vm_or(meets_none, vm_and_not(touches, doubtful)));
    const vm ends = vm_and(busy, vm_or(well, vm_or(touches, stayed)));
    const vm old = vm_and_not(busy, vi_lt(age, vi_set(narc_call_of(batch)->iterations - 1)));
    struct verdict verdict;
    verdict.collides = vm_and_not(vm_or(inside, both_sides), well);
    verdict.separate = vm_and_not(ends, verdict.collides);
    verdict.limit = vm_and_not(old, vm_or(ends, verdict.collides));
    const vm close = vm_and_not(v_le(left, v_select(positive, tolerance, found.noise)), doubtful);
    verdict.stuck = vm_and_not(vm_and_not(verdict.separate, well), close);
    return verdict;
}

INLINE vm is_done(const struct verdict *v) { return vm_or(v->collides, vm_or(v->separate, v->limit)); }

/* A search that rounding has ended may go better without the simplex that it began with. */
INLINE void begin_again(struct lanes *lanes, int32_t *simplex, struct verdict *verdict) {
    const vi old = vi_load(simplex), none = vi_set(0);
    const vm again = vm_and(verdict->stuck, vi_lt(none, simplex_length(old)));
    vi_store(simplex, vi_select(again, none, old));
    vi_store(lanes->age, vi_select(again, none, vi_load(lanes->age)));
    verdict->separate = vm_and_not(verdict->separate, again);
    verdict->stuck = vm_and_not(verdict->stuck, again);
}

/* Passes the pairs that collide on to EPA, each with the triangle that holds the origin. */
INLINE void pass_collisions(const struct lanes *lanes, const struct search *s, vm collides, struct collisions *to) {
    const struct vertex *const corners[] = {&s->p, &s->q, &s->third};
    float corner[3][4][V_WIDTH];
    for (int c = 0; c < 3; c++) {
        v_store(corner[c][0], corners[c]->point.x);
        v_store(corner[c][1], corners[c]->point.y);
        v_store(corner[c][2], corners[c]->middle.x);
        v_store(corner[c][3], corners[c]->middle.y);
    }
    for (uint32_t bits = vm_bits(collides); bits; bits &= bits - 1) {
        const int lane = FIND_LOWEST(bits), k = to->pairs.count++;
        copy_item(&lanes->pair, lane, &to->pairs, k);
        for (int c = 0; c < 3; c++)
            for (int f = 0; f < 4; f++)
                to->corner[k][c][f] = corner[c][f][lane];
    }
}

/* Searches with the pairs `begin` ... of a queue. Without `found`, sets the bits of those that collide. With it, those
 * that are apart go there, and those that collide to `colliding`. */
INLINE void search_all(const struct call *call, const struct queue *queue, int begin, struct collisions *colliding,
                       struct queue *found) {
    const narc_batch *batch = call->batch;
    struct lanes lanes;
    struct search s;
    int32_t simplex[V_WIDTH] = {0};
    memset(&s, 0, sizeof s);
    start_lanes(&lanes, begin);
    while (fill_lanes(&lanes, queue)) {
        struct verdict verdict;
        read_simplexes(call, &lanes, simplex);
        do {
            verdict = step_search(batch, &lanes, &s, vi_load(simplex), get_margins(call, &lanes.pair, 0));
            end_step(&lanes, is_done(&verdict));
            if (vm_any(verdict.stuck))
                begin_again(&lanes, simplex, &verdict);
        } while (!vm_any(is_done(&verdict)));
        note_outcome(call, &lanes.pair, 0, verdict.limit, NARC_OUTCOME_LIMIT);
        note_outcome(call, &lanes.pair, 0, verdict.stuck, NARC_OUTCOME_ROUNDING);
        if (narc_call_of(batch)->simplexes) {
            const struct vertex *const corners[] = {&s.p, &s.q, &s.third};
            leave_simplexes(call, &lanes, corners, s.best.n, verdict.collides, is_done(&verdict));
        }
        if (!found) {
            mark_overlaps(call, &lanes.pair, 0, verdict.collides);
            continue;
        }
        struct best best = s.best;
        best.separation = v_max(best.separation, v_set(0));
        append_found(&lanes, vm_or(verdict.separate, verdict.limit), &best, found);
        pass_collisions(&lanes, &s, verdict.collides, colliding);
    }
}

static void find_overlaps_gjk(const struct call *call, struct queue *queue, int begin) {
    search_all(call, queue, begin, NULL, NULL);
}

static void find_contacts_gjk(const struct call *call, struct queue *queue, int begin) {
    struct collisions colliding;
    struct queue found;
    struct found_arcs arcs;
    start_queue(&found, &arcs);
    colliding.pairs.count = 0;
    search_all(call, queue, begin, &colliding, &found);
    expand_all(call, &colliding, &found);
    pad(&found);
    store_found(call, &found);
}

static void overlap_gjk(const narc_batch *batch, size_t first, size_t count, size_t *skipped, uint64_t *out_bits) {
    run_overlap_method(find_overlaps_gjk, batch, first, count, skipped, out_bits);
}

static size_t contact_gjk(const narc_batch *batch, size_t first, size_t count, size_t *skipped, const narc_rows *out) {
    return run_contact_method(find_contacts_gjk, batch, first, count, skipped, out);
}

#endif
