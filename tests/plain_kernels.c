/* SPDX-License-Identifier: MIT
 *
 * plain_kernels.c - the kernels' scalar table without shortcuts.
 */
#include "simd_scalar.h"

#define NARC_SHORTCUTS 0
#define NARC_ISA_NAME  plain
#include "table.inl"
