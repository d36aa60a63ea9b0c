/* SPDX-License-Identifier: MIT
 *
 * fail.c - the end of a command that went wrong, and memory that cannot run out unnoticed.
 */
#include "fail.h"

#include <stdarg.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "output.h"
#include "progress.h"

enum { FAILURE_STATUS = 2, LINE_SIZE = 2048 };

static const char *program = "narc";

void name_program(const char *name) { program = name; }

/* Prints `line` as one line. */
static void print_line(char *line) {
    hide_progress();
    for (char *c = line; *c; c++)
        if ((unsigned char)*c < 0x20 || *c == 0x7f)
            *c = '?';
    fprintf(stderr, "%s\n", line);
}

/* Prints `line` and ends the process. _Exit() drops what is still buffered: nothing more gets written. */
static _Noreturn void end(char *line) {
    discard_outputs();
    print_line(line);
    _Exit(FAILURE_STATUS);
}

void fail(const char *format, ...) {
    char line[LINE_SIZE];
    const int used = snprintf(line, sizeof line, "%s: ", program);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    va_end(arguments);
    end(line);
}

void fail_at(const char *path, size_t line_number, const char *format, ...) {
    char line[LINE_SIZE];
    const char *shown = strcmp(path, "-") == 0 ? "standard input" : path;
    /* Half the line is kept for the message, however long the path. */
    const int used = line_number ? snprintf(line, sizeof line, "%.*s:%zu: ", LINE_SIZE / 2, shown, line_number)
                                 : snprintf(line, sizeof line, "%s: %.*s: ", program, LINE_SIZE / 2, shown);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    va_end(arguments);
    end(line);
}

void warn_at(const char *path, const char *format, ...) {
    char line[LINE_SIZE];
    const char *shown = strcmp(path, "-") == 0 ? "standard input" : path;
    const int used = snprintf(line, sizeof line, "%s: %.*s: ", program, LINE_SIZE / 2, shown);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - (size_t)used, format, arguments);
    va_end(arguments);
    print_line(line);
}

void *allocate(size_t count, size_t size) {
    void *memory = count <= SIZE_MAX / size ? malloc(count ? count * size : 1) : NULL;
    if (!memory)
        fail("not enough memory for %zu items of %zu bytes", count, size);
    return memory;
}

void *grow(void *items, size_t *capacity, size_t needed, size_t size) {
    if (items && needed <= *capacity)
        return items;
    size_t larger = *capacity <= SIZE_MAX / 2 ? 2 * *capacity : SIZE_MAX;
    larger = larger < needed ? needed : larger;
    larger = larger < 16 ? 16 : larger;
    void *memory = larger <= SIZE_MAX / size ? realloc(items, larger * size) : NULL;
    if (!memory)
        fail("not enough memory for %zu items of %zu bytes", larger, size);
    *capacity = larger;
    return memory;
}
