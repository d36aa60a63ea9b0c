/* SPDX-License-Identifier: MIT
 *
 * table.h - CSV files with a header, whose columns are found by their names: in any order, among others.
 */
#ifndef NARC_TOOL_TABLE_H
#define NARC_TOOL_TABLE_H

#include <stdbool.h>
#include <stddef.h>

#include "csv.h"
#include "fail.h"

enum { TABLE_MAX_COLUMNS = 8 };

typedef struct table {
    const char *path;
    char *text; /* the whole file */
    size_t size;
    narc_csv csv;
    size_t columns;                   /* of the header */
    const char *const *names;         /* of the columns that are asked for */
    size_t places[TABLE_MAX_COLUMNS]; /* where they are in a row; `columns`: there is none */
} table;

/* Opens a file that has columns with `count` names, small letters; only the first `required` of them must be there. */
void open_table(table *rows, const char *path, const char *const *names, size_t count, size_t required);

/* Is there a column with name k? */
bool has_column(const table *rows, size_t k);

/* Moves to the next row; false at the end. Blank lines may follow the last row. Shows progress as `stage`. */
bool next_row(table *rows, const char *stage);

/* The field of the current row in the column with name k; as a number. */
const char *row_field(const table *rows, size_t k);
double row_number(table *rows, size_t k);

/* Ends the command: "path:line: name message 'field'", the field cut if it is long. */
PRINTF_LIKE(3, 4) _Noreturn void fail_field(const table *rows, size_t k, const char *format, ...);

void close_table(table *rows);

#endif
