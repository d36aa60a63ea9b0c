/* SPDX-License-Identifier: MIT
 *
 * ray_lanes.inl - rays of one origin at one body, each in a lane: where they enter it.
 *
 * The formulas of ray_entry.inl in the same order, so that a ray's answer has the same bits. Most rays enter by an arc or
 * an edge, in front of them. All others are told to be asked alone: those that start in the body, and those that pass
 * some place by next to nothing.
 */
#ifndef NARC_SCENE_RAY_LANES_INL
#define NARC_SCENE_RAY_LANES_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "base/vec2.inl"
#include "scene/body_frame.inl"
#include "scene/ray_features.inl"
#include "scene/ray_reading.inl"
#include "simd/doubles.h"

enum { LANE_HALVES = V_WIDTH / D_WIDTH };

typedef struct {
    vd x, y;
} vec2d;

INLINE vd d_dot(vec2d a, vec2d b) { return a.x * b.x + a.y * b.y; }
INLINE vd d_cross(vec2d a, vec2d b) { return a.x * b.y - a.y * b.x; }
INLINE vec2d d_set2(place a) { return (vec2d){d_set(a.x), d_set(a.y)}; }
INLINE vec2d d_select2(vl m, vec2d a, vec2d b) { return (vec2d){d_select(m, a.x, b.x), d_select(m, a.y, b.y)}; }
INLINE vd d_of_half(const vf *a, int l) { return d_of_floats((const float *)a + l); }
INLINE vec2d d_of_half2(const vf *a, int l) { return (vec2d){d_of_half(a, l), d_of_half(a + 1, l)}; }

/* What is known of half as many rays as there are lanes. */
struct half_met {
    vec2d direction, foot, normal;
    vd ahead, distance;
};

/* The features by which lines enter: the first one of each (struct entries), an arc or ON_EDGE and the arc behind it. */
enum { ON_EDGE = 256 };

struct entry_lanes {
    vm found, on_edge, near;
    vi feature; /* -1: none */
    int32_t arc[V_WIDTH];
};

/* Lines in the shape's coordinates. */
struct lines {
    vec2 foot, direction;
};

/* s of an arc's centre. */
INLINE vf find_height(const narc_stored_arc *arc, vec2 o, vec2 v) {
    return v2_cross(v, v2_sub((vec2){v_set(arc->center_x), v_set(arc->center_y)}, o));
}

/* v x n of the normal at a junction. */
INLINE vf find_turn(vec2 v, const float *normal) { return v2_cross(v, (vec2){v_set(normal[0]), v_set(normal[1])}); }

/* From the last arc to the first: what is found later is before what was found. An edge is known when the arc before it is. */
NOINLINE void find_entry_lanes(const narc_record *arcs, int count, const struct lines *lines, float near,
                               struct entry_lanes *out) {
    const vec2 o = lines->foot, v = lines->direction;
    const vf zero = v_set(0);
    vf nearest = v_set(INFINITY);
    vi first = vi_set(-1);
    vm falls = v_lt(zero, zero), left = falls, last = falls; /* behind: faces the ray and starts to the right */
    for (int k = count - 1; k >= 0; k--) {
        const narc_stored_arc *const arc = &arcs[k].arc;
        const vm start_faces = v_lt(v2_dot(v, (vec2){v_set(arc->start_x), v_set(arc->start_y)}), zero);
        const vf h = find_height(arc, o, v), radius = v_set(arc->radius);
        if (arc->radius > 0) {
            const vm end_faces = v_lt(v2_dot(v, (vec2){v_set(arc->end_x), v_set(arc->end_y)}), zero);
            const vf turn = find_turn(v, &arc->start_x);
            const bool is_wide = arc->start_x * arc->end_x + arc->start_y * arc->end_y < 0;
            const vm faces =
                is_wide ? vm_or(vm_xor(start_faces, end_faces), v_lt(zero, turn)) : vm_or(start_faces, end_faces);
            const vf start = v_add(h, v_mul(radius, turn)), end = v_add(h, v_mul(radius, find_turn(v, &arc->end_x)));
            const vf from = v_select(start_faces, start, v_add(h, radius));
            const vf to = v_select(end_faces, end, v_sub(h, radius));
            nearest = v_min(nearest, v_min(v_abs(from), v_abs(to)));
            left = v_le(zero, end);
            first = vi_select(vm_and(falls, left), vi_set(k + 1 + ON_EDGE), first);
            first = vi_select(vm_and(faces, vm_and(v_le(zero, from), v_lt(to, zero))), vi_set(k), first);
            falls = vm_and_not(start_faces, v_le(zero, start));
        } else {
            nearest = v_min(nearest, v_abs(h));
            left = v_le(zero, h);
            first = vi_select(vm_and(falls, left), vi_set(k + 1 + ON_EDGE), first);
            falls = vm_and_not(start_faces, left);
        }
        last = k == count - 1 ? left : last;
    }
    first = vi_select(vm_and(falls, last), vi_set(ON_EDGE), first);
    out->found = vi_lt(vi_set(-1), first);
    out->on_edge = vi_lt(vi_set(ON_EDGE - 1), first);
    out->near = v_le(nearest, v_set(near));
    out->feature = first;
    vi_store(out->arc,
             vi_select(out->found, vi_sub(first, vi_select(out->on_edge, vi_set(ON_EDGE), vi_set(0))), vi_set(0)));
}

