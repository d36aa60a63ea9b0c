/* SPDX-License-Identifier: MIT
 *
 * avx512.h - the vector wrapper with sixteen lanes: AVX-512 F, DQ, BW and VL.
 */
#ifndef NARC_SIMD_AVX512_H
#define NARC_SIMD_AVX512_H

#include "simd/simd.h"

#if !defined(__AVX512F__) || !defined(__AVX512DQ__) || !defined(__AVX512BW__) || !defined(__AVX512VL__)
#error "compile with -mavx512f -mavx512dq -mavx512bw -mavx512vl"
#endif
/* A kernel whose lanes are a node's slots or one shape's arcs says that eight are enough (NARC_EIGHT_LANES): it takes a third
 * longer with sixteen, half of them for nothing. */
#ifdef NARC_EIGHT_LANES
#include "simd/avx2.h"
#else
#include "simd/x86.h"

#define V_WIDTH  16
#define V_SINCOS Sleef_cinz_sincosf16_u10avx512fnofma
typedef __m512 vf;
typedef __m512i vi;
typedef __mmask16 vm;
typedef __m512i vp;

INLINE vf v_set(float a) { return _mm512_set1_ps(a); }
INLINE vf v_load(const float *p) { return _mm512_loadu_ps(p); }
INLINE vf v_load_8(const float *p) { return _mm512_zextps256_ps512(_mm256_loadu_ps(p)); }
INLINE void v_store(float *p, vf a) { _mm512_storeu_ps(p, a); }
INLINE __m512 v_four_rows(const char *base, ptrdiff_t stride, const size_t *index) {
    __m512 rows = _mm512_castps128_ps512(v_row(base, stride, index[0]));
    rows = _mm512_insertf32x4(rows, v_row(base, stride, index[4]), 1);
    rows = _mm512_insertf32x4(rows, v_row(base, stride, index[8]), 2);
    return _mm512_insertf32x4(rows, v_row(base, stride, index[12]), 3);
}
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    size_t at[16];
    v_indices(index, 16, at);
    const __m512 a = v_four_rows(base, stride, at), b = v_four_rows(base, stride, at + 1);
    const __m512 c = v_four_rows(base, stride, at + 2), d = v_four_rows(base, stride, at + 3);
    const __m512d ab_low = _mm512_castps_pd(_mm512_unpacklo_ps(a, b)),
                  ab_high = _mm512_castps_pd(_mm512_unpackhi_ps(a, b));
    const __m512d cd_low = _mm512_castps_pd(_mm512_unpacklo_ps(c, d)),
                  cd_high = _mm512_castps_pd(_mm512_unpackhi_ps(c, d));
    out[0] = _mm512_castpd_ps(_mm512_unpacklo_pd(ab_low, cd_low));
    out[1] = _mm512_castpd_ps(_mm512_unpackhi_pd(ab_low, cd_low));
    out[2] = _mm512_castpd_ps(_mm512_unpacklo_pd(ab_high, cd_high));
    out[3] = _mm512_castpd_ps(_mm512_unpackhi_pd(ab_high, cd_high));
}
INLINE void v_put_four_rows(char *const *place, int offset, __m512 rows) {
    v_put_row(place[0], offset, _mm512_castps512_ps128(rows));
    v_put_row(place[4], offset, _mm512_extractf32x4_ps(rows, 1));
    v_put_row(place[8], offset, _mm512_extractf32x4_ps(rows, 2));
    v_put_row(place[12], offset, _mm512_extractf32x4_ps(rows, 3));
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    const __m512 low01 = _mm512_unpacklo_ps(in[0], in[1]), high01 = _mm512_unpackhi_ps(in[0], in[1]);
    const __m512 low23 = _mm512_unpacklo_ps(in[2], in[3]), high23 = _mm512_unpackhi_ps(in[2], in[3]);
    v_put_four_rows(place, offset, _mm512_shuffle_ps(low01, low23, 0x44));
    v_put_four_rows(place + 1, offset, _mm512_shuffle_ps(low01, low23, 0xee));
    v_put_four_rows(place + 2, offset, _mm512_shuffle_ps(high01, high23, 0x44));
    v_put_four_rows(place + 3, offset, _mm512_shuffle_ps(high01, high23, 0xee));
}
/* Of lanes 0, 1, 4, 5, 8 ... (from lane 0 on) or 2, 3, 6, 7 ... */
INLINE __m512 v_half_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, bool shifted,
                                 __m512 shifts) {
    __m512 all = _mm512_castps128_ps512(v_two_differences(rows, a, b, shifted, _mm512_castps512_ps128(shifts)));
    all = _mm512_insertf32x4(all, v_two_differences(rows, a + 4, b + 4, shifted, _mm512_extractf32x4_ps(shifts, 1)), 1);
    all = _mm512_insertf32x4(all, v_two_differences(rows, a + 8, b + 8, shifted, _mm512_extractf32x4_ps(shifts, 2)), 2);
    return _mm512_insertf32x4(all, v_two_differences(rows, a + 12, b + 12, shifted, _mm512_extractf32x4_ps(shifts, 3)),
                              3);
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const bool shifted = shifts != NULL;
    const __m512 zero = _mm512_setzero_ps();
    const __m512 s_low = shifted ? _mm512_unpacklo_ps(shifts[0], shifts[1]) : zero;
    const __m512 s_high = shifted ? _mm512_unpackhi_ps(shifts[0], shifts[1]) : zero;
    const __m512 low = v_half_differences(rows, a, b, shifted, s_low);
    const __m512 high = v_half_differences(rows, a + 2, b + 2, shifted, s_high);
    out[0] = _mm512_shuffle_ps(low, high, 0x88);
    out[1] = _mm512_shuffle_ps(low, high, 0xdd);
}
INLINE vf v_add(vf a, vf b) { return _mm512_add_ps(a, b); }
INLINE vf v_sub(vf a, vf b) { return _mm512_sub_ps(a, b); }
INLINE vf v_mul(vf a, vf b) { return _mm512_mul_ps(a, b); }
INLINE vf v_div(vf a, vf b) { return _mm512_div_ps(a, b); }
INLINE vf v_sqrt(vf a) { return _mm512_sqrt_ps(a); }
INLINE vf v_abs(vf a) { return _mm512_andnot_ps(_mm512_set1_ps(-0.0f), a); }
INLINE vf v_neg(vf a) { return _mm512_xor_ps(_mm512_set1_ps(-0.0f), a); }
INLINE vf v_min(vf a, vf b) { return _mm512_min_ps(a, b); }
INLINE vf v_max(vf a, vf b) { return _mm512_max_ps(a, b); }
INLINE vm v_lt(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LT_OQ); }
INLINE vm v_le(vf a, vf b) { return _mm512_cmp_ps_mask(a, b, _CMP_LE_OQ); }
INLINE vf v_select(vm m, vf a, vf b) { return _mm512_mask_blend_ps(m, b, a); }
INLINE vf v_pack(vp p, vf a) { return _mm512_permutexvar_ps(p, a); }
INLINE vi vi_set(int32_t a) { return _mm512_set1_epi32(a); }
INLINE vi vi_load(const int32_t *p) { return _mm512_loadu_si512(p); }
INLINE void vi_store(int32_t *p, vi a) { _mm512_storeu_si512(p, a); }
INLINE vi vi_add(vi a, vi b) { return _mm512_add_epi32(a, b); }
INLINE vi vi_sub(vi a, vi b) { return _mm512_sub_epi32(a, b); }
INLINE vm vi_lt(vi a, vi b) { return _mm512_cmplt_epi32_mask(a, b); }
INLINE vi vi_select(vm m, vi a, vi b) { return _mm512_mask_blend_epi32(m, b, a); }
INLINE vi vi_and(vi a, vi b) { return _mm512_and_si512(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return _mm512_slli_epi32(a, (unsigned)n); }
INLINE vi vi_shift_right(vi a, int n) { return _mm512_srli_epi32(a, (unsigned)n); }
INLINE vi vi_bits(vf a) { return _mm512_castps_si512(a); }
INLINE vf v_of_bits(vi a) { return _mm512_castsi512_ps(a); }
INLINE vf v_of_int(vi a) { return _mm512_cvtepi32_ps(a); }
INLINE vi vi_truncate(vf a) { return _mm512_cvttps_epi32(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) {
    return _mm512_mask_add_epi16(counts, _mm512_cmpgt_epi16_mask(below, values), counts, _mm512_set1_epi16(1));
}
INLINE vi vi_lanes(void) { return _mm512_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15); }
INLINE vm vm_and(vm a, vm b) { return (vm)(a & b); }
INLINE vm vm_or(vm a, vm b) { return (vm)(a | b); }
INLINE vm vm_xor(vm a, vm b) { return (vm)(a ^ b); }
INLINE vm vm_not(vm a) { return (vm)~a; }
INLINE vm vm_and_not(vm a, vm b) { return (vm)(a & ~b); }
INLINE vm vm_front(int n) { return vi_lt(vi_lanes(), vi_set(n)); }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)a; }
INLINE vp vm_packing(vm a) { return _mm512_maskz_compress_epi32(a, vi_lanes()); }
INLINE int vm_any(vm a) { return a != 0; }
#endif

#endif
