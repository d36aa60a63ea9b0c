/* SPDX-License-Identifier: MIT
 *
 * svg.c - SVG files: how near the outline is to what is drawn, units, what is seen, files that are wrong.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "fit_support.h"

/* The largest part of its radius by which a circle of four cubics, which librsvg draws, is too large. */
static const double CIRCLE_ERROR = 2.8e-4;

static narc_status read_usual(const void *data, size_t size, narc_path *path, narc_error *error) {
    return narc_read_svg(data, size, NULL, path, error);
}

/* Is a drawing traced where it need not be, as in most of these tests? */
static bool traces = true;

static narc_path *read_request(const char *attributes, const char *body, narc_image_request request) {
    request.trace = traces;
    char text[4000];
    const int size = snprintf(text, sizeof text,
                              "<svg xmlns='http://www.w3.org/2000/svg' xmlns:xlink='http://www.w3.org/1999/xlink' %s>"
                              "%s</svg>",
                              attributes, body);
    assert_true(size > 0 && (size_t)size < sizeof text);
    narc_path *path = make_path();
    narc_error error = {.message = ""};
    const narc_status status = narc_read_svg(text, (size_t)size, &request, path, &error);
    if (status)
        fail_msg("%s: %s", text, error.message);
    return path;
}

static narc_path *read_path(const char *attributes, const char *body) {
    return read_request(attributes, body, (narc_image_request){.threshold = 0});
}

static narc_contours read_contours(const char *attributes, const char *body) {
    AUTO(narc_destroy_path_at) narc_path *path = read_path(attributes, body);
    return flatten(path);
}

static double find_support(const narc_point *points, size_t count, double angle) {
    double most = -INFINITY;
    for (size_t k = 0; k < count; k++)
        most = fmax(most, points[k].x * cos(angle) + points[k].y * sin(angle));
    return most;
}

/* ---------------------------------------------------------------------------- how near the outline is */

/* Ink whose hull is that of discs with one radius round some points; y up. */
struct ink {
    narc_point points[4];
    size_t count;
    double radius;
};

/* In all directions the outline reaches as far as the ink, up to the flatness that it tells, which is a pixel: at most
 * one 4096th of the ink's longer side, or one 8192nd of the page's, which is 100. */
static void expect_near_ink(const char *body, const struct ink *ink, double rounding) {
    AUTO(narc_release_contours) narc_contours contours = read_contours("viewBox='0 0 100 100'", body);
    double sides[4];
    for (int k = 0; k < 4; k++)
        sides[k] = find_support(ink->points, ink->count, k * PI / 2) + ink->radius;
    const double extent = fmax(sides[0] + sides[2], sides[1] + sides[3]);
    assert_true(contours.flatness > 0 && contours.flatness <= fmax(extent / 4096, 100.0 / 8192) * (1 + 1e-9));
    for (int k = 0; k < 720; k++) {
        const double angle = k * PI / 360;
        const double reach = find_support(contours.points, contours.point_count, angle);
        const double truth = find_support(ink->points, ink->count, angle) + ink->radius;
        if (!(reach >= truth - contours.flatness && reach <= truth + contours.flatness + rounding)) {
            fail_msg("%s: at %g degrees the outline is %g pixels beyond the ink", body, k / 2.0,
                     (reach - truth) / contours.flatness);
        }
    }
}

/* Numbers in the file are short of these by 1e-12. */
static void expect_near_polygon(const narc_point *corners, size_t count) {
    char body[400] = "<polygon points='";
    struct ink ink = {.count = count};
    for (size_t k = 0; k < count; k++) {
        ink.points[k] = corners[k];
        snprintf(body + strlen(body), sizeof body - strlen(body), "%.12f %.12f ", corners[k].x, -corners[k].y);
    }
    strcat(body, "'/>");
    expect_near_ink(body, &ink, 0);
}

