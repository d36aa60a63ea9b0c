/* SPDX-License-Identifier: MIT
 *
 * method_kernels.h - what the methods' kernels see of a call, and what their dispatcher sees of the kernels. Internal.
 */
#ifndef NARC_METHODS_METHOD_KERNELS_H
#define NARC_METHODS_METHOD_KERNELS_H

#include "kernels.h"
#include "narc_methods.h"

/* What the methods ask of a shape beside its arcs: a box around it and its centroid. The half sides have room for the
 * kernels' rounding, NARC_ROUNDING_ROOM times the extent. */
typedef struct narc_oriented_box {
    float center_x, center_y, half_x, half_y;
    float axis_x, axis_y; /* the direction of the side half_x, unit */
    float centroid_x, centroid_y;
} narc_oriented_box;
_Static_assert(sizeof(narc_oriented_box) == sizeof(narc_record), "a box takes the place of a record");

/* What a call knows beside its batch. The batch's shapes are its first member: a copy of those of the store, with a
 * record more for each, its box, behind the arcs. */
typedef struct narc_method_call {
    narc_shapes shapes;
    narc_overlap_kernel *overlap;
    narc_row_kernel *contact; /* NULL: it has none */
    uint8_t *outcomes;        /* one for each pair, out; may be NULL. Kernels write those that did not end well */
    uint32_t *simplexes;      /* of gjk, one for each pair, in and out; may be NULL */
    float tolerance;          /* of gjk, relative to the sum of both bounding radii */
    int iterations;           /* of gjk, 1 .. NARC_MAX_ITERATIONS */
} narc_method_call;

static inline const narc_method_call *narc_call_of(const narc_batch *batch) {
    return (const narc_method_call *)batch->shapes;
}

/* One constant table of kernels for each instruction set. */
typedef struct narc_method_table {
#define NARC_METHOD_KERNEL(kind, name) narc_##kind##_kernel *name;
#include "methods.def"
} narc_method_table;

#define NARC_ISA(name, needs, processors, flags) extern const narc_method_table narc_method_kernels_##name;
#include "isa.def"

#endif
