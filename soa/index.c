/* SPDX-License-Identifier: MIT
 *
 * index.c - allocates the memory of an index, and says how many nodes it has. What a build needs is kept, so that the
 * next one allocates nothing unless it is larger.
 */
#include "index.h"

#include "memory.h"

narc_status narc_create_index(const narc_allocator *allocator, narc_index **out_index) {
    const narc_allocator chosen = narc_choose_allocator(allocator);
    if (!out_index || !chosen.allocate || !chosen.release)
        return NARC_ERROR_ARGUMENT;
    narc_index *index = chosen.allocate(sizeof *index, chosen.context);
    if (!index)
        return NARC_ERROR_MEMORY;
    *index = (narc_index){.allocator = chosen, .box = {INFINITY, INFINITY, -INFINITY, -INFINITY}};
    *out_index = index;
    return NARC_OK;
}

void narc_destroy_index(narc_index *index) {
    if (!index)
        return;
    const narc_allocator allocator = index->allocator;
    void *const memory[] = {
        index->tree_memory, index->mask_memory, index->world_memory, index->build_memory, index->regions,
        index->found,       index->rows,        index->sweeps,       index->starts,       index};
    for (size_t k = 0; k < sizeof memory / sizeof memory[0]; k++)
        if (memory[k])
            allocator.release(memory[k], allocator.context);
}

/* ------------------------------------------------------------------------------------------------ levels */

/* The nodes of one level above so many slots or nodes. */
static size_t count_parents(size_t count) { return (count + NARC_NODE_SLOTS - 1) / NARC_NODE_SLOTS; }

size_t narc_count_index_slots(size_t bodies, bool packed) {
    const size_t room = packed || bodies <= NARC_NODE_SLOTS ? 0 : bodies / 3;
    return count_parents(bodies > 0 ? bodies + room : 1) * NARC_NODE_SLOTS;
}

/* All nodes above so many slots. */
static size_t count_all_nodes(size_t count) {
    size_t all = 0;
    while (count > 1) {
        count = count_parents(count);
        all += count;
    }
    return all;
}

/* All slots of a tree of so many boxes. */
static size_t count_all_slots(size_t boxes) {
    return count_all_nodes(narc_count_index_slots(boxes, false)) * NARC_NODE_SLOTS;
}

void narc_lay_out_index(narc_index *index, size_t slots) {
    size_t first = 0, count = slots;
    unsigned level = 0;
    index->slots = slots;
    for (; count > 1; level++) {
        count = count_parents(count);
        index->first_node[level] = (uint32_t)first;
        index->node_count[level] = (uint32_t)count;
        first += count;
    }
    index->level_count = level;
}

/* ------------------------------------------------------------------------------------------------ memory */

/* Room for a quarter more than is needed, so that a scene that grows slowly does not allocate at every step. */
static size_t with_room(size_t count) { return count < 64 ? 64 : count + count / 4; }

/* Bytes, up to whole cache lines. */
enum { LINE = 64 };
static size_t fill_lines(size_t bytes) { return (bytes + LINE - 1) / LINE * LINE; }

/* Memory for a tree of so many boxes: what lies where in it, from its first whole cache line on. */
struct tree_layout {
    size_t home, body, place, waiting, filled, changes, order, touched, end;
};

static struct tree_layout lay_out_tree(size_t count) {
    const size_t slots = narc_count_index_slots(count, false), nodes = count_all_nodes(slots);
    struct tree_layout at;
    at.home = fill_lines(nodes * sizeof(narc_index_node) + NARC_NODE_PADDING * sizeof(float));
    at.body = at.home + fill_lines(slots / NARC_NODE_SLOTS * sizeof(narc_box));
    at.place = at.body + fill_lines((slots + NARC_NODE_PADDING) * sizeof(uint32_t));
    at.waiting = at.place + fill_lines(count * sizeof(uint32_t));
    at.filled = at.waiting + fill_lines(count * sizeof(uint32_t));
    at.changes = at.filled + fill_lines(nodes * sizeof(uint32_t));
    at.order = at.changes + fill_lines(nodes * sizeof(uint32_t));
    at.touched = at.order + fill_lines(nodes);
    at.end = at.touched + fill_lines(nodes);
    return at;
}

/* A piece of memory that takes the place of another, if all pieces could be had. */
struct piece {
    void **place, *fresh;
    size_t *capacity, count, bytes;
};

bool narc_has_index_room(const narc_index *index, size_t count, bool masks, bool worlds) {
    return count <= index->tree_capacity && (!masks || count <= index->mask_capacity) &&
           (!worlds || count <= index->world_capacity);
}

