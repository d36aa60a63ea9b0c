/* SPDX-License-Identifier: MIT
 *
 * kernels.h - what the dispatcher sees of the kernels: one constant table for each instruction set. Internal.
 *
 * Kernels check nothing: arguments, indices and capacities are the caller's business (dispatch/api.c).
 */
#ifndef NARC_KERNELS_H
#define NARC_KERNELS_H

#include "store.h"

/* What a batch call works on. */
typedef struct narc_batch {
    const narc_shapes *shapes;
    const narc_bodies *bodies;
    const narc_pairs *pairs;
    uint32_t *hints;   /* one for each pair, in and out; may be NULL */
    uint8_t *outcomes; /* one for each pair, out; may be NULL. Only methods that can fail write them. */
    float tolerance;   /* of gjk, relative to the sum of both bounding radii */
    int iterations;    /* of gjk, 1 .. NARC_MAX_ITERATIONS */
} narc_batch;

/* Pairs whose contacts a kernel collects before it lists them; more are as good as several calls. */
enum { NARC_CONTACT_GROUP = 1024 };

typedef struct narc_kernel_table {
    const char *isa;
#define NARC_KERNEL(type, name, parameters) type(*name) parameters;
#include "kernels.def"
#undef NARC_KERNEL
} narc_kernel_table;

/* What the kernels called overlap... and contact... have in common. */
typedef void narc_overlap_kernel(const narc_batch *batch, size_t first, size_t count, uint64_t *out_bits);
typedef size_t narc_contact_kernel(const narc_batch *batch, size_t first, size_t count, float margin,
                                   const narc_contacts *out);

extern const narc_kernel_table narc_kernels_scalar;
extern const narc_kernel_table narc_kernels_neon;
extern const narc_kernel_table narc_kernels_avx2;
extern const narc_kernel_table narc_kernels_avx512;

#endif
