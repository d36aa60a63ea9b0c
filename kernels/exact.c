/* SPDX-License-Identifier: MIT
 *
 * exact.c - the table of one instruction set's exact kernels, the only symbol of its object. The compiler's command
 * line defines NARC_ISA_NAME, the instruction set's name, and NARC_SIMD, the file of its vector wrapper.
 */
#include "broad/boxes.inl"
#include "broad/sweep.inl"
#include "kernels.h"
#include "pose.inl"
#include "sat/contact.inl"
#include "sat/overlap.inl"

const narc_kernel_table NARC_ISA_SYMBOL(narc_kernels_, NARC_ISA_NAME) = {
    .isa = NARC_ISA_TEXT(NARC_ISA_NAME),
#define NARC_KERNEL(type, name, parameters) .name = name,
#include "kernels.def"
};
