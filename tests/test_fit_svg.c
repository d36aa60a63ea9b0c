/* SPDX-License-Identifier: MIT
 *
 * test_fit_svg.c - SVG files: path data, arcs, the other shapes, lengths. Expected outlines are derived by hand.
 */
#include <float.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fit_svg.h"

static const double PI = 3.14159265358979323846;

/* ---------------------------------------------------------------------------- path data */

struct path_case {
    const char *data;
    struct op ops[10];
};

static void reads_path_commands(void **state) {
    (void)state;
    static const struct path_case cases[] = {
        {"M10 20L30 40H5V7Z", {{'M', {10, 20}}, {'L', {30, 40}}, {'L', {5, 40}}, {'L', {5, 7}}}},
        {"m10 20l30 40h5v7z", {{'M', {10, 20}}, {'L', {40, 60}}, {'L', {45, 60}}, {'L', {45, 67}}}},
        {"M1 2 3 4 5 0", {{'M', {1, 2}}, {'L', {3, 4}}, {'L', {5, 0}}}},
        {"m1 2 3 4 5 0", {{'M', {1, 2}}, {'L', {4, 6}}, {'L', {9, 6}}}},
        {"M0 0H1 2 3V4 5h1 1v1 1",
         {{'M', {0, 0}},
          {'L', {1, 0}},
          {'L', {2, 0}},
          {'L', {3, 0}},
          {'L', {3, 4}},
          {'L', {3, 5}},
          {'L', {4, 5}},
          {'L', {5, 5}},
          {'L', {5, 6}},
          {'L', {5, 7}}}},
        {"M1 2C3 4 5 6 7 9 9 8 7 6 5 0", {{'M', {1, 2}}, {'C', {3, 4, 5, 6, 7, 9}}, {'C', {9, 8, 7, 6, 5, 0}}}},
        {"M1 2c3 4 5 6 7 9-1-2-3-4-5-9", {{'M', {1, 2}}, {'C', {4, 6, 6, 8, 8, 11}}, {'C', {7, 9, 5, 7, 3, 2}}}},
        {"M1 2C3 4 5 6 7 9S8 1 0 9 5 5 6 6",
         {{'M', {1, 2}}, {'C', {3, 4, 5, 6, 7, 9}}, {'C', {9, 12, 8, 1, 0, 9}}, {'C', {-8, 17, 5, 5, 6, 6}}}},
        {"M1 2c3 4 5 6 7 9s8 1 0 9", {{'M', {1, 2}}, {'C', {4, 6, 6, 8, 8, 11}}, {'C', {10, 14, 16, 12, 8, 20}}}},
        {"M1 2S8 1 0 9", {{'M', {1, 2}}, {'C', {1, 2, 8, 1, 0, 9}}}},
        {"M1 2Q3 4 5 0S8 1 0 9", {{'M', {1, 2}}, {'Q', {3, 4, 5, 0}}, {'C', {5, 0, 8, 1, 0, 9}}}},
        {"M1 2Q3 4 5 0 7 8 9 1", {{'M', {1, 2}}, {'Q', {3, 4, 5, 0}}, {'Q', {7, 8, 9, 1}}}},
        {"M1 2q3 4 5 0 7 8 9 1", {{'M', {1, 2}}, {'Q', {4, 6, 6, 2}}, {'Q', {13, 10, 15, 3}}}},
        {"M1 2Q3 4 5 0T9 9 2 7", {{'M', {1, 2}}, {'Q', {3, 4, 5, 0}}, {'Q', {7, -4, 9, 9}}, {'Q', {11, 22, 2, 7}}}},
        {"M1 2q3 4 5 0t9 9", {{'M', {1, 2}}, {'Q', {4, 6, 6, 2}}, {'Q', {8, -2, 15, 11}}}},
        {"M1 2T9 9 2 0", {{'M', {1, 2}}, {'Q', {1, 2, 9, 9}}, {'Q', {17, 16, 2, 0}}}},
        {"M1 2C3 4 5 6 7 9T0 0", {{'M', {1, 2}}, {'C', {3, 4, 5, 6, 7, 9}}, {'Q', {7, 9, 0, 0}}}},
        {"M1 2C3 4 5 6 7 9L8 8S8 1 0 9",
         {{'M', {1, 2}}, {'C', {3, 4, 5, 6, 7, 9}}, {'L', {8, 8}}, {'C', {8, 8, 8, 1, 0, 9}}}},
        /* After closing, the pen is where the contour began. */
        {"M1 2h4v4zh-4v4z",
         {{'M', {1, 2}}, {'L', {5, 2}}, {'L', {5, 6}}, {'M', {1, 2}}, {'L', {-3, 2}}, {'L', {-3, 6}}}},
        {"M5 5h4v4Zm1 1h2v2z",
         {{'M', {5, 5}}, {'L', {9, 5}}, {'L', {9, 9}}, {'M', {6, 6}}, {'L', {8, 6}}, {'L', {8, 8}}}},
        {"m5 5h4v4m1 1h2v2",
         {{'M', {5, 5}}, {'L', {9, 5}}, {'L', {9, 9}}, {'M', {10, 10}}, {'L', {12, 10}}, {'L', {12, 12}}}},
        /* Moves that nothing follows, and closing what is not begun, draw nothing. */
        {"M9 9M8 8zzM0 0h4v4zM7 7", {{'M', {0, 0}}, {'L', {4, 0}}, {'L', {4, 4}}}},
    };
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        char body[200];
        snprintf(body, sizeof(body), "<path d='%s'/>", cases[k].data);
        struct op ops[11] = {{0}};
        memcpy(ops, cases[k].ops, sizeof(cases[k].ops));
        expect_outline(body, ops);
    }
}

