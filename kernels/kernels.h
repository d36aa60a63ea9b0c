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
    uint32_t *hints; /* one for each pair, in and out; may be NULL */
} narc_batch;

/* Pairs whose contacts a kernel collects before it lists them; more are as good as several calls. */
enum { NARC_CONTACT_GROUP = 1024 };

typedef struct narc_kernel_table {
    const char *isa;
#define NARC_KERNEL(type, name, parameters) type(*name) parameters;
#include "kernels.def"
#undef NARC_KERNEL
} narc_kernel_table;

extern const narc_kernel_table narc_kernels_scalar;
extern const narc_kernel_table narc_kernels_neon;
extern const narc_kernel_table narc_kernels_avx2;
extern const narc_kernel_table narc_kernels_avx512;

#endif
