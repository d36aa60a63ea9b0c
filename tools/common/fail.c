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

/* Makes one line of UTF-8 of `line`, and prints it; the last one of the command behind those that were held. */
static void print_line(char *line, bool last) {
    narc_make_printable(line);
    if (holding && !last)
        return;
    hide_progress();
    for (size_t i = 0; holding && i < message_count; i++) {
        char held[LINE_SIZE];
        const size_t used = print_place(held, messages[i].path, messages[i].line);
        snprintf(held + used, sizeof held - used, "%s", messages[i].text);
        narc_make_printable(held);
        fprintf(stderr, "%s\n", held);
    }
    holding = false;
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

/* A file that is given twice tells the same twice. */
static void keep_told(const char *path, size_t line, bool is_error, const char *text) {
    for (size_t i = 0; i < message_count; i++)
        if (messages[i].line == line && messages[i].is_error == is_error && strcmp(messages[i].text, text) == 0 &&
            strcmp(messages[i].path, path) == 0)
            return;
    messages = grow(messages, &message_capacity, message_count + 1, sizeof *messages);
    messages[message_count++] =
        (told){join_text(path, strlen(path), ""), line, is_error, join_text(text, strlen(text), "")};
}

void report_at(const char *path, size_t line_number, const char *format, ...) {
    char line[LINE_SIZE];
    const size_t used = print_place(line, path, line_number);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - used, format, arguments);
    va_end(arguments);
    print_line(line, !going_on);
    keep_told(path, line_number, true, line + used);
    report_count++;
    if (!going_on)
        abandon();
}

void warn_at(const char *path, const char *format, ...) {
    char line[LINE_SIZE];
    const size_t used = print_place(line, path, 0);
    va_list arguments;
    va_start(arguments, format);
    vsnprintf(line + used, sizeof line - used, format, arguments);
    va_end(arguments);
    print_line(line, false);
    keep_told(path, 0, false, line + used);
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
