/* SPDX-License-Identifier: MIT
 *
 * flattening.c - flattened curves against dense samples of the true ones, in long double.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"

enum { SAMPLES = 1500, KINDS = 8 };

/* A curve from a point of its own, degree 2 or 3. */
struct curve {
    narc_point controls[4];
    unsigned degree;
};

/* By the powers of t and 1 - t; the error is some 2^-62 of the largest coordinate, nothing beside DBL_EPSILON of it. */
static narc_point evaluate(const struct curve *c, long double t) {
    static const int binomials[4][4] = {{1}, {1, 1}, {1, 2, 1}, {1, 3, 3, 1}};
    long double x = 0, y = 0;
    for (unsigned i = 0; i <= c->degree; i++) {
        const long double weight =
            (long double)binomials[c->degree][i] * powl(t, (long double)i) * powl(1 - t, (long double)(c->degree - i));
        x += weight * (long double)c->controls[i].x;
        y += weight * (long double)c->controls[i].y;
    }
    return (narc_point){(double)x, (double)y};
}

static double find_largest(const struct curve *c) {
    double largest = 0;
    for (unsigned i = 0; i <= c->degree; i++)
        largest = fmax(largest, fmax(fabs(c->controls[i].x), fabs(c->controls[i].y)));
    return largest;
}

/* The largest speed: d times the longest side of the control polygon. */
static double find_speed(const struct curve *c) {
    double longest = 0;
    for (unsigned i = 0; i < c->degree; i++) {
        longest =
            fmax(longest, hypot(c->controls[i + 1].x - c->controls[i].x, c->controls[i + 1].y - c->controls[i].y));
    }
    return c->degree * longest;
}

/* A bound of the second derivative. */
static double find_acceleration(const struct curve *c) {
    double largest = 0;
    for (unsigned i = 0; i + 2 <= c->degree; i++) {
        largest = fmax(largest, hypot(c->controls[i].x - 2 * c->controls[i + 1].x + c->controls[i + 2].x,
                                      c->controls[i].y - 2 * c->controls[i + 1].y + c->controls[i + 2].y));
    }
    return c->degree * (c->degree - 1) * largest;
}

/* Any of the kinds of curves that may be hard. */
static struct curve make_curve(struct test_random *random, size_t kind) {
    struct curve c = {.degree = 2 + (unsigned)random_below(random, 2)};
    const double size = kind == 0 ? 1e9 : kind == 1 ? 1e-3 : random_log_between(random, 1e-6, 1e6);
    const double shift = kind == 1 ? 9e8 : 0; /* small and far out */
    narc_point *p = c.controls;
    for (unsigned i = 0; i <= c.degree; i++)
        p[i] = (narc_point){shift + size * random_between(random, -1, 1), shift + size * random_between(random, -1, 1)};
    if (kind == 2) { /* a cusp or a loop: the inner control points changed */
        p[1] = (narc_point){p[0].x + 2 * (p[c.degree].x - p[0].x), p[1].y};
        p[c.degree - 1] = c.degree == 3 ? (narc_point){p[0].x - (p[3].x - p[0].x), p[1].y} : p[1];
    } else if (kind == 3) { /* all on a line, overshooting the ends */
        for (unsigned i = 1; i <= c.degree; i++)
            p[i] = (narc_point){p[0].x + size * random_between(random, -1, 1), p[0].y};
    } else if (kind == 4) { /* closed */
        p[c.degree] = p[0];
    } else if (kind == 5) { /* no tangent at an end */
        p[1] = p[0];
    } else if (kind == 6) { /* nearly a line, evenly parametrised */
        for (unsigned i = 1; i < c.degree; i++) {
            p[i].x = p[0].x + (p[c.degree].x - p[0].x) * i / c.degree;
            p[i].y = p[0].y + (p[c.degree].y - p[0].y) * i / c.degree * (1 + random_between(random, 0, 1e-9));
        }
    }
    return c;
}

static narc_path *draw_curve(const struct curve *c) {
    narc_path *path = make_path();
    narc_error error;
    const narc_point *p = c->controls;
    expect_ok(narc_move_to(path, &p[0], &error), &error);
    expect_ok(c->degree == 2 ? narc_quadratic_to(path, &p[1], &p[2], &error)
                             : narc_cubic_to(path, &p[1], &p[2], &p[3], &error),
              &error);
    return path;
}

static void sample_curve(const struct curve *c, narc_point *out_samples) {
    for (size_t k = 0; k <= SAMPLES; k++)
        out_samples[k] = evaluate(c, (long double)k / SAMPLES);
}

/* No sample is further than the flatness from the chords, the closing one (if the curve's end is not its start) left
 * out. Samples are rounded, by half an epsilon in each coordinate, and so are distances (see measure_distance()); the
 * control polygon is not wider than the speed. */
