/* SPDX-License-Identifier: MIT
 *
 * outlines.c - outlines to fit, and checks of fits.
 */
#include "outlines.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* ---------------------------------------------------------------------------- outlines */

struct outline make_outline(const char *name) {
    return (struct outline){.name = name, .path = make_path()};
}

void free_outline(struct outline *of) {
    narc_destroy_path(of->path);
    free(of->points);
    *of = (struct outline){0};
}

static void remember(struct outline *to, narc_point p) {
    if (to->count == to->capacity) {
        to->capacity = 2 * to->capacity + 16;
        to->points = realloc(to->points, to->capacity * sizeof *to->points);
        assert_non_null(to->points);
    }
    to->points[to->count++] = p;
}

void add_corners(struct outline *to, const narc_point *points, size_t count) {
    draw_polygon(to->path, points, count);
    for (size_t k = 0; k < count; k++)
        remember(to, points[k]);
}

void add_cubic(struct outline *to, const narc_point c[4]) {
    enum { SAMPLES = 64 };
    narc_error error;
    const narc_point *last = to->count ? &to->points[to->count - 1] : NULL;
    if (!last || last->x != c[0].x || last->y != c[0].y) {
        expect_ok(narc_move_to(to->path, &c[0], &error), &error);
        remember(to, c[0]);
    }
    expect_ok(narc_cubic_to(to->path, &c[1], &c[2], &c[3], &error), &error);
    for (int k = 1; k < SAMPLES; k++) {
        const double t = (double)k / SAMPLES, s = 1 - t;
        const double a = s * s * s, b = 3 * s * s * t, d = 3 * s * t * t, e = t * t * t;
        remember(to, (narc_point){a * c[0].x + b * c[1].x + d * c[2].x + e * c[3].x,
                                  a * c[0].y + b * c[1].y + d * c[2].y + e * c[3].y});
    }
    remember(to, c[3]);
    to->curved = true;
}

enum { MOST_CORNERS = 2000 };

struct outline make_regular(const char *name, size_t corners, double phase, double squeeze) {
    narc_point p[MOST_CORNERS];
    for (size_t k = 0; k < corners; k++) {
        const double angle = phase + 2 * PI * (double)k / (double)corners;
        p[k] = (narc_point){cos(angle), squeeze * sin(angle)};
    }
    struct outline made = make_outline(name);
    add_corners(&made, p, corners);
    return made;
}

struct outline make_box(double width, double height) {
    const narc_point p[4] = {{0, 0}, {width, 0}, {width, height}, {0, height}};
    struct outline made = make_outline("box");
    add_corners(&made, p, 4);
    return made;
}

struct outline make_stadium(double length, size_t corners) {
    narc_point p[MOST_CORNERS];
    for (size_t k = 0; k < 2 * corners; k++) {
        const bool left = k >= corners;
        const double angle = PI * ((double)(k % corners) / (double)(corners - 1) - 0.5) + (left ? PI : 0);
        p[k] = (narc_point){cos(angle) + (left ? -length / 2 : length / 2), sin(angle)};
    }
    struct outline made = make_outline("stadium");
    add_corners(&made, p, 2 * corners);
    return made;
}

struct outline make_reuleaux(size_t corners) {
    narc_point p[MOST_CORNERS];
    for (size_t side = 0; side < 3; side++) {
        /* Around each corner of the triangle, a sixth of a turn from the next corner to the one after. */
        const double place = 2 * PI * (double)side / 3, first = place + PI - PI / 6;
        for (size_t k = 0; k < corners; k++) {
            const double angle = first + PI / 3 * (double)k / (double)corners;
            p[side * corners + k] = (narc_point){cos(place) / sqrt(3) + cos(angle), sin(place) / sqrt(3) + sin(angle)};
        }
    }
    struct outline made = make_outline("Reuleaux triangle");
    add_corners(&made, p, 3 * corners);
    return made;
}

