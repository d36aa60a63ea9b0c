/* SPDX-License-Identifier: MIT
 *
 * scalar.h - the vector wrapper with one lane: plain C.
 */
#ifndef NARC_SIMD_SCALAR_H
#define NARC_SIMD_SCALAR_H

#include "simd/simd.h"

#if FLT_EVAL_METHOD != 0
#error "single precision must be computed in single precision: on 32-bit x86, compile with -msse2 -mfpmath=sse"
#endif

#define V_WIDTH  1
#define V_SINCOS Sleef_cinz_sincosf1_u10purec
typedef float vf;
typedef int32_t vi;
typedef int vm;
typedef int vp;

INLINE vf v_set(float a) { return a; }
/* What a float is loaded from, or stored to, may hold an integer. */
INLINE vf v_load(const float *p) {
    float a;
    memcpy(&a, p, sizeof a);
    return a;
}
INLINE void v_store(float *p, vf a) { memcpy(p, &a, sizeof a); }
INLINE void v_rows(const void *base, ptrdiff_t stride, const int32_t *index, vf out[4]) {
    memcpy(out, (const char *)base + (ptrdiff_t)(uint32_t)*index * stride, 4 * sizeof(float));
}
INLINE void v_put_rows(char *const *place, int offset, const vf in[4]) {
    memcpy(*place + offset, in, 4 * sizeof(float));
}
INLINE void v_double_differences(const struct double_rows *rows, const int32_t *a, const int32_t *b, const vf *shifts,
                                 vf out[2]) {
    double from[2], to[2];
    memcpy(from, rows->a + (ptrdiff_t)(uint32_t)*a * rows->stride_a, sizeof from);
    memcpy(to, rows->b + (ptrdiff_t)(uint32_t)*b * rows->stride_b, sizeof to);
    for (int i = 0; i < 2; i++)
        out[i] = (float)(shifts ? to[i] - from[i] + (double)shifts[i] : to[i] - from[i]);
}
INLINE vf v_add(vf a, vf b) { return a + b; }
INLINE vf v_sub(vf a, vf b) { return a - b; }
INLINE vf v_mul(vf a, vf b) { return a * b; }
INLINE vf v_div(vf a, vf b) { return a / b; }
INLINE vf v_sqrt(vf a) { return sqrtf(a); }
INLINE vf v_abs(vf a) { return fabsf(a); }
INLINE vf v_neg(vf a) { return -a; }
INLINE vf v_min(vf a, vf b) { return a < b ? a : b; }
INLINE vf v_max(vf a, vf b) { return a > b ? a : b; }
INLINE vm v_lt(vf a, vf b) { return a < b; }
INLINE vm v_le(vf a, vf b) { return a <= b; }
INLINE vf v_select(vm m, vf a, vf b) { return m ? a : b; }
INLINE vf v_pack(vp p, vf a) {
    (void)p;
    return a;
}
INLINE vi vi_set(int32_t a) { return a; }
INLINE vi vi_load(const int32_t *p) { return *p; }
INLINE void vi_store(int32_t *p, vi a) { *p = a; }
INLINE vi vi_add(vi a, vi b) { return (int32_t)((uint32_t)a + (uint32_t)b); }
INLINE vi vi_sub(vi a, vi b) { return (int32_t)((uint32_t)a - (uint32_t)b); }
INLINE vm vi_lt(vi a, vi b) { return a < b; }
INLINE vi vi_select(vm m, vi a, vi b) { return m ? a : b; }
INLINE vi vi_and(vi a, vi b) { return a & b; }
INLINE vi vi_shift_left(vi a, int n) { return (int32_t)((uint32_t)a << n); }
INLINE vi vi_shift_right(vi a, int n) { return (int32_t)((uint32_t)a >> n); }
INLINE vi vi_bits(vf a) {
    int32_t bits;
    memcpy(&bits, &a, sizeof bits);
    return bits;
}
INLINE vf v_of_bits(vi a) {
    float value;
    memcpy(&value, &a, sizeof value);
    return value;
}
INLINE vf v_of_int(vi a) { return (float)a; }
INLINE vi vi_truncate(vf a) { return fabsf(a) < 0x1p31f ? (int32_t)a : INT32_MIN; }
INLINE vi vi_count16(vi counts, vi below, vi values) {
    int16_t limit[2], value[2], count[2];
    memcpy(limit, &below, sizeof below);
    memcpy(value, &values, sizeof values);
    memcpy(count, &counts, sizeof counts);
    count[0] = (int16_t)(count[0] + (value[0] < limit[0]));
    count[1] = (int16_t)(count[1] + (value[1] < limit[1]));
    memcpy(&counts, count, sizeof counts);
    return counts;
}
INLINE vi vi_lanes(void) { return 0; }
INLINE vm vm_and(vm a, vm b) { return a & b; }
INLINE vm vm_or(vm a, vm b) { return a | b; }
INLINE vm vm_xor(vm a, vm b) { return a ^ b; }
INLINE vm vm_not(vm a) { return !a; }
INLINE vm vm_and_not(vm a, vm b) { return a & !b; }
INLINE vm vm_front(int n) { return n > 0; }
INLINE uint32_t vm_bits(vm a) { return (uint32_t)a; }
INLINE vp vm_packing(vm a) { return a; }
INLINE int vm_any(vm a) { return a; }

#endif
