/* SPDX-License-Identifier: MIT
 *
 * polylines.c - outlines as polylines: how far one is from the other, of shapes of all families and of chains, in any place.
 */
#include <math.h>
#include <stdlib.h>

#include "chains.h"
#include "families.h"
#include "oracle.h"
#include "support.h"
#include "tests.h"

static double find_distance(narc_point p, narc_point a, narc_point b) {
    const double x = b.x - a.x, y = b.y - a.y, square = x * x + y * y;
    const double t = square > 0 ? fmin(1, fmax(0, ((p.x - a.x) * x + (p.y - a.y) * y) / square)) : 0;
    return hypot(a.x + t * x - p.x, a.y + t * y - p.y);
}

static double find_way_to(const narc_point *line, size_t count, bool closed, narc_point p) {
    double least = INFINITY;
    for (size_t k = 0; k + !closed < count || k == 0; k++)
        least = fmin(least, find_distance(p, line[k], line[(k + 1) % count]));
    return least;
}

static narc_point place(const narc_body *body, narc_point p) {
    const double c = (double)body->cosine, s = (double)body->sine, scale = (double)body->scale / hypot(c, s);
    return (narc_point){body->x + scale * (c * p.x - s * p.y), body->y + scale * (s * p.x + c * p.y)};
}

/* Into memory of just the size that is said. */
static narc_point *flatten(const narc_arc *arcs, size_t count, bool closed, const narc_body *body, double tolerance,
                           size_t *out_count) {
    narc_error error;
    size_t needed = 0;
    assert_int_equal(narc_flatten_arcs(arcs, count, closed, body, tolerance, NULL, 0, &needed, &error),
                     NARC_ERROR_CAPACITY);
    narc_point *const line = malloc(needed * sizeof *line);
    expect_ok(narc_flatten_arcs(arcs, count, closed, body, tolerance, line, needed, out_count, &error), &error);
    assert_true(*out_count <= needed);
    return line;
}

/* All samples of the outline are near the polyline, and all samples of this near the outline: both bounds are reached by half. */
TEST(polylines_are_within_the_tolerance) {
    struct test_random random = test_random_named("polylines");
    double worst = 0;
    for (size_t trial = 0; trial < FAMILY_COUNT * test_trials(6); trial++) {
        const struct shape shape = make_shape(&random, (enum family)(trial % FAMILY_COUNT));
        struct samples samples = oracle_sample(shape.arcs, shape.count, 60);
        const double size = 2 * oracle_reach(shape.arcs, shape.count, samples.point[0]);
        const double tolerance = size * random_log_between(&random, 1e-5, 0.1), rounding = 1e-9 * size + samples.defect;
        size_t count;
        AUTO(free_at) narc_point *const line = flatten(shape.arcs, shape.count, true, NULL, tolerance, &count);
        for (size_t k = 0; k < samples.count; k++) {
            const double way = find_way_to(line, count, true, samples.point[k]);
            assert_true(way <= tolerance + rounding);
            worst = fmax(worst, way / tolerance);
        }
        double area = 0;
        for (size_t k = 0; k < count; k++) {
            const narc_point a = line[k], b = line[(k + 1) % count];
            area += (a.x - line[0].x) * (b.y - line[0].y) - (a.y - line[0].y) * (b.x - line[0].x);
            for (int i = 0; i < 8; i++) {
                const narc_point p = {a.x + (b.x - a.x) * i / 8, a.y + (b.y - a.y) * i / 8};
                double distance;
                assert_true(narc_compute_distance(shape.arcs, shape.count, &p, &distance));
                assert_true(fabs(distance) <= tolerance + rounding);
            }
            assert_true(count < 2 || hypot(b.x - a.x, b.y - a.y) > tolerance * 0x1p-10);
        }
        assert_true(area >= -rounding * size); /* counter-clockwise */
        oracle_free(&samples);
    }
    assert_true(worst > 0.5);
}

