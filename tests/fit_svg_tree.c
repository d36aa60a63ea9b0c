/* SPDX-License-Identifier: MIT
 *
 * fit_svg_tree.c - SVG files: transforms, nested coordinate systems, what uses show, and what is not drawn.
 */
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "fit_svg.h"

static const double RADIANS = 3.14159265358979323846 / 180;

/* ---------------------------------------------------------------------------- transforms */

/* 3 x 3 matrices, the slow obvious way. */
struct matrix {
    double m[3][3];
};

static struct matrix multiply(const struct matrix *a, const struct matrix *b) {
    struct matrix c = {{{0}}};
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            for (int k = 0; k < 3; k++) {
                c.m[i][j] += a->m[i][k] * b->m[k][j];
            }
        }
    }
    return c;
}

/* One random function as text and as a matrix; *moves: it turns about a point, so that its own matrix is a product. */
static struct matrix random_function(struct test_random *random, char *text, size_t size, bool *moves) {
    double n[6];
    for (int k = 0; k < 6; k++) {
        n[k] = random_between(random, -2, 2);
    }
    const double angle = random_between(random, -180, 180), c = cos(angle * RADIANS), s = sin(angle * RADIANS);
    const struct matrix there = {{{1, 0, n[0]}, {0, 1, n[1]}, {0, 0, 1}}};
    const struct matrix back = {{{1, 0, -n[0]}, {0, 1, -n[1]}, {0, 0, 1}}};
    const struct matrix turn = {{{c, -s, 0}, {s, c, 0}, {0, 0, 1}}};
    struct matrix turned;
    const size_t kind = random_below(random, 9);
    *moves = kind == 6;
    switch (kind) {
    case 0:
        snprintf(text, size, "matrix(%.17g,%.17g %.17g %.17g , %.17g %.17g)", n[0], n[1], n[2], n[3], n[4], n[5]);
        return (struct matrix){{{n[0], n[2], n[4]}, {n[1], n[3], n[5]}, {0, 0, 1}}};
    case 1:
        snprintf(text, size, "translate(%.17g %.17g)", n[0], n[1]);
        return there;
    case 2:
        snprintf(text, size, "translate ( %.17g )", n[0]);
        return (struct matrix){{{1, 0, n[0]}, {0, 1, 0}, {0, 0, 1}}};
    case 3:
        snprintf(text, size, "scale(%.17g,%.17g)", n[0], n[1]);
        return (struct matrix){{{n[0], 0, 0}, {0, n[1], 0}, {0, 0, 1}}};
    case 4:
        snprintf(text, size, "scale(%.17g)", n[0]);
        return (struct matrix){{{n[0], 0, 0}, {0, n[0], 0}, {0, 0, 1}}};
    case 5:
        snprintf(text, size, "rotate(%.17g)", angle);
        return turn;
    case 6:
        snprintf(text, size, "rotate(%.17g %.17g %.17g)", angle, n[0], n[1]);
        turned = multiply(&there, &turn);
        return multiply(&turned, &back);
    case 7:
        snprintf(text, size, "skewX(%.17g)", angle / 4);
        return (struct matrix){{{1, tan(angle / 4 * RADIANS), 0}, {0, 1, 0}, {0, 0, 1}}};
    default:
        snprintf(text, size, "skewY(%.17g)", angle / 4);
        return (struct matrix){{{1, 0, 0}, {tan(angle / 4 * RADIANS), 1, 0}, {0, 0, 1}}};
    }
}

/* Lists of up to 3 functions on 3 elements inside each other: at most 9 matrices, each with 3 terms in an entry. Both
 * ways round, so the outcome differs by some DBL_EPSILON times the product of the matrices of absolute values. For a
 * turn about a point, whose terms may cancel, 10 is above all terms: |x| + c |x| + s |y| with |x|, |y| <= 2. */
