/* SPDX-License-Identifier: MIT
 *
 * compiler.h - what C17 has no word for, in the words of GCC and clang; clang-cl has the same. Internal. No other file of
 * the libraries and the command has such words, but narc_export.h, which is public.
 */
#ifndef NARC_COMPILER_H
#define NARC_COMPILER_H

#if !defined(__GNUC__) && !defined(__clang__)
#error "narc: the words of this compiler are to be added to soa/compiler.h"
#endif

/* For steps of the inner loops that are written once and used more than once, and for what stores vectors to small
 * arrays of its own: the address sanitizer's frames are less aligned than GCC 12 takes those arrays to be. Code that is
 * to be small (-Os) leaves it to the compiler. */
#ifdef __OPTIMIZE_SIZE__
#define INLINE static inline
#else
#define INLINE static inline __attribute__((always_inline))
#endif

#define NOINLINE static __attribute__((noinline))

/* For larger steps of the same kind. With one pair at a time a call costs less than the text of another copy. */
#ifdef NARC_ONE_PAIR
#define SHARED NOINLINE
#else
#define SHARED INLINE
#endif

/* Before a loop over the fields of something, all of which is wanted in registers; and before one that does little else
 * but count. */
#ifdef __OPTIMIZE_SIZE__
#define UNROLL
#define UNROLL_FEW
#elif defined(__clang__)
#define UNROLL     _Pragma("unroll")
#define UNROLL_FEW _Pragma("unroll 4")
#else
#define UNROLL     _Pragma("GCC unroll 32")
#define UNROLL_FEW _Pragma("GCC unroll 4")
#endif

#define LIKELY(condition)       __builtin_expect(condition, 1)
#define FETCH(address)          __builtin_prefetch(address)
#define FETCH_TO_WRITE(address) __builtin_prefetch(address, 1)
#ifdef __wasm__ /* it has no such instruction */
#define FETCHES 0
#else
#define FETCHES 1
#endif
#define TYPE_OF(value) __typeof__(value)

/* Within a function that only fetches: GCC takes it for one without effect, and leaves out its calls. */
#ifdef __clang__
#define HAS_EFFECT (void)0
#else
#define HAS_EFFECT __asm__ volatile("")
#endif

/* After a type's name in its definition: a vector of so many bytes, with operators by lane. */
#define VECTOR_OF(bytes) __attribute__((vector_size(bytes)))

/* Of unsigned numbers: how many bits are set; the number of the lowest or the highest, where one is; other order of bytes. */
#define COUNT_BITS(bits)      __builtin_popcount(bits)
#define FIND_LOWEST(bits)     __builtin_ctz(bits)
#define FIND_LOWEST_64(bits)  __builtin_ctzll(bits)
#define FIND_HIGHEST(bits)    (31 - __builtin_clz(bits))
#define SWAP_BYTES_64(number) __builtin_bswap64(number)

/* Before a function whose arguments are those of printf(): which is the format, which the first that it prints. */
#ifdef __MINGW32__
#include <stdio.h> /* which of two printf() there is */
#define PRINTF_LIKE(format_at, first) __attribute__((format(__MINGW_PRINTF_FORMAT, format_at, first)))
#else
#define PRINTF_LIKE(format_at, first) __attribute__((format(printf, format_at, first)))
#endif

/* The processor's kind. On x86, the low and the high half of an extended control register; cpuid.h is of these compilers
 * too. With AVX, lanes of `a` where the sign of `mask` is set, of `b` elsewhere: of their intrinsic GCC makes another mask. */
#if defined(__x86_64__) || defined(__i386__)
#define NARC_ON_X86
#define READ_CONTROL_REGISTER(number, out_low, out_high)                                                               \
    __asm__ volatile("xgetbv" : "=a"(*(out_low)), "=d"(*(out_high)) : "c"(number))
#define SELECT_LANES(out, mask, a, b) __asm__("vblendvps %3, %2, %1, %0" : "=x"(*(out)) : "x"(b), "xm"(a), "x"(mask))
#elif defined(__aarch64__)
#define NARC_ON_ARM64
#elif defined(__wasm__)
#define NARC_ON_WASM
#endif

#endif
