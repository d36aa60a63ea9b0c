/* SPDX-License-Identifier: MIT
 *
 * rounding.c - fits of outlines that are hard on numbers: points that coincide or lie in line but for roundings, tiny,
 * huge, far away and thin outlines. What is told is compared with sums over the outline's own points and the arcs' in
 * long double, which share nothing with the library.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "outlines.h"

typedef long double real;
#define LONG_PI 3.14159265358979323846264338327950288L

typedef struct vector {
    real x, y;
} vector;

static real dot(vector a, vector b) { return a.x * b.x + a.y * b.y; }
static real cross(vector a, vector b) { return a.x * b.y - a.y * b.x; }
static vector minus(vector a, vector b) { return (vector){a.x - b.x, a.y - b.y}; }
static vector unit_at(real angle) { return (vector){cosl(angle), sinl(angle)}; }

/* ---------------------------------------------------------------------------- the outline's points */

enum { MOST_POINTS = 400 };

/* What a shape must hold, as seen from its origin. */
struct points {
    size_t count;
    vector items[MOST_POINTS];
    real size; /* the largest distance from the first */
};

static struct points see_points(const struct outline *of, narc_point origin) {
    struct points seen = {.count = of->count};
    assert_true(of->count <= MOST_POINTS);
    for (size_t k = 0; k < of->count; k++) {
        seen.items[k] = (vector){(real)of->points[k].x - (real)origin.x, (real)of->points[k].y - (real)origin.y};
        const vector from = minus(seen.items[k], seen.items[0]);
        seen.size = fmaxl(seen.size, hypotl(from.x, from.y));
    }
    return seen;
}

static real reach_points(const struct points *of, vector u) {
    real most = -INFINITY;
    for (size_t k = 0; k < of->count; k++)
        most = fmaxl(most, dot(of->items[k], u));
    return most;
}

/* Half the sum of the sides of the hull, each crossed with its end: a side is a pair of points that has none to its
 * right; of those in line the furthest two. */
static real measure_hull(const struct points *of) {
    real twice = 0;
    for (size_t i = 0; i < of->count; i++) {
        for (size_t j = 0; j < of->count; j++) {
            const vector a = of->items[i], side = minus(of->items[j], a);
            bool is_side = side.x != 0 || side.y != 0;
            for (size_t k = 0; k < of->count && is_side; k++) {
                const vector b = minus(of->items[k], a);
                const real left = cross(side, b), along = dot(side, b);
                const bool first = k < i && b.x == 0 && b.y == 0;
                const bool before = k < j && b.x == side.x && b.y == side.y;
                is_side = left > 0 || (left == 0 && along >= 0 && along <= dot(side, side) && !first && !before);
            }
            twice += is_side ? cross(a, of->items[j]) : 0;
        }
    }
    return twice / 2;
}

/* ---------------------------------------------------------------------------- the arcs */

struct shape {
    size_t count;
    struct {
        vector center, start, end; /* unit normals */
        real radius, from, sweep;
    } arcs[NARC_MAX_ARCS];
};

static struct shape see_arcs(const narc_arc *arcs, size_t count) {
    struct shape seen = {.count = count};
    for (size_t k = 0; k < count; k++) {
        const real from = arcs[k].start, sweep = (real)arcs[k].end - (real)arcs[k].start;
        seen.arcs[k].center = (vector){arcs[k].center_x, arcs[k].center_y};
        seen.arcs[k].radius = arcs[k].radius;
        seen.arcs[k].from = from;
        seen.arcs[k].sweep = sweep > 0 ? sweep : sweep + 2 * LONG_PI;
        seen.arcs[k].start = unit_at(from);
        seen.arcs[k].end = unit_at(from + seen.arcs[k].sweep);
    }
    return seen;
}

/* What the store makes of a fit. */
static struct shape store_fit(const narc_fit_result *fit) {
    narc_shapes *shapes = NULL;
    narc_arc arcs[NARC_MAX_ARCS];
    narc_error error = {0};
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    expect_ok(narc_add_shape(shapes, fit->arcs, fit->arc_count, NULL, &error), &error);
    const size_t count = narc_get_arcs(shapes, 0, arcs);
    narc_destroy_shapes(shapes);
    return see_arcs(arcs, count);
}

static vector arc_end(const struct shape *of, size_t k, bool end) {
    const vector d = end ? of->arcs[k].end : of->arcs[k].start, c = of->arcs[k].center;
    return (vector){c.x + of->arcs[k].radius * d.x, c.y + of->arcs[k].radius * d.y};
}

