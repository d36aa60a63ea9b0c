/* SPDX-License-Identifier: MIT
 *
 * part_walk.inl - the parts of one thing near a place, and how far they are from it.
 */
#ifndef NARC_SCENE_PART_WALK_INL
#define NARC_SCENE_PART_WALK_INL

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "index.h"
#include "scene/body_frame.inl"
#include "scene/things.inl"
#include "simd/simd.h"

/* Goes through the parts of a thing whose boxes come near to a place. */
struct part_walk {
    const narc_index *index;
    const struct chosen *chosen;
    uint32_t owner;
    float min_x, min_y, max_x, max_y;
    unsigned level;
    uint32_t node[NARC_INDEX_LEVELS], slots[NARC_INDEX_LEVELS]; /* of each level: where it is, and what is left there */
};

INLINE void enter_part_node(struct part_walk *w, unsigned level, uint32_t node) {
    const size_t at = (size_t)w->index->first_node[level] + node;
    const narc_index_node *const boxes = &w->index->nodes[at];
    uint32_t slots = 0;
    for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH) {
        const vm in_x =
            vm_and(v_le(v_load(boxes->min_x + k), v_set(w->max_x)), v_le(v_set(w->min_x), v_load(boxes->max_x + k)));
        const vm in_y =
            vm_and(v_le(v_load(boxes->min_y + k), v_set(w->max_y)), v_le(v_set(w->min_y), v_load(boxes->max_y + k)));
        slots |= vm_bits(vm_and(in_x, in_y)) << k;
    }
    w->level = level;
    w->node[level] = node;
    w->slots[level] = mask_slots(w->index, at, slots & ((1u << NARC_NODE_SLOTS) - 1), w->chosen);
}

/* Boxes no further than `reach` from the place, which is one in the world. The index is not empty. */
INLINE struct part_walk begin_part_walk(const narc_index *index, const struct chosen *chosen, uint32_t owner, place at,
                                        double reach) {
    at = (place){at.x - index->origin.x, at.y - index->origin.y};
    const double room = reach + (fabs(at.x) + fabs(at.y)) * 0x1p-22;
    struct part_walk w = {.index = index, .chosen = chosen, .owner = owner};
    w.min_x = (float)find_most(-(double)FLT_MAX, at.x - room);
    w.min_y = (float)find_most(-(double)FLT_MAX, at.y - room);
    w.max_x = (float)find_least((double)FLT_MAX, at.x + room);
    w.max_y = (float)find_least((double)FLT_MAX, at.y + room);
    enter_part_node(&w, index->level_count - 1, 0);
    return w;
}

/* The next part, and its frame. False if there is none. */
NOINLINE bool find_next_part(struct part_walk *w, const narc_shapes *shapes, const narc_bodies *bodies,
                             uint32_t *out_body, struct body_frame *out) {
    const unsigned top = w->index->level_count - 1;
    while (w->level <= top) {
        uint32_t *const slots = &w->slots[w->level];
        if (*slots == 0) {
            w->level++;
            continue;
        }
        const uint32_t below = NARC_NODE_SLOTS * w->node[w->level] + (uint32_t)FIND_LOWEST(*slots);
        *slots &= *slots - 1;
        if (w->level > 0) {
            enter_part_node(w, w->level - 1, below);
            continue;
        }
        *out_body = w->index->body[below];
        if (find_owner(w->chosen, *out_body) == w->owner && is_chosen(w->chosen, *out_body) &&
            load_body_frame(shapes, bodies, *out_body, out))
            return true;
    }
    return false;
}

/* How far a point, in a shape's coordinates, is from a shape; negative within it. As point_rows.inl has it, in double
 * precision. */
INLINE double find_depth_in(const struct body_frame *frame, place point) {
    double most = -INFINITY;
    for (int k = 0; k < (int)frame->header->count; k++) {
        const narc_stored_arc *const arc = &frame->arcs[k].arc;
        const place u = {point.x - (double)arc->center_x, point.y - (double)arc->center_y};
        const place start = {(double)arc->start_x, (double)arc->start_y},
                    end = {(double)arc->end_x, (double)arc->end_y};
        const bool holds = find_cross(start, u) >= 0 && find_cross(u, end) >= 0;
        const double reach = holds ? sqrt(find_dot(u, u)) : find_most(find_dot(u, start), find_dot(u, end));
        most = find_most(most, reach - (double)arc->radius);
    }
    return most;
}

INLINE place find_place_in(const struct body_frame *frame, place point) {
    const place from = {point.x - frame->position.x, point.y - frame->position.y};
    const place turned = turn_to_shape(frame, from);
    return (place){turned.x * frame->inverse_scale, turned.y * frame->inverse_scale};
}

/* So near parts count as connected: NARC_ERROR_BOUND times their extent, or twice that, in the world's unit. */
INLINE double find_seam(const struct body_frame *frame) {
    const double ratio = frame->header->extent_ratio < UINT8_MAX ? (double)frame->header->extent_ratio : 1;
    return 32.0 / 16777216.0 * ratio * (double)frame->header->bound_radius * frame->scale;
}

#endif