/* The arcs by which they enter, and those before them, as records have them: centre and radius, and both normals. */
struct arc_lanes {
    vf at[4], normals[4], before[4];
};

INLINE void load_arc_lanes(const struct body_frame *frame, const int32_t *arc, struct arc_lanes *out) {
    int32_t before[V_WIDTH];
    const vi number = vi_load(arc), last = vi_set((int32_t)frame->header->count - 1);
    vi_store(before, vi_select(vi_lt(vi_set(0), number), vi_sub(number, vi_set(1)), last));
    v_rows(frame->arcs, sizeof *frame->arcs, arc, out->at);
    v_rows(&frame->arcs->arc.start_x, sizeof *frame->arcs, arc, out->normals);
    v_rows(frame->arcs, sizeof *frame->arcs, before, out->before);
}

/* enter_edge() and enter_arc(), from lane l on. */
INLINE vd enter_edge_lanes(const struct arc_lanes *arcs, int l, struct half_met *met) {
    const vec2d v = met->direction, foot = met->foot, n = d_of_half2(arcs->normals, l);
    const vec2d before = d_of_half2(arcs->before, l), after = d_of_half2(arcs->at, l);
    const vd r = d_of_half(arcs->before + 2, l), q = d_of_half(arcs->at + 2, l), zero = d_set(0);
    const vec2d from = {before.x + r * n.x - foot.x, before.y + r * n.y - foot.y};
    const vec2d to = {after.x + q * n.x - foot.x, after.y + q * n.y - foot.y};
    const vd left = d_cross(v, from), right = d_cross(v, to), start = d_dot(v, from);
    const vd within = d_select(d_le(zero, right), d_set(1), left / (left - right));
    const vd part = d_select(d_le(left, zero), zero, within);
    met->normal = n;
    return start + part * (d_dot(v, to) - start);
}

INLINE vd enter_arc_lanes(const struct arc_lanes *arcs, int l, struct half_met *met) {
    const vec2d v = met->direction, foot = met->foot, start = d_of_half2(arcs->normals, l);
    const vec2d end = d_of_half2(arcs->normals + 2, l);
    const vec2d at = d_of_half2(arcs->at, l), center = {at.x - foot.x, at.y - foot.y};
    const vd radius = d_of_half(arcs->at + 2, l), beside = d_cross(v, center) / radius;
    const vd zero = d_set(0), one = d_set(1);
    const vd capped = d_max(d_set(-1), d_min(one, beside));
    const vd half = d_sqrt((one - capped) * (one + capped));
    const vec2d n = {capped * v.y - half * v.x, -capped * v.x - half * v.y};
    const vl behind = d_le(zero, d_cross(start, n)), before = d_le(zero, d_cross(n, end)), is_within = behind & before;
    const vl is_start = ~behind & (before | d_lt(d_dot(end, n), d_dot(start, n)));
    met->normal = d_select2(is_within, n, d_select2(is_start, start, end));
    return d_dot(v, center) + radius * d_select(is_within, -half, d_dot(v, met->normal));
}

/* Where rays of one origin, from one on, meet a body that is no piece, all in front of them: out_fraction is at least 0, -1 of
 * those that are to be asked alone, and NaN of others. `ignores`: those that start in the body are not asked. False if it is
 * that of all. */
