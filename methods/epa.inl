/* SPDX-License-Identifier: MIT
 *
 * epa.inl - how deep two bodies are in each other: the expanding polytope algorithm (van den Bergen 2001), which
 * section II of "Using Piecewise Circular Curves as a 2D Collision Primitive" puts behind GJK.
 *
 * A polygon inside the difference that holds the origin: how far its nearest edge is from the origin is a lower bound
 * of the depth. The support point along that edge's normal gives an upper bound, the depth along that normal, and
 * splits the edge in two. A curved difference has no last edge: the search ends when the bounds agree within the
 * tolerance, when the nearest edge is one of the difference itself, or after the call's iterations.
 *
 * Edges lie in no order; what each needs is its distance.
 */
#ifndef NARC_METHODS_EPA_INL
#define NARC_METHODS_EPA_INL

#include <float.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/queue.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "methods/lanes.inl"
#include "methods/method_kernels.h"
#include "methods/outcomes.inl"
#include "methods/simplex.inl"
#include "methods/support.inl"
#include "simd/simd.h"

enum { EDGES = 3 + NARC_MAX_ITERATIONS };
_Static_assert(EDGES <= UINT8_MAX, "the numbers of vertices are bytes");

/* Pairs that collide, and for each a triangle of three vertices that holds the origin: x, y and the middle. */
struct collisions {
    struct queue pairs;
    float corner[FLUSH][3][4];
};

/* The polygon of each lane, vertices and edges between two of them, counter-clockwise; as many of the one as of the
 * other. The last vertex is for lanes that write none. */
struct polytope {
    _Alignas(64) float vertex[EDGES + 1][V_WIDTH][4];
    _Alignas(64) float distance[EDGES][V_WIDTH];
    uint8_t from[EDGES][V_WIDTH], to[EDGES][V_WIDTH];
    int32_t count[V_WIDTH];
};

/* The state of the search in each lane. */
struct expansion {
    vi slot;     /* of the nearest edge */
    vf distance; /* of that from the origin: the depth is at least that */
    struct best best;
};

/* The ends of edge number `slot` of each lane. */
INLINE void get_edge(const struct polytope *p, vi slot, struct vertex out_ends[2]) {
    int32_t edge[V_WIDTH], row[2][V_WIDTH];
    vi_store(edge, slot);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        row[0][lane] = p->from[edge[lane]][lane] * V_WIDTH + lane;
        row[1][lane] = p->to[edge[lane]][lane] * V_WIDTH + lane;
    }
    for (int end = 0; end < 2; end++) {
        vf field[4];
        v_rows(p->vertex, sizeof p->vertex[0][0], row[end], field);
        out_ends[end] = (struct vertex){{field[0], field[1]}, {field[2], field[3]}, v_set(0)};
    }
}

/* In the lanes that begin: the triangles of their pairs. */
INLINE void start_polytopes(struct polytope *p, const struct lanes *lanes, const struct collisions *collisions,
                            struct expansion *e) {
    const vm fresh = vm_and_not(vi_lt(vi_load(lanes->age), vi_set(1)), vi_lt(vi_load(lanes->age), vi_set(0)));
    for (int lane = 0; lane < V_WIDTH; lane++) {
        if (!lanes->begins[lane])
            continue;
        const float(*const corner)[4] = collisions->corner[lanes->from[lane]];
        const bool left = (corner[1][0] - corner[0][0]) * (corner[2][1] - corner[0][1]) >=
                          (corner[1][1] - corner[0][1]) * (corner[2][0] - corner[0][0]);
        for (int k = 0; k < 3; k++) {
            memcpy(p->vertex[k][lane], corner[left ? k : 2 - k], sizeof corner[k]);
            p->from[k][lane] = (uint8_t)k;
            p->to[k][lane] = (uint8_t)((k + 1) % 3);
        }
        p->count[lane] = 3;
    }
    e->distance = v_select(fresh, v_set(INFINITY), e->distance);
    for (int k = 0; k < 3; k++) {
        struct vertex ends[2];
        get_edge(p, vi_set(k), ends);
        const vf distance = find_nearest(&ends[0], &ends[1]).distance;
        const vm nearer = vm_and(fresh, v_lt(distance, e->distance));
        v_store(p->distance[k], v_select(fresh, distance, v_load(p->distance[k])));
        e->slot = vi_select(nearer, vi_set(k), e->slot);
        e->distance = v_select(nearer, distance, e->distance);
    }
}

INLINE vm is_number(vi number, int k) { return vm_and_not(vi_lt(number, vi_set(k + 1)), vi_lt(number, vi_set(k))); }

/* Splits edge `slot`, between `ends`, of the lanes `splits` at w; finds the edge that is nearest to the origin in each
 * lane, the first of equals. Both in one pass over the distances, because a vector that is read after single lanes of
 * it were written is slow. */
