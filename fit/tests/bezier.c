/* SPDX-License-Identifier: MIT
 *
 * bezier.c - Bezier curves as arcs: common tangents, ends, the told distance against distances measured afresh
 * both ways, the number of arcs against theory, errors, and what must not matter.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fit_support.h"

enum { MOST_ARCS = 20000 };

/* ------------------------------------------------------------------------------------------------ plain geometry */

typedef narc_point point;

static point plus(point a, point b) { return (point){a.x + b.x, a.y + b.y}; }
static point minus(point a, point b) { return (point){a.x - b.x, a.y - b.y}; }
static point times(double s, point a) { return (point){s * a.x, s * a.y}; }
static double dot(point a, point b) { return a.x * b.x + a.y * b.y; }
static double cross(point a, point b) { return a.x * b.y - a.y * b.x; }
static double size_of(point a) { return hypot(a.x, a.y); }
static double distance(point a, point b) { return size_of(minus(a, b)); }

struct curve {
    point c[4];
    size_t degree;
    double tolerance;
};

static point curve_at(const struct curve *curve, double t) {
    point p[4] = {curve->c[0], curve->c[1], curve->c[2], curve->c[3]};
    for (size_t last = curve->degree; last > 0; last--)
        for (size_t i = 0; i < last; i++)
            p[i] = plus(times(1 - t, p[i]), times(t, p[i + 1]));
    return p[0];
}

static double extent_of(const struct curve *curve) {
    double extent = 0;
    for (size_t i = 0; i <= curve->degree; i++) {
        for (size_t j = 0; j < i; j++) {
            const point d = minus(curve->c[i], curve->c[j]);
            extent = fmax(extent, fmax(fabs(d.x), fabs(d.y)));
        }
    }
    return extent;
}

static double largest_coordinate(const struct curve *curve) {
    double largest = 0;
    for (size_t i = 0; i <= curve->degree; i++)
        largest = fmax(largest, fmax(fabs(curve->c[i].x), fabs(curve->c[i].y)));
    return largest;
}

/* What rounding does to coordinates of the arcs and of the test's own points: some tens of roundings. */
static double rounding_of(const struct curve *curve) {
    return 32 * DBL_EPSILON * (largest_coordinate(curve) + extent_of(curve));
}

/* The largest possible second derivative: d (d - 1) times the largest second difference. */
static double bend_of(const struct curve *curve) {
    double bend = 0;
    for (size_t i = 0; i + 2 <= curve->degree; i++)
        bend = fmax(bend, size_of(plus(minus(curve->c[i], times(2, curve->c[i + 1])), curve->c[i + 2])));
    return (double)(curve->degree * (curve->degree - 1)) * bend;
}

/* Distance from a point to a curve: chords stray by at most step^2 / 8 times the second derivative, so that parts which
 * are further away than the best point so far are left out, and the others halved. */
struct nearest {
    const struct curve *curve;
    point from;
    double bend, precision, best;
};

static void seek_nearest(struct nearest *n, double t0, point p0, double t1, point p1) {
    const double stray = n->bend * (t1 - t0) * (t1 - t0) / 8;
    n->best = fmin(n->best, fmin(distance(n->from, p0), distance(n->from, p1)));
    if (measure_distance(n->from, p0, p1) - stray > n->best - n->precision)
        return;
    const double t = (t0 + t1) / 2;
    const point p = curve_at(n->curve, t);
    if (distance(n->from, p0) < distance(n->from, p1)) {
        seek_nearest(n, t0, p0, t, p);
        seek_nearest(n, t, p, t1, p1);
    } else {
        seek_nearest(n, t, p, t1, p1);
        seek_nearest(n, t0, p0, t, p);
    }
}

/* Too large by at most `precision`. */
static double curve_distance(const struct curve *curve, point from, double precision) {
    struct nearest n = {curve, from, bend_of(curve), precision, INFINITY};
    seek_nearest(&n, 0, curve_at(curve, 0), 1, curve_at(curve, 1));
    return n.best;
}

/* An arc from its ends and its turn alone: centre = middle of the chord + what the turn says. */
static point turned_by(point v, double angle) {
    return (point){cos(angle) * v.x - sin(angle) * v.y, sin(angle) * v.x + cos(angle) * v.y};
}