struct outline make_star(void) {
    narc_point p[10];
    for (int k = 0; k < 10; k++) {
        const double radius = k % 2 ? 0.4 : 1 + 0.05 * k;
        p[k] = (narc_point){3 + radius * cos(0.2 * PI * k), 5 + radius * sin(0.2 * PI * k)};
    }
    /* A second contour, across the first, and a hole. */
    const narc_point bar[4] = {{2.2, 5.1}, {4.5, 5.2}, {4.4, 5.6}, {2.2, 5.5}};
    const narc_point hole[3] = {{2.9, 4.9}, {3, 5.05}, {3.1, 4.9}};
    struct outline made = make_outline("star");
    add_corners(&made, p, 10);
    add_corners(&made, bar, 4);
    add_corners(&made, hole, 3);
    return made;
}

struct outline make_random_points(struct test_random *random, size_t count) {
    struct outline made = make_outline("random points");
    const double squeeze = random_log_between(random, 0.1, 1);
    narc_point p[MOST_CORNERS];
    for (size_t k = 0; k < count; k++)
        p[k] = (narc_point){random_between(random, -1, 1), squeeze * random_between(random, -1, 1)};
    add_corners(&made, p, count);
    return made;
}

struct outline make_blob(struct test_random *random, size_t curves) {
    struct outline made = make_outline("blob");
    narc_point p[3 * 16 + 1];
    for (size_t k = 0; k < 3 * curves; k++) {
        const double angle = 2 * PI * (double)k / (double)(3 * curves), radius = random_between(random, 0.3, 1.5);
        p[k] = (narc_point){radius * cos(angle), radius * sin(angle)};
    }
    p[3 * curves] = p[0];
    for (size_t k = 0; k < curves; k++)
        add_cubic(&made, &p[3 * k]);
    return made;
}

/* Corners only. */
struct outline make_moved(const struct outline *of, double scale, double angle, bool mirror, narc_point by) {
    narc_point p[MOST_CORNERS];
    for (size_t k = 0; k < of->count; k++) {
        const double x = mirror ? -of->points[k].x : of->points[k].x, y = of->points[k].y;
        p[k] = (narc_point){scale * (cos(angle) * x - sin(angle) * y) + by.x,
                            scale * (sin(angle) * x + cos(angle) * y) + by.y};
    }
    struct outline made = make_outline(of->name);
    add_corners(&made, p, of->count);
    return made;
}

/* ---------------------------------------------------------------------------- fits */

narc_fit_result fit_outline(const struct outline *of, narc_fit_request request) {
    narc_fit_result fit;
    narc_error error = {0};
    const narc_status status = narc_fit_path(of->path, &request, &fit, &error);
    if (status != NARC_OK) {
        fail_msg("%s, family %d, goal %d, %zu arcs: %s, %s", of->name, (int)request.family, (int)request.goal,
                 request.arc_count, narc_status_name(status), error.message);
    }
    return fit;
}

narc_fit_result fit_shape(const struct outline *of, narc_fit_family family, narc_fit_goal goal, size_t arcs) {
    return fit_outline(of, (narc_fit_request){.arc_count = arcs, .family = family, .goal = goal});
}

double goal_value(const narc_fit_result *of, narc_fit_goal goal) {
    switch (goal) {
    case NARC_FIT_BOUND_AREA:
        return of->area;
    case NARC_FIT_BOUND_PERIMETER:
        return of->perimeter;
    case NARC_FIT_DIFFERENCE:
        return of->difference_area;
    default:
        return of->max_distance;
    }
}

narc_error refuse_fit(const narc_path *path, narc_fit_request request, narc_status expected, const char *words) {
    narc_fit_result fit, junk;
    narc_error error = {0};
    memset(&fit, 0x5a, sizeof fit);
    memset(&junk, 0x5a, sizeof junk);
    expect_error(narc_fit_path(path, &request, &fit, &error), expected, &error, words);
    assert_memory_equal(&fit, &junk, sizeof fit);
    return error;
}

