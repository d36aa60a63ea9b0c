/* SPDX-License-Identifier: MIT
 *
 * junctions.c - n-arcs from junctions, the range of radii, and the adjustment of polygons.
 */
#include <math.h>
#include <string.h>

#include "families.h"
#include "support.h"
#include "tests.h"

static double apart(narc_point a, narc_point b) { return hypot(a.x - b.x, a.y - b.y); }

static narc_point point_on(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

#define REFUSED(STATUS, words, ...) expect_error(__VA_ARGS__, NARC_ERROR_##STATUS, &error, words)

/* The arcs run from point to point and are tangent to each other. */
static void expect_n_arc(const narc_arc *arcs, size_t count, const narc_point *points, size_t point_count,
                         double tolerance) {
    narc_error error;
    assert_int_equal(count, point_count);
    expect_ok(narc_validate_arcs(arcs, count, &error), &error);
    for (size_t i = 0; i < count; i++) {
        size_t next = (i + 1) % count;
        expect_near(apart(point_on(&arcs[i], arcs[i].start), points[i]), 0, tolerance, "distance of an arc's start");
        expect_near(apart(point_on(&arcs[i], arcs[i].end), points[next]), 0, tolerance, "distance of an arc's end");
        expect_near(remainder(arcs[i].end - arcs[next].start, 2 * PI), 0, 1e-12, "angle between two arcs");
    }
}

/* Corners of an outline that turns by `turns` (degrees) and has sides as given, the last two of which close it. */
static void walk(const double *turns, const double *sides, size_t count, narc_point *points) {
    double angle = 0;
    narc_point at = {0, 0};
    for (size_t i = 0; i < count; i++) {
        points[i] = at;
        angle += i ? turns[i] * PI / 180 : 0;
        at = (narc_point){at.x + sides[i] * cos(angle), at.y + sides[i] * sin(angle)};
    }
    expect_near(hypot(at.x, at.y), 0, 1e-9, "gap of the outline");
}

TEST(three_points_give_their_circle) {
    const narc_point points[3] = {{1, 2}, {5, 2.5}, {3, 5}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    expect_ok(narc_build_points(points, 3, 0, arcs, &count, &error), &error);
    expect_n_arc(arcs, count, points, 3, 1e-14);
    for (size_t i = 0; i < 3; i++) {
        expect_near(arcs[i].radius, arcs[0].radius, 1e-14, "radius");
        expect_near(arcs[i].center_x, arcs[0].center_x, 1e-14, "center x");
        expect_near(arcs[i].center_y, arcs[0].center_y, 1e-14, "center y");
    }
    narc_circle bound;
    narc_mass mass;
    assert_true(narc_compute_bounding_circle(arcs, 3, &bound) && narc_compute_mass(arcs, 3, &mass));
    expect_near(bound.radius, arcs[0].radius, 1e-14, "bounding radius");
    expect_near(mass.area, PI * bound.radius * bound.radius, 1e-13, "area");
    expect_near(mass.second_moment, PI * pow(bound.radius, 4) / 2, 1e-12, "second moment");
}

/* Pentagons with convex corners near a circle: always one solution, and giving another radius is an error. */
TEST(random_pentagons_have_one_solution) {
    struct test_random random = test_random_named("pentagons");
    for (size_t k = 0; k < test_trials(2000); k++) {
        narc_point points[5];
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count;
        narc_error error;
        for (size_t i = 0; i < 5; i++) {
            double angle = 2 * PI * ((double)i + random_between(&random, -0.15, 0.15)) / 5;
            double distance = random_between(&random, 0.95, 1.05);
            points[i] = (narc_point){distance * cos(angle), distance * sin(angle)};
        }
        expect_ok(narc_build_points(points, 5, 0, arcs, &count, &error), &error);
        expect_n_arc(arcs, count, points, 5, 1e-13);
        double least, most, chosen;
        expect_ok(narc_find_radius_range(points, 5, &least, &most, &chosen, &error), &error);
        assert_true(least == most && most == chosen);
        expect_near(arcs[0].radius, chosen, 1e-13, "radius");
        expect_ok(narc_build_points(points, 5, chosen * (1 + 1e-7), arcs, &count, &error), &error);
        expect_near(arcs[0].radius, chosen, 1e-13, "radius");
        REFUSED(RADIUS, "odd number", narc_build_points(points, 5, chosen * 1.001, arcs, &count, &error));
    }
}

static double spread_of(const narc_arc *arcs, size_t count) {
    double sum = 0, squares = 0;
    for (size_t i = 0; i < count; i++) {
        sum += log(arcs[i].radius);
        squares += log(arcs[i].radius) * log(arcs[i].radius);
    }
    return squares / (double)count - sum / (double)count * (sum / (double)count);
}

/* The junctions of a random n-arc with an even number of arcs: its first radius gives the n-arc back, every radius in
 * the range gives one, none outside it does, and none makes the radii more alike than the chosen one. */
TEST(even_counts_have_a_range) {
    struct test_random random = test_random_named("even counts");
    size_t built = 0;
    for (size_t k = 0; k < test_trials(800); k++) {
        struct shape shape = make_shape(&random, FAMILY_SMOOTH);
        narc_point points[NARC_MAX_ARCS];
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count;
        narc_error error;
        double least, most, chosen;
        if (shape.count % 2)
            continue;
        for (size_t i = 0; i < shape.count; i++)
            points[i] = point_on(&shape.arcs[i], shape.arcs[i].start);
        expect_ok(narc_build_points(points, shape.count, shape.arcs[0].radius, arcs, &count, &error), &error);
        expect_n_arc(arcs, count, points, shape.count, 1e-11);
        for (size_t i = 0; i < count; i++)
            expect_near(arcs[i].radius, shape.arcs[i].radius, 1e-9 * shape.arcs[i].radius, "radius");
        expect_ok(narc_find_radius_range(points, shape.count, &least, &most, &chosen, &error), &error);
        assert_true(least <= chosen && chosen < most); /* a half circle is the end of the range that it includes */
        expect_ok(narc_build_points(points, shape.count, 0, arcs, &count, &error), &error);
        expect_n_arc(arcs, count, points, shape.count, 1e-11);
        expect_near(arcs[0].radius, chosen, 1e-12 * chosen, "chosen radius");
        double best = spread_of(arcs, count);
        for (int step = 1; step < 20; step++) {
            double radius = 1 / (1 / least + step / 20.0 * (1 / most - 1 / least));
            if (narc_build_points(points, shape.count, radius, arcs, &count, &error) == NARC_OK) {
                built++;
                expect_n_arc(arcs, count, points, shape.count, 1e-11);
                expect_near(arcs[0].radius, radius, 1e-12 * radius, "given radius");
                assert_true(spread_of(arcs, count) >= best - 1e-9);
            } else { /* within the range only the ratio of radii can be wrong */
                expect_error(error.status, NARC_ERROR_RADIUS, &error, "bounding radius");
            }
        }
        REFUSED(RADIUS, "not between", narc_build_points(points, shape.count, least * 0.999, arcs, &count, &error));
        if (isfinite(most))
            REFUSED(RADIUS, "not between", narc_build_points(points, shape.count, most * 1.001, arcs, &count, &error));
    }
    assert_true(built > 0);
}

/* Exterior angles 100, 40, 40, 100, 40, 40: the sums agree, and there is still no solution. */
TEST(tells_when_there_is_no_solution) {
    const double turns[6] = {100, 40, 40, 100, 40, 40}, sides[6] = {1, 1, 1, 1, 1, 1};
    narc_point points[6], trapezoid[4] = {{0, 0}, {4, 0}, {3, 1}, {0, 1}};
    narc_arc arcs[NARC_MAX_ARCS], pattern[NARC_MAX_ARCS];
    size_t count = 77;
    double least = 1, most = 2, chosen = 3;
    narc_error error;
    memset(arcs, 0x5a, sizeof arcs);
    memset(pattern, 0x5a, sizeof pattern);
    walk(turns, sides, 6, points);
    REFUSED(NO_SOLUTION, "arcs 4 and 1", narc_build_points(points, 6, 0, arcs, &count, &error));
    REFUSED(NO_SOLUTION, "arcs 4 and 1", narc_find_radius_range(points, 6, &least, &most, &chosen, &error));
    REFUSED(NO_SOLUTION, "even points add up to", narc_build_points(trapezoid, 4, 0, arcs, &count, &error));
    /* A triangle with an angle above a right angle: one alpha is that angle. */
    const narc_point blunt[3] = {{-3, 0}, {3, 0}, {0, 1}};
    REFUSED(NO_SOLUTION, "arc 0", narc_build_points(blunt, 3, 0, arcs, &count, &error));
    assert_true(least == 1 && most == 2 && chosen == 3 && count == 77);
    assert_memory_equal(arcs, pattern, sizeof arcs);
}

TEST(refuses_bad_points) {
    const narc_point square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, clockwise[4] = {{0, 0}, {0, 1}, {1, 1}, {1, 0}};
    const narc_point same[4] = {{0, 0}, {1, 0}, {1, 0}, {0, 1}}, bad[3] = {{0, 0}, {1, 0}, {0, INFINITY}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    double least, most, chosen;
    narc_error error;
    REFUSED(ARGUMENT, "points", narc_build_points(NULL, 4, 0, arcs, &count, &error));
    REFUSED(ARGUMENT, "output", narc_build_points(square, 4, 0, NULL, &count, &error));
    REFUSED(COUNT, "2 points", narc_build_points(square, 2, 0, arcs, &count, &error));
    REFUSED(COUNT, "65 points", narc_build_points(square, 65, 0, arcs, &count, &error));
    REFUSED(NOT_FINITE, "point 2", narc_build_points(bad, 3, 0, arcs, &count, &error));
    REFUSED(NOT_FINITE, "radius", narc_build_points(square, 4, NAN, arcs, &count, &error));
    REFUSED(RADIUS, "radius is -1", narc_build_points(square, 4, -1, arcs, &count, &error));
    REFUSED(RADIUS, "not between 0.5", narc_build_points(square, 4, 0.4, arcs, &count, &error));
    REFUSED(NOT_CONVEX, "point 0", narc_build_points(clockwise, 4, 0, arcs, &count, &error));
    assert_non_null(strstr(error.message, "clockwise: reverse the points"));
    REFUSED(SIZE, "point 1", narc_build_points(same, 4, 0, arcs, &count, &error));
    narc_point star[5];
    for (size_t i = 0; i < 5; i++)
        star[i] = (narc_point){cos(0.8 * PI * (double)i), sin(0.8 * PI * (double)i)};
    REFUSED(NOT_CONVEX, "not once", narc_build_points(star, 5, 0, arcs, &count, &error));
    REFUSED(ARGUMENT, "output", narc_find_radius_range(square, 4, NULL, &most, &chosen, &error));
    expect_ok(narc_find_radius_range(square, 4, &least, &most, &chosen, &error), &error);
    expect_near(least, 0.5, 1e-14, "least radius");
    assert_true(most == INFINITY);
    expect_near(chosen, sqrt(0.5), 1e-8, "chosen radius");
    /* The junctions of a 7-digit file. */
    const narc_point digits[4] = {{0.1234567, 0}, {1, 0.2345678}, {0.7654322, 1}, {-0.2345678, 0.6543211}};
    narc_point rounded[4];
    expect_ok(narc_adjust_polygon(digits, 4, rounded, &error), &error);
    for (size_t i = 0; i < 4; i++)
        rounded[i] = (narc_point){round(rounded[i].x * 1e7) / 1e7, round(rounded[i].y * 1e7) / 1e7};
    expect_ok(narc_build_points(rounded, 4, 0, arcs, &count, &error), &error);
}

/* ------------------------------------------------------------------------------------------------ polygons */

static void expect_adjusted(const narc_point *polygon, size_t count, const char *what) {
    narc_point points[NARC_MAX_ARCS];
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count = 0;
    narc_error error = {0};
    narc_status status = narc_adjust_polygon(polygon, count, points, &error);
    if (status == NARC_OK)
        status = narc_build_points(points, count, 0, arcs, &arc_count, &error);
    if (status != NARC_OK)
        fail_msg("%s with %zu corners: %s: %s", what, count, narc_status_name(status), error.message);
    /* A point far from the origin is known to few digits; relative to that, all is exact. */
    double far = 1 + hypot(polygon[0].x, polygon[0].y);
    expect_n_arc(arcs, arc_count, points, count, 1e-11 * far);
}

/* Stars around a point, convex and not, of either orientation; simple because the angles increase by less than pi. */
TEST(adjusts_random_polygons) {
    struct test_random random = test_random_named("polygons");
    for (size_t k = 0; k < test_trials(1000); k++) {
        narc_point p[NARC_MAX_ARCS];
        size_t n = 3 + random_below(&random, k % 8 ? 14 : 62);
        double sense = random_below(&random, 2) ? 1 : -1, depth = k % 2 ? random_between(&random, 0, 5) : 0;
        double flatness = random_below(&random, 3) ? 1 : random_log_between(&random, 1e-4, 1);
        narc_point middle = {random_between(&random, -9, 9), random_between(&random, -9, 9)};
        for (size_t i = 0; i < n; i++) {
            double angle = sense * 2 * PI * ((double)i + 0.45 * random_unit(&random)) / (double)n;
            double distance = exp(-depth * random_unit(&random));
            p[i] = (narc_point){middle.x + distance * cos(angle), middle.y + flatness * distance * sin(angle)};
        }
        expect_adjusted(p, n, "a star");
    }
}

TEST(adjusts_nasty_polygons) {
    struct test_random random = test_random_named("nasty polygons");
    narc_point p[NARC_MAX_ARCS];
    for (size_t n = 3; n <= NARC_MAX_ARCS; n++) {
        /* All corners but one on a line, straight or with a little noise. */
        for (int noise = 0; noise < 2; noise++) {
            for (size_t i = 0; i < n; i++)
                p[i] = (narc_point){(double)i, noise * 1e-7 * random_unit(&random)};
            p[n - 1] = (narc_point){0.5 * (double)n, 3};
            expect_adjusted(p, n, "a fan");
        }
        /* Corners ever closer together. */
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * PI * pow((double)i / (double)n, 2.5);
            p[i] = (narc_point){cos(angle), sin(angle)};
        }
        expect_adjusted(p, n, "a crowd");
        /* A comb. */
        for (size_t i = 0; i + 2 < n; i++)
            p[i] = (narc_point){(double)i, i % 2 ? 5 : 0};
        p[n - 2] = (narc_point){(double)n, 6};
        p[n - 1] = (narc_point){-1, 6};
        if (n > 3)
            expect_adjusted(p, n, "a comb");
        /* A band wound up as a spiral, 1.5 turns. */
        size_t half = n / 2;
        for (size_t i = 0; i < half && n % 2 == 0 && n >= 24; i++) {
            double angle = 3 * PI * (double)i / (double)(half - 1), distance = 1 + 0.4 * angle;
            p[i] = (narc_point){(distance + 0.2) * cos(angle), (distance + 0.2) * sin(angle)};
            p[n - 1 - i] = (narc_point){(distance - 0.2) * cos(angle), (distance - 0.2) * sin(angle)};
            if (i + 1 == half)
                expect_adjusted(p, n, "a spiral");
        }
    }
}

/* Where there is an n-arc already, nothing moves: acute triangles, regular polygons, and the junctions of n-arcs. */
TEST(leaves_good_polygons_alone) {
    struct test_random random = test_random_named("good polygons");
    size_t tested = 0;
    for (size_t k = 0; k < test_trials(1000); k++) {
        struct shape shape = make_shape(&random, FAMILY_SMOOTH);
        narc_point points[NARC_MAX_ARCS], adjusted[NARC_MAX_ARCS];
        narc_error error;
        bool roomy = true;
        for (size_t i = 0; i < shape.count; i++) {
            points[i] = point_on(&shape.arcs[i], shape.arcs[i].start);
            double half = (shape.arcs[i].end - shape.arcs[i].start) / 2;
            roomy = roomy && half > 0.3 * PI / (double)shape.count && half < PI / 2;
        }
        if (!roomy)
            continue;
        tested++;
        expect_ok(narc_adjust_polygon(points, shape.count, adjusted, &error), &error);
        for (size_t i = 0; i < shape.count; i++)
            expect_near(apart(points[i], adjusted[i]), 0, 1e-6, "moved by");
    }
    assert_true(tested > test_trials(1000) / 20);
}

/* The outline's exterior angles. */
static void find_turns(const narc_point *p, size_t count, double *turns) {
    for (size_t i = 0; i < count; i++) {
        narc_point a = p[(i + count - 1) % count], b = p[i], c = p[(i + 1) % count];
        double ux = b.x - a.x, uy = b.y - a.y, vx = c.x - b.x, vy = c.y - b.y;
        turns[i] = atan2(ux * vy - uy * vx, ux * vx + uy * vy);
    }
}

/* Near a regular polygon with an even count no alpha is at a limit. The nearest angles whose even and odd sums agree
 * are then those from which the difference is taken in equal parts; new sides go through the middles of the old. */
TEST(changes_angles_least) {
    struct test_random random = test_random_named("least change");
    for (size_t k = 0; k < test_trials(500); k++) {
        narc_point points[12], adjusted[12];
        double old[12], new[12], apart_by = 0;
        size_t n = 6 + 2 * random_below(&random, 4);
        narc_error error;
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * PI * ((double)i + random_between(&random, -0.05, 0.05)) / (double)n;
            double distance = random_between(&random, 0.99, 1.01);
            points[i] = (narc_point){distance * cos(angle), distance * sin(angle)};
        }
        expect_ok(narc_adjust_polygon(points, n, adjusted, &error), &error);
        find_turns(points, n, old);
        find_turns(adjusted, n, new);
        for (size_t i = 0; i < n; i++)
            apart_by += i % 2 ? -old[i] : old[i];
        for (size_t i = 0; i < n; i++) {
            narc_point a = adjusted[i], b = adjusted[(i + 1) % n], c = points[i], d = points[(i + 1) % n];
            expect_near(new[i], old[i] + (i % 2 ? apart_by : -apart_by) / (double)n, 1e-9, "exterior angle");
            double x = (c.x + d.x) / 2 - a.x, y = (c.y + d.y) / 2 - a.y;
            expect_near(((b.x - a.x) * y - (b.y - a.y) * x) / apart(a, b), 0, 1e-12, "distance from a side's middle");
        }
    }
}

/* The same polygon backwards gives the same outline, still counter-clockwise and from the same corner. */
TEST(takes_either_orientation) {
    struct test_random random = test_random_named("orientation");
    for (size_t k = 0; k < test_trials(500); k++) {
        narc_point points[16], backwards[16], a[16], b[16];
        size_t n = 3 + random_below(&random, 14);
        narc_error error;
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * PI * ((double)i + random_between(&random, -0.3, 0.3)) / (double)n;
            double distance = random_between(&random, 0.3, 1);
            points[i] = backwards[(n - i) % n] = (narc_point){distance * cos(angle), distance * sin(angle)};
        }
        expect_ok(narc_adjust_polygon(points, n, a, &error), &error);
        expect_ok(narc_adjust_polygon(backwards, n, b, &error), &error);
        for (size_t i = 0; i < n; i++)
            expect_near(apart(a[i], b[i]), 0, 1e-9, "distance between the two");
    }
}