static point arc_at(const narc_curve_arc *arc, double share) {
    const point chord = minus(arc->end, arc->start);
    if (fabs(arc->turn) < 1e-6) { /* x = share, height = turn x (1 - x) / 2: off by turn^2 */
        return plus(plus(arc->start, times(share, chord)),
                    times(-arc->turn / 2 * share * (1 - share), (point){-chord.y, chord.x}));
    }
    /* The chord of a part of the arc: inscribed angles are half of those at the centre. */
    const double part = sin(share * arc->turn / 2) / sin(arc->turn / 2);
    return plus(arc->start, times(part, turned_by(chord, -(1 - share) * arc->turn / 2)));
}

static double arc_distance(const narc_curve_arc *arc, point p) {
    const double ends = fmin(distance(p, arc->start), distance(p, arc->end));
    if (isinf(arc->radius))
        return measure_distance(p, arc->start, arc->end);
    /* In the sector if the direction from the centre turns from the start the same way, and no further, than the
     * arc. */
    const point from = minus(arc->start, arc->center), to = minus(p, arc->center);
    const double angle = atan2(cross(from, to), dot(from, to)) * (arc->turn < 0 ? -1 : 1);
    const double positive = angle < 0 ? angle + 2 * PI : angle;
    return positive <= fabs(arc->turn) ? fmin(ends, fabs(size_of(to) - arc->radius)) : ends;
}

/* ------------------------------------------------------------------------------------------------ fits */

struct fit {
    narc_curve_arc arcs[MOST_ARCS];
    size_t count;
    double told;
};

/* One at a time, since it is large. */
static struct fit the_fit, other_fit;

static void describe(const struct curve *curve, const char *what, double value, double limit) {
    char text[400];
    int used = snprintf(text, sizeof text, "%s: %.17g, limit %.17g; tolerance %.17g, curve", what, value, limit,
                        curve->tolerance);
    for (size_t i = 0; i <= curve->degree && used > 0 && (size_t)used < sizeof text; i++)
        used += snprintf(text + used, sizeof text - (size_t)used, " (%.17g, %.17g)", curve->c[i].x, curve->c[i].y);
    fail_msg("%s", text);
}

static void fit(const struct curve *curve, struct fit *out) {
    narc_error error = {0};
    if (narc_fit_bezier(curve->c, curve->degree, curve->tolerance, out->arcs, MOST_ARCS, &out->count, &out->told,
                        &error) != NARC_OK)
        describe(curve, error.message, 0, 0);
}

/* The distance that samples show: of the curve from the arcs, and of the arcs from the curve. */
static double sample(const struct curve *curve, const struct fit *f, size_t samples) {
    double largest = 0;
    for (size_t k = 0; k <= samples; k++) {
        const point p = curve_at(curve, (double)k / (double)samples);
        double nearest = INFINITY;
        for (size_t i = 0; i < f->count; i++)
            nearest = fmin(nearest, arc_distance(&f->arcs[i], p));
        largest = fmax(largest, nearest);
    }
    const size_t per_arc = samples / (4 * f->count) + 3;
    const double precision = 1e-3 * curve->tolerance;
    for (size_t i = 0; i < f->count; i++) {
        for (size_t k = 0; k <= per_arc; k++) {
            const point p = arc_at(&f->arcs[i], (double)k / (double)per_arc);
            largest = fmax(largest, curve_distance(curve, p, precision) - precision);
        }
    }
    return largest;
}

/* Direction of the tangent where an arc starts (-1) or ends (+1). */
static double tangent_at(const narc_curve_arc *arc, double side) {
    const point chord = minus(arc->end, arc->start);
    return atan2(chord.y, chord.x) + side * arc->turn / 2;
}

static void check_angle(const struct curve *curve, const char *what, double a, double b, double chord) {
    /* Arcs that turn by less than 4e-8 may be lines, each off by half of that; rounded points turn a chord by their
     * rounding over its length. */
    const double limit = 4e-8 + 1e-10 + 2 * rounding_of(curve) / chord;
    const double off = fabs(remainder(a - b, 2 * PI));
    if (!(off <= limit))
        describe(curve, what, off, limit);
}

/* Each arc by itself: fields that agree. */
static void check_arc(const struct curve *curve, const narc_curve_arc *arc) {
    if (!(distance(arc->start, arc->end) > 0))
        describe(curve, "an arc without length", 0, 0);
    if (isinf(arc->radius)) {
        assert_true(arc->turn == 0);
        return;
    }
    /* Centre and radius round like the radius. */
    const double limit = rounding_of(curve) + 8 * DBL_EPSILON * arc->radius;
    const double off = fmax(fabs(distance(arc->start, arc->center) - arc->radius),
                            fmax(fabs(distance(arc->end, arc->center) - arc->radius),
                                 fabs(distance(arc_at(arc, 0.5), arc->center) - arc->radius)));
    if (!(off <= limit) || !(arc->radius > 0) || !(fabs(arc->turn) <= PI))
        describe(curve, "an arc's fields disagree", off, limit);
}

