/* SPDX-License-Identifier: MIT
 *
 * plain.c - plain shapes are seen, with the numbers they were drawn with, and none where there is none.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "outlines.h"

/* Within the tolerance, and around the outline if it bounds, by the reference. */
static void check_plain(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit) {
    AUTO(free_at) struct reference_hull hull = reference_wrap(of->points, of->count, fit->origin);
    const struct reference_range range = reference_compare(fit->arcs, fit->arc_count, &hull);
    const real slack = 1e-9L * hull.radius;
    assert_true(range.largest <= request->tolerance + slack && range.least >= -request->tolerance - slack);
    assert_true(request->goal > NARC_FIT_BOUND_DISTANCE || (range.least >= 0 && fit->clearance > 0));
}

static narc_fit_result see(const struct outline *of, double tolerance, narc_fit_goal goal) {
    const narc_fit_request request = {.tolerance = tolerance, .goal = goal, .family = NARC_FIT_PLAIN};
    const narc_fit_result fit = fit_outline(of, request);
    check_plain(of, &request, &fit);
    return fit;
}

static void expect_arcs(const narc_fit_result *fit, const narc_arc *arcs, size_t count, double slack) {
    assert_int_equal(fit->arc_count, count);
    for (size_t k = 0; k < count; k++) {
        assert_true(fabs(fit->arcs[k].center_x - arcs[k].center_x) <= slack);
        assert_true(fabs(fit->arcs[k].center_y - arcs[k].center_y) <= slack);
        assert_true(fabs(fit->arcs[k].radius - arcs[k].radius) <= slack);
        assert_true(fit->arcs[k].start == arcs[k].start && fit->arcs[k].end == arcs[k].end);
    }
}

/* What is drawn with numbers of single precision has them again where it need not bound. */
static void check_both(const struct outline *of, const narc_arc *arcs, size_t count, double size) {
    narc_fit_result fit = see(of, 0.001 * size, NARC_FIT_DISTANCE);
    expect_arcs(&fit, arcs, count, 0);
    fit = see(of, 0.001 * size, NARC_FIT_BOUND_AREA);
    expect_arcs(&fit, arcs, count, 2e-6 * size);
}

static void draw_round_box(struct outline *to, double x, double y, double r, narc_point at, int steps) {
    const narc_point center[] = {{x - r, y - r}, {r - x, y - r}, {r - x, r - y}, {x - r, r - y}};
    for (int k = 0; k < 4; k++)
        for (int i = 0; i <= steps; i++) {
            const double angle = 1.5707963267948966 * (k + i / (double)steps);
            const narc_point p = {at.x + center[k].x + r * cos(angle), at.y + center[k].y + r * sin(angle)};
            to->points = realloc(to->points, (to->count + 1) * sizeof *to->points);
            to->points[to->count++] = p;
            assert_int_equal(k + i ? narc_line_to(to->path, &p, NULL) : narc_move_to(to->path, &p, NULL), NARC_OK);
        }
}

TEST(test_circle) {
    struct outline of = make_outline("circle");
    const narc_point sides[] = {{103, 50}, {100, 53}, {97, 50}, {100, 47}};
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_move_to(of.path, &sides[0], NULL), NARC_OK);
    assert_int_equal(narc_arc_to(of.path, &sides[1], &sides[2], NULL), NARC_OK);
    assert_int_equal(narc_arc_to(of.path, &sides[3], &sides[0], NULL), NARC_OK);
    of.points = malloc(sizeof sides);
    memcpy(of.points, sides, sizeof sides);
    of.count = 4;
    assert_int_equal(narc_build_circle(3, arcs, &count, NULL), NARC_OK);
    for (int goal = NARC_FIT_BOUND_AREA; goal <= NARC_FIT_DIFFERENCE; goal++) {
        const narc_fit_request request = {.tolerance = 0.01, .goal = (narc_fit_goal)goal, .family = NARC_FIT_PLAIN};
        const narc_fit_result fit = fit_outline(&of, request);
        expect_arcs(&fit, arcs, count, goal > NARC_FIT_BOUND_DISTANCE ? 0 : 5e-6);
        assert_true(fit.origin.x == 100 && fit.origin.y == 50);
    }
    free_outline(&of);
}

