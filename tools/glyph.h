/* SPDX-License-Identifier: MIT
 *
 * glyph.h - from a character of a font to an n-arc: outline, convex hull, polygon with n sides, n-arc.
 *
 * Lengths are in em (font units / units per em), y up; the origin is the centroid of the n-arc.
 */
#ifndef NARC_TOOL_GLYPH_H
#define NARC_TOOL_GLYPH_H

#include "narc_shapes.h"

typedef struct glyph {
    char name[12];       /* "A", or "U+1F47B" for all but ASCII letters */
    narc_point *outline; /* curves flattened, contour after contour */
    size_t outline_count, outline_capacity;
    size_t *ends; /* for each contour, the index in `outline` behind its last point */
    size_t end_count, end_capacity;
    double hull_area;
    narc_point polygon[NARC_MAX_ARCS]; /* see set_side_count(); as many corners as arcs */
    narc_arc arcs[NARC_MAX_ARCS];
    size_t arc_count;
    double area;
} glyph;

/* A font that FreeType has opened. */
typedef struct font font;
font *open_font(const char *path);
void close_font(font *opened);

/* Makes the n-arc of one character. */
void make_glyph(font *from, uint32_t character, size_t arc_count, glyph *out_glyph);
void free_glyph(glyph *made);

#endif