/* Corners of a box that is `width` by `height` round a point of the page, turned. */
static void make_box(double width, double height, double angle, narc_point middle, narc_point *corners) {
    for (int k = 0; k < 4; k++) {
        const double x = (k == 1 || k == 2 ? 0.5 : -0.5) * width, y = (k >= 2 ? 0.5 : -0.5) * height;
        corners[k] =
            (narc_point){middle.x + x * cos(angle) - y * sin(angle), middle.y + x * sin(angle) + y * cos(angle)};
    }
}

static narc_point random_middle(struct test_random *random) {
    return (narc_point){random_between(random, 45, 55), random_between(random, -55, -45)};
}

TEST(keeps_near_boxes) {
    struct test_random random = test_random_named("svg boxes");
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        narc_point corners[4];
        const double width = random_between(&random, 4, 60);
        /* Upright ones, squares on their corners, any angle; as high as wide, or thin down to four pixels. */
        const double angle = trial % 3 ? (trial % 3 == 1 ? PI / 4 : random_between(&random, 0, PI)) : 0;
        const double height = trial % 2 ? width : width * random_log_between(&random, 1e-3, 1);
        make_box(width, height, angle, random_middle(&random), corners);
        expect_near_polygon(corners, 4);
    }
}

/* Needles with an angle of 8 degrees or more at the tip, pointing anywhere, and along rows and columns. */
TEST(keeps_near_needles) {
    struct test_random random = test_random_named("svg needles");
    for (size_t trial = 0; trial < test_trials(12); trial++) {
        const narc_point middle = random_middle(&random);
        const double tip = random_between(&random, 8, 60) * PI / 180, length = random_between(&random, 10, 40);
        const double angle = trial % 2 ? random_between(&random, 0, 2 * PI) : (double)(trial / 2 % 4) * PI / 2;
        const double x = length * cos(angle), y = length * sin(angle), half = tan(tip / 2);
        expect_near_polygon((narc_point[]){{middle.x + x, middle.y + y},
                                           {middle.x - half * y, middle.y + half * x},
                                           {middle.x + half * y, middle.y - half * x}},
                            3);
    }
}

TEST(keeps_near_circles_and_strokes) {
    struct test_random random = test_random_named("svg circles");
    for (size_t trial = 0; trial < test_trials(8); trial++) {
        const narc_point a = random_middle(&random), b = random_middle(&random);
        const double radius = random_between(&random, 3, 20);
        char body[300];
        if (trial % 2) {
            snprintf(body, sizeof body, "<circle cx='%.12f' cy='%.12f' r='%.12f'/>", a.x, -a.y, radius);
            expect_near_ink(body, &(struct ink){{a}, 1, radius}, CIRCLE_ERROR * radius);
        } else {
            snprintf(body, sizeof body,
                     "<line x1='%.12f' y1='%.12f' x2='%.12f' y2='%.12f' stroke='blue' stroke-width='%.12f' "
                     "stroke-linecap='round'/>",
                     a.x, -a.y, b.x, -b.y, 2 * radius);
            expect_near_ink(body, &(struct ink){{a, b}, 2, radius}, CIRCLE_ERROR * radius);
        }
    }
}

/* The flatness counts: a bounding fit holds the drawing itself, not only the outline that was traced. */
TEST(bounds_what_is_drawn) {
    struct test_random random = test_random_named("svg fits");
    for (size_t trial = 0; trial < test_trials(6); trial++) {
        narc_point corners[4];
        char body[300];
        make_box(random_between(&random, 10, 60), random_between(&random, 10, 60), random_between(&random, 0, PI),
                 random_middle(&random), corners);
        snprintf(body, sizeof body, "<path d='M%.12f %.12f %.12f %.12f %.12f %.12f %.12f %.12f'/>", corners[0].x,
                 -corners[0].y, corners[1].x, -corners[1].y, corners[2].x, -corners[2].y, corners[3].x, -corners[3].y);
        AUTO(narc_destroy_path_at) narc_path *path = read_path("viewBox='0 0 100 100'", body);
        narc_fit_result fit;
        narc_error error;
        const narc_fit_request request = {.arc_count = 4, .family = NARC_FIT_POLYGON, .starts = 2};
        expect_ok(narc_fit_path(path, &request, &fit, &error), &error);
        assert_true(fit.flatness > 0);
        for (size_t k = 0; k < fit.arc_count; k++) { /* the corners are on the left of each side */
            const narc_arc a = fit.arcs[k], b = fit.arcs[(k + 1) % fit.arc_count];
            const double x = b.center_x - a.center_x, y = b.center_y - a.center_y;
            for (int i = 0; i < 4; i++) {
                const double to_x = corners[i].x - fit.origin.x - a.center_x;
                const double to_y = corners[i].y - fit.origin.y - a.center_y;
                assert_true(x * to_y - y * to_x > 0);
            }
        }
    }
}

