/* SPDX-License-Identifier: MIT
 *
 * index.c - narc_build_index(), narc_describe_index(), narc_copy_nodes(): bodies into leaves, then boxes from the leaves up.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "leaves.h"

#include <math.h>
#include <string.h>

/* Nodes that are worth a task. */
enum { NODES = 1024 };

/* ------------------------------------------------------------------------------------------------ boxes */

/* Nodes from `first` on of a level. */
typedef struct fitting {
    narc_index *index;
    const narc_kernel_table *kernels;
    const narc_box *boxes;
    narc_word_column category;
    narc_index_column world;
    unsigned level;
    size_t first;
} fitting;

static void fit_leaves(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    (void)part;
    f->kernels->leaves(f->index, f->boxes, f->first + first, f->first + end);
}

static void fit_nodes(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    (void)part;
    f->kernels->nodes(f->index, f->level, f->first + first, f->first + end, NULL);
}

/* The masks of nodes: those of bodies, or all of each child's together. */
static void join_masks(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    const narc_index *const index = f->index;
    uint64_t *const masks = index->masks + (size_t)index->first_node[f->level] * NARC_NODE_SLOTS;
    (void)part;
    for (size_t k = (f->first + first) * NARC_NODE_SLOTS; k < (f->first + end) * NARC_NODE_SLOTS; k++) {
        masks[k] = 0;
        if (f->level == 0 && index->body[k] != UINT32_MAX)
            masks[k] = narc_word_at(f->category, index->body[k]);
        for (size_t slot = 0; f->level > 0 && k < index->node_count[f->level - 1] && slot < NARC_NODE_SLOTS; slot++)
            masks[k] |= index->masks[(index->first_node[f->level - 1] + k) * NARC_NODE_SLOTS + slot];
    }
}

/* The worlds of nodes, likewise. */
static void join_worlds(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    const narc_index *const index = f->index;
    narc_node_worlds *const worlds = index->worlds + index->first_node[f->level];
    (void)part;
    for (size_t k = (f->first + first) * NARC_NODE_SLOTS; k < (f->first + end) * NARC_NODE_SLOTS; k++) {
        narc_world_range all = narc_no_worlds;
        if (f->level == 0 && index->body[k] != UINT32_MAX)
            all.lowest = all.highest = narc_order_world(narc_index_at(f->world, index->body[k]));
        for (size_t slot = 0; f->level > 0 && k < index->node_count[f->level - 1] && slot < NARC_NODE_SLOTS; slot++)
            all = narc_join_worlds(all, narc_get_worlds(&index->worlds[index->first_node[f->level - 1] + k], slot));
        narc_put_worlds(&worlds[k / NARC_NODE_SLOTS], k % NARC_NODE_SLOTS, all);
    }
}

static void fit(const narc_making *m, unsigned level, size_t first, size_t end) {
    fitting f = {m->index, m->kernels, m->boxes, m->options->category, m->options->world, level, first};
    narc_run_ranges(m->options->workers, end - first, NODES, level == 0 ? fit_leaves : fit_nodes, &f);
    if (m->index->masks)
        narc_run_ranges(m->options->workers, end - first, NODES, join_masks, &f);
    if (m->index->worlds)
        narc_run_ranges(m->options->workers, end - first, NODES, join_worlds, &f);
}

void narc_fit_nodes(const narc_making *making, unsigned level, size_t first, size_t end) {
    fit(making, level, first, end);
}

void narc_fit_root(const narc_making *making) {
    narc_index *const index = making->index;
    narc_index_node above;
    making->kernels->nodes(index, index->level_count, 0, 1, &above);
    index->box = narc_get_node_box(&above, 0);
}

/* A body may move a little beyond the box of its leaf: of half the perimeter, */
#define HOME 0x1p-5f

static narc_box grow_home(const narc_index_node *node, size_t slot) {
    const float width = node->max_x[slot] - node->min_x[slot], height = node->max_y[slot] - node->min_y[slot];
    const float margin = (width + height) * HOME;
    return (narc_box){node->min_x[slot] - margin, node->min_y[slot] - margin, node->max_x[slot] + margin,
                      node->max_y[slot] + margin};
}

/* What is kept of a node, beside its boxes, when bodies have been put into the slots below it. */
static void begin_node(narc_index *index, unsigned level, size_t node) {
    const size_t at = index->first_node[level] + node, below = node * NARC_NODE_SLOTS;
    uint32_t filled = 0;
    for (size_t slot = 0; slot < NARC_NODE_SLOTS; slot++)
        if (level == 0)
            filled += index->body[below + slot] != UINT32_MAX;
        else if (below + slot < index->node_count[level - 1])
            filled += index->filled[index->first_node[level - 1] + below + slot];
    for (size_t slot = 0; slot < NARC_NODE_SLOTS && level == 1 && below + slot < index->node_count[0]; slot++)
        index->home[below + slot] = grow_home(&index->nodes[at], slot);
    index->filled[at] = filled;
    index->changes[at] = 0;
    index->touched[at] = 0;
}

/* The first node of a level below another one. */
static size_t find_first(const narc_index *index, unsigned below, unsigned level, size_t node) {
    const uint64_t first = (uint64_t)node << (3 * (level - below));
    return first < index->node_count[below] ? (size_t)first : index->node_count[below];
}

void narc_spread_bodies(const narc_making *m, unsigned level, size_t node, size_t count) {
    narc_index *const index = m->index;
    const size_t first = find_first(index, 0, level, node) * NARC_NODE_SLOTS;
    const size_t end = find_first(index, 0, level, node + 1) * NARC_NODE_SLOTS;
    const narc_filling filling = {index, m->boxes, m->options->world, m->options->workers, first, end - first, count};
    if (m->options->fast && end - first == index->slots)
        narc_sort_bodies_by_curve(&filling);
    else
        narc_halve_bodies(&filling);
    for (unsigned below = 0; below <= level; below++) {
        const size_t last = find_first(index, below, level, node + 1);
        fit(m, below, find_first(index, below, level, node), last);
        for (size_t k = find_first(index, below, level, node); k < last; k++)
            begin_node(index, below, k);
    }
}

