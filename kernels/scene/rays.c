/* SPDX-License-Identifier: MIT
 *
 * rays.c - the kernel of rays: from the root of the index down to the bodies whose boxes a ray meets, nearest first.
 *
 * The lanes are a node's eight slots. A slot's box is met from `near` to `far` along the ray, which are computed in
 * single precision with room, so that nothing is lost that ray_entry.inl would find; then it makes no difference which
 * boxes are met besides, or in which order. Rays that start outside of all boxes are moved to where they meet them
 * first: so the room is in proportion to the scene. A near, a far err by three roundings in proportion, and by the
 * rounding of the start, up to 2^-24 of it.
 */
#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "column.h"
#include "index.h"
#include "kernels.h"
#include "scene/ray_entry.inl"
#include "simd/simd.h"

/* Relative to all that near and far are computed from, eight times their error. */
#define ROOM 0x1p-20f

/* 1 / a direction's component that is less than the inverse counts as this: within the scene the ray moves by less than
 * its room along that axis. */
#define LARGEST_INVERSE 0x1p60f

/* A ray's way along an axis past boxes: the planes that it meets first and last of a node's, as offsets in floats, and
 * the start, moved apart by the room. */
struct axis {
    int first, last;
    float first_start, last_start, inverse;
};

/* What is left to visit: a node, counted within its level, and how far away it is. */
struct visit {
    float near;
    uint32_t node;
    uint32_t level;
};

enum { MOST_VISITS = (NARC_NODE_SLOTS - 1) * NARC_INDEX_LEVELS + 1 };

