/* SPDX-License-Identifier: MIT
 *
 * builders.c - circle, capsule, box, polygon and four arcs: closed formulas, and each documented failure.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "families.h"
#include "support.h"
#include "tests.h"

/* What a builder was given to write to, full of a pattern, so that a wrong write shows. */
struct output {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
};

static struct output make_output(void) {
    struct output out;
    memset(&out, 0x5a, sizeof out);
    return out;
}

static void expect_refused(const struct output *out, narc_status status, narc_status expected, const char *words) {
    struct output untouched = make_output();
    expect_error(status, expected, &out->error, words);
    assert_memory_equal(out->arcs, untouched.arcs, sizeof out->arcs);
    assert_memory_equal(&out->count, &untouched.count, sizeof out->count);
}

#define BUILD(out, function, ...)                                                                                      \
    expect_ok(function(__VA_ARGS__, (out)->arcs, &(out)->count, &(out)->error), &(out)->error)
#define REFUSED(out, STATUS, words, function, ...)                                                                     \
    expect_refused(out, function(__VA_ARGS__, (out)->arcs, &(out)->count, &(out)->error), NARC_ERROR_##STATUS, words)

/* Arcs are written up to a count, and not behind it. */
static void expect_nothing_behind(const struct output *out, size_t count) {
    const struct output untouched = make_output();
    assert_memory_equal(out->arcs + count, untouched.arcs, (NARC_MAX_ARCS - count) * sizeof *out->arcs);
}

static void expect_measures(const struct output *out, double area, double second_moment, double perimeter) {
    narc_mass mass;
    double length;
    expect_nothing_behind(out, out->count);
    assert_true(narc_compute_mass(out->arcs, out->count, &mass));
    assert_true(narc_compute_perimeter(out->arcs, out->count, &length));
    expect_near(mass.area, area, 1e-13 * area, "area");
    expect_near(mass.second_moment, second_moment, 1e-13 * second_moment, "second moment");
    expect_near(length, perimeter, 1e-13 * perimeter, "perimeter");
    expect_near(hypot(mass.centroid_x, mass.centroid_y), 0, 1e-14 * perimeter, "centroid");
}

TEST(builds_circles) {
    struct output out = make_output();
    BUILD(&out, narc_build_circle, 3);
    assert_int_equal(out.count, 1);
    assert_true(out.arcs[0].end - out.arcs[0].start == 2 * PI);
    expect_measures(&out, 9 * PI, 81 * PI / 2, 6 * PI);
}

TEST(builds_capsules) {
    for (double length = 0; length < 9; length += 2) {
        struct output out = make_output();
        double r = 1.5, l = length;
        BUILD(&out, narc_build_capsule, l, r);
        assert_int_equal(out.count, 2);
        /* A rectangle l by 2r, and two half discs, whose centroids are 4r / (3 pi) from their middles. */
        double half = PI * r * r / 2, c = 4 * r / (3 * PI);
        double moment = l * 2 * r * (l * l + 4 * r * r) / 12 +
                        2 * (half * r * r / 2 - half * c * c + half * (c + l / 2) * (c + l / 2));
        expect_measures(&out, PI * r * r + 2 * r * l, moment, 2 * PI * r + 2 * l);
    }
}

TEST(builds_boxes) {
    const double w = 3, h = 2, radii[] = {0, 0.25, 0.7, 1};
    for (size_t k = 0; k < 4; k++) {
        struct output out = make_output();
        double r = radii[k];
        BUILD(&out, narc_build_box, w, h, r);
        assert_int_equal(out.count, 4);
        /* Of a corner's square, r by r with its inner corner at (x, y), the quarter disc stays. */
        double x = w / 2 - r, y = h / 2 - r, c = 4 * r / (3 * PI), quarter = PI * r * r / 4;
        double corner = quarter * r * r / 2 + 2 * quarter * c * (x + y) + quarter * (x * x + y * y);
        double square = (pow(x + r, 3) - pow(x, 3)) / 3 * r + (pow(y + r, 3) - pow(y, 3)) / 3 * r;
        double moment = w * h * (w * w + h * h) / 12 - 4 * (square - corner);
        expect_measures(&out, w * h - (4 - PI) * r * r, moment, 2 * (w + h) - (8 - 2 * PI) * r);
        narc_aabb box;
        assert_true(narc_compute_aabb(out.arcs, out.count, 0, &box));
        assert_true(box.min_x == -1.5 && box.max_x == 1.5 && box.min_y == -1 && box.max_y == 1);
    }
}

/* A regular polygon with n corners on a circle of radius R, and rounded corners. */
TEST(builds_polygons) {
    for (size_t n = 3; n <= NARC_MAX_ARCS; n++) {
        narc_point points[NARC_MAX_ARCS];
        double turn = 2 * PI / (double)n, apothem = 2 * cos(turn / 2), side = 4 * sin(turn / 2), count = (double)n;
        for (size_t i = 0; i < n; i++)
            points[i] = (narc_point){2 * cos(0.3 + turn * (double)i), 2 * sin(0.3 + turn * (double)i)};
        struct output out = make_output();
        BUILD(&out, narc_build_polygon, points, n, 0);
        assert_int_equal(out.count, n);
        expect_measures(&out, count * side * apothem / 2,
                        count * side * apothem / 2 * (apothem * apothem / 2 + side * side / 24), count * side);
        for (size_t i = 0; i < n; i++) {
            assert_true(out.arcs[i].center_x == points[i].x && out.arcs[i].center_y == points[i].y);
            assert_true(out.arcs[i].radius == 0);
        }
        /* Rounded: each corner loses two triangles and keeps a sector. */
        double r = apothem * 0.6, cut = tan(turn / 2);
        BUILD(&out, narc_build_polygon, points, n, r);
        narc_mass mass;
        double length;
        assert_true(narc_compute_mass(out.arcs, out.count, &mass));
        assert_true(narc_compute_perimeter(out.arcs, out.count, &length));
        expect_near(mass.area, count * side * apothem / 2 - count * r * r * (cut - turn / 2), 1e-13 * mass.area,
                    "area");
        expect_near(length, count * (side - 2 * r * cut) + 2 * PI * r, 1e-13 * length, "perimeter");
        /* As round as it gets: the inscribed circle. */
        BUILD(&out, narc_build_polygon, points, n, apothem);
        expect_measures(&out, PI * apothem * apothem, PI * pow(apothem, 4) / 2, 2 * PI * apothem);
    }
}

TEST(rounded_polygon_stays_inside) {
    struct test_random random = test_random_named("rounded polygons");
    for (size_t k = 0; k < test_trials(500); k++) {
        narc_point points[16];
        size_t n = 3 + random_below(&random, 14);
        for (size_t i = 0; i < n; i++) {
            double angle = 2 * PI * ((double)i + 0.8 * random_unit(&random)) / (double)n;
            points[i] = (narc_point){1 + 3 * cos(angle), sin(angle) - 2};
        }
        struct output out = make_output();
        narc_status status = narc_build_polygon(points, n, 0.02 / (double)n, out.arcs, &out.count, &out.error);
        if (status != NARC_OK) {
            /* The largest radius that fits is told, and fits. */
            const char *told = strstr(out.error.message, "fits it is ");
            expect_error(status, NARC_ERROR_RADIUS, &out.error, "side ");
            assert_non_null(told);
            double radius = strtod(told + strlen("fits it is "), NULL);
            assert_true(radius < 0.02 / (double)n);
            continue;
        }
        for (size_t i = 0; i < n; i++) {
            /* Side i: nothing outside it, and the shape lies on it. */
            double x = points[(i + 1) % n].y - points[i].y, y = points[i].x - points[(i + 1) % n].x, l = hypot(x, y);
            narc_point support;
            assert_true(narc_find_support(out.arcs, out.count, x, y, &support, NULL));
            expect_near((x * (support.x - points[i].x) + y * (support.y - points[i].y)) / l, 0, 1e-13, "height");
        }
    }
}

TEST(builds_four_arcs) {
    struct test_random random = test_random_named("four arcs");
    for (size_t k = 0; k < test_trials(1000); k++) {
        narc_four_arc f = {random_between(&random, 3, 6), random_between(&random, 3, 6), 0, 0, 0};
        double sum = f.radius_low + f.radius_high;
        f.distance = random_between(&random, 0.7, 0.95) * sum;
        double most = (sum - f.distance) / 2;
        f.radius_left = random_below(&random, 4) ? random_between(&random, 0, 0.95) * most : 0;
        f.radius_right = random_below(&random, 4) ? random_between(&random, 0, 0.95) * most : 0;
        struct output out = make_output();
        BUILD(&out, narc_build_four_arc, &f);
        assert_int_equal(out.count, 4);
        assert_true(out.arcs[1].radius == f.radius_high && out.arcs[1].center_y == -f.distance / 2);
        assert_true(out.arcs[3].radius == f.radius_low && out.arcs[3].center_y == f.distance / 2);
        assert_true(out.arcs[0].radius == f.radius_right && out.arcs[0].center_x > 0);
        assert_true(out.arcs[2].radius == f.radius_left && out.arcs[2].center_x < 0);
        for (size_t tip = 0; tip < 4; tip += 2) { /* both touch both large circles from inside */
            const narc_arc *arc = &out.arcs[tip];
            expect_near(hypot(arc->center_x, arc->center_y - f.distance / 2), f.radius_low - arc->radius, 1e-12, "tip");
            expect_near(hypot(arc->center_x, arc->center_y + f.distance / 2), f.radius_high - arc->radius, 1e-12,
                        "tip");
        }
        narc_aabb box;
        assert_true(narc_compute_aabb(out.arcs, 4, 0, &box));
        expect_near(box.max_y, f.radius_high - f.distance / 2, 1e-12, "top");
        expect_near(box.min_y, f.distance / 2 - f.radius_low, 1e-12, "bottom");
    }
    /* A sharp lens of equal circles: two segments of half angle a. */
    struct output out = make_output();
    BUILD(&out, narc_build_four_arc, &(narc_four_arc){5, 5, 8, 0, 0});
    narc_mass mass;
    assert_true(narc_compute_mass(out.arcs, 4, &mass));
    double a = acos(0.8);
    expect_near(mass.area, 25 * (2 * a - sin(2 * a)), 1e-13, "area of a lens");
}

TEST(refuses_bad_lengths) {
    const struct {
        double value;
        narc_status circle;
    } cases[] = {{0, NARC_ERROR_SIZE},         {-1, NARC_ERROR_SIZE},
                 {NAN, NARC_ERROR_NOT_FINITE}, {INFINITY, NARC_ERROR_NOT_FINITE},
                 {1e-10, NARC_ERROR_SIZE},     {1e10, NARC_ERROR_SIZE}};
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k++) {
        struct output out = make_output();
        double v = cases[k].value;
        narc_status status = cases[k].circle;
        expect_refused(&out, narc_build_circle(v, out.arcs, &out.count, &out.error), status, "radius is");
        if (v == 1e-10)
            continue; /* thin, but not small */
        expect_refused(&out, narc_build_capsule(1, v, out.arcs, &out.count, &out.error), status, "radius is");
        expect_refused(&out, narc_build_box(v, 1, 0, out.arcs, &out.count, &out.error), status,
                       v == 1e10 ? "" : "width");
        expect_refused(&out, narc_build_box(1, v, 0, out.arcs, &out.count, &out.error), status,
                       v == 1e10 ? "" : "height is");
        if (v != 0) {
            expect_refused(&out, narc_build_capsule(v, 1, out.arcs, &out.count, &out.error), status,
                           v == 1e10 ? "" : "length is");
        }
    }
}

