/* SPDX-License-Identifier: MIT
 *
 * isa_avx512.c - the kernels' avx512 table.
 */
#include "simd_avx512.h"

#define NARC_ISA_NAME avx512
#include "table.inl"
