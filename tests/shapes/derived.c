/* SPDX-License-Identifier: MIT
 *
 * derived.c - derived quantities of every family of shapes against samples and searches.
 */
#include <math.h>
#include <string.h>

#include "families.h"
#include "oracle.h"
#include "support.h"
#include "tests.h"

enum { PER_ARC = 500 };

typedef void check(struct test_random *random, const struct shape *shape, const struct samples *samples);

static void for_all_families(const char *name, size_t trials, check *check_one) {
    struct test_random random = test_random_named(name);
    for (size_t k = 0; k < FAMILY_COUNT * test_trials(trials); k++) {
        struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        struct samples samples = oracle_sample(shape.arcs, shape.count, PER_ARC);
        check_one(&random, &shape, &samples);
        oracle_free(&samples);
    }
}

/* The polygon through the samples lacks slivers along the arcs. They take away area, and second moment up to their area
 * times the square of the diameter. */
static void check_mass(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    (void)random;
    double diameter = 2 * oracle_reach(shape->arcs, shape->count, samples->point[0]);
    narc_mass mass, sampled = oracle_mass(samples);
    assert_true(narc_compute_mass(shape->arcs, shape->count, &mass));
    if (shape->count == 2 && shape->arcs[0].radius == 0 && shape->arcs[1].radius == 0) {
        const narc_arc *from = &shape->arcs[0], *to = &shape->arcs[1];
        assert_true(mass.area == 0 && mass.second_moment == 0);
        expect_near(mass.centroid_x, (from->center_x + to->center_x) / 2, 1e-15, "centroid x");
        expect_near(mass.centroid_y, (from->center_y + to->center_y) / 2, 1e-15, "centroid y");
        return;
    }
    double rounding = 1e-12 + 100 * samples->defect, lack = samples->area_error;
    assert_true(mass.area >= sampled.area - rounding && mass.area <= sampled.area + lack + rounding);
    assert_true(mass.second_moment >= sampled.second_moment - rounding &&
                mass.second_moment <= sampled.second_moment + lack * diameter * diameter + rounding);
    double apart = hypot(mass.centroid_x - sampled.centroid_x, mass.centroid_y - sampled.centroid_y);
    assert_true(apart * mass.area <= lack * diameter + rounding);
    assert_true(lack < 1e-3 * mass.area); /* or nothing was tested */
}

TEST(mass_matches_samples) { for_all_families("mass", 20, check_mass); }

static void check_perimeter(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    (void)random;
    double length, sampled = oracle_perimeter(samples);
    assert_true(narc_compute_perimeter(shape->arcs, shape->count, &length));
    double rounding = 1e-11 + 2 * (double)shape->count * samples->defect;
    assert_true(length >= sampled - rounding && length <= sampled + samples->length_error + rounding);
}

TEST(perimeter_matches_samples) { for_all_families("perimeter", 20, check_perimeter); }

static void check_support(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    double rounding = 1e-13 + 2 * samples->defect, error = samples->height_error + rounding;
    for (size_t k = 0; k < 40; k++) {
        /* Any direction, or exactly a normal that two arcs or an edge share. */
        double angle = k % 2 ? random_between(random, -PI, PI) : shape->arcs[random_below(random, shape->count)].start;
        double length = random_log_between(random, 1e-3, 1e3), x = cos(angle), y = sin(angle);
        narc_point point;
        size_t arc;
        assert_true(narc_find_support(shape->arcs, shape->count, x * length, y * length, &point, &arc));
        assert_true(arc < shape->count);
        double height = x * point.x + y * point.y, sampled = oracle_height(samples, x, y);
        assert_true(height >= sampled - rounding && height <= sampled + error);
        const narc_arc *a = &shape->arcs[arc];
        expect_near(hypot(point.x - a->center_x, point.y - a->center_y), a->radius, 1e-13, "distance from its arc");
        narc_aabb box;
        assert_true(narc_compute_aabb(shape->arcs, shape->count, -angle, &box));
        expect_near(box.max_x, height, rounding, "the box turned by the angle");
        assert_true(box.min_x <= -oracle_height(samples, -x, -y) + rounding);
        assert_true(box.min_x >= -oracle_height(samples, -x, -y) - error);
        assert_true(box.max_y >= oracle_height(samples, -y, x) - rounding);
        assert_true(box.max_y <= oracle_height(samples, -y, x) + error);
        assert_true(box.min_y <= -oracle_height(samples, y, -x) + rounding);
        assert_true(box.min_y >= -oracle_height(samples, y, -x) - error);
    }
}

