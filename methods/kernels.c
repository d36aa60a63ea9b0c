/* SPDX-License-Identifier: MIT
 *
 * kernels.c - the table of one instruction set's kernels for the methods of narc_methods.h, the only symbol of its
 * object. NARC_ISA_NAME and NARC_SIMD: see kernels/table.c.
 */
/* Searches in lanes go best with many pairs at a time. */
#define NARC_QUEUE_PAIRS 128

#include "methods/bounding.inl"
#include "methods/first_pair.inl"
#include "methods/gjk.inl"
#include "methods/method_kernels.h"
#include "methods/polygon.inl"

const narc_method_table NARC_NAMED(method_kernels) = {
#define NARC_METHOD_KERNEL(kind, name) .name = name,
#include "methods/methods.def"
};
