/* SPDX-License-Identifier: MIT
 *
 * random.h - splitmix64: the same scenes on every machine; and pi.
 */
#ifndef NARC_BENCH_RANDOM_H
#define NARC_BENCH_RANDOM_H

#include <stddef.h>
#include <stdint.h>

static const double pi = 3.14159265358979323846;

static inline uint64_t random_bits(uint64_t *state) {
    uint64_t z = *state += 0x9e3779b97f4a7c15u;
    z = (z ^ z >> 30) * 0xbf58476d1ce4e5b9u;
    z = (z ^ z >> 27) * 0x94d049bb133111ebu;
    return z ^ z >> 31;
}

/* In [0, 1). */
static inline double random_unit(uint64_t *state) { return (double)(random_bits(state) >> 11) * 0x1p-53; }

static inline double random_between(uint64_t *state, double low, double high) {
    return low + (high - low) * random_unit(state);
}

/* 0 .. count - 1. */
static inline size_t random_below(uint64_t *state, size_t count) {
    return (size_t)((double)count * random_unit(state));
}

#endif
