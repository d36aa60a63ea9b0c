/* SPDX-License-Identifier: MIT
 *
 * png_files.h - PNG files in memory, for the tests of their reader.
 */
#ifndef NARC_TEST_PNG_FILES_H
#define NARC_TEST_PNG_FILES_H

#include "fit_support.h"

/* What a file is to be like, in the terms of libpng. */
struct png_format {
    int bit_depth, color_type; /* PNG_COLOR_TYPE_GRAY and so on */
    bool interlaced;
};

struct png_file {
    unsigned char *bytes;
    size_t size;
};

/* A file whose pixels are, in all formats: gray (and red, green and blue) of value gray[k], and alpha[k], both 0 ..
 * 65535 and rounded to what the format has. A palette has 16 grays, or 16 alphas with black; 8 bits. Formats without
 * alpha drop it. To be freed by the caller. */
struct png_file write_png(struct png_format format, size_t width, size_t height, const uint16_t *gray,
                          const uint16_t *alpha);

/* The contours in such a file, of its alpha at a threshold, or as the request says. */
narc_contours read_png(struct png_file file, double threshold);
narc_contours read_silhouette(struct png_file file, narc_image_request request);

#endif