/* Small ink on a large page is drawn as large as the page may become: 8192 pixels. */
TEST(tells_a_pixel) {
    narc_contours contours = read_contours("viewBox='0 0 1000 500'", "<circle cx='600' cy='200' r='1'/>");
    assert_true(fabs(contours.flatness - 1000.0 / 8192) < 1e-9);
    narc_release_contours(&contours);
    /* The path's other contours count with the same. */
    AUTO(narc_destroy_path_at) narc_path *path = read_path("viewBox='0 0 100 100'", "<rect width='100' height='100'/>");
    draw_polygon(path, (narc_point[]){{0, 0}, {1, 0}, {0, 1}}, 3);
    contours = flatten(path);
    assert_true(contours.flatness > 100.0 / 4200 && contours.flatness < 100.0 / 4096);
    narc_release_contours(&contours);
}

/* ---------------------------------------------------------------------------- units, and what is seen */

struct seen {
    const char *attributes, *body;
    double left, bottom, right, top; /* y up */
};

/* Both ways see the same. */
static void expect_seen(const struct seen *cases, size_t count) {
    for (size_t k = 0; k < 2 * count; k += stride(5)) {
        const struct seen *c = &cases[k / 2];
        traces = k % 2 == 0;
        AUTO(narc_release_contours) narc_contours contours = read_contours(c->attributes, c->body);
        traces = true;
        const double sides[4] = {c->right, c->top, -c->left, -c->bottom};
        for (int i = 0; i < 4; i++) {
            const double reach = find_support(contours.points, contours.point_count, i * PI / 2);
            if (!(fabs(reach - sides[i]) <= fmax(contours.flatness, 1e-9)))
                fail_msg("<svg %s> %s: side %d is at %.9g, not %.9g", c->attributes, c->body, i, reach, sides[i]);
        }
    }
}

TEST(keeps_user_units) {
    static const char rectangle[] = "<rect x='1' y='2' width='3' height='4'/>";
    static const struct seen cases[] = {
        {"viewBox='0 0 10 10'", rectangle, 1, -6, 4, -2},
        {"viewBox='-50 -20 100 40'", rectangle, 1, -6, 4, -2},
        {"viewBox='0 0 10 10' width='20cm' height='5'", rectangle, 1, -6, 4, -2},
        {"viewBox='0 0 10 10' width='200' height='50' preserveAspectRatio='none'", rectangle, 1, -6, 4, -2},
        {"viewBox='0 0 10 10' width='200' height='50' preserveAspectRatio='xMaxYMin slice'", rectangle, 1, -6, 4, -2},
        {"viewBox='0.5 1.5 1000 1' width='1' height='1'", "<rect x='1' y='1' width='900' height='9'/>", 1, -2.5, 901,
         -1.5},
        {"width='10' height='10'", rectangle, 1, -6, 4, -2},
        {"width='1in' height='25.4mm'", "<rect width='96' height='48'/>", 0, -48, 96, 0},
        {"viewBox='0 0 200 100'", "<rect width='1in' height='50%'/>", 0, -50, 96, 0},
        /* Without a page all is drawn, wherever it is; percentages are of 300 x 150. */
        {"", "<circle cx='-5' cy='5' r='3'/>", -8, -8, -2, -2},
        {"", "<rect width='50%' height='50%'/>", 0, -75, 150, 0},
        {"width='100%'", "<rect x='-4' y='-400' width='900' height='500'/>", -4, -100, 896, 400},
    };
    expect_seen(cases, sizeof cases / sizeof cases[0]);
}

