/* SPDX-License-Identifier: MIT
 *
 * isa_neon.c - the kernels' neon table.
 */
#include "simd_neon.h"

#define NARC_ISA_NAME neon
#include "table.inl"
