/* SPDX-License-Identifier: MIT
 *
 * number.h - decimal numbers in texts. Internal.
 */
#ifndef NARC_NUMBER_H
#define NARC_NUMBER_H

#include <stdbool.h>
#include <stddef.h>

/* Reads a decimal number that is all of text[0 .. size - 1], such as -1.5e3, the same in every locale. False if it is
 * none (hexadecimal, "nan" and "inf" are none) or has more than 300 characters. What is too large comes out
 * infinite. */
bool narc_parse_number(const char *text, size_t size, double *out_value);

#endif