TEST(sees_what_is_drawn) {
    static const char page[] = "viewBox='0 0 20 20'";
    static const struct seen cases[] = {
        /* Strokes have width, corners are mitred; what is outside of the page is cut off. */
        {page, "<path d='M5 5H10V12H5z' stroke='red' stroke-width='2'/>", 4, -13, 11, -4},
        {page, "<path d='M5 5H10' stroke='red' stroke-width='2'/>", 5, -6, 10, -4},
        {page, "<rect x='-5' y='10' width='10' height='30'/>", 0, -20, 5, -10},
        {page, "<g opacity='0.5'><rect x='-5' y='10' width='10' height='30'/></g>", 0, -20, 5, -10},
        /* What is not drawn at all does not count. */
        {page, "<circle r='9' fill='none'/><circle r='9' opacity='0'/><rect x='5' y='5' width='3' height='4'/>", 5, -9,
         8, -5},
        {page,
         "<g display='none'><circle r='9'/></g><defs><circle r='9'/></defs><rect x='5' y='5' width='3' height='4'/>", 5,
         -9, 8, -5},
        {page,
         "<style>.a{fill:none} .b *{visibility:hidden}</style><circle r='9' class='a'/><g class='b'><circle r='9'/></g>"
         "<rect x='5' y='5' width='3' height='4'/>",
         5, -9, 8, -5},
        {page,
         "<clipPath id='c'><rect x='5' y='5' width='3' height='4'/></clipPath><circle r='19' clip-path='url(#c)'/>", 5,
         -9, 8, -5},
        {page, "<defs><rect id='r' width='3' height='4'/></defs><use xlink:href='#r' transform='translate(5 5)'/>", 5,
         -9, 8, -5},
        {page, "<g transform='rotate(90)'><rect x='5' y='-8' width='4' height='3'/></g>", 5, -9, 8, -5},
        {page,
         "<svg x='5' y='5' width='3' height='4' viewBox='0 0 1 1' preserveAspectRatio='none'><circle r='9'/></svg>", 5,
         -9, 8, -5},
    };
    expect_seen(cases, sizeof cases / sizeof cases[0]);
}

/* ---------------------------------------------------------------------------- how faint ink may be */

static const char page_of_100[] = "viewBox='0 0 100 100'", square[] = "<rect x='20' y='20' width='30' height='30'/>";

/* How far the outline reaches to the right, and upwards. */
static narc_point measure_reach(const char *body, narc_image_request request) {
    AUTO(narc_destroy_path_at) narc_path *path = read_request(page_of_100, body, request);
    AUTO(narc_release_contours) narc_contours contours = flatten(path);
    return (narc_point){find_support(contours.points, contours.point_count, 0),
                        find_support(contours.points, contours.point_count, PI / 2)};
}

/* A shadow, even or blurred, apart or behind, counts if it is not fainter than the threshold, which usually is a quarter.
 * What is near ink counts with it, by up to 8 pixels of a 4096th of the ink, and the outline is a pixel away. */
