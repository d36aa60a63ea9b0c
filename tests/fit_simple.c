/* SPDX-License-Identifier: MIT
 *
 * fit_simple.c - crossings and touches: against the comparison of all pairs of sides, and contours of 100,000 points.
 */
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "fit_support.h"

enum { MANY = 100000 };

static const double pi = 3.14159265358979323846;

static narc_status check(const narc_point *points, size_t count, narc_error *error) {
    narc_path *path = make_path();
    draw_polygon(path, points, count);
    const narc_status status = narc_check_simple(path, error);
    narc_destroy_path(path);
    return status;
}

static void expect_simple(const narc_point *points, size_t count) {
    narc_error error;
    expect_ok(check(points, count, &error), &error);
}

static void expect_hit(const narc_point *points, size_t count, const char *words) {
    narc_error error;
    expect_error(check(points, count, &error), NARC_ERROR_NOT_SIMPLE, &error, words);
}

/* ---------------------------------------------------------------------------- small ones, by hand */

static void knows_simple_contours(void **state) {
    (void)state;
    expect_simple((narc_point[]){{0, 0}, {1, 0}, {0, 1}}, 3);
    expect_simple((narc_point[]){{0, 0}, {0, 1}, {1, 0}}, 3); /* clockwise */
    expect_simple((narc_point[]){{0, 0}, {0, 0}, {2, 0}, {2, 2}, {2, 2}, {2, 2}, {0, 2}, {0, 0}}, 8);
    expect_simple((narc_point[]){{0, 0}, {1, 0}, {2, 0}, {2, 1}, {2, 2}, {0, 2}}, 6); /* points within sides */
    expect_simple((narc_point[]){{0, 0}, {4, 0}, {4, 3}, {3, 3}, {3, 1}, {1, 1}, {1, 3}, {0, 3}}, 8);
    expect_simple((narc_point[]){{-0.0, 0}, {0.0, 0}, {1, -0.0}, {1, 1}}, 4); /* zeros of either sign are equal */
}

static void finds_crossings_and_touches(void **state) {
    (void)state;
    expect_hit((narc_point[]){{0, 0}, {2, 2}, {2, 0}, {0, 2}}, 4, "contour 0 crosses or touches itself at (1, 1)");
    expect_hit((narc_point[]){{0, 0}, {4, 0}, {4, 4}, {2, 0}, {0, 4}}, 5, "at (2, 0)");         /* point on side */
    expect_hit((narc_point[]){{0, 0}, {4, 0}, {2, 2}, {4, 4}, {0, 4}, {2, 2}}, 6, "at (2, 2)"); /* equal points */
    expect_hit((narc_point[]){{0, 0}, {4, 0}, {4, 4}, {4, 2}, {0, 2}}, 5, "at (4, 2)");         /* a side goes back */
    expect_hit((narc_point[]){{0, 0}, {4, 0}, {4, 2}, {6, 2}, {4, 2}, {4, 4}, {0, 4}}, 7, "at (4, 2)"); /* spike */
    expect_hit((narc_point[]){{0, 0}, {5, 0}, {5, 5}, {3, 0}, {2, 0}, {0, 5}}, 6, "touches itself");    /* on a side */
    expect_hit((narc_point[]){{0, 0}, {1, 1}, {2, 2}}, 3, "touches itself"); /* all on a line, and back */
}

static void names_contours_that_enclose_nothing(void **state) {
    (void)state;
    expect_hit((narc_point[]){{3, 4}, {3, 4}}, 2, "contour 0 encloses nothing: it is a point at (3, 4)");
    expect_hit((narc_point[]){{3, 4}, {3, 5}, {3, 4}}, 3, "contour 0 encloses nothing: it is a line at (3, 4)");
}

