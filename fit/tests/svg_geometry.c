/* SPDX-License-Identifier: MIT
 *
 * svg_geometry.c - plain SVG drawings: their geometry beside what is traced, and what is not plain.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "fit_support.h"

static narc_path *read_drawing(const char *body, bool trace, bool *out_exact) {
    char text[1000];
    const int size =
        snprintf(text, sizeof text, "<svg xmlns='http://www.w3.org/2000/svg' viewBox='0 0 100 100'>%s</svg>", body);
    assert_true(size > 0 && (size_t)size < sizeof text);
    narc_path *path = make_path();
    narc_error error = {.message = ""};
    const narc_image_request request = {.trace = trace, .out_exact = out_exact};
    expect_ok(narc_read_svg(text, (size_t)size, &request, path, &error), &error);
    return path;
}

static double sum_areas(const narc_contours *contours) {
    double twice = 0;
    for (size_t c = 0, begin = 0; c < contours->count; begin = contours->ends[c++]) {
        double own = 0;
        for (size_t k = begin; k < contours->ends[c]; k++) {
            const narc_point p = contours->points[k], q = contours->points[k + 1 < contours->ends[c] ? k + 1 : begin];
            own += p.x * q.y - p.y * q.x;
        }
        twice += fabs(own);
    }
    return twice / 2;
}

/* Areas of all contours, up to chords, against what is traced and the true ones. */
TEST(test_geometry) {
    static const struct {
        const char *body;
        double area;
        size_t contours;
    } cases[] = {
        {"<circle cx='50' cy='50' r='40'/>", PI * 1600, 1},
        {"<g transform='translate(10 20)'><g transform='rotate(30) scale(2)'><circle cx='20' cy='6' r='5' "
         "style='fill:#f00;stroke:none'/></g></g>",
         PI * 100, 1},
        {"<ellipse cx='50' cy='50' rx='40' ry='10' transform='rotate(20 50 50)'/>", PI * 400, 1},
        {"<rect x='10' y='10' width='40' height='30' rx='5'/>", 1200 - (4 - PI) * 25, 1},
        {"<rect x='10' y='10' width='40' height='30' rx='5' ry='50'/>", 1200 - (4 - PI) * 75, 1},
        {"<circle cx='50' cy='50' r='20' fill='none' stroke='red' stroke-width='4'/>", PI * (22 * 22 + 18 * 18), 2},
        {"<rect x='20' y='20' width='40' height='30' fill='none' stroke='red' stroke-width='4'/>", 44 * 34 + 36 * 26,
         2},
        {"<rect x='20' y='20' width='40' height='30' stroke='red' stroke-width='4' stroke-linejoin='round'/>",
         44 * 34 - (4 - PI) * 4, 1},
        {"<line x1='10' y1='20' x2='40' y2='60' stroke='red' stroke-width='6'/>", 300, 1},
        {"<line x1='10' y1='20' x2='40' y2='60' stroke='red' stroke-width='6' stroke-linecap='round'/>", 300 + PI * 9,
         1},
        {"<line x1='10' y1='20' x2='40' y2='60' stroke='red' stroke-width='6' stroke-linecap='square'/>", 336, 1},
        {"<polygon points='10,10 30,10 30,40'/><polyline points='50 50 60 50 60 60'/>", 350, 2},
        {"<path d='M10 10h20v20h-20zm5 5v10h10v-10z'/>", 500, 2},
        {"<path d='M10 10h20v20h-20zm5 5h10v10h-10z'/>", 400, 1},
        {"<path fill-rule='evenodd' d='M10 10h20v20h-20zm5 5h10v10h-10z'/>", 500, 2},
        {"<path d='M10 10H30V30H10Z'/><rect x='15' y='15' width='3' height='3' fill='red'/>", 400, 1},
        {"<path d='M20 50a10 10 0 0 1 20 0a10 10 0 01-20 0z'/>", PI * 100, 1},
        {"<path d='M30 50A20 20 0 1 0 50 30L50 50z'/>", PI * 300, 1},
        {"<path d='M30 50A20 20 0 1 1 50 70L50 50z'/>", PI * 300, 1},
        {"<path d='M30 50A20 20 0 0 0 50 70L50 50z'/>", PI * 100, 1},
        {"<path d='M30 50a5 5 30 0 1 40 0z'/>", PI * 200, 1},
        {"<path d='M20 20C20 40 40 40 40 20S60 0 60 20T80 20V80H20Z'/>", 0, 1},
        {"<path d='M20 20h30v30h-30z M 60 60 h10 v10 x 9 9'/>", 950, 2},
        {"<defs><circle id='a' r='9'/></defs><title>t</title><rect x='20' y='20' width='9' height='9'/>", 81, 1},
    };
    for (size_t k = 0; k < sizeof cases / sizeof cases[0]; k += stride(3)) {
        bool exact = false;
        double areas[2];
        for (int way = 0; way < 2; way++) {
            AUTO(narc_destroy_path_at) narc_path *path = read_drawing(cases[k].body, way == 1, way ? NULL : &exact);
            AUTO(narc_release_contours) narc_contours contours = flatten(path);
            areas[way] = sum_areas(&contours);
            if (contours.count != cases[k].contours)
                fail_msg("%s: %zu contours, way %d", cases[k].body, contours.count, way);
        }
        if (!exact || fabs(areas[0] - areas[1]) > 3e-3 * areas[0] ||
            (cases[k].area > 0 && fabs(areas[0] - cases[k].area) > 2e-4 * areas[0]))
            fail_msg("%s: areas %.9g, traced %.9g, true %.9g", cases[k].body, areas[0], areas[1], cases[k].area);
    }
}

/* What is not plain is drawn. */
TEST(test_what_is_not_plain) {
    static const char *const bodies[] = {
        "<rect width='20' height='20'/><rect x='10' y='10' width='20' height='20'/>",
        "<rect width='20' height='20'/><rect x='20' width='20' height='20'/>",
        "<circle cx='50' cy='50' r='60'/>",
        "<circle cx='50' cy='50' r='20' filter='url(#f)'/>",
        "<style>circle{fill:none}</style><circle cx='50' cy='50' r='20'/><rect width='9' height='9'/>",
        "<circle cx='50' cy='50' r='20' opacity='0.2'/><rect width='9' height='9'/>",
        "<circle cx='50' cy='50' r='20' fill='none' stroke='red' stroke-dasharray='4 4'/>",
        "<path d='M20 20L60 20L60 60' fill='none' stroke='red'/>",
        "<path d='M20 20L60 60L60 20L20 60z'/>",
        "<g clip-path='url(#c)'><circle r='50'/></g><clipPath id='c'><rect width='40' height='40'/></clipPath>",
        "<rect width='20%' height='20'/>",
    };
    for (size_t k = 0; k < sizeof bodies / sizeof bodies[0]; k += stride(3)) {
        bool exact = true;
        narc_destroy_path(read_drawing(bodies[k], false, &exact));
        if (exact)
            fail_msg("%s: taken as plain", bodies[k]);
    }
}

TEST_MAIN("SVG geometry")
