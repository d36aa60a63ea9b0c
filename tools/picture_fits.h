/* SPDX-License-Identifier: MIT
 *
 * picture_fits.h - a picture of outlines, their convex hulls and the shapes or chains of arcs fitted to them.
 */
#ifndef NARC_TOOL_PICTURE_FITS_H
#define NARC_TOOL_PICTURE_FITS_H

#include <stdio.h>

#include "fit_inputs.h"

/* `file` is an open output for `path`, whose suffix tells the kind. Fit k, or chains k, are those of outline k; the
 * other of both is NULL. */
void draw_fits(const char *path, FILE *file, const outline_list *outlines, const narc_fit_result *fits,
               const narc_arc_chains *chains);

#endif
