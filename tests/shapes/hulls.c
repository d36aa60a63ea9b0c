/* SPDX-License-Identifier: MIT
 *
 * hulls.c - hulls of points: corners among them, none outside, of clouds, lattices, lines and circles.
 */
#include <math.h>
#include <string.h>

#include "support.h"
#include "tests.h"

enum { MOST = 400 };

/* How far a point is outside of a polygon at most, along the normals of its sides. */
static double find_outside(const narc_arc *corners, size_t count, narc_point p) {
    double most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *const a = &corners[k], *const b = &corners[(k + 1) % count];
        const long double x = (long double)b->center_x - (long double)a->center_x,
                          y = (long double)b->center_y - (long double)a->center_y;
        const long double outside =
            (((long double)p.x - (long double)a->center_x) * y - ((long double)p.y - (long double)a->center_y) * x) /
            hypotl(x, y);
        most = fmax(most, (double)outside);
    }
    return most;
}

/* A cloud, rounded to a lattice, a thin one, a circle of points, or few of them many times; anywhere. */
static size_t make_points(struct test_random *random, narc_point *out) {
    const size_t kind = random_below(random, 5), count = 3 + random_below(random, MOST - 2);
    const double size = random_log_between(random, 1e-3, 1e3), far = random_below(random, 3) ? 0 : 1e4 * size,
                 angle = random_between(random, -PI, PI);
    for (size_t k = 0; k < count; k++) {
        double x = random_between(random, -1, 1), y = random_between(random, -1, 1);
        if (kind == 1) {
            x = round(4 * x) / 4;
            y = round(4 * y) / 4;
        } else if (kind == 2)
            y *= 1e-3;
        else if (kind == 3) {
            const double turn = 2 * PI * (double)(k % 48) / 48;
            x = cos(turn);
            y = sin(turn);
        } else if (kind == 4 && k >= 3) {
            out[k] = out[random_below(random, k)];
            continue;
        }
        out[k] = (narc_point){far + size * (x * cos(angle) - y * sin(angle)), size * (x * sin(angle) + y * cos(angle))};
    }
    return count;
}

TEST(hulls_hold_all_points) {
    struct test_random random = test_random_named("hulls");
    size_t built = 0;
    for (size_t trial = 0; trial < test_trials(600); trial++) {
        narc_point points[MOST];
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = make_points(&random, points);
        size_t corners;
        double extent = 0;
        narc_error error;
        for (size_t k = 0; k < count; k++)
            for (size_t i = 0; i < k; i++)
                extent = fmax(extent, hypot(points[k].x - points[i].x, points[k].y - points[i].y));
        const double tolerance = random_below(&random, 2) ? 0 : extent * random_log_between(&random, 1e-6, 0.05);
        const double radius = random_below(&random, 2) ? 0 : extent / 8;
        const double allowed = fmax(tolerance, extent * 0x1p-17) * (1 + 1e-9) + 1e-12 * extent;
        const narc_status status = narc_build_hull(points, count, tolerance, radius, arcs, &corners, &error);
        if (status == NARC_ERROR_NOT_CONVEX ||
            status == NARC_ERROR_COUNT) { /* few points, or a thin cloud; too round a one */
            assert_true(status == NARC_ERROR_COUNT ? error.value > tolerance : tolerance > 0 || count < 9);
            if (status == NARC_ERROR_COUNT)
                expect_ok(narc_build_hull(points, count, error.value, radius, arcs, &corners, &error), &error);
            continue;
        }
        expect_ok(status, &error);
        built++;
        for (size_t k = 0; k < count; k++)
            assert_true(find_outside(arcs, corners, points[k]) <= allowed);
        for (size_t k = 0; k < corners; k++) {
            bool among = false;
            for (size_t i = 0; i < count; i++)
                among |= points[i].x == arcs[k].center_x && points[i].y == arcs[k].center_y;
            assert_true(among && arcs[k].radius == radius);
            /* No corner that hardly counts is left. */
            narc_arc others[NARC_MAX_ARCS];
            memcpy(others, arcs, k * sizeof *arcs);
            memcpy(others + k, arcs + k + 1, (corners - k - 1) * sizeof *arcs);
            if (corners > 3)
                assert_true(find_outside(others, corners - 1, (narc_point){arcs[k].center_x, arcs[k].center_y}) >=
                            extent * 0x1p-19 * (1 - 1e-6) - 1e-12 * extent);
        }
    }
    assert_true(built > test_trials(600) / 2);
}

/* The hull of a square with points on its sides, twice, is the square. */
TEST(points_in_line_are_left_out) {
    const narc_point points[] = {{0, 0}, {0.5, 0}, {1, 0},     {1, 0.25}, {1, 1}, {0.75, 1}, {0.25, 1},
                                 {0, 1}, {0, 0.5}, {0.5, 0.5}, {1, 1},    {0, 0}, {0.1, 0}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    expect_ok(narc_build_hull(points, sizeof points / sizeof *points, 0, 0, arcs, &count, &error), &error);
    assert_int_equal(count, 4);
    for (size_t k = 0; k < 4; k++) {
        assert_true(fabs(arcs[k].center_x - 0.5) == 0.5 && fabs(arcs[k].center_y - 0.5) == 0.5);
        assert_true((arcs[(k + 1) % 4].center_x - arcs[k].center_x) * (arcs[k].center_y - 0.5) <= 0);
    }
}

TEST(hulls_that_are_none) {
    const narc_point line[] = {{0, 0}, {1, 1}, {2, 2}, {0.5, 0.5}}, same[] = {{1, 2}, {1, 2}, {1, 2}};
    narc_point bad[3] = {{0, 0}, {1, 0}, {0, NAN}}, round[500];
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count = 77;
    narc_error error;
    for (size_t k = 0; k < 500; k++)
        round[k] = (narc_point){cos(2 * PI * (double)k / 500), sin(2 * PI * (double)k / 500)};
    expect_error(narc_build_hull(line, 4, 0, 0, arcs, &count, &error), NARC_ERROR_NOT_CONVEX, &error, "of a segment");
    expect_error(narc_build_hull(same, 3, 0, 0, arcs, &count, &error), NARC_ERROR_NOT_CONVEX, &error, "of a segment");
    expect_error(narc_build_hull(line, 2, 0, 0, arcs, &count, &error), NARC_ERROR_COUNT, &error, "2 points");
    expect_error(narc_build_hull(bad, 3, 0, 0, arcs, &count, &error), NARC_ERROR_NOT_FINITE, &error, "point");
    expect_error(narc_build_hull(line, 4, -1, 0, arcs, &count, &error), NARC_ERROR_SIZE, &error, "tolerance is -1");
    expect_error(narc_build_hull(line, 4, 0, -1, arcs, &count, &error), NARC_ERROR_RADIUS, &error, "radius is -1");
    expect_error(narc_build_hull(NULL, 4, 0, 0, arcs, &count, &error), NARC_ERROR_ARGUMENT, &error, "points is NULL");
    expect_error(narc_build_hull(line, 4, 0, 0, NULL, &count, &error), NARC_ERROR_ARGUMENT, &error, "NULL");
    expect_error(narc_build_hull(round, 500, 0, 0, arcs, &count, &error), NARC_ERROR_COUNT, &error,
                 "more than 64 corners");
    assert_int_equal(count, 77);
    expect_ok(narc_build_hull(round, 500, error.value, 0, arcs, &count, &error), &error);
    assert_true(count <= NARC_MAX_ARCS && count > 30);
}
