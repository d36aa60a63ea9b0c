/* SPDX-License-Identifier: MIT
 *
 * table.c - CSV files with a header that is known. The file is read whole and cut into fields in place.
 */
#include "table.h"

#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "progress.h"
#include "text.h"

size_t open_table(table *rows, const char *path, const char *const *headers, size_t header_count) {
    *rows = (table){.path = path, .text = read_text(path), .line = 1};
    rows->size = strlen(rows->text);
    rows->next = rows->text;
    const char *line = narc_next_line(&rows->next);
    for (size_t i = 0; i < header_count; i++) {
        if (strcmp(line, headers[i]) == 0) {
            rows->columns = 1;
            for (const char *c = line; *c; c++)
                rows->columns += *c == ',';
            return i;
        }
    }
    fail_at(path, 1, "the header must be %s%s%s, not '%s'", headers[0], header_count > 1 ? " or " : "",
            header_count > 1 ? headers[1] : "", narc_make_excerpt(line).text);
}

bool next_row(table *rows, const char *stage) {
    show_progress(stage, (size_t)(rows->next - rows->text), rows->size);
    char *line = narc_next_line(&rows->next);
    if (!line)
        return false;
    rows->line++;
    if (!*line) {
        if (!rows->next[strspn(rows->next, " \t\r\n")])
            return false;
        fail_at(rows->path, rows->line, "a blank line between rows");
    }
    const size_t columns = narc_split_line(line, rows->fields, TABLE_MAX_COLUMNS);
    if (columns != rows->columns)
        fail_at(rows->path, rows->line, "%zu columns where the header has %zu", columns, rows->columns);
    return true;
}

void fail_field(const table *rows, size_t column, const char *format, ...) {
    char message[256];
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(message, sizeof message, format, arguments);
    va_end(arguments);
    fail_at(rows->path, rows->line, "%s '%s'", message, narc_make_excerpt(rows->fields[column]).text);
}

double row_number(const table *rows, size_t column, const char *name) {
    double value;
    if (!parse_number(rows->fields[column], &value))
        fail_field(rows, column, "%s is not a finite number", name);
    return value;
}

void close_table(table *rows) { free(rows->text); }
