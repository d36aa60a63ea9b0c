/* SPDX-License-Identifier: MIT
 *
 * rounding.c - fits of outlines that are hard on numbers: points that coincide or lie in line but for roundings, tiny,
 * huge, far away and thin outlines. What is told is compared with sums over the outline's own points and the arcs' in
 * long double, which share nothing with the library.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "outlines.h"

/* ---------------------------------------------------------------------------- points that coincide */

/* The first corner comes again, off by two roundings. */
static struct outline make_closed_by_hand(void) {
    narc_point p[24];
    for (int k = 0; k < 24; k++)
        p[k] = (narc_point){cos(2 * PI * k / 23), sin(2 * PI * k / 23)};
    assert_true(p[23].y != p[0].y && fabs(p[23].y) < 1e-15);
    struct outline made = make_outline("closed by hand");
    add_corners(&made, p, 24);
    return made;
}

TEST(test_closed_by_hand) {
    struct outline of = make_closed_by_hand();
    for (int family = NARC_FIT_N_ARC; family <= NARC_FIT_PAPER; family++) {
        const int last = family == NARC_FIT_PAPER ? NARC_FIT_BOUND_AREA : NARC_FIT_DIFFERENCE;
        for (int goal = NARC_FIT_BOUND_AREA; goal <= last; goal += (int)stride(2)) {
            fit_and_check(&of, (narc_fit_request){.arc_count = 4 + 2 * (size_t)(goal % 2),
                                                  .family = (narc_fit_family)family,
                                                  .goal = (narc_fit_goal)goal,
                                                  .starts = 1});
        }
    }
    const narc_fit_result circle = fit_shape(&of, NARC_FIT_N_ARC, NARC_FIT_BOUND_AREA, 4);
    assert_true(circle.area <= PI * (1 + 1e-6));
    fit_and_check(&of, (narc_fit_request){.tolerance = 0.01, .starts = 1});
    free_outline(&of);
}

/* A path in relative coordinates with two decimals, closed by hand and once more by the pen: the sum of the steps is 0
 * but for roundings. */
static struct outline make_steps(struct test_random *random) {
    const size_t count = 5 + random_below(random, 20);
    narc_point p[32], at = {random_between(random, -100, 100), random_between(random, -100, 100)};
    for (size_t k = 0; k < count; k++) {
        const double angle = 2 * PI * (double)k / (double)count, radius = random_between(random, 3, 5);
        const narc_point to = {radius * cos(angle), radius * sin(angle)};
        p[k] = (narc_point){round(100 * to.x) / 100, round(100 * to.y) / 100};
    }
    struct outline made = make_outline("relative steps");
    narc_point corners[32];
    for (size_t k = 0; k <= count; k++) {
        corners[k] = at;
        const narc_point here = p[k % count], next = p[(k + 1) % count];
        at = (narc_point){at.x + (round(100 * (next.x - here.x)) / 100), at.y + (round(100 * (next.y - here.y)) / 100)};
    }
    add_corners(&made, corners, count + 1);
    return made;
}

TEST(test_relative_steps) {
    struct test_random random = test_random_named("relative steps");
    for (size_t trial = 0, trials = test_trials(20); trial < trials; trial++) {
        struct outline of = make_steps(&random);
        fit_and_check(&of, (narc_fit_request){.arc_count = 3 + random_below(&random, 4), .starts = 1});
        free_outline(&of);
    }
}

/* ---------------------------------------------------------------------------- random outlines */

static double step_ulps(double x, size_t steps, bool up) {
    for (size_t k = 0; k < steps; k++)
        x = nextafter(x, up ? INFINITY : -INFINITY);
    return x;
}

/* A point by another: the same, some roundings off, or up to 1e-9 of the size off. */
static narc_point double_point(struct test_random *random, narc_point p, double size) {
    const double off = size * random_log_between(random, 1e-16, 1e-9);
    const size_t steps = random_below(random, 2) ? 1 + random_below(random, 3) : random_below(random, 1000);
    switch (random_below(random, 3)) {
    case 0:
        return p;
    case 1:
        return (narc_point){step_ulps(p.x, random_below(random, steps + 1), random_below(random, 2)),
                            step_ulps(p.y, random_below(random, steps + 1), random_below(random, 2))};
    default:
        return (narc_point){p.x + random_between(random, -off, off), p.y + random_between(random, -off, off)};
    }
}

