/* SPDX-License-Identifier: MIT
 *
 * wasm128.h - the vector wrapper with four lanes: WebAssembly's simd128.
 */
#ifndef NARC_SIMD_WASM128_H
#define NARC_SIMD_WASM128_H

#include "simd/simd.h"

#if !defined(__wasm_simd128__)
#error "compile with -msimd128"
#endif
#include <wasm_simd128.h>

#include "simd/packing.h"

#define V_WIDTH  4
#define V_SINCOS none /* SLEEF has no function for it */
typedef v128_t vf;
typedef v128_t vi;
typedef v128_t vm;
typedef v128_t vp;

INLINE vf v_set(float a) { return wasm_f32x4_splat(a); }
INLINE vf v_load(const float *p) { return wasm_v128_load(p); }
INLINE void v_store(float *p, vf a) { wasm_v128_store(p, a); }
INLINE vf v_zip_low(vf a, vf b) { return wasm_i32x4_shuffle(a, b, 0, 4, 1, 5); }
INLINE vf v_zip_high(vf a, vf b) { return wasm_i32x4_shuffle(a, b, 2, 6, 3, 7); }
INLINE vf v_row(const void *base, ptrdiff_t stride, int32_t index) {
    return wasm_v128_load((const char *)base + (ptrdiff_t)(uint32_t)index * stride);
}
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    const vf a = v_row(base, stride, index[0]), b = v_row(base, stride, index[1]);
    const vf c = v_row(base, stride, index[2]), d = v_row(base, stride, index[3]);
    const vf ac_low = v_zip_low(a, c), ac_high = v_zip_high(a, c);
    const vf bd_low = v_zip_low(b, d), bd_high = v_zip_high(b, d);
    out[0] = v_zip_low(ac_low, bd_low);
    out[1] = v_zip_high(ac_low, bd_low);
    out[2] = v_zip_low(ac_high, bd_high);
    out[3] = v_zip_high(ac_high, bd_high);
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    const vf low02 = v_zip_low(in[0], in[2]), high02 = v_zip_high(in[0], in[2]);
    const vf low13 = v_zip_low(in[1], in[3]), high13 = v_zip_high(in[1], in[3]);
    wasm_v128_store(place[0] + offset, v_zip_low(low02, low13));
    wasm_v128_store(place[1] + offset, v_zip_high(low02, low13));
    wasm_v128_store(place[2] + offset, v_zip_low(high02, high13));
    wasm_v128_store(place[3] + offset, v_zip_high(high02, high13));
}
/* The differences of one lane, in the two lower lanes; its shifts are those of the lower lanes. */
INLINE vf v_double_difference(const struct double_rows *rows, int32_t a, int32_t b, bool shifted, vf shift) {
    const v128_t from = v_row(rows->a, rows->stride_a, a), to = v_row(rows->b, rows->stride_b, b);
    const v128_t difference = wasm_f64x2_sub(to, from);
    return wasm_f32x4_demote_f64x2_zero(shifted ? wasm_f64x2_add(difference, wasm_f64x2_promote_low_f32x4(shift))
                                                : difference);
}
INLINE vf v_upper_half(vf a) { return wasm_i64x2_shuffle(a, a, 1, 1); }
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const bool shifted = shifts != NULL;
    const vf s_low = shifted ? v_zip_low(shifts[0], shifts[1]) : v_set(0);
    const vf s_high = shifted ? v_zip_high(shifts[0], shifts[1]) : v_set(0);
    const vf d0 = v_double_difference(rows, a[0], b[0], shifted, s_low);
    const vf d1 = v_double_difference(rows, a[1], b[1], shifted, v_upper_half(s_low));
    const vf d2 = v_double_difference(rows, a[2], b[2], shifted, s_high);
    const vf d3 = v_double_difference(rows, a[3], b[3], shifted, v_upper_half(s_high));
    const vf low = wasm_i64x2_shuffle(d0, d1, 0, 2), high = wasm_i64x2_shuffle(d2, d3, 0, 2);
    out[0] = wasm_i32x4_shuffle(low, high, 0, 2, 4, 6);
    out[1] = wasm_i32x4_shuffle(low, high, 1, 3, 5, 7);
}
INLINE vf v_add(vf a, vf b) { return wasm_f32x4_add(a, b); }
INLINE vf v_sub(vf a, vf b) { return wasm_f32x4_sub(a, b); }
INLINE vf v_mul(vf a, vf b) { return wasm_f32x4_mul(a, b); }
INLINE vf v_div(vf a, vf b) { return wasm_f32x4_div(a, b); }
INLINE vf v_sqrt(vf a) { return wasm_f32x4_sqrt(a); }
INLINE vf v_abs(vf a) { return wasm_f32x4_abs(a); }
INLINE vf v_neg(vf a) { return wasm_f32x4_neg(a); }
/* pmin(a, b) is b < a ? b : a, and pmax(a, b) is a < b ? b : a. */
INLINE vf v_min(vf a, vf b) { return wasm_f32x4_pmin(b, a); }
INLINE vf v_max(vf a, vf b) { return wasm_f32x4_pmax(b, a); }
INLINE vm v_lt(vf a, vf b) { return wasm_f32x4_lt(a, b); }
INLINE vm v_le(vf a, vf b) { return wasm_f32x4_le(a, b); }
INLINE vf v_select(vm m, vf a, vf b) { return wasm_v128_bitselect(a, b, m); }
INLINE vf v_pack(vp p, vf a) { return wasm_i8x16_swizzle(a, p); }
INLINE vi vi_set(int32_t a) { return wasm_i32x4_splat(a); }
INLINE vi vi_load(const int32_t *p) { return wasm_v128_load(p); }
INLINE void vi_store(int32_t *p, vi a) { wasm_v128_store(p, a); }
INLINE vi vi_add(vi a, vi b) { return wasm_i32x4_add(a, b); }
INLINE vi vi_sub(vi a, vi b) { return wasm_i32x4_sub(a, b); }
INLINE vm vi_lt(vi a, vi b) { return wasm_i32x4_lt(a, b); }
INLINE vi vi_select(vm m, vi a, vi b) { return wasm_v128_bitselect(a, b, m); }
INLINE vi vi_and(vi a, vi b) { return wasm_v128_and(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return wasm_i32x4_shl(a, (uint32_t)n); }
INLINE vi vi_shift_right(vi a, int n) { return wasm_u32x4_shr(a, (uint32_t)n); }
INLINE vi vi_bits(vf a) { return a; }
INLINE vf v_of_bits(vi a) { return a; }
INLINE vf v_of_int(vi a) { return wasm_f32x4_convert_i32x4(a); }
INLINE vi vi_truncate(vf a) { return wasm_i32x4_trunc_sat_f32x4(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) { return wasm_i16x8_sub(counts, wasm_i16x8_lt(values, below)); }
INLINE vi vi_lanes(void) { return wasm_i32x4_const(0, 1, 2, 3); }
INLINE vm vm_and(vm a, vm b) { return wasm_v128_and(a, b); }
INLINE vm vm_or(vm a, vm b) { return wasm_v128_or(a, b); }
INLINE vm vm_xor(vm a, vm b) { return wasm_v128_xor(a, b); }
INLINE vm vm_not(vm a) { return wasm_v128_not(a); }
INLINE vm vm_and_not(vm a, vm b) { return wasm_v128_andnot(a, b); }
INLINE vm vm_front(int n) { return vi_lt(vi_lanes(), vi_set(n)); }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)wasm_i32x4_bitmask(a); }
INLINE vp vm_packing(vm a) { return wasm_v128_load(v_four_lanes[vm_bits(a)]); }
INLINE int vm_any(vm a) { return wasm_v128_any_true(a); }

#endif
