/* SPDX-License-Identifier: MIT
 *
 * results.c - fits: every field of the result against the reference, what bounds bounds after the store's rounding,
 * numbers of arcs, errors, progress, and equal bits for equal input. How good fits are: see optima.c.
 */
#include <math.h>
#include <string.h>

#include "outlines.h"

static void check(const struct outline *of, narc_fit_family family, narc_fit_goal goal, size_t arcs) {
    const narc_fit_request request = {.arc_count = arcs, .family = family, .goal = goal, .starts = 1};
    const narc_fit_result fit = fit_outline(of, request);
    check_fit_result(of, &request, &fit);
}

/* All goals of a family. */
static void check_goals(const struct outline *of, narc_fit_family family, size_t arcs) {
    const int last = family == NARC_FIT_PAPER ? NARC_FIT_BOUND_AREA : NARC_FIT_DIFFERENCE;
    for (int goal = NARC_FIT_BOUND_AREA; goal <= last; goal++)
        check(of, family, (narc_fit_goal)goal, arcs);
}

static void check_families(const struct outline *of, size_t arcs) {
    for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_PAPER; family++)
        if (arcs >= 3 || family == NARC_FIT_N_ARC || family == NARC_FIT_EDGES)
            check_goals(of, (narc_fit_family)family, arcs);
}

TEST(test_fields) {
    struct test_random random = test_random_named("fields");
    struct outline outlines[] = {make_regular("triangle", 3, 0.3, 1), make_box(3, 1),
                                 make_regular("ellipse", 24, 0, 0.5), make_star(), make_blob(&random, 5)};
    for (size_t k = 0; k < sizeof outlines / sizeof *outlines; k++) {
        check_families(&outlines[k], 5);
        free_outline(&outlines[k]);
    }
}

TEST(test_random_outlines) {
    struct test_random random = test_random_named("outlines");
    for (size_t trial = 0, trials = test_trials(30); trial < trials; trial++) {
        struct outline of = random_below(&random, 2) ? make_random_points(&random, 3 + random_below(&random, 30))
                                                     : make_blob(&random, 1 + random_below(&random, 6));
        const narc_fit_family family = (narc_fit_family)random_below(&random, 4);
        const narc_fit_goal goal =
            family == NARC_FIT_PAPER ? NARC_FIT_BOUND_AREA : (narc_fit_goal)random_below(&random, 5);
        check(&of, family, goal, 3 + random_below(&random, 8));
        free_outline(&of);
    }
}

/* Every count, each family and goal in turn; of the large counts, which take seconds, some unless there is more
 * time. */
