/* SPDX-License-Identifier: MIT
 *
 * regions.c - the kernels of narc_query_index(): the bodies of an index whose boxes meet a query's box, and their
 * order.
 *
 * The tree is walked level by level: of some nodes of a level, all children whose boxes meet the query's box, then
 * theirs. Nodes of one list do not wait for each other, unlike those of a stack. A list that is longer than NODES is
 * taken in parts, each down to the leaves before the next, so that lists are never longer than their memory.
 */
#include <stdbool.h>
#include <stdint.h>

#include "kernels.h"
#include "scene/things.inl"
#include "simd/simd.h"

/* Nodes that are taken from a list in one go. */
enum { NODES = 16 };
_Static_assert((int)NARC_REGION_ROOM >= NODES * NARC_NODE_SLOTS + 16, "what so many leaves hold, and a vector");

/* What a query asks, in vectors and out of them. */
struct region {
    vf min_x, min_y, max_x, max_y;
    struct chosen chosen;
};

INLINE vm meet_slots(const struct region *region, const narc_index_node *node, int slot) {
    const vm in_x =
        vm_and(v_le(v_load(node->min_x + slot), region->max_x), v_le(region->min_x, v_load(node->max_x + slot)));
    const vm in_y =
        vm_and(v_le(v_load(node->min_y + slot), region->max_y), v_le(region->min_y, v_load(node->max_y + slot)));
    return vm_and(vm_and(in_x, in_y), vm_front(NARC_NODE_SLOTS));
}

/* Appends those lanes of `items` that hold; writes a whole vector. */
INLINE uint32_t *append(uint32_t *to, vm hit, vi items) {
    v_store((float *)(void *)to, v_pack(vm_packing(hit), v_of_bits(items)));
    return to + COUNT_BITS(vm_bits(hit));
}

/* Of a node's slots, from one on, those that mask and world meet. */
INLINE vm match_slots(const narc_index *index, size_t node, int slot, vm hit, const struct chosen *chosen) {
    int32_t fine[V_WIDTH] = {0};
    if (index->worlds)
        hit = vm_and(hit, meet_worlds(&index->worlds[node], slot, chosen));
    if (!index->masks)
        return hit;
    for (uint32_t bits = vm_bits(hit); bits > 0; bits &= bits - 1) {
        const int lane = FIND_LOWEST(bits);
        fine[lane] = (index->masks[NARC_NODE_SLOTS * node + (size_t)(slot + lane)] & chosen->mask) != 0;
    }
    return vm_and(hit, vi_lt(vi_set(0), vi_load(fine)));
}

/* Of some bodies those that are not ignored. */
INLINE vm leave_out(const struct chosen *chosen, vm hit, vi body) {
    const vi ignored = vi_set((int32_t)chosen->ignored);
    hit = vm_and(hit, vm_or(vi_lt(body, ignored), vi_lt(ignored, body)));
    if (chosen->ignored_owner == UINT32_MAX)
        return hit;
    int32_t bodies[V_WIDTH], fine[V_WIDTH] = {0};
    vi_store(bodies, body);
    for (uint32_t bits = vm_bits(hit); bits > 0; bits &= bits - 1) {
        const int lane = FIND_LOWEST(bits);
        fine[lane] = is_chosen(chosen, (uint32_t)bodies[lane]);
    }
    return vm_and(hit, vi_lt(vi_set(0), vi_load(fine)));
}

/* Appends the children of nodes list[0 .. count - 1] of a level, or the bodies of leaves, whose boxes meet the
 * region. */
INLINE uint32_t *visit(const narc_index *index, unsigned level, const struct region *region, bool masked, bool ignores,
                       const uint32_t *list, size_t count, uint32_t *to) {
    const narc_index_node *const nodes = index->nodes + index->first_node[level];
    for (size_t k = 0; k < count; k++)
        for (int slot = 0; slot < NARC_NODE_SLOTS; slot += V_WIDTH) {
            const size_t below = (size_t)list[k] * NARC_NODE_SLOTS + (size_t)slot;
            vm hit = meet_slots(region, &nodes[list[k]], slot);
            if (masked)
                hit = match_slots(index, (size_t)index->first_node[level] + list[k], slot, hit, &region->chosen);
            vi item = vi_add(vi_set((int32_t)(uint32_t)below), vi_lanes());
            if (level == 0) {
                item = vi_load((const int32_t *)(const void *)(index->body + below));
                if (ignores)
                    hit = leave_out(&region->chosen, hit, item);
            }
            to = append(to, hit, item);
        }
    return to;
}

