/* SPDX-License-Identifier: MIT
 *
 * things.inl - which bodies a question finds, and which of these are parts of one thing (narc_owners).
 */
#ifndef NARC_SCENE_THINGS_INL
#define NARC_SCENE_THINGS_INL

#include <stdbool.h>
#include <stdint.h>

#include "column.h"
#include "index.h"
#include "simd/simd.h"

/* What one of a question's items leaves out. */
struct chosen {
    const narc_owners *owners; /* NULL: each body is a thing */
    uint64_t mask;
    uint32_t ignored, ignored_owner; /* UINT32_MAX: none */
    narc_world_range worlds;         /* one, or all */
};

INLINE struct chosen read_chosen(const narc_index_query *query, size_t k) {
    const narc_owners *const owners = query->owners;
    const bool one = query->world.base;
    const int32_t world = one ? narc_order_world(narc_index_at(query->world, k)) : INT32_MIN;
    return (struct chosen){owners,
                           query->mask.base ? narc_word_at(query->mask, k) : UINT64_MAX,
                           query->ignored.base ? narc_index_at(query->ignored, k) : UINT32_MAX,
                           owners && owners->ignored.base ? narc_index_at(owners->ignored, k) : UINT32_MAX,
                           {world, one ? world : INT32_MAX}};
}

/* UINT32_MAX: the body is a thing by itself. */
INLINE uint32_t find_owner(const struct chosen *chosen, uint32_t body) {
    return chosen->owners ? narc_index_at(chosen->owners->owner, body) : UINT32_MAX;
}

/* Of a body whose category meets the mask. */
INLINE bool is_chosen(const struct chosen *chosen, uint32_t body) {
    return body != chosen->ignored &&
           (chosen->ignored_owner == UINT32_MAX || find_owner(chosen, body) != chosen->ignored_owner);
}

/* Those of a node's slots, from one on, that have a body of a world that is asked for. */
INLINE vm meet_worlds(const narc_node_worlds *node, int slot, const struct chosen *chosen) {
    const vm behind = vi_lt(vi_set(chosen->worlds.highest), vi_load(node->lowest + slot));
    const vm before = vi_lt(vi_load(node->highest + slot), vi_set(chosen->worlds.lowest));
    return vm_and_not(vm_front(NARC_NODE_SLOTS), vm_or(behind, before));
}

/* Those of a node's slots that mask and world meet. */
INLINE uint32_t mask_slots(const narc_index *index, size_t node, uint32_t slots, const struct chosen *chosen) {
    if (index->worlds) {
        uint32_t meet = 0;
        for (int k = 0; k < NARC_NODE_SLOTS; k += V_WIDTH)
            meet |= (uint32_t)vm_bits(meet_worlds(&index->worlds[node], k, chosen)) << k;
        slots &= meet;
    }
    if (!index->masks)
        return chosen->mask ? slots : 0;
    for (uint32_t bits = slots; bits; bits &= bits - 1) {
        const unsigned slot = (unsigned)FIND_LOWEST(bits);
        slots &= ~((uint32_t) !(index->masks[NARC_NODE_SLOTS * node + slot] & chosen->mask) << slot);
    }
    return slots;
}

#endif
