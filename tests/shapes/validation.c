/* SPDX-License-Identifier: MIT
 *
 * validation.c - what narc_validate_arcs() accepts, and how it names what is wrong.
 */
#include <float.h>
#include <math.h>
#include <string.h>

#include "families.h"
#include "support.h"
#include "tests.h"

/* A box, 2 by 1 with corners of 0.25, with which one thing is wrong at a time. */
static void make_box(narc_arc arcs[NARC_MAX_ARCS]) {
    size_t count;
    assert_int_equal(narc_build_box(2, 1, 0.25, arcs, &count, NULL), NARC_OK);
    assert_int_equal(count, 4);
}

TEST(refuses_bad_counts) {
    narc_arc arcs[NARC_MAX_ARCS + 1] = {{0}};
    narc_error error;
    expect_error(narc_validate_arcs(NULL, 4, &error), NARC_ERROR_ARGUMENT, &error, "arcs is NULL");
    expect_error(narc_validate_arcs(arcs, 0, &error), NARC_ERROR_COUNT, &error, "0 arcs");
    expect_error(narc_validate_arcs(arcs, NARC_MAX_ARCS + 1, &error), NARC_ERROR_COUNT, &error, "65 arcs");
    assert_int_equal(narc_validate_arcs(arcs, 0, NULL), NARC_ERROR_COUNT);
}

TEST(refuses_bad_numbers) {
    static const char *const names[] = {"arc 2: center x is", "arc 2: center y is", "arc 2: radius is",
                                        "arc 2: start is", "arc 2: end is"};
    static const double values[] = {NAN, INFINITY, -INFINITY};
    for (size_t field = 0; field < 5; field++) {
        for (size_t k = 0; k < 3; k++) {
            narc_arc arcs[NARC_MAX_ARCS];
            narc_error error;
            make_box(arcs);
            double *fields[] = {&arcs[2].center_x, &arcs[2].center_y, &arcs[2].radius, &arcs[2].start, &arcs[2].end};
            *fields[field] = values[k];
            expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_NOT_FINITE, &error, names[field]);
            assert_int_equal(error.index, 2);
        }
    }
}

TEST(refuses_bad_radii) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    make_box(arcs);
    arcs[2].radius = -1;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_RADIUS, &error, "arc 2: radius is -1");
    assert_int_equal(error.index, 2);
    assert_true(error.value == -1);
    /* Lenses of two arcs as wide as 2: the radius divided by the bounding radius, 1, is the radius. */
    for (double radius = 63.9; radius < 64.2; radius += 0.2) {
        double y = sqrt(radius * radius - 1), half = asin(1 / radius);
        narc_arc lens[4] = {{1, 0, 0, -PI / 2 + half, PI / 2 - half},
                            {0, -y, radius, PI / 2 - half, PI / 2 + half},
                            {-1, 0, 0, PI / 2 + half, 3 * PI / 2 - half},
                            {0, y, radius, 3 * PI / 2 - half, 3 * PI / 2 + half}};
        narc_status status = narc_validate_arcs(lens, 4, &error);
        if (radius < NARC_MAX_RADIUS_RATIO) {
            expect_ok(status, &error);
        } else {
            expect_error(status, NARC_ERROR_RADIUS, &error, "arc 1: radius is 64.1");
            assert_int_equal(error.index, 1);
        }
    }
}

TEST(refuses_bad_sweeps) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    make_box(arcs);
    arcs[3].end = arcs[3].start + 3.5;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_SWEEP, &error,
                 "arc 3: sweep is 3.5 rad, more than half a turn");
    assert_int_equal(error.index, 3);
    assert_true(fabs(error.value - 3.5) < 1e-12);
    make_box(arcs);
    arcs[1].end = arcs[1].start;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_SWEEP, &error, "arc 1: sweep is 0 rad");
    make_box(arcs);
    arcs[1].end = arcs[1].start - 7;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_SWEEP, &error, "backwards");
    narc_arc half = {0, 0, 1, 0, PI};
    expect_error(narc_validate_arcs(&half, 1, &error), NARC_ERROR_SWEEP, &error, "arc 0: sweep is 3.14");
    /* Twice around: four half circles. */
    narc_arc twice[4] = {{0, 0, 1, 0, PI}, {0, 0, 1, PI, 2 * PI}, {0, 0, 1, 0, PI}, {0, 0, 1, PI, 2 * PI}};
    expect_error(narc_validate_arcs(twice, 4, &error), NARC_ERROR_SWEEP, &error, "12.566");
    /* The kernels need normals that differ by more than their rounding. */
    narc_arc sliver[3] = {{0, 0, 1, 0, 0.9e-5}, {0, 0, 1, 0.9e-5, PI}, {0, 0, 1, PI, 2 * PI}};
    expect_error(narc_validate_arcs(sliver, 3, &error), NARC_ERROR_SWEEP, &error,
                 "arc 0: sweep is 9e-06 rad, it turns by nothing");
    sliver[0].end = sliver[1].start = 1.1e-5;
    assert_int_equal(narc_validate_arcs(sliver, 3, &error), NARC_OK);
}

