/* SPDX-License-Identifier: MIT
 *
 * polygon_edges.inl - pairs of two sharp polygons with 3 to 8 corners: the gap at all junctions of both.
 *
 * At the normal n of an edge of A the gap g (normal_fan.inl) is the least n.b over all corners b of B, less n.a of a
 * corner a at that edge; at the negated normal of an edge of B it is n.b of a corner at the edge less the largest n.a.
 * So all junctions cost 2 * 8 * 8 products, without a search and without a branch.
 *
 * They tell which edge answers, if one is CLEAR_EDGE slacks above all others (polygon_contact.inl).
 */
#ifndef NARC_POLYGON_POLYGON_EDGES_INL
#define NARC_POLYGON_POLYGON_EDGES_INL

#include <math.h>
#include <stdbool.h>

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "sat/arc_lookup.inl"
#include "simd/simd.h"
#include "store.h"

enum { MAX_CORNERS = 8 };

/* By so many slacks the largest gap at a junction exceeds all others, or the pair is left to the deciding formula. */
#define CLEAR_EDGE 6.0f

/* Are both shapes sharp polygons of 3 to 8 corners, in the lanes `which`? */
INLINE vm are_polygons(vm which, vf info_a, vf info_b) {
    if (!vm_any(which))
        return which;
    const vi a = vi_bits(info_a), b = vi_bits(info_b), least = vi_set(2), most = vi_set(MAX_CORNERS + 1);
    const vm both = vm_and(which, has_flag(vi_and(a, b), NARC_SHAPE_POLYGON));
    if (!vm_any(both))
        return both;
    const vm large = vm_and(vi_lt(least, get_arc_count(a)), vi_lt(least, get_arc_count(b)));
    return vm_and(both, vm_and(large, vm_and(vi_lt(get_arc_count(a), most), vi_lt(get_arc_count(b), most))));
}

/* Those of the pairs k ... of a queue. */
INLINE vm select_polygons(const struct queue *queue, int k, vm which) {
    return are_polygons(which, get(queue, INFO_A, k), get(queue, INFO_B, k));
}

/* The largest gap at a junction and the second largest; where the largest is: edge i of A, or MAX_CORNERS + i of B. */
struct best_edge {
    vf gap, second;
    vi edge;
    vec2 normal;
};

/* The edge with the largest gap, and the other shape's corner that is closest to it. */
struct polygon_edge {
    struct best_edge best;
    vi corner;
};

/* A polygon in each lane, in A's frame: its corners, and the normals of the edges before them, B's negated. Lanes that
 * have less corners than others repeat their first one. `full`: all have 8. */
struct polygon {
    bool full, is_b;
    int most; /* corners of any lane */
    vi count;
    vec2 corner[MAX_CORNERS], normal[MAX_CORNERS];
};

INLINE vec2 place_corner(vec2 center, const struct pose *pose, bool is_b) {
    return is_b ? place_center_b(center, pose) : v2_scale(center, pose->scale_a);
}

/* The record of corner j in each lane, for v_rows(). */
INLINE void store_corner_record(const struct polygon *p, struct ring ring, int j, int32_t index[V_WIDTH]) {
    if (!p->full)
        vi_store(index, vi_select(vi_lt(vi_set(j), ring.count), vi_add(ring.base, vi_set(j)), ring.base));
}

/* Two corners at a time: a record has the normals of the edges at both its ends. */
INLINE void load_polygon(const narc_record *records, struct ring ring, const struct pose *pose, struct polygon *p) {
    const bool is_b = p->is_b;
    int32_t index[V_WIDTH];
    p->count = ring.count;
    p->most = MAX_CORNERS;
    while (!p->full && p->most > 3 && !vm_any(vi_lt(vi_set(p->most - 1), ring.count)))
        p->most--;
    vi_store(index, ring.base);
    UNROLL
    for (int j = 0; j < MAX_CORNERS; j += 2) {
        vf first[4], second[4], normals[4];
        if (j >= p->most) {
            p->corner[j] = p->corner[j + 1] = p->corner[0];
            continue;
        }
        const narc_record *const here = p->full ? records + j : records;
        store_corner_record(p, ring, j, index);
        v_rows(here, sizeof *records, index, first);
        v_rows(&here->arc.start_x, sizeof *records, index, normals);
        store_corner_record(p, ring, j + 1, index);
        v_rows(p->full ? here + 1 : here, sizeof *records, index, second);
        p->corner[j] = place_corner((vec2){first[0], first[1]}, pose, is_b);
        p->corner[j + 1] = place_corner((vec2){second[0], second[1]}, pose, is_b);
        p->normal[j] = (vec2){normals[0], normals[1]};
        p->normal[j + 1] = (vec2){normals[2], normals[3]};
        if (is_b) {
            p->normal[j] = v2_rotate_opposite(pose->rotation, p->normal[j]);
            p->normal[j + 1] = v2_rotate_opposite(pose->rotation, p->normal[j + 1]);
        }
    }
}

