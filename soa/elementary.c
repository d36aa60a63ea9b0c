/* SPDX-License-Identifier: MIT
 *
 * elementary.c - elementary functions from correctly rounded operations alone.
 *
 * Each reduces its argument to a small one, where a few terms of the Taylor series are enough: the first that is left
 * out is below a sixteenth of a unit in the last place. What decides the last bit is carried in two doubles. frexp(),
 * ldexp(), nearbyint() and the like are exact, so any C library's will do.
 */
#include "elementary.h"

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

/* A number in two doubles: `high` is the sum, rounded. */
typedef struct two {
    double high, low;
} two;

static const two pi = {0x1.921fb54442d18p+1, 0x1.1a62633145c07p-53};
static const two half_pi = {0x1.921fb54442d18p+0, 0x1.1a62633145c07p-54};

/* The exact sum (Knuth). */
static two add(double a, double b) {
    const double sum = a + b, of_b = sum - a;
    return (two){sum, (a - (sum - of_b)) + (b - of_b)};
}

/* The exact product (Dekker), from halves of 26 bits. */
static two multiply(double a, double b) {
    const double split = 0x1p27 + 1, product = a * b;
    const double a_high = split * a - (split * a - a), a_low = a - a_high;
    const double b_high = split * b - (split * b - b), b_low = b - b_high;
    return (two){product, ((a_high * b_high - product) + a_high * b_low + a_low * b_high) + a_low * b_low};
}

/* What brings a vector to a size whose square is a number; 1 for most. */
static double find_scale(double x, double y) {
    const double largest = fmax(fabs(x), fabs(y));
    return largest > 0x1p500 ? 0x1p-600 : largest < 0x1p-500 ? 0x1p600 : 1;
}

/* c[0] + c[1] z + ... */
static double sum_series(const double *c, int count, double z) {
    double sum = 0;
    for (int k = count - 1; k >= 0; k--)
        sum = c[k] + z * sum;
    return sum;
}
#define SERIES(c, z) sum_series(c, (int)(sizeof(c) / sizeof(c)[0]), z)

/* ------------------------------------------------------------------------------------------------ sine and cosine */

/* 2 / pi after its binary point, as much as the largest double needs. */
static const uint32_t two_over_pi[] = {
    0xa2f9836e, 0x4e441529, 0xfc2757d1, 0xf534ddc0, 0xdb629599, 0x3c439041, 0xfe5163ab, 0xdebbc561,
    0xb7246e3a, 0x424dd2e0, 0x06492eea, 0x09d1921c, 0xfe1deb1c, 0xb129a73e, 0xe88235f5, 0x2ebb4484,
    0xe99c7026, 0xb45f7e41, 0x3991d639, 0x835339f4, 0x9c845f8b, 0xbdf9283b, 0x1ff897ff, 0xde05980f,
    0xef2f118b, 0x5a0a6d1f, 0x6d367ecf, 0x27cb09b7, 0x4f463f66, 0x9e5fea2d, 0x7527bac7, 0xebe5f17b,
    0x3d0739f7, 0x8a5292ea, 0x6bfb5fb1, 0x1f8d5d08, 0x56033046};

/* Words of 2 / pi that count, and of their product with a double's 53 bits, with one more for read_word(). */
enum { WORDS = 7, PRODUCT_WORDS = WORDS + 3, FRACTION_WORDS = 5 };

/* 32 bits of a number whose lowest word comes first. */
static uint32_t read_word(const uint32_t *words, int bit) {
    return (uint32_t)(((uint64_t)words[bit / 32 + 1] << 32 | words[bit / 32]) >> bit % 32);
}

/* The number of quarter turns nearest to an angle of pi / 4 or more, modulo 4, and what remains, by the digits of 2 /
 * pi (Payne and Hanek). The words left out on the left give whole turns, those on the right less than 2^-137 of a
 * quarter turn; no double is nearer to a multiple of one than 2^-62. */