TEST(refuses_what_does_not_meet) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error;
    /* Normals that do not join. */
    make_box(arcs);
    arcs[2].start += 0.01;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_NOT_CLOSED, &error, "arc 2: its start normal is");
    assert_int_equal(error.index, 2);
    /* One corner moved outwards: the edge that leads to it is off by 0.01 along its normal. */
    make_box(arcs);
    arcs[1].center_y += 0.01;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_NOT_CLOSED, &error,
                 "arc 1: starts 0.01 away from where the edge from arc 0 should meet it");
    assert_int_equal(error.index, 1);
    /* Left and right exchanged: the upper edge runs backwards. */
    make_box(arcs);
    for (size_t i = 0; i < 4; i++)
        arcs[i].center_x = -arcs[i].center_x;
    expect_error(narc_validate_arcs(arcs, 4, &error), NARC_ERROR_NOT_CONVEX, &error, "arc 1: the edge from arc 0");
    /* An arc that turns by as little as it may, between two that reach as far into it as they may. */
    const double little = 1.01e-5, most = 0.99e-5;
    const narc_arc overlapping[4] = {
        {0, 0, 1, 0, 2 + most}, {0, 0, 1, 2, 2 + little}, {0, 0, 1, 2 + little - most, 4}, {0, 0, 1, 4, 2 * PI}};
    expect_error(narc_validate_arcs(overlapping, 4, &error), NARC_ERROR_SWEEP, &error, "it turns by nothing");
    assert_int_equal(error.index, 1);
    /* Within the tolerance. */
    make_box(arcs);
    arcs[1].center_y += 0.9e-5;
    arcs[2].start += 0.9e-5;
    expect_ok(narc_validate_arcs(arcs, 4, &error), &error);
}

TEST(refuses_bad_sizes) {
    static const double radii[] = {0, 0.5e-9, 2e9, 1e200, DBL_MAX, DBL_MIN};
    narc_error error;
    for (size_t k = 0; k < sizeof radii / sizeof radii[0]; k++) {
        narc_arc circle = {0, 0, radii[k], -PI, PI};
        expect_error(narc_validate_arcs(&circle, 1, &error), NARC_ERROR_SIZE, &error, "radius is");
    }
    narc_arc smallest = {0, 0, NARC_MIN_SIZE, -PI, PI}, largest = {0, 0, NARC_MAX_SIZE, -PI, PI};
    expect_ok(narc_validate_arcs(&smallest, 1, &error), &error);
    expect_ok(narc_validate_arcs(&largest, 1, &error), &error);
    narc_arc far = {2e9, 0, 1, -PI, PI};
    expect_error(narc_validate_arcs(&far, 1, &error), NARC_ERROR_SIZE, &error, "away from its origin");
    for (size_t i = 0; i < 4; i++) {
        narc_arc box[NARC_MAX_ARCS];
        make_box(box);
        box[i].center_x = 1e200;
        expect_error(narc_validate_arcs(box, 4, &error), NARC_ERROR_SIZE, &error, "a coordinate or radius is 1e+200");
        assert_int_equal(error.index, i);
    }
    /* A segment, a point, and a triangle whose corners lie on a line. */
    narc_arc segment[2] = {{1, 2, 0, -PI / 2, PI / 2}, {-1, 2, 0, PI / 2, -PI / 2}};
    expect_ok(narc_validate_arcs(segment, 2, &error), &error);
    narc_arc flat[2] = {{1, 0, 1e-14, -PI / 2, PI / 2}, {-1, 0, 1e-14, PI / 2, -PI / 2}};
    expect_error(narc_validate_arcs(flat, 2, &error), NARC_ERROR_SIZE, &error, "no area");
    narc_arc point[2] = {{3, 1, 0, 0, PI}, {3, 1, 0, PI, 2 * PI}};
    expect_error(narc_validate_arcs(point, 2, &error), NARC_ERROR_SIZE, &error, "bounding radius is 0");
    narc_arc line[3] = {{1, 0, 0, -PI / 2, 0.5}, {1, 0, 0, 0.5, PI / 2}, {-1, 0, 0, PI / 2, 3 * PI / 2}};
    expect_error(narc_validate_arcs(line, 3, &error), NARC_ERROR_SIZE, &error, "no area");
    /* The thinnest capsule there is a use for. */
    narc_arc thin[2] = {{1, 0, 1e-6, -PI / 2, PI / 2}, {-1, 0, 1e-6, PI / 2, -PI / 2}};
    expect_ok(narc_validate_arcs(thin, 2, &error), &error);
}

