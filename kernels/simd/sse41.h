/* SPDX-License-Identifier: MIT
 *
 * sse41.h - the vector wrapper with four lanes for x86: SSE4.1.
 */
#ifndef NARC_SIMD_SSE41_H
#define NARC_SIMD_SSE41_H

#include "simd/simd.h"

#if !defined(__SSE4_1__) || !defined(__POPCNT__)
#error "compile with -msse4.1 -mpopcnt"
#endif
#include "simd/packing.h"
#include "simd/x86.h"

#define V_WIDTH  4
#define V_SINCOS Sleef_cinz_sincosf4_u10sse4
typedef __m128 vf;
typedef __m128i vi;
typedef __m128 vm;
typedef __m128i vp;

INLINE vf v_set(float a) { return _mm_set1_ps(a); }
INLINE vf v_load(const float *p) { return _mm_loadu_ps(p); }
INLINE void v_store(float *p, vf a) { _mm_storeu_ps(p, a); }
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    const __m128 a = v_row(base, stride, (uint32_t)index[0]), b = v_row(base, stride, (uint32_t)index[1]);
    const __m128 c = v_row(base, stride, (uint32_t)index[2]), d = v_row(base, stride, (uint32_t)index[3]);
    const __m128 ab_low = _mm_shuffle_ps(a, b, 0x44), ab_high = _mm_shuffle_ps(a, b, 0xee);
    const __m128 cd_low = _mm_shuffle_ps(c, d, 0x44), cd_high = _mm_shuffle_ps(c, d, 0xee);
    out[0] = _mm_shuffle_ps(ab_low, cd_low, 0x88);
    out[1] = _mm_shuffle_ps(ab_low, cd_low, 0xdd);
    out[2] = _mm_shuffle_ps(ab_high, cd_high, 0x88);
    out[3] = _mm_shuffle_ps(ab_high, cd_high, 0xdd);
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    const __m128 low01 = _mm_shuffle_ps(in[0], in[1], 0x44), high01 = _mm_shuffle_ps(in[0], in[1], 0xee);
    const __m128 low23 = _mm_shuffle_ps(in[2], in[3], 0x44), high23 = _mm_shuffle_ps(in[2], in[3], 0xee);
    v_put_row(place[0], offset, _mm_shuffle_ps(low01, low23, 0x88));
    v_put_row(place[1], offset, _mm_shuffle_ps(low01, low23, 0xdd));
    v_put_row(place[2], offset, _mm_shuffle_ps(high01, high23, 0x88));
    v_put_row(place[3], offset, _mm_shuffle_ps(high01, high23, 0xdd));
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const bool shifted = shifts != NULL;
    const __m128 zero = _mm_setzero_ps();
    const __m128 s_low = shifted ? _mm_unpacklo_ps(shifts[0], shifts[1]) : zero;
    const __m128 s_high = shifted ? _mm_unpackhi_ps(shifts[0], shifts[1]) : zero;
    const __m128 low = v_two_differences(rows, a, b, shifted, s_low);
    const __m128 high = v_two_differences(rows, a + 2, b + 2, shifted, s_high);
    out[0] = _mm_shuffle_ps(low, high, 0x88);
    out[1] = _mm_shuffle_ps(low, high, 0xdd);
}
INLINE vf v_add(vf a, vf b) { return _mm_add_ps(a, b); }
INLINE vf v_sub(vf a, vf b) { return _mm_sub_ps(a, b); }
INLINE vf v_mul(vf a, vf b) { return _mm_mul_ps(a, b); }
INLINE vf v_div(vf a, vf b) { return _mm_div_ps(a, b); }
INLINE vf v_sqrt(vf a) { return _mm_sqrt_ps(a); }
INLINE vf v_abs(vf a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
INLINE vf v_neg(vf a) { return _mm_xor_ps(_mm_set1_ps(-0.0f), a); }
INLINE vf v_min(vf a, vf b) { return _mm_min_ps(a, b); }
INLINE vf v_max(vf a, vf b) { return _mm_max_ps(a, b); }
INLINE vm v_lt(vf a, vf b) { return _mm_cmplt_ps(a, b); }
INLINE vm v_le(vf a, vf b) { return _mm_cmple_ps(a, b); }
INLINE vf v_select(vm m, vf a, vf b) { return _mm_blendv_ps(b, a, m); }
INLINE vf v_pack(vp p, vf a) { return _mm_castsi128_ps(_mm_shuffle_epi8(_mm_castps_si128(a), p)); }
INLINE vi vi_set(int32_t a) { return _mm_set1_epi32(a); }
INLINE vi vi_load(const int32_t *p) { return _mm_loadu_si128((const __m128i *)p); }
INLINE void vi_store(int32_t *p, vi a) { _mm_storeu_si128((__m128i *)p, a); }
INLINE vi vi_add(vi a, vi b) { return _mm_add_epi32(a, b); }
INLINE vi vi_sub(vi a, vi b) { return _mm_sub_epi32(a, b); }
INLINE vm vi_lt(vi a, vi b) { return _mm_castsi128_ps(_mm_cmpgt_epi32(b, a)); }
INLINE vi vi_select(vm m, vi a, vi b) { return _mm_blendv_epi8(b, a, _mm_castps_si128(m)); }
INLINE vi vi_and(vi a, vi b) { return _mm_and_si128(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return _mm_slli_epi32(a, n); }
INLINE vi vi_shift_right(vi a, int n) { return _mm_srli_epi32(a, n); }
INLINE vi vi_bits(vf a) { return _mm_castps_si128(a); }
INLINE vf v_of_bits(vi a) { return _mm_castsi128_ps(a); }
INLINE vf v_of_int(vi a) { return _mm_cvtepi32_ps(a); }
INLINE vi vi_truncate(vf a) { return _mm_cvttps_epi32(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) { return _mm_sub_epi16(counts, _mm_cmpgt_epi16(below, values)); }
INLINE vi vi_lanes(void) { return _mm_setr_epi32(0, 1, 2, 3); }
INLINE vm vm_and(vm a, vm b) { return _mm_and_ps(a, b); }
INLINE vm vm_or(vm a, vm b) { return _mm_or_ps(a, b); }
INLINE vm vm_xor(vm a, vm b) { return _mm_xor_ps(a, b); }
INLINE vm vm_not(vm a) { return _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1))); }
INLINE vm vm_and_not(vm a, vm b) { return _mm_andnot_ps(b, a); }
INLINE vm vm_front(int n) { return vi_lt(vi_lanes(), vi_set(n)); }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)_mm_movemask_ps(a); }
INLINE vp vm_packing(vm a) { return _mm_loadu_si128((const __m128i *)(const void *)v_four_lanes[vm_bits(a)]); }
INLINE int vm_any(vm a) { return _mm_movemask_ps(a) != 0; }

#endif
