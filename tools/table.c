/* SPDX-License-Identifier: MIT
 *
 * table.c - CSV files with a header, whose columns are found by their names. The file is read whole and cut into fields
 * in place.
 */
#include "table.h"

#include <math.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "progress.h"
#include "text.h"

static bool read_row(table *rows) {
    bool is_found;
    narc_error error;
    if (narc_read_row(&rows->csv, &is_found, &error) != NARC_OK)
        fail_text(rows->path, &error);
    return is_found;
}

void open_table(table *rows, const char *path, const char *const *names, size_t count, size_t required) {
    *rows = (table){.path = path, .text = read_text(path), .names = names};
    rows->size = strlen(rows->text);
    rows->csv.rest = rows->text;
    read_row(rows);
    rows->columns = rows->csv.count;
    for (size_t k = 0; k < count; k++) {
        narc_error error;
        if (narc_find_column(&rows->csv, names[k], k < required, &rows->places[k], &error) != NARC_OK)
            fail_text(path, &error);
    }
}

bool has_column(const table *rows, size_t k) { return rows->places[k] < rows->columns; }

bool next_row(table *rows, const char *stage) {
    const narc_csv *csv = &rows->csv;
    size_t blank = 0;
    show_progress(stage, (size_t)(csv->rest - rows->text), rows->size);
    while (read_row(rows)) {
        if (csv->count && blank)
            fail_at(rows->path, blank, "a blank line between rows");
        if (csv->count && csv->count != rows->columns)
            fail_at(rows->path, csv->line, "%zu columns where the header has %zu", csv->count, rows->columns);
        if (csv->count)
            return true;
        blank = blank ? blank : csv->line;
    }
    return false;
}

const char *row_field(const table *rows, size_t k) { return rows->csv.fields[rows->places[k]]; }

void fail_field(const table *rows, size_t k, const char *format, ...) {
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(rows->path, rows->csv.line, "%s %s '%s'", rows->names[k], message,
            narc_make_excerpt(row_field(rows, k)).text);
}

double row_number(table *rows, size_t k) {
    double value;
    const char *wrong = narc_read_number(&rows->csv, rows->places[k], &value);
    if (wrong || !isfinite(value))
        fail_field(rows, k, "%s", wrong ? wrong : "is not finite");
    return value;
}

void close_table(table *rows) { free(rows->text); }
