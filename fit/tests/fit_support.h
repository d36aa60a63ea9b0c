/* SPDX-License-Identifier: MIT
 *
 * fit_support.h - what the tests of paths and their readers share.
 */
#ifndef NARC_TEST_FIT_SUPPORT_H
#define NARC_TEST_FIT_SUPPORT_H

#include <stdbool.h>
#include <stddef.h>

#include "expect.h"
#include "narc_fit.h"
#include "support.h"

/* Where trials are few, of cases that take long only each `step`th is looked at: 1 otherwise. */
size_t stride(size_t step);

/* A whole file; to be freed. */
unsigned char *read_file(const char *name, size_t *out_size);

/* The number in `size` bytes, the most significant first. */
unsigned read_big_endian(const unsigned char *at, int size);

narc_path *make_path(void);
RELEASE_AT(narc_destroy_path)
RELEASE_AT(narc_close_font)

/* Closed contours of straight lines. */
void draw_polygon(narc_path *path, const narc_point *points, size_t count);

/* The path's contours at the default flatness. */
narc_contours flatten(const narc_path *path);

/* A path with one triangle in it, for readers that fail to leave as it is. */
narc_path *make_occupied_path(void);
void expect_unchanged(const narc_path *occupied);

/* What a reader may end with on any bytes: it has added contours to an occupied path, then at most `most` in all; or
 * status and error tell one of `allowed`, bits 1 << status, and the path is as it was. Frees the path; returns whether
 * the bytes were read. */
bool finish_any_bytes(narc_status status, const narc_error *error, unsigned allowed, size_t most, narc_path *occupied);

/* A reader, and reading from a block of exactly that size, so that reading behind its end shows. */
typedef narc_status reader(const void *data, size_t size, narc_path *path, narc_error *error);
narc_status read_exactly(reader *read, const char *text, size_t size, narc_path *path, narc_error *error);

/* Reading this text ends with the error, with a message or without, which names line (0: none) and words, and leaves
 * the path as it was. */
void expect_wrong_text(reader *read, const char *text, size_t size, narc_status status, size_t line, const char *words);

/* A text and its error. */
struct wrong {
    const char *text;
    narc_status status;
    size_t line;
    const char *words;
};

/* The signed area of contour k, counter-clockwise positive. */
double measure_area(const narc_contours *contours, size_t k);

/* How far a point is from the side a-b, but for rounding of at most 6 DBL_EPSILON times the largest distance of the
 * three points. */
double measure_distance(narc_point p, narc_point a, narc_point b);

/* Is a point inside an odd number of the contours? */
bool is_inside(const narc_contours *of, narc_point p);

#endif