TEST(test_boxes_and_capsules) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    struct outline box = make_box(3, 1), tall = make_box(1, 3), capsule = make_outline("capsule");
    assert_int_equal(narc_build_box(3, 1, 0, arcs, &count, NULL), NARC_OK);
    check_both(&box, arcs, count, 3);
    assert_int_equal(narc_build_box(1, 3, 0, arcs, &count, NULL), NARC_OK);
    check_both(&tall, arcs, count, 3);
    draw_round_box(&capsule, 3, 1, 1, (narc_point){7, -5}, 40);
    assert_int_equal(narc_build_capsule(4, 1, arcs, &count, NULL), NARC_OK);
    check_both(&capsule, arcs, count, 3);
    struct outline fine = make_outline("capsule of many corners");
    draw_round_box(&fine, 3, 1, 1, (narc_point){7, -5}, 520);
    check_both(&fine, arcs, count, 3);
    free_outline(&fine);
    for (double radius = 0.125; radius < 1; radius *= 2) {
        struct outline round = make_outline("round box");
        draw_round_box(&round, 1, 2, radius, (narc_point){-7, 5}, 40);
        assert_int_equal(narc_build_box(2, 4, radius, arcs, &count, NULL), NARC_OK);
        check_both(&round, arcs, count, 2);
        free_outline(&round);
    }
    free_outline(&box);
    free_outline(&tall);
    free_outline(&capsule);
}

TEST(test_turned_and_regular) {
    struct test_random random = test_random_named("plain");
    for (size_t trial = 0, trials = test_trials(60); trial < trials; trial++) {
        const size_t sides = 3 + random_below(&random, 14);
        struct outline of = sides == 4   ? make_box(random_between(&random, 0.2, 5), 1)
                            : sides > 14 ? make_stadium(random_between(&random, 1, 5), 60)
                                         : make_regular("regular", sides, random_between(&random, 0, 7), 1);
        const double scale = exp(random_between(&random, -3, 3)), tolerance = (sides > 14 ? 1e-3 : 1e-5) * scale;
        struct outline moved = make_moved(&of, scale, random_between(&random, -4, 4), trial & 1,
                                          (narc_point){scale * random_between(&random, -9, 9), scale});
        narc_fit_result fit = see(&moved, tolerance, trial & 2 ? NARC_FIT_DISTANCE : NARC_FIT_BOUND_AREA);
        assert_int_equal(fit.arc_count, sides > 14 ? 2 : sides);
        free_outline(&of);
        free_outline(&moved);
    }
}

/* A rough outline is a plain shape within the tolerance, for any goal. */
TEST(test_rough) {
    struct test_random random = test_random_named("rough");
    for (size_t trial = 0, trials = test_trials(100); trial < trials; trial++) {
        struct outline of = make_outline("rough"), clean = make_outline("clean");
        draw_round_box(&clean, random_between(&random, 1, 3), 1, random_between(&random, 0.01, 1), (narc_point){0, 0},
                       40);
        for (size_t k = 0; k < clean.count; k++) {
            clean.points[k].x += random_between(&random, -0.005, 0.005);
            clean.points[k].y += random_between(&random, -0.005, 0.005);
        }
        add_corners(&of, clean.points, clean.count);
        const narc_fit_result fit = see(&of, 0.05, trial & 1 ? NARC_FIT_DISTANCE : NARC_FIT_BOUND_AREA);
        assert_true(fit.arc_count <= 4);
        free_outline(&of);
        free_outline(&clean);
    }
}

TEST(test_none) {
    struct outline star = make_star(), lens = make_regular("lens", 40, 0, 0.5), box = make_box(2, 1);
    const narc_fit_request request = {.tolerance = 0.01, .family = NARC_FIT_PLAIN};
    refuse_fit(star.path, request, NARC_ERROR_NO_SOLUTION, "within 0.01");
    refuse_fit(lens.path, request, NARC_ERROR_NO_SOLUTION, "within 0.01");
    refuse_fit(box.path, (narc_fit_request){.tolerance = 0.01, .family = NARC_FIT_PLAIN, .min_radius = 0.1},
               NARC_ERROR_NO_SOLUTION, "within 0.01");
    refuse_fit(box.path, (narc_fit_request){.arc_count = 4, .family = NARC_FIT_PLAIN}, NARC_ERROR_ARGUMENT, "4 arcs");
    free_outline(&star);
    free_outline(&lens);
    free_outline(&box);
}

TEST(test_the_input_s_coordinates) {
    struct outline box = make_box(2, 1);
    struct outline moved = make_moved(&box, 1, 0, false, (narc_point){100, 50});
    const narc_fit_request request = {
        .tolerance = 0.01, .family = NARC_FIT_PLAIN, .goal = NARC_FIT_DISTANCE, .keep_origin = true};
    const narc_fit_result fit = fit_outline(&moved, request);
    assert_true(fit.origin.x == 0 && fit.origin.y == 0);
    check_plain(&moved, &request, &fit);
    free_outline(&box);
    free_outline(&moved);
}

TEST_MAIN("plain shapes")
