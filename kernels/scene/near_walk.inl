/* SPDX-License-Identifier: MIT
 *
 * near_walk.inl - the bodies of an index whose boxes are near to a point, at each node the nearest slot first.
 */
#ifndef NARC_SCENE_NEAR_WALK_INL
#define NARC_SCENE_NEAR_WALK_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>
#include <string.h>

#include "base/vec2.inl"
#include "index.h"
#include "scene/body_frame.inl"
#include "scene/things.inl"
#include "simd/simd.h"

/* Boxes and the values that are compared with them leave room for the rounding of separations, so that the answer
 * does not depend on which boxes lie around a body: a separation is within 6 e d + 600 e R of that of the stored
 * arcs, d the distance to the box, R the radius of the smallest circle around the body. A centre is at most 65 R
 * from its middle, and a radius at most 64 R. R is below 0.6 of the box's width and height together. BOX_ROOM is
 * three times that, KEY_ROOM some 20 times: of a square. */
#define BOX_ROOM 0x1p-14f
#define KEY_ROOM 0x1p-16f

/* All separations are less: further away no body has an answer. */
#define FARTHEST 1.5e17f

enum { KEYS = V_WIDTH > NARC_NODE_SLOTS ? V_WIDTH : NARC_NODE_SLOTS, SLOT_BITS = NARC_NODE_SLOTS - 1 };

/* A node on the way, and the keys of its slots, each with the number of its slot in the lowest bits; infinite where
 * there is nothing to look at, or no more. */
struct step {
    float key[KEYS];
    uint32_t node;
};

/* A walk from a point. Who walks may bring the limit nearer. */
struct near_walk {
    const narc_index *index;
    const struct chosen *chosen;
    float x, y, room; /* the point in the index' coordinates, in single precision, and what that may be off by */
    float limit_key;  /* of what is still looked at */
    unsigned level;
    struct step steps[NARC_INDEX_LEVELS];
};

/* Squares keep the order if those of negative values are negative. What is added last is far below any square that a
 * body's size makes, and above what a slot's number makes of 0. */
INLINE float find_limit_key(float separation) {
    const float key = separation * fabsf(separation);
    return key + fabsf(key) * KEY_ROOM + 0x1p-120f;
}

/* Below the key of any separation, and still finite with a slot's number in its lowest bits. */
#define LEAST_KEY (-0x1p126f)

/* Lower bounds of the separations in a node's slots, as keys: within a box the distance to its nearest side, negative,
 * outside the distance to the box; infinite, or NaN, for empty slots and those that are too far away. Of a box that a
 * body far away has made large the square may be more than any float. */
INLINE vf find_keys(const struct near_walk *walk, const narc_index_node *node, int k) {
    const vf zero = v_set(0), at_x = v_set(walk->x), at_y = v_set(walk->y);
    const vf min_x = v_load(node->min_x + k), max_x = v_load(node->max_x + k);
    const vf min_y = v_load(node->min_y + k), max_y = v_load(node->max_y + k);
    const vf size = v_add(v_sub(max_x, min_x), v_sub(max_y, min_y));
    const vf room = v_add(v_mul(size, v_set(BOX_ROOM)), v_set(walk->room));
    const vf x = v_sub(v_max(v_sub(min_x, at_x), v_sub(at_x, max_x)), room);
    const vf y = v_sub(v_max(v_sub(min_y, at_y), v_sub(at_y, max_y)), room);
    const vf depth = v_max(x, y);
    const vec2 outside = {v_max(x, zero), v_max(y, zero)};
    return v_max(v_set(LEAST_KEY), v_select(v_lt(zero, depth), v2_dot(outside, outside), v_neg(v_mul(depth, depth))));
}

INLINE void enter_node(const struct near_walk *walk, unsigned level, uint32_t node, struct step *step) {
    const narc_index *const index = walk->index;
    const size_t at = index->first_node[level] + (size_t)node;
    const vf limit = v_set(walk->limit_key), none = v_set(INFINITY);
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vf key = find_keys(walk, &index->nodes[at], k);
        const vi slot = vi_add(vi_lanes(), vi_set(k)), front = vi_and(vi_bits(key), vi_set(~SLOT_BITS));
        v_store(step->key + k, v_select(v_le(key, limit), v_of_bits(vi_add(front, slot)), none));
    }
    step->node = node;
    const uint32_t slots = mask_slots(index, at, UINT8_MAX, walk->chosen);
    for (unsigned k = 0; k < NARC_NODE_SLOTS && slots != UINT8_MAX; k++)
        if (!(slots >> k & 1))
            step->key[k] = INFINITY;
}

INLINE float find_lower(float a, float b) { return a < b ? a : b; }

/* The least of a node's keys. */
INLINE float find_least_key(const float *key) {
    const float low = find_lower(find_lower(key[0], key[1]), find_lower(key[2], key[3]));
    return find_lower(low, find_lower(find_lower(key[4], key[5]), find_lower(key[6], key[7])));
}

/* False if all boxes are too far away. The index is not empty. */
INLINE bool begin_near_walk(struct near_walk *walk, const narc_index *index, const struct chosen *chosen, place point,
                            float limit_key) {
    const place at = {point.x - index->origin.x, point.y - index->origin.y};
    walk->index = index;
    walk->chosen = chosen;
    walk->x = (float)at.x;
    walk->y = (float)at.y;
    walk->room = (float)((fabs(at.x - (double)walk->x) + fabs(at.y - (double)walk->y)) * 1.001);
    walk->limit_key = limit_key;
    walk->level = index->level_count - 1;
    if (!(fabsf(walk->x) <= FLT_MAX && fabsf(walk->y) <= FLT_MAX))
        return false;
    enter_node(walk, walk->level, 0, &walk->steps[walk->level]);
    return true;
}

/* The next body. False if there is none. */
INLINE bool find_next_near(struct near_walk *walk, uint32_t *out_body) {
    while (walk->level < walk->index->level_count) {
        struct step *const step = &walk->steps[walk->level];
        const float least = find_least_key(step->key);
        if (!(least <= walk->limit_key)) {
            walk->level++;
            continue;
        }
        uint32_t bits;
        memcpy(&bits, &least, sizeof bits);
        const uint32_t slot = bits & SLOT_BITS, below = NARC_NODE_SLOTS * step->node + slot;
        step->key[slot] = INFINITY;
        if (walk->level == 0) {
            *out_body = walk->index->body[below];
            return true;
        }
        walk->level--;
        enter_node(walk, walk->level, below, &walk->steps[walk->level]);
    }
    return false;
}

#endif