/* The nearer of two corners of B, seen from A; of A it is the other one. */
INLINE vf find_nearer(vf a, vf b, bool of_a) { return of_a ? v_max(a, b) : v_min(a, b); }

/* Takes the junctions of `own`. */
INLINE void try_edges(const struct polygon *own, const struct polygon *other, struct best_edge *best) {
    const bool of_a = own->is_b; /* whose corners are searched */
    for (int i = 0; i < (own->full ? MAX_CORNERS : own->most); i++) {
        const vec2 n = own->normal[i];
        vf even = v2_dot(n, other->corner[0]), odd = v2_dot(n, other->corner[1]);
        UNROLL
        for (int j = 2; j < MAX_CORNERS; j += 2) {
            if (j == 4 && !other->full && other->most <= 4)
                break;
            even = find_nearer(even, v2_dot(n, other->corner[j]), of_a);
            odd = find_nearer(odd, v2_dot(n, other->corner[j + 1]), of_a);
        }
        const vf here = v2_dot(n, own->corner[i]), there = find_nearer(even, odd, of_a);
        vf gap = of_a ? v_sub(here, there) : v_sub(there, here);
        if (!own->full)
            gap = v_select(vi_lt(vi_set(i), own->count), gap, v_set(-INFINITY));
        const vm better = v_lt(best->gap, gap);
        best->second = v_max(best->second, v_min(best->gap, gap));
        best->edge = vi_select(better, vi_set(own->is_b ? MAX_CORNERS + i : i), best->edge);
        best->normal = v2_select(better, n, best->normal);
        best->gap = v_max(best->gap, gap);
    }
}

/* The corner of the other shape that is closest to the edge of A, in the lanes `of_a`, or of B. */
INLINE vi find_closest_corner(const struct polygon *a, const struct polygon *b, vm of_a, vec2 n) {
    const vec2 m = v2_select(of_a, n, (vec2){v_neg(n.x), v_neg(n.y)});
    vf least = v_set(INFINITY);
    vi closest = vi_set(0);
    UNROLL
    for (int j = 0; j < MAX_CORNERS; j++) {
        const vf along = v2_dot(m, v2_select(of_a, b->corner[j], a->corner[j]));
        closest = vi_select(v_lt(along, least), vi_set(j), closest);
        least = v_min(along, least);
    }
    return closest;
}

INLINE struct polygon_edge find_best_of(const narc_record *records, const struct queue *queue, int k, bool full) {
    const struct pose pose = get_pose(queue, k);
    const vf none = v_set(-INFINITY);
    struct polygon a, b; /* an initialiser would clear all of both */
    struct polygon_edge found = {{none, none, vi_set(0), {v_set(0), v_set(0)}}, vi_set(0)};
    a.full = b.full = full;
    a.is_b = false;
    b.is_b = true;
    load_polygon(records, get_ring_a(queue, k), &pose, &a);
    load_polygon(records, get_ring_b(queue, k), &pose, &b);
    try_edges(&a, &b, &found.best);
    try_edges(&b, &a, &found.best);
    found.corner = find_closest_corner(&a, &b, vi_lt(found.best.edge, vi_set(MAX_CORNERS)), found.best.normal);
    return found;
}

/* ------------------------------------------------------------------------------------------------ one lane
 *
 * With one lane a junction is asked in the frame of the shape whose it is, so that nothing is placed. The edge that faces
 * the other body is looked up by the axis of the inscribed circles; from there on, on both sides, junctions are asked until
 * these circles rule them out, and so all beyond. The other shape's corner is looked up, too, by 16 bits: a gap is too
 * large if that is the wrong one, by less than LOOSE slacks (certificates.inl), and if the largest is, F does not lie within
 * that corner's sector (polygon_contact.inl).
 * Otherwise values differ from the formula's by as little as those of lanes. Corners may have radii, equal ones. */

/* Two polygons, seen from the one whose junctions are asked. */
struct seen_polygons {
    const narc_record *records;
    struct ring own, other;
    vi first, info;   /* of the other one's header */
    struct pose pose; /* of the other one; scale_a: of the own one */
    vec2 axis;        /* from the centre of the own inscribed circle to that of the other one */
    vf radii, core, room;
};

INLINE const narc_stored_arc *get_stored_arc(const narc_record *records, vi record) {
    int32_t index;
    vi_store(&index, record);
    return &records[(uint32_t)index].arc;
}

/* Junctions of the own shape: the larger gap of those that were asked and the other one; of the larger, the number of the
 * arc behind it, and the corner closest to it; and the most that the gap may be at those beside them. */