static void check_distance(const struct curve *c, const narc_contours *flat, const narc_point *samples) {
    const double allowed = flat->flatness + DBL_EPSILON * (find_largest(c) + 6 * find_speed(c));
    const narc_point *end = &c->controls[c->degree];
    const bool closes = end->x == c->controls[0].x && end->y == c->controls[0].y;
    size_t chord = 0;
    for (size_t k = 0; k <= SAMPLES; k++) {
        /* Samples and chords follow the curve together: the nearest chord is looked for from the last one's on. */
        const size_t count = flat->point_count;
        size_t tried = 0;
        double distance = INFINITY;
        for (; tried <= count && !(distance <= allowed); tried++) {
            const size_t i = (chord + tried) % count;
            if (i + 1 < count || closes)
                distance = measure_distance(samples[k], flat->points[i], flat->points[i + 1 < count ? i + 1 : 0]);
            else if (count == 1)
                distance = hypot(samples[k].x - flat->points[0].x, samples[k].y - flat->points[0].y);
        }
        chord = (chord + tried - 1) % count;
        if (!(distance <= allowed))
            fail_msg("degree %u, sample %zu is not within %.17g of the chords", c->degree, k, allowed);
    }
}

/* The chords' ends are on the curve, in its order: between samples the curve strays from them by at most half a step
 * times its speed. Rounding: 5 epsilon in each coordinate for the ends, and 1 for the samples. */
static void check_ends(const struct curve *c, const narc_contours *flat, const narc_point *samples) {
    const double allowed = find_speed(c) / (2 * SAMPLES) + 10 * DBL_EPSILON * find_largest(c);
    size_t sample = 0;
    for (size_t i = 0; i < flat->point_count; i++) {
        const narc_point p = flat->points[i];
        while (sample < SAMPLES && hypot(p.x - samples[sample].x, p.y - samples[sample].y) > allowed)
            sample++;
        if (!(hypot(p.x - samples[sample].x, p.y - samples[sample].y) <= allowed))
            fail_msg("degree %u, point %zu of %zu is not on the curve", c->degree, i, flat->point_count);
    }
    assert_memory_equal(&flat->points[0], &c->controls[0], sizeof c->controls[0]);
}

/* No more chords than even steps need: k with acceleration / (8 k^2) <= flatness - rounding, rounding 26 epsilon as the
 * library has it, and one more if the division came out that way. */
static void check_thrift(const struct curve *c, const narc_contours *flat) {
    const double room = flat->flatness - 26 * DBL_EPSILON * find_largest(c);
    const double chords = room > 0 ? sqrt(find_acceleration(c) / 8 / room) : 0;
    assert_true(room > 0 || flat->point_count < 3 || find_acceleration(c) > 0);
    if (room > 1e-6 * flat->flatness && (double)flat->point_count > fmin(20000, ceil(chords * (1 + 1e-6))) + 2)
        fail_msg("%zu points where %g chords do", flat->point_count, chords);
}

TEST(stays_within_flatness) {
    struct test_random random = test_random_named("flattening");
    const size_t trials = test_trials(400);
    for (size_t trial = 0; trial < trials; trial++) {
        const struct curve c = make_curve(&random, trial % KINDS);
        AUTO(narc_destroy_path_at) narc_path *path = draw_curve(&c);
        narc_point samples[SAMPLES + 1];
        sample_curve(&c, samples);
        for (int round = 0; round < 2; round++) {
            const double asked =
                round ? fmax(random_log_between(&random, 1e-6, 0.1) * find_speed(&c), 1e-12 * find_largest(&c)) : 0;
            AUTO(narc_release_contours) narc_contours flat;
            narc_error error;
            expect_ok(narc_flatten_path(path, asked, &flat, &error), &error);
            assert_true(round ? flat.flatness == asked : flat.flatness > 0);
            assert_int_equal(flat.count, 1);
            assert_int_equal(flat.ends[0], flat.point_count);
            check_distance(&c, &flat, samples);
            check_ends(&c, &flat, samples);
            check_thrift(&c, &flat);
        }
    }
}

/* The default is NARC_FLATNESS times the larger side of the box around the curves, not around their control points.
 * The box around samples is smaller by up to the curve's bend between two of them, on either side. */
