/* SPDX-License-Identifier: MIT
 *
 * csv.h - tables as spreadsheets write them, row by row. Internal.
 *
 * The first row that is not blank tells what separates fields: semicolons if it has any, or else tabs, commas, blanks.
 * Where semicolons or tabs do, numbers may have a decimal comma, all of them or none. A field in quotes may hold
 * separators, and a quote as two; it ends in its line. Blanks around fields do not count. Lines end with LF or CR LF.
 */
#ifndef NARC_CSV_H
#define NARC_CSV_H

#include <stdbool.h>

#include "lines.h"

/* Of a row with more columns the others are only counted. */
enum { NARC_CSV_COLUMNS = 256 };

/* Begin with {.rest = text}; the text is cut in place. */
typedef struct narc_csv {
    char *rest;       /* the text behind the current row */
    size_t line;      /* of the current row, the first being 1 */
    char separator;   /* a blank: any number of blanks and tabs; 0: not known yet */
    char point;       /* the decimal point or comma that was met; 0: none yet */
    narc_excerpt row; /* the current row, for messages */
    size_t count;     /* its fields; 0: all are empty */
    char *fields[NARC_CSV_COLUMNS];
} narc_csv;

/* Moves on to the next line; *out_found is false behind the last one. NARC_ERROR_FORMAT: quotes are wrong. */
narc_status narc_read_row(narc_csv *csv, bool *out_found, narc_error *error);

/* The column of the current row, a header, whose field is `name` in small or capital letters; csv->count if there is
 * none. NARC_ERROR_FORMAT: there are two, or none but one is required. */
narc_status narc_find_column(const narc_csv *csv, const char *name, bool is_required, size_t *out_column,
                             narc_error *error);

/* A field as a number, see narc_parse_number(). Returns NULL, or what is wrong: "is not a number". */
const char *narc_read_number(narc_csv *csv, size_t column, double *out_value);

#endif
