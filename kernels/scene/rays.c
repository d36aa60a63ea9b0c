/* SPDX-License-Identifier: MIT
 *
 * rays.c - the kernel of rays: from the root of the index down to the bodies whose boxes a ray meets, nearest first.
 *
 * The lanes are a node's eight slots. A slot's box is met from `near` to `far` along the ray, which are computed in
 * single precision with room, so that nothing is lost that ray_entry.inl would find; then it makes no difference which
 * boxes are met besides, in which order, and how large they are. Rays that start outside of all boxes are moved to where they meet them
 * first: so the room is in proportion to the scene. A near, a far err by three roundings in proportion, and by the
 * rounding of the start, up to 2^-24 of it.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "column.h"
#include "index.h"
#include "kernels.h"
#include "scene/part_walk.inl"
#include "scene/ray_entry.inl"
#include "scene/things.inl"
#include "simd/simd.h"

/* Relative to all that near and far are computed from, eight times their error. */
#define ROOM 0x1p-20f

/* 1 / a direction's component that is less than the inverse counts as this: within the scene the ray moves by less than
 * its room along that axis. */
#define LARGEST_INVERSE 0x1p60f

/* A ray's way along an axis past boxes: the planes that it meets first and last of a node's, as offsets in floats, and
 * the start, moved apart by the room. */
struct axis {
    bool backwards;
    int first, last;
    float first_start, last_start, inverse;
};

/* What is left to visit: a node, counted within its level, and how far away it is. */
struct visit {
    float near;
    uint32_t node;
    uint32_t level;
};

struct visits {
    unsigned count;
    struct visit left[(NARC_NODE_SLOTS - 1) * NARC_INDEX_LEVELS + 1];
};

/* A ray, and what is known of its hits. */
struct walk {
    struct ray ray;
    struct axis x, y;
    double base; /* where along the ray nears are counted from */
    float room;  /* of a distance */
    float limit; /* no body whose near is above is wanted */
    float limit_fraction;
    struct chosen chosen;
    size_t found;
    narc_ray_hit *rows;
};

enum { LEAST_TOGETHER = 4, MOST_TOGETHER = 32 };

/* The least cosine of the angle between a ray and the first that it goes with. */
#define COHERENT 0.97

/* Rays of one origin whose directions differ little go through the index together: a node is visited if it meets the
 * wedge between the outermost two, and only at a leaf each ray is asked, in a lane of its own. A ray's answer is the same
 * whether it goes alone or not. */
struct bundle {
    size_t count;
    bool open;                              /* may others join? */
    float left_x, left_y, right_x, right_y; /* the directions of the outermost rays */
    float limit;                            /* the largest */
    uint64_t mask;                          /* of all */
    float limits[MOST_TOGETHER], inverse_x[MOST_TOGETHER], inverse_y[MOST_TOGETHER];
    struct walk walks[MOST_TOGETHER];
};

/* ------------------------------------------------------------------------------------------------ a ray begins */

/* The box around all. Empty boxes change nothing. */
static narc_box find_scene_box(const narc_index *index) {
    narc_box box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    const narc_index_node *const root = &index->nodes[index->first_node[index->level_count - 1]];
    for (int k = 0; k < NARC_NODE_SLOTS; k++) {
        box.min_x = root->min_x[k] < box.min_x ? root->min_x[k] : box.min_x;
        box.min_y = root->min_y[k] < box.min_y ? root->min_y[k] : box.min_y;
        box.max_x = root->max_x[k] > box.max_x ? root->max_x[k] : box.max_x;
        box.max_y = root->max_y[k] > box.max_y ? root->max_y[k] : box.max_y;
    }
    return box;
}

static float clip_to_float(double a) { return (float)find_most(-(double)FLT_MAX, find_least((double)FLT_MAX, a)); }

static float clip_inverse(double inverse) {
    const double limit = (double)LARGEST_INVERSE;
    return (float)find_most(-limit, find_least(limit, inverse));
}