/* Contours may cross one another; the error tells which one crosses itself. */
static void names_the_contour(void **state) {
    (void)state;
    narc_path *path = make_path();
    narc_error error;
    expect_ok(narc_check_simple(path, &error), &error); /* nothing drawn, nothing wrong */
    draw_polygon(path, (narc_point[]){{0, 0}, {4, 0}, {4, 4}, {0, 4}}, 4);
    draw_polygon(path, (narc_point[]){{2, 2}, {6, 2}, {6, 6}, {2, 6}}, 4);
    draw_polygon(path, (narc_point[]){{0, 0}, {4, 0}, {4, 4}, {0, 4}}, 4);
    expect_ok(narc_check_simple(path, &error), &error);
    draw_polygon(path, (narc_point[]){{10, 10}, {20, 20}, {20, 10}, {10, 20}}, 4);
    expect_error(narc_check_simple(path, &error), NARC_ERROR_NOT_SIMPLE, &error,
                 "contour 3 crosses or touches itself at (15, 15)");
    assert_int_equal(error.index, 3);
    assert_int_equal(narc_check_simple(path, NULL), NARC_ERROR_NOT_SIMPLE);
    narc_destroy_path(path);
    expect_error(narc_check_simple(NULL, &error), NARC_ERROR_ARGUMENT, &error, "path");
}

/* From (-1, 0) to (1, 0) with the control points (r, 8) and (-r, 8): with s = 1 - t and u = t - s,
 * x = u (1 - (1 + 3 r) s t) and y = 24 s t. For r = 1, x = u^3: no crossing. For r = 8, x is 0 at s t = 1 / 25 as well:
 * a crossing at (0, 0.96), at slopes of about 1, where chords are off by at most twice the flatness, of an extent
 * of 6. */
static void checks_curves(void **state) {
    (void)state;
    for (int loop = 0; loop < 2; loop++) {
        narc_path *path = make_path();
        narc_error error;
        const double r = loop ? 8 : 1;
        expect_ok(narc_move_to(path, (narc_point){-1, 0}, &error), &error);
        expect_ok(narc_cubic_to(path, (narc_point){r, 8}, (narc_point){-r, 8}, (narc_point){1, 0}, &error), &error);
        const narc_status status = narc_check_simple(path, &error);
        if (loop) {
            double x, y;
            expect_error(status, NARC_ERROR_NOT_SIMPLE, &error, "at (");
            assert_int_equal(sscanf(strstr(error.message, "at ("), "at (%lf, %lf)", &x, &y), 2);
            assert_true(hypot(x, y - 0.96) <= 2 * 6 * NARC_FLATNESS + 1e-6); /* six digits are told */
        } else {
            expect_ok(status, &error);
        }
        narc_destroy_path(path);
    }
}

/* ---------------------------------------------------------------------------- against all pairs */

static bool is_same(narc_point a, narc_point b) { return a.x == b.x && a.y == b.y; }

/* Points that repeat the one before are left out. */
static size_t drop_repeats(narc_point *points, size_t count) {
    size_t kept = 1;
    for (size_t i = 1; i < count; i++) {
        if (!is_same(points[i], points[kept - 1])) {
            points[kept++] = points[i];
        }
    }
    while (kept > 1 && is_same(points[kept - 1], points[0])) {
        kept--;
    }
    return kept;
}

/* Do sides i and k meet, i < k? With three points each side follows both others. */
static bool pair_meets(const narc_point *points, size_t count, size_t i, size_t k) {
    const narc_point p = points[i], q = points[i + 1], r = points[k], s = points[(k + 1) % count];
    return i == 0 && k + 1 == count ? sides_meet(r, s, p, q, true, find_whole_orientation)
                                    : sides_meet(p, q, r, s, i + 1 == k, find_whole_orientation);
}

/* Is there a pair of sides that meet, near a place? Anywhere if `near` is NULL. */
static bool has_hit(const narc_point *points, size_t count, const narc_point *near, double tolerance) {
    for (size_t i = 0; i < count; i++) {
        for (size_t k = i + 1; k < count; k++) {
            if (pair_meets(points, count, i, k) &&
                (!near || (measure_distance(*near, points[i], points[i + 1]) <= tolerance &&
                           measure_distance(*near, points[k], points[(k + 1) % count]) <= tolerance))) {
                return true;
            }
        }
    }
    return false;
}

/* Small lattices make touches of all sorts, large ones crossings; a walk of short steps makes simple ones. */
static size_t make_lattice_contour(struct test_random *random, narc_point *out_points) {
    static const size_t widths[] = {2, 3, 4, 6, 10, 100, (size_t)1 << 20, (size_t)1 << 29};
    const size_t width = widths[random_below(random, 8)], count = 3 + random_below(random, 14);
    const bool turns = random_below(random, 2);
    for (size_t i = 0; i < count; i++) {
        out_points[i] = (narc_point){(double)random_below(random, width), (double)random_below(random, width)};
        if (turns) { /* around the middle: mostly simple */
            const double angle = 2 * pi * ((double)i + random_unit(random)) / (double)count, r = (double)width / 2;
            const double length = r * random_between(random, 0.2, 1);
            out_points[i] = (narc_point){floor(r + length * cos(angle)), floor(r + length * sin(angle))};
        }
    }
    return drop_repeats(out_points, count);
}

