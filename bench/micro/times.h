/* SPDX-License-Identifier: MIT
 *
 * times.h - the times of rows by their names.
 */
#ifndef NARC_BENCH_TIMES_H
#define NARC_BENCH_TIMES_H

#include "report.h"

/* The time of a row in nanoseconds per pair, NaN if it did not run. "BEST" in the name is the best instruction set; of
 * two names with " + " between them the sum. */
double time_of(const struct report *report, const char *names);

/* Copies `text` with `value` in the place of the word `key`, if it is there. */
void replace_word(const char *text, const char *key, const char *value, char *out, size_t size);

/* A cell of a table: empty if the value is NaN. */
void print_cell(FILE *out, double value);

#endif
