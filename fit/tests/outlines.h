/* SPDX-License-Identifier: MIT
 *
 * outlines.h - outlines to fit, with the points that a shape must hold if it bounds, and checks of fits.
 */
#ifndef NARC_TEST_OUTLINES_H
#define NARC_TEST_OUTLINES_H

#include <stdbool.h>
#include <stddef.h>

#include "fit_support.h"
#include "measures.h"
#include "narc_fit.h"

/* A path, and points on it: all corners, and many on each curve. */
struct outline {
    const char *name;
    narc_path *path;
    narc_point *points;
    size_t count, capacity;
    bool curved;
};

struct outline make_outline(const char *name);
void free_outline(struct outline *of);

/* Contours. */
void add_corners(struct outline *to, const narc_point *points, size_t count);
void add_cubic(struct outline *to, const narc_point controls[4]); /* begins a contour if the pen is elsewhere */

/* Ready-made ones. A regular polygon has its corners on the unit circle; squeezed: y times `squeeze`. */
struct outline make_regular(const char *name, size_t corners, double phase, double squeeze);
struct outline make_box(double width, double height);
struct outline make_stadium(double length, size_t corners); /* radius 1; corners per half circle */
struct outline make_reuleaux(size_t corners);               /* width 1; corners per arc */
struct outline make_star(void);
struct outline make_random_points(struct test_random *random, size_t count); /* each a corner of one contour */
struct outline make_blob(struct test_random *random, size_t curves);
struct outline make_moved(const struct outline *of, double scale, double angle, bool mirror, narc_point by);

/* Fits; fails the test if it can't be done. */
narc_fit_result fit_outline(const struct outline *of, narc_fit_request request);
narc_fit_result fit_shape(const struct outline *of, narc_fit_family family, narc_fit_goal goal, size_t arcs);

/* A fit ends with this error, in these words, and leaves its result as it was. Returns the error. */
narc_error refuse_fit(const narc_path *path, narc_fit_request request, narc_status expected, const char *words);

/* What the goal makes least. */
double goal_value(const narc_fit_result *of, narc_fit_goal goal);

/* Fails the test unless the shape that a store makes of the fit holds all points, with the clearance that is told. */
void check_contained(const struct outline *of, const narc_fit_result *fit, const char *what);

/* Areas, perimeters, largest distance and clearance against the reference, and what family and goal promise; and every
 * field, of outlines that are not thin. */
void check_fit(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit);
narc_fit_result fit_and_check(const struct outline *of, narc_fit_request request);
void check_fit_result(const struct outline *of, const narc_fit_request *request, const narc_fit_result *fit);

#endif