TEST(test_counts) {
    struct outline of = make_regular("pentagon", 5, 0.1, 0.8);
    for (size_t arcs = 1; arcs <= NARC_MAX_FIT_ARCS; arcs++) {
        if (arcs > 12 && arcs % 5 != 2 && test_trials(1) == 1)
            continue;
        const narc_fit_family family = arcs < 3 ? (narc_fit_family)(arcs % 2) : (narc_fit_family)(arcs % 4);
        check(&of, family, family == NARC_FIT_PAPER ? NARC_FIT_BOUND_AREA : (narc_fit_goal)(arcs % 5), arcs);
    }
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- tolerance */

static void check_tolerance(const struct outline *of, narc_fit_family family, narc_fit_goal goal, double tolerance) {
    narc_fit_request request = {.tolerance = tolerance, .family = family, .goal = goal, .starts = 3};
    const narc_fit_result fit = fit_outline(of, request);
    assert_true(fit.max_distance <= tolerance);
    assert_true(goal > NARC_FIT_BOUND_DISTANCE || fit.clearance >= 0);
    if (goal <= NARC_FIT_BOUND_DISTANCE)
        check_contained(of, &fit, "with a tolerance");
    if (fit.arc_count <= 4)
        return; /* a circle, or a polygon's least */
    /* One less does not do: the same search, for the least distance. */
    request.arc_count = fit.arc_count - 1;
    request.goal = goal <= NARC_FIT_BOUND_DISTANCE ? NARC_FIT_BOUND_DISTANCE : NARC_FIT_DISTANCE;
    request.flatness = fit.flatness;
    narc_fit_result less;
    if (narc_fit_path(of->path, &request, &less, NULL) == NARC_OK &&
        less.max_distance <= tolerance - 2 * fit.flatness) {
        fail_msg("%s, family %d, goal %d: %zu arcs told, but %zu come within %g of %g", of->name, (int)family,
                 (int)goal, fit.arc_count, less.arc_count, less.max_distance, tolerance);
    }
}

TEST(test_tolerances) {
    struct test_random random = test_random_named("tolerances");
    struct outline outlines[] = {make_box(2, 1), make_regular("ellipse", 20, 0, 0.5), make_blob(&random, 3)};
    for (size_t k = 0; k < sizeof outlines / sizeof *outlines; k++) {
        for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_POLYGON; family++) {
            check_tolerance(&outlines[k], (narc_fit_family)family, NARC_FIT_BOUND_AREA, 0.08);
            check_tolerance(&outlines[k], (narc_fit_family)family, NARC_FIT_DISTANCE, 0.05);
        }
        free_outline(&outlines[k]);
    }
    struct outline circle = make_regular("many corners", 200, 0, 1);
    const narc_fit_request polygon = {.tolerance = 1e-4, .family = NARC_FIT_POLYGON, .starts = 1};
    narc_fit_result fit;
    narc_error error = {0};
    /* A polygon of 32 sides around a circle is off by 1 / cos(pi / 32) - 1 = 0.0048 at its corners. */
    const narc_status status = narc_fit_path(circle.path, &polygon, &fit, &error);
    expect_error(status, NARC_ERROR_NO_SOLUTION, &error, "tolerance");
    free_outline(&circle);
}

/* ---------------------------------------------------------------------------- errors */