/* The support function: the largest of all arcs' points. */
static real reach_arcs(const struct shape *of, vector u) {
    const real angle = atan2l(u.y, u.x);
    real most = -INFINITY;
    for (size_t k = 0; k < of->count; k++) {
        real turn = fmodl(angle - of->arcs[k].from, 2 * LONG_PI);
        turn = turn < 0 ? turn + 2 * LONG_PI : turn;
        most = fmaxl(most, fmaxl(dot(arc_end(of, k, false), u), dot(arc_end(of, k, true), u)));
        most = turn <= of->arcs[k].sweep ? fmaxl(most, dot(of->arcs[k].center, u) + of->arcs[k].radius) : most;
    }
    return most;
}

/* The least of (support function - p.u) for one point: at an arc's ends, at the normal of the line between two arcs, or
 * where u is along the point as seen from an arc's centre. Elsewhere it has no least. */
static real find_room(const struct shape *of, vector p) {
    real least = INFINITY;
    for (size_t k = 0; k < of->count; k++) {
        const vector a = arc_end(of, k, true), b = arc_end(of, (k + 1) % of->count, false);
        const vector directions[] = {of->arcs[k].start, {b.y - a.y, a.x - b.x}, minus(p, of->arcs[k].center)};
        for (size_t i = 0; i < 3; i++) {
            const vector u = directions[i];
            const real size = hypotl(u.x, u.y);
            if (size > 0) {
                const vector unit = {u.x / size, u.y / size};
                least = fminl(least, reach_arcs(of, unit) - dot(unit, p));
            }
        }
    }
    return least;
}

/* Green's theorem: arcs, and the lines between them. */
static real measure_arcs(const struct shape *of) {
    real twice = 0;
    for (size_t k = 0; k < of->count; k++) {
        const vector c = of->arcs[k].center, step = minus(of->arcs[k].end, of->arcs[k].start);
        const real r = of->arcs[k].radius;
        twice += r * r * of->arcs[k].sweep + r * cross(c, step);
        twice += cross(arc_end(of, k, true), arc_end(of, (k + 1) % of->count, false));
    }
    return twice / 2;
}

/* ---------------------------------------------------------------------------- distance */

static real differ_at(const struct shape *of, const struct points *points, real angle) {
    const vector u = unit_at(angle);
    return fabsl(reach_arcs(of, u) - reach_points(points, u));
}

/* The largest difference to either side: many directions, and thirds around each that is larger than those beside. */
static real find_distance(const struct shape *of, const struct points *points) {
    enum { DIRECTIONS = 720, THIRDS = 60 };
    real values[DIRECTIONS], most = 0;
    const real step = 2 * LONG_PI / DIRECTIONS;
    for (int k = 0; k < DIRECTIONS; k++)
        values[k] = differ_at(of, points, step * k);
    for (int k = 0; k < DIRECTIONS; k++) {
        if (values[k] < values[(k + 1) % DIRECTIONS] || values[k] < values[(k + DIRECTIONS - 1) % DIRECTIONS])
            continue;
        real low = step * (k - 1), high = step * (k + 1);
        for (int third = 0; third < THIRDS; third++) {
            const real a = low + (high - low) / 3, b = high - (high - low) / 3;
            if (differ_at(of, points, a) < differ_at(of, points, b))
                low = a;
            else
                high = b;
        }
        most = fmaxl(most, fmaxl(values[k], differ_at(of, points, (low + high) / 2)));
    }
    return most;
}

/* ---------------------------------------------------------------------------- what must hold */

static void expect_close(const char *what, const char *quantity, double told, real known, real limit) {
    if (!(fabsl(told - known) <= limit)) {
        fail_msg("%s: %s is %.17g, but %.17Lg is known, off by %.3Lg of %.3Lg", what, quantity, told, known,
                 fabsl(told - known), limit);
    }
}

/* Neighbouring arcs, whose centres and radii are rounded to single precision, each by up to 2^-25 of itself, miss each
 * other by up to 2 (sqrt(2) + 1) 2^-25 of the largest: what is between them may count or not. */
static real find_miss(const narc_fit_result *fit, const struct points *points) {
    real largest = points->size;
    for (size_t k = 0; k < fit->arc_count; k++)
        largest = fmaxl(largest, points->size + fit->arcs[k].radius);
    return 0x1p-22L * largest;
}

static void check_fit(const char *what, const struct outline *of, bool bound, const narc_fit_result *fit) {
    const struct points points = see_points(of, fit->origin);
    const struct shape told = see_arcs(fit->arcs, fit->arc_count), kept = store_fit(fit);
    if (bound) {
        real least = INFINITY;
        for (size_t k = 0; k < points.count; k++)
            least = fminl(least, find_room(&kept, points.items[k]));
        if (!(least > 0) || !(fit->clearance > 0) || !(fit->clearance <= least)) {
            fail_msg("%s: the least room is %.3Lg of the size, told %.3Lg", what, least / points.size,
                     fit->clearance / points.size);
        }
    }
    const real area = measure_arcs(&told);
    expect_close(what, "area", fit->area, area, 1e-9L * area);
    /* Corners of the hull that are closer than 1e-10 of its size are one to the library. Between points of a curve, 64 of
     * them, the curve may be 6 D / (8 * 64^2) further out, with D, the second difference of its control points, up to 4
     * times their radius. */
    const real more = of->curved ? 1e-3L * points.size + fit->flatness : 1e-9L * points.size;
    expect_close(what, "hull's area", fit->hull_area, measure_hull(&points), 8 * points.size * more);
    expect_close(what, "distance", fit->max_distance, find_distance(&told, &points), find_miss(fit, &points) + more);
}

