/* SPDX-License-Identifier: MIT
 *
 * fit_support.c - what the tests of paths and their readers share.
 */
#include "fit_support.h"

#include <math.h>
#include <stdint.h>
#include <string.h>

static const narc_point triangle[] = {{0.25, 0.5}, {3, 0.125}, {1, 2}};

void expect_fit_error(narc_status status, narc_status expected, const narc_error *error, const char *words) {
    if (status != expected) {
        fail_msg("got %s, expected %s (%s)", narc_status_name(status), narc_status_name(expected), words);
    }
    if (error->status != expected) {
        fail_msg("the error says %s, not %s", narc_status_name(error->status), narc_status_name(expected));
    }
    if (!strstr(error->message, words)) {
        fail_msg("the message is \"%s\", it should mention \"%s\"", error->message, words);
    }
    const size_t length = strlen(error->message);
    if (length == 0 || strchr(error->message, '\n') || error->message[length - 1] == '.') {
        fail_msg("not one line without a full stop: \"%s\"", error->message);
    }
}

void expect_fit_ok(narc_status status, const narc_error *error) {
    if (status != NARC_OK) {
        fail_msg("%s: %s", narc_status_name(status), error->message);
    }
}

narc_path *make_path(void) {
    narc_path *path = NULL;
    assert_int_equal(narc_create_path(&path), NARC_OK);
    assert_non_null(path);
    return path;
}

void draw_polygon(narc_path *path, const narc_point *points, size_t count) {
    narc_error error;
    expect_fit_ok(narc_move_to(path, points[0], &error), &error);
    for (size_t i = 1; i < count; i++) {
        expect_fit_ok(narc_line_to(path, points[i], &error), &error);
    }
}

narc_contours flatten(const narc_path *path) {
    narc_contours contours;
    narc_error error;
    expect_fit_ok(narc_flatten_path(path, 0, &contours, &error), &error);
    return contours;
}

narc_path *make_occupied_path(void) {
    narc_path *path = make_path();
    draw_polygon(path, triangle, 3);
    return path;
}

void expect_unchanged(const narc_path *occupied) {
    narc_contours contours = flatten(occupied);
    assert_int_equal(contours.count, 1);
    assert_int_equal(contours.ends[0], 3);
    assert_int_equal(contours.point_count, 3);
    assert_memory_equal(contours.points, triangle, sizeof triangle);
    narc_release_contours(&contours);
}

int find_whole_orientation(narc_point a, narc_point b, narc_point c) {
    /* Differences are below 2^31, products below 2^62. */
    const int64_t x = (int64_t)b.x - (int64_t)a.x, y = (int64_t)b.y - (int64_t)a.y;
    const int64_t left = x * ((int64_t)c.y - (int64_t)a.y), right = y * ((int64_t)c.x - (int64_t)a.x);
    return (left > right) - (left < right);
}

static bool is_in_box(narc_point p, narc_point a, narc_point b) {
    return p.x >= fmin(a.x, b.x) && p.x <= fmax(a.x, b.x) && p.y >= fmin(a.y, b.y) && p.y <= fmax(a.y, b.y);
}

bool sides_meet(narc_point p, narc_point q, narc_point r, narc_point s, bool follows,
                int orientation(narc_point, narc_point, narc_point)) {
    if (follows) { /* more in common than q: then an end of one is on the other */
        return (orientation(p, q, s) == 0 && is_in_box(s, p, q)) || (orientation(r, s, p) == 0 && is_in_box(p, r, s));
    }
    const int a = orientation(p, q, r), b = orientation(p, q, s), c = orientation(r, s, p), d = orientation(r, s, q);
    return (a * b < 0 && c * d < 0) || (a == 0 && is_in_box(r, p, q)) || (b == 0 && is_in_box(s, p, q)) ||
           (c == 0 && is_in_box(p, r, s)) || (d == 0 && is_in_box(q, r, s));
}

double measure_distance(narc_point p, narc_point a, narc_point b) {
    const double x = b.x - a.x, y = b.y - a.y, to_x = p.x - a.x, to_y = p.y - a.y, length = x * x + y * y;
    const double t = length > 0 ? fmin(1, fmax(0, (to_x * x + to_y * y) / length)) : 0;
    return hypot(to_x - t * x, to_y - t * y);
}
