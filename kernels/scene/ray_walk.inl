/* SPDX-License-Identifier: MIT
 *
 * ray_walk.inl - the way of a ray, or of some that go together, from the root of the index down to the bodies whose boxes it
 * meets, nearest first.
 */
#ifndef NARC_SCENE_RAY_WALK_INL
#define NARC_SCENE_RAY_WALK_INL

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "index.h"
#include "kernels.h"
#include "scene/ray_features.inl"
#include "scene/ray_reading.inl"
#include "scene/things.inl"
#include "simd/simd.h"

/* Fewer rays than that do not go together. */
enum { LEAST_TOGETHER = 4 };

/* A ray's way along an axis past boxes: the planes that it meets first and last of a node's, as offsets in floats, and
 * the start, moved apart by the room. */
struct axis {
    size_t first, last;
    float first_start, last_start, inverse;
};

#define PLANE(name) (offsetof(narc_index_node, name) / sizeof(float))

/* Where a walk is: of each level its node, counted within it, and how far away the slots are. All that is left to visit is
 * a bit, eight for each level, of slot ^ flips: the lowest is the next. */
struct descent {
    uint64_t left, above;
    uint32_t node[NARC_INDEX_LEVELS];
    unsigned flips[NARC_INDEX_LEVELS];
    float near[NARC_INDEX_LEVELS][NARC_NODE_SLOTS > V_WIDTH ? NARC_NODE_SLOTS : V_WIDTH];
};

/* A ray, and what is known of its hits. */
struct walk {
    struct ray ray;
    struct axis x, y;
    unsigned left, aslant; /* see narc_find_flips() */
    double base;           /* where along the ray nears are counted from */
    float room;            /* of a distance */
    float limit;           /* no body whose near is above is wanted */
    float limit_fraction;
    struct chosen chosen;
    size_t found;
    narc_ray_hit *rows;
    bool is_masked; /* by worlds or categories */
};

/* ------------------------------------------------------------------------------------------------ a ray begins */

/* Planes of greatest coordinates lie so many floats behind those of the least. */
enum { PLANES_APART = PLANE(max_x) - PLANE(min_x) };

INLINE struct axis get_axis(const struct read_axis *axis, size_t k, bool backwards, size_t min) {
    const size_t first = min + PLANES_APART * backwards;
    return (struct axis){first, 2 * min + PLANES_APART - first, axis->first_start[k], axis->last_start[k],
                         axis->inverse[k]};
}

/* The k-th of them; its rows are empty. */
INLINE void begin_walk(const narc_ray_batch *batch, const struct read_rays *rays, size_t k, struct walk *w) {
    w->ray = (struct ray){{rays->origin_x[k], rays->origin_y[k]},
                          {rays->direction_x[k], rays->direction_y[k]},
                          rays->length[k],
                          rays->inverse_length[k]};
    const bool left = rays->x.inverse[k] < 0, down = rays->y.inverse[k] < 0;
    w->x = get_axis(&rays->x, k, left, PLANE(min_x));
    w->y = get_axis(&rays->y, k, down, PLANE(min_y));
    w->left = left ? 7 : 0;
    w->aslant = left != down ? 7 : 0;
    w->base = rays->base[k];
    w->room = rays->room[k];
    w->chosen = read_chosen(&batch->options->search, rays->number[k]);
    w->is_masked = batch->index->worlds || batch->index->masks || w->chosen.mask == 0;
    w->found = 0;
    w->rows = get_rows(batch, rays, k);
    w->limit = rays->limit[k];
    w->limit_fraction = rays->fraction[k];
}

/* ------------------------------------------------------------------------------------------------ a node */

/* Of each set of slots and each flips: bit k becomes bit k ^ flips (rays.c). */
extern const uint8_t NARC_NAMED(flipped_slots)[8][256];

/* The next slot that is left, its level, and what is below it: a node, or of a leaf a body. False if there is none. */
INLINE bool take_slot(struct descent *d, unsigned *level, uint32_t *below) {
    unsigned bit;
    if (d->left) {
        bit = (unsigned)FIND_LOWEST_64(d->left);
        d->left &= d->left - 1;
    } else {
        if (d->above == 0)
            return false;
        bit = 64 + (unsigned)FIND_LOWEST_64(d->above);
        d->above &= d->above - 1;
    }
    *level = bit >> 3;
    *below = NARC_NODE_SLOTS * d->node[*level] + ((bit & 7) ^ d->flips[*level]);
    return true;
}

/* Takes the first of a node's slots that are to be visited, and leaves the others; or as take_slot(). */
INLINE bool go_below(struct descent *d, unsigned *level, uint32_t *below, uint32_t slots, unsigned flips) {
    const uint32_t ordered = NARC_NAMED(flipped_slots)[flips][slots], node = *below;
    if (ordered == 0)
        return take_slot(d, level, below);
    const uint64_t left = (uint64_t)(ordered & (ordered - 1)) << 8 * (*level & 7);
    d->node[*level] = node;
    d->flips[*level] = flips;
    if (*level < 8)
        d->left |= left;
    else
        d->above |= left;
    *below = NARC_NODE_SLOTS * node + ((unsigned)FIND_LOWEST(ordered) ^ flips);
    return true;
}

/* Of slots that are left, from a level up: those that are no further than a limit. */
INLINE uint64_t keep_slots(const struct descent *d, uint64_t left, unsigned level, float limit) {
    uint64_t kept = left;
    for (unsigned at; left; left &= ~((uint64_t)0xff << at)) {
        at = (unsigned)FIND_LOWEST_64(left) & ~7u;
        const unsigned number = level + at / 8;
        uint32_t far = 0;
        for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH)
            far |= vm_bits(v_lt(v_set(limit), v_load_8(d->near[number] + k))) << k;
        kept &= ~((uint64_t)NARC_NAMED(flipped_slots)[d->flips[number]][far & 0xff] << at);
    }
    return kept;
}

/* Leaves out what is further than a limit that has become less. */
INLINE void drop_slots(struct descent *d, float limit) {
    d->left = keep_slots(d, d->left, 0, limit);
    d->above = keep_slots(d, d->above, 8, limit);
}

/* Casts a ray at a body (rays.c). Is it done? */
bool NARC_NAMED(cast_at_frame)(const narc_ray_batch *batch, struct walk *w, const struct body_frame *frame,
                               uint32_t body);

/* Rays from `first` on that go together, cast if they are LEAST_TOGETHER (ray_fans.c); how many are they? */
size_t NARC_NAMED(cast_fan)(const narc_ray_batch *batch, const narc_box *scene, struct read_rays *rays, size_t first);

#endif
