/* SPDX-License-Identifier: MIT
 *
 * parts.c - parts_study TOLERANCE FILE...: drawings as convex parts, within a part of their larger side, three quarters
 * of it for the cuts as in the narc command; a row for each drawing, then medians. Ends with 1 if more than half of the
 * drawings have more than six parts, or more than a tenth of them are not cut.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

#include "draw_fit.h"
#include "fail.h"
#include "numbers.h"
#include "progress.h"
#include "text.h"

static const double SHARE_OF_CUTS = 0.75, MOST_PARTS = 6;

enum { PARTS, DISTANCE, SECONDS, FIELDS };
static const char *const field_names[FIELDS] = {"parts", "distance", "seconds"};

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
static bool study_drawing(const narc_path *path, const char *file, double tolerance, numbers *to) {
    const double extent = measure_extent(path, file), begin = seconds_now();
    const narc_parts_request cut = {.most = NARC_MAX_PARTS, .tolerance = SHARE_OF_CUTS * tolerance * extent};
    narc_parts parts;
    narc_error error;
    const bool done = narc_cut_path(path, &cut, &parts, &error) == NARC_OK;
    const double seconds = seconds_now() - begin;
    add_number(&to[PARTS], done ? (double)parts.count : NARC_MAX_PARTS + 1);
    add_number(&to[DISTANCE], done ? parts.distance / extent : NAN);
    add_number(&to[SECONDS], seconds);
    if (done) {
        printf("%s: %zu parts, distance %.4f, %.3f s\n", file, parts.count, parts.distance / extent, seconds);
        narc_release_parts(&parts);
    } else {
        printf("%s: %s\n", file, error.message);
    }
    return done;
}

int main(int argc, char **argv) {
    const double tolerance = argc > 2 ? strtod(argv[1], NULL) : 0;
    if (!(tolerance > 0))
        fail("usage: parts_study TOLERANCE FILE...");
    numbers *found = allocate(FIELDS, sizeof *found);
    size_t failed = 0;
    for (int field = 0; field < FIELDS; field++)
        found[field].count = 0;
    for (int k = 2; k < argc; k++) {
        narc_path *path = read_drawing(argv[k]);
        if (path)
            failed += !study_drawing(path, argv[k], tolerance, found);
        narc_destroy_path(path);
        fflush(stdout);
    }
    const size_t count = found[PARTS].count;
    if (count == 0)
        fail("no drawing has anything to see");
    printf("drawings %zu, not cut %zu\n", count, failed);
    for (int field = 0; field < FIELDS; field++)
        printf("%-8s median %.3g, 75 %% up to %.3g, 90 %% up to %.3g\n", field_names[field],
               find_quantile(&found[field], 0.5), find_quantile(&found[field], 0.75),
               find_quantile(&found[field], 0.9));
    const bool good = find_quantile(&found[PARTS], 0.5) <= MOST_PARTS && 10 * failed <= count;
    free(found);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