TEST(accepts_whole_turns) {
    struct test_random random = test_random_named("whole turns");
    for (size_t k = 0; k < test_trials(2000); k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        narc_error error;
        for (size_t i = 0; i < shape.count; i++) {
            double turns = 2 * PI * ((double)random_below(&random, 7) - 3);
            shape.arcs[i].start += turns;
            shape.arcs[i].end += turns;
            if (shape.count > 1 && random_below(&random, 2)) {
                shape.arcs[i].end = atan2(sin(shape.arcs[i].end), cos(shape.arcs[i].end));
                shape.arcs[i].start = atan2(sin(shape.arcs[i].start), cos(shape.arcs[i].start));
            }
        }
        expect_ok(narc_validate_arcs(shape.arcs, shape.count, &error), &error);
    }
}

/* Lists with few digits, as files have, pass, if no number is so large that these digits end before the tolerance. */
TEST(accepts_seven_digits) {
    struct test_random random = test_random_named("seven digits");
    size_t tested = 0;
    for (size_t k = 0; k < test_trials(2000); k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        narc_circle bound;
        narc_error error;
        double largest = 0;
        assert_true(narc_compute_bounding_circle(shape.arcs, shape.count, &bound));
        for (size_t i = 0; i < shape.count; i++) {
            double *fields[] = {&shape.arcs[i].center_x, &shape.arcs[i].center_y, &shape.arcs[i].radius,
                                &shape.arcs[i].start, &shape.arcs[i].end};
            for (size_t f = 0; f < 5; f++) {
                largest = f < 3 ? fmax(largest, fabs(*fields[f])) : largest;
                double unit = *fields[f] == 0 ? 1 : pow(10, floor(log10(fabs(*fields[f]))) - 6);
                *fields[f] = round(*fields[f] / unit) * unit;
            }
        }
        if (largest < 10 && bound.radius > 0.5) {
            expect_ok(narc_validate_arcs(shape.arcs, shape.count, &error), &error);
            tested++;
        }
    }
    assert_true(tested > test_trials(2000) / 4);
}

/* Anything in, no crash and no hang; what passes has finite properties. */
TEST(survives_random_bits) {
    struct test_random random = test_random_named("random bits");
    for (size_t k = 0; k < test_trials(20000); k++) {
        struct shape shape = make_shape(&random, (enum family)random_below(&random, FAMILY_COUNT));
        double *fields = &shape.arcs[0].center_x;
        size_t which = random_below(&random, 5 * shape.count);
        uint64_t bits = random_bits(&random);
        assert_int_equal(sizeof(narc_arc), 5 * sizeof(double));
        memcpy(fields + which, &bits, sizeof bits);
        narc_circle circle;
        if (narc_validate_arcs(shape.arcs, shape.count, NULL) == NARC_OK) {
            assert_true(narc_compute_bounding_circle(shape.arcs, shape.count, &circle));
            assert_true(circle.radius >= NARC_MIN_SIZE && circle.radius <= NARC_MAX_SIZE);
        }
    }
}

TEST(names_every_status) {
    for (int k = 0; k <= NARC_ERROR_IN_USE; k++) {
        const char *name = narc_status_name((narc_status)k);
        assert_int_equal(strncmp(name, k ? "NARC_ERROR_" : "NARC_OK", k ? 11 : 7), 0);
        for (int j = 0; j < k; j++)
            assert_string_not_equal(name, narc_status_name((narc_status)j));
    }
    assert_string_equal(narc_status_name((narc_status)99), "unknown status");
}
