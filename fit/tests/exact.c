/* SPDX-License-Identifier: MIT
 *
 * exact.c - exact cuts: parts are convex, hold what the outline holds, each point once, and are few.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "outlines.h"

static const double PI_ = 3.14159265358979323846;

typedef struct cuts {
    narc_fit_result parts[NARC_MAX_PARTS];
    size_t count;
} cuts;

static cuts *cut(const narc_path *path) {
    cuts *of = malloc(sizeof *of);
    narc_error error;
    expect_ok(narc_cut_exactly(path, of->parts, NARC_MAX_PARTS, &of->count, &error), &error);
    return of;
}

/* By how much a point is inside a part: the least over all directions of support function less its projection, of edges
 * and arcs by themselves; below 0 outside. */
static double find_depth(const narc_fit_result *part, narc_point p) {
    const narc_point q = {p.x - part->origin.x, p.y - part->origin.y};
    double least = INFINITY;
    for (size_t k = 0; k < part->arc_count; k++) {
        const narc_arc *a = &part->arcs[k];
        double from = a->start, to = a->end, way = atan2(q.y - a->center_y, q.x - a->center_x);
        while (to < from)
            to += 2 * PI_;
        while (way < from)
            way += 2 * PI_;
        const double angles[] = {from, to, way};
        for (int i = 0; i < (way <= to ? 3 : 2); i++) {
            const double c = cos(angles[i]), s = sin(angles[i]);
            least = fmin(least, a->radius - c * (q.x - a->center_x) - s * (q.y - a->center_y));
        }
    }
    return least;
}

/* The area, and at random points: in one part inside, in none outside, but near lines. */
static void check_cuts(const cuts *of, const narc_path *path, double area, double size) {
    struct test_random random = test_random_named("points");
    AUTO(narc_release_contours) narc_contours flat;
    narc_error error;
    narc_shapes *store = NULL;
    double sum = 0;
    assert_int_equal(narc_create_shapes(NULL, &store), NARC_OK);
    for (size_t k = 0; k < of->count; k++) {
        narc_mass mass;
        expect_ok(narc_add_shape(store, of->parts[k].arcs, of->parts[k].arc_count, NULL, &error), &error);
        narc_compute_mass(of->parts[k].arcs, of->parts[k].arc_count, &mass);
        sum += mass.area;
        assert_true(fabs(mass.area - of->parts[k].area) <= 1e-6 * size * size);
    }
    narc_destroy_shapes(store);
    if (!(fabs(sum - area) <= 1e-6 * size * size))
        fail_msg("area %.9g, parts have %.9g", area, sum);
    expect_ok(narc_flatten_path(path, 1e-6 * size, &flat, &error), &error);
    for (int trial = 0; trial < 300; trial++) {
        const narc_point p = {random_between(&random, -size, size), random_between(&random, -size, size)};
        int inside = 0, near = 0;
        for (size_t k = 0; k < of->count; k++) {
            const double depth = find_depth(&of->parts[k], p);
            inside += depth > 1e-5 * size;
            near += fabs(depth) <= 1e-5 * size;
        }
        if (near == 0)
            assert_int_equal(inside, is_inside(&flat, p));
    }
}

static double measure_path(const narc_path *path, double size) {
    AUTO(narc_release_contours) narc_contours flat;
    double area = 0;
    assert_int_equal(narc_flatten_path(path, 1e-8 * size, &flat, NULL), NARC_OK);
    for (size_t k = 0; k < flat.count; k++) {
        const narc_point p = flat.points[k ? flat.ends[k - 1] : 0];
        int around = 0;
        for (size_t i = 0; i < flat.count; i++) {
            const size_t begin = i ? flat.ends[i - 1] : 0;
            size_t end = flat.ends[i] - begin;
            const narc_contours one = {flat.points + begin, end, &end, 1, 0};
            around += i != k && is_inside(&one, p);
        }
        area += around % 2 ? -fabs(measure_area(&flat, k)) : fabs(measure_area(&flat, k));
    }
    return area;
}

static void expect_cuts(const narc_path *path, size_t count, double size) {
    AUTO(free_at) cuts *of = cut(path);
    assert_int_equal(of->count, count);
    check_cuts(of, path, measure_path(path, size), size);
}

