/* SPDX-License-Identifier: MIT
 *
 * doubles.h - double lanes, for what single precision is not enough for: half as many as floats, and one if there is
 * one. Sums, differences, products and quotients are the language's own operators, and so are & | ~ of predicates. All
 * are correctly rounded, as in simd.h; other operations do what theirs of floats do. d_of_lanes(m, h) is what a predicate
 * of floats says of lanes h ..., 0 or D_WIDTH; d_pack(m, a) packs the lanes m. d_join_floats(a) rounds as many as make a vector
 * of floats, which memory would make wait: a vector is not read from two halves that were just written.
 */
#ifndef NARC_SIMD_DOUBLES_H
#define NARC_SIMD_DOUBLES_H

#include "simd/simd.h"

#if V_WIDTH == 1 && !defined(NARC_SIMD_ONE_H)
enum { D_WIDTH = 1 };
typedef double vd;
typedef int64_t vl; /* a predicate: 0 or -1 in each lane, or a mask register's bits */

INLINE vd d_set(double a) { return a; }
INLINE vl d_lt(vd a, vd b) { return -(vl)(a < b); }
INLINE vl d_le(vd a, vd b) { return -(vl)(a <= b); }
INLINE vd d_select(vl m, vd a, vd b) { return m ? a : b; }
INLINE vd d_sqrt(vd a) { return sqrt(a); }
INLINE vd d_abs(vd a) { return fabs(a); }
INLINE vd d_min(vd a, vd b) { return a < b ? a : b; }
INLINE vd d_max(vd a, vd b) { return a > b ? a : b; }
INLINE uint32_t d_bits(vl m) { return m & 1; }
INLINE vl d_of_lanes(vm m, int h) { return -(vl)(m << h); }
INLINE vd d_pack(vl m, vd a) { return m ? a : 0; }
INLINE vd d_of_floats(const float *p) { return (double)*p; }
INLINE void d_put_floats(float *p, vd a) { *p = (float)a; }
INLINE vf d_join_floats(const vd *a) { return (float)*a; }
#else
#if defined(__AVX__)
#include <immintrin.h>
#elif defined(__SSE2__)
#include <smmintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif
#ifdef NARC_SIMD_ONE_H /* one lane of a register */
enum { D_WIDTH = 1, D_BYTES = 16 };
#else
enum { D_WIDTH = V_WIDTH / 2, D_BYTES = 8 * V_WIDTH / 2 };
#endif
typedef double vd VECTOR_OF(D_BYTES);

