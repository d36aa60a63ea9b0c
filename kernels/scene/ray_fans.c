/* SPDX-License-Identifier: MIT
 *
 * ray_fans.c - rays of one origin whose directions differ little go through the index together, and meet a body in
 * lanes.
 *
 * A node is visited if it meets the wedge between the outermost two, and only at a leaf each ray is asked, in a lane of
 * its own. A ray's answer is the same whether it goes alone or not.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "column.h"
#include "index.h"
#include "kernels.h"
#include "scene/body_frame.inl"
#include "scene/ray_features.inl"
#include "scene/ray_lanes.inl"
#include "scene/ray_reading.inl"
#include "scene/ray_walk.inl"
#include "scene/things.inl"
#include "simd/doubles.h"
#include "simd/simd.h"

enum { MOST_TOGETHER = 32, LANES = MOST_TOGETHER + V_WIDTH };

/* Do rays that go together meet a body in lanes? In the module for WebAssembly they take too much room. */
#if defined(__wasm__)
#define IN_LANES 0
#else
#define IN_LANES (NARC_SHORTCUTS && V_WIDTH > 1)
#endif

/* The least cosine of the angle between a ray and the first that it goes with. */
#define COHERENT 0.8

/* Of rays in lanes, each with room for one hit: its nearest, as far as it is not yet in its row. A body is its number less
 * 2^31, and UINT32_MAX there is none. */
struct nearest {
    uint32_t waiting; /* a bit for each ray */
    int32_t body[LANES];
    float fraction[LANES], normal_x[LANES], normal_y[LANES], point_x[LANES], point_y[LANES];
    int32_t feature[LANES]; /* the arc, and ON_EDGE */
    int32_t word[LANES];    /* that and the count as rows have them, */
    float radius[LANES];    /* and this, when they are written */
};

/* Rays that go together. */
struct fan {
    struct read_rays *rays;
    size_t first, count;
    float left_x, left_y, right_x, right_y; /* directions: none is further out */
    float limit;                            /* the largest */
    struct chosen chosen;                   /* for all */
    float *limits;
    bool in_lanes;
    struct walk walks[MOST_TOGETHER]; /* in lanes: the first, and those that are asked alone */
    struct nearest nearest;
};

INLINE bool goes_in_lanes(const struct fan *f) { return IN_LANES && f->in_lanes; }

/* Do two rays ask of the same bodies? */
INLINE bool is_alike(narc_index_column column, size_t a, size_t b) {
    return !column.base || narc_index_at(column, a) == narc_index_at(column, b);
}

INLINE bool ask_alike(const narc_index_query *search, size_t a, size_t b) {
    return is_alike(search->world, a, b) && is_alike(search->ignored, a, b) &&
           (!search->mask.base || narc_word_at(search->mask, a) == narc_word_at(search->mask, b)) &&
           (!search->owners || is_alike(search->owners->ignored, a, b));
}

/* Rays that start within the scene may go together, if it is not so large that a wedge's numbers overflow, and unless
 * any hit will do: which is found depends on the way. */
INLINE bool is_open(const narc_ray_batch *batch, const narc_box *scene, const struct read_rays *rays, size_t k) {
    const narc_point *const origin = &batch->index->origin;
    const place o = {rays->origin_x[k] - origin->x, rays->origin_y[k] - origin->y};
    return (double)scene->min_x <= o.x && o.x <= (double)scene->max_x && (double)scene->min_y <= o.y &&
           o.y <= (double)scene->max_y && rays->room[k] <= 0x1p80f && !batch->options->any;
}

/* The outermost of rays, on one side, in lanes: how far to that side of a direction it goes, and its own. */
struct outermost {
    vd sine;
    vec2d direction;
};

INLINE void widen(struct outermost *side, vl in, vd sine, vec2d direction) {
    const vl out = in & d_lt(side->sine, sine);
    side->sine = d_select(out, sine, side->sine);
    side->direction = d_select2(out, direction, side->direction);
}

INLINE void put_outermost(const struct outermost *side, float *out_x, float *out_y) {
    double sine[D_WIDTH], x[D_WIDTH], y[D_WIDTH];
    int most = 0;
    d_store(sine, side->sine);
    d_store(x, side->direction.x);
    d_store(y, side->direction.y);
    for (int l = 1; l < D_WIDTH; l++)
        most = sine[l] > sine[most] ? l : most;
    *out_x = (float)x[most];
    *out_y = (float)y[most];
}