TEST(support_matches_samples) { for_all_families("support", 8, check_support); }

/* On an edge's normal the counter-clockwise end is reported. */
TEST(support_of_an_edge_is_its_end) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count, arc;
    narc_point point;
    const double x[4] = {1, 0, -1, 0}, y[4] = {0, 1, 0, -1};
    const narc_point end[4] = {{1, 0.25}, {-0.75, 0.5}, {-1, -0.25}, {0.75, -0.5}};
    assert_int_equal(narc_build_box(2, 1, 0.25, arcs, &count, NULL), NARC_OK);
    for (size_t k = 0; k < 4; k++) {
        assert_true(narc_find_support(arcs, count, x[k], y[k], &point, &arc));
        assert_int_equal(arc, k);
        assert_true(point.x == end[k].x && point.y == end[k].y);
    }
}

static void check_distance(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    double rounding = 1e-12 + 2 * samples->defect;
    for (size_t k = 0; k < 60; k++) {
        narc_point near = samples->point[random_below(random, samples->count)], point;
        double reach = random_log_between(random, 1e-3, 3), angle = random_between(random, -PI, PI), distance;
        point = (narc_point){near.x + reach * cos(angle), near.y + reach * sin(angle)};
        if (k < shape->count) /* the centres too: the worst case of an arc's sector */
            point = (narc_point){shape->arcs[k].center_x, shape->arcs[k].center_y};
        double expected = oracle_distance(shape->arcs, shape->count, point);
        assert_true(narc_compute_distance(shape->arcs, shape->count, &point, &distance));
        if (fabs(expected) < rounding) {
            expect_near(fabs(distance), 0, 2 * rounding, "distance"); /* which side is rounding */
        } else {
            expect_near(distance, expected, rounding, "distance");
            assert_int_equal(narc_contains_point(shape->arcs, shape->count, &point), expected < 0);
        }
    }
}

TEST(distance_matches_arcs_and_edges) { for_all_families("distance", 50, check_distance); }

static void check_circles(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    (void)random;
    double rounding = 1e-12 + 2 * samples->defect;
    narc_circle bound, inner;
    assert_true(narc_compute_bounding_circle(shape->arcs, shape->count, &bound));
    assert_true(narc_compute_inscribed_circle(shape->arcs, shape->count, &inner));
    /* Each is where it says ... */
    double reach = oracle_reach(shape->arcs, shape->count, (narc_point){bound.x, bound.y});
    double room = -oracle_distance(shape->arcs, shape->count, (narc_point){inner.x, inner.y});
    expect_near(bound.radius, reach, rounding, "bounding radius");
    expect_near(inner.radius, room, rounding, "inscribed radius");
    /* ... and no other place that the search finds is better by more than the promised 1e-9. */
    double least = oracle_bounding_radius(shape->arcs, shape->count);
    double most = oracle_inscribed_radius(shape->arcs, shape->count);
    assert_true(bound.radius <= least * (1 + 1e-9));
    assert_true(inner.radius >= most * (1 - 1e-9));
}

TEST(circles_match_searches) { for_all_families("circles", 2, check_circles); }

