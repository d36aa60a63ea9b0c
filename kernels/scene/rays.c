/* SPDX-License-Identifier: MIT
 *
 * rays.c - the kernel of rays: reads them, and sends them through the index, those that have company together (ray_fans.c) and
 * the others alone, several in turn.
 *
 * The lanes are a node's eight slots. A slot's box is met from `near` to `far` along the ray, which are computed in
 * single precision with room, so that nothing is lost that ray_entry.inl would find; then it makes no difference which
 * boxes are met besides, in which order, and how large they are. A near, a far err by three roundings in proportion, and
 * by the rounding of the start, up to 2^-24 of it.
 */
#define NARC_EIGHT_LANES

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "index.h"
#include "kernels.h"
#include "scene/part_walk.inl"
#include "scene/ray_entry.inl"
#include "scene/ray_features.inl"
#include "scene/ray_reading.inl"
#include "scene/ray_walk.inl"
#include "scene/things.inl"
#include "simd/simd.h"

/* Do rays without company take steps in turn? In the module for WebAssembly that takes too much room. */
#if defined(__wasm__)
#define TAKES_TURNS 0
#else
#define TAKES_TURNS (NARC_SHORTCUTS && V_WIDTH > 1)
#endif

/* Of each set of slots and each flips: bit k becomes bit k ^ flips. Sets of more slots are those of fewer, without a slot
 * and with it. */
#define FLIP(k, f)       | 1 << ((k) ^ (f))
#define SETS_2(set, f)   set, set FLIP(0, f)
#define SETS_4(set, f)   SETS_2(set, f), SETS_2(set FLIP(1, f), f)
#define SETS_8(set, f)   SETS_4(set, f), SETS_4(set FLIP(2, f), f)
#define SETS_16(set, f)  SETS_8(set, f), SETS_8(set FLIP(3, f), f)
#define SETS_32(set, f)  SETS_16(set, f), SETS_16(set FLIP(4, f), f)
#define SETS_64(set, f)  SETS_32(set, f), SETS_32(set FLIP(5, f), f)
#define SETS_128(set, f) SETS_64(set, f), SETS_64(set FLIP(6, f), f)
#define ALL_SETS(f)                                                                                                    \
    { SETS_128(0, f), SETS_128(0 FLIP(7, f), f) }
const uint8_t NARC_NAMED(flipped_slots)[8][256] = {ALL_SETS(0), ALL_SETS(1), ALL_SETS(2), ALL_SETS(3),
                                                   ALL_SETS(4), ALL_SETS(5), ALL_SETS(6), ALL_SETS(7)};

/* ------------------------------------------------------------------------------------------------ hits */

static float clip_to_float(double a) { return (float)find_most(-(double)FLT_MAX, find_least((double)FLT_MAX, a)); }

/* Nothing further than a fraction of the ray's motion is wanted; what is as far still is, also up to rounding of fractions
 * that underflow. */
