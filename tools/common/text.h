/* SPDX-License-Identifier: MIT
 *
 * text.h - whole files and numbers.
 */
#ifndef NARC_TOOL_TEXT_H
#define NARC_TOOL_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "lines.h"
#include "narc_files.h"

/* The bytes of a file, at most 1 GiB, with a NUL behind them that does not count; "-" is standard input, which can be read
 * once. From now on no output may replace the file. To be freed. The second one returns NULL where a command that keeps
 * going has reported an error. */
char *read_bytes(const char *path, size_t *out_size);
char *try_read_bytes(const char *path, size_t *out_size);

/* The text of a file, NUL-terminated, as narc_clean_text() leaves it. */
char *read_text(const char *path);

/* The shapes of a file, and a store of them unless `out_store` is NULL. */
narc_shape_list *read_shapes(const char *path, narc_shapes **out_store);

/* A text as JSON, in quotes, fit for a page too. */
void put_json_text(FILE *file, const char *text);

/* Ends the command with an error of reading a text, whose index is its line. */
_Noreturn void fail_text(const char *path, const narc_error *error);

/* The same for a command that may keep going. */
void report_text(const char *path, const narc_error *error);

/* A finite decimal number, and nothing else. */
bool parse_number(const char *text, double *out_value);

/* A whole number in decimal digits, at most `largest`. */
bool parse_whole(const char *text, uint64_t largest, uint64_t *out_value);

#endif
