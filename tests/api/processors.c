/* SPDX-License-Identifier: MIT
 *
 * processors.c - what narc_detect_cpu() takes a processor for: dispatch/cpu.c on x86 processors that are made up here,
 * of which the operating system saves some registers.
 */
#include <stdbool.h>
#include <string.h>

#include "compiler.h"
#include "support.h"

#ifdef NARC_ON_X86

#include <cpuid.h>

/* Bits of leaf 1, ecx; of leaf 7, ebx; of extended control register 0. As Intel's manual of the processor has them. */
enum { SSE41 = 1 << 19, POPCNT = 1 << 23, OSXSAVE = 1 << 27 };
enum { AVX2 = 1 << 5, AVX512F = 1 << 16, AVX512DQ = 1 << 17, AVX512BW = 1 << 30 };
#define AVX512VL (1u << 31)
enum {
    XMM = 2,
    YMM = 4,
    MASKS = 0x20,
    HIGH_ZMM = 0x40,
    MORE_ZMM = 0x80,
    ALL = XMM | YMM | MASKS | HIGH_ZMM | MORE_ZMM
};
#define AVX512 (AVX512F | AVX512DQ | AVX512BW | AVX512VL)

static struct { unsigned most_leaf, leaf1_ecx, leaf7_ebx, saved; } processor;

static int ask(unsigned leaf, unsigned part, unsigned *a, unsigned *b, unsigned *c, unsigned *d) {
    if (leaf > processor.most_leaf)
        return 0;
    *a = *b = *c = *d = 0;
    if (leaf == 1)
        *c = processor.leaf1_ecx;
    if (leaf == 7 && part == 0)
        *b = processor.leaf7_ebx;
    return 1;
}

/* The instruction faults where the operating system does not allow it. */
static void read_register(unsigned number, unsigned *out_low, unsigned *out_high) {
    assert_true(number == 0 && (processor.leaf1_ecx & OSXSAVE));
    *out_low = processor.saved;
    *out_high = 0;
}

#define __get_cpuid(leaf, a, b, c, d)             ask(leaf, 0, a, b, c, d)
#define __get_cpuid_count(leaf, part, a, b, c, d) ask(leaf, part, a, b, c, d)
#undef READ_CONTROL_REGISTER
#define READ_CONTROL_REGISTER(number, out_low, out_high) read_register(number, out_low, out_high)
#define narc_detect_cpu                                  detect
#define narc_cpu_feature                                 name_feature
#include "cpu.c" /* NOLINT(bugprone-suspicious-include) */

static void set_processor(unsigned leaf1_ecx, unsigned leaf7_ebx, unsigned saved) {
    processor.most_leaf = 7;
    processor.leaf1_ecx = leaf1_ecx;
    processor.leaf7_ebx = leaf7_ebx;
    processor.saved = saved;
}

/* On all processors that have these features and registers, or not. */
TEST(test_detection) {
    static const unsigned first[] = {SSE41, POPCNT, OSXSAVE}, second[] = {AVX2, AVX512F, AVX512DQ, AVX512BW, AVX512VL},
                          registers[] = {1, XMM, YMM, MASKS, HIGH_ZMM, MORE_ZMM};
    for (unsigned mix = 0; mix < 1u << 14; mix++) {
        unsigned leaf1 = 0, leaf7 = 0, saved = 0;
        for (unsigned k = 0; k < 14; k++) {
            const bool has = mix >> k & 1;
            if (k < 3)
                leaf1 |= has ? first[k] : 0;
            else if (k < 8)
                leaf7 |= has ? second[k - 3] : 0;
            else
                saved |= has ? registers[k - 8] : 0;
        }
        set_processor(leaf1, leaf7, saved);
        const bool asks = leaf1 & OSXSAVE, wide = asks && (saved & (XMM | YMM)) == (XMM | YMM),
                   widest = asks && (saved & ALL) == ALL;
        const unsigned expected = ((leaf1 & SSE41) && (leaf1 & POPCNT) ? NARC_CPU_SSE41 : 0u) |
                                  (wide && (leaf7 & AVX2) ? NARC_CPU_AVX2 : 0u) |
                                  (widest && (leaf7 & AVX512) == AVX512 ? NARC_CPU_AVX512 : 0u);
        assert_int_equal(detect(), expected);
        processor.most_leaf = 1; /* an old one */
        assert_int_equal(detect(), expected & NARC_CPU_SSE41);
    }
    processor.most_leaf = 0;
    assert_int_equal(detect(), 0);
}

/* Every need of an instruction set of these processors is found on one that has all that is made up here. */
TEST(test_all_needs) {
    static const struct {
        const char *processors;
        unsigned needs;
    } isas[] = {
#define NARC_ISA(name, needs, processors, flags) {processors, needs},
#include "isa.def"
    };
    set_processor(SSE41 | POPCNT | OSXSAVE, AVX2 | AVX512, ALL);
    for (size_t k = 0; k < sizeof isas / sizeof *isas; k++)
        if (strstr(isas[k].processors, "86"))
            assert_int_equal(isas[k].needs & ~detect(), 0);
}

TEST(test_names) {
    static const char *const names[] = {"sse4.1", "popcnt", "avx2", "avx512f", "avx512dq", "avx512bw", "avx512vl"};
    set_processor(SSE41 | POPCNT | OSXSAVE, AVX2 | AVX512, ALL);
    for (size_t k = 0; k < 7; k++)
        assert_string_equal(name_feature(k), names[k]);
    assert_null(name_feature(7));
    set_processor(POPCNT | OSXSAVE, AVX2 | AVX512, XMM | YMM);
    assert_string_equal(name_feature(0), "popcnt");
    assert_string_equal(name_feature(1), "avx2");
    assert_null(name_feature(2));
}

TEST_MAIN("processors")

#else

int main(void) { return TEST_SKIPPED; } /* other kinds of processors are asked nothing */

#endif
