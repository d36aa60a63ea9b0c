/* SPDX-License-Identifier: MIT
 *
 * fit_svg.c - what the tests of the SVG reader share.
 */
#include "fit_svg.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

narc_contours read_root(const char *attributes, const char *body) {
    static const char format[] = "<svg xmlns='http://www.w3.org/2000/svg' "
                                 "xmlns:xlink='http://www.w3.org/1999/xlink' %s>\n%s\n</svg>\n";
    const size_t capacity = sizeof(format) + strlen(attributes) + strlen(body);
    char *text = malloc(capacity);
    assert_non_null(text);
    const int size = snprintf(text, capacity, format, attributes, body);
    narc_path *path = make_path();
    narc_error error = {.message = ""};
    const narc_status status = narc_read_svg(text, (size_t)size, path, &error);
    if (status) {
        fail_msg("%s: %s", body, error.message);
    }
    const narc_contours contours = flatten(path);
    narc_destroy_path(path);
    free(text);
    return contours;
}

narc_contours read_body(const char *body) { return read_root("", body); }

static narc_path *draw_ops(const struct op *ops) {
    narc_path *path = make_path();
    narc_status status = NARC_OK;
    for (const struct op *op = ops; op->kind && !status; op++) {
        const narc_point a = {op->n[0], -op->n[1]}, b = {op->n[2], -op->n[3]}, c = {op->n[4], -op->n[5]};
        status = op->kind == 'M'   ? narc_move_to(path, a, NULL)
                 : op->kind == 'L' ? narc_line_to(path, a, NULL)
                 : op->kind == 'Q' ? narc_quadratic_to(path, a, b, NULL)
                                   : narc_cubic_to(path, a, b, c, NULL);
    }
    assert_int_equal(status, NARC_OK);
    return path;
}

void expect_outline_near(const char *body, const struct op *ops, double tolerance) {
    narc_path *path = draw_ops(ops);
    narc_contours expected = flatten(path), got = read_body(body);
    if (got.count != expected.count || got.point_count != expected.point_count) {
        fail_msg("%s: %zu contours and %zu points, not %zu and %zu", body, got.count, got.point_count, expected.count,
                 expected.point_count);
    }
    for (size_t k = 0; k < got.count; k++) {
        assert_int_equal(got.ends[k], expected.ends[k]);
    }
    for (size_t k = 0; k < got.point_count; k++) {
        const narc_point a = got.points[k], b = expected.points[k];
        if (!(fabs(a.x - b.x) <= tolerance && fabs(a.y - b.y) <= tolerance)) {
            fail_msg("%s: point %zu is (%.17g, %.17g), not (%.17g, %.17g)", body, k, a.x, -a.y, b.x, -b.y);
        }
    }
    narc_release_contours(&expected);
    narc_release_contours(&got);
    narc_destroy_path(path);
}

void expect_outline(const char *body, const struct op *ops) { expect_outline_near(body, ops, 0); }
