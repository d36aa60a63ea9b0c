/* SPDX-License-Identifier: MIT
 *
 * cpu.c - what this processor can do and the operating system lets it do. The only place that asks.
 */
#include "compiler.h"
#include "dispatch.h"

#if (NARC_BUILT_sse41 && !defined(NARC_ON_X86)) || (NARC_BUILT_neon && !defined(NARC_ON_ARM64)) ||                     \
    (NARC_BUILT_wasm128 && !defined(NARC_ON_WASM))
#error "narc: kernels for a processor that compiler.h does not recognise would never be used"
#endif

#ifdef NARC_ON_X86
#include <cpuid.h>

enum { EBX = 1, ECX = 2 };

/* Bits of extended control register 0: the register files that the operating system saves. What compilers use without
 * being asked is saved without asking. */
enum { XMM_SAVED = 0, YMM_SAVED = 0x06, ZMM_SAVED = 0xe6 };

/* Each feature: the need that it is part of, where cpuid has it (leaf, register, bit), and the registers that it works
 * on. */
static const struct feature {
    const char *name;
    unsigned need, leaf, place, bit;
    unsigned long long saved;
} features[] = {
    {"sse4.1", NARC_CPU_SSE41, 1, ECX, 19, XMM_SAVED},    {"popcnt", NARC_CPU_SSE41, 1, ECX, 23, XMM_SAVED},
    {"avx2", NARC_CPU_AVX2, 7, EBX, 5, YMM_SAVED},        {"avx512f", NARC_CPU_AVX512, 7, EBX, 16, ZMM_SAVED},
    {"avx512dq", NARC_CPU_AVX512, 7, EBX, 17, ZMM_SAVED}, {"avx512bw", NARC_CPU_AVX512, 7, EBX, 30, ZMM_SAVED},
    {"avx512vl", NARC_CPU_AVX512, 7, EBX, 31, ZMM_SAVED},
};

static unsigned long long read_xcr0(void) {
    unsigned low, high;
    READ_CONTROL_REGISTER(0, &low, &high);
    return (unsigned long long)high << 32 | low;
}

static bool are_saved(unsigned long long registers) {
    const unsigned osxsave = 1u << 27; /* leaf 1, ecx */
    unsigned a, b, c, d;
    if (registers == 0)
        return true;
    return __get_cpuid(1, &a, &b, &c, &d) && c & osxsave && (read_xcr0() & registers) == registers;
}

static bool has_feature(const struct feature *feature) {
    unsigned word[4];
    return are_saved(feature->saved) && __get_cpuid_count(feature->leaf, 0, &word[0], &word[1], &word[2], &word[3]) &&
           word[feature->place] >> feature->bit & 1;
}

#else

static const struct feature {
    const char *name;
    unsigned need;
} features[] = {{"neon", NARC_CPU_NEON}, {"simd128", NARC_CPU_WASM128}};

static bool has_feature(const struct feature *feature) {
#ifdef NARC_ON_ARM64
    return feature->need == NARC_CPU_NEON; /* part of the base architecture */
#elif defined(NARC_ON_WASM)
    return feature->need == NARC_CPU_WASM128; /* an engine without it would have refused the module */
#else
    (void)feature;
    return false;
#endif
}

#endif

enum { FEATURES = sizeof features / sizeof *features };

unsigned narc_detect_cpu(void) {
    unsigned known = 0, missing = 0;
    for (int k = 0; k < FEATURES; k++) {
        known |= features[k].need;
        missing |= has_feature(&features[k]) ? 0 : features[k].need;
    }
    return known & ~missing;
}

const char *narc_cpu_feature(size_t index) {
    for (int k = 0; k < FEATURES; k++)
        if (has_feature(&features[k]) && index-- == 0)
            return features[k].name;
    return NULL;
}