TEST(leaves_out_faint_shadows) {
    static const double near = 9 * 70.0 / 4096;
    static const struct {
        const char *shadow;
        double opacity, right; /* of all of it */
    } cases[] = {
        {"<rect x='30' y='30' width='40' height='30' opacity='%g'/>", 0.2, 70},
        {"<g opacity='%g'><rect x='60' y='30' width='30' height='9'/></g>", 0.15, 90},
        {"<rect x='25' y='22' width='60' height='30' fill-opacity='%g' fill='red'/>", 0.02, 85},
        {"<filter id='f' x='-.2' y='-.4' width='1.4' height='1.8'><feGaussianBlur stdDeviation='2'/></filter>"
         "<rect x='30' y='22' width='40' height='20' filter='url(#f)' opacity='%g'/>",
         0.24, 73},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k += stride(4)) {
        char body[600];
        const double opacity = cases[k].opacity;
        snprintf(body, sizeof body, cases[k].shadow, opacity);
        strcat(body, square);
        narc_point reach = measure_reach(body, (narc_image_request){.threshold = 0});
        if (!(fabs(reach.x - 50) <= near))
            fail_msg("%s: the outline reaches to %g", body, reach.x);
        assert_true(fabs(reach.y + 20) <= near);
        reach = measure_reach(body, (narc_image_request){.threshold = 0.005});
        assert_true(reach.x > cases[k].right - near);
        if (stride(4) > 1 || strstr(body, "Blur")) /* which takes seconds to draw */
            continue;
        reach = measure_reach(body, (narc_image_request){.threshold = opacity + 0.01});
        assert_true(fabs(reach.x - 50) <= near);
        reach = measure_reach(body, (narc_image_request){.threshold = 0.95});
        assert_true(fabs(reach.x - 50) <= near);
    }
    /* However faint, it counts if the threshold lets it. */
    const struct seen faint = {page_of_100, "<rect x='5' y='5' width='3' height='4' fill-opacity='.26'/>", 5, -9, 8,
                               -5};
    expect_seen(&faint, 1);
    const narc_point reach =
        measure_reach("<rect width='3' height='4' fill-opacity='.004'/>", (narc_image_request){.threshold = 1e-9});
    assert_true(fabs(reach.x - 3) <= 9e-3);
}

/* Ink of full strength is where it is whatever the threshold; tips of 30 degrees too. */
/* A pixel of strong ink at a side of the page, and faint ink next to it: all within eight pixels counts, and is one. */
TEST(keeps_faint_ink_at_sides) {
    AUTO(narc_release_contours)
    narc_contours whole = read_contours("viewBox='0 0 100 100'", "<rect width='100' height='1'/>");
    const double pixel = whole.flatness;
    for (int side = 0; side < 4; side++) {
        char body[300];
        snprintf(body, sizeof body,
                 "<g transform='rotate(%d 50 50)'><rect width='100' height='%.12f'/>"
                 "<rect width='100' height='%.12f' opacity='0.02'/></g>",
                 90 * side, pixel, 12 * pixel);
        AUTO(narc_release_contours) narc_contours contours = read_contours("viewBox='0 0 100 100'", body);
        assert_true(contours.flatness == pixel);
        assert_int_equal(contours.count, 1);
        const double across = (side + 1) * PI / 2;
        const double depth = find_support(contours.points, contours.point_count, across) +
                             find_support(contours.points, contours.point_count, across + PI);
        assert_true(depth >= 8 * pixel && depth <= 11 * pixel);
    }
}

TEST(keeps_strong_ink_at_any_threshold) {
    static const char body[] = "<path d='M20 20H80L50 76z'/><path d='M10 90L90 79V90z'/>";
    for (double threshold = 0.05; threshold < 1; threshold += 0.15 * (double)stride(4)) {
        const narc_point reach = measure_reach(body, (narc_image_request){.threshold = threshold});
        assert_true(fabs(reach.x - 90) <= 1.001 * 80 / 4096 && fabs(reach.y + 20) <= 1.001 * 80 / 4096);
    }
}

