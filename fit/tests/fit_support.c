/* SPDX-License-Identifier: MIT
 *
 * fit_support.c - what the tests of paths and their readers share.
 */
#include "fit_support.h"

#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const narc_point triangle[] = {{0.25, 0.5}, {3, 0.125}, {1, 2}};

size_t stride(size_t step) { return test_trials(10) < 10 ? step : 1; }

unsigned char *read_file(const char *name, size_t *out_size) {
    FILE *file = fopen(name, "rb");
    if (!file)
        fail_msg("%s can't be read", name);
    assert_int_equal(fseek(file, 0, SEEK_END), 0);
    *out_size = (size_t)ftell(file);
    rewind(file);
    unsigned char *data = malloc(*out_size);
    assert_non_null(data);
    assert_int_equal(fread(data, 1, *out_size, file), *out_size);
    fclose(file);
    return data;
}

unsigned read_big_endian(const unsigned char *at, int size) {
    unsigned value = 0;
    for (int i = 0; i < size; i++)
        value = value << 8 | at[i];
    return value;
}

narc_path *make_path(void) {
    narc_path *path = NULL;
    assert_int_equal(narc_create_path(&path), NARC_OK);
    assert_non_null(path);
    return path;
}

void draw_polygon(narc_path *path, const narc_point *points, size_t count) {
    narc_error error;
    expect_ok(narc_move_to(path, &points[0], &error), &error);
    for (size_t i = 1; i < count; i++)
        expect_ok(narc_line_to(path, &points[i], &error), &error);
}

narc_contours flatten(const narc_path *path) {
    narc_contours contours;
    narc_error error;
    expect_ok(narc_flatten_path(path, 0, &contours, &error), &error);
    return contours;
}

narc_path *make_occupied_path(void) {
    narc_path *path = make_path();
    draw_polygon(path, triangle, 3);
    return path;
}

void expect_unchanged(const narc_path *occupied) {
    AUTO(narc_release_contours) narc_contours contours = flatten(occupied);
    assert_int_equal(contours.count, 1);
    assert_int_equal(contours.ends[0], 3);
    assert_int_equal(contours.point_count, 3);
    assert_memory_equal(contours.points, triangle, sizeof triangle);
}

bool finish_any_bytes(narc_status status, const narc_error *error, unsigned allowed, size_t most, narc_path *occupied) {
    if (status) {
        expect_error(status, error->status, error, "");
        if (!(allowed >> status & 1))
            fail_msg("%s is none of the errors of damaged data: %s", narc_status_name(status), error->message);
        expect_unchanged(occupied);
    } else {
        AUTO(narc_release_contours) narc_contours contours = flatten(occupied);
        assert_true(contours.count > 1 && contours.count <= most);
    }
    narc_destroy_path(occupied);
    return status == NARC_OK;
}

narc_status read_exactly(reader *read, const char *text, size_t size, narc_path *path, narc_error *error) {
    AUTO(free_at) char *data = malloc(size ? size : 1);
    assert_non_null(data);
    memcpy(data, text, size);
    return read(data, size, path, error);
}

void expect_wrong_text(reader *read, const char *text, size_t size, narc_status status, size_t line,
                       const char *words) {
    AUTO(narc_destroy_path_at) narc_path *path = make_occupied_path();
    narc_error error = {.message = "?"};
    char beginning[32];
    expect_error(read_exactly(read, text, size, path, &error), status, &error, words);
    if (error.index != line)
        fail_msg("line %zu, not %zu: %s", error.index, line, error.message);
    snprintf(beginning, sizeof beginning, "line %zu", line);
    const size_t length = strlen(beginning);
    assert_true(line == 0 || (strncmp(error.message, beginning, length) == 0 && strchr(":,", error.message[length])));
    expect_unchanged(path);
    assert_int_equal(read_exactly(read, text, size, path, NULL), status);
    expect_unchanged(path);
}

double measure_area(const narc_contours *contours, size_t k) {
    const size_t first = k ? contours->ends[k - 1] : 0, end = contours->ends[k];
    double sum = 0;
    for (size_t i = first; i < end; i++) {
        const narc_point a = contours->points[i], b = contours->points[i + 1 < end ? i + 1 : first];
        sum += a.x * b.y - b.x * a.y;
    }
    return sum / 2;
}

double measure_distance(narc_point p, narc_point a, narc_point b) {
    const double x = b.x - a.x, y = b.y - a.y, to_x = p.x - a.x, to_y = p.y - a.y, length = x * x + y * y;
    const double t = length > 0 ? fmin(1, fmax(0, (to_x * x + to_y * y) / length)) : 0;
    return hypot(to_x - t * x, to_y - t * y);
}

bool is_inside(const narc_contours *of, narc_point p) {
    bool inside = false;
    for (size_t k = 0, begin = 0; k < of->count; begin = of->ends[k++]) {
        for (size_t i = begin; i < of->ends[k]; i++) {
            const narc_point a = of->points[i], b = of->points[i + 1 < of->ends[k] ? i + 1 : begin];
            if ((a.y > p.y) != (b.y > p.y) && p.x < a.x + (p.y - a.y) / (b.y - a.y) * (b.x - a.x))
                inside = !inside;
        }
    }
    return inside;
}