static void agrees_with_all_pairs(void **state) {
    (void)state;
    struct test_random random = test_random_named("all pairs");
    size_t simple = 0, hits = 0;
    const size_t trials = test_trials(60000);
    for (size_t trial = 0; trial < trials; trial++) {
        narc_point points[20];
        const size_t count = make_lattice_contour(&random, points);
        if (count < 3) {
            continue;
        }
        narc_error error;
        const bool expected = has_hit(points, count, NULL, 0);
        const narc_status status = check(points, count, &error);
        if (status != (expected ? NARC_ERROR_NOT_SIMPLE : NARC_OK)) {
            fail_msg("trial %zu, %zu points: %s", trial, count, narc_status_name(status));
        }
        simple += !expected;
        if (expected) {
            narc_point place;
            hits++;
            assert_int_equal(sscanf(strstr(error.message, "at ("), "at (%lf, %lf)", &place.x, &place.y), 2);
            /* Six digits: half a unit of the sixth, in each coordinate, is 5e-6 of it at most. */
            if (!has_hit(points, count, &place, 1e-5 * (1 + hypot(place.x, place.y)))) {
                fail_msg("trial %zu, %zu points: no sides meet at (%g, %g)", trial, count, place.x, place.y);
            }
        }
    }
    assert_true(simple > trials / 5 && hits > trials / 5);
}

/* p seen from the first corner, at (-5e8, -5e8). */
static narc_point shift(double x, double y) { return (narc_point){x - 5e8, y - 5e8}; }

/* (0, 0)-(p, q) and a notch whose tip (x, y) is beside it at the least distance that whole numbers can have:
 * p y - q x = +-1, which is lost when products of up to 2^58 are rounded. (p, q) and (x, y) follow one another as
 * numerators and denominators of a continued fraction, p from 1e8 to 4e8. */
static void tells_the_least_distances(void **state) {
    (void)state;
    struct test_random random = test_random_named("least distances");
    for (size_t trial = 0; trial < test_trials(3000); trial++) {
        double p = 1, q = 0, x = 0, y = 1;
        while (p < 1e8) {
            const double quotient = (double)(1 + random_below(&random, 3));
            const double next_p = quotient * p + x, next_q = quotient * q + y;
            x = p, y = q;
            p = next_p, q = next_q;
        }
        const narc_point start = shift(0, 0), far = shift(p, q), tip = shift(x, y), twice = shift(2 * p, 2 * q);
        const int left = find_whole_orientation(start, far, tip); /* or -1: then everything is to the right */
        assert_true(left != 0);
        expect_simple((narc_point[]){start, far, shift(p - left * q, q + left * p), tip}, 4);
        expect_hit((narc_point[]){start, far, shift(p + left * q, q - left * p), tip}, 4, "touches itself");
        expect_hit((narc_point[]){start, twice, shift(2 * p - left * q, 2 * q + left * p), far}, 4, "touches itself");
    }
}

/* The sign of (b - a) x (c - a) for multiples of 2^-53 below 32: products are below 2^118. */
static int find_fine_orientation(narc_point a, narc_point b, narc_point c) {
    __extension__ typedef __int128 whole;
    const whole x = (int64_t)(b.x * 0x1p53) - (int64_t)(a.x * 0x1p53);
    const whole y = (int64_t)(b.y * 0x1p53) - (int64_t)(a.y * 0x1p53);
    const whole left = x * ((int64_t)(c.y * 0x1p53) - (int64_t)(a.y * 0x1p53));
    const whole right = y * ((int64_t)(c.x * 0x1p53) - (int64_t)(a.x * 0x1p53));
    return (left > right) - (left < right);
}

/* `value`, some units in the last place on. */
static double step_on(struct test_random *random, double value, double unit) {
    return value + unit * (double)random_below(random, 64);
}

