/* SPDX-License-Identifier: MIT
 *
 * cpu.c - what this processor can do and the operating system lets it do. The only place that asks.
 */
#include "dispatch.h"

#if defined(__x86_64__)
#include <cpuid.h>

/* Extended control register 0: which register files the operating system saves. */
static unsigned long long read_xcr0(void) {
    unsigned low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return (unsigned long long)high << 32 | low;
}

unsigned narc_detect_cpu(void) {
    const unsigned osxsave_and_avx = 1u << 27 | 1u << 28;              /* leaf 1, ecx */
    const unsigned avx2_and_bmi2 = 1u << 5 | 1u << 8;                  /* leaf 7, ebx */
    const unsigned avx512 = 1u << 16 | 1u << 17 | 1u << 30 | 1u << 31; /* leaf 7, ebx: F, DQ, BW, VL */
    const unsigned long long ymm_saved = 0x06, zmm_saved = 0xe6;
    unsigned a, b, c, d, found = 0;
    if (!__get_cpuid(1, &a, &b, &c, &d) || (c & osxsave_and_avx) != osxsave_and_avx)
        return 0;
    const unsigned long long saved = read_xcr0();
    if ((saved & ymm_saved) != ymm_saved)
        return 0;
    found |= NARC_CPU_AVX;
    if (!__get_cpuid_count(7, 0, &a, &b, &c, &d))
        return found;
    if ((b & avx2_and_bmi2) == avx2_and_bmi2)
        found |= NARC_CPU_AVX2;
    if ((b & avx512) == avx512 && (saved & zmm_saved) == zmm_saved)
        found |= NARC_CPU_AVX512;
    return found;
}

#elif defined(__aarch64__)

unsigned narc_detect_cpu(void) { return NARC_CPU_NEON; } /* part of the base architecture */

#else

unsigned narc_detect_cpu(void) { return 0; }

#endif

const char *narc_cpu_features(void) {
    const unsigned found = narc_detect_cpu();
    if (found & NARC_CPU_NEON)
        return "neon";
    if (found & NARC_CPU_AVX512)
        return "avx avx2 avx512f avx512dq avx512bw avx512vl";
    if (found & NARC_CPU_AVX2)
        return "avx avx2";
    return found & NARC_CPU_AVX ? "avx" : "";
}