TEST(refuses_what_does_not_fit) {
    const narc_point square[4] = {{0, 0}, {2, 0}, {2, 1}, {0, 1}}, clockwise[4] = {{0, 0}, {0, 1}, {2, 1}, {2, 0}};
    const narc_point dent[5] = {{0, 0}, {2, 0}, {1, 0.5}, {2, 1}, {0, 1}}, flat[4] = {{0, 0}, {1, 0}, {2, 0}, {1, 1}};
    const narc_point twice[5] = {{0, 0}, {2, 0}, {2, 1}, {2, 1}, {0, 1}}, nan[3] = {{0, 0}, {1, NAN}, {0, 1}};
    narc_point star[5];
    for (size_t i = 0; i < 5; i++)
        star[i] = (narc_point){cos(0.8 * PI * (double)i), sin(0.8 * PI * (double)i)};
    struct output o = make_output();
    narc_arc *arcs = o.arcs;
    size_t *count = &o.count;
    narc_error *error = &o.error;
    REFUSED(&o, RADIUS, "half the shorter side, 0.5", narc_build_box, 2, 1, 0.6);
    REFUSED(&o, RADIUS, "radius is -0.1", narc_build_box, 2, 1, -0.1);
    REFUSED(&o, ARGUMENT, "points", narc_build_polygon, NULL, 4, 0);
    REFUSED(&o, COUNT, "2 points", narc_build_polygon, square, 2, 0);
    REFUSED(&o, COUNT, "65 points", narc_build_polygon, square, 65, 0);
    REFUSED(&o, NOT_FINITE, "point 1", narc_build_polygon, nan, 3, 0);
    REFUSED(&o, NOT_FINITE, "radius", narc_build_polygon, square, 4, NAN);
    REFUSED(&o, NOT_CONVEX, "point 0", narc_build_polygon, clockwise, 4, 0);
    REFUSED(&o, NOT_CONVEX, "point 2", narc_build_polygon, dent, 5, 0);
    assert_null(strstr(error->message, "reverse")); /* it is no more convex the other way round */
    REFUSED(&o, NOT_CONVEX, "point 1", narc_build_polygon, flat, 4, 0);
    REFUSED(&o, NOT_CONVEX, "not once", narc_build_polygon, star, 5, 0);
    REFUSED(&o, SIZE, "side 2", narc_build_polygon, twice, 5, 0);
    REFUSED(&o, RADIUS, "side 1: radius is 0.6, the largest that fits it is 0.5", narc_build_polygon, square, 4, 0.6);
    assert_int_equal(error->index, 1);
    REFUSED(&o, SIZE, "overlap only below 2", narc_build_four_arc, &(narc_four_arc){1, 1, 2, 0, 0});
    REFUSED(&o, SIZE, "contains the other", narc_build_four_arc, &(narc_four_arc){3, 1, 2, 0, 0});
    REFUSED(&o, SIZE, "radius_high is 0", narc_build_four_arc, &(narc_four_arc){3, 0, 2, 0, 0});
    REFUSED(&o, RADIUS, "radius_left is 1", narc_build_four_arc, &(narc_four_arc){5, 5, 8, 1, 0});
    REFUSED(&o, RADIUS, "radius_right is 1.5", narc_build_four_arc, &(narc_four_arc){5, 5, 8, 0, 1.5});
    REFUSED(&o, RADIUS, "radius_right is -1", narc_build_four_arc, &(narc_four_arc){5, 5, 8, 0, -1});
    REFUSED(&o, NOT_FINITE, "radius_low", narc_build_four_arc, &(narc_four_arc){NAN, 5, 8, 0, 0});
    /* Most of the small circle, with more than half a turn. */
    REFUSED(&o, SWEEP, "arc 1", narc_build_four_arc, &(narc_four_arc){5, 1, 4.5, 0, 0});
    assert_int_equal(narc_build_circle(1, NULL, count, error), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_build_circle(1, arcs, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_build_capsule(1, 1, arcs, NULL, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_build_box(1, 1, 0, NULL, count, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_build_polygon(square, 4, 0, NULL, count, NULL), NARC_ERROR_ARGUMENT);
    assert_int_equal(narc_build_four_arc(&(narc_four_arc){5, 5, 8, 0, 0}, NULL, count, NULL), NARC_ERROR_ARGUMENT);
    REFUSED(&o, ARGUMENT, "form", narc_build_four_arc, NULL);
    REFUSED(&o, ARGUMENT, "from", narc_build_segment, NULL, &square[0], 1);
    REFUSED(&o, ARGUMENT, "to", narc_build_segment, &square[0], NULL, 1);
}

/* The polygon with corners at equal angles, whose measures are checked above. */
TEST(builds_regular_polygons) {
    for (size_t n = 3; n <= NARC_MAX_ARCS; n++) {
        const double turn = 2 * PI / (double)n, radius = 1.2 * cos(turn / 2);
        for (int rounded = 0; rounded < 2; rounded++) {
            struct output out = make_output(), polygon = make_output();
            narc_point points[NARC_MAX_ARCS];
            for (size_t i = 0; i < n; i++)
                points[i] = (narc_point){3 * cos(turn * (double)i), 3 * sin(turn * (double)i)};
            BUILD(&out, narc_build_regular_polygon, n, 3, rounded ? radius : 0);
            BUILD(&polygon, narc_build_polygon, points, n, rounded ? radius : 0);
            assert_int_equal(out.count, n);
            assert_true(rounded || (out.arcs[0].center_x == 3 && out.arcs[0].center_y == 0));
            for (size_t i = 0; i < n; i++) {
                expect_near(out.arcs[i].center_x, polygon.arcs[i].center_x, 1e-13, "centre x");
                expect_near(out.arcs[i].center_y, polygon.arcs[i].center_y, 1e-13, "centre y");
                assert_true(out.arcs[i].radius == polygon.arcs[i].radius);
            }
        }
    }
    struct output o = make_output();
    size_t *count = &o.count;
    narc_error *error = &o.error;
    REFUSED(&o, COUNT, "2 corners", narc_build_regular_polygon, 2, 1, 0);
    REFUSED(&o, COUNT, "65 corners", narc_build_regular_polygon, 65, 1, 0);
    REFUSED(&o, SIZE, "circumradius is 0", narc_build_regular_polygon, 5, 0, 0);
    REFUSED(&o, NOT_FINITE, "circumradius", narc_build_regular_polygon, 5, NAN, 0);
    REFUSED(&o, RADIUS, "radius is 1", narc_build_regular_polygon, 4, 1, 1);
    REFUSED(&o, RADIUS, "radius is -1", narc_build_regular_polygon, 4, 1, -1);
    assert_int_equal(narc_build_regular_polygon(4, 1, 0, NULL, count, error), NARC_ERROR_ARGUMENT);
}

/* By how much the support function of a smooth outline, symmetric to both axes, differs from an ellipse's, at most:
 * sampled. Each normal of the first quadrant is held by one arc. */
static double measure_distance(const narc_arc *arcs, size_t count, double half_x, double half_y) {
    enum { SAMPLES = 1000 };
    double largest = 0;
    for (int k = 0; k <= SAMPLES; k++) {
        const double angle = atan2(sqrt(half_x) * sin(PI / 2 * k / SAMPLES), sqrt(half_y) * cos(PI / 2 * k / SAMPLES)),
                     x = cos(angle), y = sin(angle);
        double height = -INFINITY;
        for (size_t i = 0; i < count; i++)
            if (arcs[i].start <= angle && angle <= arcs[i].end)
                height = arcs[i].center_x * x + arcs[i].center_y * y + arcs[i].radius;
        largest = fmax(largest, fabs(height - hypot(half_x * x, half_y * y)));
    }
    return largest;
}

/* The same quadrant with other junctions and radii, closed by moving the centres. */
static double measure_changed(const narc_arc *arcs, size_t count, double half_x, double half_y,
                              struct test_random *random, double amount) {
    const size_t last = count / 4;
    narc_arc changed[NARC_MAX_ARCS];
    for (size_t k = 0; k <= last; k++) {
        changed[k] = arcs[k];
        changed[k].radius *= 1 + amount * random_between(random, -1, 1);
        changed[k].start += k > 0 ? amount * random_between(random, -1, 1) : 0;
    }
    for (size_t k = 0; k < last; k++)
        changed[k].end = changed[k + 1].start;
    changed[0].center_x = changed[0].center_y = 0;
    for (size_t k = 1; k <= last; k++) {
        const double step = changed[k - 1].radius - changed[k].radius;
        changed[k].center_x = changed[k - 1].center_x + step * cos(changed[k].start);
        changed[k].center_y = changed[k - 1].center_y + step * sin(changed[k].start);
    }
    const double by = changed[last].center_x;
    for (size_t k = 0; k <= last; k++)
        changed[k].center_x -= by;
    return measure_distance(changed, last + 1, half_x, half_y);
}

/* Smooth, as near as it says, and no small change brings it nearer. */
TEST(builds_ellipses) {
    const double ratio[] = {1.001, 1.2, 2, 4.5, 11, 35};
    struct test_random random = test_random_named("ellipses");
    for (size_t r = 0; r < 2 * sizeof ratio / sizeof *ratio; r++) {
        const double long_half = 3 * ratio[r / 2], half_x = r % 2 ? 3 : long_half, half_y = r % 2 ? long_half : 3;
        double last = INFINITY;
        for (size_t n = 4; n <= NARC_MAX_ARCS; n += n < 16 ? 4 : 16) {
            struct output out = make_output();
            double distance;
            expect_ok(narc_build_ellipse(half_x, half_y, n, out.arcs, &out.count, &distance, &out.error), &out.error);
            assert_int_equal(out.count, n);
            for (size_t i = 0; i < n; i++) {
                const narc_arc *a = &out.arcs[i], *b = &out.arcs[(i + 1) % n];
                const double x = a->center_x + a->radius * cos(a->end) - b->center_x - b->radius * cos(b->start);
                const double y = a->center_y + a->radius * sin(a->end) - b->center_y - b->radius * sin(b->start);
                expect_near(hypot(x, y), 0, 1e-11 * long_half, "gap at a junction");
                const narc_arc *across = &out.arcs[(n - i) % n]; /* mirrored at the x axis */
                expect_near(across->center_y, -a->center_y, 1e-11 * long_half, "symmetry");
            }
            const double measured = measure_distance(out.arcs, n, half_x, half_y);
            assert_true(measured <= distance * (1 + 1e-9) + 1e-14 * long_half);
            assert_true(measured >= distance * 0.999);
            assert_true(distance < last || ratio[r / 2] > 12);
            last = distance;
            if (ratio[r / 2] > 12 && n > 16)
                continue; /* perhaps not the nearest */
            for (size_t k = 0; k < test_trials(5) && n <= 12; k++)
                for (double amount = 1e-2; amount > 1e-5; amount /= 8)
                    assert_true(measure_changed(out.arcs, n, half_x, half_y, &random, amount) > distance * 0.9995);
        }
    }
    struct output o = make_output();
    narc_arc *arcs = o.arcs;
    size_t *count = &o.count;
    narc_error *error = &o.error;
    double distance = 7;
    expect_ok(narc_build_ellipse(2, 2.000001, 8, arcs, count, &distance, error), error);
    assert_int_equal(*count, 1);
    expect_near(distance, 5e-7, 1e-12, "distance");
    o = make_output();
    expect_refused(&o, narc_build_ellipse(2, 1, 6, arcs, count, NULL, error), NARC_ERROR_COUNT, "arc_count is 6");
    expect_refused(&o, narc_build_ellipse(2, 1, 68, arcs, count, NULL, error), NARC_ERROR_COUNT, "arc_count is 68");
    expect_refused(&o, narc_build_ellipse(0, 1, 8, arcs, count, NULL, error), NARC_ERROR_SIZE, "half_x is 0");
    expect_refused(&o, narc_build_ellipse(1, NAN, 8, arcs, count, NULL, error), NARC_ERROR_NOT_FINITE, "half_y is");
    expect_refused(&o, narc_build_ellipse(100, 1, 32, arcs, count, NULL, error), NARC_ERROR_RADIUS, "");
    expect_refused(&o, narc_build_ellipse(1, 129, 8, arcs, count, NULL, error), NARC_ERROR_RADIUS, "is too thin");
    expect_refused(&o, narc_build_ellipse(1e-151, 1e-151, 8, arcs, count, NULL, error), NARC_ERROR_SIZE, "1e-150");
    expect_refused(&o, narc_build_ellipse(1e-151, 1e-149, 8, arcs, count, NULL, error), NARC_ERROR_SIZE, "1e-150");
    expect_refused(&o, narc_build_ellipse(1e151, 1e151, 8, arcs, count, NULL, error), NARC_ERROR_SIZE, "1e150");
    assert_int_equal(narc_build_ellipse(2, 1, 8, NULL, count, NULL, error), NARC_ERROR_ARGUMENT);
}

/* What narc_build_ellipse() says of the number of arcs. */
TEST(more_arcs_are_nearer_to_ellipses) {
    const double ratio[] = {1.01, 1.5, 3, 7, 12};
    for (size_t r = 0; r < sizeof ratio / sizeof *ratio; r++) {
        double last = 0, least = 4.15;
        for (size_t n = 4; n <= NARC_MAX_ARCS; n *= 2) {
            struct output o = make_output();
            double distance;
            expect_ok(narc_build_ellipse(ratio[r], 1, n, o.arcs, &o.count, &distance, &o.error), &o.error);
            assert_true(n == 4 || (last / distance > least && last / distance < 7.35));
            least = n == 4 ? least : last / distance;
            last = distance;
        }
    }
}

/* Random rings: convex ones, stars in either direction; each has an n-arc with as many arcs. */
TEST(builds_rings) {
    struct test_random random = test_random_named("rings");
    for (size_t k = 0; k < test_trials(1000); k++) {
        const size_t n = 3 + random_below(&random, 14);
        const bool backwards = random_below(&random, 2), convex = random_below(&random, 2);
        narc_point points[16];
        for (size_t i = 0; i < n; i++) {
            const double angle = 2 * PI * ((double)i + 0.8 * random_unit(&random)) / (double)n;
            const double r = convex ? 1 : random_between(&random, 0.4, 1);
            points[backwards ? n - 1 - i : i] = (narc_point){4 + 3 * r * cos(angle), r * sin(angle) - 2};
        }
        struct output out = make_output();
        BUILD(&out, narc_build_ring, points, n);
        assert_int_equal(out.count, n);
        expect_ok(narc_validate_arcs(out.arcs, n, &out.error), &out.error);
        /* It is smooth. */
        for (size_t i = 0; i < n; i++) {
            const narc_arc *a = &out.arcs[i], *b = &out.arcs[(i + 1) % n];
            const double x = a->center_x + a->radius * cos(a->end) - b->center_x - b->radius * cos(b->start);
            const double y = a->center_y + a->radius * sin(a->end) - b->center_y - b->radius * sin(b->start);
            expect_near(hypot(x, y), 0, 1e-9, "gap at a junction");
        }
    }
    const narc_point bow[4] = {{0, 0}, {1, 1}, {1, 0}, {0, 1}}, line[3] = {{0, 0}, {1, 0}, {2, 0}};
    struct output o = make_output();
    REFUSED(&o, NOT_SIMPLE, "cross or touch", narc_build_ring, bow, 4);
    REFUSED(&o, NOT_SIMPLE, "", narc_build_ring, line, 3);
    REFUSED(&o, COUNT, "2 points", narc_build_ring, bow, 2);
    REFUSED(&o, ARGUMENT, "polygon is NULL", narc_build_ring, NULL, 4);
    assert_int_equal(narc_build_ring(bow, 4, NULL, &o.count, &o.error), NARC_ERROR_ARGUMENT);
}

/* Heights of shapes of all kinds: of the mirror image along (-x, y), of the centred one less by what it moved. */
TEST(moves_arcs) {
    struct test_random random = test_random_named("moved arcs");
    for (size_t k = 0; k < test_trials(20) * FAMILY_COUNT; k++) {
        const struct shape shape = make_shape(&random, (enum family)(k % FAMILY_COUNT));
        struct output mirror = make_output(), centered = make_output();
        narc_point centroid, a, b, c;
        narc_mass mass, moved;
        expect_ok(narc_mirror_arcs(shape.arcs, shape.count, mirror.arcs, &mirror.error), &mirror.error);
        expect_ok(narc_validate_arcs(mirror.arcs, shape.count, &mirror.error), &mirror.error);
        expect_ok(narc_center_arcs(shape.arcs, shape.count, centered.arcs, &centroid, &centered.error),
                  &centered.error);
        assert_true(narc_compute_mass(shape.arcs, shape.count, &mass));
        assert_true(narc_compute_mass(centered.arcs, shape.count, &moved));
        assert_true(centroid.x == mass.centroid_x && centroid.y == mass.centroid_y);
        const double reach = 1 + hypot(centroid.x, centroid.y),
                     tolerance = 1e-9 * reach; /* some roundings of angles and large radii */
        expect_near(hypot(moved.centroid_x, moved.centroid_y), 0, tolerance, "centroid");
        assert_true(mirror.arcs[0].radius == shape.arcs[shape.count - 1].radius);
        expect_nothing_behind(&mirror, shape.count);
        expect_nothing_behind(&centered, shape.count);
        for (int i = 0; i < 50; i++) {
            const double angle = random_between(&random, -PI, PI), x = cos(angle), y = sin(angle);
            assert_true(narc_find_support(shape.arcs, shape.count, x, y, &a, NULL));
            assert_true(narc_find_support(mirror.arcs, shape.count, -x, y, &b, NULL));
            assert_true(narc_find_support(centered.arcs, shape.count, x, y, &c, NULL));
            expect_near(b.y * y - b.x * x, a.x * x + a.y * y, tolerance, "height of the mirror image");
            expect_near(c.x * x + c.y * y, (a.x - centroid.x) * x + (a.y - centroid.y) * y, tolerance, "height");
        }
        /* In place; and the mirror image of the mirror image. */
        expect_ok(narc_mirror_arcs(mirror.arcs, shape.count, mirror.arcs, NULL), NULL);
        for (size_t i = 0; i < shape.count; i++)
            assert_true(mirror.arcs[i].center_x == shape.arcs[i].center_x);
        expect_ok(narc_center_arcs(centered.arcs, shape.count, centered.arcs, NULL, NULL), NULL);
    }
    struct output o = make_output();
    narc_arc broken = {0, 0, -1, -PI, PI};
    expect_refused(&o, narc_center_arcs(&broken, 1, o.arcs, NULL, &o.error), NARC_ERROR_RADIUS, "radius is -1");
    expect_refused(&o, narc_mirror_arcs(NULL, 1, o.arcs, &o.error), NARC_ERROR_ARGUMENT, "arcs is NULL");
    expect_refused(&o, narc_mirror_arcs(&broken, 1, NULL, &o.error), NARC_ERROR_ARGUMENT, "out_arcs is NULL");
    expect_refused(&o, narc_mirror_arcs(&broken, 65, o.arcs, &o.error), NARC_ERROR_COUNT, "65 arcs");
}

/* A segment, and with a radius the capsule between its ends, anywhere and in any direction. */
TEST(builds_segments) {
    struct test_random random = test_random_named("segments");
    for (size_t k = 0; k < test_trials(200); k++) {
        const narc_point from = {random_between(&random, -3, 3), random_between(&random, -3, 3)};
        const narc_point to = {k % 3 ? random_between(&random, -3, 3) : from.x, random_between(&random, -3, 3)};
        const double r = k % 2 ? random_between(&random, 0.1, 2) : 0, l = hypot(to.x - from.x, to.y - from.y);
        struct output out = make_output();
        narc_mass mass;
        double length = 0, distance;
        BUILD(&out, narc_build_segment, &from, &to, r);
        assert_int_equal(out.count, 2);
        assert_true(out.arcs[0].center_x == to.x && out.arcs[1].center_y == from.y && out.arcs[0].radius == r);
        assert_true(narc_compute_mass(out.arcs, 2, &mass) && narc_compute_perimeter(out.arcs, 2, &length));
        expect_near(mass.area, PI * r * r + 2 * r * l, 1e-12, "area");
        expect_near(length, 2 * PI * r + 2 * l, 1e-12, "perimeter");
        expect_near(mass.centroid_x, (from.x + to.x) / 2, 1e-12, "centroid x");
        expect_near(mass.centroid_y, (from.y + to.y) / 2, 1e-12, "centroid y");
        const double t = random_unit(&random), side = k % 4 < 2 ? 1 : -1, up = random_between(&random, 0.1, 1);
        const narc_point p = {from.x + t * (to.x - from.x) - side * up * (to.y - from.y) / l,
                              from.y + t * (to.y - from.y) + side * up * (to.x - from.x) / l};
        assert_true(narc_compute_distance(out.arcs, 2, &p, &distance));
        if (up > r)
            expect_near(distance, up - r, 1e-12, "distance");
    }
    struct output o = make_output();
    const narc_point p = {1, 2}, q = {NAN, 0};
    REFUSED(&o, SIZE, "radius is 0", narc_build_segment, &p, &p, 0);
    REFUSED(&o, NOT_FINITE, "point 1", narc_build_segment, &p, &q, 0);
    REFUSED(&o, RADIUS, "radius is -1", narc_build_segment, &p, &(narc_point){0, 0}, -1);
    BUILD(&o, narc_build_segment, &p, &p, 2); /* a disc */
    narc_mass disc;
    assert_true(narc_compute_mass(o.arcs, o.count, &disc));
    expect_near(disc.area, 4 * PI, 1e-12, "area");
}

/* Steiner's formula: area + perimeter r + pi r^2; and the heights are those of the polygon and r more. */
TEST(builds_skin_polygons) {
    const narc_point box[4] = {{-1, -0.5}, {2, -0.5}, {2, 0.5}, {-1, 0.5}}, kite[3] = {{0, 0}, {2, 0.25}, {0.5, 1}};
    const narc_point *const polygons[2] = {box, kite};
    for (int k = 0; k < 2; k++) {
        for (double r = 0; r < 8; r = 2 * r + 0.25) {
            const size_t n = k ? 3 : 4;
            struct output sharp = make_output(), skin = make_output();
            double area, length = 0;
            narc_mass mass;
            BUILD(&sharp, narc_build_polygon, polygons[k], n, 0);
            BUILD(&skin, narc_build_skin_polygon, polygons[k], n, r);
            assert_int_equal(skin.count, n);
            assert_true(narc_compute_mass(sharp.arcs, n, &mass) && narc_compute_perimeter(sharp.arcs, n, &length));
            area = mass.area;
            assert_true(narc_compute_mass(skin.arcs, n, &mass));
            expect_near(mass.area, area + length * r + PI * r * r, 1e-13 * mass.area, "area");
            for (size_t i = 0; i < n; i++) {
                assert_true(skin.arcs[i].center_x == polygons[k][i].x && skin.arcs[i].center_y == polygons[k][i].y);
                assert_true(skin.arcs[i].radius == r);
            }
            for (double angle = 0; angle < 6; angle += 0.1) {
                narc_point a, b;
                const double x = cos(angle), y = sin(angle);
                assert_true(narc_find_support(sharp.arcs, n, x, y, &a, NULL));
                assert_true(narc_find_support(skin.arcs, n, x, y, &b, NULL));
                expect_near(b.x * x + b.y * y, a.x * x + a.y * y + r, 1e-13, "height");
            }
        }
    }
    struct output o = make_output();
    const narc_point clockwise[3] = {{0, 0}, {0, 1}, {1, 0}};
    REFUSED(&o, NOT_CONVEX, "clockwise: reverse the points", narc_build_polygon, clockwise, 3, 0);
    REFUSED(&o, NOT_CONVEX, "clockwise: reverse the points", narc_build_skin_polygon, clockwise, 3, 1);
    REFUSED(&o, RADIUS, "-1", narc_build_skin_polygon, box, 4, -1);
    REFUSED(&o, COUNT, "2 points", narc_build_skin_polygon, box, 2, 1);
    REFUSED(&o, ARGUMENT, "NULL", narc_build_skin_polygon, NULL, 3, 1);
}

static double distance_to_side(narc_point p, narc_point a, narc_point b) {
    const double x = b.x - a.x, y = b.y - a.y, t = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    const double along = fmin(1, fmax(0, t));
    return hypot(p.x - a.x - along * x, p.y - a.y - along * y);
}

/* Corners are left out, none is moved, and none that is left out is further away than the tolerance. */
TEST(welds_polygons) {
    const narc_point box[7] = {{0, 0}, {1, 0}, {2, 0}, {2, 1e-6}, {2, 1}, {1, 1 + 1e-6}, {0, 1}};
    narc_point left[NARC_MAX_ARCS];
    size_t count;
    narc_error error;
    struct output o = make_output();
    REFUSED(&o, NOT_CONVEX, "point 1", narc_build_polygon, box, 7, 0);
    expect_ok(narc_weld_polygon(box, 7, 1e-5, left, &count, &error), &error);
    assert_int_equal(count, 4);
    assert_true(left[0].x == 0 && left[1].x == 2 && left[2].y == 1 && left[3].x == 0 && left[3].y == 1);
    BUILD(&o, narc_build_polygon, left, count, 0);
    expect_ok(narc_weld_polygon(box, 7, 0, left, &count, &error), &error);
    assert_int_equal(count, 5); /* without those that lie on a line */
    struct test_random random = test_random_named("welding");
    for (size_t k = 0; k < test_trials(300); k++) {
        const size_t n = 8 + random_below(&random, NARC_MAX_ARCS - 7);
        const double tolerance = random_log_between(&random, 1e-4, 0.3);
        narc_point points[NARC_MAX_ARCS];
        size_t next = 0;
        for (size_t i = 0; i < n; i++) {
            const double angle = 2 * PI * ((double)i + 0.4 * random_unit(&random)) / (double)n;
            points[i] = (narc_point){2 * cos(angle), sin(angle)};
        }
        expect_ok(narc_weld_polygon(points, n, tolerance, left, &count, &error), &error);
        assert_in_range(count, 3, n);
        for (size_t i = 0; i < n; i++) {
            if (next < count && points[i].x == left[next].x && points[i].y == left[next].y) {
                next++;
                continue;
            }
            double least = INFINITY;
            for (size_t j = 0; j < count; j++)
                least = fmin(least, distance_to_side(points[i], left[j], left[(j + 1) % count]));
            assert_true(least <= tolerance * (1 + 1e-12));
        }
        assert_int_equal(next, count); /* in their order */
        size_t in_place;
        expect_ok(narc_weld_polygon(points, n, tolerance, points, &in_place, &error), &error);
        assert_int_equal(in_place, count);
        assert_memory_equal(points, left, count * sizeof *left);
    }
    const narc_point flat[4] = {{0, 0}, {1, -1e-7}, {2, 0}, {1, 1e-7}};
    const narc_point nearly[4] = {{0, 0}, {1, -1e-4}, {2, 0}, {1, 1}}; /* a triangle is left */
    expect_ok(narc_weld_polygon(nearly, 4, 1e-3, left, &count, &error), &error);
    assert_int_equal(count, 3);
    expect_error(narc_weld_polygon(flat, 4, 1e-3, left, &count, &error), NARC_ERROR_COUNT, &error, "fewer than 3");
    expect_error(narc_weld_polygon(flat, 2, 1, left, &count, &error), NARC_ERROR_COUNT, &error, "2 points");
    expect_error(narc_weld_polygon(flat, 4, -1, left, &count, &error), NARC_ERROR_SIZE, &error, "tolerance is -1");
    expect_error(narc_weld_polygon(flat, 4, NAN, left, &count, &error), NARC_ERROR_NOT_FINITE, &error, "tolerance");
    expect_error(narc_weld_polygon(NULL, 4, 1, left, &count, &error), NARC_ERROR_ARGUMENT, &error, "points is NULL");
    expect_error(narc_weld_polygon(flat, 4, 1, NULL, &count, &error), NARC_ERROR_ARGUMENT, &error, "output is NULL");
}
