/* SPDX-License-Identifier: MIT
 *
 * table.inl - all kernels for one instruction set, and the table that is the only symbol of its object file. The
 * including file has included a simd_<isa>.h and defined NARC_ISA_NAME.
 */
#include <float.h>
#include <stdbool.h>
#include <string.h>

#include "column.h"
#include "kernels.h"

/* Without shortcuts every pair goes to the deciding formula: the tests compare the two, bit for bit. */
#ifndef NARC_SHORTCUTS
#define NARC_SHORTCUTS 1
#endif

#include "relative.inl"

#include "overlay.inl"

#include "search.inl"

#include "proof.inl"

#include "contact.inl"
#include "overlap.inl"

#include "boxes.inl"

#include "lists.inl"

#include "support.inl"

#include "first.inl"

#include "polygon.inl"

#include "epa.inl"

#include "gjk.inl"

#include "pose.inl"

#define NARC_JOIN_(a, b) a##b
#define NARC_JOIN(a, b)  NARC_JOIN_(a, b)
#define NARC_TEXT_(a)    #a
#define NARC_TEXT(a)     NARC_TEXT_(a)

const narc_kernel_table NARC_JOIN(narc_kernels_, NARC_ISA_NAME) = {
    .isa = NARC_TEXT(NARC_ISA_NAME),
#define NARC_KERNEL(type, name, parameters) .name = name,
#include "kernels.def"
#undef NARC_KERNEL
};
