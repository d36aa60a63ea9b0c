/* SPDX-License-Identifier: MIT
 *
 * x86.h - what the wrappers of both x86 instruction sets need.
 */
#ifndef NARC_SIMD_X86_H
#define NARC_SIMD_X86_H

#include <immintrin.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The differences of two lanes that follow each other. */
static inline __attribute__((always_inline)) __m128
v_two_differences(const char *base, ptrdiff_t stride, const int32_t *a, const int32_t *b, bool shifted, __m128 shifts) {
    __m256d from =
        _mm256_castpd128_pd256(_mm_loadu_pd((const double *)(const void *)(base + (ptrdiff_t)(uint32_t)a[0] * stride)));
    __m256d to =
        _mm256_castpd128_pd256(_mm_loadu_pd((const double *)(const void *)(base + (ptrdiff_t)(uint32_t)b[0] * stride)));
    from = _mm256_insertf128_pd(
        from, _mm_loadu_pd((const double *)(const void *)(base + (ptrdiff_t)(uint32_t)a[1] * stride)), 1);
    to = _mm256_insertf128_pd(
        to, _mm_loadu_pd((const double *)(const void *)(base + (ptrdiff_t)(uint32_t)b[1] * stride)), 1);
    const __m256d difference = _mm256_sub_pd(to, from);
    return _mm256_cvtpd_ps(shifted ? _mm256_add_pd(difference, _mm256_cvtps_pd(shifts)) : difference);
}

#endif