/* Gathers the rays from `first` on that go together: of one start, into one quadrant, not far apart, asking the same. How many
 * are they? The wedge may be that of some that come behind them, too. */
INLINE size_t gather_fan(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays, size_t first,
                         struct fan *f) {
    const narc_index_query *const search = &batch->options->search;
    const vd x = d_set(rays->origin_x[first]), y = d_set(rays->origin_y[first]), zero = d_set(0);
    const vd inverse_x = d_set((double)rays->x.inverse[first]), inverse_y = d_set((double)rays->y.inverse[first]);
    const vec2d direction = d_set2((place){rays->direction_x[first], rays->direction_y[first]});
    const size_t left = rays->count - first, most = left < MOST_TOGETHER ? left : MOST_TOGETHER;
    struct outermost to_left = {zero, direction}, to_right = to_left;
    uint64_t company = 0;
    if (!NARC_SHORTCUTS || most == 1 || rays->origin_x[first + 1] != rays->origin_x[first] ||
        !is_open(batch, scene, rays, first))
        return 1;
    for (size_t k = 0; k < most && company + 1 == (uint64_t)1 << k; k += D_WIDTH) {
        const size_t at = first + k;
        const vd other_x = d_load(rays->origin_x + at), other_y = d_load(rays->origin_y + at);
        const vec2d other = {d_load(rays->direction_x + at), d_load(rays->direction_y + at)};
        const vd sine = d_cross(direction, other);
        const vl joins = d_le(x, other_x) & d_le(other_x, x) & d_le(y, other_y) & d_le(other_y, y) &
                         d_lt(zero, d_load(rays->length + at)) & d_lt(d_set(COHERENT), d_dot(direction, other)) &
                         d_lt(zero, d_of_floats(rays->x.inverse + at) * inverse_x) &
                         d_lt(zero, d_of_floats(rays->y.inverse + at) * inverse_y);
        widen(&to_left, joins, sine, other);
        widen(&to_right, joins, -sine, other);
        company |= (uint64_t)d_bits(joins) << k;
    }
    company &= UINT64_MAX >> (64 - most);
    const bool alike = !search->world.base && !search->ignored.base && !search->mask.base && !search->owners;
    size_t count = alike ? (size_t)FIND_LOWEST_64(~company) : 1;
    while (company >> count & 1 && ask_alike(search, rays->number[first], rays->number[first + count]))
        count++;
    put_outermost(&to_left, &f->left_x, &f->left_y);
    put_outermost(&to_right, &f->right_x, &f->right_y);
    f->rays = rays;
    f->first = first;
    return f->count = count;
}

/* The largest limit of all. */
INLINE float find_largest_limit(const struct fan *f) {
    vf largest = v_set(-INFINITY);
    float lanes[V_WIDTH];
    for (int k = 0; k < (int)f->count; k += V_WIDTH)
        largest = v_max(v_select(vm_front((int)f->count - k), v_load(f->limits + k), v_set(-INFINITY)), largest);
    v_store(lanes, largest);
    for (int l = 1; l < V_WIDTH; l++)
        lanes[0] = lanes[l] > lanes[0] ? lanes[l] : lanes[0];
    return lanes[0];
}

INLINE void begin_fan(const narc_ray_batch *batch, struct fan *f) {
    struct read_rays *const rays = f->rays;
    f->limits = rays->limit + f->first;
    f->limit = find_largest_limit(f);
    f->in_lanes = IN_LANES && batch->most == 1 && !batch->options->search.owners;
    for (size_t k = 0; k < (goes_in_lanes(f) ? 1 : f->count); k++)
        begin_walk(batch, rays, f->first + k, &f->walks[k]);
    f->chosen = f->walks->chosen;
    if (!goes_in_lanes(f))
        return;
    f->nearest.waiting = 0;
    for (int k = 0; k < (int)f->count + V_WIDTH; k += V_WIDTH) {
        v_store(f->nearest.fraction + k, v_set(-1));
        vi_store(f->nearest.body + k, vi_set(INT32_MAX));
    }
    memcpy(f->nearest.fraction, rays->fraction + f->first, f->count * sizeof *rays->fraction);
}