static unsigned reduce_by_digits(double angle, two *out_rest) {
    int exponent;
    const uint64_t digits = (uint64_t)ldexp(frexp(angle, &exponent), 53);
    exponent -= 53;
    const int first = exponent > 2 ? (exponent - 2) / 32 : 0;
    uint32_t product[PRODUCT_WORDS] = {0};
    for (int half = 0; half < 2; half++) {
        uint64_t carry = 0;
        for (int k = 0; k < WORDS; k++) {
            carry += (digits >> 32 * half & UINT32_MAX) * two_over_pi[first + WORDS - 1 - k] + product[k + half];
            product[k + half] = (uint32_t)carry;
            carry >>= 32;
        }
        product[WORDS + half] = (uint32_t)carry;
    }
    const int point = 32 * (first + WORDS) - exponent; /* bits behind the binary point */
    const bool is_above = read_word(product, point - 32) >> 31;
    two part = {0, 0};
    for (int k = FRACTION_WORDS; k > 0; k--) {
        const uint32_t word = read_word(product, point - 32 * k);
        const two sum = add(part.high, ldexp((double)(is_above ? ~word : word), -32 * k));
        part = (two){sum.high, part.low + sum.low};
    }
    const two rest = multiply(part.high, half_pi.high);
    const two sum = add(rest.high, rest.low + (part.high * half_pi.low + part.low * half_pi.high));
    *out_rest = is_above ? (two){-sum.high, -sum.low} : sum;
    return read_word(product, point) + is_above;
}

/* The same for any angle of 0 or more. Where it is not large, pi / 2 in three parts, the first two so short that their
 * multiples are exact (Cody and Waite); the last is off by less than 2^-103. */
static unsigned reduce(double angle, two *out_rest) {
    const double large = 0x1p19, near = 0x1p-30;
    *out_rest = (two){angle, 0};
    if (angle <= half_pi.high / 2)
        return 0;
    if (angle < large) {
        const double turns = (int)(angle * 0.63661977236758134 + 0.5); /* 2 / pi */
        const two part = add(angle - turns * 0x1.921fb544p+0, -turns * 0x1.0b4611a6p-34);
        *out_rest = add(part.high, part.low - turns * 0x1.3198a2e037073p-69);
        if (fabs(out_rest->high) >= near)
            return (unsigned)turns;
    }
    return reduce_by_digits(angle, out_rest);
}

void narc_find_cosine(double angle, double *out_cosine, double *out_sine) {
    /* Of (sin x - x) / x^3, and of (cos x - 1 + x^2 / 2) / x^4, in powers of x^2. */
    static const double sine[] = {-1.0 / 6,
                                  1.0 / 120,
                                  -1.0 / 5040,
                                  1.0 / 362880,
                                  -1.0 / 39916800,
                                  1.0 / 6227020800,
                                  -1.0 / 1307674368000,
                                  1.0 / 355687428096000,
                                  -1.0 / 121645100408832000};
    static const double cosine[] = {1.0 / 24,        -1.0 / 720,         1.0 / 40320,          -1.0 / 3628800,
                                    1.0 / 479001600, -1.0 / 87178291200, 1.0 / 20922789888000, -1.0 / 6402373705728000};
    const double tiny = 0x1p-27; /* its square is below a rounding of 1 */
    if (!(fabs(angle) >= tiny) || !isfinite(angle)) {
        *out_cosine = isfinite(angle) ? 1 : NAN;
        *out_sine = isfinite(angle) ? angle : NAN;
        return;
    }
    two rest;
    const unsigned quarter = reduce(fabs(angle), &rest);
    const double x = rest.high, z = x * x, rounded = 1 - z / 2;
    const double s = x + (x * z * SERIES(sine, z) + rest.low * rounded);
    const double c = rounded + ((1 - rounded - z / 2) + (z * z * SERIES(cosine, z) - x * rest.low));
    const double turned_c = quarter & 1 ? -s : c, turned_s = quarter & 1 ? c : s;
    const bool is_opposite = quarter & 2;
    *out_cosine = is_opposite ? -turned_c : turned_c;
    *out_sine = is_opposite != (angle < 0) ? -turned_s : turned_s;
}

double narc_cos(double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return c;
}

double narc_sin(double angle) {
    double c, s;
    narc_find_cosine(angle, &c, &s);
    return s;
}

/* ------------------------------------------------------------------------------------------------ arc tangent */

/* atan(k / 8). */
static const two eighths[] = {{0, 0},
                              {0x1.fd5ba9aac2f6ep-4, -0x1.cd37686760c17p-59},
                              {0x1.f5b75f92c80ddp-3, 0x1.8ab6e3cf7afbdp-57},
                              {0x1.6f61941e4def1p-2, -0x1.c63aae6f6e918p-56},
                              {0x1.dac670561bb4fp-2, 0x1.a2b7f222f65e2p-56},
                              {0x1.1e00babdefeb4p-1, -0x1.928df287a668fp-58},
                              {0x1.4978fa3269ee1p-1, 0x1.2419a87f2a458p-56},
                              {0x1.700a7c5784634p-1, -0x1.8c34d25aadef6p-56},
                              {0x1.921fb54442d18p-1, 0x1.1a62633145c07p-55}};

