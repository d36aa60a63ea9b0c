/* SPDX-License-Identifier: MIT
 *
 * optima.c - how good fits are: known optima, a search by brute force, order among counts, families and goals,
 * and what must not matter.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "outlines.h"

/* Where the optimum is a corner of what is allowed, the search reaches it but for its last steps' gains (1e-7 of the
 * value), the certificate for single precision (some 2^-22 of the size) and the largest radius allowed, 64 times the
 * size, which bends what would be straight. */
static const double CLOSE = 1e-5;

/* Elsewhere the search may end near the optimum: fit/README.md says how near, for few arcs. */
static const double NEAR = 2e-3;

static void expect_within(const char *what, double told, double known, double part) {
    printf("%-44s %.9g, known %.9g, %+.2g\n", what, told, known, told / known - 1);
    if (!(told <= known * (1 + part)))
        fail_msg("%s: %.9g, but %.9g is known, %+.3g", what, told, known, told / known - 1);
}

static void expect_least(const char *what, double told, double known) { expect_within(what, told, known, CLOSE); }

static void expect_exact(const char *what, double told, double known) {
    expect_least(what, told, known);
    assert_true(told >= known * (1 - 1e-9));
}

/* ---------------------------------------------------------------------------- known optima */

TEST(test_hulls) {
    /* With as many edges as the hull has, the hull itself. */
    struct outline of[] = {make_box(1, 1), make_box(7, 2), make_regular("triangle", 3, 0.2, 1),
                           make_regular("hexagon", 6, 0.2, 0.7)};
    const size_t sides[] = {4, 4, 3, 6};
    for (size_t k = 0; k < 4; k++) {
        for (int family = NARC_FIT_EDGES; family <= NARC_FIT_POLYGON; family++) {
            narc_fit_result fit = fit_shape(&of[k], (narc_fit_family)family, NARC_FIT_BOUND_AREA, sides[k]);
            expect_exact("hull by area", fit.area, fit.hull_area);
            assert_int_equal(fit.edge_count, sides[k]);
            fit = fit_shape(&of[k], (narc_fit_family)family, NARC_FIT_BOUND_PERIMETER, sides[k]);
            expect_exact("hull by perimeter", fit.perimeter, fit.hull_perimeter);
            fit = fit_shape(&of[k], (narc_fit_family)family, NARC_FIT_BOUND_DISTANCE, sides[k]);
            assert_true(fit.max_distance <= CLOSE * fit.hull_perimeter);
        }
        free_outline(&of[k]);
    }
}

TEST(test_polygons) {
    /* Every k-gon around a circle of radius s has an area of k tan(pi / k) s^2 or more. A regular m k-gon holds its
     * inscribed circle, and every m-th of its sides make a regular k-gon around it: this is the optimum. */
    for (size_t k = 3; k <= 6; k++) {
        for (size_t m = 2; m <= 3; m++) {
            struct outline of = make_regular("regular", m * k, 0.1, 1);
            const double inscribed = cos(PI / (double)(m * k));
            const narc_fit_result fit = fit_shape(&of, NARC_FIT_POLYGON, NARC_FIT_BOUND_AREA, k);
            char what[60];
            snprintf(what, sizeof what, "%zu-gon around a regular %zu-gon", k, m * k);
            expect_exact(what, fit.area, (double)k * tan(PI / (double)k) * inscribed * inscribed);
            free_outline(&of);
        }
    }
    /* The least triangle around a square has twice its area. */
    struct outline square = make_box(1, 1);
    expect_exact("triangle around a square", fit_shape(&square, NARC_FIT_POLYGON, NARC_FIT_BOUND_AREA, 3).area, 2);
    free_outline(&square);
}

