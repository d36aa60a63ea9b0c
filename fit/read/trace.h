/* SPDX-License-Identifier: MIT
 *
 * trace.h - contours of an image. Internal.
 */
#ifndef NARC_TRACE_H
#define NARC_TRACE_H

#include "narc_fit.h"

/* A bit for each pixel, row by row: column x is bit x % 64 of word x / 64. Behind a row's end bits are 0. */
typedef struct narc_bits {
    uint64_t *words; /* [rows * stride] */
    size_t stride;   /* words of a row */
} narc_bits;

/* Samples at the centres of pixels, the top row first: pixel (column, row) is `pixel` times (column + 1/2, height - row
 * - 1/2) from `origin`, the image's lower left corner. */
typedef struct narc_image {
    const uint16_t *samples; /* or NULL: those of `bits` are the largest, all others 0 */
    narc_bits bits;          /* without samples */
    size_t width, height;
    double pixel;
    narc_point origin;
} narc_image;

/* Adds the contours where the image, bilinear between samples and surrounded by pixels of value 0, passes `level`:
 * polygons with a point on each line between two neighbouring samples of which one is above. Round what is above they
 * go counter-clockwise, round holes clockwise; none crosses itself or another. Samples must not be equal to the level,
 * and it must be above 0. NARC_ERROR_MEMORY, NARC_ERROR_SIZE (coordinates); then the path may have some of them. */
narc_status narc_trace_image(const narc_image *image, double level, narc_path *path, narc_error *error);

/* What both readers of images are called with. NARC_ERROR_ARGUMENT, NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE. */
narc_status narc_check_image_request(const void *data, const narc_image_request *request, const narc_path *path,
                                     narc_error *error);

#endif
