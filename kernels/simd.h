/* SPDX-License-Identifier: MIT
 *
 * simd.h - the contract of the vector wrapper. simd_<isa>.h implements it, one line for each operation, all in this
 * order.
 *
 * Types: vf, V_WIDTH floats; vi, as many int32; vm, a predicate for each lane, opaque (a vector, a mask register or an
 * int). V_WIDTH divides 64. Every operation is lane by lane and correctly rounded where it rounds, so that a kernel
 * written with them gives the same bits whatever the width. There is no fused multiply-add and no estimate on purpose.
 *
 *   v_set(float)  v_load(float *)  v_store(float *, vf)         any alignment
 *   v_gather(float *base, vi index)                             base[index[lane]]
 *   v_add v_sub v_mul v_div v_sqrt v_abs v_neg
 *   v_min v_max                                                 exactly a < b ? a : b and a > b ? a : b
 *   v_lt v_le                                                   false where an operand is NaN
 *   v_select(vm, vf a, vf b)                                    a where true, b elsewhere
 *   vi_set vi_load vi_store vi_gather vi_add vi_lt vi_select    the same for int32; vi_add wraps
 *   vi_bits(vf)                                                 the bits of a float
 *   vi_lanes()                                                  0, 1, 2 ...
 *   vm_and vm_or
 *   vm_bits(vm)                                                 bit k is lane k
 *   vm_any(vm)
 */
#ifndef NARC_SIMD_H
#define NARC_SIMD_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <string.h>

#endif
