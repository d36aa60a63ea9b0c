/* SPDX-License-Identifier: MIT
 *
 * truetype.h - a plain reader of TrueType outlines, to compare with.
 */
#ifndef NARC_TEST_TRUETYPE_H
#define NARC_TEST_TRUETYPE_H

#include <stdbool.h>
#include <stdint.h>

#include "narc_fit.h"

/* The number in `size` bytes, the most significant first. */
unsigned read_big_endian(const unsigned char *at, int size);

/* A table by its tag; the test fails if it is not there. */
unsigned char *find_truetype_table(unsigned char *font, const char *tag);

/* Draws the glyph of a character of the basic plane, in em. False if there is none or it is blank or composed of
 * others. */
bool draw_truetype_glyph(unsigned char *font, uint32_t character, narc_path *path);

#endif