static void reads_numbers_without_separators(void **state) {
    (void)state;
    static const struct path_case cases[] = {
        {"M1.5.5-3e2-.25+7+8", {{'M', {1.5, 0.5}}, {'L', {-300, -0.25}}, {'L', {7, 8}}}},
        {"M.5.5.25-1e1-1E+1,4.e0", {{'M', {0.5, 0.5}}, {'L', {0.25, -10}}, {'L', {-10, 4}}}},
        {" \tM\n0 , 0,4,0 , 4 4 ", {{'M', {0, 0}}, {'L', {4, 0}}, {'L', {4, 4}}}},
        {"M0-0L50000e-4 0 0.00005e5,00005", {{'M', {0, 0}}, {'L', {5, 0}}, {'L', {5, 5}}}},
        {"M0 0 1e-400 5 5 5", {{'M', {0, 0}}, {'L', {0, 5}}, {'L', {5, 5}}}},
        {"M0 0L123456789 0 0 1234567.125", {{'M', {0, 0}}, {'L', {123456789, 0}}, {'L', {0, 1234567.125}}}},
        {"M0 0L.1 0 0 .3", {{'M', {0, 0}}, {'L', {0.1, 0}}, {'L', {0, 0.3}}}},
    };
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        char body[200];
        snprintf(body, sizeof(body), "<path d='%s'/>", cases[k].data);
        expect_outline(body, cases[k].ops);
    }
}

/* ---------------------------------------------------------------------------- arcs */

/* What pieces of 30 degrees can be off, of the radius, always outwards; and a little rounding. */
static double arc_bound(void) { return 2.0 / 27 * pow(sin(PI / 24), 6) / pow(cos(PI / 24), 2); }

/* The chord from (0, 0) to (10, 0) in circles of radius 13 round (5, -12) or (5, 12). With y down and `sweep`, angles
 * grow from x to y: the small arc bulges to y = -1 from the centre (5, 12). */
static void draws_each_of_four_arcs(void **state) {
    (void)state;
    static const char *const flags[] = {"0 0", "0 1", "1 0", "1 1", "00", "01", "10", "11"};
    for (size_t k = 0; k < 8; k++) {
        const bool large = k % 4 >= 2, sweep = k % 2;
        const double center_y = large == sweep ? -12 : 12;
        const double far_y = sweep ? (large ? -25 : -1) : (large ? 25 : 1);
        char body[100];
        snprintf(body, sizeof(body), "<path d='M0 0A13 13 0 %s%s10,0V0'/>", flags[k], k < 4 ? "," : "");
        narc_contours contours = read_body(body);
        assert_int_equal(contours.count, 1);
        double nearest = 100;
        for (size_t i = 0; i < contours.point_count; i++) {
            const narc_point p = {contours.points[i].x, -contours.points[i].y};
            const double radius = hypot(p.x - 5, p.y - center_y);
            assert_true(radius > 13 * (1 - 8 * DBL_EPSILON) && radius < 13 * (1 + arc_bound()) + 1e-12);
            assert_true(p.y * far_y >= 0);
            nearest = fmin(nearest, hypot(p.x - 5, p.y - far_y));
        }
        /* The flattened arc passes its far point: chords of sagitta s on radius r are sqrt(8 r s) long. */
        assert_true(nearest <= sqrt(8 * 13 * contours.flatness));
        narc_release_contours(&contours);
    }
}