/* A bit for each slot that the wedge may meet, and how far away it is at least: boxes have corners to the left of the
 * rightmost ray and to the right of the leftmost one; which corner decides is known by the quadrant. Boxes are larger by
 * the room on every side, and a cross product errs by less than half of it. */
INLINE uint32_t find_wedge_slots(const struct fan *f, const narc_index_node *node, float *out_near) {
    const struct walk *const w = &f->walks[0];
    const float *const planes = (const float *)node;
    const bool aslant = w->aslant;
    const vf zero = v_set(0), limit = v_set(f->limit), right_x = v_set(f->right_x), right_y = v_set(f->right_y);
    const vf outer_x = aslant ? right_x : v_set(f->left_x), outer_y = aslant ? right_y : v_set(f->left_y);
    const vf other_x = aslant ? v_set(f->left_x) : right_x, other_y = aslant ? v_set(f->left_y) : right_y;
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf first_x = v_sub(v_load_8(planes + w->x.first + k), v_set(w->x.first_start));
        const vf first_y = v_sub(v_load_8(planes + w->y.first + k), v_set(w->y.first_start));
        const vf last_x = v_sub(v_load_8(planes + w->x.last + k), v_set(w->x.last_start));
        const vf last_y = v_sub(v_load_8(planes + w->y.last + k), v_set(w->y.last_start));
        const vf a = v_sub(v_mul(outer_x, first_y), v_mul(outer_y, last_x));
        const vf c = v_sub(v_mul(other_x, last_y), v_mul(other_y, first_x));
        const vm beside = aslant ? vm_and(v_le(zero, a), v_le(c, zero)) : vm_and(v_le(a, zero), v_le(zero, c));
        const vf near = v_add(v_mul(right_x, first_x), v_mul(right_y, first_y));
        const vf far = v_add(v_mul(right_x, last_x), v_mul(right_y, last_y));
        v_store(out_near + k, near);
        slots |= vm_bits(vm_and(beside, vm_and(v_le(zero, far), v_le(near, limit)))) << k;
    }
    return slots & ((1u << NARC_NODE_SLOTS) - 1);
}

/* A bit for each ray that meets a slot's box: as find_slots(), with a lane for each ray. */
INLINE uint32_t find_rays(const struct fan *f, const narc_index_node *node, unsigned slot) {
    const struct walk *const w = &f->walks[0];
    const float *const planes = (const float *)node + slot;
    const float *const all_x = f->rays->x.inverse + f->first, *const all_y = f->rays->y.inverse + f->first;
    const vf first_x = v_set(planes[w->x.first] - w->x.first_start),
             last_x = v_set(planes[w->x.last] - w->x.last_start);
    const vf first_y = v_set(planes[w->y.first] - w->y.first_start),
             last_y = v_set(planes[w->y.last] - w->y.last_start);
    uint64_t rays = 0;
    for (size_t k = 0; k < f->count; k += V_WIDTH) {
        const vf inverse_x = v_load(all_x + k), inverse_y = v_load(all_y + k);
        const vf near = v_max(v_max(v_mul(first_x, inverse_x), v_mul(first_y, inverse_y)), v_set(0));
        const vf far = v_mul(v_min(v_mul(last_x, inverse_x), v_mul(last_y, inverse_y)), v_set(1 + ROOM));
        rays |= (uint64_t)vm_bits(vm_and(v_le(near, far), v_le(near, v_load(f->limits + k)))) << k;
    }
    return (uint32_t)(rays & (((uint64_t)1 << f->count) - 1));
}

INLINE unsigned find_nearest_slot(uint32_t slots, const float *near) {
    unsigned nearest = (unsigned)FIND_LOWEST(slots);
    while (slots &= slots - 1)
        nearest = near[FIND_LOWEST(slots)] < near[nearest] ? (unsigned)FIND_LOWEST(slots) : nearest;
    return nearest;
}