/* The tangent at an end against the direction to the nearest control point elsewhere; `end` is that end's control
 * point, the others follow it in steps of `step`. If the nearest is very near, the curve may turn round there: a cusp's
 * tip counts as a point if its size, about speed^2 / second derivative, is below 1e-12 of the extent; speed = 3
 * times the distance and a second derivative up to 24 extents make that 1.7e-6. Then the next one's direction may be
 * the tangent, with which the curve leaves the tip but for a few times the ratio of both distances. */
static void check_end(const struct curve *curve, const char *what, double angle, const point *end, int step,
                      const narc_curve_arc *arc) {
    const double chord = distance(arc->start, arc->end);
    double before = 0;
    for (int near = 1; near <= (int)curve->degree; near++) {
        const point to = minus(end[near * step], *end);
        const double size = size_of(to);
        if (size == 0)
            continue;
        const double off = fabs(remainder(angle - atan2(to.y, to.x), 2 * PI));
        const double limit = 4e-8 + 1e-10 + 2 * rounding_of(curve) / fmin(chord, size) + 10 * before / size;
        if (off <= limit || rounding_of(curve) > 0.1 * chord)
            return;
        if (size >= 1.7e-6 * extent_of(curve))
            describe(curve, what, off, limit);
        before = size;
    }
}

/* Joints, ends and end tangents; `corners` is how many joints may have none in common. */
static void check_chain(const struct curve *curve, const struct fit *f, size_t corners) {
    const size_t last = f->count - 1;
    assert_memory_equal(&f->arcs[0].start, &curve->c[0], sizeof(point));
    assert_memory_equal(&f->arcs[last].end, &curve->c[curve->degree], sizeof(point));
    size_t jumps = 0;
    for (size_t i = 0; i < f->count; i++) {
        check_arc(curve, &f->arcs[i]);
        if (i == last)
            break;
        assert_memory_equal(&f->arcs[i].end, &f->arcs[i + 1].start, sizeof(point));
        const double a = tangent_at(&f->arcs[i], 1), b = tangent_at(&f->arcs[i + 1], -1);
        if (jumps < corners && fabs(remainder(a - b, 2 * PI)) > 1e-3) {
            jumps++;
            continue;
        }
        check_angle(
            curve, "the tangent jumps", a, b,
            fmin(distance(f->arcs[i].start, f->arcs[i].end), distance(f->arcs[i + 1].start, f->arcs[i + 1].end)));
    }
    check_end(curve, "the start's tangent", tangent_at(&f->arcs[0], -1), curve->c, 1, &f->arcs[0]);
    check_end(curve, "the end's tangent", tangent_at(&f->arcs[last], 1) + PI, curve->c + curve->degree, -1,
              &f->arcs[last]);
}

/* All of it; the sampled distance is returned. */
static double check_fit(const struct curve *curve, size_t corners, size_t samples) {
    fit(curve, &the_fit);
    check_chain(curve, &the_fit, corners);
    if (!(the_fit.told <= curve->tolerance))
        describe(curve, "told distance above the tolerance", the_fit.told, curve->tolerance);
    const double sampled = sample(curve, &the_fit, samples);
    if (!(sampled <= the_fit.told))
        describe(curve, "sampled distance above the told one", sampled, the_fit.told);
    return sampled;
}

/* ------------------------------------------------------------------------------------------------ curves */

static struct curve random_curve(struct test_random *random) {
    struct curve curve = {.degree = 1 + random_below(random, 3)};
    for (size_t i = 0; i <= curve.degree; i++)
        curve.c[i] = (point){random_between(random, -1, 1), random_between(random, -1, 1)};
    curve.tolerance = random_log_between(random, 1e-5, 1e-1);
    return curve;
}

/* Does the curve turn gently (no near cusp), so that its arcs and samples are of a size? */
static bool is_ordinary(const struct curve *curve) {
    double least = INFINITY;
    for (int k = 0; k < 200; k++)
        least = fmin(least, 200 * distance(curve_at(curve, k / 200.), curve_at(curve, (k + 1) / 200.)));
    return least > 0.2 * extent_of(curve);
}

