/* SPDX-License-Identifier: MIT
 *
 * table.h - reads CSV files: a header that is known, then rows with as many fields. Fields are not quoted.
 */
#ifndef NARC_TOOL_TABLE_H
#define NARC_TOOL_TABLE_H

#include <stdbool.h>
#include <stddef.h>

enum { TABLE_MAX_COLUMNS = 8 };

typedef struct table {
    const char *path;
    char *text, *next, *end; /* the whole file, the line after the current one, the file's end */
    size_t line;
    size_t columns;
    char *fields[TABLE_MAX_COLUMNS]; /* of the current row, without surrounding blanks */
} table;

/* Opens a file whose first line is one of `headers`, and tells which. */
size_t open_table(table *rows, const char *path, const char *const *headers, size_t header_count);

/* Moves to the next row; false at the end. Lines may end with CR LF; blank lines may follow the last row. */
bool next_row(table *rows);

/* A field of the current row as a number; `name` is for the message. */
double row_number(const table *rows, size_t column, const char *name);

void close_table(table *rows);

#endif
