/* SPDX-License-Identifier: MIT
 *
 * neon.h - the vector wrapper with four lanes: NEON on AArch64.
 */
#ifndef NARC_SIMD_NEON_H
#define NARC_SIMD_NEON_H

#include "simd/simd.h"

#if !defined(__ARM_NEON) || !defined(__aarch64__)
#error "compile for AArch64"
#endif
#include <arm_neon.h>

#include "simd/packing.h"

#define V_WIDTH  4
#define V_SINCOS Sleef_cinz_sincosf4_u10advsimdnofma
typedef float32x4_t vf;
typedef int32x4_t vi;
typedef uint32x4_t vm;
typedef uint8x16_t vp;

INLINE vf v_set(float a) { return vdupq_n_f32(a); }
INLINE vf v_load(const float *p) { return vld1q_f32(p); }
INLINE void v_store(float *p, vf a) { vst1q_f32(p, a); }
INLINE vf v_row(const void *base, ptrdiff_t stride, int32_t index) {
    return vld1q_f32((const float *)(const void *)((const char *)base + (ptrdiff_t)(uint32_t)index * stride));
}
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    const vf a = v_row(base, stride, index[0]), b = v_row(base, stride, index[1]);
    const vf c = v_row(base, stride, index[2]), d = v_row(base, stride, index[3]);
    const vf ac_low = vzip1q_f32(a, c), ac_high = vzip2q_f32(a, c);
    const vf bd_low = vzip1q_f32(b, d), bd_high = vzip2q_f32(b, d);
    out[0] = vzip1q_f32(ac_low, bd_low);
    out[1] = vzip2q_f32(ac_low, bd_low);
    out[2] = vzip1q_f32(ac_high, bd_high);
    out[3] = vzip2q_f32(ac_high, bd_high);
}
INLINE void v_put_row(char *place, vf row) { vst1q_f32((float *)(void *)place, row); }
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    const vf low02 = vzip1q_f32(in[0], in[2]), high02 = vzip2q_f32(in[0], in[2]);
    const vf low13 = vzip1q_f32(in[1], in[3]), high13 = vzip2q_f32(in[1], in[3]);
    v_put_row(place[0] + offset, vzip1q_f32(low02, low13));
    v_put_row(place[1] + offset, vzip2q_f32(low02, low13));
    v_put_row(place[2] + offset, vzip1q_f32(high02, high13));
    v_put_row(place[3] + offset, vzip2q_f32(high02, high13));
}
/* The differences of one lane. */
INLINE float32x2_t v_double_difference(const struct double_rows *rows, int32_t a, int32_t b, bool shifted,
                                       float32x2_t shift) {
    const float64x2_t from =
        vld1q_f64((const double *)(const void *)(rows->a + (ptrdiff_t)(uint32_t)a * rows->stride_a));
    const float64x2_t to = vld1q_f64((const double *)(const void *)(rows->b + (ptrdiff_t)(uint32_t)b * rows->stride_b));
    const float64x2_t difference = vsubq_f64(to, from);
    return vcvt_f32_f64(shifted ? vaddq_f64(difference, vcvt_f64_f32(shift)) : difference);
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const bool shifted = shifts != NULL;
    const vf s_low = shifted ? vzip1q_f32(shifts[0], shifts[1]) : vdupq_n_f32(0);
    const vf s_high = shifted ? vzip2q_f32(shifts[0], shifts[1]) : vdupq_n_f32(0);
    const vf low = vcombine_f32(v_double_difference(rows, a[0], b[0], shifted, vget_low_f32(s_low)),
                                v_double_difference(rows, a[1], b[1], shifted, vget_high_f32(s_low)));
    const vf high = vcombine_f32(v_double_difference(rows, a[2], b[2], shifted, vget_low_f32(s_high)),
                                 v_double_difference(rows, a[3], b[3], shifted, vget_high_f32(s_high)));
    out[0] = vuzp1q_f32(low, high);
    out[1] = vuzp2q_f32(low, high);
}
INLINE vf v_add(vf a, vf b) { return vaddq_f32(a, b); }
INLINE vf v_sub(vf a, vf b) { return vsubq_f32(a, b); }
INLINE vf v_mul(vf a, vf b) { return vmulq_f32(a, b); }
INLINE vf v_div(vf a, vf b) { return vdivq_f32(a, b); }
INLINE vf v_sqrt(vf a) { return vsqrtq_f32(a); }
INLINE vf v_abs(vf a) { return vabsq_f32(a); }
INLINE vf v_neg(vf a) { return vnegq_f32(a); }
INLINE vf v_min(vf a, vf b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
INLINE vf v_max(vf a, vf b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
INLINE vm v_lt(vf a, vf b) { return vcltq_f32(a, b); }
INLINE vm v_le(vf a, vf b) { return vcleq_f32(a, b); }
INLINE vf v_select(vm m, vf a, vf b) { return vbslq_f32(m, a, b); }
INLINE vf v_pack(vp p, vf a) { return vreinterpretq_f32_u8(vqtbl1q_u8(vreinterpretq_u8_f32(a), p)); }
INLINE vi vi_set(int32_t a) { return vdupq_n_s32(a); }
INLINE vi vi_load(const int32_t *p) { return vld1q_s32(p); }
INLINE void vi_store(int32_t *p, vi a) { vst1q_s32(p, a); }
INLINE vi vi_add(vi a, vi b) { return vaddq_s32(a, b); }
INLINE vi vi_sub(vi a, vi b) { return vsubq_s32(a, b); }
INLINE vm vi_lt(vi a, vi b) { return vcltq_s32(a, b); }
INLINE vi vi_select(vm m, vi a, vi b) { return vbslq_s32(m, a, b); }
INLINE vi vi_and(vi a, vi b) { return vandq_s32(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return vshlq_s32(a, vdupq_n_s32(n)); }
INLINE vi vi_shift_right(vi a, int n) {
    return vreinterpretq_s32_u32(vshlq_u32(vreinterpretq_u32_s32(a), vdupq_n_s32(-n)));
}
INLINE vi vi_bits(vf a) { return vreinterpretq_s32_f32(a); }
INLINE vf v_of_bits(vi a) { return vreinterpretq_f32_s32(a); }
INLINE vf v_of_int(vi a) { return vcvtq_f32_s32(a); }
INLINE vi vi_truncate(vf a) { return vcvtq_s32_f32(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) {
    const uint16x8_t less = vcltq_s16(vreinterpretq_s16_s32(values), vreinterpretq_s16_s32(below));
    return vreinterpretq_s32_u16(vsubq_u16(vreinterpretq_u16_s32(counts), less));
}
INLINE vi vi_lanes(void) { return vld1q_s32((const int32_t[4]){0, 1, 2, 3}); }
INLINE vm vm_and(vm a, vm b) { return vandq_u32(a, b); }
INLINE vm vm_or(vm a, vm b) { return vorrq_u32(a, b); }
INLINE vm vm_xor(vm a, vm b) { return veorq_u32(a, b); }
INLINE vm vm_not(vm a) { return vmvnq_u32(a); }
INLINE vm vm_and_not(vm a, vm b) { return vbicq_u32(a, b); }
INLINE vm vm_front(int n) { return vi_lt(vi_lanes(), vi_set(n)); }
INLINE uint32_t vm_bits(vm a) { return vaddvq_u32(vandq_u32(a, vld1q_u32((const uint32_t[4]){1, 2, 4, 8}))); }
INLINE vp vm_packing(vm a) { return vld1q_u8(v_four_lanes[vm_bits(a)]); }
INLINE int vm_any(vm a) { return vmaxvq_u32(a) != 0; }

#endif