TEST(test_random_curves) {
    struct test_random random = test_random_named("random curves");
    size_t ordinary = 0;
    double worst = 0;
    for (size_t trial = 0, trials = test_trials(150); trial < trials; trial++) {
        const struct curve curve = random_curve(&random);
        const double sampled = check_fit(&curve, 0, 300);
        /* Three samples and more on each arc miss the largest distance by some per cent; and where curves come near
         * themselves, another arc may be nearer than the curve's own. */
        if (curve.degree > 1 && is_ordinary(&curve) && the_fit.told < 1e-2) {
            ordinary++;
            worst = fmax(worst, the_fit.told / sampled);
        }
    }
    printf("%zu ordinary curves, told at most %.4f times what was sampled\n", ordinary, worst);
    assert_true(ordinary > 0);
    assert_true(worst <= 1.05);
}

TEST(test_small_tolerances) {
    struct test_random random = test_random_named("small tolerances");
    for (size_t trial = 0, trials = test_trials(10); trial < trials; trial++) {
        struct curve curve = random_curve(&random);
        curve.tolerance = extent_of(&curve) * random_log_between(&random, 1.0000001e-9, 1e-6);
        check_fit(&curve, 0, 1000);
    }
}

/* Curves that have given trouble to somebody: each with the number of its corners. */
static const struct nasty {
    const char *name;
    struct curve curve;
    size_t corners;
} NASTY[] = {
    {"cusp", {{{0, 0}, {1, 1}, {0, 1}, {1, 0}}, 3, 0}, 1},
    {"small loop", {{{0, 0}, {1.001, 1}, {-0.001, 1}, {1, 0}}, 3, 0}, 0},
    {"just no cusp", {{{0, 0}, {0.9999, 1}, {0.0001, 1}, {1, 0}}, 3, 0}, 0},
    {"nearly a cusp", {{{0, 0}, {1 - 1e-7, 1}, {1e-7, 1}, {1, 0}}, 3, 0}, 1},
    {"closed loop", {{{0, 0}, {1, 1}, {-1, 1}, {0, 0}}, 3, 0}, 0},
    {"symmetric inflection", {{{0, 0}, {0.5, 1}, {0.5, -1}, {1, 0}}, 3, 0}, 0},
    {"control point on the start", {{{0, 0}, {0, 0}, {0.5, 1}, {1, 0}}, 3, 0}, 0},
    {"control point on the end", {{{0, 0}, {0.5, 1}, {1, 0}, {1, 0}}, 3, 0}, 0},
    {"both on their ends", {{{0, 0}, {0, 0}, {1, 0.5}, {1, 0.5}}, 3, 0}, 0},
    {"both on the start", {{{0, 0}, {0, 0}, {0, 0}, {1, 0.5}}, 3, 0}, 0},
    {"both on the other's end", {{{0, 0}, {1, 0.5}, {0, 0}, {1, 0.5}}, 3, 0}, 2},
    {"both at one place", {{{0, 0}, {0.5, 1}, {0.5, 1}, {1, 0}}, 3, 0}, 0},
    {"quadratic, control on the start", {{{0, 0}, {0, 0}, {1, 2}}, 2, 0}, 0},
    {"quadratic, sharp", {{{0, 0}, {1, 0}, {0, 1e-3}}, 2, 0}, 0},
    {"quadratic, there and back", {{{0, 0}, {1, 0.5}, {0, 0}}, 2, 0}, 1},
    {"quadratic, doubling back", {{{0, 0}, {3, 1.5}, {1, 0.5}}, 2, 0}, 1},
    {"line", {{{1, 2}, {4, 3}}, 1, 0}, 0},
    {"straight cubic", {{{0, 0}, {1, 1}, {2, 2}, {3, 3}}, 3, 0}, 0},
    {"straight cubic that stands still", {{{0, 0}, {1, 1}, {0, 0}, {1, 1}}, 3, 0}, 2},
    {"straight, two turns", {{{0, 0}, {3, 6}, {-2, -4}, {1, 2}}, 3, 0}, 2},
    {"straight, out at both ends", {{{0, 0}, {-1, -2}, {2, 4}, {1, 2}}, 3, 0}, 2},
    {"end tangent the wrong way", {{{0, 0}, {-1e-3, 0}, {1, 1e-3}, {1, 0}}, 3, 0}, 1},
    {"tiny tangent the wrong way", {{{0, 0}, {-1e-6, 1e-7}, {0.5, 1}, {1, 0}}, 3, 0}, 1},
    {"tiny tangent aside", {{{0, 0}, {1e-9, -1e-9}, {0.5, 1}, {1, 0}}, 3, 0}, 0},
    {"quarter circle", {{{1, 0}, {1, 0.5522847498}, {0.5522847498, 1}, {0, 1}}, 3, 0}, 0},
    {"three quarters of a turn", {{{0, 0}, {2, 0.2}, {0.5, 3}, {-0.2, 0.1}}, 3, 0}, 0},
    {"long and flat", {{{0, 0}, {1, 1e-6}, {2, -1e-6}, {3, 1e-6}}, 3, 0}, 0},
    {"very uneven speed", {{{0, 0}, {1e-4, 1e-4}, {1, 2e-4}, {1.0001, 1}}, 3, 0}, 0},
};

