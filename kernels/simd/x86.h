/* SPDX-License-Identifier: MIT
 *
 * x86.h - what the wrappers of x86 instruction sets share.
 */
#ifndef NARC_SIMD_X86_H
#define NARC_SIMD_X86_H

#include "simd/simd.h"

#ifdef __AVX__
#include <immintrin.h>
#else /* a tenth of that to read */
#include <smmintrin.h>
#endif

/* Indices that kernels have just stored, compilers take from the vector that they were in: by pairs, since 64 bits come
 * out as fast as 32. */
INLINE void v_indices(const int32_t *index, int count, size_t *out) {
    UNROLL
    for (int k = 0; k < count; k += 2) {
        uint64_t two;
        memcpy(&two, index + k, sizeof two);
        out[k] = (uint32_t)two;
        out[k + 1] = (size_t)(two >> 32);
    }
}
INLINE __m128 v_row(const char *base, ptrdiff_t stride, size_t index) {
    return _mm_loadu_ps((const float *)(const void *)(base + (ptrdiff_t)index * stride));
}
INLINE void v_put_row(char *place, int offset, __m128 row) { _mm_storeu_ps((float *)(void *)(place + offset), row); }
INLINE __m128d v_double_row(const char *base, ptrdiff_t stride, int32_t index) {
    return _mm_loadu_pd((const double *)(const void *)(base + (ptrdiff_t)(uint32_t)index * stride));
}

/* The differences of two lanes that follow each other. */
#ifdef __AVX__
INLINE __m256d v_two_double_rows(const char *base, ptrdiff_t stride, const int32_t *index) {
    const __m256d low = _mm256_castpd128_pd256(v_double_row(base, stride, index[0]));
    return _mm256_insertf128_pd(low, v_double_row(base, stride, index[1]), 1);
}
INLINE __m128 v_two_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, bool shifted,
                                __m128 shifts) {
    const __m256d from = v_two_double_rows(rows->a, rows->stride_a, a);
    const __m256d difference = _mm256_sub_pd(v_two_double_rows(rows->b, rows->stride_b, b), from);
    return _mm256_cvtpd_ps(shifted ? _mm256_add_pd(difference, _mm256_cvtps_pd(shifts)) : difference);
}
#else
INLINE __m128 v_difference(const struct double_rows *rows, int32_t a, int32_t b, bool shifted, __m128 shift) {
    const __m128d from = v_double_row(rows->a, rows->stride_a, a), to = v_double_row(rows->b, rows->stride_b, b);
    const __m128d difference = _mm_sub_pd(to, from);
    return _mm_cvtpd_ps(shifted ? _mm_add_pd(difference, _mm_cvtps_pd(shift)) : difference);
}
INLINE __m128 v_two_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, bool shifted,
                                __m128 shifts) {
    return _mm_movelh_ps(v_difference(rows, a[0], b[0], shifted, shifts),
                         v_difference(rows, a[1], b[1], shifted, _mm_movehl_ps(shifts, shifts)));
}
#endif

#endif