/* Corners on an ellipse, doubled here and there, and others on the sides between them, in line or nearly. */
static struct outline make_hard(struct test_random *random) {
    const size_t count = 3 + random_below(random, 8);
    const double size = random_log_between(random, 1e-6, 1e6), squeeze = random_log_between(random, 0.01, 1);
    const double away = random_below(random, 3) ? 0 : fmin(5e8, size * random_log_between(random, 1, 1e7));
    const narc_point middle = {random_between(random, -away, away), random_between(random, -away, away)};
    const double tilt = random_below(random, 2) ? 0 : random_between(random, 0, 7);
    narc_point corners[10], p[50];
    size_t made = 0;
    for (size_t k = 0; k < count; k++) {
        const double angle = 2 * PI * ((double)k + random_between(random, 0, 0.8)) / (double)count;
        const double x = size * cos(angle), y = size * squeeze * sin(angle);
        corners[k] = (narc_point){middle.x + x * cos(tilt) - y * sin(tilt), middle.y + x * sin(tilt) + y * cos(tilt)};
    }
    for (size_t k = 0; k < count; k++) {
        const narc_point a = corners[k], b = corners[(k + 1) % count];
        p[made++] = a;
        for (size_t more = random_below(random, 3); more > 0; more--)
            p[made++] = double_point(random, a, size);
        for (size_t more = random_below(random, 3); more > 0; more--) {
            const double t = random_unit(random);
            p[made++] = double_point(random, (narc_point){a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)}, size);
        }
    }
    struct outline of = make_outline("hard");
    add_corners(&of, p, made);
    return of;
}

/* Curves whose control points are a corner's doubles now and then, so that chords nearly coincide. */
static struct outline make_hard_curves(struct test_random *random) {
    const size_t count = 2 + random_below(random, 3);
    const double size = random_log_between(random, 1e-6, 1e6);
    narc_point c[4 * 3 + 1];
    for (size_t k = 0; k < 3 * count; k++) {
        const double angle = 2 * PI * (double)k / (double)(3 * count), r = size * random_between(random, 0.3, 1);
        c[k] = (narc_point){r * cos(angle), r * sin(angle)};
        c[k] = k % 3 && random_below(random, 2) ? double_point(random, c[k - 1], size) : c[k];
    }
    c[3 * count] = random_below(random, 2) ? c[0] : double_point(random, c[0], size);
    struct outline of = make_outline("hard curves");
    for (size_t k = 0; k < count; k++)
        add_cubic(&of, &c[3 * k]);
    return of;
}

static void fit_at_random(struct test_random *random, const struct outline *of) {
    narc_fit_request request = {.family = (narc_fit_family)random_below(random, 4), .starts = 1};
    request.goal = request.family == NARC_FIT_PAPER ? NARC_FIT_BOUND_AREA : (narc_fit_goal)random_below(random, 5);
    request.arc_count = 3 + random_below(random, 4);
    AUTO(free_at) struct reference_hull hull = reference_wrap(of->points, of->count, of->points[0]);
    if (random_below(random, 8) == 0 && request.family != NARC_FIT_PAPER) {
        request.arc_count = 0;
        request.tolerance = (double)hull.radius * random_between(random, 0.2, 1);
    }
    narc_fit_result fit;
    if (narc_fit_path(of->path, &request, &fit, NULL) == NARC_ERROR_NOT_CONVEX) /* thin as a line */
        assert_true(hull.area < 4e-5L * hull.radius * hull.radius);
    else
        fit_and_check(of, request);
}

TEST(test_hard_outlines) {
    struct test_random random = test_random_named("hard outlines");
    for (size_t trial = 0, trials = test_trials(16); trial < trials; trial++) {
        struct outline of = random_below(&random, 4) ? make_hard(&random) : make_hard_curves(&random);
        fit_at_random(&random, &of);
        free_outline(&of);
    }
}

/* ---------------------------------------------------------------------------- thin outlines */

static struct outline make_rhombus(double aspect) {
    const narc_point p[] = {{-aspect, 0}, {0, -1}, {aspect, 0}, {0, 1}};
    struct outline made = make_outline("rhombus");
    add_corners(&made, p, 4);
    return made;
}

/* A part of all families, goals and counts, unless there is more time. */
TEST(test_rhombi) {
    static const double aspects[] = {1, 2, 4, 8, 11, 12, 13, 16, 32, 100, 316, 1000};
    const bool all = test_trials(1) > 1;
    for (size_t k = 0; k < sizeof aspects / sizeof *aspects; k++) {
        struct outline of = make_rhombus(aspects[k]);
        for (size_t turn = 0; turn < 4 * 3 * 2; turn++) {
            const narc_fit_request request = {.arc_count = 4 + 2 * (turn % 2),
                                              .family = (narc_fit_family)(turn / 2 % 4),
                                              .goal = (narc_fit_goal)(turn / 8),
                                              .starts = 1};
            const bool exists = request.family != NARC_FIT_PAPER || request.goal == NARC_FIT_BOUND_AREA;
            if (exists && (all || (k + turn) % (5 * stride(3)) == 0))
                fit_and_check(&of, request);
        }
        free_outline(&of);
    }
}