INLINE void find_bodies(const narc_index *index, const struct region *region, bool masked, bool ignores,
                        narc_found_bodies *out) {
    /* Of each level but the highest a list. */
    uint32_t lists[NARC_INDEX_LEVELS][NODES * NARC_NODE_SLOTS + 16];
    uint32_t from[NARC_INDEX_LEVELS], end[NARC_INDEX_LEVELS];
    const unsigned top = index->level_count - 1;
    unsigned level = top;
    lists[top][0] = 0;
    from[top] = 0;
    end[top] = 1;
    for (;;) {
        const uint32_t *const list = lists[level] + from[level];
        const uint32_t left = end[level] - from[level], count = left < NODES ? left : NODES;
        from[level] += count;
        if (count == 0) {
            if (level == top)
                return;
            level++;
        } else if (level > 0) {
            uint32_t *const to = lists[level - 1];
            end[level - 1] = (uint32_t)(visit(index, level, region, masked, ignores, list, count, to) - to);
            from[--level] = 0;
        } else {
            if (out->room - out->count < NARC_REGION_ROOM)
                out->get_room(out);
            uint32_t *const to = out->body + out->count;
            out->count += (size_t)(visit(index, 0, region, masked, ignores, list, count, to) - to);
        }
    }
}

void NARC_NAMED(regions)(const narc_region_batch *batch, size_t first, size_t count, narc_found_bodies *out) {
    const narc_index *const index = batch->index;
    const narc_owners *const owners = batch->query->owners;
    const bool masked = index->masks || index->worlds;
    const bool ignores = batch->query->ignored.base || (owners && owners->ignored.base);
    for (size_t k = first; k < first + count; k++) {
        const narc_box *const box = &batch->boxes[k];
        const struct chosen chosen = read_chosen(batch->query, k);
        if (narc_is_full_box(box) && chosen.mask != 0) {
            const struct region region = {v_set(box->min_x), v_set(box->min_y), v_set(box->max_x), v_set(box->max_y),
                                          chosen};
            if (masked)
                find_bodies(index, &region, true, true, out);
            else if (ignores)
                find_bodies(index, &region, false, true, out);
            else
                find_bodies(index, &region, false, false, out);
        }
        out->end_query(out);
    }
}

/* ------------------------------------------------------------------------------------------------ order */

/* The place of a body is the number of those below it, in the sign of a difference: bodies are below 2^31. */
INLINE void find_places(const uint32_t *bodies, size_t count, size_t first, int vectors, uint32_t *out) {
    vi own[4], place[4];
    UNROLL
    for (int i = 0; i < vectors; i++) {
        own[i] = vi_load((const int32_t *)(const void *)(bodies + first) + i * V_WIDTH);
        place[i] = vi_set(0);
    }
    for (size_t k = 0; k < count; k++) {
        const vi other = vi_set((int32_t)bodies[k]);
        UNROLL
        for (int i = 0; i < vectors; i++)
            place[i] = vi_add(place[i], vi_shift_right(vi_sub(other, own[i]), 31));
    }
    int32_t to[4 * V_WIDTH];
    UNROLL
    for (int i = 0; i < vectors; i++)
        vi_store(to + i * V_WIDTH, place[i]);
    const size_t left = count - first, n = (size_t)vectors * V_WIDTH;
    for (size_t k = 0; k < n && k < left; k++)
        out[to[k]] = bodies[first + k];
}

void NARC_NAMED(order)(const uint32_t *bodies, size_t count, uint32_t *out) {
    size_t first = 0;
    for (; count - first > 2 * V_WIDTH && first < count; first += 4 * V_WIDTH)
        find_places(bodies, count, first, 4, out);
    if (first < count && count - first > V_WIDTH)
        find_places(bodies, count, first, 2, out);
    else if (first < count)
        find_places(bodies, count, first, 1, out);
}
