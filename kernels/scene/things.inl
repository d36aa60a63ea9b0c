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
    const uint32_t world = query->world.base ? narc_index_at(query->world, k) : 0;
    return (struct chosen){owners,
                           query->mask.base ? narc_word_at(query->mask, k) : UINT64_MAX,
                           query->ignored.base ? narc_index_at(query->ignored, k) : UINT32_MAX,
                           owners && owners->ignored.base ? narc_index_at(owners->ignored, k) : UINT32_MAX,
                           {world, query->world.base ? world : UINT32_MAX}};
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

/* Those of a node's slots that mask and world meet. */
INLINE uint32_t mask_slots(const narc_index *index, size_t node, uint32_t slots, const struct chosen *chosen) {
    for (uint32_t bits = index->worlds ? slots : 0; bits; bits &= bits - 1) {
        const unsigned slot = (unsigned)FIND_LOWEST(bits);
        const narc_world_range *const own = &index->worlds[NARC_NODE_SLOTS * node + slot];
        const bool meets = own->lowest <= chosen->worlds.highest && chosen->worlds.lowest <= own->highest;
        slots &= ~((uint32_t)!meets << slot);
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