static void multiplies_transforms(void **state) {
    (void)state;
    static const narc_point corners[3] = {{1, 2}, {3, -1}, {-2, 1}};
    struct test_random random = test_random_named("svg transforms");
    for (size_t trial = 0; trial < test_trials(1000); trial++) {
        char body[4000] = "", text[300];
        struct matrix all = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}}, size = all;
        for (int level = 0; level < 3; level++) {
            static const char *const tags[] = {"<g transform='",
                                               "<a style='fill:red;transform:", "<polygon transform=\""};
            strcat(body, tags[level]);
            for (size_t k = random_below(&random, 4); k > 0; k--) {
                bool moves;
                struct matrix next = random_function(&random, text, sizeof(text), &moves);
                all = multiply(&all, &next);
                for (int i = 0; i < 9; i++) {
                    const bool product = moves && i % 3 == 2 && i < 6;
                    next.m[i / 3][i % 3] = product ? 10 : fabs(next.m[i / 3][i % 3]);
                }
                size = multiply(&size, &next);
                strcat(strcat(body, text), random_below(&random, 2) ? "," : " \n");
            }
            strcat(body, level < 2 ? "'>" : "\"");
        }
        strcat(body, " points='1 2 3-1-2 1' stroke='red'/></a></g>");
        struct op ops[4] = {{0}};
        double scale = 0;
        for (int k = 0; k < 3; k++) {
            ops[k].kind = k ? 'L' : 'M';
            for (int i = 0; i < 2; i++) {
                ops[k].n[i] = all.m[i][0] * corners[k].x + all.m[i][1] * corners[k].y + all.m[i][2];
                scale = fmax(scale, size.m[i][0] * 3 + size.m[i][1] * 2 + size.m[i][2]);
            }
        }
        /* 9 products of matrices and that with the point, each with 3 roundings in an entry, and 2 more in the
         * functions' own entries; on both sides. */
        expect_outline_near(body, ops, 2 * 10 * 5 * 0x1p-53 * scale);
    }
}

static void knows_transforms_that_do_nothing(void **state) {
    (void)state;
    const struct op ops[] = {{'M', {1, 2}}, {'L', {3, -1}}, {'L', {-2, 1}}, {0}};
    static const char *const texts[] = {"", " ", "none", "translate(0)", "rotate(0 7,9)", "matrix(1 0 0 1 0 0)"};
    for (size_t k = 0; k < 6; k++) {
        char body[100];
        snprintf(body, sizeof(body), "<polygon transform='%s' points='1 2 3-1-2 1'/>", texts[k]);
        expect_outline(body, ops);
    }
    expect_outline("<polygon style='transform:translate(4px, -8px) rotate(0deg)' points='1 2 3-1-2 1'/>",
                   (struct op[]){{'M', {5, -6}}, {'L', {7, -9}}, {'L', {2, -7}}, {0}});
}

/* ---------------------------------------------------------------------------- views and uses */

/* The triangle (0, 0), (4, 0), (4, 2), mapped by x -> x0 + sx x and y -> y0 + sy y. */
static void expect_triangle(const char *body, double x0, double y0, double sx, double sy) {
    expect_outline_near(
        body, (struct op[]){{'M', {x0, y0}}, {'L', {x0 + 4 * sx, y0}}, {'L', {x0 + 4 * sx, y0 + 2 * sy}}, {0}},
        1e-13); /* some roundings of numbers up to 100 */
}

/* A view of 100 x 50 at (10, 20), the box from (0, 0) to (10, 10): a scale of 5 leaves 50 to the sides, one of 10 takes
 * 50 more in height than there is. */
static void places_view_boxes(void **state) {
    (void)state;
    static const struct {
        const char *aspect;
        double x, y, sx, sy;
    } cases[] = {
        {"", 35, 20, 5, 5},
        {"preserveAspectRatio='xMidYMid'", 35, 20, 5, 5},
        {"preserveAspectRatio=' defer xMinYMax meet '", 10, 20, 5, 5},
        {"preserveAspectRatio='xMaxYMin meet'", 60, 20, 5, 5},
        {"preserveAspectRatio='none'", 10, 20, 10, 5},
        {"preserveAspectRatio='xMidYMin slice'", 10, 20, 10, 10},
        {"preserveAspectRatio='xMinYMid slice'", 10, -5, 10, 10},
        {"preserveAspectRatio='xMaxYMax slice'", 10, -30, 10, 10},
    };
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        char body[500];
        snprintf(body, sizeof(body),
                 "<svg x='10' y='20' width='100' height='50' viewBox='0 0 10 10' %s><path d='M0 0h4v2'/></svg>",
                 cases[k].aspect);
        expect_triangle(body, cases[k].x, cases[k].y, cases[k].sx, cases[k].sy);
    }
    expect_triangle("<svg x='10' y='20'><path d='M0 0h4v2'/></svg>", 10, 20, 1, 1);
    expect_triangle("<g transform='scale(2)'><svg x='10' y='20' width='8' height='8' viewBox='1,3,4 4'>"
                    "<path d='M1 3h4v2'/></svg></g>",
                    20, 40, 4, 4);
    /* Views and boxes without a size show nothing. */
    expect_triangle("<path d='M0 0h4v2'/><svg width='0'><path d='M0 0h9v9'/></svg><svg width='5' height='5' "
                    "viewBox='0 0 0 9'><path d='M0 0h9v9'/></svg>",
                    0, 0, 1, 1);
}