/* Sides are moved out by what single precision takes, and no more: a polygon is the rhombus itself. */
TEST(test_thin_is_close) {
    struct outline of = make_rhombus(1000);
    const narc_fit_result fit = fit_shape(&of, NARC_FIT_POLYGON, NARC_FIT_BOUND_AREA, 6);
    assert_true(fit.area <= fit.hull_area * 1.0005);
    assert_true(fit.max_distance <= 1e-6 * 2000);
    fit_and_check(&of, (narc_fit_request){.tolerance = 0.01, .family = NARC_FIT_EDGES, .starts = 1});
    free_outline(&of);
}

TEST(test_without_area) {
    static const double widths[] = {0, 1e-300, 1e-17, 1e-12, 1e-7, 1e-6};
    for (size_t k = 0; k < sizeof widths / sizeof *widths; k++) {
        const narc_point p[] = {{0, 0}, {1, 1}, {2 - widths[k], 2 + widths[k]}, {3, 3}, {1, 1 + widths[k]}};
        struct outline of = make_outline("nearly a line");
        add_corners(&of, p, 5);
        refuse_fit(of.path, (narc_fit_request){.arc_count = 4}, NARC_ERROR_NOT_CONVEX, "line");
        free_outline(&of);
    }
}

/* ---------------------------------------------------------------------------- far from the origin */

static struct outline make_far(struct test_random *random, double away) {
    const double angle = random_between(random, 0, 2 * PI), turn = random_between(random, 0, 1);
    narc_point p[5];
    for (int k = 0; k < 5; k++) {
        const double at = turn + 2 * PI * k / 5, r = random_between(random, 0.6, 1);
        p[k] = (narc_point){away * cos(angle) + r * cos(at), away * sin(angle) + r * sin(at)};
    }
    struct outline made = make_outline("far");
    add_corners(&made, p, 5);
    return made;
}

/* Coordinates that are kept are rounded by the store, and the shape holds the outline there. Its distance is told of
 * centres that are rounded by up to 2^-24 of theirs. */
TEST(test_kept_origin) {
    struct test_random random = test_random_named("kept origin");
    for (size_t trial = 0, trials = test_trials(12); trial < trials; trial++) {
        const double away = pow(10, (double)(trial % 6));
        struct outline of = make_far(&random, away);
        const narc_fit_request request = {
            .arc_count = 4, .family = (narc_fit_family)(trial % 3), .starts = 1, .keep_origin = true};
        const narc_fit_result fit = fit_outline(&of, request);
        assert_true(fit.origin.x == 0 && fit.origin.y == 0);
        check_contained(&of, &fit, "kept origin");
        AUTO(free_at) struct reference_hull hull = reference_wrap(of.points, of.count, (narc_point){0, 0});
        const struct reference_range range = reference_compare(fit.arcs, fit.arc_count, &hull);
        const real known = fmaxl(-range.least, range.largest);
        assert_true(fabsl(fit.max_distance - known) <= 4 * 0x1p-24L * (away + 2) + 1e-5L);
        free_outline(&of);
    }
}

TEST(test_too_far_to_keep) {
    struct test_random random = test_random_named("too far");
    struct outline of = make_far(&random, 9e8);
    const narc_fit_request request = {.arc_count = 4, .starts = 1, .keep_origin = true};
    refuse_fit(of.path, request, NARC_ERROR_NO_SOLUTION,
               "9e+08 from its origin, where single precision rounds by up to 53.6442");
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- messages */

/* What is told of a tolerance that is not reached is how close fits came, also if there is none with the most arcs: the
 * paper's route finds no n-arc with 32 arcs here. */
TEST(test_closest) {
    struct outline of = make_rhombus(316);
    const narc_fit_request request = {.tolerance = 4, .family = NARC_FIT_PAPER, .starts = 1};
    const narc_error error = refuse_fit(of.path, request, NARC_ERROR_NO_SOLUTION, "tolerance 4");
    assert_true(error.value > request.tolerance && error.value < 316);
    assert_null(strstr(error.message, "inf"));
    free_outline(&of);
}

TEST_MAIN("rounding")
