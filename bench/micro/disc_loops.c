/* SPDX-License-Identifier: MIT
 *
 * disc_loops.c - contacts of discs: a plain loop, and one written by hand for AVX2.
 */
#include "disc_loops.h"

#include <math.h>
#include <string.h>

static size_t find_by_scalar_loop(const struct disc *discs, const struct pair *pairs, size_t count, narc_contact *out) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const struct disc *a = &discs[pairs[k].a], *b = &discs[pairs[k].b];
        const float x = b->x - a->x, y = b->y - a->y, radii = a->radius + b->radius, square = x * x + y * y;
        if (!(square < radii * radii))
            continue;
        const float length = sqrtf(square), n_x = length > 0 ? x / length : 1, n_y = length > 0 ? y / length : 0;
        const float along = 0.5f * (length + a->radius - b->radius);
        out[found++] = (narc_contact){.pair = (uint32_t)k,
                                      .count = 1,
                                      .separation = length - radii,
                                      .normal_x = n_x,
                                      .normal_y = n_y,
                                      .point_x = n_x * along,
                                      .point_y = n_y * along,
                                      .radius_a = a->radius,
                                      .radius_b = b->radius};
    }
    return found;
}

#ifdef __x86_64__
#include <immintrin.h>

#define AVX2 __attribute__((target("avx2")))

/* Discs in lanes. */
struct eight {
    __m256 x, y, radius;
};

/* Discs k and k + 4 beside each other. */
AVX2 static inline __m256 load_two(const struct disc *discs, uint32_t low, uint32_t high) {
    return _mm256_insertf128_ps(_mm256_castps128_ps256(_mm_loadu_ps(&discs[low].x)), _mm_loadu_ps(&discs[high].x), 1);
}

/* The first (second 0) or second bodies of eight pairs. */
AVX2 static inline struct eight load_eight(const struct disc *discs, const struct pair *pairs, int second) {
    const uint32_t *index = second ? &pairs->b : &pairs->a;
    const __m256 r0 = load_two(discs, index[0], index[8]), r1 = load_two(discs, index[2], index[10]);
    const __m256 r2 = load_two(discs, index[4], index[12]), r3 = load_two(discs, index[6], index[14]);
    const __m256 xy01 = _mm256_unpacklo_ps(r0, r1), xy23 = _mm256_unpacklo_ps(r2, r3);
    const __m256 radius01 = _mm256_unpackhi_ps(r0, r1), radius23 = _mm256_unpackhi_ps(r2, r3);
    return (struct eight){_mm256_shuffle_ps(xy01, xy23, 0x44), _mm256_shuffle_ps(xy01, xy23, 0xee),
                          _mm256_shuffle_ps(radius01, radius23, 0x44)};
}

/* Item i of vector k becomes item k of vector i. */
AVX2 static inline void transpose(__m256 v[8]) {
    __m256 pairs[8], fours[8];
    for (int k = 0; k < 8; k += 2) {
        pairs[k] = _mm256_unpacklo_ps(v[k], v[k + 1]);
        pairs[k + 1] = _mm256_unpackhi_ps(v[k], v[k + 1]);
    }
    for (int k = 0; k < 8; k += 4)
        for (int high = 0; high < 2; high++) {
            fours[k + 2 * high] = _mm256_shuffle_ps(pairs[k + high], pairs[k + high + 2], 0x44);
            fours[k + 2 * high + 1] = _mm256_shuffle_ps(pairs[k + high], pairs[k + high + 2], 0xee);
        }
    for (int k = 0; k < 4; k++) {
        v[k] = _mm256_permute2f128_ps(fours[k], fours[k + 4], 0x20);
        v[k + 4] = _mm256_permute2f128_ps(fours[k], fours[k + 4], 0x31);
    }
}

AVX2 static size_t find_by_avx2_loop(const struct disc *discs, const struct pair *pairs, size_t count,
                                     narc_contact *out) {
    const __m256 zero = _mm256_setzero_ps(), one = _mm256_set1_ps(1), half = _mm256_set1_ps(0.5f);
    size_t found = 0, k = 0;
    __m256i number = _mm256_setr_epi32(0, 1, 2, 3, 4, 5, 6, 7);
    for (; k + 8 <= count; k += 8, number = _mm256_add_epi32(number, _mm256_set1_epi32(8))) {
        const struct eight a = load_eight(discs, pairs + k, 0), b = load_eight(discs, pairs + k, 1);
        const __m256 x = _mm256_sub_ps(b.x, a.x), y = _mm256_sub_ps(b.y, a.y);
        const __m256 radii = _mm256_add_ps(a.radius, b.radius);
        const __m256 square = _mm256_add_ps(_mm256_mul_ps(x, x), _mm256_mul_ps(y, y));
        const __m256 hit = _mm256_cmp_ps(square, _mm256_mul_ps(radii, radii), _CMP_LT_OQ);
        const unsigned bits = (unsigned)_mm256_movemask_ps(hit);
        const __m256 length = _mm256_sqrt_ps(square), some = _mm256_cmp_ps(zero, length, _CMP_LT_OQ);
        const __m256 inverse = _mm256_div_ps(one, length);
        const __m256 n_x = _mm256_blendv_ps(one, _mm256_mul_ps(x, inverse), some);
        const __m256 n_y = _mm256_and_ps(_mm256_mul_ps(y, inverse), some);
        const __m256 along = _mm256_mul_ps(half, _mm256_sub_ps(_mm256_add_ps(length, a.radius), b.radius));
        __m256 row[8] = {_mm256_castsi256_ps(number),
                         _mm256_castsi256_ps(_mm256_set1_epi32(1 << 16)), /* no feature, a count of 1 */
                         _mm256_sub_ps(length, radii),
                         n_x,
                         n_y,
                         _mm256_mul_ps(n_x, along),
                         _mm256_mul_ps(n_y, along),
                         a.radius};
        float radius_b[8];
        transpose(row);
        _mm256_storeu_ps(radius_b, b.radius);
        for (int lane = 0; lane < 8; lane++) { /* the next one lies over what is none */
            memcpy(&out[found], &row[lane], sizeof row[lane]);
            out[found].radius_b = radius_b[lane];
            found += bits >> lane & 1;
        }
    }
    const size_t last = find_by_scalar_loop(discs, pairs + k, count - k, out + found);
    for (size_t i = 0; i < last; i++)
        out[found + i].pair += (uint32_t)k;
    return found + last;
}
#endif

disc_loop *find_disc_loop(const char *name) {
    if (strcmp(name, "scalar-loop") == 0)
        return find_by_scalar_loop;
#ifdef __x86_64__
    if (strcmp(name, "avx2-loop") == 0 && narc_isa_supported("avx2"))
        return find_by_avx2_loop;
#endif
    return NULL;
}
