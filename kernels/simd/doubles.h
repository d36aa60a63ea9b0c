/* SPDX-License-Identifier: MIT
 *
 * doubles.h - double lanes, for what single precision is not enough for: half as many as floats, and one if there is
 * one. Sums, differences, products and quotients are the language's own operators, and so are & | ~ of predicates. All
 * are correctly rounded, as in simd.h.
 */
#ifndef NARC_SIMD_DOUBLES_H
#define NARC_SIMD_DOUBLES_H

#include "simd/simd.h"

#if V_WIDTH == 1
enum { D_WIDTH = 1 };
typedef double vd;
typedef int64_t vl; /* a predicate: 0 or -1 in each lane */

INLINE vd d_set(double a) { return a; }
INLINE vl d_lt(vd a, vd b) { return -(vl)(a < b); }
INLINE vl d_le(vd a, vd b) { return -(vl)(a <= b); }
INLINE vd d_select(vl m, vd a, vd b) { return m ? a : b; }
INLINE vd d_sqrt(vd a) { return sqrt(a); }
INLINE int d_any(vl m) { return m != 0; }
INLINE vd d_of_floats(const float *p) { return (double)*p; }
INLINE void d_put_floats(float *p, vd a) { *p = (float)a; }
#else
#if defined(__SSE2__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#elif defined(__wasm_simd128__)
#include <wasm_simd128.h>
#endif
enum { D_WIDTH = V_WIDTH / 2 };
typedef double vd VECTOR_OF(8 * V_WIDTH / 2);
typedef int64_t vl VECTOR_OF(8 * V_WIDTH / 2);

INLINE vd d_set(double a) { return a - (vd){0}; }
INLINE vl d_lt(vd a, vd b) { return (vl)(a < b); }
INLINE vl d_le(vd a, vd b) { return (vl)(a <= b); }
INLINE vd d_select(vl m, vd a, vd b) { return (vd)((m & (vl)a) | (~m & (vl)b)); }
/* Conversions by intrinsics: GCC 12 takes (double)(float)a for a, where it makes vectors of such lanes itself. */
#if V_WIDTH == 16
INLINE vd d_sqrt(vd a) { return _mm512_sqrt_pd(a); }
INLINE vd d_of_floats(const float *p) { return _mm512_cvtps_pd(_mm256_loadu_ps(p)); }
INLINE void d_put_floats(float *p, vd a) { _mm256_storeu_ps(p, _mm512_cvtpd_ps(a)); }
#elif V_WIDTH == 8
INLINE vd d_sqrt(vd a) { return _mm256_sqrt_pd(a); }
INLINE vd d_of_floats(const float *p) { return _mm256_cvtps_pd(_mm_loadu_ps(p)); }
INLINE void d_put_floats(float *p, vd a) { _mm_storeu_ps(p, _mm256_cvtpd_ps(a)); }
#elif defined(__SSE2__)
INLINE vd d_sqrt(vd a) { return _mm_sqrt_pd(a); }
INLINE vd d_of_floats(const float *p) {
    return _mm_cvtps_pd(_mm_castsi128_ps(_mm_loadl_epi64((const __m128i *)(const void *)p)));
}
INLINE void d_put_floats(float *p, vd a) { _mm_storel_epi64((__m128i *)(void *)p, _mm_castps_si128(_mm_cvtpd_ps(a))); }
#elif defined(__aarch64__)
INLINE vd d_sqrt(vd a) { return (vd)vsqrtq_f64((float64x2_t)a); }
INLINE vd d_of_floats(const float *p) { return (vd)vcvt_f64_f32(vld1_f32(p)); }
INLINE void d_put_floats(float *p, vd a) { vst1_f32(p, vcvt_f32_f64((float64x2_t)a)); }
#else
INLINE vd d_sqrt(vd a) { return (vd)wasm_f64x2_sqrt((v128_t)a); }
INLINE vd d_of_floats(const float *p) { return (vd)wasm_f64x2_promote_low_f32x4(wasm_v128_load64_zero(p)); }
INLINE void d_put_floats(float *p, vd a) { wasm_v128_store64_lane(p, wasm_f32x4_demote_f64x2_zero((v128_t)a), 0); }
#endif
INLINE int d_any(vl m) {
    int64_t all = 0;
    for (int l = 0; l < D_WIDTH; l++)
        all |= m[l];
    return all != 0;
}
#endif

INLINE vd d_load(const double *p) {
    vd a;
    memcpy(&a, p, sizeof a);
    return a;
}
INLINE void d_store(double *p, vd a) { memcpy(p, &a, sizeof a); }
INLINE vd d_min(vd a, vd b) { return d_select(d_lt(a, b), a, b); }
INLINE vd d_abs(vd a) { return d_select(d_lt(a, d_set(0)), -a, a); }

#endif
