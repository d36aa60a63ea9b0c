/* SPDX-License-Identifier: MIT
 *
 * lines.h - texts, their lines, the fields of CSV, and pieces of them for messages. Internal.
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

/* Makes a text of `size` bytes with a NUL byte behind them: takes a UTF-8 byte order mark away. NARC_ERROR_FORMAT: a
 * NUL byte inside, or nothing but blanks. */
narc_status narc_clean_text(char *text, size_t size, narc_error *error);

/* Cuts the first line off *rest and moves on behind it; NULL at the end. Lines end with LF or CR LF. The line has no
 * blanks at its ends. */
char *narc_next_line(char **rest);

/* Cuts a line at its commas into fields without blanks around them; fields are not quoted. Returns how many there are;
 * those beyond `capacity` are only counted. */
size_t narc_split_line(char *line, char **out_fields, size_t capacity);

#endif