INLINE struct axis set_axis(int min, int max, double start, double room, double inverse) {
    const bool backwards = inverse < 0;
    const float low = clip_to_float(start - room), high = clip_to_float(start + room);
    return (struct axis){backwards,
                         backwards ? max : min,
                         backwards ? min : max,
                         backwards ? low : high,
                         backwards ? high : low,
                         clip_inverse(inverse)};
}

/* Nothing further than a fraction of the ray's motion is wanted; what is as far still is, also up to rounding of fractions
 * that underflow. */
INLINE void set_limit(struct walk *w, float fraction) {
    const double distance = ((double)fraction * (1 + 0x1p-22) + 0x1p-149) * w->ray.length - w->base;
    w->limit_fraction = fraction;
    w->limit = clip_to_float(distance + fabs(distance) * (double)ROOM + (double)w->room);
}

/* False for a ray without an answer. */
static bool read_ray(const narc_rays *rays, size_t k, struct ray *out, float *out_fraction) {
    const place motion = {(double)narc_float_at(rays->motion_x, k), (double)narc_float_at(rays->motion_y, k)};
    const float fraction = rays->fraction.base ? narc_float_at(rays->fraction, k) : 1;
    out->origin = (place){narc_position_at(rays->x, k), narc_position_at(rays->y, k)};
    out->length = sqrt(find_dot(motion, motion));
    out->inverse_length = 1 / out->length;
    out->direction = (place){motion.x * out->inverse_length, motion.y * out->inverse_length};
    out->inverse = (place){1 / out->direction.x, 1 / out->direction.y};
    *out_fraction = fraction;
    return fabs(out->origin.x) <= DBL_MAX && fabs(out->origin.y) <= DBL_MAX && 0 < out->length &&
           out->length <= DBL_MAX && fraction >= 0;
}

/* A ray meets a body that it passes by TOUCH, and what rounding adds, perhaps beside its box. For each unit of the
 * extent's ratio to the bounding radius, which is less than 1.42 times the scene's largest coordinate. */
#define TOUCH_ROOM 0x1p-19

/* Cuts from .. to down to where a line lies between two sides. NaN on a side that it lies in. */
INLINE void cut_stretch(double low, double high, double origin, double inverse, double *from, double *to) {
    const double a = (low - origin) * inverse, b = (high - origin) * inverse;
    const double first = inverse < 0 ? b : a, last = inverse < 0 ? a : b;
    *from = first > *from ? first : *from;
    *to = last < *to ? last : *to;
}

/* Sets a ray out from where it meets the scene, with room. False if it never does. */
static bool begin_walk(const narc_box *scene, const narc_shapes *shapes, struct walk *w) {
    const place origin = w->ray.origin, inverse = w->ray.inverse;
    const double size = find_most(find_most(-(double)scene->min_x, (double)scene->max_x),
                                  find_most(-(double)scene->min_y, (double)scene->max_y));
    const double touch = size * ((double)ROOM + (double)shapes->largest_ratio * TOUCH_ROOM) +
                         (fabs(origin.x) + fabs(origin.y)) * 0x1p-48;
    double from = 0, to = INFINITY;
    cut_stretch((double)scene->min_x - touch, (double)scene->max_x + touch, origin.x, inverse.x, &from, &to);
    cut_stretch((double)scene->min_y - touch, (double)scene->max_y + touch, origin.y, inverse.y, &from, &to);
    if (!(to >= 0)) /* it is behind, or empty */
        return false;
    w->base = find_least(from, DBL_MAX);
    const place start = {origin.x + w->base * w->ray.direction.x, origin.y + w->base * w->ray.direction.y};
    const double room = (fabs(start.x) + fabs(start.y)) * (double)ROOM + touch;
    w->room = clip_to_float(room);
    w->x = set_axis(offsetof(narc_index_node, min_x) / sizeof(float), offsetof(narc_index_node, max_x) / sizeof(float),
                    start.x, room, inverse.x);
    w->y = set_axis(offsetof(narc_index_node, min_y) / sizeof(float), offsetof(narc_index_node, max_y) / sizeof(float),
                    start.y, room, inverse.y);
    return true;
}