TEST(test_circles) {
    struct test_random random = test_random_named("circles");
    for (size_t trial = 0, trials = test_trials(10); trial < trials; trial++) {
        struct outline of = make_random_points(&random, 3 + random_below(&random, 12));
        const double radius = reference_smallest_circle(of.points, of.count);
        for (size_t arcs = 1; arcs <= 3; arcs++) {
            for (int goal = NARC_FIT_BOUND_AREA; goal <= NARC_FIT_BOUND_PERIMETER; goal++) {
                const narc_fit_result fit = fit_shape(&of, NARC_FIT_N_ARC, (narc_fit_goal)goal, arcs);
                assert_int_equal(fit.arc_count, 1);
                assert_true(fabs(fit.arcs[0].end - fit.arcs[0].start - 2 * PI) <= 1e-12);
                if (!(fit.arcs[0].radius <= radius * (1 + CLOSE) && fit.arcs[0].radius >= radius * (1 - 1e-9)))
                    fail_msg("smallest circle: radius %.9g, known %.9g", fit.arcs[0].radius, radius);
            }
        }
        free_outline(&of);
    }
    struct outline round = make_regular("many corners", 360, 0, 1);
    for (size_t arcs = 1; arcs <= 4; arcs += 3) {
        const narc_fit_result fit = fit_shape(&round, NARC_FIT_N_ARC, NARC_FIT_BOUND_AREA, arcs);
        expect_least("circle", fit.area, PI);
    }
    free_outline(&round);
}

TEST(test_stadium) {
    struct outline of = make_stadium(4, 60);
    const double area = PI + 8, perimeter = 2 * PI + 8;
    for (size_t arcs = 2; arcs <= 4; arcs++) {
        const narc_fit_result fit = fit_shape(&of, NARC_FIT_EDGES, NARC_FIT_BOUND_AREA, arcs);
        expect_least("stadium by area", fit.area, area);
        assert_true(fit.area >= fit.hull_area);
        expect_least("stadium by perimeter", fit_shape(&of, NARC_FIT_EDGES, NARC_FIT_BOUND_PERIMETER, arcs).perimeter,
                     perimeter);
    }
    free_outline(&of);
}

TEST(test_reuleaux) {
    struct outline of = make_reuleaux(24);
    /* Three arcs and three corners. */
    expect_least("Reuleaux triangle by area", fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_AREA, 6).area,
                 (PI - sqrt(3)) / 2);
    expect_least("Reuleaux triangle by perimeter",
                 fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_PERIMETER, 6).perimeter, PI);
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- an ellipse by four arcs */

/* Four arcs, symmetric about both axes: the right one around (c, 0) with normals up to angle f, the upper around (0,
 * -d). They have a common tangent at angle f if c = s cos f and d = s sin f, s being the difference of the radii.
 * For given f and s, the radii are the least that hold the points. */
enum { AREA, PERIMETER, DISTANCE };

static double measure_four_arcs(const struct reference_hull *hull, int what, double f, double s) {
    enum { DIRECTIONS = 600 };
    const double c = s * cos(f), d = s * sin(f);
    double radius = 0, least = INFINITY;
    for (int k = 0; k <= DIRECTIONS; k++) {
        const double angle = PI / 2 * k / DIRECTIONS;
        const double center = angle <= f ? c * cos(angle) : s - d * sin(angle);
        const double needed = (double)reference_hull_support(hull, angle) - center;
        radius = fmax(radius, needed);
        least = fmin(least, needed);
    }
    const double other = radius + s, rest = PI / 2 - f;
    if (what == DISTANCE)
        return radius - least;
    /* Sectors of all four less the rhombus of the centres, which those of the upper and lower arc count twice. */
    return what == AREA ? 2 * (radius * radius * f + other * other * rest) - 2 * c * d
                        : 4 * (radius * f + other * rest);
}

/* The least on a grid, then on finer ones around it. */
static double find_four_arcs(const struct reference_hull *hull, int what) {
    double best = INFINITY, best_f = 0.8, best_s = 1.5, f_width = 0.7, s_width = 1.5;
    for (int round = 0; round < 7; round++) {
        const double middle_f = best_f, middle_s = best_s;
        for (int i = -15; i <= 15; i++) {
            for (int j = -15; j <= 15; j++) {
                const double f = middle_f + f_width * i / 15, s = middle_s + s_width * j / 15;
                const double value = f > 0 && f < PI / 2 && s >= 0 ? measure_four_arcs(hull, what, f, s) : INFINITY;
                if (value < best) {
                    best = value;
                    best_f = f;
                    best_s = s;
                }
            }
        }
        f_width /= 4;
        s_width /= 4;
    }
    return best;
}

