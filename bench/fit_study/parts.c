/* SPDX-License-Identifier: MIT
 *
 * parts.c - parts_study TOLERANCE ARCS FILE...: drawings as convex parts, within a part of their larger side, each part
 * with at most so many arcs and edges (0: the parts alone); a row for each drawing, then medians.
 */
#define _POSIX_C_SOURCE 199309L
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <time.h>

#include "draw_fit.h"
#include "fail.h"
#include "output.h"
#include "text.h"

typedef struct row {
    double parts, distance, ratio, cut_seconds, seconds;
} row;

/* Of the tolerance, what parts get; the rest is for the shapes that are fitted to them. */
static const double SHARE_OF_PARTS = 0.75;

static double seconds_now(void) {
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    return (double)now.tv_sec + 1e-9 * (double)now.tv_nsec;
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

static bool study_drawing(const char *file, double tolerance, bool fits_arcs, row *out) {
    size_t size;
    char *bytes = read_bytes(file, &size);
    narc_path *path;
    narc_error error;
    narc_parts parts;
    if (narc_create_path(&path) != NARC_OK)
        fail("not enough memory for an outline");
    bool done = narc_read_svg(bytes, size, NULL, path, &error) == NARC_OK;
    free(bytes);
    if (done) {
        const double extent = measure_extent(path, file), begin = seconds_now();
        const double share = fits_arcs ? SHARE_OF_PARTS : 1;
        const narc_parts_request cut = {.most = NARC_MAX_PARTS, .tolerance = share * tolerance * extent};
        done = narc_cut_path(path, &cut, &parts, &error) == NARC_OK;
        if (done) {
            *out = (row){.parts = (double)parts.count, .cut_seconds = seconds_now() - begin, .distance = parts.distance / extent};
            narc_fit_result *fits = allocate(parts.count, sizeof *fits);
            double worst = 0, area;
            for (size_t k = 0; k < parts.count && done && fits_arcs; k++) {
                const narc_fit_request fit = {.tolerance = fits_arcs ? tolerance * extent - parts.distance : 0, .family = fits_arcs ? NARC_FIT_EDGES : NARC_FIT_POLYGON, .arc_count = fits_arcs ? 0 : 12, .starts = 1};
                done = narc_fit_path(parts.paths[k], &fit, &fits[k], &error) == NARC_OK;
                worst = done ? fmax(worst, fits[k].max_distance) : 0;
            }
            if (done && fits_arcs && (narc_measure_union(fits, parts.count, &area, &error) == NARC_OK || (printf("%s\n", error.message), 0))) {
                out->ratio = area / parts.area;
                if (fits_arcs) out->distance += worst / extent;
            }
            out->seconds = seconds_now() - begin;
            free(fits);
            narc_release_parts(&parts);
        }
    }
    if (!done)
        printf("%s: %s\n", file, error.message);
    else
        printf("%s: parts %g, distance %.4f, area %.4f, cut in %.3f s, all in %.3f s\n", file, out->parts, out->distance, out->ratio, out->cut_seconds, out->seconds);
    fflush(stdout);
    narc_destroy_path(path);
    return done;
}

int main(int argc, char **argv) {
    for (int k = 3; k < argc; k++) {
        row r;
        study_drawing(argv[k], atof(argv[1]), atoi(argv[2]), &r);
    }
    return 0;
}