/* A body's polyline is that of its shape, placed; its tolerance is the world's. */
TEST(polylines_of_bodies_are_placed) {
    struct test_random random = test_random_named("polylines of bodies");
    for (size_t trial = 0; trial < FAMILY_COUNT * test_trials(2); trial++) {
        const struct shape shape = make_shape(&random, (enum family)(trial % FAMILY_COUNT));
        const double angle = random_between(&random, -PI, PI), scale = random_log_between(&random, 0.1, 10);
        const narc_body body = {random_between(&random, -9, 9),
                                random_between(&random, -9, 9),
                                (float)cos(angle),
                                (float)sin(angle),
                                (float)scale,
                                0};
        size_t count, own_count;
        AUTO(free_at)
        narc_point *const line = flatten(shape.arcs, shape.count, true, &body, 0.01 * (double)body.scale, &count);
        AUTO(free_at) narc_point *const own = flatten(shape.arcs, shape.count, true, NULL, 0.01, &own_count);
        assert_int_equal(count, own_count);
        for (size_t k = 0; k < count; k++) {
            const narc_point p = place(&body, own[k]);
            assert_true(hypot(p.x - line[k].x, p.y - line[k].y) <= 1e-12 * (1 + hypot(p.x, p.y)) * 100);
        }
    }
}

/* Points of a chain's arcs, convex and concave, are near its polyline, in their order. */
TEST(polylines_of_chains_go_along) {
    struct test_random random = test_random_named("polylines of chains");
    const enum chain_family families[] = {CHAIN_HILLS, CHAIN_BOWLS, CHAIN_MIXED, CHAIN_STEPS};
    for (size_t trial = 0; trial < 4 * test_trials(6); trial++) {
        AUTO(free_at) const struct chain chain = make_chain(&random, families[trial % 4]);
        const double tolerance = random_log_between(&random, 1e-4, 0.1);
        size_t count, at = 0;
        AUTO(free_at) narc_point *const line = flatten(chain.arcs, chain.count, false, NULL, tolerance, &count);
        for (size_t k = 0; k < chain.count; k++) {
            const narc_arc *const arc = &chain.arcs[k];
            const bool concave = signbit(arc->radius);
            double turn = concave ? arc->start - arc->end : arc->end - arc->start;
            turn = (turn < 0 ? turn + 2 * PI : turn) * (concave ? -1 : 1);
            for (int i = 0; i <= 20; i++) {
                const double angle = arc->start + turn * i / 20;
                const narc_point p = {arc->center_x + arc->radius * cos(angle),
                                      arc->center_y + arc->radius * sin(angle)};
                while (at + 2 < count && !(find_distance(p, line[at], line[at + 1]) <= tolerance + 1e-9))
                    at++; /* never back */
                assert_true(find_distance(p, line[at], line[at + 1]) <= tolerance + 1e-9);
            }
        }
    }
}

TEST(polylines_that_are_none) {
    narc_arc arcs[NARC_MAX_ARCS];
    narc_point points[100];
    size_t count, found = 5;
    narc_error error;
    const narc_body broken = {0, 0, 2, 0, 1, 0};
    assert_int_equal(narc_build_capsule(2, 1, arcs, &count, &error), NARC_OK);
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, 0, points, 100, &found, &error), NARC_ERROR_ARGUMENT,
                 &error, "tolerance");
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, NAN, points, 100, &found, &error), NARC_ERROR_NOT_FINITE,
                 &error, "tolerance");
    expect_error(narc_flatten_arcs(arcs, count, true, &broken, 1, points, 100, &found, &error), NARC_ERROR_ARGUMENT,
                 &error, "broken");
    expect_error(narc_flatten_arcs(NULL, 2, true, NULL, 1, points, 100, &found, &error), NARC_ERROR_ARGUMENT, &error,
                 "arcs is NULL");
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, 1, NULL, 100, &found, &error), NARC_ERROR_ARGUMENT, &error,
                 "NULL");
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, 1e-300, points, 100, &found, &error), NARC_ERROR_CAPACITY,
                 &error, "room for 100");
    arcs[1].end = 1e9;
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, 1, points, 100, &found, &error), NARC_ERROR_SWEEP, &error,
                 "arc 1");
    arcs[1].end = INFINITY;
    expect_error(narc_flatten_arcs(arcs, count, true, NULL, 1, points, 100, &found, &error), NARC_ERROR_NOT_FINITE,
                 &error, "arc 1");
    expect_ok(narc_flatten_arcs(NULL, 0, true, NULL, 1, NULL, 0, &found, &error), &error);
    assert_int_equal(found, 0);
}