TEST(refuses_bad_polygons) {
    const narc_point square[4] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}}, bow[4] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}};
    const narc_point same[4] = {{0, 0}, {1, 0}, {1, 0}, {0, 1}}, flat[3] = {{0, 0}, {1, 0}, {2, 0}};
    const narc_point spike[4] = {{0, 0}, {2, 0}, {1, 0}, {1, 1}}, bad[3] = {{0, 0}, {NAN, 0}, {0, 1}};
    const narc_point touch[5] = {{0, 0}, {2, 0}, {2, 1}, {1, 0}, {0, 1}};
    const narc_point twice[6] = {{0, 0}, {1, 0}, {0.5, 1}, {0, 0}, {-1, 0}, {-0.5, -1}};
    const narc_point one[3] = {{1, 1}, {1, 1}, {1, 1}};
    narc_point out[NARC_MAX_ARCS] = {{7, 7}};
    narc_error error;
    REFUSED(ARGUMENT, "polygon", narc_adjust_polygon(NULL, 4, out, &error));
    REFUSED(ARGUMENT, "out_points", narc_adjust_polygon(square, 4, NULL, &error));
    REFUSED(COUNT, "2 points", narc_adjust_polygon(square, 2, out, &error));
    REFUSED(COUNT, "65 points", narc_adjust_polygon(square, 65, out, &error));
    REFUSED(NOT_FINITE, "point 1", narc_adjust_polygon(bad, 3, out, &error));
    REFUSED(NOT_SIMPLE, "sides 0 and 2", narc_adjust_polygon(bow, 4, out, &error));
    REFUSED(NOT_SIMPLE, "point 1", narc_adjust_polygon(same, 4, out, &error));
    REFUSED(NOT_SIMPLE, "sides", narc_adjust_polygon(flat, 3, out, &error));
    REFUSED(NOT_SIMPLE, "sides 0 and 1", narc_adjust_polygon(spike, 4, out, &error));
    REFUSED(NOT_SIMPLE, "sides 0 and 2", narc_adjust_polygon(touch, 5, out, &error));
    REFUSED(NOT_SIMPLE, "sides 0 and 2", narc_adjust_polygon(twice, 6, out, &error));
    REFUSED(NOT_SIMPLE, "all points", narc_adjust_polygon(one, 3, out, &error));
    for (int k = 0; k < 2; k++) {
        const double size = k ? 4 * NARC_MAX_SIZE : NARC_MIN_SIZE / 4;
        const narc_point sized[3] = {{0, 0}, {size, 0}, {0, size}};
        REFUSED(SIZE, "the polygon's size is", narc_adjust_polygon(sized, 3, out, &error));
    }
    assert_true(out[0].x == 7 && out[0].y == 7);
}
