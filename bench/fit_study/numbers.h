/* SPDX-License-Identifier: MIT
 *
 * numbers.h - order statistics.
 */
#ifndef NARC_STUDY_NUMBERS_H
#define NARC_STUDY_NUMBERS_H

#include <stdio.h>

enum { MOST_NUMBERS = 4096 };
typedef struct numbers {
    size_t count;
    double values[MOST_NUMBERS];
} numbers;

/* NAN is left out. */
void add_number(numbers *to, double value);

/* The value below which a part of all lies, between two values by interpolation; sorts them. NAN if there are none. */
double find_quantile(numbers *of, double part);

/* " median (least to largest)". */
void print_range(numbers *of, int decimals, FILE *out);

#endif
