/* SPDX-License-Identifier: MIT
 *
 * text.h - whole files, numbers and UTF-8.
 */
#ifndef NARC_TOOL_TEXT_H
#define NARC_TOOL_TEXT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* The bytes of a file, with a NUL behind them that does not count. From now on no output may replace the file. */
char *read_bytes(const char *path, size_t *out_size);

/* The text of a file, NUL-terminated, without a UTF-8 byte order mark. A NUL byte in the file is an error. From
 * now on no output may replace the file. */
char *read_text(const char *path, size_t *out_size);

/* The number of the line that holds `position`, the first being 1. */
size_t line_of(const char *text, const char *position);

/* A finite decimal number, and nothing else. */
bool parse_number(const char *text, double *out_value);

/* A whole number in decimal digits, at most `largest`. */
bool parse_whole(const char *text, uint64_t largest, uint64_t *out_value);

/* Reads the code point at *text and moves on; false for invalid UTF-8 (also surrogates and overlong forms). */
bool next_code_point(const char **text, uint32_t *out_code);

#endif