TEST(test_errors) {
    struct outline good = make_box(2, 1);
    narc_fit_result fit;
    const narc_fit_request four = {.arc_count = 4};
    assert_int_equal(narc_fit_path(NULL, &four, &fit, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_fit_path(good.path, NULL, &fit, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_fit_path(good.path, &four, NULL, NULL), NARC_ERROR_ARGUMENT);
    const narc_path *path = good.path;
    assert_int_equal(narc_fit_path(path, &(narc_fit_request){.arc_count = 33}, &fit, NULL), NARC_ERROR_COUNT);
    refuse_fit(path, (narc_fit_request){.arc_count = 4, .family = (narc_fit_family)5}, NARC_ERROR_ARGUMENT, "family");
    refuse_fit(path, (narc_fit_request){.arc_count = 4, .family = (narc_fit_family)-1}, NARC_ERROR_ARGUMENT, "family");
    refuse_fit(path, (narc_fit_request){.arc_count = 4, .goal = (narc_fit_goal)5}, NARC_ERROR_ARGUMENT, "goal");
    for (int goal = NARC_FIT_BOUND_PERIMETER; goal <= NARC_FIT_DIFFERENCE; goal++) {
        refuse_fit(path, (narc_fit_request){.arc_count = 5, .family = NARC_FIT_PAPER, .goal = (narc_fit_goal)goal},
                   NARC_ERROR_ARGUMENT, "paper");
    }
    refuse_fit(path, (narc_fit_request){.arc_count = 33}, NARC_ERROR_COUNT, "33");
    refuse_fit(path, (narc_fit_request){.arc_count = 2, .family = NARC_FIT_POLYGON}, NARC_ERROR_COUNT, "2");
    refuse_fit(path, (narc_fit_request){.arc_count = 2, .family = NARC_FIT_PAPER}, NARC_ERROR_COUNT, "2");
    refuse_fit(path, (narc_fit_request){.tolerance = 0}, NARC_ERROR_SIZE, "tolerance");
    refuse_fit(path, (narc_fit_request){.tolerance = -1}, NARC_ERROR_SIZE, "tolerance");
    refuse_fit(path, (narc_fit_request){.tolerance = NAN}, NARC_ERROR_SIZE, "tolerance");
    refuse_fit(path, (narc_fit_request){.arc_count = 4, .flatness = -1}, NARC_ERROR_SIZE, "flatness");
    refuse_fit(path, (narc_fit_request){.arc_count = 4, .flatness = NAN}, NARC_ERROR_SIZE, "flatness");
    free_outline(&good);
}

TEST(test_bad_paths) {
    const narc_fit_request four = {.arc_count = 4};
    struct outline empty = make_outline("empty");
    refuse_fit(empty.path, four, NARC_ERROR_COUNT, "point");
    free_outline(&empty);
    const narc_point line[3] = {{0, 0}, {1, 2}, {2, 4}}, point[2] = {{3, 3}, {3, 3}};
    struct outline flat = make_outline("line"), spot = make_outline("point");
    add_corners(&flat, line, 3);
    add_corners(&spot, point, 2);
    refuse_fit(flat.path, four, NARC_ERROR_NOT_CONVEX, "line");
    refuse_fit(spot.path, four, NARC_ERROR_NOT_CONVEX, "");
    free_outline(&flat);
    free_outline(&spot);
    const double sizes[2] = {1e-12, 9e8};
    for (int k = 0; k < 2; k++) {
        const narc_point box[3] = {{0, 0}, {sizes[k], 0}, {0, sizes[k]}};
        struct outline odd = make_outline("size");
        add_corners(&odd, box, 3);
        refuse_fit(odd.path, four, NARC_ERROR_SIZE, "");
        free_outline(&odd);
    }
}

/* ---------------------------------------------------------------------------- progress */

struct watch {
    size_t calls, most, last_done, last_total;
    bool in_order;
};

static bool look(size_t done, size_t total, void *context) {
    struct watch *watch = context;
    watch->in_order = watch->in_order && done >= watch->last_done && done <= total;
    watch->last_done = done;
    watch->last_total = total;
    return ++watch->calls < watch->most;
}

TEST(test_progress) {
    struct outline of = make_regular("ellipse", 16, 0, 0.5);
    struct watch all = {.most = SIZE_MAX, .in_order = true};
    narc_fit_request request = {.arc_count = 5, .starts = 4, .progress = look, .context = &all};
    const narc_fit_result whole = fit_outline(&of, request);
    assert_true(all.calls > 1);
    assert_true(all.in_order);
    assert_true(all.last_total > 0);
    /* Ended after each number of calls, of many some: cancelled, or the best so far, which bounds. */
    size_t cancelled = 0, ended = 0;
    for (size_t most = 1; most < all.calls; most += 1 + most / 8) {
        struct watch some = {.most = most, .in_order = true};
        request.context = &some;
        narc_fit_result fit;
        narc_error error = {0};
        const narc_status status = narc_fit_path(of.path, &request, &fit, &error);
        assert_int_equal(some.calls, most);
        if (status != NARC_OK) {
            assert_int_equal(status, NARC_ERROR_CANCELLED);
            cancelled++;
        } else {
            ended++;
            assert_true(fit.area >= whole.area * (1 - 1e-6));
            check_contained(&of, &fit, "ended");
        }
    }
    assert_true(ended > 0);
    free_outline(&of);
}

TEST(test_same_bits) {
    struct outline of = make_star();
    for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_PAPER; family++) {
        narc_fit_result a, b;
        memset(&a, 0, sizeof a);
        memset(&b, 0, sizeof b);
        const narc_fit_request request = {.arc_count = 6, .family = (narc_fit_family)family, .starts = 3};
        assert_int_equal(narc_fit_path(of.path, &request, &a, NULL), NARC_OK);
        assert_int_equal(narc_fit_path(of.path, &request, &b, NULL), NARC_OK);
        assert_int_equal(a.arc_count, b.arc_count);
        assert_memory_equal(a.arcs, b.arcs, a.arc_count * sizeof *a.arcs);
        assert_memory_equal(&a.origin, &b.origin, sizeof a.origin);
        assert_true(a.area == b.area && a.perimeter == b.perimeter && a.clearance == b.clearance);
        assert_true(a.max_distance == b.max_distance && a.mean_distance == b.mean_distance);
        assert_true(a.difference_area == b.difference_area);
    }
    free_outline(&of);
}

TEST_MAIN("results")
