/* SPDX-License-Identifier: MIT
 *
 * svg_geometry.h - plain SVG drawings, by their geometry. Internal.
 */
#ifndef NARC_SVG_GEOMETRY_H
#define NARC_SVG_GEOMETRY_H

#include "narc_fit.h"

/* Adds the outline of a plain drawing to a path: of fills, and of strokes of circles, rectangles and lines, that do not
 * cross each other nor leave the page. `element` is the id of what counts, NULL: all; what is not fainter than `threshold`
 * counts. `page` has y up; NULL: nothing is cut off. *out_plain says whether it is such a drawing; if not, the path is as
 * before. The text is SVG that librsvg has read. NARC_ERROR_MEMORY. */
narc_status narc_read_svg_geometry(const char *data, size_t size, const char *element, double threshold,
                                   const narc_aabb *page, narc_path *path, bool *out_plain, narc_error *error);

#endif
