/* SPDX-License-Identifier: MIT
 *
 * fit_fonts.h - the fonts of test_fit_fonts.
 */
#ifndef NARC_TEST_FIT_FONTS_H
#define NARC_TEST_FIT_FONTS_H

#include <stddef.h>

/* A font, read whole. */
typedef struct file {
    const char *name;
    unsigned char *data;
    size_t size;
} file;

/* Those that the program was given. */
extern int file_count;
extern file files[8];

/* The glyph of the one that is made by hand; see make_type1_font(). */
extern const char operators[];
extern const int steps[];

void survives_damage(void **state);
void survives_damaged_type1(void **state);

#endif