/* Everything moves and scales with the shape. */
static void check_motion(struct test_random *random, const struct shape *shape, const struct samples *samples) {
    (void)samples;
    double angle = random_between(random, -PI, PI), scale = random_log_between(random, 1e-6, 1e6);
    double c = cos(angle), s = sin(angle), x = 3 * scale, y = -5 * scale;
    narc_arc moved[NARC_MAX_ARCS];
    for (size_t i = 0; i < shape->count; i++) {
        narc_arc a = shape->arcs[i];
        moved[i] =
            (narc_arc){x + scale * (c * a.center_x - s * a.center_y), y + scale * (s * a.center_x + c * a.center_y),
                       scale * a.radius, a.start + angle, a.end + angle};
    }
    narc_error error;
    expect_ok(narc_validate_arcs(moved, shape->count, &error), &error);
    narc_mass before, after;
    narc_circle bound, moved_bound, inner, moved_inner;
    double length, moved_length;
    assert_true(narc_compute_mass(shape->arcs, shape->count, &before));
    assert_true(narc_compute_mass(moved, shape->count, &after));
    assert_true(narc_compute_bounding_circle(shape->arcs, shape->count, &bound));
    assert_true(narc_compute_bounding_circle(moved, shape->count, &moved_bound));
    assert_true(narc_compute_inscribed_circle(shape->arcs, shape->count, &inner));
    assert_true(narc_compute_inscribed_circle(moved, shape->count, &moved_inner));
    assert_true(narc_compute_perimeter(shape->arcs, shape->count, &length));
    assert_true(narc_compute_perimeter(moved, shape->count, &moved_length));
    expect_near(after.area / (scale * scale), before.area, 1e-11, "area");
    expect_near(after.second_moment / pow(scale, 4), before.second_moment, 1e-11, "second moment");
    double cx = (after.centroid_x - x) / scale, cy = (after.centroid_y - y) / scale;
    expect_near(c * cx + s * cy, before.centroid_x, 1e-10, "centroid x");
    expect_near(c * cy - s * cx, before.centroid_y, 1e-10, "centroid y");
    expect_near(moved_bound.radius / scale, bound.radius, 1e-9 * bound.radius, "bounding radius");
    expect_near(moved_inner.radius / scale, inner.radius, 1e-9 * inner.radius, "inscribed radius");
    expect_near(moved_length / scale, length, 1e-11, "perimeter");
}

TEST(quantities_follow_motion) { for_all_families("motion", 50, check_motion); }

TEST(refuses_bad_arguments) {
    narc_arc arcs[NARC_MAX_ARCS + 1] = {{0, 0, 1, -1, 1}};
    narc_mass mass;
    narc_circle circle;
    narc_aabb box;
    double value;
    const size_t counts[2] = {0, NARC_MAX_ARCS + 1};
    for (int k = 0; k < 3; k++) {
        const narc_arc *a = k < 2 ? arcs : NULL;
        size_t n = k < 2 ? counts[k] : 4;
        assert_false(narc_compute_mass(a, n, &mass));
        assert_false(narc_compute_bounding_circle(a, n, &circle));
        assert_false(narc_compute_inscribed_circle(a, n, &circle));
        assert_false(narc_compute_aabb(a, n, 0, &box));
        assert_false(narc_compute_perimeter(a, n, &value));
        assert_false(narc_find_support(a, n, 1, 0, NULL, NULL));
        assert_false(narc_compute_distance(a, n, &(narc_point){0, 0}, &value));
        assert_false(narc_contains_point(a, n, &(narc_point){0, 0}));
    }
    assert_false(narc_compute_mass(arcs, 1, NULL));
    assert_false(narc_compute_bounding_circle(arcs, 1, NULL));
    assert_false(narc_compute_inscribed_circle(arcs, 1, NULL));
    assert_false(narc_compute_aabb(arcs, 1, 0, NULL));
    assert_false(narc_compute_perimeter(arcs, 1, NULL));
    assert_false(narc_compute_distance(arcs, 1, &(narc_point){0, 0}, NULL));
    assert_false(narc_compute_distance(arcs, 1, NULL, &value));
    assert_false(narc_contains_point(arcs, 1, NULL));
    for (int k = 0; k < 6; k++) {
        const double wrong = k % 3 == 0 ? NAN : k % 3 == 1 ? INFINITY : -INFINITY;
        const narc_point nowhere = k < 3 ? (narc_point){wrong, 0} : (narc_point){0, wrong};
        assert_false(narc_compute_distance(arcs, 1, &nowhere, &value));
        assert_false(narc_contains_point(arcs, 1, &nowhere));
        assert_false(narc_compute_aabb(arcs, 1, wrong, &box));
    }
    assert_false(narc_find_support(arcs, 1, 0, 0, NULL, NULL));
}