TEST(test_nasty_curves) {
    for (size_t k = 0; k < sizeof NASTY / sizeof *NASTY; k += stride(3)) {
        for (double tolerance = 10; tolerance > 5e-7; tolerance /= 20) {
            struct curve curve = NASTY[k].curve;
            curve.tolerance = tolerance;
            const double sampled = check_fit(&curve, NASTY[k].corners, 400);
            if (tolerance < 2e-3 && tolerance > 1e-3) {
                printf("%-34s %3zu arcs, told %.3g, sampled %.3g\n", NASTY[k].name, the_fit.count, the_fit.told,
                       sampled);
            }
        }
    }
}

/* Curves drawn at random near what is degenerate. Their tangents jump at cusps, which two derivatives on the way may
 * be near: up to three. */
static struct curve random_nasty(struct test_random *random) {
    struct curve curve = random_curve(random);
    const double small = random_log_between(random, 1e-15, 1e-1);
    const point noise = {small * random_between(random, -1, 1), small * random_between(random, -1, 1)};
    const point across = minus(curve.c[curve.degree], curve.c[0]);
    switch (random_below(random, 5)) {
    case 0: /* a control point on or near another */
        curve.c[random_below(random, curve.degree + 1)] = plus(curve.c[random_below(random, curve.degree + 1)], noise);
        break;
    case 1: /* on or near a line */
        for (size_t i = 1; i < curve.degree; i++)
            curve.c[i] = plus(plus(curve.c[0], times(random_between(random, -2, 3), across)), times((double)i, noise));
        break;
    case 2: /* near a cusp: B'(1/2) = 0 if c3 - c0 = c1 - c2 */
        curve.degree = 3;
        curve.c[3] = plus(plus(curve.c[0], minus(curve.c[1], curve.c[2])), noise);
        break;
    case 3: /* on a lattice */
        for (size_t i = 0; i <= curve.degree; i++)
            curve.c[i] = (point){(double)random_below(random, 3), (double)random_below(random, 3)};
        break;
    default: /* far from the origin */
        for (size_t i = 0; i <= curve.degree; i++)
            curve.c[i] = plus(curve.c[i], (point){1e7, -3e7});
    }
    return curve;
}

TEST(test_random_nasty) {
    struct test_random random = test_random_named("nasty curves");
    for (size_t trial = 0, trials = test_trials(150); trial < trials; trial++) {
        const struct curve curve = random_nasty(&random);
        fit(&curve, &the_fit);
        if (extent_of(&curve) == 0) {
            assert_int_equal(the_fit.count, 0);
            assert_true(the_fit.told == 0);
            continue;
        }
        check_fit(&curve, 3, 200);
    }
}

/* ------------------------------------------------------------------------------------------------ numbers of arcs */

static const struct curve SMOOTH[] = {
    {{{0, 0}, {0.3, 0.5}, {0.7, 0.5}, {1, 0}}, 3, 0},
    {{{0, 0}, {0.2, 0.9}, {0.5, 0.3}, {1, 0.1}}, 3, 0},
    {{{0, 0}, {0.5, 1}, {0.5, -1}, {1, 0}}, 3, 0},
    {{{0, 0}, {1, 0.99}, {-0.05, 0.99}, {0.9, 0}}, 3, 0},
    {{{0, 0}, {0.2, 0.8}, {1, 0}}, 2, 0},
    {{{0, 0}, {0.1, 0.3}, {0.6, 0.5}, {1, 1.4}}, 3, 0},
};

/* For a small tolerance no arcs with common tangents do with fewer than 0.2002 = (sqrt(3) / 216)^(1/3) times the
 * integral of cbrt(|rate of the curvature|) over the length, divided by cbrt(tolerance): in a window of constant
 * rate q the offset is q x^3 / 6 minus a spline of degree 2, whose least largest value with knots h apart is that of
 * the Bernoulli polynomial, q h^3 sqrt(3) / 216. Curvature by differences of the tangent. */