narc_fit_result fit_and_check(const struct outline *of, narc_fit_request request) {
    const narc_fit_result fit = fit_outline(of, request);
    check_fit(of, &request, &fit);
    return fit;
}

/* ---------------------------------------------------------------------------- checks */

static size_t store(const narc_fit_result *fit, narc_arc out_arcs[NARC_MAX_ARCS]) {
    AUTO(narc_destroy_shapes_at) narc_shapes *shapes = NULL;
    narc_error error = {0};
    assert_int_equal(narc_create_shapes(NULL, &shapes), NARC_OK);
    expect_ok(narc_add_shape(shapes, fit->arcs, fit->arc_count, NULL, &error), &error);
    const size_t count = narc_get_arcs(shapes, 0, out_arcs);
    assert_int_equal(count, fit->arc_count);
    return count;
}

static void expect_near(const char *name, const char *what, real told, real expected, real limit) {
    if (!(fabsl(told - expected) <= limit)) {
        fail_msg("%s: %s is %.17Lg, expected %.17Lg, off by %.3Lg of %.3Lg", name, what, told, expected,
                 fabsl(told - expected), limit);
    }
}

/* The least room of a point inside the shape that a store makes of the fit, seen from `origin`. */
static real find_room(const struct outline *of, const narc_fit_result *fit) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = store(fit, arcs);
    AUTO(free_at) struct reference_hull points = reference_wrap(of->points, of->count, fit->origin);
    return reference_compare(arcs, count, &points).least;
}

void check_contained(const struct outline *of, const narc_fit_result *fit, const char *what) {
    const real least = find_room(of, fit);
    if (!(least > 0 && fit->clearance > 0 && fit->clearance <= least))
        fail_msg("%s, %s, %zu arcs: the least room is %.3Lg, told %.3g", of->name, what, fit->arc_count, least,
                 fit->clearance);
}

/* Through memory: GCC 12 may leave out a conversion there and back. */
static bool is_single(double value) {
    const volatile float rounded = (float)value;
    return (double)rounded == value;
}

static void check_family(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit) {
    narc_error error = {0};
    expect_ok(narc_validate_arcs(fit->arcs, fit->arc_count, &error), &error);
    assert_true(fit->arc_count >= 1);
    assert_true(request->arc_count == 0 || fit->arc_count <= request->arc_count);
    /* Rounding of centres to single precision leaves steps of 2^-24 of the size at junctions: no edges. */
    const size_t edges = reference_count_edges(fit->arcs, fit->arc_count, 1e-5 * fit->hull_perimeter);
    assert_int_equal(fit->edge_count, edges);
    for (size_t k = 0; k < fit->arc_count; k++) {
        const narc_arc *arc = &fit->arcs[k];
        assert_true(is_single(arc->center_x) && is_single(arc->center_y) && is_single(arc->radius));
    }
    if ((request->family == NARC_FIT_N_ARC || request->family == NARC_FIT_PAPER) && edges > 0)
        fail_msg("%s: an n-arc with %zu edges", of->name, edges);
}

/* Centres and radii of a result are rounded to single precision, each by up to 2^-25 of itself: neighbours, two centres
 * and two radii, then miss each other by up to 2 (sqrt(2) + 1) 2^-25 of the largest. What is between them is
 * anybody's. */
static real miss_of(const narc_fit_result *fit, real size) {
    real largest = size;
    for (size_t k = 0; k < fit->arc_count; k++)
        largest = fmaxl(largest, size + fit->arcs[k].radius);
    return 0x1p-22L * largest;
}

/* The hull is that of the flattened curves, which are off by up to the flatness told. */
static struct reference_hull wrap_outline(const struct outline *of, const narc_fit_request *request,
                                          const narc_fit_result *fit, const char *name) {
    AUTO(narc_release_contours) narc_contours contours;
    narc_error error = {0};
    expect_ok(narc_flatten_path(of->path, request->flatness, &contours, &error), &error);
    if (request->arc_count)
        expect_near(name, "flatness", fit->flatness, contours.flatness, 1e-3L * contours.flatness);
    return reference_wrap(contours.points, contours.point_count, fit->origin);
}

