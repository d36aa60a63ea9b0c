/* SPDX-License-Identifier: MIT
 *
 * layout.h - the first stage of a pair, with what it reads of a shape kept as rows or as planes.
 */
#ifndef NARC_BENCH_LAYOUT_H
#define NARC_BENCH_LAYOUT_H

#include "workload.h"

/* What the first stage reads of a shape: 32 bytes, as in the store. */
struct shape_row {
    uint32_t block, bytes; /* where the arcs are, and how many: passed on */
    float bound_x, bound_y, bound_radius;
    float inner_x, inner_y, inner_radius;
};

enum { SHAPE_WORDS = 8 };

struct layout_input {
    const struct body *bodies;
    const struct pair *pairs;
    size_t pair_count;                /* a multiple of 64 */
    const struct shape_row *rows;     /* structures */
    const float *planes[SHAPE_WORDS]; /* arrays: plane w has word w of every row */
};

/* Sets the bits of the pairs whose bounding circles are apart, and of those whose inscribed circles overlap. */
typedef void layout_stage(const struct layout_input *input, uint64_t *out_apart, uint64_t *out_deep);

enum layout {
    ROWS,     /* two loads of 16 bytes for each lane, transposed in registers */
    GATHERED, /* one gather for each plane */
    MASKED,   /* the same, but where bounding circles are apart only those */
    LOADED,   /* one load of 4 bytes for each lane and plane */
    LAYOUTS
};

/* By layout, on one instruction set. */
extern layout_stage *const layouts_avx2[LAYOUTS], *const layouts_avx512[LAYOUTS];

#endif