INLINE vi split_edge(struct polytope *p, vi slot, vm splits, const struct vertex ends[2], const struct vertex *w,
                     vf *out_distance) {
    const vi old_count = vi_load(p->count), spare = vi_set(EDGES);
    const vi changed = vi_select(splits, slot, spare), added = vi_select(splits, old_count, spare);
    const vi count = vi_select(splits, vi_add(old_count, vi_set(1)), old_count);
    const vf before = find_nearest(&ends[0], w).distance, behind = find_nearest(w, &ends[1]).distance;
    const vf fields[4] = {w->point.x, w->point.y, w->middle.x, w->middle.y};
    int32_t edge[V_WIDTH], vertex[V_WIDTH];
    char *place[V_WIDTH];
    vi_store(edge, changed);
    vi_store(vertex, added);
    for (int lane = 0; lane < V_WIDTH; lane++) {
        const int split = edge[lane], fresh = vertex[lane];
        place[lane] = (char *)p->vertex[fresh][lane];
        if (split == EDGES)
            continue;
        p->from[fresh][lane] = (uint8_t)fresh;
        p->to[fresh][lane] = p->to[split][lane];
        p->to[split][lane] = (uint8_t)fresh;
    }
    v_put_rows(place, 0, fields);
    vi_store(p->count, count);
    vf least = v_set(INFINITY);
    vi nearest = vi_set(0);
    for (int i = 0; vm_any(vi_lt(vi_set(i), count)); i++) {
        vf distance = v_select(is_number(changed, i), before, v_load(p->distance[i]));
        distance = v_select(is_number(added, i), behind, distance);
        v_store(p->distance[i], distance);
        const vm nearer = vm_and(vi_lt(vi_set(i), count), v_lt(distance, least));
        least = v_select(nearer, distance, least);
        nearest = vi_select(nearer, vi_set(i), nearest);
    }
    *out_distance = least;
    return nearest;
}

INLINE vm is_near(const struct vertex *a, const struct vertex *b, vf distance) {
    const vec2 d = v2_sub(a->point, b->point);
    return vm_and(v_le(v_abs(d.x), distance), v_le(v_abs(d.y), distance));
}

/* The lanes whose search has ended, those of them where rounding left no way on, and those that have had enough. */
struct ending {
    vm done, stuck, limit;
};

/* One step in every lane: the support point beyond the nearest edge ends the search or splits it. */
INLINE struct ending step_expansion(const narc_batch *batch, const struct lanes *lanes, struct polytope *p,
                                    struct expansion *e, vf enough) {
    const vi age = vi_load(lanes->age);
    const vm busy = vi_lt(vi_set(-1), age), fresh = vi_lt(age, vi_set(1));
    struct vertex ends[2];
    get_edge(p, e->slot, ends);
    /* The outward normal is to the right of the edge; from A to B is the other way. */
    const vec2 p0 = ends[0].point, p1 = ends[1].point, inward = {v_sub(p0.y, p1.y), v_sub(p1.x, p0.x)};
    const struct support found = find_support(batch->shapes, &lanes->pair, 0, busy, inward);
    const struct vertex w = {found.w, found.middle, v_set(0)};
    const struct nearest at = find_nearest(&ends[0], &ends[1]);
    const vf left = v_sub(v_neg(found.gap), e->distance);
    const vf tolerance = v_max(v_mul(v_set(narc_call_of(batch)->tolerance), get(&lanes->pair, SIZE, 0)), found.noise);
    const vm known = v_le(left, tolerance);
    keep_best(&e->best, &found, at.middle, vm_or(fresh, known));
    const vm enough_known = vm_or(known, v_le(enough, e->best.separation));
    const vm final = vm_or(is_near(&w, &ends[0], found.noise), is_near(&w, &ends[1], found.noise));
    const vm old = vm_and_not(busy, vi_lt(age, vi_set(narc_call_of(batch)->iterations - 1)));
    const vm done = vm_and(busy, vm_or(enough_known, final));
    e->slot = split_edge(p, e->slot, vm_and_not(busy, done), ends, &w, &e->distance);
    return (struct ending){done, vm_and_not(done, enough_known), vm_and_not(old, done)};
}

/* The contacts of all pairs that GJK found to collide. */
static void expand_all(const struct call *call, const struct collisions *collisions, struct queue *found) {
    struct lanes lanes;
    struct polytope polytope;
    struct expansion e;
    memset(&e, 0, sizeof e);
    memset(polytope.count, 0, sizeof polytope.count);
    memset(polytope.from, 0, 3 * sizeof polytope.from[0]); /* lanes that never begin look at edges, too */
    memset(polytope.to, 0, 3 * sizeof polytope.to[0]);
    start_lanes(&lanes, 0);
    while (fill_lanes(&lanes, &collisions->pairs)) {
        struct ending ending;
        vm done;
        start_polytopes(&polytope, &lanes, collisions, &e);
        do {
            ending = step_expansion(call->batch, &lanes, &polytope, &e, get_margins(call, &lanes.pair, 0));
            done = vm_or(ending.done, ending.limit);
            end_step(&lanes, done);
        } while (!vm_any(done));
        note_outcome(call, &lanes.pair, 0, ending.limit, NARC_OUTCOME_LIMIT);
        note_outcome(call, &lanes.pair, 0, ending.stuck, NARC_OUTCOME_ROUNDING);
        struct best best = e.best;
        best.separation = v_min(best.separation, v_set(-FLT_MIN)); /* GJK decides whether, EPA how deep */
        append_found(&lanes, done, &best, found);
    }
}

#endif
