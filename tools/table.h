/* SPDX-License-Identifier: MIT
 *
 * table.h - CSV files with a header that is known, then rows with as many fields. Fields are not quoted.
 */
#ifndef NARC_TOOL_TABLE_H
#define NARC_TOOL_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "fail.h"

enum { TABLE_MAX_COLUMNS = 8 };

typedef struct table {
    const char *path;
    char *text, *next; /* the whole file, the line behind the current one */
    size_t size, line;
    size_t columns;
    char *fields[TABLE_MAX_COLUMNS]; /* of the current row, without surrounding blanks */
} table;

/* Opens a file whose first line is one of `headers`, and tells which. */
size_t open_table(table *rows, const char *path, const char *const *headers, size_t header_count);

/* Moves to the next row; false at the end. Blank lines may follow the last row. Shows progress as `stage`. */
bool next_row(table *rows, const char *stage);

/* A field of the current row as a number; `name` is for the message. */
double row_number(const table *rows, size_t column, const char *name);

/* Ends the command: "path:line: message 'field'", the field cut if it is long. */
PRINTF_LIKE(3, 4) _Noreturn void fail_field(const table *rows, size_t column, const char *format, ...);

void close_table(table *rows);

#endif