INLINE void set_limit(struct walk *w, float fraction) {
    const double distance = ((double)fraction * (1 + 0x1p-22) + 0x1p-149) * w->ray.length - w->base;
    w->limit_fraction = fraction;
    w->limit = clip_to_float(distance + fabs(distance) * (double)ROOM + (double)w->room);
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

/* Casts a ray at a part: it has a row if none of its thing is before it. Of a thing that the ray starts in, that of its end, or
 * none. Is it done? */
NOINLINE bool cast_at_part(const narc_ray_batch *batch, struct walk *w, struct body_frame frame, uint32_t body) {
    const narc_inside inside = batch->options->inside;
    const uint32_t owner = find_owner(&w->chosen, body);
    const bool is_part = owner != UINT32_MAX, goes_out = is_part && inside != NARC_INSIDE_STOPS;
    narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
    struct meeting met;
    if (!is_chosen(&w->chosen, body) ||
        !find_meeting(&frame, &w->ray, goes_out ? NARC_INSIDE_LEAVES : inside, false, &met))
        return false;
    const bool leaves = goes_out && met.is_within;
    if ((leaves && inside == NARC_INSIDE_IGNORES) ||
        !put_meeting(&frame, &w->ray, &met, leaves ? INFINITY : w->limit_fraction, &hit) ||
        (leaves ? !leave_thing(batch, w, owner, met.distance, &hit) : goes_out && starts_in(batch, w, owner)) ||
        (is_part && !replace_row(w, owner, &hit)))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

/* ------------------------------------------------------------------------------------------------ a body */

bool NARC_NAMED(cast_at_frame)(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame,
                               uint32_t body) {
    narc_ray_hit hit = {.ray = w->rows->ray, .body = body, .count = 1};
    struct meeting met;
    if (w->chosen.owners)
        return cast_at_part(batch, w, *frame, body);
    if (body == w->chosen.ignored || !find_meeting(frame, &w->ray, batch->options->inside, false, &met) ||
        !put_meeting(frame, &w->ray, &met, w->limit_fraction, &hit))
        return false;
    keep_hit(w, batch->most, &hit);
    return batch->options->any;
}

INLINE bool cast_at_body(const narc_ray_batch *batch, struct walk *w, uint32_t body) {
    struct body_frame frame;
    return load_body_frame(batch->shapes, batch->bodies, body, &frame) &&
           NARC_NAMED(cast_at_frame)(batch, w, &frame, body);
}

/* ------------------------------------------------------------------------------------------------ a ray alone */

/* What an axis is, in all lanes; a far has room. */
struct axis_lanes {
    vf first_start, last_start, inverse, far_inverse;
};

INLINE struct axis_lanes get_axis_lanes(const struct axis *axis) {
    return (struct axis_lanes){v_set(axis->first_start), v_set(axis->last_start), v_set(axis->inverse),
                               v_set(axis->inverse * (1 + ROOM))};
}

/* A bit for each slot that the ray meets, and where. */
INLINE uint32_t find_slots(const struct walk *w, struct axis_lanes x, struct axis_lanes y, const narc_index_node *node,
                           float *out_near) {
    const float *const planes = (const float *)node;
    const vf limit = v_set(w->limit);
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf near_x = v_mul(v_sub(v_load_8(planes + w->x.first + k), x.first_start), x.inverse);
        const vf near_y = v_mul(v_sub(v_load_8(planes + w->y.first + k), y.first_start), y.inverse);
        const vf far_x = v_mul(v_sub(v_load_8(planes + w->x.last + k), x.last_start), x.far_inverse);
        const vf far_y = v_mul(v_sub(v_load_8(planes + w->y.last + k), y.last_start), y.far_inverse);
        const vf near = v_max(near_x, near_y), far = v_min(far_x, far_y);
        v_store(out_near + k, near);
        slots |= vm_bits(vm_and(vm_and(v_le(v_set(0), far), v_le(near, limit)), v_le(near, far))) << k;
    }
    return slots;
}

/* Casts a ray at the body in a leaf's slot. Is it done? */
INLINE bool visit_slot(const narc_ray_batch *batch, struct walk *w, struct descent *d, uint32_t number) {
    const float limit = w->limit;
    if (cast_at_body(batch, w, batch->index->body[number]))
        return true;
    if (w->limit < limit)
        drop_slots(d, w->limit);
    return false;
}

/* Visits a node of a level, and goes on below it, as go_below(). */
INLINE bool visit_node(const narc_index *index, const struct walk *w, struct axis_lanes x, struct axis_lanes y,
                       unsigned *level, uint32_t *below, struct descent *d) {
    const size_t node = (size_t)index->first_node[*level] + *below;
    const uint32_t slots = find_slots(w, x, y, &index->nodes[node], d->near[*level]);
    return go_below(d, level, below, w->is_masked ? mask_slots(index, node, slots, &w->chosen) : slots,
                    narc_find_flips(index->order[node], w->left, w->aslant));
}

NOINLINE void walk_alone(const narc_ray_batch *batch, struct walk *w) {
    struct descent d;
    const struct axis_lanes x = get_axis_lanes(&w->x), y = get_axis_lanes(&w->y);
    unsigned level = batch->index->level_count - 1;
    uint32_t below = 0;
    d.left = d.above = 0;
    for (; visit_node(batch->index, w, x, y, &level, &below, &d); level--)
        while (level == 0)
            if (visit_slot(batch, w, &d, below) || !take_slot(&d, &level, &below))
                return;
}

/* ------------------------------------------------------------------------------------------------ rays side by side */

/* Rays that each go their own way take a step in turn, so that the processor need not wait for one. */
enum { UNDER_WAY = 16 };

struct stepper {
    struct walk walk;
    struct descent d;
    unsigned level; /* of the node to visit, and one more; 0: of the body */
    uint32_t below;
};

/* Rays that have no company. */
struct loners {
    const struct read_rays *rays;
    size_t next, count;
    uint8_t number[READ];
};

/* The next one begins. False if there is none. */
INLINE bool begin_steps(const narc_ray_batch *batch, struct loners *loners, struct stepper *out) {
    if (loners->next == loners->count)
        return false;
    begin_walk(batch, loners->rays, loners->number[loners->next++], &out->walk);
    out->d.left = out->d.above = 0;
    out->below = 0;
    out->level = batch->index->level_count;
    return true;
}

NOINLINE void walk_apart(const narc_ray_batch *batch, struct loners *loners) {
    struct stepper steppers[UNDER_WAY], *at_node[UNDER_WAY], *at_body[UNDER_WAY];
    size_t node_count = 0, body_count;
    for (; node_count < UNDER_WAY && begin_steps(batch, loners, &steppers[node_count]); node_count++)
        at_node[node_count] = &steppers[node_count];
    while (node_count > 0) {
        body_count = 0;
        const size_t nodes = node_count;
        node_count = 0;
        for (size_t k = 0; k < nodes; k++) {
            struct stepper *const s = at_node[k];
            s->level--;
            if (!visit_node(batch->index, &s->walk, get_axis_lanes(&s->walk.x), get_axis_lanes(&s->walk.y), &s->level,
                            &s->below, &s->d) &&
                !begin_steps(batch, loners, s))
                continue;
            at_node[node_count] = at_body[body_count] = s;
            node_count += s->level > 0;
            body_count += s->level == 0;
        }
        for (size_t k = 0; k < body_count; k++) {
            struct stepper *const s = at_body[k];
            bool goes_on;
            do {
                goes_on = !visit_slot(batch, &s->walk, &s->d, s->below) && take_slot(&s->d, &s->level, &s->below);
            } while (goes_on && s->level == 0);
            if (goes_on || begin_steps(batch, loners, s))
                at_node[node_count++] = s;
        }
    }
}

static void walk_one_by_one(const narc_ray_batch *batch, struct loners *loners) {
    struct walk w;
    while (loners->next < loners->count) {
        begin_walk(batch, loners->rays, loners->number[loners->next++], &w);
        walk_alone(batch, &w);
    }
}

/* ------------------------------------------------------------------------------------------------ all */

/* Empties a ray's rows, one at least. Has it an answer? */
INLINE bool empty_rows(const narc_ray_batch *batch, const struct read_rays *rays, size_t k) {
    narc_ray_hit *row = get_rows(batch, rays, k), *const end = row + batch->most;
    do {
        *row++ = (narc_ray_hit){.ray = rays->number[k]};
    } while (row < end);
    return rays->length[k] > 0;
}

/* Casts rays that are read; how many have no answer? */
static size_t cast_rays(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays) {
    struct loners loners;
    size_t skipped = 0;
    loners.rays = rays;
    loners.next = loners.count = 0;
    for (size_t k = 0; k < rays->count; k++)
        skipped += !empty_rows(batch, rays, k);
    for (size_t k = 0, count; k < rays->count; k += count) {
        count = 1;
        if (!(rays->length[k] > 0) || rays->base[k] < 0)
            continue;
        count = NARC_NAMED(cast_fan)(batch, scene, rays, k);
        if (count >= LEAST_TOGETHER)
            continue;
        for (size_t i = k; i < k + count; i++)
            loners.number[loners.count++] = (uint8_t)i;
    }
    if (TAKES_TURNS && loners.count >= LEAST_TOGETHER)
        walk_apart(batch, &loners);
    else
        walk_one_by_one(batch, &loners);
    return skipped;
}

/* A ray by itself; has it no answer? */
static bool cast_one_ray(const narc_ray_batch *batch, const narc_box *scene, size_t k, struct read_rays *rays) {
    struct walk w;
    read_rays(batch, scene, k, 1, rays);
    if (!empty_rows(batch, rays, 0))
        return true;
    if (rays->base[0] >= 0) {
        begin_walk(batch, rays, 0, &w);
        walk_alone(batch, &w);
    }
    return false;
}

size_t NARC_NAMED(rays)(const narc_ray_batch *batch, size_t first, size_t count) {
    const narc_box scene = batch->index->box;
    size_t skipped = 0;
    struct read_rays rays;
    if (count == 1)
        return cast_one_ray(batch, &scene, first, &rays);
    for (size_t k = first; k < first + count; k += READ) {
        const size_t left = first + count - k;
        read_rays(batch, &scene, k, left < READ ? left : READ, &rays);
        skipped += cast_rays(batch, &scene, &rays);
    }
    return skipped;
}
