/* SPDX-License-Identifier: MIT
 *
 * svg_transform.h - affine maps, and the transforms of an SVG file. Internal.
 */
#ifndef NARC_SVG_TRANSFORM_H
#define NARC_SVG_TRANSFORM_H

#include "svg_number.h"

/* (x, y) -> (xx x + xy y + x0, yx x + yy y + y0). */
typedef struct narc_affine {
    double xx, yx, xy, yy, x0, y0; /* in the order of SVG's matrix() */
} narc_affine;

narc_point narc_apply_affine(const narc_affine *map, narc_point point);

/* First `inner`, then `outer`. */
narc_affine narc_multiply_affine(const narc_affine *outer, const narc_affine *inner);

/* A list of matrix, translate, scale, rotate, skewX and skewY, the last of which comes first; empty or "none": the
 * identity. The text may be part of one that ends with NUL. */
narc_status narc_parse_transform(const char *text, size_t size, narc_affine *out_map, narc_svg_fault *fault);

#endif
