/* SPDX-License-Identifier: MIT
 *
 * isa_scalar.c - the kernels' scalar table.
 */
#include "simd_scalar.h"

#define NARC_ISA_NAME scalar
#include "table.inl"