static double least_arcs(const struct curve *curve) {
    enum { STEPS = 20000 };
    double sum = 0, last_curvature = 0, last_length = 0;
    point before = curve_at(curve, 0), here = curve_at(curve, 1. / STEPS);
    for (int k = 2; k <= STEPS; k++) {
        const point after = curve_at(curve, (double)k / STEPS), u = minus(here, before), v = minus(after, here);
        const double length = (size_of(u) + size_of(v)) / 2, curvature = atan2(cross(u, v), dot(u, v)) / length;
        if (k > 2) {
            const double step = (length + last_length) / 2;
            sum += cbrt(fabs(curvature - last_curvature) / step) * step;
        }
        last_curvature = curvature;
        last_length = length;
        before = here;
        here = after;
    }
    return cbrt(sqrt(3) / 216) * sum / cbrt(curve->tolerance);
}

TEST(test_arc_numbers) {
    for (size_t k = 0; k < sizeof SMOOTH / sizeof *SMOOTH; k += stride(3)) {
        struct curve curve = SMOOTH[k];
        double counts[7];
        printf("curve %zu, arcs (least asymptotically):", k);
        for (int digit = 2; digit <= 8; digit++) {
            curve.tolerance = pow(10, -digit);
            fit(&curve, &the_fit);
            counts[digit - 2] = (double)the_fit.count;
            const double least = least_arcs(&curve);
            printf(" %zu (%.1f)", the_fit.count, least);
            /* The ends, whose tangents are given, and the last pair, shorter than the others, cost up to 3; shares of
             * the tilt up to 0.8 cost 8 per cent (see spline.c for what is measured). */
            assert_true((double)the_fit.count <= 1.1 * least + 3);
            assert_true((double)the_fit.count >= 0.95 * least);
        }
        const double exponent = log10(counts[6] / counts[3]) / 3;
        printf("; exponent %.4f\n", -exponent);
        /* a / tolerance^(1/3) + b with b up to 4 has this slope between those two, to b / (3 log(10) a) at most. */
        assert_true(fabs(exponent - 1. / 3) <= 4 / (3 * log(10) * (counts[3] - 4)));
    }
}

TEST(test_known_counts) {
    /* Symmetric and one circle nearly: the usual quarter circle is off by 2.7e-4, one arc through its ends is
     * enough. */
    struct curve quarter = {{{1, 0}, {1, 0.5522847498}, {0.5522847498, 1}, {0, 1}}, 3, 1e-3};
    fit(&quarter, &the_fit);
    assert_int_equal(the_fit.count, 1);
    assert_true(fabs(the_fit.arcs[0].radius - 1) <= 1e-9);
    assert_true(fabs(the_fit.arcs[0].turn - PI / 2) <= 1e-9);
    assert_true(the_fit.told >= 2.7e-4 && the_fit.told <= 2.8e-4);
    /* Lines. */
    struct curve line = {{{0, 0}, {1, 2}, {3, 6}, {4, 8}}, 3, 1e-6};
    fit(&line, &the_fit);
    assert_int_equal(the_fit.count, 1);
    assert_true(isinf(the_fit.arcs[0].radius));
    struct curve back = {{{0, 0}, {3, 6}, {-2, -4}, {1, 2}}, 3, 1e-6};
    fit(&back, &the_fit);
    assert_int_equal(the_fit.count, 3);
    /* A cusp: two halves, mirror images. */
    struct curve cusp = {{{0, 0}, {1, 1}, {0, 1}, {1, 0}}, 3, 1e-4};
    fit(&cusp, &the_fit);
    assert_int_equal(the_fit.count % 2, 0);
    assert_true(fabs(the_fit.arcs[the_fit.count / 2].start.x - 0.5) <= 1e-9);
    assert_true(fabs(the_fit.arcs[the_fit.count / 2].start.y - 0.75) <= 1e-9);
    /* A point. */
    struct curve point_only = {{{2, 3}, {2, 3}, {2, 3}, {2, 3}}, 3, 1e-6};
    fit(&point_only, &the_fit);
    assert_int_equal(the_fit.count, 0);
    assert_true(the_fit.told == 0);
}

/* --------------------------------------------------------------------------------------------- what must not matter */

/* A last pair that just fits, or just does not, makes the counts differ by one pair. */
static void check_alike(const struct curve *a, const struct curve *b) {
    fit(a, &the_fit);
    fit(b, &other_fit);
    const double off = fabs((double)the_fit.count - (double)other_fit.count);
    if (off > 2)
        describe(a, "count of arcs changes by", off, 2);
}

