/* SPDX-License-Identifier: MIT
 *
 * poses.c - the pose kernel: within 1 ulp of exact, the same bits as scalar, no byte too far.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "guard.h"
#include "narc.h"
#include "support.h"

/* The largest error promised, in units of the last place of the exact value. */
static const double max_ulps = 1.0;

/* The unit in the last place of a float near `value` (cosines and sines: at most 1). */
static double ulp(double value) {
    int exponent;
    frexp(value, &exponent);
    const int least = -149;
    return ldexp(1, exponent - 24 < least ? least : exponent - 24);
}

static float float_of_bits(uint32_t bits) {
    float value;
    memcpy(&value, &bits, sizeof(value));
    return value;
}

static uint32_t bits_of_float(float value) {
    uint32_t bits;
    memcpy(&bits, &value, sizeof(bits));
    return bits;
}

/* Small and large angles, all bit patterns, and multiples of a quarter turn. */
static float random_angle(struct test_random *random) {
    const double quarter = 1.57079632679489661923;
    switch (random_below(random, 4)) {
    case 0:
        return (float)random_between(random, -7, 7);
    case 1:
        return (float)random_between(random, -1e6, 1e6);
    case 2:
        return (float)(quarter * ((double)random_below(random, 2001) - 1000));
    default:
        return float_of_bits((uint32_t)random_bits(random));
    }
}

TEST(test_accuracy) {
    struct test_random random = test_random_named("pose accuracy");
    size_t count = test_trials(200000);
    AUTO(free_at) float *angles = malloc(count * sizeof(float));
    AUTO(free_at) float *cosines = malloc(count * sizeof(float));
    AUTO(free_at) float *sines = malloc(count * sizeof(float));
    for (size_t k = 0; k < count; k++)
        angles[k] = random_angle(&random);
    assert_int_equal(narc_compute_poses(angles, count, cosines, sines, NULL), NARC_OK);
    for (size_t k = 0; k < count; k++) {
        double angle = (double)angles[k], cosine = cos(angle), sine = sin(angle);
        if (!isfinite(angle)) {
            assert_true(isnan(cosines[k]) && isnan(sines[k]));
        } else if (!(fabs((double)cosines[k] - cosine) <= max_ulps * ulp(cosine)) ||
                   !(fabs((double)sines[k] - sine) <= max_ulps * ulp(sine))) {
            fail_msg("angle %a: cosine %a, sine %a; exact %a, %a", angle, (double)cosines[k], (double)sines[k], cosine,
                     sine);
        }
    }
}

/* Any NaN is as good as any other. */
static void check_same_numbers(const float *expected, const float *values, size_t count) {
    for (size_t k = 0; k < count; k++)
        if (bits_of_float(expected[k]) != bits_of_float(values[k]) && !(isnan(expected[k]) && isnan(values[k])))
            fail_msg("number %zu of %zu: %a instead of %a", k, count, (double)values[k], (double)expected[k]);
}

static void check_count(struct test_random *random, size_t count) {
    size_t size = count * sizeof(float);
    AUTO(guard_release_at) float *angles = guard_allocate(size);
    AUTO(guard_release_at) float *cosines = guard_allocate(size);
    AUTO(guard_release_at) float *sines = guard_allocate(size);
    AUTO(guard_release_at) float *expected_cosines = guard_allocate(size), *expected_sines = guard_allocate(size);
    for (size_t k = 0; k < count; k++)
        angles[k] = random_angle(random);
    test_use_isa("scalar");
    assert_int_equal(narc_compute_poses(angles, count, expected_cosines, expected_sines, NULL), NARC_OK);
    test_use_isa(test_isa());
    assert_int_equal(narc_compute_poses(angles, count, cosines, sines, NULL), NARC_OK);
    check_same_numbers(expected_cosines, cosines, count);
    check_same_numbers(expected_sines, sines, count);
    /* In place, either way round. */
    AUTO(guard_release_at) float *copy = guard_copy(angles, size);
    assert_int_equal(narc_compute_poses(copy, count, copy, sines, NULL), NARC_OK);
    check_same_numbers(expected_cosines, copy, count);
    check_same_numbers(expected_sines, sines, count);
    assert_int_equal(narc_compute_poses(angles, count, cosines, angles, NULL), NARC_OK);
    check_same_numbers(expected_cosines, cosines, count);
    check_same_numbers(expected_sines, angles, count);
}

TEST(test_counts) {
    struct test_random random = test_random_named("pose counts");
    for (size_t count = 0; count < 132; count++)
        check_count(&random, count);
    check_count(&random, test_trials(100003));
}

/* Exact where a table of special values would be: no angle, either zero. */
TEST(test_special_angles) {
    const float angles[] = {0.0f, -0.0f, 0x1p-149f, -0x1p-126f};
    float cosines[4], sines[4];
    assert_int_equal(narc_compute_poses(angles, 4, cosines, sines, NULL), NARC_OK);
    for (int k = 0; k < 4; k++) {
        assert_true(cosines[k] == 1.0f);
        assert_true(fabsf(sines[k] - angles[k]) <= 0x1p-149f);
    }
    assert_int_equal(narc_compute_poses(NULL, 0, NULL, NULL, NULL), NARC_OK);
}

TEST_MAIN("poses")
