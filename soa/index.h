/* SPDX-License-Identifier: MIT
 *
 * index.h - the layout of an index, as the kernels read it. Internal.
 *
 * A tree without pointers. LEAVES are nodes of level 0 and have eight slots for bodies; eight nodes that follow
 * each other in a level are the children of one node of the next, in their order; the last level has one node, the
 * root. So child `slot` of node i of a level is node 8 i + slot of the level below, and body 8 i + slot of a leaf is
 * narc_index.body[8 i + slot]. A quarter of all slots are free, evenly, unless an index is built fast, so that bodies may go to
 * other leaves; where some nodes are too full, or too much of what is below one has come later, its bodies are spread
 * over its slots anew.
 *
 * Slots are what three halvings of a node make: bit 2 of a slot's number says in which half it is by the first one, bit
 * 1 by the second, bit 0 by the third. For each bit `order` of the node says along which axis the halves lie, and
 * whether the half with the bit 0 lies lower there. So a ray meets the slots roughly in the order of slot ^ flips, with
 * flips of its direction's quadrant, and nothing is sorted on the way.
 */
#ifndef NARC_INDEX_H
#define NARC_INDEX_H

#include <float.h>
#include <math.h>
#include <stdbool.h>

#include "narc_scene.h"

enum { NARC_NODE_SLOTS = 8, NARC_INDEX_LEVELS = 11 };

/* The boxes of a node's slots. A slot without anything has the empty box. Kernels with wider vectors read on in the
 * node, and behind the last one up to NARC_NODE_PADDING floats. */
typedef struct narc_index_node {
    float min_x[NARC_NODE_SLOTS], min_y[NARC_NODE_SLOTS], max_x[NARC_NODE_SLOTS], max_y[NARC_NODE_SLOTS];
} narc_index_node;

enum { NARC_NODE_PADDING = 16 };

/* A box that is not empty. False for NaN too. */
static inline bool narc_is_full_box(const narc_box *box) {
    return box->min_x >= -FLT_MAX && box->min_y >= -FLT_MAX && box->max_x <= FLT_MAX && box->max_y <= FLT_MAX &&
           box->min_x <= box->max_x && box->min_y <= box->max_y;
}

/* In a node's `order`: of the halving by bit b of the slots. */
#define NARC_ORDER_ALONG_Y(b)  (1u << (b)) /* the halves lie one above the other; else side by side */
#define NARC_ORDER_DOWNWARD(b) (8u << (b)) /* the half with bit 0 is the upper one, or that on the right */

/* What building takes for each box: two numbers of 32 bits twice, and of one kind three lists. */
enum { NARC_INDEX_BUILD_BYTES = 28 };

/* The worlds of what is below each slot of a node, from the lowest to the highest, as narc_order_world() has them; without
 * bodies from the last to the first. */
typedef struct narc_node_worlds {
    int32_t lowest[NARC_NODE_SLOTS], highest[NARC_NODE_SLOTS];
} narc_node_worlds;

typedef struct narc_world_range {
    int32_t lowest, highest;
} narc_world_range;

/* A signed number in the order of worlds. */
static inline int32_t narc_order_world(uint32_t world) { return (int32_t)(world ^ 0x80000000u); }

static inline narc_world_range narc_get_worlds(const narc_node_worlds *node, size_t slot) {
    return (narc_world_range){node->lowest[slot], node->highest[slot]};
}

static inline void narc_put_worlds(narc_node_worlds *node, size_t slot, narc_world_range worlds) {
    node->lowest[slot] = worlds.lowest;
    node->highest[slot] = worlds.highest;
}

/* Both together. */
static inline narc_world_range narc_join_worlds(narc_world_range a, narc_world_range b) {
    return (narc_world_range){a.lowest < b.lowest ? a.lowest : b.lowest, a.highest > b.highest ? a.highest : b.highest};
}

static const narc_world_range narc_no_worlds = {INT32_MAX, INT32_MIN};

/* In narc_index.place: the body is in no leaf; or it waits for one, while the index is updated. */
#define NARC_NO_PLACE      UINT32_MAX
#define NARC_WAITING_PLACE (UINT32_MAX - 1)

/* What a query of narc_query_index() has found: `count` bodies from narc_index.found[first] on, whose pairs begin at
 * `row`. */
typedef struct narc_region {
    size_t first;
    uint32_t count, row;
} narc_region;

/* Of a mover and a body, where parts of things are let go together: how far apart they are at the start, the target, and how
 * deep the mover is in the thing, if it is in this part. */