/* A side along the diagonal from near (0.5, 0.5) to near (24, 24), and a notch with its tip near (17.3, 17.3): simple
 * exactly if the tip is on the left. Their differences do not fit into a double, so that rounded areas have wrong signs
 * (Kettner et al., "Classroom examples of robustness problems in geometric computations", 2008). */
static void tells_units_in_the_last_place(void **state) {
    (void)state;
    struct test_random random = test_random_named("last place");
    size_t counts[3] = {0};
    const size_t trials = test_trials(20000);
    for (size_t trial = 0; trial < trials; trial++) {
        const narc_point first = {step_on(&random, 0.5, 0x1p-53), step_on(&random, 0.5, 0x1p-53)};
        const narc_point far = {step_on(&random, 24, 0x1p-48), step_on(&random, 24, 0x1p-48)};
        const narc_point tip = {step_on(&random, 17.3, 0x1p-48), step_on(&random, 17.3, 0x1p-48)};
        const narc_point contour[] = {first, far, {0, 24}, tip};
        const int side = find_fine_orientation(first, far, tip);
        counts[side + 1]++;
        if (side > 0) {
            expect_simple(contour, 4);
        } else {
            expect_hit(contour, 4, "touches itself");
        }
    }
    assert_true(counts[0] > trials / 4 && counts[2] > trials / 4);
}

/* ---------------------------------------------------------------------------- many points */

/* What 100,000 points take; checking goes with n log n, and a comparison of all pairs would take minutes. */
static double check_many(const narc_point *points, size_t count, narc_status expected, narc_error *error) {
    narc_path *path = make_path();
    draw_polygon(path, points, count);
    const clock_t start = clock();
    const narc_status status = narc_check_simple(path, error);
    const double seconds = (double)(clock() - start) / CLOCKS_PER_SEC;
    narc_destroy_path(path);
    assert_int_equal(status, expected);
    if (!(seconds < 1)) {
        fail_msg("%zu points took %g s", count, seconds);
    }
    return seconds;
}

enum form { CIRCLE, SPIKES, COMB, RANDOM_STAR, FORMS };

/* All of them turn round the origin but the comb, which has long thin teeth on a back that its last two points make. */
static void make_many(enum form form, narc_point *out_points) {
    struct test_random random = test_random_named("many points");
    for (size_t i = 0; i < MANY; i++) {
        const double angle = 2 * pi * (double)i / MANY;
        double length = form == SPIKES && i % 2 ? 0.5 : 1;
        if (form == RANDOM_STAR && i >= 10) {
            length = random_between(&random, 0.01, 1);
        }
        out_points[i] = (narc_point){length * cos(angle), length * sin(angle)};
        if (form == COMB) {
            out_points[i] =
                i + 2 < MANY ? (narc_point){(double)i, i % 2 ? 1e6 : 1} : (narc_point){i + 2 == MANY ? MANY : 0, -1};
        }
    }
}

static void checks_many_points_fast(void **state) {
    (void)state;
    static const char *const names[FORMS] = {"circle", "spikes", "comb", "random star"};
    narc_point *points = malloc(MANY * sizeof *points);
    assert_non_null(points);
    for (enum form form = CIRCLE; form < FORMS; form++) {
        narc_error error = {0};
        make_many(form, points);
        const double simple = check_many(points, MANY, NARC_OK, &error);
        /* Four points a, b, c, d as a, d, c, b, at the place that is swept last. The sides to d and from b cross. */
        const size_t place = form == COMB ? MANY - 10 : 2;
        const narc_point moved = points[place];
        points[place] = points[place + 2];
        points[place + 2] = moved;
        const double hit = check_many(points, MANY, NARC_ERROR_NOT_SIMPLE, &error);
        printf("%s: %g s, with two points exchanged %g s: %s\n", names[form], simple, hit, error.message);
    }
    free(points);
}

int test_simple(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(knows_simple_contours),
        cmocka_unit_test(finds_crossings_and_touches),
        cmocka_unit_test(names_contours_that_enclose_nothing),
        cmocka_unit_test(names_the_contour),
        cmocka_unit_test(checks_curves),
        cmocka_unit_test(agrees_with_all_pairs),
        cmocka_unit_test(tells_the_least_distances),
        cmocka_unit_test(tells_units_in_the_last_place),
        cmocka_unit_test(checks_many_points_fast),
    };
    return cmocka_run_group_tests(tests, NULL, NULL);
}
