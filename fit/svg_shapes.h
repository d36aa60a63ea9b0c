/* SPDX-License-Identifier: MIT
 *
 * svg_shapes.h - the elements of an SVG file that have an outline or a coordinate system of their own. Internal.
 */
#ifndef NARC_SVG_SHAPES_H
#define NARC_SVG_SHAPES_H

#include "svg_pen.h"
#include "svg_style.h"

/* What percentages are of: the size of the nearest viewport in its own coordinates. NaN: the file does not tell. */
typedef struct narc_svg_view {
    double width, height;
} narc_svg_view;

/* A length; the fallback if there is no such attribute. */
narc_status narc_get_length(const xmlNode *node, const char *name, double whole, double fallback, double *out_length,
                            narc_svg_fault *fault);

/* Draws a path, rect, circle, ellipse, line, polyline or polygon; an element of another name is nothing. Shapes without
 * a size are not drawn. */
narc_status narc_draw_svg_shape(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen,
                                narc_svg_fault *fault);

/* The root's view: its view box, else its size. What cannot be read there is not told. */
narc_svg_view narc_read_root_view(const xmlNode *root);

/* The view of a nested svg element or a symbol inside `outer`, and the map from its coordinates to the outer ones. The
 * `use` that shows it, if any, has a say in its size. A view of size 0 shows nothing: *out_empty. */
narc_status narc_read_view(const xmlNode *node, const xmlNode *use, const narc_svg_view *outer, narc_svg_view *out_view,
                           narc_affine *out_map, bool *out_empty, narc_svg_fault *fault);

#endif