typedef struct narc_start {
    float separation, target, depth;
} narc_start;

struct narc_index {
    narc_allocator allocator;
    narc_point origin;                      /* of their coordinates, in the world */
    size_t count;                           /* boxes; those that are empty are in no leaf */
    size_t slots;                           /* of leaves, eight each */
    unsigned level_count;                   /* 0: there are no boxes, and no nodes */
    uint32_t first_node[NARC_INDEX_LEVELS]; /* of each level, in `nodes` and `order`; level 0 begins at 0 */
    uint32_t node_count[NARC_INDEX_LEVELS];
    narc_index_node *nodes; /* at cache lines */
    uint8_t *order;         /* of each node */
    uint64_t *masks; /* for each slot of each node, 8 * node + slot: all category bits below; NULL: all bits set */
    narc_node_worlds *worlds; /* of each node; NULL: there is one world */
    uint32_t *body;           /* for each slot of each leaf; UINT32_MAX: none */
    uint32_t *place;          /* of each body the slot of a leaf, or NARC_..._PLACE */
    uint32_t *filled;         /* of each node: how many bodies are below, */
    uint32_t *changes;        /* how many came since they were spread over its slots, */
    uint8_t *touched;         /* and while the index is updated a bit for each child of which something has changed */
    narc_box *home;           /* of each leaf: a body that moves within this stays */
    uint32_t *waiting;        /* while the index is updated: bodies that are to go to a leaf */
    double perimeter;         /* of all nodes together, when it was built */
    /* memory, and for how many boxes */
    void *tree_memory, *mask_memory, *world_memory, *build_memory;
    size_t tree_capacity, mask_capacity, world_capacity, build_capacity;
    /* of narc_query_index(): for each query, each body that is found, in any order, and each pair */
    narc_region *regions;
    uint32_t *found, *rows;
    size_t region_capacity, found_capacity, row_capacity;
    narc_box *sweeps; /* of narc_cast_shapes(): for each mover */
    size_t sweep_capacity;
    narc_start *starts; /* and for each pair */
    size_t start_capacity;
    narc_box box; /* around all; empty without boxes */
};

/* Makes room for an index of so many boxes, with masks and worlds or without, and for building it. What it holds is lost only if
 * there was no room; NARC_ERROR_MEMORY: it is as it was. */
narc_status narc_reserve_index(narc_index *index, size_t count, bool masks, bool worlds);

/* Make room for so many queries, bodies that are found, and pairs of both, boxes of movers, and starts of their pairs; what was there is lost,
 * unless there is room already. NARC_ERROR_MEMORY: there is as much room as before. Behind the bodies NARC_FOUND_PADDING
 * more may be read. */
narc_status narc_reserve_regions(narc_index *index, size_t count);
narc_status narc_reserve_found(narc_index *index, size_t count);
narc_status narc_reserve_rows(narc_index *index, size_t count);
narc_status narc_reserve_sweeps(narc_index *index, size_t count);
narc_status narc_reserve_starts(narc_index *index, size_t count);

/* Four of the widest vectors. */
enum { NARC_FOUND_PADDING = 64 };

/* Is there room for so many boxes already? Then narc_reserve_index() changes nothing. */
bool narc_has_index_room(const narc_index *index, size_t count, bool masks, bool worlds);

/* All memory that the index has. */
size_t narc_count_index_bytes(const narc_index *index);

/* How many slots so many bodies get when an index is built: packed as few as there may be. */
size_t narc_count_index_slots(size_t bodies, bool packed);

/* Sets the number of slots, and the levels that they make. There is room for them. */
void narc_lay_out_index(narc_index *index, size_t slots);

/* How many nodes it has: the root is the last. */
static inline size_t narc_count_nodes(const narc_index *index) {
    return index->level_count > 0 ? (size_t)index->first_node[index->level_count - 1] + 1 : 0;
}

static inline narc_box narc_get_node_box(const narc_index_node *node, size_t slot) {
    return (narc_box){node->min_x[slot], node->min_y[slot], node->max_x[slot], node->max_y[slot]};
}

/* The slot that the ray meets first, second and so on: k ^ flips. `order` of the node; `left`: 7 if the ray goes left, else
 * 0; `aslant`: 7 if it goes left and up, or right and down, else 0. */
static inline unsigned narc_find_flips(unsigned order, unsigned left, unsigned aslant) {
    return left ^ (order & aslant) ^ order >> 3;
}

#endif
