/* SPDX-License-Identifier: MIT
 *
 * lines.h - texts, their lines, and pieces of them for messages. Internal.
 *
 * Messages about a place in a text begin "line N: ", and error->index is N.
 */
#ifndef NARC_LINES_H
#define NARC_LINES_H

#include "narc_shapes.h"

/* The first line of a text, fit to be shown: not all of a long one, no half characters, nothing that is not printed. */
typedef struct narc_excerpt {
    char text[48];
} narc_excerpt;
narc_excerpt narc_make_excerpt(const char *text);

/* The number of the line that holds `place`, the first being 1. */
size_t narc_find_line(const char *text, const char *place);

/* Makes a text of `size` bytes with a NUL byte behind them: takes a UTF-8 byte order mark away. NARC_ERROR_FORMAT:
 * UTF-16, a NUL byte inside, or nothing but blanks. */
narc_status narc_clean_text(char *text, size_t size, narc_error *error);

#endif
