/* SPDX-License-Identifier: MIT
 *
 * table.c - the table of one instruction set's kernels. As for every kernel's file the compiler's command line defines
 * NARC_ISA_NAME, the instruction set's name, and NARC_SIMD, the file of its vector wrapper.
 */
#include "kernels.h"

const narc_kernel_table NARC_NAMED(kernels) = {
    .isa = NARC_ISA_TEXT(NARC_ISA_NAME),
#define NARC_KERNEL(type, name, parameters) .name = NARC_NAMED(name),
#include "kernels.def"
};