/* Writes what waits of these rays to their rows. Neighbours mostly hit the same body, often by the same feature. */
NOINLINE void put_hits(const narc_ray_batch *batch, struct fan *f, uint32_t rays) {
    struct nearest *const nearest = &f->nearest;
    narc_ray_hit told = {.count = 1}, spare;
    struct body_frame frame = {.header = NULL};
    int32_t body = INT32_MAX, feature = -1;
    const uint64_t put = rays & nearest->waiting;
    for (uint64_t left = put; left; left &= left - 1) {
        const unsigned k = (unsigned)FIND_LOWEST_64(left);
        if (nearest->body[k] != body || nearest->feature[k] != feature) {
            if (nearest->body[k] != body)
                load_body_frame(batch->shapes, batch->bodies, (uint32_t)nearest->body[k] ^ 0x80000000u, &frame);
            body = nearest->body[k];
            feature = nearest->feature[k];
            put_feature(&frame, &(struct entry){.arc = feature & (ON_EDGE - 1), .on_edge = (feature & ON_EDGE) != 0},
                        &told);
        }
        memcpy(&nearest->word[k], &told.feature, sizeof nearest->word[k]);
        nearest->radius[k] = told.radius;
    }
    for (size_t k = 0; k < f->count; k += V_WIDTH) {
        const vf first[4] = {v_of_bits(vi_add(vi_load(nearest->body + k), vi_set(INT32_MIN))),
                             v_of_bits(vi_load(nearest->word + k)), v_load(nearest->fraction + k),
                             v_load(nearest->normal_x + k)};
        const vf second[4] = {v_load(nearest->normal_y + k), v_load(nearest->point_x + k), v_load(nearest->point_y + k),
                              v_load(nearest->radius + k)};
        char *row[V_WIDTH];
        for (size_t l = 0; l < V_WIDTH; l++)
            row[l] = (char *)(put >> (k + l) & 1 ? batch->out + f->rays->number[f->first + k + l] : &spare);
        v_put_rows(row, offsetof(narc_ray_hit, body), first);
        v_put_rows(row, offsetof(narc_ray_hit, normal_y), second);
    }
    nearest->waiting &= ~rays;
}

_Static_assert(offsetof(narc_ray_hit, feature) == 8 && offsetof(narc_ray_hit, count) == 10 &&
                   offsetof(narc_ray_hit, fraction) == 12 && offsetof(narc_ray_hit, point_x) == 24 &&
                   offsetof(narc_ray_hit, radius) == 32,
               "a row is the ray's number, and two times four words");

INLINE void select_ints(vm m, int32_t *p, vi a) { vi_store(p, vi_select(m, a, vi_load(p))); }
INLINE void select_floats(vm m, float *p, vf a) { v_store(p, v_select(m, a, v_load(p))); }

/* Casts rays k, k + 1 ... at a body, which has a hit for each ray that it tells nothing of. */
INLINE uint32_t cast_lanes(struct fan *f, const struct body_frame *frame, uint32_t body, bool ignores, unsigned k) {
    struct nearest *const nearest = &f->nearest;
    const struct read_rays *const all = f->rays;
    const size_t at = f->first + k;
    struct entry_lanes entries;
    struct half_met met[LANE_HALVES];
    vf fraction;
    if (!meet_in_lanes(frame, all, at, ignores, &entries, met, &fraction))
        return 0;
    const vf least = v_load(nearest->fraction + k);
    const vi number = vi_set((int32_t)(body ^ 0x80000000u));
    const vm is_before = vm_or(v_lt(fraction, least), vi_lt(number, vi_load(nearest->body + k)));
    const vm hits = vm_and(vm_and(v_le(v_set(0), fraction), v_le(fraction, least)), is_before);
    if (vm_any(hits)) {
        vd limits[LANE_HALVES], normal_x[LANE_HALVES], normal_y[LANE_HALVES], point_x[LANE_HALVES],
            point_y[LANE_HALVES];
        float lanes[V_WIDTH];
        v_store(lanes, fraction);
        UNROLL
        for (int h = 0; h < LANE_HALVES; h++) {
            const int l = h * D_WIDTH;
            const struct half_place at_place = find_place_lanes(frame, &met[h]);
            normal_x[h] = at_place.normal.x;
            normal_y[h] = at_place.normal.y;
            point_x[h] = at_place.point.x;
            point_y[h] = at_place.point.y;
            limits[h] = find_limit(d_of_floats(lanes + l), d_load(all->length + at + l), d_set(0),
                                   d_set((double)f->walks[0].room));
        }
        nearest->waiting |= vm_bits(hits) << k;
        select_floats(hits, nearest->fraction + k, fraction);
        select_ints(hits, nearest->body + k, number);
        select_ints(hits, nearest->feature + k, entries.feature);
        select_floats(hits, nearest->normal_x + k, d_join_floats(normal_x));
        select_floats(hits, nearest->normal_y + k, d_join_floats(normal_y));
        select_floats(hits, nearest->point_x + k, d_join_floats(point_x));
        select_floats(hits, nearest->point_y + k, d_join_floats(point_y));
        select_floats(hits, f->limits + k, d_join_floats(limits));
    }
    return vm_bits(v_lt(fraction, v_set(0)));
}