struct asked_junctions {
    vf gap, second, beside;
    vi edge, corner;
    vec2 normal;
};

/* The gap along n, at a junction of the arc `own`, and the corner of the other shape that is closest. */
INLINE vf ask_gap(const struct seen_polygons *p, const narc_stored_arc *own, vec2 n, vi *out_corner) {
    const vec2 m = v2_unrotate(p->pose.rotation, n);
    const vi record = find_arc(p->records, p->first, p->info, (vec2){v_neg(m.x), v_neg(m.y)});
    const narc_stored_arc *const other = get_stored_arc(p->records, record);
    const vf there = v2_dot(m, (vec2){v_load(&other->center_x), v_load(&other->center_y)}),
             here = v2_dot(n, (vec2){v_load(&own->center_x), v_load(&own->center_y)});
    *out_corner = vi_sub(record, p->other.base);
    return v_sub(v_add(v2_dot(n, p->pose.position), v_mul(p->pose.scale_b, there)),
                 v_add(v_mul(p->pose.scale_a, here), p->radii));
}

/* Asks those at the ends of the arc `facing`: the one that faces the other body, and the other one if it counts. */
INLINE struct asked_junctions ask_facing(const struct seen_polygons *p, vi facing) {
    const vi one = vi_set(1), back = vi_set(-1);
    const narc_stored_arc *const arc = get_stored_arc(p->records, facing);
    const vec2 start = {v_load(&arc->start_x), v_load(&arc->start_y)}, end = {v_load(&arc->end_x), v_load(&arc->end_y)};
    const vf at_start = v2_dot(p->axis, start), at_end = v2_dot(p->axis, end);
    const vm ahead = v_lt(at_start, at_end);
    const vi next = step_record(p->own, facing, one), before = step_record(p->own, facing, back);
    const narc_stored_arc *const above = get_stored_arc(p->records, next), *const below =
                                                                               get_stored_arc(p->records, before);
    const vf at_above = v2_dot(p->axis, (vec2){v_load(&above->end_x), v_load(&above->end_y)}),
             at_below = v2_dot(p->axis, (vec2){v_load(&below->start_x), v_load(&below->start_y)});
    struct asked_junctions asked = {.normal = v2_select(ahead, end, start), .second = v_set(-INFINITY)};
    asked.edge = vi_sub(vi_select(ahead, next, facing), p->own.base);
    asked.beside = v_sub(v_max(at_above, at_below), p->core);
    asked.gap = ask_gap(p, arc, asked.normal, &asked.corner);
    if (vm_any(v_le(v_sub(asked.gap, p->room), v_sub(v_min(at_start, at_end), p->core)))) {
        const vec2 n = v2_select(ahead, start, end);
        vi corner;
        const vf gap = ask_gap(p, arc, n, &corner);
        const vm better = v_lt(asked.gap, gap);
        asked.second = v_min(asked.gap, gap);
        asked.gap = v_max(asked.gap, gap);
        asked.edge = vi_select(better, vi_sub(vi_select(ahead, facing, next), p->own.base), asked.edge);
        asked.corner = vi_select(better, corner, asked.corner);
        asked.normal = v2_select(better, n, asked.normal);
    }
    return asked;
}

/* Asks the junctions of the own shape that count, beside the arc `facing`; the number of its first one is `first`. */
INLINE void ask_junctions(const struct seen_polygons *p, vi facing, int first, struct best_edge *best, vi *corner) {
    int32_t count, start;
    vi_store(&count, p->own.count);
    vi_store(&start, vi_sub(facing, p->own.base));
    const narc_stored_arc *const arc = get_stored_arc(p->records, facing);
    const vf before = v2_dot(p->axis, (vec2){v_load(&arc->start_x), v_load(&arc->start_y)}),
             behind = v2_dot(p->axis, (vec2){v_load(&arc->end_x), v_load(&arc->end_y)});
    const int end = start + 1 < count ? start + 1 : 0;
    bool up = vm_any(v_lt(before, behind)), turned = false;
    int at = up ? end : start;
    for (int asked = 0; asked < count;) {
        const narc_stored_arc *const own = get_stored_arc(p->records, vi_add(p->own.base, vi_set(at)));
        const vec2 n = {v_load(&own->start_x), v_load(&own->start_y)};
        if (!vm_any(v_le(v_sub(best->gap, p->room), v_sub(v2_dot(p->axis, n), p->core)))) {
            if (asked == 0 || turned)
                return;
            turned = true;
            up = !up;
            at = up ? end : start;
            continue;
        }
        vi closest;
        const vf gap = ask_gap(p, own, n, &closest);
        if (vm_any(v_lt(best->gap, gap))) {
            *best = (struct best_edge){gap, best->gap, vi_set(first + at), n};
            *corner = closest;
        } else {
            best->second = v_max(best->second, gap);
        }
        at = up ? (at + 1 < count ? at + 1 : 0) : (at > 0 ? at : count) - 1;
        asked++;
    }
}

