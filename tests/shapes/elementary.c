/* SPDX-License-Identifier: MIT
 *
 * elementary.c - the elementary functions of soa/: within their errors of the C library's long doubles, which have 11
 * bits or more to spare, and with recorded bits.
 */
#include "elementary.h"

#include <float.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "support.h"

static const uint64_t golden_values = 0x2e9cd1e3eb29a993u;

/* By how many units in the last place a value is off. */
static double units_off(double value, long double right) {
    const double near = fabs((double)right), unit = nextafter(near, INFINITY) - near;
    return (double)(fabsl((long double)value - right) / (long double)unit);
}

struct worst {
    double units, x, y;
};

static void look(struct worst *worst, double value, long double right, double x, double y) {
    const double units = units_off(value, right);
    if (!(units <= worst->units)) /* a NaN counts */
        *worst = (struct worst){units, x, y};
}

static void check_worst(const char *name, struct worst worst, double limit) {
    printf("  %s: off by %.4f units in the last place at most, at %a, %a\n", name, worst.units, worst.x, worst.y);
    assert_true(worst.units < limit);
}

/* A number of any size between two powers of two. */
static double random_size(struct test_random *random, int low, int high) {
    const double digits = 1 + random_unit(random);
    return ldexp(digits, low + (int)random_below(random, (size_t)(high - low)));
}

static double random_sign(struct test_random *random, double x) { return random_below(random, 2) ? -x : x; }

/* Has the C library functions with more digits than a double's? On Windows some have fewer. */
#ifdef _WIN32
static bool has_long_double(void) { return false; }
#else
static bool has_long_double(void) { return LDBL_MANT_DIG >= 64; }
#endif

TEST(test_sines) {
    if (!has_long_double())
        skip();
    struct test_random random = test_random_named("sines");
    struct worst cosine = {0}, sine = {0};
    const size_t trials = test_trials(400000);
    for (size_t k = 0; k < trials; k++) {
        double x = k % 4 == 0   ? random_between(&random, -7, 7)
                   : k % 4 == 1 ? random_size(&random, -40, 20)
                                : random_size(&random, 20, 1024);
        double c, s;
        if (k % 4 == 3) { /* next to multiples of a quarter turn */
            x = (double)random_below(&random, k % 8 == 3 ? 16 : 1 << 24) * 1.57079632679489662;
            for (size_t i = random_below(&random, 3); i > 0; i--)
                x = nextafter(x, INFINITY);
        }
        x = random_sign(&random, x);
        narc_find_cosine(x, &c, &s);
        look(&cosine, c, cosl((long double)x), x, 0);
        look(&sine, s, sinl((long double)x), x, 0);
        assert_true(c == narc_cos(x) && s == narc_sin(x));
    }
    /* The double that is nearest to a multiple of a quarter turn. */
    const double nearest = ldexp(6381956970095103.0, 797);
    look(&cosine, narc_cos(nearest), cosl((long double)nearest), nearest, 0);
    look(&sine, narc_sin(nearest), sinl((long double)nearest), nearest, 0);
    check_worst("cosine", cosine, 1);
    check_worst("sine", sine, 1);
}

TEST(test_arc_tangents) {
    if (!has_long_double())
        skip();
    struct test_random random = test_random_named("arc tangents");
    struct worst tangent = {0}, sine = {0};
    const size_t trials = test_trials(400000);
    for (size_t k = 0; k < trials; k++) {
        double x = random_size(&random, -500, 500), y = x * random_between(&random, 0, 1);
        if (k % 3 == 0)
            y = x * random_size(&random, -60, 2);
        if (k % 3 == 1) /* about the places where the eighth changes */
            y = x * (double)(1 + random_below(&random, 16)) / 16 * (1 + (random_unit(&random) - 0.5) * 0x1p-50);
        const bool turned = random_below(&random, 2);
        const double longer = random_sign(&random, x), shorter = random_sign(&random, y);
        x = turned ? shorter : longer;
        y = turned ? longer : shorter;
        look(&tangent, narc_atan2(y, x), atan2l((long double)y, (long double)x), y, x);
        const double s = random_sign(&random, k % 2 ? random_unit(&random) : 1 - random_size(&random, -52, -1));
        look(&sine, narc_asin(s), asinl((long double)s), s, 0);
    }
    check_worst("arc tangent", tangent, 1);
    check_worst("arc sine", sine, 2);
}