/* ------------------------------------------------------------------------------------------------ a node */

/* A bit for each slot that the ray meets, and where. */
INLINE uint32_t find_slots(const struct walk *w, const narc_index_node *node, float *out_near) {
    const float *const planes = (const float *)node;
    const vf inverse_x = v_set(w->x.inverse), inverse_y = v_set(w->y.inverse), limit = v_set(w->limit);
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf near_x = v_mul(v_sub(v_load(planes + w->x.first + k), v_set(w->x.first_start)), inverse_x);
        const vf near_y = v_mul(v_sub(v_load(planes + w->y.first + k), v_set(w->y.first_start)), inverse_y);
        const vf far_x = v_mul(v_sub(v_load(planes + w->x.last + k), v_set(w->x.last_start)), inverse_x);
        const vf far_y = v_mul(v_sub(v_load(planes + w->y.last + k), v_set(w->y.last_start)), inverse_y);
        const vf near = v_max(v_max(near_x, near_y), v_set(0));
        const vf far = v_mul(v_min(far_x, far_y), v_set(1 + ROOM));
        v_store(out_near + k, near);
        slots |= vm_bits(vm_and(v_le(near, far), v_le(near, limit))) << k;
    }
    return slots & ((1u << NARC_NODE_SLOTS) - 1);
}

/* Bit k becomes bit k ^ flips. */
INLINE uint32_t flip_slots(uint32_t slots, unsigned flips) {
    slots = flips & 1 ? (slots & 0x55) << 1 | (slots >> 1 & 0x55) : slots;
    slots = flips & 2 ? (slots & 0x33) << 2 | (slots >> 2 & 0x33) : slots;
    return flips & 4 ? (slots & 0x0f) << 4 | slots >> 4 : slots;
}

INLINE bool is_before(const narc_ray_hit *a, const narc_ray_hit *b) {
    return a->fraction < b->fraction || (a->fraction == b->fraction && a->body < b->body);
}

/* Puts a hit among a ray's rows, if it is one of the first. */
INLINE void keep_hit(struct walk *w, size_t most, const narc_ray_hit *hit) {
    size_t k = w->found;
    if (k == most && !is_before(hit, &w->rows[most - 1]))
        return;
    for (k = k == most ? most - 1 : k; k > 0 && is_before(hit, &w->rows[k - 1]); k--)
        w->rows[k] = w->rows[k - 1];
    w->rows[k] = *hit;
    w->found += w->found < most;
    if (w->found == most)
        set_limit(w, w->rows[most - 1].fraction);
}

/* ------------------------------------------------------------------------------------------------ things */

/* Does the ray start within a part of the thing? */
NOINLINE bool starts_in(const narc_ray_batch *batch, const struct walk *w, uint32_t owner) {
    struct part_walk parts = begin_part_walk(batch->index, &w->chosen, owner, w->ray.origin, 4 * (double)w->room);
    struct body_frame frame;
    struct meeting met;
    uint32_t body;
    while (find_next_part(&parts, batch->shapes, batch->bodies, &body, &frame))
        if (find_meeting(&frame, &w->ray, NARC_INSIDE_STOPS, false, &met) && met.is_within)
            return true;
    return false;
}

/* Where the ray leaves a thing, from where it leaves a part that it starts in (`out`, at this distance): from part to part, as
 * long as one that holds the place, or lies within a seam of it, goes on further. False if that is too far. */
