/* SPDX-License-Identifier: MIT
 *
 * leaves.h - how the tree of an index is made: bodies into leaves, in two orders, and boxes from the leaves up. Internal.
 */
#ifndef NARC_SCENE_LEAVES_H
#define NARC_SCENE_LEAVES_H

#include "index.h"
#include "kernels.h"

/* Slots `first` and so on of leaves, and the bodies for them: the first `count` numbers of 32 bits in
 * index->build_memory, no more than there are slots. Their boxes are full. */
typedef struct narc_filling {
    narc_index *index;
    const narc_box *boxes;
    narc_index_column world; /* base NULL: there is one */
    const narc_workers *workers;
    size_t first, slots, count;
} narc_filling;

/* Put the bodies into the slots, spread evenly: index->body and index->place. The order depends on the boxes, and which of
 * equal ones come first on the list, alone. */
void narc_halve_bodies(const narc_filling *filling);
void narc_sort_bodies_by_curve(const narc_filling *filling);

/* What an index is made of. */
typedef struct narc_making {
    narc_index *index;
    const narc_kernel_table *kernels;
    const narc_box *boxes;
    const narc_index_options *options;
} narc_making;

/* Makes the whole tree anew, of all boxes that are full, packed or not. There is room. */
void narc_make_index(const narc_making *making, bool packed);

/* Puts the bodies that are listed, `count` of them, evenly into the slots below a node above leaves, and fits all nodes
 * below, and it, to them; those above it are as they were. */
void narc_spread_bodies(const narc_making *making, unsigned level, size_t node, size_t count);

/* Fits nodes first .. end - 1 of a level above the leaves to their children. */
void narc_fit_nodes(const narc_making *making, unsigned level, size_t first, size_t end);

/* The box around all, and the order of the root, when all nodes fit their children. */
void narc_fit_root(const narc_making *making);

/* Are the arguments of a build in order? */
narc_status narc_check_making(const narc_index *index, const narc_box *boxes, size_t count,
                              const narc_index_options *options, narc_error *error);

/* Puts a 0 before each of 16 bits. */
static inline uint32_t narc_spread_bits(uint32_t k) {
    k = (k | k << 8) & 0x00ff00ff;
    k = (k | k << 4) & 0x0f0f0f0f;
    k = (k | k << 2) & 0x33333333;
    return (k | k << 1) & 0x55555555;
}

#endif
