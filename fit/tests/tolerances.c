/* SPDX-License-Identifier: MIT
 *
 * tolerances.c - tolerances that can't be kept are refused without the whole search: at once if that is known
 * beforehand, and otherwise after so many reports of progress.
 */
#include <math.h>

#include "outlines.h"

static bool count_report(size_t done, size_t total, void *context) {
    size_t *reports = context;
    (void)done, (void)total;
    ++*reports;
    return true;
}

/* Returns the distance that the error tells. */
static double refuse(const struct outline *of, narc_fit_request request, const char *words, size_t most_reports) {
    size_t reports = 0;
    request.progress = count_report;
    request.context = &reports;
    const narc_error error = refuse_fit(of->path, request, NARC_ERROR_NO_SOLUTION, words);
    if (!(reports <= most_reports))
        fail_msg("%s, tolerance %g: %zu reports, at most %zu", of->name, request.tolerance, reports, most_reports);
    assert_true(error.value > request.tolerance);
    return error.value;
}

TEST(test_less_than_single_precision) {
    struct outline thin = make_box(100, 0.3), circle = make_regular("circle", 200, 0, 1);
    for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_PAPER; family++) {
        const bool has_edges = family == NARC_FIT_EDGES || family == NARC_FIT_POLYGON;
        const narc_fit_request fine = {.tolerance = 1e-9, .family = (narc_fit_family)family};
        const narc_fit_request finer = {.tolerance = 1e-12, .family = (narc_fit_family)family};
        const double least = refuse(&thin, fine, has_edges ? "single precision" : "64 times", 0);
        refuse(&circle, finer, "tolerance 1e-12", 0);
        if (has_edges) /* coordinates of 50 are multiples of 2^-18, those of 100 of 2^-17 */
            assert_true(least >= 0x1p-19 && least <= 0x1p-18);
    }
    free_outline(&thin);
    free_outline(&circle);
}

TEST(test_less_than_flatness) {
    struct test_random random = test_random_named("flatness");
    struct outline blob = make_blob(&random, 4);
    for (int goal = NARC_FIT_BOUND_DISTANCE; goal <= NARC_FIT_DISTANCE; goal++) {
        const narc_fit_request request = {.tolerance = 0.005, .flatness = 0.01, .goal = (narc_fit_goal)goal};
        refuse(&blob, request, "chords", 0);
    }
    free_outline(&blob);
}

/* Around the square of side 2, at a distance t, radii are at most 64 (sqrt(2) + t). A side is a chord of such a circle
 * with a sagitta of at most t: 1 <= 2 * 64 (sqrt(2) + t) t. */
TEST(test_bulge_of_a_square) {
    struct outline square = make_box(2, 2);
    const double told = refuse(&square, (narc_fit_request){.tolerance = 1e-3}, "straight edges", 0);
    assert_true(128 * (sqrt(2) + told) * told <= 1 && told >= 0.0054);
    free_outline(&square);
}

/* What is told beforehand is less than what is found. */
TEST(test_bulge_is_a_lower_bound) {
    struct test_random random = test_random_named("bulges");
    for (size_t trial = 0, trials = test_trials(4); trial < trials; trial++) {
        struct outline of =
            trial % 2 ? make_random_points(&random, 4) : make_box(1, random_log_between(&random, 0.01, 1));
        const narc_fit_goal goal = trial / 2 % 2 ? NARC_FIT_BOUND_DISTANCE : NARC_FIT_DISTANCE;
        const double told = refuse(&of, (narc_fit_request){.tolerance = 1e-5, .goal = goal}, "straight edges", 0);
        const narc_fit_request found = {.arc_count = 7, .goal = goal, .starts = 2};
        assert_true(fit_outline(&of, found).max_distance >= told);
        free_outline(&of);
    }
}

/* The hull itself, but for roundings, has four arcs; a circle of 200 corners is too fine for 32. */
TEST(test_few_searches) {
    struct outline thin = make_box(100, 0.3), circle = make_regular("circle", 200, 0, 1);
    refuse(&thin, (narc_fit_request){.tolerance = 1e-5, .family = NARC_FIT_EDGES}, "up to 32 arcs come within", 1000);
    refuse(&circle, (narc_fit_request){.tolerance = 1e-6, .family = NARC_FIT_EDGES}, "up to 32 arcs come within", 20);
    free_outline(&thin);
    free_outline(&circle);
}

TEST_MAIN("tolerances")
