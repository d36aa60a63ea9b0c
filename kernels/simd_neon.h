/* SPDX-License-Identifier: MIT
 *
 * simd_neon.h - the vector wrapper with four lanes: NEON on AArch64.
 */
#include "simd.h"

#if !defined(__ARM_NEON) || !defined(__aarch64__)
#error "compile for AArch64"
#endif
#include <arm_neon.h>

#define V_WIDTH 4
typedef float32x4_t vf;
typedef int32x4_t vi;
typedef uint32x4_t vm;

static inline vf v_set(float a) { return vdupq_n_f32(a); }
static inline vf v_load(const float *p) { return vld1q_f32(p); }
static inline void v_store(float *p, vf a) { vst1q_f32(p, a); }
static inline vf v_gather(const float *base, vi index) {
    vf a = vdupq_n_f32(base[vgetq_lane_s32(index, 0)]);
    a = vld1q_lane_f32(base + vgetq_lane_s32(index, 1), a, 1);
    a = vld1q_lane_f32(base + vgetq_lane_s32(index, 2), a, 2);
    return vld1q_lane_f32(base + vgetq_lane_s32(index, 3), a, 3);
}
static inline vf v_add(vf a, vf b) { return vaddq_f32(a, b); }
static inline vf v_sub(vf a, vf b) { return vsubq_f32(a, b); }
static inline vf v_mul(vf a, vf b) { return vmulq_f32(a, b); }
static inline vf v_div(vf a, vf b) { return vdivq_f32(a, b); }
static inline vf v_sqrt(vf a) { return vsqrtq_f32(a); }
static inline vf v_abs(vf a) { return vabsq_f32(a); }
static inline vf v_neg(vf a) { return vnegq_f32(a); }
static inline vf v_min(vf a, vf b) { return vbslq_f32(vcltq_f32(a, b), a, b); }
static inline vf v_max(vf a, vf b) { return vbslq_f32(vcgtq_f32(a, b), a, b); }
static inline vm v_lt(vf a, vf b) { return vcltq_f32(a, b); }
static inline vm v_le(vf a, vf b) { return vcleq_f32(a, b); }
static inline vf v_select(vm m, vf a, vf b) { return vbslq_f32(m, a, b); }
static inline vi vi_set(int32_t a) { return vdupq_n_s32(a); }
static inline vi vi_load(const int32_t *p) { return vld1q_s32(p); }
static inline void vi_store(int32_t *p, vi a) { vst1q_s32(p, a); }
static inline vi vi_gather(const int32_t *base, vi index) {
    vi a = vdupq_n_s32(base[vgetq_lane_s32(index, 0)]);
    a = vld1q_lane_s32(base + vgetq_lane_s32(index, 1), a, 1);
    a = vld1q_lane_s32(base + vgetq_lane_s32(index, 2), a, 2);
    return vld1q_lane_s32(base + vgetq_lane_s32(index, 3), a, 3);
}
static inline vi vi_add(vi a, vi b) { return vaddq_s32(a, b); }
static inline vm vi_lt(vi a, vi b) { return vcltq_s32(a, b); }
static inline vi vi_select(vm m, vi a, vi b) { return vbslq_s32(m, a, b); }
static inline vi vi_bits(vf a) { return vreinterpretq_s32_f32(a); }
static inline vi vi_lanes(void) { return vld1q_s32((const int32_t[4]){0, 1, 2, 3}); }
static inline vm vm_and(vm a, vm b) { return vandq_u32(a, b); }
static inline vm vm_or(vm a, vm b) { return vorrq_u32(a, b); }
static inline uint32_t vm_bits(vm a) { return vaddvq_u32(vandq_u32(a, vld1q_u32((const uint32_t[4]){1, 2, 4, 8}))); }
static inline int vm_any(vm a) { return vmaxvq_u32(a) != 0; }