NOINLINE bool leave_thing(const narc_ray_batch *batch, const struct walk *w, uint32_t owner, double distance,
                          narc_ray_hit *out) {
    const struct ray *const ray = &w->ray;
    for (double at = -1; at < distance;) {
        at = distance;
        const place from = {ray->origin.x + at * ray->direction.x, ray->origin.y + at * ray->direction.y};
        struct part_walk parts = begin_part_walk(batch->index, &w->chosen, owner, from, 4 * (double)w->room);
        struct body_frame frame;
        struct meeting met;
        uint32_t body;
        while (find_next_part(&parts, batch->shapes, batch->bodies, &body, &frame))
            if (find_meeting(&frame, ray, NARC_INSIDE_LEAVES, true, &met) &&
                (met.distance > distance || (met.distance == distance && body < out->body)) &&
                find_depth_in(&frame, find_place_in(&frame, from)) * frame.scale <= find_seam(&frame) &&
                put_meeting(&frame, ray, &met, INFINITY, out)) {
                distance = met.distance;
                out->body = body;
            }
    }
    return out->fraction <= w->limit_fraction;
}

/* Takes a thing's row out, if it has one. False if that is before the hit. */
INLINE bool replace_row(struct walk *w, uint32_t owner, const narc_ray_hit *hit) {
    for (size_t k = 0; k < w->found; k++)
        if (find_owner(&w->chosen, w->rows[k].body) == owner) {
            if (!is_before(hit, &w->rows[k]))
                return false;
            for (w->found--; k < w->found; k++)
                w->rows[k] = w->rows[k + 1];
        }
    return true;
}

/* A row for a part, if none of its thing is before it. Of a thing that the ray starts in, that of its end, or none. */
INLINE bool find_part_row(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame,
                          narc_ray_hit *out) {
    const narc_inside inside = batch->options->inside;
    const uint32_t owner = find_owner(&w->chosen, out->body);
    const bool is_part = owner != UINT32_MAX;
    struct meeting met;
    if (!is_chosen(&w->chosen, out->body) ||
        !find_meeting(frame, &w->ray, is_part && inside == NARC_INSIDE_IGNORES ? NARC_INSIDE_LEAVES : inside, false,
                      &met))
        return false;
    if (!is_part || inside == NARC_INSIDE_STOPS || !met.is_within)
        return put_meeting(frame, &w->ray, &met, w->limit_fraction, out) &&
               (!is_part || inside == NARC_INSIDE_STOPS || !starts_in(batch, w, owner)) &&
               (!is_part || replace_row(w, owner, out));
    return inside == NARC_INSIDE_LEAVES && put_meeting(frame, &w->ray, &met, INFINITY, out) &&
           leave_thing(batch, w, owner, met.distance, out) && replace_row(w, owner, out);
}

/* ------------------------------------------------------------------------------------------------ a body */