/* Darkness and lightness of what is drawn, also on a background; a page that is covered is its rectangle, and told. */
TEST(takes_dark_and_light) {
    static const char on_white[] = "<rect width='100' height='100' fill='white'/><rect x='20' y='20' width='30' "
                                   "height='30' fill='#402010'/><circle cx='80' cy='80' r='9' fill='#ffff80'/>";
    static const char on_black[] = "<rect width='100' height='100'/><rect x='20' y='20' width='30' height='30' "
                                   "fill='#c0d0e0'/><circle cx='80' cy='80' r='9' fill='#300'/>";
    static const char on_nothing[] = "<rect x='20' y='20' width='30' height='30' fill='black'/><rect x='60' y='60' "
                                     "width='10' height='10' fill='white'/>";
    static const double pixel = 100.0 / 4096;
    const struct {
        const char *body;
        narc_silhouette silhouette;
        double threshold;
        bool whole;
        narc_point reach;
    } cases[] = {
        {on_white, NARC_SILHOUETTE_ALPHA, 0, true, {100, 0}},
        {on_white, NARC_SILHOUETTE_DARK, 0, false, {50, -20}},
        {on_black, NARC_SILHOUETTE_LIGHT, 0, false, {50, -20}},
        {on_black, NARC_SILHOUETTE_DARK, 0.1, true, {100, 0}},
        {on_nothing, NARC_SILHOUETTE_DARK, 0, false, {50, -20}},
        {on_nothing, NARC_SILHOUETTE_LIGHT, 0, false, {70, -60}},
        {square, NARC_SILHOUETTE_ALPHA, 0, false, {50, -20}},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k += stride(3)) {
        bool whole = !cases[k].whole;
        const narc_point reach = measure_reach(
            cases[k].body, (narc_image_request){cases[k].silhouette, cases[k].threshold, .out_whole = &whole});
        if (whole != cases[k].whole || !(fabs(reach.x - cases[k].reach.x) <= pixel) ||
            !(fabs(reach.y - cases[k].reach.y) <= pixel))
            fail_msg("case %zu: the outline reaches to %g, %g, whole: %d", k, reach.x, reach.y, whole);
    }
}

/* Text too large for FreeType is left out, and no later text suffers for it, in this file or in the next. Without a font
 * that says nothing. */
TEST(leaves_out_huge_text) {
    static const char huge[] =
        "<rect width='9' height='9'/><text transform='scale(56,26)' font-size='12' x='2.2' y='14.2'>l</text>";
    for (int trial = 0; trial < 2; trial++) {
        const struct seen seen = {"viewBox='0 0 9 9'", huge, 0, -9, 9, 0};
        expect_seen(&seen, 1);
        AUTO(narc_release_contours)
        narc_contours contours =
            read_contours("viewBox='0 0 90 90'", "<rect width='9' height='9'/><text y='80'>l</text>");
    }
}

/* ---------------------------------------------------------------------------- files that are wrong */