struct ellipse_arc {
    double x, y, rx, ry, tilt, start, turn; /* tilt in degrees, turn signed */
    double m[6];                            /* matrix(a b c d e f) */
};

static narc_point on_ellipse(const struct ellipse_arc *e, double angle) {
    const double u = e->rx * cos(angle), v = e->ry * sin(angle), t = e->tilt * PI / 180;
    return (narc_point){e->x + u * cos(t) - v * sin(t), e->y + u * sin(t) + v * cos(t)};
}

/* Back from the path's coordinates to the frame where the ellipse is the unit circle. */
static narc_point to_unit_circle(const struct ellipse_arc *e, narc_point p) {
    const double *m = e->m, det = m[0] * m[3] - m[1] * m[2], x = p.x - m[4], y = -p.y - m[5];
    const double ux = (m[3] * x - m[2] * y) / det - e->x, uy = (m[0] * y - m[1] * x) / det - e->y;
    const double t = e->tilt * PI / 180;
    return (narc_point){(ux * cos(t) + uy * sin(t)) / e->rx, (uy * cos(t) - ux * sin(t)) / e->ry};
}

static struct ellipse_arc random_arc(struct test_random *random) {
    struct ellipse_arc e = {.x = random_between(random, -50, 50),
                            .y = random_between(random, -50, 50),
                            .rx = random_log_between(random, 1, 100),
                            .ry = random_log_between(random, 1, 100),
                            .tilt = random_between(random, -400, 400),
                            .start = random_between(random, -PI, PI),
                            .turn = random_between(random, 0.05, PI - 0.01)};
    e.turn = random_below(random, 2) ? e.turn : 2 * PI - e.turn;
    e.turn = random_below(random, 2) ? e.turn : -e.turn;
    do {
        for (int k = 0; k < 6; k++) {
            e.m[k] = random_between(random, -2, 2);
        }
    } while (fabs(e.m[0] * e.m[3] - e.m[1] * e.m[2]) < 0.2);
    return e;
}

/* How well an arc is known from its end points. These are off by some 1e-13 (rounding of coordinates up to 150), which
 * is as much in the unit circle's frame, since radii are at least 1. The chord's direction is then off by that over
 * half its length, sin(0.05 / 2): 4e-12; the centre by it over the cosine of half the angle, at least 0.005: 2e-11. The
 * test's way back through the matrix enlarges the rounding of coordinates up to 4 * 150 by 4 / 0.2: 20 * 600 * 4
 * DBL_EPSILON is 1e-11. */
static const double ARC_ROUNDING = 1e-10;

static void draws_arcs_of_random_ellipses(void **state) {
    (void)state;
    struct test_random random = test_random_named("svg arcs");
    for (size_t trial = 0; trial < test_trials(2000); trial++) {
        const struct ellipse_arc e = random_arc(&random);
        const narc_point from = on_ellipse(&e, e.start), to = on_ellipse(&e, e.start + e.turn);
        char body[500];
        snprintf(body, sizeof(body),
                 "<path transform='matrix(%.17g %.17g %.17g %.17g %.17g %.17g)' stroke='red' "
                 "d='M%.17g %.17gA%.17g %.17g %.17g %d%d%.17g %.17g'/>",
                 e.m[0], e.m[1], e.m[2], e.m[3], e.m[4], e.m[5], from.x, from.y, e.rx, e.ry, e.tilt, fabs(e.turn) > PI,
                 e.turn > 0, to.x, to.y);
        narc_contours contours = read_body(body);
        double turned = 0;
        for (size_t i = 0; i < contours.point_count; i++) {
            const narc_point p = to_unit_circle(&e, contours.points[i]);
            const double radius = hypot(p.x, p.y);
            if (!(radius > 1 - ARC_ROUNDING && radius < 1 + arc_bound() + ARC_ROUNDING)) {
                fail_msg("trial %zu: radius 1 + %g", trial, radius - 1);
            }
            if (i > 0) {
                const narc_point q = to_unit_circle(&e, contours.points[i - 1]);
                turned += atan2(q.x * p.y - q.y * p.x, q.x * p.x + q.y * p.y);
            }
        }
        if (!(fabs(turned - e.turn) < 2 * ARC_ROUNDING)) {
            fail_msg("trial %zu: the arc turns by %.9g, not %.9g", trial, turned, e.turn);
        }
        narc_release_contours(&contours);
    }
}