/* atan(y / x), 0 <= y <= x: the angle of the nearest c = k / 8 and that between, atan((y - c x) / (x + c y)), whose
 * quotient u comes with its remainder. y - c x loses nothing where c is 1/4 or more. */
static two find_arc_tangent(double y, double x) {
    static const double terms[] = {-1.0 / 3,  1.0 / 5,  -1.0 / 7,  1.0 / 9,  -1.0 / 11, 1.0 / 13,
                                   -1.0 / 15, 1.0 / 17, -1.0 / 19, 1.0 / 21, -1.0 / 23, 1.0 / 25};
    const int k = y >= 0.1875 * x ? (int)(8 * (y / x) + 0.5) : 0;
    const two of_x = multiply(k / 8.0, x);
    const double top = (y - of_x.high) - of_x.low, bottom = x + k / 8.0 * y, u = top / bottom;
    const two back = multiply(u, bottom);
    const double rest = ((top - back.high) - back.low) / bottom;
    const two sum = add(eighths[k].high, u);
    return (two){sum.high, sum.low + (eighths[k].low + (rest + u * (u * u) * SERIES(terms, u * u)))};
}

double narc_atan2(double y, double x) {
    if (!isfinite(x) || !isfinite(y))
        return NAN;
    if (x == 0 && y == 0)
        return copysign(signbit(x) ? pi.high : 0, y);
    const double scale = find_scale(x, y), across = scale * fabs(x), up = scale * fabs(y);
    const bool is_steep = up > across, is_left = x < 0;
    const two part = is_steep ? find_arc_tangent(across, up) : find_arc_tangent(up, across);
    const two from = is_steep ? half_pi : is_left ? pi : (two){0, 0};
    const double sign = is_steep == is_left ? 1 : -1; /* away from the x axis, or from the y axis to the left */
    const two sum = add(from.high, sign * part.high);
    return copysign(sum.high + (sum.low + (from.low + sign * part.low)), y);
}

double narc_asin(double sine) { return narc_atan2(sine, sqrt((1 - sine) * (1 + sine))); }

/* ------------------------------------------------------------------------------------------------ length */

double narc_hypot(double x, double y) {
    const double scale = find_scale(x, y);
    if (scale == 1)
        return sqrt(x * x + y * y);
    x *= scale;
    y *= scale;
    return sqrt(x * x + y * y) / scale;
}

/* ------------------------------------------------------------------------------------------------ powers */

/* log 2, its first part so short that its multiples by exponents are exact. */
static const two log_2 = {0x1.62e42feep-1, 0x1.a39ef35793c76p-33};

/* With m = 1 + f between sqrt(1/2) and sqrt(2) and s = f / (2 + f): log m = 2 artanh(s), and 2 s = f - s f. */
double narc_log(double x) {
    static const double terms[] = {2.0 / 3,  2.0 / 5,  2.0 / 7,  2.0 / 9,  2.0 / 11,
                                   2.0 / 13, 2.0 / 15, 2.0 / 17, 2.0 / 19, 2.0 / 21};
    int exponent;
    double m = frexp(x, &exponent);
    if (!(x > 0) || !isfinite(x))
        return x > 0 ? x : x == 0 ? -INFINITY : NAN;
    if (m < 0.70710678118654752) {
        m *= 2;
        exponent--;
    }
    const double f = m - 1, s = f / (2 + f), z = s * s;
    return exponent * log_2.high + (f - (s * (f - z * SERIES(terms, z)) - exponent * log_2.low));
}

double narc_pow(double x, double y) {
    static const double terms[] = {
        1,          1,           1.0 / 2,      1.0 / 6,       1.0 / 24,       1.0 / 120,       1.0 / 720,
        1.0 / 5040, 1.0 / 40320, 1.0 / 362880, 1.0 / 3628800, 1.0 / 39916800, 1.0 / 479001600, 1.0 / 6227020800};
    if (x == 0)
        return 0;
    const double exponent = y * narc_log(x), twos = nearbyint(exponent / log_2.high);
    const double rest = (exponent - twos * log_2.high) - twos * log_2.low;
    return ldexp(SERIES(terms, rest), (int)twos);
}