TEST(test_lengths_and_powers) {
    if (!has_long_double())
        skip();
    struct test_random random = test_random_named("lengths and powers");
    struct worst length = {0}, logarithm = {0}, power = {0};
    const size_t trials = test_trials(200000);
    for (size_t k = 0; k < trials; k++) {
        double x = random_size(&random, -1021, 1023), y = x * random_between(&random, 0, 1);
        if (k % 2)
            y = random_size(&random, -1021, 1023);
        look(&length, narc_hypot(x, -y), hypotl((long double)x, (long double)y), x, y);
        if (k % 2)
            x = random_between(&random, 0.5, 2);
        look(&logarithm, narc_log(x), logl((long double)x), x, 0);
        y = random_unit(&random);
        const double units = units_off(narc_pow(x, y), powl((long double)x, (long double)y));
        const double part = units / (2 + 2 * fabs(y * narc_log(x))); /* of what is promised */
        if (!(part <= power.units))
            power = (struct worst){part, x, y};
    }
    check_worst("length", length, 1.5);
    check_worst("logarithm", logarithm, 1.5);
    check_worst("power, relative to what is promised", power, 1);
}

static bool is_same(double a, double b) { return a == b && !signbit(a) == !signbit(b); }

TEST(test_special_values) {
    double c, s;
    narc_find_cosine(-0.0, &c, &s);
    assert_true(is_same(c, 1) && is_same(s, -0.0));
    const double broken[] = {NAN, INFINITY, -INFINITY};
    for (int k = 0; k < 3; k++) {
        narc_find_cosine(broken[k], &c, &s);
        assert_true(isnan(c) && isnan(s));
        assert_true(isnan(narc_atan2(1, broken[k])) && isnan(narc_atan2(broken[k], 1)));
    }
    for (int k = 0; k < 4; k++) {
        const double y = k & 1 ? -0.0 : 0, x = k & 2 ? -0.0 : 0;
        assert_true(is_same(narc_atan2(y, x), atan2(y, x)));
        assert_true(is_same(narc_atan2(y, k & 2 ? -3 : 3), atan2(y, k & 2 ? -3 : 3)));
    }
    assert_true(narc_atan2(2, 0) == PI / 2 && narc_atan2(-2, -0.0) == -PI / 2);
    assert_true(narc_atan2(5, 5) == PI / 4 && narc_atan2(-5e-310, -5e-310) == -0.75 * PI);
    assert_true(narc_asin(1) == PI / 2 && narc_asin(-1) == -PI / 2 && narc_asin(0) == 0);
    assert_true(narc_hypot(3, -4) == 5 && narc_hypot(3e300, 4e300) == 5e300 && narc_hypot(0, 0) == 0);
    assert_true(narc_hypot(DBL_MAX, DBL_MAX) == INFINITY && narc_hypot(1, INFINITY) == INFINITY);
    assert_true(is_same(narc_log(1), 0) && narc_log(0) == -INFINITY && isnan(narc_log(-1)));
    assert_true(narc_pow(0, 0.5) == 0 && narc_pow(1, 0.7) == 1);
}

/* The same on every machine. */
TEST(test_golden) {
    enum { VALUES = 4096 };
    static double values[7 * VALUES];
    struct test_random random = {4}; /* not of NARC_TEST_SEED */
    for (size_t k = 0; k < VALUES; k++) {
        double *const out = &values[7 * k];
        const double x = random_size(&random, -30, k % 2 ? 30 : 3),
                     y = random_sign(&random, random_size(&random, -3, 3));
        narc_find_cosine(x, &out[0], &out[1]);
        out[2] = narc_atan2(y, x);
        out[3] = narc_asin(random_unit(&random));
        out[4] = narc_hypot(x, y);
        out[5] = narc_log(x);
        out[6] = narc_pow(x, 1.0 / 3);
    }
    const uint64_t hash = test_hash_items(TEST_HASH_START, values, 7 * VALUES, sizeof *values);
    printf("  elementary functions: 0x%016" PRIx64 "\n", hash);
    assert_true(hash == golden_values);
}

TEST_MAIN("elementary")
