/* SPDX-License-Identifier: MIT
 *
 * fit_support.h - what the tests of paths and their readers share.
 */
#ifndef NARC_TEST_FIT_SUPPORT_H
#define NARC_TEST_FIT_SUPPORT_H

#include <stdbool.h>
#include <stddef.h>

#include "narc_fit.h"
#include "support.h"

/* Fails unless status and error are the expected one and the message, one line without a full stop, holds `words`. */
void expect_fit_error(narc_status status, narc_status expected, const narc_error *error, const char *words);
void expect_fit_ok(narc_status status, const narc_error *error);

narc_path *make_path(void);

/* Closed contours of straight lines. */
void draw_polygon(narc_path *path, const narc_point *points, size_t count);

/* The path's contours at the default flatness. */
narc_contours flatten(const narc_path *path);

/* A path with one triangle in it, for readers that fail to leave as it is. */
narc_path *make_occupied_path(void);
void expect_unchanged(const narc_path *occupied);

/* The sign of (b - a) x (c - a) where a, b and c are whole numbers up to 2^30. */
int find_whole_orientation(narc_point a, narc_point b, narc_point c);

/* Do the sides p-q and r-s have a common point, other than q = r with nothing more? The slow, obvious way. */
bool sides_meet(narc_point p, narc_point q, narc_point r, narc_point s, bool follows,
                int orientation(narc_point, narc_point, narc_point));

/* How far a point is from the side a-b, but for rounding of at most 6 DBL_EPSILON times the largest distance of the
 * three points. */
double measure_distance(narc_point p, narc_point a, narc_point b);

/* The groups of tests, each returning cmocka's number of failures. */
int test_flattening(void);
int test_simple(void);
int test_points(void);

#endif