static void shows_uses(void **state) {
    (void)state;
    expect_triangle("<defs><path id='a' d='M0 0h4v2'/></defs><use href='#a' x='3' y='5'/>", 3, 5, 1, 1);
    expect_triangle("<use xlink:href='#a' x='3' transform='scale(2)'/><defs><path id='a' d='M0 0h4v2'/></defs>", 6, 0,
                    2, 2);
    expect_triangle(
        "<defs><g id='b' transform='translate(1 1)'><use href='#a' y='5'/></g>"
        "<path id='a' transform='scale(3)' d='M0 0h4v2'/></defs><use xlink:href='#nothing' href='#b' x='3'/>",
        4, 6, 3, 3);
    expect_triangle("<symbol id='a'><path d='M0 0h4v2'/></symbol><use href='#a' x='3' y='5'/>", 3, 5, 1, 1);
    expect_triangle("<symbol id='a' viewBox='0 0 4 2'><path d='M0 0h4v2'/></symbol>"
                    "<use href='#a' x='3' y='5' width='40' height='40'/>",
                    3, 15, 10, 10);
    expect_triangle("<symbol id='a' viewBox='0 0 4 2' width='8' height='4'><path d='M0 0h4v2'/></symbol>"
                    "<use href='#a' x='3' y='5' height='40'/>",
                    3, 23, 2, 2);
    expect_triangle("<defs><svg id='a' x='1' viewBox='0 0 4 2' width='4' height='2'><path d='M0 0h4v2'/></svg></defs>"
                    "<use href='#a' x='3' y='5' width='8' height='4'/>",
                    4, 5, 2, 2);
    /* A target that is not there shows nothing; nor does one that is not drawn. */
    expect_triangle("<path d='M0 0h4v2'/><use href='#b'/><use/><use href='#'/><clipPath id='c'><path d='M0 0h9v9'/>"
                    "</clipPath><use href='#c'/>",
                    0, 0, 1, 1);
    /* The first element with an id counts. Two uses are two contours. */
    narc_contours contours = read_body("<defs><path id='a' d='M0 0h4v2'/><rect id='a' width='9' height='9'/></defs>"
                                       "<use href='#a'/><use href='#a'/>");
    assert_int_equal(contours.count, 2);
    assert_int_equal(contours.point_count, 6);
    narc_release_contours(&contours);
}

/* ---------------------------------------------------------------------------- what is drawn */

/* How many contours come out, beside the triangle that each body has anyway. */
static void expect_more(const char *more, size_t count) {
    char body[1000];
    snprintf(body, sizeof(body), "<path d='M0 0h4v2'/>%s", more);
    narc_contours contours = read_body(body);
    if (contours.count != count + 1) {
        fail_msg("%s: %zu contours, not %zu", more, contours.count - 1, count);
    }
    narc_release_contours(&contours);
}

static void leaves_out_what_is_not_drawn(void **state) {
    (void)state;
    static const char *const containers[] = {
        "defs", "clipPath", "mask",           "pattern", "marker", "symbol",        "title",   "desc",  "metadata",
        "text", "image",    "linearGradient", "filter",  "style",  "foreignObject", "unknown", "script"};
    for (size_t k = 0; k < sizeof(containers) / sizeof(containers[0]); k++) {
        char more[200];
        snprintf(more, sizeof(more), "<%s><g><rect width='9' height='9'/></g></%s>", containers[k], containers[k]);
        expect_more(more, 0);
    }
    static const char *const shown[] = {"g", "svg", "a", "switch"};
    for (size_t k = 0; k < sizeof(shown) / sizeof(shown[0]); k++) {
        char more[200];
        snprintf(more, sizeof(more), "<%s><rect width='9' height='9'/></%s>", shown[k], shown[k]);
        expect_more(more, 1);
    }
    expect_more("<i:g xmlns:i='urn:other'><rect width='9' height='9'/></i:g><i:rect xmlns:i='urn:other' width='9' "
                "height='9'/>",
                0);
    expect_more("<s:rect xmlns:s='http://www.w3.org/2000/svg' width='9' height='9'/>", 1);
    expect_more("<switch><foreignObject requiredExtensions='x'/><g systemLanguage='de'><rect width='1' height='1'/></g>"
                "<g><rect width='9' height='9'/><circle r='1'/></g><g><rect width='9' height='9'/></g></switch>",
                2);
    /* Shapes without a size or data, and contours that are only lines without a stroke, or only dots without caps. */
    expect_more(
        "<rect width='9'/><rect height='9'/><circle/><ellipse rx='0' ry='3'/><path/><path d=''/><path d='none'/>"
        "<polygon/><polyline points=' '/><path d='M1 1'/>",
        0);
    expect_more("<line x2='3'/><path d='M0 0L5 5 2 2'/><polygon points='3 4'/><polygon points='3 4 3 4'/>"
                "<path d='M0 0h9v9zM100 100C100 100 100 100 100 100z' stroke='red'/>",
                1);
    expect_more("<g stroke='red'><line x2='3'/><path d='M0 0L5 5 2 2'/><path d='M3 3h0' stroke-linecap='round'/></g>",
                3);
}