TEST(test_invariance) {
    struct test_random random = test_random_named("invariance");
    for (size_t trial = 0, trials = test_trials(60); trial < trials; trial++) {
        struct curve curve = random_curve(&random), moved = curve;
        const double angle = random_between(&random, -4, 4);
        for (size_t i = 0; i <= curve.degree; i++)
            moved.c[i] = turned_by(curve.c[i], angle);
        check_alike(&curve, &moved);
        /* Powers of two change no bit of what is computed. */
        for (size_t i = 0; i <= curve.degree; i++)
            moved.c[i] = times(0x1p-30, curve.c[i]);
        moved.tolerance = curve.tolerance * 0x1p-30;
        fit(&curve, &the_fit);
        fit(&moved, &other_fit);
        assert_int_equal(the_fit.count, other_fit.count);
        assert_true(other_fit.told == the_fit.told * 0x1p-30);
        /* The other way round: the same splines to choose from. */
        struct curve reversed = curve;
        for (size_t i = 0; i <= curve.degree; i++)
            reversed.c[i] = curve.c[curve.degree - i];
        fit(&reversed, &other_fit);
        if (the_fit.count != other_fit.count || fabs(the_fit.told - other_fit.told) > 1e-3 * the_fit.told)
            describe(&curve, "reversed: distance", other_fit.told, the_fit.told);
    }
}

TEST(test_degrees_agree) {
    struct test_random random = test_random_named("degrees");
    for (size_t trial = 0, trials = test_trials(100); trial < trials; trial++) {
        struct curve curve = random_curve(&random), raised = curve;
        curve.degree = 2;
        raised.degree = 3;
        raised.c[3] = curve.c[2] = (point){random_between(&random, -1, 1), random_between(&random, -1, 1)};
        raised.tolerance = curve.tolerance;
        raised.c[1] = plus(times(1. / 3, curve.c[0]), times(2. / 3, curve.c[1]));
        raised.c[2] = plus(times(1. / 3, curve.c[2]), times(2. / 3, curve.c[1]));
        check_alike(&curve, &raised);
    }
}

/* The same bits again. And more tolerance, no more arcs: but the furthest cuts are not always the best, where a curve
 * turns sharply, so that one in a hundred may fail (one in a thousand was seen to). */
TEST(test_order) {
    struct test_random random = test_random_named("order");
    size_t failures = 0;
    for (size_t trial = 0, trials = test_trials(100); trial < trials; trial++) {
        struct curve curve = random_curve(&random);
        fit(&curve, &the_fit);
        fit(&curve, &other_fit);
        assert_int_equal(the_fit.count, other_fit.count);
        assert_memory_equal(the_fit.arcs, other_fit.arcs, the_fit.count * sizeof *the_fit.arcs);
        curve.tolerance *= 2;
        fit(&curve, &other_fit);
        failures += other_fit.count > the_fit.count;
    }
    assert_true(failures <= test_trials(100) / 100);
}

/* ------------------------------------------------------------------------------------------------ errors, capacity */

static void expect(narc_status expected, const point *c, size_t degree, double tolerance, const char *words) {
    narc_error error = {0};
    narc_curve_arc arcs[4];
    size_t count = 77;
    double told = -5;
    expect_error(narc_fit_bezier(c, degree, tolerance, arcs, 4, &count, &told, &error), expected, &error, words);
    assert_true(count == 77 && told == -5);
    assert_int_equal(narc_fit_bezier(c, degree, tolerance, arcs, 4, &count, &told, NULL), expected);
}