TEST(test_four_arcs) {
    struct outline of = make_regular("ellipse", 48, PI / 48, 0.5);
    AUTO(free_at) struct reference_hull hull = reference_wrap(of.points, of.count, (narc_point){0, 0});
    const double best[3] = {find_four_arcs(&hull, AREA), find_four_arcs(&hull, PERIMETER),
                            find_four_arcs(&hull, DISTANCE)};
    expect_least("ellipse by 4 arcs, area", fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_AREA, 4).area, best[0]);
    expect_least("ellipse by 4 arcs, perimeter", fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_PERIMETER, 4).perimeter,
                 best[1]);
    expect_within("ellipse by 4 arcs, distance",
                  fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_DISTANCE, 4).max_distance, best[2], NEAR);
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- order */

enum { FIRST = 4, LAST = 5, FAMILIES = 3, GOALS = 5 };

/* All fits of an outline. */
struct fits {
    const char *name;
    narc_fit_result fit[FAMILIES][GOALS][LAST + 1];
    size_t failures;
};

/* What one fit reaches of a goal is no worse than what another does. */
static void expect_no_worse(struct fits *in, int goal, const char *what, size_t arcs, int family, double mine,
                            double theirs) {
    if (!(mine <= theirs * (1 + CLOSE) + 1e-6)) {
        print_error("%s, family %d, goal %d, %zu arcs: reaches %.9g, %s %.9g (%+.2g)\n", in->name, family, goal, arcs,
                    mine, what, theirs, mine / theirs - 1);
        in->failures++;
    }
}

static void compare_fits(struct fits *in, int family, int goal, size_t arcs) {
    const narc_fit_goal by = (narc_fit_goal)goal;
    const double mine = goal_value(&in->fit[family][goal][arcs], by);
    if (arcs > FIRST)
        expect_no_worse(in, goal, "one arc less", arcs, family, mine, goal_value(&in->fit[family][goal][arcs - 1], by));
    /* Fits for other goals: those that bound, or all. */
    for (int other = 0; other < (goal <= NARC_FIT_BOUND_DISTANCE ? 3 : GOALS); other++) {
        expect_no_worse(in, goal, "the fit for another goal", arcs, family, mine,
                        goal_value(&in->fit[family][other][arcs], by));
    }
    if (family == NARC_FIT_EDGES) {
        expect_no_worse(in, goal, "without edges", arcs, family, mine,
                        goal_value(&in->fit[NARC_FIT_N_ARC][goal][arcs], by));
        expect_no_worse(in, goal, "edges alone", arcs, family, mine,
                        goal_value(&in->fit[NARC_FIT_POLYGON][goal][arcs], by));
    }
}

static size_t check_order(const struct outline *of) {
    static struct fits all;
    all.name = of->name;
    all.failures = 0;
    for (size_t arcs = FIRST; arcs <= LAST; arcs++) {
        for (int family = 0; family < FAMILIES; family++)
            for (int goal = 0; goal < GOALS; goal++)
                all.fit[family][goal][arcs] = fit_shape(of, (narc_fit_family)family, (narc_fit_goal)goal, arcs);
        for (int family = 0; family < FAMILIES; family++)
            for (int goal = 0; goal < GOALS; goal++)
                compare_fits(&all, family, goal, arcs);
    }
    return all.failures;
}

TEST(test_order) {
    struct test_random random = test_random_named("order");
    struct outline of = make_regular("ellipse", 14, 0, 0.6);
    size_t failures = check_order(&of);
    free_outline(&of);
    for (size_t trial = 0, trials = test_trials(1); trial < trials; trial++) {
        of = make_random_points(&random, 9);
        failures += check_order(&of);
        free_outline(&of);
    }
    assert_int_equal(failures, 0);
}