INLINE vd d_set(double a) { return a - (vd){0}; }
/* Conversions by intrinsics: GCC 12 takes (double)(float)a for a, where it makes vectors of such lanes itself. */
#if V_WIDTH == 16
typedef uint32_t vl;
INLINE vl d_lt(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LT_OQ); }
INLINE vl d_le(vd a, vd b) { return _mm512_cmp_pd_mask(a, b, _CMP_LE_OQ); }
INLINE vd d_select(vl m, vd a, vd b) { return _mm512_mask_blend_pd((__mmask8)m, b, a); }
INLINE vd d_sqrt(vd a) { return _mm512_sqrt_pd(a); }
INLINE vd d_abs(vd a) { return _mm512_abs_pd(a); }
INLINE vd d_min(vd a, vd b) { return _mm512_min_pd(a, b); }
INLINE vd d_max(vd a, vd b) { return _mm512_max_pd(a, b); }
INLINE uint32_t d_bits(vl m) { return (__mmask8)m; }
INLINE vl d_of_lanes(vm m, int h) { return (vl)m >> h; }
INLINE vd d_pack(vl m, vd a) { return _mm512_maskz_compress_pd((__mmask8)m, a); }
INLINE vd d_of_floats(const float *p) { return _mm512_cvtps_pd(_mm256_loadu_ps(p)); }
INLINE void d_put_floats(float *p, vd a) { _mm256_storeu_ps(p, _mm512_cvtpd_ps(a)); }
INLINE vf d_join_floats(const vd *a) {
    const __m256d low = _mm256_castps_pd(_mm512_cvtpd_ps(a[0])), high = _mm256_castps_pd(_mm512_cvtpd_ps(a[1]));
    return _mm512_castpd_ps(_mm512_insertf64x4(_mm512_castpd256_pd512(low), high, 1));
}
#else
typedef int64_t vl VECTOR_OF(D_BYTES);
INLINE vl d_lt(vd a, vd b) { return (vl)(a < b); }
INLINE vl d_le(vd a, vd b) { return (vl)(a <= b); }
INLINE vd d_abs(vd a) { return (vd)((vl)a & INT64_MAX); }
INLINE vd d_pack(vl m, vd a) { return (vd)v_pack(vm_packing((vm)m), (vf)a); }
#if V_WIDTH == 8
INLINE vd d_select(vl m, vd a, vd b) { return _mm256_blendv_pd(b, a, (vd)m); }
INLINE vd d_sqrt(vd a) { return _mm256_sqrt_pd(a); }
INLINE vd d_min(vd a, vd b) { return _mm256_min_pd(a, b); }
INLINE vd d_max(vd a, vd b) { return _mm256_max_pd(a, b); }
INLINE uint32_t d_bits(vl m) { return (uint32_t)_mm256_movemask_pd((vd)m); }
INLINE vl d_of_lanes(vm m, int h) {
    const __m256i all = _mm256_castps_si256(m);
    return (vl)_mm256_cvtepi32_epi64(h ? _mm256_extracti128_si256(all, 1) : _mm256_castsi256_si128(all));
}
INLINE vd d_of_floats(const float *p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
INLINE void d_put_floats(float *p, vd a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a)); }
INLINE vf d_join_floats(const vd *a) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm256_cvtpd_ps(a[0])), _mm256_cvtpd_ps(a[1]), 1);
}
#elif defined(__SSE2__)
INLINE vd d_select(vl m, vd a, vd b) { return _mm_blendv_pd(b, a, (vd)m); }
INLINE vd d_sqrt(vd a) { return _mm_sqrt_pd(a); }
INLINE vd d_min(vd a, vd b) { return _mm_min_pd(a, b); }
INLINE vd d_max(vd a, vd b) { return _mm_max_pd(a, b); }
INLINE uint32_t d_bits(vl m) { return (uint32_t)_mm_movemask_pd((vd)m) & ((1 << D_WIDTH) - 1); }
INLINE vl d_of_lanes(vm m, int h) { return (vl)(h ? _mm_unpackhi_ps(m, m) : _mm_unpacklo_ps(m, m)); }
#ifdef NARC_SIMD_ONE_H
INLINE vd d_of_floats(const float *p) { return _mm_cvtss_sd(_mm_setzero_pd(), _mm_load_ss(p)); }
INLINE void d_put_floats(float *p, vd a) { _mm_store_ss(p, _mm_cvtsd_ss(_mm_setzero_ps(), a)); }
INLINE vf d_join_floats(const vd *a) { return _mm_cvtpd_ps(*a); }
#else
INLINE vd d_of_floats(const float *p) {
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)p)));
}
INLINE void d_put_floats(float *p, vd a) { _mm_storel_epi64((__m128i *)(void *)p, _mm_castps_si128(_mm_cvtpd_ps(a))); }
INLINE vf d_join_floats(const vd *a) { return _mm_movelh_ps(_mm_cvtpd_ps(a[0]), _mm_cvtpd_ps(a[1])); }
#endif
#else
INLINE vd d_select(vl m, vd a, vd b) { return (vd)((m & (vl)a) | (~m & (vl)b)); }
INLINE vd d_min(vd a, vd b) { return d_select(d_lt(a, b), a, b); }
INLINE vd d_max(vd a, vd b) { return d_select(d_lt(b, a), a, b); }
INLINE uint32_t d_bits(vl m) { return (uint32_t)((m[0] & 1) | (m[1] & 2)); }
#if defined(__aarch64__)
INLINE vl d_of_lanes(vm m, int h) { return (vl)(h ? vzip2q_u32(m, m) : vzip1q_u32(m, m)); }
INLINE vd d_sqrt(vd a) { return (vd)vsqrtq_f64((float64x2_t)a); }
INLINE vd d_of_floats(const float *p) { return (vd)vcvt_f64_f32(vld1_f32(p)); }
INLINE void d_put_floats(float *p, vd a) { vst1_f32(p, vcvt_f32_f64((float64x2_t)a)); }
INLINE vf d_join_floats(const vd *a) { return vcvt_high_f32_f64(vcvt_f32_f64((float64x2_t)a[0]), (float64x2_t)a[1]); }
#else
INLINE vl d_of_lanes(vm m, int h) {
    return (vl)(h ? wasm_i32x4_shuffle(m, m, 2, 2, 3, 3) : wasm_i32x4_shuffle(m, m, 0, 0, 1, 1));
}
INLINE vd d_sqrt(vd a) { return (vd)wasm_f64x2_sqrt((v128_t)a); }
INLINE vd d_of_floats(const float *p) { return (vd)wasm_f64x2_promote_low_f32x4(wasm_v128_load64_zero(p)); }
INLINE void d_put_floats(float *p, vd a) { wasm_v128_store64_lane(p, wasm_f32x4_demote_f64x2_zero((v128_t)a), 0); }
INLINE vf d_join_floats(const vd *a) {
    return wasm_i64x2_shuffle(wasm_f32x4_demote_f64x2_zero((v128_t)a[0]), wasm_f32x4_demote_f64x2_zero((v128_t)a[1]), 0,
                              2);
}
#endif
#endif
#endif
#endif
INLINE int d_any(vl m) { return d_bits(m) != 0; }

/* A register of which one lane is in use has room for two: d_both() fills it, and d_other() takes the second out. Elsewhere
 * both leave the first as it is. D_HELD lanes are in use then, of which d_any_held() asks. */
#ifdef NARC_SIMD_ONE_H
enum { D_ROOM = 2 };
INLINE vd d_both(vd a, vd b) { return _mm_unpacklo_pd(a, b); }
INLINE vd d_other(vd a) { return _mm_unpackhi_pd(a, a); }
INLINE int d_any_held(vl m) { return _mm_movemask_pd((vd)m) != 0; }
#else
enum { D_ROOM = 1 };
INLINE vd d_both(vd a, vd b) {
    (void)b;
    return a;
}
INLINE vd d_other(vd a) { return a; }
INLINE int d_any_held(vl m) { return d_any(m); }
#endif
enum { D_HELD = D_ROOM * D_WIDTH };

#ifdef NARC_SIMD_ONE_H
INLINE vd d_load(const double *p) { return d_set(*p); }
INLINE void d_store(double *p, vd a) { *p = a[0]; }
#else
INLINE vd d_load(const double *p) {
    vd a;
    memcpy(&a, p, sizeof a);
    return a;
}
INLINE void d_store(double *p, vd a) { memcpy(p, &a, sizeof a); }
#endif

#endif