static void draws_special_arcs(void **state) {
    (void)state;
    /* Without a radius, or with a circle too large to tell from its chord: a line. On the spot: nothing. */
    expect_outline("<path d='M0 0A0 5 0 0 0 5 0A5 0 0 1 1 5 5'/>",
                   (struct op[]){{'M', {0, 0}}, {'L', {5, 0}}, {'L', {5, 5}}, {0}});
    expect_outline("<path d='M0 0A3 5 0 0 0 0 0L5 0A3 5 0 1 1 5 0L5 5'/>",
                   (struct op[]){{'M', {0, 0}}, {'L', {5, 0}}, {'L', {5, 5}}, {0}});
    /* Radii too small to reach, and negative ones: a half circle of radius 5, which goes up (y down) to -5. */
    static const char *const halves[] = {"A1 1 0 0 1 10 0", "a-1-1 77 1 1 10 0", "A5 5 0 0 1 10 0",
                                         "A1e-9 1e-9 0 0110 0"};
    for (size_t k = 0; k < 4; k++) {
        char body[100];
        snprintf(body, sizeof(body), "<path d='M0 0%s'/>", halves[k]);
        narc_contours contours = read_body(body);
        /* The area: of the half circle, less the chords' share (2/3 of chord times flatness each, the outline being
         * 5 pi long), plus what the cubics are outside. */
        const double area = -measure_area(&contours, 0), full = PI * 25 / 2;
        assert_true(area > full - 5 * PI * contours.flatness && area < full + 5 * PI * 5 * arc_bound());
        for (size_t i = 0; i < contours.point_count; i++) {
            assert_true(fabs(hypot(contours.points[i].x - 5, contours.points[i].y) - 5) < 5 * arc_bound() + 1e-12);
        }
        narc_release_contours(&contours);
    }
    /* A nearly straight arc keeps its sagitta c^2 / (8 r): 10^2 / 8e12 = 1.25e-11, far from where its centre is. */
    narc_contours contours = read_body("<path d='M0 0A1e12 1e12 0 0 1 10 0V5'/>");
    for (size_t i = 0; i < contours.point_count; i++) {
        const narc_point p = contours.points[i];
        assert_true(p.x >= 0 && p.x <= 10 && (p.y == -5 || (p.y >= 0 && p.y < 1.3e-11)));
    }
    narc_release_contours(&contours);
}

/* ---------------------------------------------------------------------------- other shapes */

/* Is the outline of the ellipse or rounded box that is `w` by `h` round (x, y), with corners rx, ry? */
static void expect_rounded_box(const char *body, double x, double y, double w, double h, double rx, double ry) {
    narc_contours contours = read_body(body);
    assert_int_equal(contours.count, 1);
    double side = 0;
    for (size_t i = 0; i < contours.point_count; i++) {
        const double px = fabs(contours.points[i].x - x), py = fabs(-contours.points[i].y - y);
        const double cx = fmax(0, (px - (w / 2 - rx)) / rx), cy = fmax(0, (py - (h / 2 - ry)) / ry);
        if (!(fabs(hypot(cx, cy) - 1) <= arc_bound() + 1e-12)) {
            fail_msg("%s: (%.9g, %.9g) is not on the outline", body, px, py);
        }
        side = fmax(side, px / w);
    }
    assert_true(fabs(side - 0.5) < 1e-12);
    /* The reader draws clockwise on a screen, which is clockwise here too. */
    const double area = -measure_area(&contours, 0), full = w * h - (4 - PI) * rx * ry;
    assert_true(area > full - 2 * (w + h) * contours.flatness);
    assert_true(area < full + 2 * (w + h) * fmax(rx, ry) * arc_bound() + 1e-9);
    narc_release_contours(&contours);
}