NOINLINE bool cast_at_part(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame, uint32_t body) {
    narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
    if (!find_part_row(batch, w, frame, &hit))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

/* Casts a ray at the body in a leaf's slot; `parts`: which may be one of several. Is the ray done? */
INLINE bool cast_at_slot(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame, size_t leaf,
                         unsigned slot, bool parts) {
    narc_ray_hit hit = {.ray = w->rows->ray, .body = batch->index->body[NARC_NODE_SLOTS * leaf + slot], .count = 1};
    struct meeting met;
    if (parts)
        return cast_at_part(batch, w, frame, hit.body);
    if (hit.body == w->chosen.ignored || !find_meeting(frame, &w->ray, batch->options->inside, false, &met) ||
        !put_meeting(frame, &w->ray, &met, w->limit_fraction, &hit))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

INLINE bool load_slot_frame(const narc_ray_batch *batch, size_t leaf, unsigned slot, struct body_frame *out) {
    return load_body_frame(batch->shapes, batch->bodies, batch->index->body[NARC_NODE_SLOTS * leaf + slot], out);
}

/* Is the ray done? */
INLINE bool visit_leaf(const narc_ray_batch *batch, struct walk *w, size_t leaf, uint32_t slots, unsigned flips,
                       const float *near) {
    for (; slots; slots &= slots - 1) {
        const unsigned slot = (unsigned)FIND_LOWEST(slots) ^ flips;
        struct body_frame frame;
        if (near[slot] <= w->limit && load_slot_frame(batch, leaf, slot, &frame) &&
            cast_at_slot(batch, w, &frame, leaf, slot, w->chosen.owners != NULL))
            return true;
    }
    return false;
}

INLINE void begin_visits(const narc_index *index, struct visits *visits) {
    visits->count = 1;
    visits->left[0] = (struct visit){0, 0, index->level_count - 1};
}

/* The last one first: it waits longest. */
INLINE void add_visits(const struct visit *parent, uint32_t slots, unsigned flips, const float *near,
                       struct visits *visits) {
    for (; slots; slots &= ~(1u << FIND_HIGHEST(slots))) {
        const unsigned slot = ((unsigned)FIND_HIGHEST(slots)) ^ flips;
        visits->left[visits->count++] =
            (struct visit){near[slot], NARC_NODE_SLOTS * parent->node + slot, parent->level - 1};
    }
}

static void walk_alone(const narc_ray_batch *batch, struct walk *w) {
    const narc_index *const index = batch->index;
    struct visits visits;
    begin_visits(index, &visits);
    while (visits.count > 0) {
        const struct visit visit = visits.left[--visits.count];
        if (visit.near > w->limit)
            continue;
        const size_t node = (size_t)index->first_node[visit.level] + visit.node;
        float near[NARC_NODE_SLOTS + V_WIDTH];
        uint32_t slots = mask_slots(index, node, find_slots(w, &index->nodes[node], near), w->chosen.mask);
        const unsigned flips = narc_find_flips(index->order[node], w->x.backwards, w->y.backwards);
        slots = flip_slots(slots, flips);
        if (visit.level > 0)
            add_visits(&visit, slots, flips, near, &visits);
        else if (visit_leaf(batch, w, node, slots, flips, near))
            return;
    }
}

/* ------------------------------------------------------------------------------------------------ rays together */

static void begin_bundle(struct bundle *b) {
    size_t left = 0, right = 0;
    b->limit = -INFINITY;
    b->mask = 0;
    for (size_t k = 0; k < MOST_TOGETHER; k++) {
        b->limits[k] = -INFINITY;
        b->inverse_x[k] = b->inverse_y[k] = 0;
    }
    for (size_t k = 0; k < b->count; k++) {
        const struct walk *const w = &b->walks[k];
        left = find_cross(b->walks[left].ray.direction, w->ray.direction) > 0 ? k : left;
        right = find_cross(b->walks[right].ray.direction, w->ray.direction) < 0 ? k : right;
        b->limits[k] = w->limit;
        b->inverse_x[k] = w->x.inverse;
        b->inverse_y[k] = w->y.inverse;
        b->limit = w->limit > b->limit ? w->limit : b->limit;
        b->mask |= w->chosen.mask;
    }
    b->left_x = (float)b->walks[left].ray.direction.x;
    b->left_y = (float)b->walks[left].ray.direction.y;
    b->right_x = (float)b->walks[right].ray.direction.x;
    b->right_y = (float)b->walks[right].ray.direction.y;
}

/* A bit for each slot that the wedge may meet, and how far away it is at least: boxes have corners to the left of the
 * rightmost ray and to the right of the leftmost one; which corner decides is known by the quadrant. Boxes are larger by
 * the room on every side, and a cross product errs by less than half of it. */
INLINE uint32_t find_wedge_slots(const struct bundle *b, const narc_index_node *node, float *out_near) {
    const struct walk *const w = &b->walks[0];
    const float *const planes = (const float *)node;
    const bool aslant = w->x.backwards != w->y.backwards;
    const vf zero = v_set(0), limit = v_set(b->limit), right_x = v_set(b->right_x), right_y = v_set(b->right_y);
    const vf outer_x = aslant ? right_x : v_set(b->left_x), outer_y = aslant ? right_y : v_set(b->left_y);
    const vf other_x = aslant ? v_set(b->left_x) : right_x, other_y = aslant ? v_set(b->left_y) : right_y;
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf first_x = v_sub(v_load(planes + w->x.first + k), v_set(w->x.first_start));
        const vf first_y = v_sub(v_load(planes + w->y.first + k), v_set(w->y.first_start));
        const vf last_x = v_sub(v_load(planes + w->x.last + k), v_set(w->x.last_start));
        const vf last_y = v_sub(v_load(planes + w->y.last + k), v_set(w->y.last_start));
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
INLINE uint32_t find_rays(const struct bundle *b, const narc_index_node *node, unsigned slot) {
    const struct walk *const w = &b->walks[0];
    const float *const planes = (const float *)node + slot;
    const vf first_x = v_set(planes[w->x.first] - w->x.first_start),
             last_x = v_set(planes[w->x.last] - w->x.last_start);
    const vf first_y = v_set(planes[w->y.first] - w->y.first_start),
             last_y = v_set(planes[w->y.last] - w->y.last_start);
    uint32_t rays = 0;
    for (size_t k = 0; k < MOST_TOGETHER; k += V_WIDTH) {
        const vf inverse_x = v_load(b->inverse_x + k), inverse_y = v_load(b->inverse_y + k);
        const vf near = v_max(v_max(v_mul(first_x, inverse_x), v_mul(first_y, inverse_y)), v_set(0));
        const vf far = v_mul(v_min(v_mul(last_x, inverse_x), v_mul(last_y, inverse_y)), v_set(1 + ROOM));
        rays |= vm_bits(vm_and(v_le(near, far), v_le(near, v_load(b->limits + k)))) << k;
    }
    return rays;
}

INLINE unsigned find_nearest_slot(uint32_t slots, const float *near) {
    unsigned nearest = (unsigned)FIND_LOWEST(slots);
    while (slots &= slots - 1)
        nearest = near[FIND_LOWEST(slots)] < near[nearest] ? (unsigned)FIND_LOWEST(slots) : nearest;
    return nearest;
}

INLINE void visit_leaf_together(const narc_ray_batch *batch, struct bundle *b, size_t leaf, uint32_t slots,
                                const float *near, bool parts) {
    const narc_index *const index = batch->index;
    unsigned slot;
    for (; slots; slots &= ~(1u << slot)) {
        slot = find_nearest_slot(slots, near);
        uint32_t rays = find_rays(b, &index->nodes[leaf], slot);
        struct body_frame frame;
        if (!rays || !load_slot_frame(batch, leaf, slot, &frame))
            continue;
        for (; rays; rays &= rays - 1) {
            struct walk *const w = &b->walks[FIND_LOWEST(rays)];
            if ((index->masks ? index->masks[NARC_NODE_SLOTS * leaf + slot] : UINT64_MAX) & w->chosen.mask)
                cast_at_slot(batch, w, &frame, leaf, slot, parts);
            b->limits[FIND_LOWEST(rays)] = w->limit;
        }
    }
    b->limit = -INFINITY;
    for (size_t k = 0; k < b->count; k++)
        b->limit = b->limits[k] > b->limit ? b->limits[k] : b->limit;
}

static void walk_together(const narc_ray_batch *batch, struct bundle *b) {
    const narc_index *const index = batch->index;
    const struct walk *const first = &b->walks[0];
    struct visits visits;
    begin_visits(index, &visits);
    begin_bundle(b);
    while (visits.count > 0) {
        const struct visit visit = visits.left[--visits.count];
        if (visit.near > b->limit)
            continue;
        const size_t node = (size_t)index->first_node[visit.level] + visit.node;
        float near[NARC_NODE_SLOTS + V_WIDTH];
        uint32_t slots = mask_slots(index, node, find_wedge_slots(b, &index->nodes[node], near), b->mask);
        const unsigned flips = narc_find_flips(index->order[node], first->x.backwards, first->y.backwards);
        if (visit.level > 0)
            add_visits(&visit, flip_slots(slots, flips), flips, near, &visits);
        else if (batch->options->search.owners)
            visit_leaf_together(batch, b, node, slots, near, true);
        else
            visit_leaf_together(batch, b, node, slots, near, false);
    }
}

/* Walks with all that are gathered. */
static void walk(const narc_ray_batch *batch, struct bundle *b) {
    if (NARC_SHORTCUTS && b->count >= LEAST_TOGETHER)
        walk_together(batch, b);
    else
        for (size_t k = 0; k < b->count; k++)
            walk_alone(batch, &b->walks[k]);
    b->count = 0;
}

/* Does a ray go the way of the first one? Then it begins as that does, if others may join it at all. */
INLINE bool join_first(const struct bundle *b, const struct ray *ray, struct walk *out) {
    const struct walk *const first = &b->walks[0];
    if (b->count == 0 || !b->open || ray->origin.x != first->ray.origin.x || ray->origin.y != first->ray.origin.y ||
        (ray->inverse.x < 0) != first->x.backwards || (ray->inverse.y < 0) != first->y.backwards ||
        !(find_dot(ray->direction, first->ray.direction) > COHERENT))
        return false;
    out->base = 0;
    out->room = first->room;
    out->x = first->x;
    out->y = first->y;
    out->x.inverse = clip_inverse(ray->inverse.x);
    out->y.inverse = clip_inverse(ray->inverse.y);
    return true;
}

/* Rays that start within the scene may go together, if it is not so large that a wedge's numbers overflow. */
static bool is_open(const narc_box *scene, const struct walk *w) {
    const place o = w->ray.origin;
    return (double)scene->min_x <= o.x && o.x <= (double)scene->max_x && (double)scene->min_y <= o.y &&
           o.y <= (double)scene->max_y && w->room <= 0x1p80f;
}

/* Empties a ray's rows and gathers it. False if it has no answer. */
static bool gather(const narc_ray_batch *batch, const narc_box *scene, size_t k, struct bundle *b) {
    narc_ray_hit *const rows = batch->out + k * batch->most;
    struct ray ray;
    float fraction;
    for (size_t i = 0; i < batch->most; i++)
        rows[i] = (narc_ray_hit){.ray = (uint32_t)k};
    if (!read_ray(batch->rays, k, &ray, &fraction))
        return false;
    const bool joins = NARC_SHORTCUTS && join_first(b, &ray, &b->walks[b->count]);
    if (!joins)
        walk(batch, b);
    struct walk *const w = &b->walks[b->count];
    w->ray = ray;
    if (!joins) {
        if (!begin_walk(scene, batch->shapes, w))
            return true;
        b->open = is_open(scene, w) && !batch->options->any; /* which hit is found of any depends on the way */
    }
    w->rows = rows;
    w->found = 0;
    w->chosen = read_chosen(&batch->options->search, k);
    set_limit(w, fraction);
    if (++b->count == MOST_TOGETHER)
        walk(batch, b);
    return true;
}

size_t NARC_NAMED(rays)(const narc_ray_batch *batch, size_t first, size_t count) {
    const bool is_empty = batch->index->level_count == 0;
    const narc_box scene =
        is_empty ? (narc_box){INFINITY, INFINITY, -INFINITY, -INFINITY} : find_scene_box(batch->index);
    size_t skipped = 0;
    struct bundle bundle;
    bundle.count = 0;
    for (size_t k = first; k < first + count; k++)
        skipped += !gather(batch, &scene, k, &bundle);
    walk(batch, &bundle);
    return skipped;
}
