/* SPDX-License-Identifier: MIT
 *
 * paths.c - paths: the pen's errors, flattening, and points read from CSV and JSON.
 */
#include <math.h>
#include <string.h>

#include "fit_support.h"

/* ---------------------------------------------------------------------------- the pen */

/* Draws with the degree's function; points[degree - 1] is where it goes. Degree 0 moves. */
static narc_status draw(narc_path *path, unsigned degree, const narc_point *points, narc_error *error) {
    switch (degree) {
    case 0:
        return narc_move_to(path, &points[0], error);
    case 1:
        return narc_line_to(path, &points[0], error);
    case 2:
        return narc_quadratic_to(path, &points[0], &points[1], error);
    default:
        return narc_cubic_to(path, &points[0], &points[1], &points[2], error);
    }
}

TEST(refuses_to_draw_without_contour) {
    static const narc_point points[] = {{1, 2}, {3, 4}, {5, 6}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    for (unsigned degree = 0; degree <= 3; degree++) {
        narc_error error;
        expect_error(draw(NULL, degree, points, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
        if (degree > 0) {
            expect_error(draw(path, degree, points, &error), NARC_ERROR_ARGUMENT, &error, "no contour was begun");
            assert_int_equal(draw(path, degree, points, NULL), NARC_ERROR_ARGUMENT);
        }
    }
    AUTO(narc_release_contours) narc_contours contours = flatten(path);
    assert_int_equal(contours.count, 0);
    assert_int_equal(contours.point_count, 0);
    narc_destroy_path(NULL);
    narc_release_contours(NULL);
    assert_int_equal(narc_create_path(NULL), NARC_ERROR_ARGUMENT);
}

/* One coordinate after the other of every move gets a value that it cannot have. */
TEST(refuses_wrong_coordinates) {
    static const struct {
        double value;
        narc_status status;
        const char *words;
    } wrong[] = {
        {NAN, NARC_ERROR_NOT_FINITE, "not finite"},
        {INFINITY, NARC_ERROR_NOT_FINITE, "inf"},
        {-INFINITY, NARC_ERROR_NOT_FINITE, "-inf"},
        {1e9 + 1, NARC_ERROR_SIZE, "1000000001, coordinates reach up to 1e+09"},
        {-1e300, NARC_ERROR_SIZE, "coordinates reach up to 1e+09"},
    };
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    for (unsigned degree = 0; degree <= 3; degree++) {
        for (unsigned place = 0; place < 2 * (degree ? degree : 1); place++) {
            for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++) {
                double numbers[6] = {1, 2, 3, 4, 5, 6};
                narc_point points[3];
                narc_error error;
                numbers[place] = wrong[k].value;
                memcpy(points, numbers, sizeof points);
                expect_error(draw(path, degree, points, &error), wrong[k].status, &error, wrong[k].words);
                assert_non_null(strstr(error.message, place % 2 ? ": y is" : ": x is"));
                assert_int_equal(strncmp(error.message, "control point 1", 15) == 0, degree > 1 && place < 2);
                assert_memory_equal(&error.value, &wrong[k].value, sizeof error.value);
                expect_unchanged(path);
            }
        }
    }
}

TEST(takes_the_largest_coordinates) {
    const double most = NARC_MAX_COORDINATE;
    const narc_point square[] = {{-most, -most}, {most, -most}, {most, most}, {-most, most}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    draw_polygon(path, square, 4);
    AUTO(narc_release_contours) narc_contours contours = flatten(path);
    assert_memory_equal(contours.points, square, sizeof square);
}

/* ---------------------------------------------------------------------------- contours */

TEST(closes_contours) {
    static const narc_point open[] = {{0, 0}, {2, 0}, {2, 2}}, closed[] = {{5, 5}, {6, 5}, {6, 6}, {5, 5}, {5, 5}};
    static const narc_point expected[] = {{0, 0}, {2, 0}, {2, 2}, {5, 5}, {6, 5}, {6, 6}, {7, 7}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    draw_polygon(path, (narc_point[]){{9, 9}}, 1); /* a contour that is only begun is not drawn */
    draw_polygon(path, open, 3);
    draw_polygon(path, (narc_point[]){{8, 8}}, 1);
    draw_polygon(path, closed, 5);
    draw_polygon(path, (narc_point[]){{7, 7}, {7, 7}}, 2); /* a line of no length is a point */
    draw_polygon(path, (narc_point[]){{4, 4}}, 1);
    narc_contours contours = flatten(path);
    assert_int_equal(contours.count, 3);
    assert_memory_equal(contours.ends, ((size_t[]){3, 6, 7}), 3 * sizeof(size_t));
    assert_int_equal(contours.point_count, 7);
    assert_memory_equal(contours.points, expected, sizeof expected);
    assert_true(contours.flatness == 0);
    narc_release_contours(&contours);
    assert_null(contours.points);
    assert_null(contours.ends);

    /* The pen goes on from the last contour. */
    expect_ok(narc_line_to(path, &(narc_point){1, 1}, &error), &error);
    contours = flatten(path);
    assert_int_equal(contours.count, 4);
    assert_int_equal(contours.point_count, 9);
    assert_true(contours.points[7].x == 4 && contours.points[8].x == 1);
    narc_release_contours(&contours);
}

/* Points that repeat the one before stay, so that polygons come out as they were drawn. */
TEST(keeps_repeated_points) {
    static const narc_point points[] = {{0, 0}, {0, 0}, {2, 0}, {2, 0}, {2, 2}, {1, 1}, {1, 1}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    draw_polygon(path, points, 7);
    AUTO(narc_release_contours) narc_contours contours = flatten(path);
    assert_int_equal(contours.point_count, 7);
    assert_memory_equal(contours.points, points, sizeof points);
}

/* A quarter of a slanted ellipse, a whole circle; the points of both fulfil their equations. */
TEST(draws_parts_of_ellipses) {
    static const narc_point center = {2, 3}, u = {4, 1}, v = {-1, 2}, start = {6, 4}, end = {1, 5};
    static const narc_point along = {3, 0}, up = {0, 3}, side = {5, 3}, left = {-7, 0};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    expect_error(narc_ellipse_to(path, &center, &u, &v, 0, 1, &end, &error), NARC_ERROR_ARGUMENT, &error, "no contour");
    expect_ok(narc_move_to(path, &start, &error), &error);
    expect_ok(narc_ellipse_to(path, &center, &u, &v, 0, PI / 2, &end, &error), &error);
    expect_ok(narc_move_to(path, &side, &error), &error);
    expect_ok(narc_ellipse_to(path, &center, &along, &up, 0, -2 * PI, &side, &error), &error);
    expect_error(narc_ellipse_to(path, &center, &u, &v, 0, 7, &end, &error), NARC_ERROR_ARGUMENT, &error, "a turn");
    expect_error(narc_ellipse_to(path, &center, &u, &v, 0, NAN, &end, &error), NARC_ERROR_ARGUMENT, &error, "a turn");
    expect_error(narc_ellipse_to(path, &center, NULL, &v, 0, 1, &end, &error), NARC_ERROR_ARGUMENT, &error, "NULL");
    expect_error(narc_ellipse_to(path, &center, &(narc_point){2e9, 0}, &v, 0, 1, &left, &error), NARC_ERROR_SIZE,
                 &error, "control point");
    AUTO(narc_release_contours) narc_contours contours;
    expect_ok(narc_flatten_path(path, 1e-4, &contours, &error), &error);
    assert_int_equal(contours.count, 2);
    assert_true(contours.ends[0] > 20 && contours.ends[1] > contours.ends[0] + 100);
    for (size_t k = 0; k < contours.point_count; k++) {
        const double x = contours.points[k].x - 2, y = contours.points[k].y - 3, s = (2 * x + y) / 9,
                     t = (4 * y - x) / 9;
        assert_true(fabs(k < contours.ends[0] ? hypot(s, t) - 1 : hypot(x, y) / 3 - 1) < 1e-10);
    }
    assert_memory_equal(&contours.points[contours.ends[0] - 1], &end, sizeof end);
}

TEST_MAIN("paths")