TEST(test_errors) {
    const point good[4] = {{0, 0}, {1, 1}, {2, -1}, {3, 0}};
    expect(NARC_ERROR_ARGUMENT, NULL, 3, 0.1, "controls");
    expect(NARC_ERROR_ARGUMENT, good, 0, 0.1, "degree is 0");
    expect(NARC_ERROR_ARGUMENT, good, 4, 0.1, "degree is 4");
    expect(NARC_ERROR_SIZE, good, 3, 0, "tolerance is 0");
    expect(NARC_ERROR_SIZE, good, 3, -1, "tolerance is -1");
    expect(NARC_ERROR_SIZE, good, 3, 2.9e-9, "tolerance");
    expect(NARC_ERROR_NOT_FINITE, good, 3, NAN, "tolerance");
    for (size_t k = 0; k < 4; k++) {
        point bad[4];
        memcpy(bad, good, sizeof bad);
        char words[40];
        snprintf(words, sizeof words, "control point %zu", k);
        bad[k].x = NAN;
        expect(NARC_ERROR_NOT_FINITE, bad, 3, 0.1, words);
        bad[k] = (point){0, INFINITY};
        expect(NARC_ERROR_NOT_FINITE, bad, 3, 0.1, words);
        bad[k] = (point){0, -1.1e9};
        expect(NARC_ERROR_SIZE, bad, 3, 0.1, words);
    }
    /* Far away doubles do not hold so small a tolerance: their spacing at 1e9 is 1.2e-7. */
    const point far[2] = {{1e9, 0}, {1e9 - 1, 1}};
    expect(NARC_ERROR_SIZE, far, 1, 1e-8, "tolerance");
    size_t count;
    double told;
    narc_curve_arc arcs[64];
    assert_int_equal(narc_fit_bezier(good, 3, 0.1, arcs, 64, NULL, &told, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_fit_bezier(good, 3, 0.1, arcs, 64, &count, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_fit_bezier(good, 3, 0.1, NULL, 64, &count, &told, NULL), NARC_ERROR_ARGUMENT);
}

TEST(test_capacity) {
    const struct curve curve = {{{0, 0}, {1, 1}, {2, -1}, {3, 0}}, 3, 1e-3};
    fit(&curve, &the_fit);
    size_t count = 0;
    double told = 0;
    narc_error error = {.status = NARC_ERROR_MEMORY};
    assert_int_equal(narc_fit_bezier(curve.c, 3, 1e-3, NULL, 0, &count, &told, &error), NARC_OK);
    assert_int_equal(error.status, NARC_ERROR_MEMORY); /* untouched */
    assert_int_equal(count, the_fit.count);
    assert_true(told == the_fit.told);
    for (size_t capacity = 0; capacity <= the_fit.count; capacity++) {
        narc_curve_arc arcs[64];
        memset(arcs, 0x55, sizeof arcs);
        count = 0;
        const bool enough = capacity == the_fit.count;
        assert_int_equal(narc_fit_bezier(curve.c, 3, 1e-3, arcs, capacity, &count, &told, &error),
                         enough ? NARC_OK : NARC_ERROR_CAPACITY);
        assert_int_equal(count, the_fit.count);
        unsigned char junk[sizeof *arcs];
        memset(junk, 0x55, sizeof junk);
        assert_memory_equal(&arcs[capacity], junk, sizeof junk);
    }
}

/* ------------------------------------------------------------------------------------------------ paths */

/* A square with one round side, given open, and a triangle that is closed by hand: each chain is closed, its curves are
 * the arcs of narc_fit_bezier(), its lines are lines. A contour that is a point is left out. */
TEST(test_chains) {
    const point bend[4] = {{0, 0}, {1, -1}, {3, -1}, {4, 0}};
    size_t count;
    double told;
    assert_int_equal(narc_fit_bezier(bend, 3, 1e-3, NULL, 0, &count, &told, NULL), NARC_OK);
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    narc_arc_chains chains;
    assert_int_equal(narc_fit_chains(path, 1e-3, false, &chains, &error), NARC_ERROR_COUNT);
    narc_move_to(path, &bend[0], NULL);
    narc_cubic_to(path, &bend[1], &bend[2], &bend[3], NULL);
    narc_line_to(path, &(point){4, 4}, NULL);
    narc_line_to(path, &(point){0, 4}, NULL);
    draw_polygon(path, (point[]){{7, 7}, {7, 7}}, 2);
    draw_polygon(path, (point[]){{9, 0}, {10, 0}, {9, 1}, {9, 0}}, 4);
    assert_int_equal(narc_fit_chains(path, 1e-3, false, &chains, &error), NARC_OK);
    assert_int_equal(chains.count, 2);
    assert_int_equal(chains.ends[0], count + 3);
    assert_int_equal(chains.ends[1], count + 6);
    assert_int_equal(chains.arc_count, count + 6);
    assert_true(chains.distance >= told && chains.distance <= 1e-3);
    for (size_t k = 0, begin = 0; k < chains.count; begin = chains.ends[k++]) {
        for (size_t i = begin; i < chains.ends[k]; i++) {
            const narc_curve_arc *next = &chains.arcs[i + 1 < chains.ends[k] ? i + 1 : begin];
            assert_true(chains.arcs[i].end.x == next->start.x && chains.arcs[i].end.y == next->start.y);
            assert_true(isinf(chains.arcs[i].radius) == (i >= count));
        }
    }
    narc_release_chains(&chains);
    assert_null(chains.arcs);
    assert_int_equal(narc_fit_chains(path, 0, false, &chains, &error), NARC_ERROR_SIZE);
    assert_int_equal(narc_fit_chains(path, NAN, false, &chains, &error), NARC_ERROR_NOT_FINITE);
    assert_int_equal(narc_fit_chains(NULL, 1, false, &chains, &error), NARC_ERROR_ARGUMENT);
}

TEST_MAIN("bezier")