static void draws_shapes(void **state) {
    (void)state;
    const struct op box[] = {{'M', {1, 2}}, {'L', {11, 2}}, {'L', {11, 7}}, {'L', {1, 7}}, {0}};
    expect_outline("<rect x='1' y='2' width='10' height='5'/>", box);
    expect_outline("<rect x='1' y='2' width='10' height='5' rx='0'/>", box);
    expect_outline("<rect x='1' y='2' width='10' height='5' rx='3' ry='0'/>", box);
    expect_outline("<rect x='1' y='2' width='10' height='5' rx='auto' ry='auto'/>", box);
    expect_outline(
        "<polygon points='1,2 11,2 11 7,1-9-.5.5'/>",
        (struct op[]){{'M', {1, 2}}, {'L', {11, 2}}, {'L', {11, 7}}, {'L', {1, -9}}, {'L', {-0.5, 0.5}}, {0}});
    expect_outline("<polyline points=' 1 2 , 11 2\n11 7 '/>",
                   (struct op[]){{'M', {1, 2}}, {'L', {11, 2}}, {'L', {11, 7}}, {0}});
    expect_outline("<line x1='1' y1='2' x2='11' y2='-7' stroke='red'/>",
                   (struct op[]){{'M', {1, 2}}, {'L', {11, -7}}, {0}});
    expect_rounded_box("<rect x='-7' y='-1' width='20' height='10' rx='3' ry='2'/>", 3, 4, 20, 10, 3, 2);
    expect_rounded_box("<rect x='-7' y='-1' width='20' height='10' rx='3'/>", 3, 4, 20, 10, 3, 3);
    expect_rounded_box("<rect x='-7' y='-1' width='20' height='10' ry='2' rx='auto'/>", 3, 4, 20, 10, 2, 2);
    expect_rounded_box("<rect x='-7' y='-1' width='20' height='10' rx='30'/>", 3, 4, 20, 10, 10, 5);
    expect_rounded_box("<circle cx='3' cy='4' r='5'/>", 3, 4, 10, 10, 5, 5);
    expect_rounded_box("<ellipse cx='3' cy='4' rx='500' ry='.5'/>", 3, 4, 1000, 1, 500, 0.5);
    expect_rounded_box("<ellipse cx='3' cy='4' ry='5'/>", 3, 4, 10, 10, 5, 5);
}

/* The box from (x, 0) to (x + w, h). */
static void expect_box(const char *attributes, const char *body, double x, double w, double h) {
    narc_contours contours = read_root(attributes, body);
    const narc_point corners[4] = {{x, 0}, {x + w, 0}, {x + w, -h}, {x, -h}};
    assert_int_equal(contours.point_count, 4);
    for (int k = 0; k < 4; k++) {
        /* A factor and a product of it, and a sum: three roundings. */
        if (!(hypot(contours.points[k].x - corners[k].x, contours.points[k].y - corners[k].y) <=
              3 * DBL_EPSILON * (fabs(x) + w + h))) {
            fail_msg("%s: corner %d is (%.17g, %.17g)", body, k, contours.points[k].x, contours.points[k].y);
        }
    }
    narc_release_contours(&contours);
}

static void reads_lengths(void **state) {
    (void)state;
    expect_box("", "<rect x='1' width='1px' height=' 1in '/>", 1, 1, 96);
    expect_box("", "<rect x='2.54cm' width='25.4mm' height='72pt'/>", 96, 96, 96);
    expect_box("", "<rect x='-6pc' width='101.6Q' height='1e2'/>", -96, 96, 100);
    expect_box("viewBox='0 0 200 50'", "<rect x='10%' width='50%' height='200%'/>", 20, 100, 100);
    expect_box("viewBox='-3,7,200 50' width='9' height='9'", "<rect x='-10%' width='50%' height='2'/>", -20, 100, 2);
    expect_box("width='200px' height='1in'", "<rect x='10%' width='50%' height='50%'/>", 20, 100, 48);
    expect_box("width='200' height='x'", "<rect x='10%' width='50%' height='5'/>", 20, 100, 5);
    expect_box("width='99'", "<svg width='200' height='50'><rect x='10%' width='50%' height='10%'/></svg>", 20, 100, 5);
    /* A percentage of a radius is of the diagonal over sqrt 2: of 30 and 40, that is 50 / sqrt 2. */
    narc_contours contours = read_root("viewBox='0 0 30 40'", "<circle cx='50%' cy='50%' r='20%'/>");
    for (size_t i = 0; i < contours.point_count; i++) {
        const double radius = hypot(contours.points[i].x - 15, contours.points[i].y + 20) / (10 / sqrt(2));
        assert_true(radius > 1 - 1e-12 && radius < 1 + arc_bound() + 1e-12);
    }
    narc_release_contours(&contours);
}

int main(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(reads_path_commands),     cmocka_unit_test(reads_numbers_without_separators),
        cmocka_unit_test(draws_each_of_four_arcs), cmocka_unit_test(draws_arcs_of_random_ellipses),
        cmocka_unit_test(draws_special_arcs),      cmocka_unit_test(draws_shapes),
        cmocka_unit_test(reads_lengths),
    };
    if (!test_begin()) {
        return TEST_SKIPPED;
    }
    const int failures = cmocka_run_group_tests_name("SVG shapes", tests, NULL, NULL);
    return failures + test_svg_tree() + test_svg_damage();
}