struct walk {
    struct ray ray;
    struct axis x, y;
    double base; /* where along the ray nears are counted from */
    float room;  /* of a distance */
    float limit; /* no body whose near is above is wanted */
    float limit_fraction;
    bool left, down;
    uint64_t mask;
    uint32_t ignored;
    size_t found;
    narc_ray_hit *rows;
    unsigned count; /* of visits */
    struct visit visits[MOST_VISITS];
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

INLINE struct axis set_axis(int min, int max, double start, double room, double inverse) {
    const bool backwards = inverse < 0;
    const float low = clip_to_float(start - room), high = clip_to_float(start + room);
    const float limit = LARGEST_INVERSE, clipped = (float)find_most((double)-limit, find_least((double)limit, inverse));
    return (struct axis){backwards ? max : min, backwards ? min : max, backwards ? low : high, backwards ? high : low,
                         clipped};
}

/* Nothing further than a fraction of the ray's motion is wanted; what is as far still is. */
INLINE void set_limit(struct walk *w, float fraction) {
    const double distance = (double)fraction * (1 + 0x1p-22) * w->ray.length - w->base;
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

/* Empties a ray's rows, and sets out from the root. False if there is nothing to visit. */
static bool begin_walk(const narc_ray_batch *batch, const narc_box *scene, size_t k, size_t *skipped, struct walk *w) {
    const narc_index_query *const search = &batch->options->search;
    float fraction;
    w->rows = batch->out + k * batch->most;
    for (size_t i = 0; i < batch->most; i++)
        w->rows[i] = (narc_ray_hit){.ray = (uint32_t)k};
    if (!read_ray(batch->rays, k, &w->ray, &fraction)) {
        ++*skipped;
        return false;
    }
    const struct stretch stretch = find_box_stretch(&w->ray, scene);
    if (!(stretch.to >= 0)) /* it is behind, or empty */
        return false;
    w->base = find_least(find_most(stretch.from, 0), DBL_MAX);
    const place start = {w->ray.origin.x + w->base * w->ray.direction.x,
                         w->ray.origin.y + w->base * w->ray.direction.y};
    const double size = find_most(find_most(-(double)scene->min_x, (double)scene->max_x),
                                  find_most(-(double)scene->min_y, (double)scene->max_y));
    const double far = fabs(w->ray.origin.x) + fabs(w->ray.origin.y);
    const double room = (fabs(start.x) + fabs(start.y) + size) * (double)ROOM + far * 0x1p-48;
    w->room = clip_to_float(room);
    w->x = set_axis(offsetof(narc_index_node, min_x) / sizeof(float), offsetof(narc_index_node, max_x) / sizeof(float),
                    start.x, room, w->ray.inverse.x);
    w->y = set_axis(offsetof(narc_index_node, min_y) / sizeof(float), offsetof(narc_index_node, max_y) / sizeof(float),
                    start.y, room, w->ray.inverse.y);
    w->left = w->ray.direction.x < 0;
    w->down = w->ray.direction.y < 0;
    w->mask = search->mask.base ? narc_word_at(search->mask, k) : UINT64_MAX;
    w->ignored = search->ignored.base ? narc_index_at(search->ignored, k) : UINT32_MAX;
    w->found = 0;
    w->count = 1;
    w->visits[0] = (struct visit){0, 0, batch->index->level_count - 1};
    set_limit(w, fraction);
    return true;
}

/* ------------------------------------------------------------------------------------------------ a node */

/* A bit for each slot that the ray meets, and where. */
INLINE uint32_t find_slots(const struct walk *w, const narc_index_node *node, float *out_near) {
    const float *const planes = node->min_x;
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

INLINE void visit_leaf(const narc_ray_batch *batch, struct walk *w, size_t leaf, uint32_t slots, unsigned flips,
                       const float *near) {
    const narc_index *const index = batch->index;
    const narc_index_node *const node = &index->nodes[leaf];
    for (; slots; slots &= slots - 1) {
        const unsigned slot = (unsigned)FIND_LOWEST(slots) ^ flips;
        const uint32_t body = index->body[NARC_NODE_SLOTS * leaf + slot];
        const narc_box box = {node->min_x[slot], node->min_y[slot], node->max_x[slot], node->max_y[slot]};
        narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
        if (near[slot] > w->limit || body == w->ignored ||
            !cast_at_body(batch->shapes, batch->bodies, &w->ray, batch->options->inside, body, &box, w->limit_fraction,
                          &hit))
            continue;
        keep_hit(w, batch->most, &hit);
        if (batch->options->any) {
            w->count = 0;
            return;
        }
    }
}

/* Visits what is next. */
INLINE void step_walk(const narc_ray_batch *batch, struct walk *w) {
    const narc_index *const index = batch->index;
    const struct visit visit = w->visits[--w->count];
    if (visit.near > w->limit)
        return;
    const size_t node = (size_t)index->first_node[visit.level] + visit.node;
    float near[NARC_NODE_SLOTS + V_WIDTH];
    uint32_t slots = find_slots(w, &index->nodes[node], near);
    if (index->masks)
        for (uint32_t bits = slots; bits; bits &= bits - 1) {
            const unsigned slot = (unsigned)FIND_LOWEST(bits);
            slots &= ~((uint32_t) !(index->masks[NARC_NODE_SLOTS * node + slot] & w->mask) << slot);
        }
    else if (!w->mask)
        slots = 0;
    if (!slots)
        return;
    const unsigned flips = narc_find_flips(index->order[node], w->left, w->down);
    slots = flip_slots(slots, flips);
    if (visit.level == 0) {
        visit_leaf(batch, w, node, slots, flips, near);
        return;
    }
    for (; slots; slots &= ~(1u << FIND_HIGHEST(slots))) { /* the last one first: it waits longest */
        const unsigned slot = (unsigned)FIND_HIGHEST(slots) ^ flips;
        w->visits[w->count++] = (struct visit){near[slot], NARC_NODE_SLOTS * visit.node + slot, visit.level - 1};
    }
}

size_t NARC_NAMED(rays)(const narc_ray_batch *batch, size_t first, size_t count) {
    const bool is_empty = batch->index->level_count == 0;
    const narc_box scene =
        is_empty ? (narc_box){INFINITY, INFINITY, -INFINITY, -INFINITY} : find_scene_box(batch->index);
    size_t skipped = 0;
    struct walk walk;
    for (size_t k = first; k < first + count; k++)
        if (begin_walk(batch, &scene, k, &skipped, &walk))
            while (walk.count > 0)
                step_walk(batch, &walk);
    return skipped;
}