INLINE bool meet_in_lanes(const struct body_frame *frame, const struct read_rays *rays, size_t first, bool ignores,
                          struct entry_lanes *entries, struct half_met met[LANE_HALVES], vf *out_fraction) {
    const narc_shape_header *const header = frame->header;
    const place way = {frame->position.x - rays->origin_x[first], frame->position.y - rays->origin_y[first]};
    const place turned = turn_to_shape(frame, way), middle = {(double)header->bound_x, (double)header->bound_y};
    const vec2d center =
        d_set2((place){turned.x * frame->inverse_scale + middle.x, turned.y * frame->inverse_scale + middle.y});
    const vec2d rotation = d_set2(frame->rotation);
    const vd radius = d_set((double)header->bound_radius), nan = d_set((double)NAN);
    vd foot_x[LANE_HALVES], foot_y[LANE_HALVES], direction_x[LANE_HALVES], direction_y[LANE_HALVES], told[LANE_HALVES];
    UNROLL
    for (int h = 0; h < LANE_HALVES; h++) {
        const int l = h * D_WIDTH;
        const vec2d world = {d_load(rays->direction_x + first + l), d_load(rays->direction_y + first + l)};
        const vec2d v = {d_dot(rotation, world), d_cross(rotation, world)};
        const vd beside = d_cross(v, center), ahead = d_dot(v, center);
        const vl meets = d_le(d_abs(beside), radius) & ~d_lt(ahead, -radius);
        met[h].direction = v;
        met[h].foot = (vec2d){d_set(middle.x) + beside * v.y, d_set(middle.y) - beside * v.x};
        met[h].normal = v; /* of those that find none */
        met[h].ahead = met[h].distance = ahead;
        foot_x[h] = d_select(meets, met[h].foot.x, nan);
        foot_y[h] = met[h].foot.y;
        direction_x[h] = v.x;
        direction_y[h] = v.y;
    }
    const struct lines lines = {{d_join_floats(foot_x), d_join_floats(foot_y)},
                                {d_join_floats(direction_x), d_join_floats(direction_y)}};
    find_entry_lanes(frame->arcs, header->count, &lines, (float)(2 * find_touch(header)), entries);
    *out_fraction = v_select(entries->near, v_set(-1), v_set(NAN));
    if (!vm_any(entries->found))
        return vm_any(entries->near);
    struct arc_lanes arcs;
    load_arc_lanes(frame, entries->arc, &arcs);
    const bool on_edges = vm_any(vm_and(entries->found, entries->on_edge));
    const bool on_arcs = vm_any(vm_and_not(entries->found, entries->on_edge));
    UNROLL
    for (int h = 0; h < LANE_HALVES; h++) {
        const int l = h * D_WIDTH;
        vd along = d_set(0);
        if (on_edges)
            along = enter_edge_lanes(&arcs, l, &met[h]);
        if (on_arcs) {
            const vec2d normal = met[h].normal;
            const vl on_edge = d_of_lanes(entries->on_edge, l);
            const vd along_arc = enter_arc_lanes(&arcs, l, &met[h]);
            along = on_edges ? d_select(on_edge, along, along_arc) : along_arc;
            met[h].normal = on_edges ? d_select2(on_edge, normal, met[h].normal) : met[h].normal;
        }
        const vd distance = (met[h].ahead + along) * d_set(frame->scale);
        const vd fraction = distance * d_load(rays->inverse_length + first + l);
        const vl in_front = d_lt(d_set(0), distance), is_number = d_le(fraction, d_set((double)FLT_MAX));
        met[h].distance = distance;
        told[h] = d_select(in_front, d_select(is_number, fraction, nan), ignores ? nan : d_set(-1));
    }
    *out_fraction = v_select(entries->near, v_set(-1), v_select(entries->found, d_join_floats(told), v_set(NAN)));
    return true;
}

/* What rows say of them, as put_place() has it. */
struct half_place {
    vec2d normal, point;
};

INLINE vec2d d_turn_to_world(const struct body_frame *frame, vec2d a) {
    const vec2d rotation = d_set2(frame->rotation);
    return (vec2d){rotation.x * a.x - rotation.y * a.y, rotation.y * a.x + rotation.x * a.y};
}

INLINE struct half_place find_place_lanes(const struct body_frame *frame, const struct half_met *met) {
    const vec2d foot = met->foot, v = met->direction;
    const vd along = met->distance * d_set(frame->inverse_scale) - met->ahead, scale = d_set(frame->scale);
    const vec2d point = d_turn_to_world(frame, (vec2d){foot.x + along * v.x, foot.y + along * v.y});
    return (struct half_place){d_turn_to_world(frame, met->normal), {point.x * scale, point.y * scale}};
}

#endif
