/* SPDX-License-Identifier: MIT
 *
 * fail.h - an error ends the command: one line on standard error, no output file left behind, exit status 2. A command
 * that keeps going after errors in some of its inputs ends with status 1.
 */
#ifndef NARC_TOOL_FAIL_H
#define NARC_TOOL_FAIL_H

#include <stdbool.h>
#include <stddef.h>

#include "compiler.h"

enum { PARTIAL_STATUS = 1, FAILURE_STATUS = 2 };

/* "narc: message". Bytes that would break the line are shown as '?'. */
PRINTF_LIKE(1, 2) _Noreturn void fail(const char *format, ...);

/* "path:line: message"; without a line, 0, "narc: path: message". "-" is standard input. */
PRINTF_LIKE(3, 4) _Noreturn void fail_at(const char *path, size_t line, const char *format, ...);

/* As fail_at(), but from keep_going() on it prints the line, counts it and returns. */
PRINTF_LIKE(3, 4) void report_at(const char *path, size_t line, const char *format, ...);
void keep_going(void);
bool goes_on(void);
size_t count_reports(void);

/* From now on lines that do not end the command are not printed: a report on standard error has them. */
void hold_lines(void);

/* A warning: "narc: path: message". */
PRINTF_LIKE(2, 3) void warn_at(const char *path, const char *format, ...);

/* What report_at() and warn_at() told. */
typedef struct told {
    const char *path;
    size_t line; /* 0: none */
    bool is_error;
    const char *text;
} told;
const told *list_told(size_t *out_count);

/* Ends the command behind an error that was reported. */
_Noreturn void abandon(void);

/* Memory for `count` items of `size` bytes, never NULL. */
void *allocate(size_t count, size_t size);

/* Makes room for `needed` items in an array that grows by doubling; `items` may be NULL at first. */
void *grow(void *items, size_t *capacity, size_t needed, size_t size);

/* `suffix` behind the first `length` bytes of `text`. */
char *join_text(const char *text, size_t length, const char *suffix);

#endif
