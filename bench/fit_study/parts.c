/* SPDX-License-Identifier: MIT
 *
 * parts.c - parts_study TOLERANCE FILE...: drawings as convex parts, within a part of their larger side, three quarters
 * of it for the cuts as in the narc command; a row for each drawing, with the area of the parts' union relative to the
 * outline's, then medians. Ends with 1 if more than half of the drawings have more than six parts, or more than a tenth
 * of them are not cut.
 */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "draw_fit.h"
#include "fail.h"
#include "progress.h"
#include "text.h"

static const double SHARE_OF_CUTS = 0.75, MOST_PARTS = 6;

typedef struct row {
    double parts, distance, area, seconds;
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

/* Adds a convex polygon to the arcs of a union, in fans of as many corners as a shape may have, without those that hardly
 * matter. Returns how many. */
static size_t add_polygon(const narc_path *path, double extent, narc_arc *arcs, size_t *counts) {
    narc_contours polygon;
    narc_error error;
    size_t fans = 0;
    if (narc_flatten_path(path, 0, &polygon, &error) != NARC_OK)
        fail("%s", error.message);
    for (size_t k = 1; k + 1 < polygon.point_count; k += NARC_MAX_ARCS - 2) {
        narc_point fan[NARC_MAX_ARCS] = {polygon.points[0]};
        const size_t left = polygon.point_count - k, taken = left < NARC_MAX_ARCS - 1 ? left : NARC_MAX_ARCS - 1;
        size_t corners;
        memcpy(fan + 1, polygon.points + k, taken * sizeof *fan);
        if (narc_weld_polygon(fan, taken + 1, 1e-5 * extent, fan, &corners, &error) != NARC_OK)
            continue; /* it has no area */
        if (narc_build_polygon(fan, corners, 0, arcs, &counts[fans], &error) != NARC_OK)
            fail("%s", error.message);
        arcs += counts[fans++];
    }
    narc_release_contours(&polygon);
    return fans;
}

static double measure_union(const narc_parts *parts, double extent) {
    enum { MOST = 16384 };
    narc_arc *arcs = allocate(MOST + NARC_MAX_ARCS, sizeof *arcs);
    size_t *counts = allocate(MOST, sizeof *counts), fans = 0, used = 0;
    narc_mass mass;
    narc_error error;
    for (size_t k = 0; k < parts->count; k++)
        for (size_t added = add_polygon(parts->paths[k], extent, arcs + used, counts + fans); added > 0; added--)
            used += counts[fans++];
    if (narc_compute_union_mass(arcs, counts, fans, NULL, &mass, &error) != NARC_OK)
        fail("%s", error.message);
    free(arcs);
    free(counts);
    return mass.area;
}

/* False if parts are not found. */
static bool study_drawing(const narc_path *path, const char *file, double tolerance, row *out) {
    const double extent = measure_extent(path, file), begin = seconds_now();
    const narc_parts_request cut = {.most = NARC_MAX_PARTS, .tolerance = SHARE_OF_CUTS * tolerance * extent};
    narc_parts parts;
    narc_error error;
    const bool done = narc_cut_path(path, &cut, &parts, &error) == NARC_OK;
    *out = (row){NARC_MAX_PARTS + 1, INFINITY, INFINITY, seconds_now() - begin};
    if (done) {
        out->parts = (double)parts.count;
        out->distance = parts.distance / extent;
        out->area = measure_union(&parts, extent) / parts.area;
        printf("%s: %zu parts, distance %.4f, area %.4f, %.3f s\n", file, parts.count, out->distance, out->area,
               out->seconds);
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
        sorted[k] = ((const double *)&rows[k])[field];
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
    static const char *const names[] = {"parts", "distance", "area", "seconds"};
    for (size_t field = 0; field < 4; field++)
        printf("%-8s median %.3g, 75 %% up to %.3g, 90 %% up to %.3g\n", names[field],
               find_quantile(rows, count, field, 0.5), find_quantile(rows, count, field, 0.75),
               find_quantile(rows, count, field, 0.9));
    const bool good = find_quantile(rows, count, 0, 0.5) <= MOST_PARTS && 10 * failed <= count;
    free(rows);
    return good ? EXIT_SUCCESS : EXIT_FAILURE;
}