static void describe(char *out, size_t size, const struct outline *of, const narc_fit_request *request) {
    snprintf(out, size, "%s, family %d, goal %d, %zu arcs, tolerance %g", of->name, (int)request->family,
             (int)request->goal, request->arc_count, request->tolerance);
}

void check_fit(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit) {
    char name[160];
    describe(name, sizeof name, of, request);
    check_family(of, request, fit);
    AUTO(free_at) struct reference_hull hull = wrap_outline(of, request, fit, name);
    /* Corners of the hull that are closer than 1e-10 of its size are one to the library. */
    const real size = hull.radius, off = fit->flatness + 1e-9L * size;
    assert_true(fit->seconds >= 0);
    assert_true(of->curved || fit->flatness == 0);
    expect_near(name, "hull's perimeter", fit->hull_perimeter, hull.perimeter, 8 * off);
    expect_near(name, "hull's area", fit->hull_area, hull.area, hull.perimeter * off);
    const real area = reference_area(fit->arcs, fit->arc_count);
    expect_near(name, "area", fit->area, area, 1e-9L * area);
    const real perimeter = reference_perimeter(fit->arcs, fit->arc_count);
    expect_near(name, "perimeter", fit->perimeter, perimeter, 1e-9L * perimeter);
    const struct reference_range range = reference_compare(fit->arcs, fit->arc_count, &hull);
    expect_near(name, "largest distance", fit->max_distance, fmaxl(-range.least, range.largest),
                off + miss_of(fit, size));
    assert_true(request->arc_count || fit->max_distance + fit->flatness <= request->tolerance);
    if (request->goal <= NARC_FIT_BOUND_DISTANCE)
        check_contained(of, fit, name);
}

void check_fit_result(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit) {
    const bool bound = request->goal <= NARC_FIT_BOUND_DISTANCE;
    char name[160];
    check_fit(of, request, fit);
    describe(name, sizeof name, of, request);
    AUTO(free_at) struct reference_hull hull = wrap_outline(of, request, fit, name);
    const real size = hull.radius, miss = miss_of(fit, size), closure = miss * hull.perimeter;
    narc_mass mass;
    assert_true(narc_compute_mass(fit->arcs, fit->arc_count, &mass));
    for (size_t k = 0; k < fit->arc_count; k++)
        assert_true(request->family != NARC_FIT_POLYGON || fit->arcs[k].radius == 0);
    expect_near(name, "centroid x", mass.centroid_x, 0, miss);
    expect_near(name, "centroid y", mass.centroid_y, 0, miss);
    /* Ten thousand points here, a thousand there. */
    const real mean = reference_mean_distance(fit->arcs, fit->arc_count, &hull);
    expect_near(name, "mean distance", fit->mean_distance, mean, 1e-2L * mean + fit->flatness + 1e-6L * size);
    if (bound) {
        narc_arc arcs[NARC_MAX_ARCS];
        const size_t count = store(fit, arcs);
        const real least = reference_compare(arcs, count, &hull).least - fit->flatness;
        /* What is told is not much less than what there is, since a sector is known to 2^-21, which moves the end of an
         * edge or a corner by that part of its length. */
        expect_near(name, "clearance", fit->clearance, least, 2 * 0x1p-21L * 4 * size);
        /* Nothing of the hull is outside. */
        expect_near(name, "difference of a bound", fit->difference_area, fit->area - fit->hull_area,
                    closure + hull.perimeter * (fit->flatness + 1e-9L * size));
    } else {
        const real difference = reference_difference(fit->arcs, fit->arc_count, &hull, 4000);
        expect_near(name, "difference", fit->difference_area, difference,
                    2e-3L * difference + 1e-6L * hull.area + closure + hull.perimeter * fit->flatness);
    }
}
