/* SPDX-License-Identifier: MIT
 *
 * simd.h - the contract of the vector wrapper. <isa>.h implements it, one line for each operation, all in this
 * order. NARC_SIMD, which the compiler's command line or the including file defines, names the one to use.
 *
 * Types: vf, V_WIDTH floats; vi, as many int32; vm, a predicate for each lane, opaque (a vector, a mask register or an
 * int); vp, how to pack the lanes of a predicate. V_WIDTH divides 64. Every operation is lane by lane and correctly
 * rounded where it rounds, so that a kernel written with them gives the same bits whatever the width. There is no fused
 * multiply-add and no estimate on purpose.
 *
 *   v_set(float)  v_load(float *)  v_store(float *, vf)         any alignment
 *   v_load_8(float *)                                           no more than eight of them, zeros behind
 *   v_rows(void *base, ptrdiff_t stride, int32_t *index, vf out[4])
 *                                                               four floats from byte index[lane] * stride of base
 *   v_put_rows(char *const *place, int offset, vf in[4])        four floats to byte `offset` of place[lane], lane by lane
 *   v_double_differences(struct double_rows *rows, int32_t *a, int32_t *b, vf *shifts, vf out[2])
 *                                                               of two doubles from byte index[lane] * stride of
 *                                                               rows->b on those of rows->a, plus two shifts for
 *                                                               each lane unless NULL; in double precision, rounded
 *   v_add v_sub v_mul v_div v_sqrt v_abs v_neg
 *   v_min v_max                                                 exactly a < b ? a : b and a > b ? a : b
 *   v_lt v_le                                                   false where an operand is NaN
 *   v_select(vm, vf a, vf b)                                    a where true, b elsewhere
 *   v_pack(vp, vf)                                              the lanes of the predicate, in order, in front; the
 *                                                               other lanes are of no use
 *   V_JOINS                                                     of one lane: others are to spare, and two vf go in one,
 *                                                               v_join() (base/ends.inl)
 *   vi_set vi_load vi_store vi_add vi_sub vi_lt vi_select        the same for int32; sums wrap
 *   vi_and vi_shift_left(vi, int) vi_shift_right(vi, int)       shifts fill up with zeros
 *   vi_bits(vf) v_of_bits(vi)                                   the bits of a float, and back
 *   v_of_int(vi)                                                to the nearest float
 *   vi_truncate(vf)                                             to int32, towards 0; out of range or NaN: any value
 *   vi_count16(vi counts, vi below, vi values)                  adds 1 to each 16-bit half of counts where that half of
 *                                                               values is less than that of below, both signed
 *   V_COUNT_EIGHT(int16_t *values, vi below)                    of one lane, if there is such an instruction: how many of
 *                                                               eight numbers are less than the low half of below
 *   vi_lanes()                                                  0, 1, 2 ...
 *   vm_and vm_or vm_xor vm_not vm_and_not(a, b)                 the last: a and not b
 *   vm_front(int)                                               true in that many lanes, the front ones
 *   vm_bits(vm)                                                 bit k is lane k
 *   vm_packing(vm)                                              the vp of a predicate
 *   vm_any(vm)
 *   V_SINCOS                                                    the name of SLEEF's deterministic sincos() of a vf
 */
#ifndef NARC_SIMD_H
#define NARC_SIMD_H

#include <float.h>
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "compiler.h"

/* Where two sets of rows begin that have two doubles in front, and the bytes from one to the next. */
struct double_rows {
    const char *a, *b;
    ptrdiff_t stride_a, stride_b;
};

#ifndef NARC_SIMD
#error "define NARC_SIMD, the file of a vector wrapper: \"simd/scalar.h\""
#endif
#include NARC_SIMD

#if V_WIDTH <= 8
#define v_load_8 v_load
#endif

#endif
