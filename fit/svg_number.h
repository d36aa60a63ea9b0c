/* SPDX-License-Identifier: MIT
 *
 * svg_number.h - numbers and lengths in the attributes of an SVG file, and what can be wrong with them. Internal.
 */
#ifndef NARC_SVG_NUMBER_H
#define NARC_SVG_NUMBER_H

#include "narc_fit.h"

/* What is wrong with an attribute: `problem` is a static text, `at` points into its value. */
typedef struct narc_svg_fault {
    narc_status status;
    const char *problem;
    const char *attribute;
    const char *at;
    double value;
} narc_svg_fault;

/* Fills a fault but for its attribute, and returns `status`. */
narc_status narc_set_fault(narc_svg_fault *fault, narc_status status, const char *problem, const char *at,
                           double value);

/* The first character that is no white space. */
const char *narc_skip_space(const char *text);

/* The same, with at most one comma. */
const char *narc_skip_comma(const char *text);

/* Reads a decimal number and moves on; false, and *text stays, if there is none (or one of more than 300 characters).
 * What follows needs no separator: "1.5.5" is two numbers. An exponent needs digits: "1em" is 1 and a unit. Numbers too
 * large for a double are infinite. */
bool narc_take_number(const char **text, double *out_number);

/* A length, and nothing else: in user units, px, mm, cm, Q, in, pt, pc, or a percentage of `whole` (NaN: not known). */
narc_status narc_parse_length(const char *text, double whole, double *out_length, narc_svg_fault *fault);

#endif
