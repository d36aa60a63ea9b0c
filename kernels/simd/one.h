/* SPDX-License-Identifier: MIT
 *
 * one.h - the vector wrapper with one lane of an x86 register: what scalar.h is, but predicates are masks, so that nothing
 * is chosen by a branch. Other lanes of the register hold anything, in the second one another number if that is wanted.
 */
#ifndef NARC_SIMD_ONE_H
#define NARC_SIMD_ONE_H

#include "simd/simd.h"

#include "simd/x86.h"

#define V_WIDTH 1
typedef __m128 vf;
typedef __m128i vi;
typedef __m128 vm;
typedef int vp;

INLINE vf v_set(float a) { return _mm_set_ss(a); }
INLINE vf v_load(const float *p) { return _mm_load_ss(p); }
INLINE void v_store(float *p, vf a) { _mm_store_ss(p, a); }
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    const float *row = (const float *)(const void *)((const char *)base + (ptrdiff_t)(uint32_t)*index * stride);
    UNROLL
    for (int i = 0; i < 4; i++)
        out[i] = _mm_load_ss(row + i);
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    v_put_row(*place, offset, _mm_movelh_ps(_mm_unpacklo_ps(in[0], in[1]), _mm_unpacklo_ps(in[2], in[3])));
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    const __m128d from = v_double_row(rows->a, rows->stride_a, *a), to = v_double_row(rows->b, rows->stride_b, *b);
    const __m128d difference = _mm_sub_pd(to, from);
    const __m128d shift = shifts ? _mm_cvtps_pd(_mm_unpacklo_ps(shifts[0], shifts[1])) : _mm_setzero_pd();
    out[0] = _mm_cvtpd_ps(shifts ? _mm_add_pd(difference, shift) : difference);
    out[1] = _mm_shuffle_ps(out[0], out[0], 0x55);
}
INLINE vf v_add(vf a, vf b) { return _mm_add_ps(a, b); }
INLINE vf v_sub(vf a, vf b) { return _mm_sub_ps(a, b); }
INLINE vf v_mul(vf a, vf b) { return _mm_mul_ps(a, b); }
/* Of the first lane alone: in those that nobody needs 0 / 0 would raise what a caller's process may trap. */
INLINE vf v_div(vf a, vf b) { return _mm_div_ss(a, b); }
INLINE vf v_sqrt(vf a) { return _mm_sqrt_ss(a); }
INLINE vf v_abs(vf a) { return _mm_andnot_ps(_mm_set1_ps(-0.0f), a); }
INLINE vf v_neg(vf a) { return _mm_xor_ps(_mm_set1_ps(-0.0f), a); }
INLINE vf v_min(vf a, vf b) { return _mm_min_ps(a, b); }
INLINE vf v_max(vf a, vf b) { return _mm_max_ps(a, b); }
INLINE vm v_lt(vf a, vf b) { return _mm_cmplt_ps(a, b); }
INLINE vm v_le(vf a, vf b) { return _mm_cmple_ps(a, b); }
#ifdef __AVX512VL__ /* one instruction of one step, where a blend by a vector takes three */
INLINE vf v_select(vm m, vf a, vf b) { return _mm_or_ps(_mm_and_ps(m, a), _mm_andnot_ps(m, b)); }
#else
INLINE vf v_select(vm m, vf a, vf b) {
    vf out;
    SELECT_LANES(&out, m, a, b);
    return out;
}
#endif
INLINE vf v_pack(vp p, vf a) {
    (void)p;
    return a;
}
#define V_JOINS /* two of them in one register: of each the first lane */
INLINE vf v_join(vf low, vf high) { return _mm_unpacklo_ps(low, high); }
INLINE vf v_high(vf a) { return _mm_movehdup_ps(a); }
INLINE vf v_both(vf a) { return _mm_set1_ps(_mm_cvtss_f32(a)); }
INLINE vf v_low_high(vf low, vf high) { return _mm_blend_ps(low, high, 2); }
INLINE void v_put_ends(char *const *place, int offset, const vf in[4], vm low_first, vm two) {
    const __m128 front = _mm_unpacklo_ps(in[0], in[1]), back = _mm_unpacklo_ps(in[2], in[3]);
    const __m128 low = _mm_movelh_ps(front, back), high = _mm_movehl_ps(back, front);
    v_put_row(*place, offset, v_select(v_both(low_first), low, high));
    v_put_row(*place, offset + 16, _mm_and_ps(v_both(two), high));
}
INLINE vi vi_set(int32_t a) { return _mm_cvtsi32_si128(a); }
INLINE vi vi_load(const int32_t *p) { return _mm_cvtsi32_si128(*p); }
INLINE void vi_store(int32_t *p, vi a) { *p = _mm_cvtsi128_si32(a); }
INLINE vi vi_add(vi a, vi b) { return _mm_add_epi32(a, b); }
INLINE vi vi_sub(vi a, vi b) { return _mm_sub_epi32(a, b); }
INLINE vm vi_lt(vi a, vi b) { return _mm_castsi128_ps(_mm_cmpgt_epi32(b, a)); }
INLINE vi vi_select(vm m, vi a, vi b) {
    return _mm_castps_si128(v_select(m, _mm_castsi128_ps(a), _mm_castsi128_ps(b)));
}
INLINE vi vi_and(vi a, vi b) { return _mm_and_si128(a, b); }
INLINE vi vi_shift_left(vi a, int n) { return _mm_slli_epi32(a, n); }
INLINE vi vi_shift_right(vi a, int n) { return _mm_srli_epi32(a, n); }
INLINE vi vi_bits(vf a) { return _mm_castps_si128(a); }
INLINE vf v_of_bits(vi a) { return _mm_castsi128_ps(a); }
INLINE vf v_of_int(vi a) { return _mm_cvtepi32_ps(a); }
INLINE vi vi_truncate(vf a) { return _mm_cvttps_epi32(a); }
INLINE vi vi_count16(vi counts, vi below, vi values) { return _mm_sub_epi16(counts, _mm_cmpgt_epi16(below, values)); }
#define V_COUNT_EIGHT v_count_eight
INLINE int v_count_eight(const int16_t *values, vi below) {
    const __m128i eight = _mm_loadu_si128((const __m128i *)(const void *)values);
    return COUNT_BITS((unsigned)_mm_movemask_epi8(_mm_cmpgt_epi16(_mm_broadcastw_epi16(below), eight))) / 2;
}
INLINE vi vi_lanes(void) { return _mm_setzero_si128(); }
INLINE vm vm_and(vm a, vm b) { return _mm_and_ps(a, b); }
INLINE vm vm_or(vm a, vm b) { return _mm_or_ps(a, b); }
INLINE vm vm_xor(vm a, vm b) { return _mm_xor_ps(a, b); }
INLINE vm vm_not(vm a) { return _mm_xor_ps(a, _mm_castsi128_ps(_mm_set1_epi32(-1))); }
INLINE vm vm_and_not(vm a, vm b) { return _mm_andnot_ps(b, a); }
INLINE vm vm_front(int n) { return _mm_castsi128_ps(_mm_set1_epi32(n > 0 ? -1 : 0)); }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)_mm_movemask_ps(a) & 1; }
INLINE vp vm_packing(vm a) { return (int)vm_bits(a); }
INLINE int vm_any(vm a) { return _mm_movemask_ps(a) & 1; }

#endif