/* Attributes of a rectangle in a group, and whether it is seen. */
static void knows_what_is_invisible(void **state) {
    (void)state;
    static const struct {
        const char *group, *shape;
        size_t seen;
    } cases[] = {
        {"", "", 1},
        {"display='none'", "", 0},
        {"", "display='none'", 0},
        {"", "style='display : none'", 0},
        {"", "style='display:inline' display='none'", 1},
        {"display='none'", "display='inline'", 0},
        {"", "visibility='hidden'", 0},
        {"visibility='collapse'", "", 0},
        {"visibility='hidden'", "visibility='visible'", 1},
        {"visibility='hidden'", "visibility='inherit'", 0},
        {"", "opacity='0'", 0},
        {"style='opacity:0.0'", "opacity='1'", 0},
        {"opacity='0.01'", "", 1},
        {"", "fill='none'", 0},
        {"fill='none'", "", 0},
        {"fill='none'", "fill='inherit'", 0},
        {"fill='none'", "fill='blue'", 1},
        {"fill='none'", "stroke='blue'", 1},
        {"fill='none' stroke='blue'", "stroke='none'", 0},
        {"fill='none' stroke='blue'", "stroke-width='0'", 0},
        {"fill='none' stroke='blue' stroke-opacity='0%'", "", 0},
        {"fill-opacity='0'", "", 0},
        {"fill-opacity='0'", "fill-opacity='.5'", 1},
        {"fill-opacity='0'", "style='stroke:#fff'", 1},
        {"", "fill='transparent'", 0},
        {"", "fill='url(#none)'", 1},
        {"", "style='a:url(data:x;fill:none);b:\";fill:none\";stroke:none'", 1},
        {"", "style='fill:red;fill:none !important;;:;x'", 0},
        {"", "class='a'", 0},
        {"", "class=' x  b a '", 1},
        {"", "class='b'", 1},
        {"class='a'", "", 0},
        {"class='a'", "style='fill:red'", 1},
        {"", "class='a' fill='red'", 0},
        {"", "class='a' id='c'", 1},
        {"", "class='d'", 0},
        {"", "class='e'", 1},
        {"", "class='f'", 0},
        {"", "id='g'", 0},
        {"", "id='h' class='a'", 0},
        {"fill-opacity='0'", "", 1}, /* the rule for all elements */
        {"fill-opacity='0'", "style='fill-opacity:0'", 0},
    };
    static const char sheet[] = "<style>.a, rect.x{fill:none}/*.b{display:none}*/ .b{fill:red} #c{fill:red}"
                                "rect{stroke:none} *{fill-opacity:1;stroke:red} .d{ fill : none }@media "
                                "print{.e{fill:none}}@import 'x';.e .b{fill:none}"
                                "</style><style><![CDATA[<!-- .f{fill:none} --> #g,#h{fill:none}]]></style>";
    for (size_t k = 0; k < sizeof(cases) / sizeof(cases[0]); k++) {
        char more[800];
        snprintf(more, sizeof(more), "<g %s><rect width='9' height='9' %s/></g>%s", cases[k].group, cases[k].shape,
                 k < 28 ? "" : sheet);
        expect_more(more, cases[k].seen);
    }
}

int test_svg_tree(void) {
    const struct CMUnitTest tests[] = {
        cmocka_unit_test(multiplies_transforms),
        cmocka_unit_test(knows_transforms_that_do_nothing),
        cmocka_unit_test(places_view_boxes),
        cmocka_unit_test(shows_uses),
        cmocka_unit_test(leaves_out_what_is_not_drawn),
        cmocka_unit_test(knows_what_is_invisible),
    };
    return cmocka_run_group_tests_name("SVG tree", tests, NULL, NULL);
}
