/* SPDX-License-Identifier: MIT
 *
 * table.c - reads CSV files. The file is read whole and cut into fields in place.
 */
#include "table.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "fail.h"
#include "text.h"

static const char BLANKS[] = " \t\r";

/* Cuts off the next line, without its end; NULL behind the last. */
static char *next_line(table *rows) {
    if (rows->next == rows->end) {
        return NULL;
    }
    char *line = rows->next;
    char *newline = memchr(line, '\n', (size_t)(rows->end - line));
    rows->next = newline ? newline + 1 : rows->end;
    rows->line++;
    if (newline) {
        *newline = 0;
        if (newline > line && newline[-1] == '\r') {
            newline[-1] = 0;
        }
    }
    return line;
}

size_t open_table(table *rows, const char *path, const char *const *headers, size_t header_count) {
    *rows = (table){.path = path};
    size_t size;
    rows->text = read_text(path, &size);
    rows->next = rows->text;
    rows->end = rows->text + size;
    const char *line = next_line(rows);
    if (!line) {
        fail_at(path, 1, "the file is empty; its header must be %s", headers[0]);
    }
    for (size_t i = 0; i < header_count; i++) {
        if (strcmp(line, headers[i]) == 0) {
            rows->columns = 1;
            for (const char *c = line; *c; c++) {
                rows->columns += *c == ',';
            }
            return i;
        }
    }
    fail_at(path, 1, "the header must be %s%s%s, not '%s'", headers[0], header_count > 1 ? " or " : "",
            header_count > 1 ? headers[1] : "", line);
}

/* A field without the blanks around it. */
static char *trim(char *field) {
    field += strspn(field, BLANKS);
    size_t length = strlen(field);
    while (length && strchr(BLANKS, field[length - 1])) {
        length--;
    }
    field[length] = 0;
    return field;
}

bool next_row(table *rows) {
    char *line = next_line(rows);
    if (!line) {
        return false;
    }
    if (!line[strspn(line, BLANKS)]) {
        if (strspn(rows->next, " \t\r\n") == (size_t)(rows->end - rows->next)) {
            return false;
        }
        fail_at(rows->path, rows->line, "a blank line between rows");
    }
    size_t columns = 0;
    for (char *field = line; field; columns++) {
        char *comma = strchr(field, ',');
        if (comma) {
            *comma++ = 0;
        }
        if (columns < rows->columns) {
            rows->fields[columns] = trim(field);
        }
        field = comma;
    }
    if (columns != rows->columns) {
        fail_at(rows->path, rows->line, "%zu columns where the header has %zu", columns, rows->columns);
    }
    return true;
}

double row_number(const table *rows, size_t column, const char *name) {
    double value;
    if (!parse_number(rows->fields[column], &value)) {
        fail_at(rows->path, rows->line, "%s is not a finite number '%s'", name, rows->fields[column]);
    }
    return value;
}

void close_table(table *rows) { free(rows->text); }