/* More starts are never worse, not by rounding either, and 56 or more never worse than the usual number, 0. */
static void check_starts(const struct outline *of, narc_fit_request request) {
    static const unsigned numbers[] = {1, 3, 8, 30, 0, 56, 112, 170};
    double last = INFINITY;
    size_t last_arcs = NARC_MAX_ARCS;
    for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++) {
        request.starts = numbers[k];
        const bool usual = request.starts == 0;
        const narc_fit_result fit = fit_outline(of, request);
        const double value = goal_value(&fit, request.goal);
        const bool fewer = request.arc_count == 0 && fit.arc_count < last_arcs;
        if (!usual && !fewer && !(value <= last && (request.arc_count || fit.arc_count == last_arcs)))
            fail_msg("%s, goal %d, %u starts: %.17g with %zu arcs, but fewer reach %.17g with %zu", of->name,
                     (int)request.goal, request.starts, value, fit.arc_count, last, last_arcs);
        if (!usual || value < last) { /* less than 56 may be better or worse than the usual number */
            last = value;
            last_arcs = fit.arc_count;
        }
    }
}

TEST(test_starts) {
    struct test_random random = test_random_named("starts");
    for (size_t trial = 0; trial < test_trials(2); trial++) {
        struct outline of = make_random_points(&random, 12);
        check_starts(&of, (narc_fit_request){.arc_count = 6});
        check_starts(&of, (narc_fit_request){.arc_count = 4, .goal = NARC_FIT_DISTANCE, .family = NARC_FIT_POLYGON});
        free_outline(&of);
    }
    struct outline of = make_box(2, 1);
    check_starts(&of, (narc_fit_request){.arc_count = 4, .goal = NARC_FIT_BOUND_PERIMETER});
    check_starts(&of, (narc_fit_request){.tolerance = 0.1, .goal = NARC_FIT_BOUND_DISTANCE});
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- what must not matter */

/* Areas, by family, of the same outline elsewhere, in another size or turned: both near the optimum. */
static void check_moved(const struct outline *of, const narc_fit_result *fits, double scale, double angle, bool mirror,
                        narc_point by) {
    struct outline moved = make_moved(of, scale, angle, mirror, by);
    for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_POLYGON; family++) {
        const narc_fit_result b = fit_shape(&moved, (narc_fit_family)family, NARC_FIT_BOUND_AREA, 4);
        const double ratio = b.area / (scale * scale) / fits[family].area;
        if (!(fabs(ratio - 1) <= NEAR)) {
            fail_msg("%s, family %d: scaled by %g, turned by %g, mirrored %d, moved by %g: area times %.9g", of->name,
                     family, scale, angle, mirror, by.x, ratio);
        }
        check_contained(&moved, &b, "moved");
    }
    free_outline(&moved);
}

TEST(test_invariance) {
    struct test_random random = test_random_named("invariance");
    struct outline outlines[] = {make_regular("ellipse", 20, 0.1, 0.6), make_random_points(&random, 8)};
    for (size_t k = 0; k < 2; k++) {
        const struct outline *of = &outlines[k];
        narc_fit_result fits[NARC_FIT_POLYGON + 1];
        for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_POLYGON; family++)
            fits[family] = fit_shape(of, (narc_fit_family)family, NARC_FIT_BOUND_AREA, 4);
        check_moved(of, fits, 1, 1, false, (narc_point){0, 0});
        check_moved(of, fits, 1, -2.5, false, (narc_point){0, 0});
        check_moved(of, fits, 1, 0, true, (narc_point){0, 0});
        check_moved(of, fits, 1, 0, false, (narc_point){3, -8});
        /* There, coordinates are rounded to 2^-53 of 1e6 sizes. */
        check_moved(of, fits, 1, 0, false, (narc_point){1e6, -2e6});
        check_moved(of, fits, 1e-6, 0, false, (narc_point){0, 0});
        check_moved(of, fits, 1e6, 0, false, (narc_point){0, 0});
        free_outline(&outlines[k]);
    }
}

TEST_MAIN("optima")