TEST(tells_what_is_wrong) {
    static const struct wrong wrong[] = {
        {"", NARC_ERROR_FORMAT, 0, "the SVG file is empty"},
        {"M0 0h1v1z", NARC_ERROR_FORMAT, 1, "not SVG: "},
        {"<svg xmlns='http://www.w3.org/2000/svg'>\n<g>\n</svg>", NARC_ERROR_FORMAT, 3, "not SVG: "},
        {"<svg xmlns='http://www.w3.org/2000/svg'>\n<path d='M0 0h4v4'", NARC_ERROR_FORMAT, 2, "not SVG: "},
        {"<svg xmlns='http://www.w3.org/2000/svg'>\n<g></g.></svg>", NARC_ERROR_FORMAT, 2, "and g"}, /* no full stop */
        {"\x1f\x8b\x08", NARC_ERROR_FORMAT, 0, "compressed"},
        {"<html><body/></html>", NARC_ERROR_FORMAT, 0, "not SVG: XML does not have <svg> root"},
        {"<svg xmlns='http://www.w3.org/2000/svg'/>", NARC_ERROR_FORMAT, 0, "nothing is seen in the SVG file"},
        {"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><g fill='none'><circle r='3'/></g></svg>",
         NARC_ERROR_FORMAT, 0, "nothing is seen in the SVG file"},
        {"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 0 9'><circle r='3'/></svg>", NARC_ERROR_FORMAT, 0,
         "nothing is seen in the SVG file"},
        {"<svg xmlns='http://www.w3.org/2000/svg' width='10'><circle r='3'/></svg>", NARC_ERROR_FORMAT, 0,
         "no viewBox, and only a part of a size"},
        {"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9e9 9e9'><circle r='8e9'/></svg>", NARC_ERROR_SIZE, 0,
         "coordinates reach up to 1e+09"},
    };
    for (size_t k = 0; k < sizeof wrong / sizeof wrong[0]; k += stride(5)) {
        const struct wrong *w = &wrong[k];
        expect_wrong_text(read_usual, w->text, strlen(w->text), w->status, w->line, w->words);
    }
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error;
    expect_error(narc_read_svg(NULL, 1, NULL, path, &error), NARC_ERROR_ARGUMENT, &error, "data is NULL");
    expect_error(narc_read_svg("<svg/>", 6, NULL, NULL, &error), NARC_ERROR_ARGUMENT, &error, "path is NULL");
    static const char faint[] = "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><circle r='3' "
                                "opacity='0.2'/></svg>";
    static const struct {
        narc_image_request request;
        narc_status status;
        const char *words;
    } requests[] = {
        {{.silhouette = (narc_silhouette)3}, NARC_ERROR_ARGUMENT, "there is no silhouette 3"},
        {{.threshold = 1}, NARC_ERROR_SIZE, "threshold is 1;"},
        {{.threshold = -0.5}, NARC_ERROR_SIZE, "threshold is -0.5;"},
        {{.threshold = NAN}, NARC_ERROR_NOT_FINITE, "threshold is"},
        {{.threshold = 0}, NARC_ERROR_FORMAT, "all ink of the SVG file is fainter than the threshold 0.25"},
        {{.threshold = 0.21}, NARC_ERROR_FORMAT, "fainter than the threshold 0.21"},
        {{.silhouette = NARC_SILHOUETTE_LIGHT},
         NARC_ERROR_FORMAT,
         "the SVG file has nothing light above the threshold 0.25"},
    };
    for (size_t k = 0; k < sizeof requests / sizeof requests[0]; k += stride(3))
        expect_error(narc_read_svg(faint, sizeof faint - 1, &requests[k].request, path, &error), requests[k].status,
                     &error, requests[k].words);
}

/* What a file shows of others is not read, though they are there. */
TEST(reads_no_other_file) {
    static const char name[] = "test_fit_svg.tmp.svg";
    static const struct {
        const char *format;
        size_t line;
        const char *words;
    } cases[] = {
        {"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><image href='%s' width='9' height='9'/></svg>", 0,
         "nothing is seen"},
        {"<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><use href='%s#a'/></svg>", 0, "nothing is seen"},
        {"<svg xmlns='http://www.w3.org/2000/svg' xmlns:xi='http://www.w3.org/2001/XInclude' viewBox='0 0 9 9'>"
         "<xi:include href='%s'/></svg>",
         0, "nothing is seen"},
        {"<!DOCTYPE svg [<!ENTITY e SYSTEM '%s'>]><svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'>&e;</svg>",
         1, "Entity 'e' not defined"},
    };
    FILE *file = fopen(name, "w");
    assert_non_null(file);
    fputs("<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 9 9'><circle id='a' r='8'/></svg>", file);
    fclose(file);
    char folder[2000], place[2200], text[2600];
    assert_non_null(getcwd(folder, sizeof folder));
    for (size_t k = 0; k < 2 * sizeof cases / sizeof cases[0]; k += stride(7)) {
        snprintf(place, sizeof place, "%s%s%s%s", k % 2 ? "file://" : "", k % 2 ? folder : "", k % 2 ? "/" : "", name);
        const char *format = cases[k / 2].format, *hole = strstr(format, "%s");
        const int size = snprintf(text, sizeof text, "%.*s%s%s", (int)(hole - format), format, place, hole + 2);
        expect_wrong_text(read_usual, text, (size_t)size, NARC_ERROR_FORMAT, cases[k / 2].line, cases[k / 2].words);
    }
    remove(name);
}

