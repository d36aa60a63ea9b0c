/* SPDX-License-Identifier: MIT
 *
 * names.h - UTF-8, and names of shapes. Internal.
 */
#ifndef NARC_NAMES_H
#define NARC_NAMES_H

#include <stdbool.h>
#include <stdint.h>

/* Reads the code point at *text and moves on; false for invalid UTF-8 (also surrogates and overlong forms). */
bool narc_next_code_point(const char **text, uint32_t *out_code);

/* Puts '?' in the place of each byte that is no UTF-8, or a control character. */
void narc_make_printable(char *text);

/* Moves on over a character; false if a name cannot have it. */
bool narc_next_of_name(const char **text);

/* A name is valid UTF-8 that can stand as a field of a CSV file: not empty, no comma, quote or control character, no
 * blank at either end. */
bool narc_is_name(const char *name);

#endif
