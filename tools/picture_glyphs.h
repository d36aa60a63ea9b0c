/* SPDX-License-Identifier: MIT
 *
 * picture_glyphs.h - a picture of glyphs, their polygons and their n-arcs.
 */
#ifndef NARC_TOOL_PICTURE_GLYPHS_H
#define NARC_TOOL_PICTURE_GLYPHS_H

#include <stdio.h>

#include "glyph.h"

/* `file` is an open output for `path`, whose suffix tells the kind. */
void draw_glyphs(const char *path, FILE *file, const glyph *glyphs, size_t count);

#endif
