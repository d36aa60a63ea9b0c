/* SPDX-License-Identifier: MIT
 *
 * picture_fits.h - a picture of outlines, their convex hulls and the shapes or chains of arcs fitted to them.
 */
#ifndef NARC_TOOL_PICTURE_FITS_H
#define NARC_TOOL_PICTURE_FITS_H

#include <stdio.h>

#include "fit_inputs.h"

/* The shapes of one outline: one around its hull, or those of its parts. */
typedef struct collider {
    narc_fit_result *fits;
    size_t count;
    /* Of parts: the area that all cover, that of the outline, how far they are from it at most. */
    double area, outline_area, distance;
    double seconds;
} collider;

/* `file` is an open output for `path`, whose suffix tells the kind. Fits k, or chains k, are those of outline k; the
 * other of both is NULL. */
void draw_fits(const char *path, FILE *file, const outline_list *outlines, const collider *fits,
               const narc_arc_chains *chains);

#endif