TEST(measures_the_extent) {
    struct test_random random = test_random_named("extent");
    for (size_t trial = 0; trial < test_trials(300); trial++) {
        const struct curve c = make_curve(&random, 2 + trial % (KINDS - 2));
        AUTO(narc_destroy_path_at) narc_path *path = draw_curve(&c);
        narc_point samples[SAMPLES + 1], low = c.controls[0], high = c.controls[0];
        sample_curve(&c, samples);
        for (size_t k = 0; k <= SAMPLES; k++) {
            low = (narc_point){fmin(low.x, samples[k].x), fmin(low.y, samples[k].y)};
            high = (narc_point){fmax(high.x, samples[k].x), fmax(high.y, samples[k].y)};
        }
        const double sampled = fmax(high.x - low.x, high.y - low.y);
        const double slack = 2 * find_acceleration(&c) / (8.0 * SAMPLES * SAMPLES), rounding = 12 * find_largest(&c);
        AUTO(narc_release_contours) narc_contours flat = flatten(path);
        const double extent = flat.flatness / NARC_FLATNESS;
        if (!(extent >= sampled - rounding * DBL_EPSILON && extent <= sampled + slack + rounding * DBL_EPSILON))
            fail_msg("extent %.17g, of samples %.17g", extent, sampled);
    }
}

/* A speck so far out that doubles cannot tell NARC_FLATNESS of it: the flatness is what they can tell. */
TEST(flattens_specks_far_out) {
    const double far = 9e8;
    struct curve c = {{{far, far}, {far + 1e-6, far}, {far + 1e-6, far + 1e-6}, {far, far + 1e-6}}, 3};
    AUTO(narc_destroy_path_at) narc_path *path = draw_curve(&c);
    narc_point samples[SAMPLES + 1];
    sample_curve(&c, samples);
    AUTO(narc_release_contours) narc_contours flat = flatten(path);
    assert_true(flat.flatness > 1e-6 * NARC_FLATNESS && flat.flatness < 1e-14 * far);
    check_distance(&c, &flat, samples);
}

TEST(refuses_wrong_flatness) {
    static const double wrong[] = {-1, -1e-300, NAN, INFINITY, -INFINITY};
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_contours out, untouched;
    narc_error error;
    memset(&out, 0x5a, sizeof out);
    untouched = out;
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k++)
        expect_error(narc_flatten_path(path, wrong[k], &out, &error), NARC_ERROR_SIZE, &error, "flatness");
    expect_error(narc_flatten_path(NULL, 0, &out, &error), NARC_ERROR_ARGUMENT, &error, "path");
    expect_error(narc_flatten_path(path, 0, NULL, &error), NARC_ERROR_ARGUMENT, &error, "out_contours");
    assert_memory_equal(&out, &untouched, sizeof out);
}

/* A tiny flatness is refused; the one that the message names is fine, a little less is not. */
TEST(names_the_least_flatness) {
    struct test_random random = test_random_named("least flatness");
    for (size_t trial = 0; trial < test_trials(40); trial++) {
        const struct curve c = make_curve(&random, trial % 2 ? 7 : trial / 2 % 3);
        AUTO(narc_destroy_path_at) narc_path *path = draw_curve(&c);
        narc_contours out, untouched;
        narc_error error;
        memset(&out, 0x5a, sizeof out);
        untouched = out;
        expect_error(narc_flatten_path(path, 1e-300, &out, &error), NARC_ERROR_SIZE, &error,
                     "flatness 1e-300 is too small for a curve of contour 0: at least ");
        assert_memory_equal(&out, &untouched, sizeof out);
        const double least = strtod(strstr(error.message, "at least ") + 9, NULL);
        expect_error(narc_flatten_path(path, least * 0.99998, &out, &error), NARC_ERROR_SIZE, &error, "too small");
        expect_ok(narc_flatten_path(path, least, &out, &error), &error);
        assert_in_range(out.point_count, 2, 20001);
        narc_release_contours(&out);
    }
}

/* Lines and curves, several contours: each has the points of its own curves. */
TEST(flattens_mixed_contours) {
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    draw_polygon(path, (narc_point[]){{10, 0}, {10, 5}}, 2);
    expect_ok(narc_cubic_to(path, &(narc_point){10, 8}, &(narc_point){7, 9}, &(narc_point){5, 9}, &error), &error);
    expect_ok(narc_quadratic_to(path, &(narc_point){0, 9}, &(narc_point){10, 0}, &error), &error);
    draw_polygon(path, (narc_point[]){{1, 1}, {2, 1}, {1, 2}}, 3);
    AUTO(narc_release_contours) narc_contours flat = flatten(path);
    assert_int_equal(flat.count, 2);
    assert_int_equal(flat.ends[1], flat.point_count);
    assert_int_equal(flat.ends[1] - flat.ends[0], 3);
    assert_true(flat.points[1].x == 10 && flat.points[1].y == 5);
    bool has_joint = false;
    for (size_t i = 2; i < flat.ends[0]; i++) {
        has_joint = has_joint || (flat.points[i].x == 5 && flat.points[i].y == 9);
        assert_false(flat.points[i].x == 10 && flat.points[i].y == 0); /* the start is not repeated */
    }
    assert_true(has_joint);
    assert_true(flat.points[flat.ends[0]].x == 1 && flat.points[flat.ends[0]].y == 1);
}
