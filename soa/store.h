/* SPDX-License-Identifier: MIT
 *
 * store.h - the layout of a shape store, as the kernels read it. Internal.
 *
 * Each shape has a HEAD of 32 bytes, all that a filter needs, and a BLOCK with its arcs. A block is
 * structure-of-arrays: five planes of `stride` floats (count rounded up to a multiple of 4, the rest filled with copies
 * of the last arc),
 *
 *     center_x[stride] center_y[stride] radius[stride] normal_x[stride] normal_y[stride]
 *
 * where normal k is the unit outward normal at the start of arc k. Planes of one shape lie together, not those of all
 * shapes: a batch meets shapes in any order, and so touches 3 cache lines for the 160 bytes of an 8-arc shape instead
 * of 5. Blocks begin at multiples of 32 bytes.
 *
 * A full circle is stored as two half circles, because the kernels want sweeps of at most half a turn;
 * NARC_SHAPE_CIRCLE tells them to report arc 0 for both.
 */
#ifndef NARC_STORE_H
#define NARC_STORE_H

#include "narc_shapes.h"

enum { NARC_PLANES = 5, NARC_STRIDE_MULTIPLE = 4, NARC_BLOCK_ALIGNMENT = 32 };

typedef struct narc_head {
    uint32_t block; /* index of the block's first float in narc_shapes.arcs */
    uint8_t count;  /* arcs as stored, 2 .. NARC_MAX_ARCS */
    uint8_t stride; /* floats in a plane */
    uint16_t flags; /* NARC_SHAPE_... */
    /* A circle around the shape and one inside it. Both leave room (NARC_HEAD_SLACK times the extent, the largest
     * |centre| + radius) for the rounding of the kernels, so that a filter that uses them never contradicts the
     * deciding formula. The inner radius is 0 where that leaves nothing. */
    float bound_x, bound_y, bound_radius;
    float inner_x, inner_y, inner_radius;
} narc_head;

/* 96 roundings, so that the circles stay clear of the deciding formula's error: that is 32 roundings (NARC_ERROR_BOUND)
 * of the distance between the positions plus both extents, and that distance is at most the sum of the extents more
 * than the distance between the circles' centres. See kernels/relative.inl. */
#define NARC_HEAD_SLACK (96.0 / 16777216.0)

/* The largest bound_radius, scaled: a centred shape of NARC_MAX_SIZE passes with its room for rounding. */
#define NARC_HEAD_MAX_RADIUS (NARC_MAX_SIZE * (1 + NARC_TOLERANCE))

struct narc_shapes {
    narc_head *heads;
    float *arcs;
    size_t count, capacity;             /* heads */
    size_t float_count, float_capacity; /* floats in arcs */
    narc_allocator allocator;
    void *arcs_memory; /* what the allocator returned; arcs is the aligned address in it */
};

#endif
