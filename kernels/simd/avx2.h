/* SPDX-License-Identifier: MIT
 *
 * avx2.h - the vector wrapper with eight lanes: AVX2.
 */
#ifndef NARC_SIMD_AVX2_H
#define NARC_SIMD_AVX2_H

#include "simd/simd.h"

#ifndef __AVX2__
#error "compile with -mavx2"
#endif
#include "simd/packing.h"
#include "simd/x86.h"

#define V_WIDTH  8
#define V_SINCOS Sleef_cinz_sincosf8_u10avx
typedef __m256 vf;
typedef __m256i vi;
typedef __m256 vm;
typedef __m256i vp;

INLINE vf v_set(float a) { return _mm256_set1_ps(a); }
INLINE vf v_load(const float *p) { return _mm256_loadu_ps(p); }
INLINE void v_store(float *p, vf a) { _mm256_storeu_ps(p, a); }
INLINE __m256 v_two_rows(const char *base, ptrdiff_t stride, const size_t *index) {
    const __m256 low = _mm256_castps128_ps256(v_row(base, stride, index[0]));
    return _mm256_insertf128_ps(low, v_row(base, stride, index[4]), 1);
}
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    size_t at[8];
    v_indices(index, 8, at);
    const __m256 a = v_two_rows(base, stride, at), b = v_two_rows(base, stride, at + 1);
    const __m256 c = v_two_rows(base, stride, at + 2), d = v_two_rows(base, stride, at + 3);
    const __m256 ab_low = _mm256_shuffle_ps(a, b, 0x44), ab_high = _mm256_shuffle_ps(a, b, 0xee);
    const __m256 cd_low = _mm256_shuffle_ps(c, d, 0x44), cd_high = _mm256_shuffle_ps(c, d, 0xee);
    out[0] = _mm256_shuffle_ps(ab_low, cd_low, 0x88);
    out[1] = _mm256_shuffle_ps(ab_low, cd_low, 0xdd);
    out[2] = _mm256_shuffle_ps(ab_high, cd_high, 0x88);
    out[3] = _mm256_shuffle_ps(ab_high, cd_high, 0xdd);
}
INLINE void v_put_two_rows(char *const *place, int offset, __m256 rows) {
    v_put_row(place[0], offset, _mm256_castps256_ps128(rows));
    v_put_row(place[4], offset, _mm256_extractf128_ps(rows, 1));
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    const __m256 low01 = _mm256_shuffle_ps(in[0], in[1], 0x44), high01 = _mm256_shuffle_ps(in[0], in[1], 0xee);
    const __m256 low23 = _mm256_shuffle_ps(in[2], in[3], 0x44), high23 = _mm256_shuffle_ps(in[2], in[3], 0xee);
    v_put_two_rows(place, offset, _mm256_shuffle_ps(low01, low23, 0x88));
    v_put_two_rows(place + 1, offset, _mm256_shuffle_ps(low01, low23, 0xdd));
    v_put_two_rows(place + 2, offset, _mm256_shuffle_ps(high01, high23, 0x88));
    v_put_two_rows(place + 3, offset, _mm256_shuffle_ps(high01, high23, 0xdd));
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const bool shifted = shifts != NULL;
    const __m256 zero = _mm256_setzero_ps();
    const __m256 s_low = shifted ? _mm256_unpacklo_ps(shifts[0], shifts[1]) : zero;
    const __m256 s_high = shifted ? _mm256_unpackhi_ps(shifts[0], shifts[1]) : zero;
    const __m128 d01 = v_two_differences(rows, a, b, shifted, _mm256_castps256_ps128(s_low));
    const __m128 d23 = v_two_differences(rows, a + 2, b + 2, shifted, _mm256_castps256_ps128(s_high));
    const __m128 d45 = v_two_differences(rows, a + 4, b + 4, shifted, _mm256_extractf128_ps(s_low, 1));
    const __m128 d67 = v_two_differences(rows, a + 6, b + 6, shifted, _mm256_extractf128_ps(s_high, 1));
    const __m256 low = _mm256_insertf128_ps(_mm256_castps128_ps256(d01), d45, 1);
    const __m256 high = _mm256_insertf128_ps(_mm256_castps128_ps256(d23), d67, 1);
    out[0] = _mm256_shuffle_ps(low, high, 0x88);
    out[1] = _mm256_shuffle_ps(low, high, 0xdd);
}
INLINE vf v_add(vf a, vf b) { return _mm256_add_ps(a, b); }
INLINE vf v_sub(vf a, vf b) { return _mm256_sub_ps(a, b); }
INLINE vf v_mul(vf a, vf b) { return _mm256_mul_ps(a, b); }
INLINE vf v_div(vf a, vf b) { return _mm256_div_ps(a, b); }
INLINE vf v_sqrt(vf a) { return _mm256_sqrt_ps(a); }
INLINE vf v_abs(vf a) { return _mm256_andnot_ps(_mm256_set1_ps(-0.0f), a); }
INLINE vf v_neg(vf a) { return _mm256_xor_ps(_mm256_set1_ps(-0.0f), a); }
INLINE vf v_min(vf a, vf b) { return _mm256_min_ps(a, b); }
INLINE vf v_max(vf a, vf b) { return _mm256_max_ps(a, b); }
INLINE vm v_lt(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_LT_OQ); }
INLINE vm v_le(vf a, vf b) { return _mm256_cmp_ps(a, b, _CMP_LE_OQ); }
INLINE vf v_select(vm m, vf a, vf b) { return _mm256_blendv_ps(b, a, m); }
INLINE vf v_pack(vp p, vf a) { return _mm256_permutevar8x32_ps(a, p); }
INLINE vi vi_set(int32_t a) { return _mm256_set1_epi32(a); }
INLINE vi vi_load(const int32_t *p) { return _mm256_loadu_si256((const __m256i *)p); }
INLINE void vi_store(int32_t *p, vi a) { _mm256_storeu_si256((__m256i *)p, a); }
INLINE vi vi_add(vi a, vi b) { return _mm256_add_epi32(a, b); }
INLINE vi vi_sub(vi a, vi b) { return _mm256_sub_epi32(a, b); }
INLINE vm vi_lt(vi a, vi b) { return _mm256_castsi256_ps(_mm256_cmpgt_epi32(b, a)); }
INLINE vi vi_select(vm m, vi a, vi b) { return _mm256_blendv_epi8(b, a, _mm256_castps_si256(m)); }
INLINE vi vi_and(vi a, vi b) { return _mm256_and_si256(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return _mm256_slli_epi32(a, n); }
INLINE vi vi_shift_right(vi a, int n) { return _mm256_srli_epi32(a, n); }
INLINE vi vi_bits(vf a) { return _mm256_castps_si256(a); }
INLINE vf v_of_bits(vi a) { return _mm256_castsi256_ps(a); }
INLINE vf v_of_int(vi a) { return _mm256_cvtepi32_ps(a); }
INLINE vi vi_truncate(vf a) { return _mm256_cvttps_epi32(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) {
    return _mm256_sub_epi16(counts, _mm256_cmpgt_epi16(below, values));
}
INLINE vi vi_lanes(void) { return _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7); }
INLINE vm vm_and(vm a, vm b) { return _mm256_and_ps(a, b); }
INLINE vm vm_or(vm a, vm b) { return _mm256_or_ps(a, b); }
INLINE vm vm_xor(vm a, vm b) { return _mm256_xor_ps(a, b); }
INLINE vm vm_not(vm a) { return _mm256_xor_ps(a, _mm256_castsi256_ps(_mm256_set1_epi32(-1))); }
INLINE vm vm_and_not(vm a, vm b) { return _mm256_andnot_ps(b, a); }
INLINE vm vm_front(int n) { return vi_lt(vi_lanes(), vi_set(n)); }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)_mm256_movemask_ps(a); }
INLINE vp vm_packing(vm a) {
    return _mm256_cvtepu8_epi32(_mm_loadl_epi64((const __m128i *)(const void *)&v_eight_lanes[vm_bits(a)]));
}
INLINE int vm_any(vm a) { return _mm256_movemask_ps(a) != 0; }

#endif