static void describe(char *out, size_t size, const struct outline *of, const narc_fit_request *request) {
    snprintf(out, size, "%s, family %d, goal %d, %zu arcs, tolerance %g", of->name, (int)request->family,
             (int)request->goal, request->arc_count, request->tolerance);
}

static void fit_and_check(const struct outline *of, narc_fit_request request) {
    char what[160];
    describe(what, sizeof what, of, &request);
    const narc_fit_result fit = fit_outline(of, request);
    check_fit(what, of, request.goal <= NARC_FIT_BOUND_DISTANCE, &fit);
    assert_true(request.arc_count || fit.max_distance + fit.flatness <= request.tolerance);
}

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
        for (int goal = NARC_FIT_BOUND_AREA; goal <= last; goal++) {
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
    narc_point corners[10], p[MOST_POINTS];
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
    const struct points points = see_points(of, of->points[0]);
    if (random_below(random, 8) == 0 && request.family != NARC_FIT_PAPER) {
        request.arc_count = 0;
        request.tolerance = (double)points.size * random_between(random, 0.1, 0.5);
    }
    char what[160];
    describe(what, sizeof what, of, &request);
    narc_fit_result fit;
    narc_error error = {0};
    const narc_status status = narc_fit_path(of->path, &request, &fit, &error);
    if (status == NARC_ERROR_NOT_CONVEX) { /* thin as a line */
        assert_true(measure_hull(&points) < 1e-5L * points.size * points.size);
        return;
    }
    if (status != NARC_OK)
        fail_msg("%s: %s, %s", what, narc_status_name(status), error.message);
    check_fit(what, of, request.goal <= NARC_FIT_BOUND_DISTANCE, &fit);
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
            if (exists && (all || (k + turn) % 5 == 0))
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
        const narc_fit_request request = {.arc_count = 4};
        narc_fit_result fit;
        narc_error error = {0};
        expect_error(narc_fit_path(of.path, &request, &fit, &error), NARC_ERROR_NOT_CONVEX, &error, "line");
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
        const struct points points = see_points(&of, (narc_point){0, 0});
        const struct shape kept = store_fit(&fit);
        real least = INFINITY;
        for (size_t k = 0; k < points.count; k++)
            least = fminl(least, find_room(&kept, points.items[k]));
        assert_true(fit.origin.x == 0 && fit.origin.y == 0);
        if (!(least > 0 && fit.clearance > 0 && fit.clearance <= least))
            fail_msg("%g away, family %d: the least room is %.3Lg, told %.3g", away, (int)request.family, least,
                     fit.clearance);
        const real told = fit.max_distance, miss = 4 * 0x1p-24L * (away + points.size) + 1e-5L;
        expect_close("kept origin", "distance", (double)told, find_distance(&kept, &points), miss);
        free_outline(&of);
    }
}

TEST(test_too_far_to_keep) {
    struct test_random random = test_random_named("too far");
    struct outline of = make_far(&random, 9e8);
    const narc_fit_request request = {.arc_count = 4, .starts = 1, .keep_origin = true};
    narc_fit_result fit;
    narc_error error = {0};
    expect_error(narc_fit_path(of.path, &request, &fit, &error), NARC_ERROR_NO_SOLUTION, &error,
                 "9e+08 from its origin, where single precision rounds by up to 53.6442");
    free_outline(&of);
}

/* ---------------------------------------------------------------------------- messages */

/* What is told of a tolerance that is not reached is how close fits came, also if there is none with the most arcs: the
 * paper's route finds no n-arc with 32 arcs here. */
TEST(test_closest) {
    struct outline of = make_rhombus(316);
    const narc_fit_request request = {.tolerance = 4, .family = NARC_FIT_PAPER, .starts = 1};
    narc_fit_result fit;
    narc_error error = {0};
    expect_error(narc_fit_path(of.path, &request, &fit, &error), NARC_ERROR_NO_SOLUTION, &error, "tolerance 4");
    assert_true(error.value > request.tolerance && error.value < 316);
    assert_null(strstr(error.message, "inf"));
    free_outline(&of);
}

TEST_MAIN("rounding")
