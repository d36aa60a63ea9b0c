/* SPDX-License-Identifier: MIT
 *
 * fail.c - the end of a command that went wrong, and memory that cannot run out unnoticed.
 */
#include "fail.h"

#include <stdarg.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "names.h"
#include "output.h"
#include "progress.h"

enum { LINE_SIZE = 2048 };

static bool going_on, holding;
static size_t report_count;
static told *messages;
static size_t message_count, message_capacity;

/* _Exit() drops what is still buffered: nothing more gets written. */
_Noreturn void abandon(void) {
    discard_outputs();
    _Exit(FAILURE_STATUS);
}

/* Begins a line with the place of an error; returns its length. */
static size_t print_place(char *line, const char *path, size_t line_number) {
    const char *shown = strcmp(path, "-") == 0 ? "standard input" : path;
    /* Half the line is kept for the message, however long the path. */
    return (size_t)(line_number ? snprintf(line, LINE_SIZE, "%.*s:%zu: ", LINE_SIZE / 2, shown, line_number)
                                : snprintf(line, LINE_SIZE, "narc: %.*s: ", LINE_SIZE / 2, shown));
}

/* Makes one line of UTF-8 of `line`, and prints it; before a last one what was held. */
static void print_line(char *line, bool last) {
    if (holding && !last)
        return;
    const size_t held = holding ? message_count : 0;
    holding = false;
    for (size_t i = 0; i < held; i++) {
        char before[LINE_SIZE];
        const size_t used = print_place(before, messages[i].path, messages[i].line);
        snprintf(before + used, sizeof before - used, "%s", messages[i].text);
        print_line(before, true);
    }
    narc_make_printable(line);
    hide_progress();
    fprintf(stderr, "%s\n", line);
}

void fail(const char *format, ...) {
    char line[LINE_SIZE] = "narc: ";
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + 6, sizeof line - 6, format, arguments);
    va_end(arguments);
    print_line(line, true);
    abandon();
}

void fail_at(const char *path, size_t line_number, const char *format, ...) {
    char line[LINE_SIZE];
    const size_t used = print_place(line, path, line_number);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - used, format, arguments);
    va_end(arguments);
    print_line(line, true);
    abandon();
}

/* False if it was told before, as of a file that is given twice. */
static bool keep_told(const char *path, size_t line, bool is_error, const char *text) {
    for (size_t i = 0; i < message_count; i++) {
        const told *other = &messages[i];
        if (other->line == line && other->is_error == is_error && strcmp(other->path, path) == 0 &&
            strcmp(other->text, text) == 0)
            return false;
    }
    messages = grow(messages, &message_capacity, message_count + 1, sizeof *messages);
    messages[message_count++] =
        (told){join_text(path, strlen(path), ""), line, is_error, join_text(text, strlen(text), "")};
    return true;
}

void report_at(const char *path, size_t line_number, const char *format, ...) {
    char line[LINE_SIZE];
    const size_t used = print_place(line, path, line_number);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - used, format, arguments);
    va_end(arguments);
    if (!going_on) {
        print_line(line, true);
        abandon();
    }
    if (keep_told(path, line_number, true, line + used))
        print_line(line, false);
    report_count++;
}

void warn_at(const char *path, const char *format, ...) {
    char line[LINE_SIZE];
    const size_t used = print_place(line, path, 0);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - used, format, arguments);
    va_end(arguments);
    if (keep_told(path, 0, false, line + used))
        print_line(line, false);
}

const told *list_told(size_t *out_count) {
    *out_count = message_count;
    return messages;
}

void keep_going(void) { going_on = true; }

bool goes_on(void) { return going_on; }

void hold_lines(void) { holding = true; }

size_t count_reports(void) { return report_count; }

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

char *join_text(const char *text, size_t length, const char *suffix) {
    char *joined = allocate(length + strlen(suffix) + 1, 1);
    memcpy(joined, text, length);
    strcpy(joined + length, suffix);
    return joined;
}
