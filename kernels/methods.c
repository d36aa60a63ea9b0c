/* SPDX-License-Identifier: MIT
 *
 * methods.c - the table of one instruction set's kernels for the methods of narc_methods.h, the only symbol of its
 * object. An object of its own, so that whoever works on the exact kernels need not compile these. NARC_ISA_NAME and
 * NARC_SIMD: see exact.c.
 */
#include "kernels.h"
#include "methods/bounding.inl"
#include "methods/first_pair.inl"
#include "methods/gjk.inl"
#include "methods/polygon.inl"

extern const narc_method_table NARC_ISA_SYMBOL(narc_methods_, NARC_ISA_NAME);

const narc_method_table NARC_ISA_SYMBOL(narc_methods_, NARC_ISA_NAME) = {
#define NARC_METHOD_KERNEL(type, name, parameters) .name = name,
#include "kernels.def"
};