narc_status narc_reserve_index(narc_index *index, size_t count, bool masks, bool worlds) {
    enum { BYTES = 64 }; /* for a box, more than any piece of memory takes */
    const size_t n = with_room(count);
    if (n > SIZE_MAX / BYTES)
        return NARC_ERROR_MEMORY;
    const struct tree_layout tree = lay_out_tree(n);
    struct piece pieces[] = {
        {&index->tree_memory, NULL, &index->tree_capacity, count, tree.end + LINE},
        {&index->build_memory, NULL, &index->build_capacity, count, n * NARC_INDEX_BUILD_BYTES},
        {&index->mask_memory, NULL, &index->mask_capacity, masks ? count : 0, count_all_slots(n) * sizeof(uint64_t)},
        {&index->world_memory, NULL, &index->world_capacity, worlds ? count : 0,
         count_all_slots(n) / NARC_NODE_SLOTS * sizeof(narc_node_worlds) + NARC_NODE_PADDING * sizeof(int32_t)},
    };
    enum { PIECES = sizeof pieces / sizeof pieces[0] };
    bool fine = true;
    for (size_t k = 0; k < PIECES && fine; k++)
        if (pieces[k].count > *pieces[k].capacity) {
            pieces[k].fresh = index->allocator.allocate(pieces[k].bytes, index->allocator.context);
            fine = pieces[k].fresh != NULL;
        }
    for (size_t k = 0; k < PIECES; k++) {
        void *const old = fine ? *pieces[k].place : pieces[k].fresh;
        if (pieces[k].fresh && old)
            index->allocator.release(old, index->allocator.context);
        if (pieces[k].fresh && fine) {
            *pieces[k].place = pieces[k].fresh;
            *pieces[k].capacity = n;
        }
    }
    if (!fine)
        return NARC_ERROR_MEMORY;
    if (pieces[0].fresh) {
        char *const base = (char *)index->tree_memory + (LINE - (uintptr_t)index->tree_memory % LINE) % LINE;
        index->nodes = (narc_index_node *)(void *)base;
        index->home = (narc_box *)(void *)(base + tree.home);
        index->body = (uint32_t *)(void *)(base + tree.body);
        index->place = (uint32_t *)(void *)(base + tree.place);
        index->waiting = (uint32_t *)(void *)(base + tree.waiting);
        index->filled = (uint32_t *)(void *)(base + tree.filled);
        index->changes = (uint32_t *)(void *)(base + tree.changes);
        index->order = (uint8_t *)(base + tree.order);
        index->touched = (uint8_t *)(base + tree.touched);
    }
    return NARC_OK;
}

size_t narc_count_index_bytes(const narc_index *index) {
    size_t bytes = sizeof *index;
    if (index->tree_memory)
        bytes += lay_out_tree(index->tree_capacity).end + LINE;
    if (index->mask_memory)
        bytes += count_all_slots(index->mask_capacity) * sizeof(uint64_t);
    if (index->world_memory)
        bytes += count_all_slots(index->world_capacity) / NARC_NODE_SLOTS * sizeof(narc_node_worlds);
    bytes += index->build_capacity * NARC_INDEX_BUILD_BYTES + index->region_capacity * sizeof *index->regions;
    bytes += index->found_capacity * sizeof *index->found + 2 * index->row_capacity * sizeof *index->rows;
    return bytes + index->sweep_capacity * sizeof *index->sweeps + index->start_capacity * sizeof *index->starts;
}

/* Makes room for `count` items of an array, with `padding` behind them. */
static narc_status reserve(const narc_index *index, void **memory, size_t *capacity, size_t count, size_t size,
                           size_t padding) {
    const size_t n = with_room(count);
    if (count <= *capacity)
        return NARC_OK;
    if (n > (SIZE_MAX - padding) / size)
        return NARC_ERROR_MEMORY;
    void *const fresh = index->allocator.allocate(n * size + padding, index->allocator.context);
    if (!fresh)
        return NARC_ERROR_MEMORY;
    if (*memory)
        index->allocator.release(*memory, index->allocator.context);
    *memory = fresh;
    *capacity = n;
    return NARC_OK;
}

narc_status narc_reserve_regions(narc_index *index, size_t count) {
    void *memory = index->regions;
    const narc_status status = reserve(index, &memory, &index->region_capacity, count, sizeof *index->regions, 0);
    index->regions = memory;
    return status;
}

narc_status narc_reserve_found(narc_index *index, size_t count) {
    void *memory = index->found;
    const narc_status status = reserve(index, &memory, &index->found_capacity, count, sizeof *index->found,
                                       NARC_FOUND_PADDING * sizeof *index->found);
    index->found = memory;
    return status;
}

narc_status narc_reserve_rows(narc_index *index, size_t count) {
    void *memory = index->rows;
    const narc_status status = reserve(index, &memory, &index->row_capacity, count, 2 * sizeof *index->rows, 0);
    index->rows = memory;
    return status;
}

narc_status narc_reserve_sweeps(narc_index *index, size_t count) {
    void *memory = index->sweeps;
    const narc_status status = reserve(index, &memory, &index->sweep_capacity, count, sizeof *index->sweeps, 0);
    index->sweeps = memory;
    return status;
}

narc_status narc_reserve_starts(narc_index *index, size_t count) {
    void *memory = index->starts;
    const narc_status status = reserve(index, &memory, &index->start_capacity, count, sizeof *index->starts, 0);
    index->starts = memory;
    return status;
}