/* Casts rays at a body; which are to be asked alone? */
INLINE uint32_t cast_in_lanes(const narc_ray_batch *batch, struct fan *f, const struct body_frame *frame, uint32_t body,
                              uint32_t rays) {
    const bool ignores = batch->options->inside == NARC_INSIDE_IGNORES;
    uint32_t alone = 0;
    while (rays) {
        const unsigned k = (unsigned)FIND_LOWEST(rays);
        const uint32_t lanes = (uint32_t)(((uint64_t)1 << V_WIDTH) - 1) << k;
        alone |= cast_lanes(f, frame, body, ignores, k) << k & rays;
        rays &= ~lanes;
    }
    return alone;
}

/* Casts one ray of a fan at a body, alone. */
NOINLINE void cast_one(const narc_ray_batch *batch, struct fan *f, const struct body_frame *frame, uint32_t body,
                       unsigned k) {
    struct walk *const w = &f->walks[k];
    if (goes_in_lanes(f)) {
        put_hits(batch, f, 1u << k);
        begin_walk(batch, f->rays, f->first + k, w);
        w->found = w->rows->count;
        w->limit = f->limits[k];
        w->limit_fraction = f->nearest.fraction[k];
    }
    NARC_NAMED(cast_at_frame)(batch, w, frame, body);
    f->limits[k] = w->limit;
    if (goes_in_lanes(f) && w->found > 0) {
        f->nearest.fraction[k] = w->rows->fraction;
        f->nearest.body[k] = (int32_t)(w->rows->body ^ 0x80000000u);
    }
}

/* Is the largest limit less now? */
INLINE bool visit_leaf_together(const narc_ray_batch *batch, struct fan *f, size_t leaf, uint32_t slots,
                                const float *near) {
    const narc_index *const index = batch->index;
    unsigned slot;
    for (; slots; slots &= ~(1u << slot)) {
        slot = find_nearest_slot(slots, near);
        uint32_t rays = find_rays(f, &index->nodes[leaf], slot);
        struct body_frame frame;
        const uint32_t body = index->body[NARC_NODE_SLOTS * leaf + slot];
        if (!rays || body == f->chosen.ignored || !load_body_frame(batch->shapes, batch->bodies, body, &frame))
            continue;
        if (goes_in_lanes(f) && !narc_is_piece(frame.header))
            rays = cast_in_lanes(batch, f, &frame, body, rays);
        for (; rays; rays &= rays - 1)
            cast_one(batch, f, &frame, body, (unsigned)FIND_LOWEST(rays));
    }
    const float limit = f->limit;
    f->limit = find_largest_limit(f);
    return f->limit < limit;
}

static void walk_together(const narc_ray_batch *batch, struct fan *f) {
    const narc_index *const index = batch->index;
    const struct walk *const first = &f->walks[0];
    struct descent d;
    unsigned level = index->level_count - 1;
    uint32_t below = 0;
    bool goes_on = true;
    d.left = d.above = 0;
    begin_fan(batch, f);
    for (; goes_on; level--) {
        const size_t node = (size_t)index->first_node[level] + below;
        const uint32_t slots =
            mask_slots(index, node, find_wedge_slots(f, &index->nodes[node], d.near[level]), &f->chosen);
        if (level > 0) {
            goes_on =
                go_below(&d, &level, &below, slots, narc_find_flips(index->order[node], first->left, first->aslant));
        } else {
            if (visit_leaf_together(batch, f, node, slots, d.near[0]))
                drop_slots(&d, f->limit);
            goes_on = take_slot(&d, &level, &below);
        }
    }
    if (goes_in_lanes(f))
        put_hits(batch, f, UINT32_MAX);
}

size_t NARC_NAMED(cast_fan)(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays, size_t first) {
    struct fan fan;
    const size_t count = gather_fan(batch, scene, rays, first, &fan);
    if (count >= LEAST_TOGETHER)
        walk_together(batch, &fan);
    return count;
}