/* A file of a kilobyte that would be 10^10 times its path; elements 100,000 deep. */
TEST(ends_what_multiplies) {
    enum { DEEP = 100000 };
    AUTO(free_at) char *text = malloc(DEEP * 3 + 100);
    assert_non_null(text);
    size_t size = (size_t)sprintf(text, "<!DOCTYPE svg [<!ENTITY a0 'h1v1h1v1h1v1h1v1'>");
    for (int level = 1; level <= 10; level++) {
        size += (size_t)sprintf(text + size, "<!ENTITY a%d '", level);
        for (int k = 0; k < 10; k++)
            size += (size_t)sprintf(text + size, "&a%d;", level - 1);
        size += (size_t)sprintf(text + size, "'>");
    }
    size += (size_t)sprintf(text + size, "]><svg xmlns='http://www.w3.org/2000/svg'><path d='M0 0&a10;'/></svg>");
    expect_wrong_text(read_usual, text, size, NARC_ERROR_FORMAT, 1, "not SVG: ");
    size = (size_t)sprintf(text, "<svg xmlns='http://www.w3.org/2000/svg'>");
    for (int k = 0; k < DEEP; k++)
        size += (size_t)sprintf(text + size, "<g>");
    expect_wrong_text(read_usual, text, size, NARC_ERROR_FORMAT, 1, "not SVG: ");
}

TEST(survives_changed_bytes) {
    static const char good[] =
        "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 10 10' width='10' height='10'>\n<style>.a{fill:none}#b,"
        "path{stroke:red}</style>\n<g transform='translate(1,2)rotate(30 1 1)'><path id='b' class='a' d='M1.5.5-3e2 4"
        "v2H5V6h1Cc1 2 3 4 5 6s1 2 3 4A1 2 3 0110 10z'/><rect x='1mm' y='2%' width='3' height='4' rx='1'/></g></svg>";
    struct test_random random = test_random_named("svg bytes");
    size_t read = 0, trials = test_trials(400);
    for (size_t trial = 0; trial < trials; trial++) {
        char text[sizeof good];
        memcpy(text, good, sizeof good);
        for (size_t count = 1 + random_below(&random, 3); count > 0; count--) {
            const size_t at = random_below(&random, sizeof good - 1);
            text[at] = (char)(text[at] ^ 1 << random_below(&random, 8));
        }
        narc_path *path = make_occupied_path();
        narc_error error = {.message = ""};
        const narc_status status = read_exactly(read_usual, text, sizeof good - 1, path, &error);
        read += finish_any_bytes(status, &error, 1u << NARC_ERROR_FORMAT | 1u << NARC_ERROR_SIZE, SIZE_MAX, path);
    }
    assert_true(read > 0 && read < trials);
}

/* One element of several, where it is on the page; an id that is not there is an error. */
TEST(test_elements) {
    static const char body[] = "<g id='a' transform='translate(1 2)'><rect width='2' height='4'/></g>"
                               "<rect id='b' x='7' y='1' width='1' height='1'/>";
    const narc_point reach = measure_reach(body, (narc_image_request){.element = "a"});
    const narc_point other = measure_reach(body, (narc_image_request){.element = "b"});
    assert_true(fabs(reach.x - 3) <= 0.01 && fabs(reach.y + 2) <= 0.01);
    assert_true(fabs(other.x - 8) <= 0.01 && fabs(other.y + 1) <= 0.01);
    static const char text[] = "<svg xmlns='http://www.w3.org/2000/svg'><rect id='a' width='1' height='1'/></svg>";
    AUTO(narc_destroy_path_at) narc_path *path = make_path();
    narc_error error = {.message = ""};
    const narc_status status =
        narc_read_svg(text, sizeof text - 1, &(narc_image_request){.element = "c"}, path, &error);
    expect_error(status, NARC_ERROR_INDEX, &error, "'c'");
}

TEST_MAIN("SVG")
