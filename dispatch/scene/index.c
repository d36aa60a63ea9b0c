/* SPDX-License-Identifier: MIT
 *
 * index.c - narc_build_index() and narc_refit_index(): bodies into the order of leaves, then boxes from the leaves up.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "leaves.h"

#include <float.h>
#include <math.h>

/* Nodes that are worth a task. */
enum { NODES = 1024 };

/* ------------------------------------------------------------------------------------------------ boxes */

typedef struct fitting {
    narc_index *index;
    const narc_kernel_table *kernels;
    const narc_box *boxes;
    narc_word_column category;
    unsigned level;
} fitting;

static void fit_leaves(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    (void)part;
    f->kernels->leaves(f->index, f->boxes, first, end);
}

static void fit_nodes(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    (void)part;
    f->kernels->nodes(f->index, f->level, first, end, NULL);
}

/* The masks of nodes: those of bodies, or all of each child's together. */
static void join_masks(void *argument, size_t part, size_t first, size_t end) {
    const fitting *const f = argument;
    const narc_index *const index = f->index;
    uint64_t *const masks = index->masks + (size_t)index->first_node[f->level] * NARC_NODE_SLOTS;
    (void)part;
    for (size_t k = first * NARC_NODE_SLOTS; k < end * NARC_NODE_SLOTS; k++) {
        masks[k] = 0;
        if (f->level == 0 && index->body[k] != UINT32_MAX)
            masks[k] = narc_word_at(f->category, index->body[k]);
        for (size_t slot = 0; f->level > 0 && k < index->node_count[f->level - 1] && slot < NARC_NODE_SLOTS; slot++)
            masks[k] |= index->masks[(index->first_node[f->level - 1] + k) * NARC_NODE_SLOTS + slot];
    }
}

static double find_perimeter(const narc_index_node *node, size_t slot) {
    const double width = (double)node->max_x[slot] - (double)node->min_x[slot];
    const double height = (double)node->max_y[slot] - (double)node->min_y[slot];
    return width >= 0 ? width + height : 0;
}

/* Boxes and masks of the slots of all nodes, and their order; returns half of the nodes' perimeters together. */
static double fit_index(narc_index *index, const narc_kernel_table *kernels, const narc_box *boxes,
                        const narc_index_options *options) {
    fitting f = {index, kernels, boxes, options->category, 0};
    narc_index_node above;
    if (index->level_count == 0)
        return 0;
    for (; f.level < index->level_count; f.level++) {
        const size_t count = index->node_count[f.level];
        narc_run_ranges(options->workers, count, NODES, f.level == 0 ? fit_leaves : fit_nodes, &f);
        if (index->masks)
            narc_run_ranges(options->workers, count, NODES, join_masks, &f);
    }
    kernels->nodes(index, f.level, 0, 1, &above);
    double perimeter = find_perimeter(&above, 0);
    for (size_t k = index->node_count[0], end = narc_count_nodes(index); k < end; k++)
        for (size_t slot = 0; slot < NARC_NODE_SLOTS; slot++)
            perimeter += find_perimeter(&index->nodes[k], slot);
    return perimeter;
}

/* ------------------------------------------------------------------------------------------------ calls */

static const narc_index_options defaults = {0};

static narc_status check_arguments(const narc_index *index, const narc_box *boxes, size_t count,
                                   const narc_index_options *options, narc_error *error) {
    if (!index || (!boxes && count > 0))
        return narc_fail_missing(error, !index ? "index" : "boxes");
    narc_status status = narc_check_count(count, (size_t)INT32_MAX + 1, "boxes in one index", error);
    if (status == NARC_OK)
        status = narc_check_origin(options->origin, "options", error);
    return status == NARC_OK ? narc_check_reserved(options->reserved, 3, "options", error) : status;
}

narc_status narc_build_index(narc_index *index, const narc_box *boxes, size_t count, const narc_index_options *options,
                             narc_error *error) {
    const narc_index_options *const o = options ? options : &defaults;
    narc_status status = check_arguments(index, boxes, count, o, error);
    if (status != NARC_OK)
        return status;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    status = narc_reserve_index(index, count, o->category.base);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, (double)count, "no memory for an index of %zu boxes", count);
    narc_lay_out_index(index, count);
    index->masks = o->category.base ? index->mask_memory : NULL;
    index->origin = o->origin ? *o->origin : (narc_point){0, 0};
    index->perimeter = 0;
    if (count == 0)
        return NARC_OK;
    if (o->fast)
        narc_sort_bodies_by_curve(index, boxes, o->workers);
    else
        narc_halve_bodies(index, boxes, o->workers);
    for (size_t k = count; k < (size_t)index->node_count[0] * NARC_NODE_SLOTS + NARC_NODE_PADDING; k++)
        index->body[k] = UINT32_MAX;
    index->perimeter = fit_index(index, kernels, boxes, o);
    return NARC_OK;
}

narc_status narc_refit_index(narc_index *index, const narc_box *boxes, size_t count, const narc_index_options *options,
                             float *out_slack, narc_error *error) {
    const narc_index_options *const o = options ? options : &defaults;
    narc_status status = check_arguments(index, boxes, count, o, error);
    if (status != NARC_OK)
        return status;
    if (count != index->count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)count, "%zu boxes, but the index was built from %zu",
                         count, index->count);
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    status = narc_reserve_index(index, count, o->category.base);
    if (status != NARC_OK)
        return narc_fail(error, status, 0, (double)count, "no memory for the masks of %zu boxes", count);
    index->masks = o->category.base ? index->mask_memory : NULL;
    index->origin = o->origin ? *o->origin : (narc_point){0, 0};
    const double perimeter = fit_index(index, kernels, boxes, o);
    const double slack = perimeter == index->perimeter ? 1 : perimeter / index->perimeter;
    if (out_slack)
        *out_slack = slack <= (double)FLT_MAX ? (float)slack : INFINITY;
    return NARC_OK;
}
