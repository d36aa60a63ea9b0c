/* SPDX-License-Identifier: MIT
 *
 * isa_avx2.c - the kernels' avx2 table.
 */
#include "simd_avx2.h"

#define NARC_ISA_NAME avx2
#include "table.inl"
