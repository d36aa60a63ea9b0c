/* SPDX-License-Identifier: MIT
 *
 * consumer_fit.c - an outline of points to a shape in a store, through the installed fitting library. C and C++.
 */
#include <narc_fit.h>
#include <stdio.h>
#include <string.h>

int main(void) {
    static const char text[] = "0,0\n1,0\n1,1\n0,1\n";
    narc_path *path = NULL;
    narc_shapes *shapes = NULL;
    narc_error error;
    narc_fit_request request;
    narc_fit_result fit;
    memset(&error, 0, sizeof error);
    memset(&request, 0, sizeof request);
    request.arc_count = 4;
    request.family = NARC_FIT_N_ARC;
    request.goal = NARC_FIT_BOUND_AREA;
    if (narc_create_path(&path) || narc_read_csv(text, strlen(text), path, &error) ||
        narc_fit_path(path, &request, &fit, &error) || narc_create_shapes(NULL, &shapes) ||
        narc_add_shape(shapes, fit.arcs, fit.arc_count, NULL, &error)) {
        fprintf(stderr, "narc: %s\n", error.message);
        return 1;
    }
    narc_destroy_shapes(shapes);
    narc_destroy_path(path);
    printf("%d arcs around a square: area %g\n", (int)fit.arc_count, fit.area);
    /* It contains the unit square, and is no larger than the circle around it, whose area is pi / 2. */
    return fit.clearance >= 0 && fit.area > 1 && fit.area < 1.5709 ? 0 : 1;
}
