/* SPDX-License-Identifier: MIT
 *
 * parts.c - parts_study TOLERANCE FILE...: drawings as convex parts, within a part of their larger side, three quarters
 * of it for the cuts as in the narc command; a row for each drawing, then medians. Ends with 1 if
 * more than half of the drawings have more than six parts, or more than a tenth of them are not cut.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "draw_fit.h"
#include "fail.h"
#include "progress.h"
#include "text.h"

static const double SHARE_OF_CUTS = 0.75, MOST_PARTS = 6;

typedef struct row {
    double parts, distance, seconds;
} row;

static narc_path *read_drawing(const char *file) {
    size_t size;
    char *bytes = read_bytes(file, &size);
    narc_path *path;
    narc_error error;
    if (narc_create_path(&path) != NARC_OK)
        fail("not enough memory for an outline");
    if (narc_read_svg(bytes, size, NULL, path, &error) != NARC_OK) {
        printf("%s: %s\n", file, error.message);
        narc_destroy_path(path);
        path = NULL;
    }
    free(bytes);
    return path;
}

static double measure_extent(const narc_path *path, const char *file) {
    narc_contours contours;
    narc_error error;
    if (narc_flatten_path(path, 0, &contours, &error) != NARC_OK)
        fail("%s: %s", file, error.message);
    const narc_aabb box = bound_points(contours.points, contours.point_count);
    narc_release_contours(&contours);
    return fmax(box.max_x - box.min_x, box.max_y - box.min_y);
}

/* False if parts are not found. */
static bool study_drawing(const narc_path *path, const char *file, double tolerance, row *out) {
    const double extent = measure_extent(path, file), begin = seconds_now();
    const narc_parts_request cut = {.most = NARC_MAX_PARTS, .tolerance = SHARE_OF_CUTS * tolerance * extent};
    narc_parts parts;
    narc_error error;
    const bool done = narc_cut_path(path, &cut, &parts, &error) == NARC_OK;
    *out = (row){NARC_MAX_PARTS + 1, INFINITY, seconds_now() - begin};
    if (done) {
        out->parts = (double)parts.count;
        out->distance = parts.distance / extent;
        printf("%s: %zu parts, distance %.4f, %.3f s\n", file, parts.count, out->distance, out->seconds);
        narc_release_parts(&parts);
    } else {
        printf("%s: %s\n", file, error.message);
    }
    return done;
}

static int compare_numbers(const void *left, const void *right) {
    const double *a = left, *b = right;
    return (*a > *b) - (*a < *b);
}

static double find_quantile(const row *rows, size_t count, size_t field, double part) {
    double *sorted = allocate(count, sizeof *sorted);
    for (size_t k = 0; k < count; k++)
        sorted[k] = field == 0 ? rows[k].parts : field == 1 ? rows[k].distance : rows[k].seconds;
    qsort(sorted, count, sizeof *sorted, compare_numbers);
    const double found = sorted[(size_t)(part * (double)(count - 1))];
    free(sorted);
    return found;
}

int main(int argc, char **argv) {
    const double tolerance = argc > 2 ? strtod(argv[1], NULL) : 0;
    if (!(tolerance > 0))
        fail("usage: parts_study TOLERANCE FILE...");
    row *rows = allocate((size_t)argc, sizeof *rows);
    size_t count = 0, failed = 0;
    for (int k = 2; k < argc; k++) {
        narc_path *path = read_drawing(argv[k]);
        if (path)
            failed += !study_drawing(path, argv[k], tolerance, &rows[count++]);
        narc_destroy_path(path);
        fflush(stdout);
    }
    if (count == 0)
        fail("no drawing has anything to see");
    printf("drawings %zu, not cut %zu\n", count, failed);
    static const char *const names[] = {"parts", "distance", "seconds"};
    for (size_t field = 0; field < 3; field++)
        printf("%-8s median %.3g, 75 %% up to %.3g, 90 %% up to %.3g\n", names[field],
               find_quantile(rows, count, field, 0.5), find_quantile(rows, count, field, 0.75),
               find_quantile(rows, count, field, 0.9));
    const bool good = find_quantile(rows, count, 0, 0.5) <= MOST_PARTS && 10 * failed <= count;
    free(rows);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