static double find_perimeter(const narc_index_node *node, size_t slot) {
    const double width = (double)node->max_x[slot] - (double)node->min_x[slot];
    const double height = (double)node->max_y[slot] - (double)node->min_y[slot];
    return width >= 0 ? width + height : 0;
}

/* Half of the perimeters of all nodes together. */
static double sum_perimeters(const narc_index *index) {
    const narc_box all = index->box;
    double perimeter = 0;
    for (size_t k = index->node_count[0], end = narc_count_nodes(index); k < end; k++)
        for (size_t slot = 0; slot < NARC_NODE_SLOTS; slot++)
            perimeter += find_perimeter(&index->nodes[k], slot);
    const double width = (double)all.max_x - (double)all.min_x, height = (double)all.max_y - (double)all.min_y;
    return width >= 0 ? perimeter + width + height : 0;
}

/* ------------------------------------------------------------------------------------------------ calls */

void narc_make_index(const narc_making *m, bool packed) {
    narc_index *const index = m->index;
    uint32_t *const list = index->build_memory;
    size_t count = 0;
    for (size_t k = 0; k < index->count; k++) {
        index->place[k] = NARC_NO_PLACE;
        if (narc_is_full_box(&m->boxes[k]))
            list[count++] = (uint32_t)k;
    }
    narc_lay_out_index(index, narc_count_index_slots(count, packed));
    for (size_t k = 0; k < NARC_NODE_PADDING; k++)
        index->body[index->slots + k] = UINT32_MAX;
    index->home[0] = (narc_box){-INFINITY, -INFINITY, INFINITY, INFINITY}; /* of an only leaf */
    narc_spread_bodies(m, index->level_count - 1, 0, count);
    narc_fit_root(m);
    index->perimeter = sum_perimeters(index);
}

narc_status narc_check_making(const narc_index *index, const narc_box *boxes, size_t count,
                              const narc_index_options *options, narc_error *error) {
    if (!index || (!boxes && count > 0))
        return narc_fail_missing(error, !index ? "index" : "boxes");
    narc_status status = narc_check_count(count, (size_t)INT32_MAX + 1, "boxes in one index", error);
    if (status == NARC_OK)
        status = narc_check_origin(options->origin, "options", error);
    return status == NARC_OK ? narc_check_reserved(options->reserved, 1, "options", error) : status;
}

narc_status narc_build_index(narc_index *index, const narc_box *boxes, size_t count, const narc_index_options *options,
                             narc_error *error) {
    static const narc_index_options defaults = {0};
    const narc_index_options *const o = options ? options : &defaults;
    narc_status status = narc_check_making(index, boxes, count, o, error);
    if (status != NARC_OK)
        return status;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    status = narc_reserve_index(index, count, o->category.base, o->world.base);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, (double)count, "no memory for an index of %zu boxes", count);
    index->count = count;
    index->masks = o->category.base ? index->mask_memory : NULL;
    index->worlds = o->world.base ? index->world_memory : NULL;
    index->origin = o->origin ? *o->origin : (narc_point){0, 0};
    index->perimeter = 0;
    index->level_count = 0;
    index->box = (narc_box){INFINITY, INFINITY, -INFINITY, -INFINITY};
    if (count > 0)
        narc_make_index(&(narc_making){index, kernels, boxes, o}, o->fast);
    return NARC_OK;
}

narc_status narc_describe_index(const narc_index *index, narc_index_statistics *out_statistics, narc_error *error) {
    if (!index || !out_statistics)
        return narc_fail_missing(error, !index ? "index" : "out_statistics");
    narc_index_statistics s = {.boxes = index->count, .depth = index->level_count, .slack = 1};
    s.bytes = narc_count_index_bytes(index);
    if (index->level_count > 0) {
        s.bodies = index->filled[narc_count_nodes(index) - 1];
        s.nodes = narc_count_nodes(index);
        s.leaves = index->node_count[0];
        const double perimeter = sum_perimeters(index);
        s.mean_perimeter = 2 * perimeter / (double)s.nodes;
        s.slack = perimeter == index->perimeter ? 1 : perimeter / index->perimeter;
    }
    *out_statistics = s;
    return NARC_OK;
}

narc_status narc_copy_nodes(const narc_index *index, size_t level, narc_box *out_boxes, ptrdiff_t stride,
                            size_t capacity, size_t *out_count, narc_error *error) {
    if (!index || !out_count || (!out_boxes && capacity > 0))
        return narc_fail_missing(error, !index ? "index" : !out_count ? "out_count" : "out_boxes");
    if (stride % 4 != 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)stride, "stride is %td, no multiple of 4", stride);
    const size_t count = *out_count = level < index->level_count ? index->node_count[level] : 0;
    if (count > capacity)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)count, "%zu boxes, but there is room for %zu", count,
                         capacity);
    char *out = (char *)out_boxes;
    for (size_t k = 0; k < count; k++, out += stride ? stride : (ptrdiff_t)sizeof *out_boxes) {
        const narc_box box = level + 1 < index->level_count
                                 ? narc_get_node_box(&index->nodes[index->first_node[level + 1] + k / NARC_NODE_SLOTS],
                                                     k % NARC_NODE_SLOTS)
                                 : index->box;
        memcpy(out, &box, sizeof box);
    }
    return NARC_OK;
}
