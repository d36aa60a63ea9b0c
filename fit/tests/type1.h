/* SPDX-License-Identifier: MIT
 *
 * type1.h - makes a small Type 1 font: one with cubic curves, whose control points the tests know.
 */
#ifndef NARC_TEST_TYPE1_H
#define NARC_TEST_TYPE1_H

#include <stddef.h>

/* A font of 1000 units per em with three glyphs: A, drawn with `steps`, a blank space, and .notdef. Each step is a move
 * (2 numbers), a line (2) or a curve (6), all of them differences from the point before; `operators` has a letter for
 * each: m, l, c, or z, which closes the contour. Returns a block of *out_size bytes, to be freed. */
char *make_type1_font(const char *operators, const int *steps, size_t *out_size);

#endif