static void expect_polygon(const narc_point *points, size_t count, size_t parts) {
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    draw_polygon(path, points, count);
    expect_cuts(path, parts, 10);
}

TEST(an_l_is_two_boxes) {
    const narc_point l[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_arc box[NARC_MAX_ARCS];
    size_t count;
    draw_polygon(path, l, 6);
    AUTO(free_at) cuts *of = cut(path);
    assert_int_equal(of->count, 2);
    for (size_t k = 0; k < 2; k++) {
        assert_int_equal(narc_build_box(of->parts[k].area, 1, 0, box, &count, NULL), NARC_OK);
        assert_memory_equal(of->parts[k].arcs, box, sizeof *box * 4);
    }
    assert_true(of->parts[0].area + of->parts[1].area == 3);
    expect_polygon(l, 6, 2);
}

TEST(cuts_serve_two_corners) {
    const narc_point plus[] = {{1, 0}, {2, 0}, {2, 1}, {3, 1}, {3, 2}, {2, 2},
                               {2, 3}, {1, 3}, {1, 2}, {0, 2}, {0, 1}, {1, 1}};
    const narc_point tee[] = {{0, 0}, {3, 0}, {3, 1}, {2, 1}, {2, 4}, {1, 4}, {1, 1}, {0, 1}};
    const narc_point hourglass[] = {{-2, -2}, {2, -2}, {0.5, 0}, {2, 2}, {-2, 2}, {-0.5, 0}};
    const narc_point star[] = {{0, 3}, {-1, 1}, {-3, 0}, {-1, -1}, {0, -3}, {1, -1}, {3, 0}, {1, 1}};
    expect_polygon(plus, 12, 3);
    expect_polygon(tee, 8, 2);
    expect_polygon(hourglass, 6, 2);
    expect_polygon(star, 8, 3);
}

TEST(holes) {
    const narc_point outer[] = {{0, 0}, {6, 0}, {6, 6}, {0, 6}}, inner[] = {{2, 2}, {4, 2}, {4, 4}, {2, 4}};
    const narc_point island[] = {{2.5, 2.5}, {2.5, 3.5}, {3.5, 3.5}, {3.5, 2.5}}, far[] = {{7, 7}, {8, 7}, {7, 8}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    draw_polygon(path, outer, 4);
    draw_polygon(path, inner, 4);
    expect_cuts(path, 4, 10);
    draw_polygon(path, island, 4);
    draw_polygon(path, far, 3);
    expect_cuts(path, 6, 10);
}

/* A half disc with a slot, drawn either way round, and one with a square hole. */
TEST(arcs_stay) {
    for (int way = 0; way < 2; way++) {
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        const narc_point left = {-4, 0}, top = {0, 4}, right = {4, 0};
        const narc_point slot[] = {{1, 0}, {1, 3}, {-1, 3}, {-1, 0}}, square[] = {{-3, 1}, {-2, 1}, {-2, 2}, {-3, 2}};
        assert_int_equal(narc_move_to(path, way ? &left : &right, NULL), NARC_OK);
        assert_int_equal(narc_arc_to(path, &top, way ? &right : &left, NULL), NARC_OK);
        for (int k = 0; k < 4; k++)
            assert_int_equal(narc_line_to(path, &slot[way ? k : 3 - k], NULL), NARC_OK);
        cuts *of = cut(path);
        assert_int_equal(of->count, 3);
        for (size_t k = 0; k < of->count; k++) {
            size_t round = 0;
            for (size_t i = 0; i < of->parts[k].arc_count; i++)
                round += of->parts[k].arcs[i].radius == 4;
            assert_int_equal(round, 1);
        }
        free(of);
        expect_cuts(path, 3, 5);
        draw_polygon(path, square, 4);
        of = cut(path);
        check_cuts(of, path, measure_path(path, 5), 5);
        assert_true(of->count <= 6);
        free(of);
    }
}

/* Stars of any form, with holes: as many parts at most as corners that turn inwards, less holes, and one. */
TEST(random_stars) {
    struct test_random random = test_random_named("stars");
    for (size_t trial = 0, trials = test_trials(200); trial < trials; trial++) {
        const size_t corners = 3 + random_below(&random, 40), holes = random_below(&random, 3);
        narc_point points[64];
        AUTO(narc_destroy_path_at) narc_path *path = make_path();
        size_t inwards = 0;
        for (size_t k = 0; k < corners; k++) {
            const double angle = 2 * PI_ * ((double)k + random_between(&random, 0, 0.9)) / (double)corners;
            const double far = random_between(&random, 2, 4);
            points[k] = (narc_point){far * cos(angle), far * sin(angle)};
        }
        for (size_t k = 0; k < corners; k++) {
            const narc_point a = points[(k + corners - 1) % corners], b = points[k], c = points[(k + 1) % corners];
            inwards += (b.x - a.x) * (c.y - b.y) - (b.y - a.y) * (c.x - b.x) < 0;
        }
        draw_polygon(path, points, corners);
        for (size_t k = 0; k < holes; k++) {
            const double x = k ? 0.2 : -0.2, turn = random_between(&random, 0, 2);
            for (int i = 0; i < 3; i++)
                points[i] = (narc_point){x + 0.1 * cos(turn + 2.1 * i), 0.1 * sin(turn + 2.1 * i)};
            draw_polygon(path, points, 3);
            inwards += 3;
        }
        AUTO(narc_release_contours) narc_contours flat = flatten(path);
        const bool inside = is_inside(&flat, (narc_point){0, 0});
        if (inside && corners > 7) { /* holes are within */
            AUTO(free_at) cuts *of = cut(path);
            if (of->count > inwards + 1 - holes)
                fail_msg("%zu parts of %zu corners that turn inwards, %zu holes", of->count, inwards, holes);
            assert_true(2 * (of->count + holes) >= inwards + 2);
            check_cuts(of, path, measure_path(path, 5), 5);
        }
    }
}

/* A part with more corners than a shape has becomes two. */
TEST(many_corners) {
    narc_point points[200];
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    for (int k = 0; k < 200; k++)
        points[k] = (narc_point){4 * cos(PI_ * k / 100), 4 * sin(PI_ * k / 100)};
    draw_polygon(path, points, 200);
    expect_cuts(path, 4, 5);
}

static void expect_refused(narc_path *path, narc_status status, size_t index, double value, const char *words) {
    narc_fit_result part;
    narc_error error;
    size_t count = 77;
    expect_error(narc_cut_exactly(path, &part, 1, &count, &error), status, &error, words);
    assert_int_equal(error.index, index);
    assert_true(error.value == value);
    narc_destroy_path(path);
}

TEST(what_is_refused) {
    const narc_point square[] = {{0, 0}, {4, 0}, {4, 4}, {0, 4}}, middle = {2, 1},
                     bow[] = {{0, 0}, {4, 4}, {4, 0}, {0, 4}};
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    expect_refused(path, NARC_ERROR_COUNT, 0, 0, "no points");
    path = make_path();
    draw_polygon(path, square, 4);
    assert_int_equal(narc_move_to(path, &(narc_point){10, 0}, NULL), NARC_OK);
    assert_int_equal(narc_line_to(path, &(narc_point){10, 5}, NULL), NARC_OK);
    assert_int_equal(narc_arc_to(path, &(narc_point){11, 3}, &(narc_point){15, 0}, NULL), NARC_OK);
    expect_refused(path, NARC_ERROR_NO_SOLUTION, 1, 1, "contour 1, piece 1 is a concave arc");
    path = make_path();
    assert_int_equal(narc_move_to(path, &square[0], NULL), NARC_OK);
    assert_int_equal(narc_quadratic_to(path, &middle, &square[1], NULL), NARC_OK);
    assert_int_equal(narc_line_to(path, &square[2], NULL), NARC_OK);
    expect_refused(path, NARC_ERROR_NO_SOLUTION, 0, 0, "piece 0 is a curve");
    path = make_path();
    draw_polygon(path, bow, 4);
    expect_refused(path, NARC_ERROR_NOT_SIMPLE, 0, 0, "crosses or touches contour 0 at 2, 2");
    path = make_path();
    const narc_point l[] = {{0, 0}, {2, 0}, {2, 1}, {1, 1}, {1, 2}, {0, 2}};
    draw_polygon(path, l, 6);
    narc_fit_result part;
    size_t count;
    narc_error error;
    expect_error(narc_cut_exactly(path, &part, 1, &count, &error), NARC_ERROR_CAPACITY, &error, "2 convex parts");
    assert_int_equal(count, 2);
}

TEST_MAIN("exact cuts")