/* The polygons of the pair k of a queue, seen from A and from B. */
INLINE void see_polygons(const narc_record *records, const struct queue *queue, int k, struct seen_polygons out[2]) {
    const struct pose pose = get_pose(queue, k);
    const vec2 axis = get_vec2(queue, AXIS, k), q = pose.rotation;
    const struct ring ring_a = get_ring_a(queue, k), ring_b = get_ring_b(queue, k);
    const vf radius_a = v_mul(v_load(&get_stored_arc(records, ring_a.base)->radius), pose.scale_a),
             radius_b = v_mul(v_load(&get_stored_arc(records, ring_b.base)->radius), pose.scale_b);
    out[0] = (struct seen_polygons){.records = records,
                                    .own = ring_a,
                                    .other = ring_b,
                                    .first = get_bits(queue, FIRST_RECORD_B, k),
                                    .info = get_bits(queue, INFO_B, k),
                                    .pose = pose,
                                    .axis = axis,
                                    .radii = v_add(radius_a, radius_b),
                                    .core = get(queue, CORE, k),
                                    .room = v_mul(v_set(CLEAR_EDGE + 2), get(queue, SLACK, k))};
    out[1] = out[0];
    out[1].own = ring_b;
    out[1].other = ring_a;
    out[1].first = get_bits(queue, FIRST_RECORD_A, k);
    out[1].info = get_bits(queue, INFO_A, k);
    out[1].pose = (struct pose){v2_unrotate_opposite(q, pose.position), {q.x, v_neg(q.y)}, pose.scale_b, pose.scale_a};
    out[1].axis = v2_unrotate_opposite(q, axis);
}

/* All that count, of both. What sees them is not the caller's, which keeps its own in registers. */
SHARED struct polygon_edge ask_both(const narc_record *records, const struct queue *queue, int k, vi facing_a,
                                    vi facing_b) {
    const vf none = v_set(-INFINITY);
    const vi facing[2] = {facing_a, facing_b};
    struct polygon_edge found = {{none, none, vi_set(0), {v_set(0), v_set(0)}}, vi_set(0)};
    struct seen_polygons from[2];
    see_polygons(records, queue, k, from);
    for (int side = 0; side < 2; side++)
        ask_junctions(&from[side], facing[side], side * MAX_CORNERS, &found.best, &found.corner);
    if (vm_any(vi_lt(vi_set(MAX_CORNERS - 1), found.best.edge)))
        found.best.normal = v2_rotate_opposite(from[0].pose.rotation, found.best.normal);
    return found;
}

INLINE struct polygon_edge find_seen_edge(const narc_record *records, const struct queue *queue, int k) {
    struct seen_polygons from[2];
    see_polygons(records, queue, k, from);
    const vi facing_a = find_arc(records, from[1].first, from[1].info, from[0].axis),
             facing_b = find_arc(records, from[0].first, from[0].info, from[1].axis);
    const struct asked_junctions a = ask_facing(&from[0], facing_a), b = ask_facing(&from[1], facing_b);
    const vm of_b = v_lt(a.gap, b.gap);
    const vi edge_b = vi_add(b.edge, vi_set(MAX_CORNERS));
    const vec2 normal_b = v2_rotate_opposite(from[0].pose.rotation, b.normal);
    const struct best_edge best = {v_max(a.gap, b.gap), v_max(v_min(a.gap, b.gap), v_max(a.second, b.second)),
                                   vi_select(of_b, edge_b, a.edge), v2_select(of_b, normal_b, a.normal)};
    if (vm_any(v_le(v_sub(best.gap, from[0].room), v_max(a.beside, b.beside)))) /* others count, too */
        return ask_both(records, queue, k, facing_a, facing_b);
    return (struct polygon_edge){best, vi_select(of_b, b.corner, a.corner)};
}

/* Those of the pairs k ... of a queue. */
INLINE struct polygon_edge find_polygon_edge(const narc_record *records, const struct queue *queue, int k) {
    if (V_WIDTH == 1)
        return find_seen_edge(records, queue, k);
    const vi most = vi_set(MAX_CORNERS);
    const vi a = get_arc_count(get_bits(queue, INFO_A, k)), b = get_arc_count(get_bits(queue, INFO_B, k));
    const bool full = !vm_any(vm_or(vi_lt(a, most), vi_lt(b, most)));
    return full ? find_best_of(records, queue, k, true) : find_best_of(records, queue, k, false);
}

#endif
