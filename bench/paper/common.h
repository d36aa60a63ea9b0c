/* SPDX-License-Identifier: MIT
 *
 * common.h - memory, errors, the clock, order statistics, files and progress.
 */
#ifndef NARC_PAPER_COMMON_H
#define NARC_PAPER_COMMON_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "narc_methods.h"

/* Says why on stderr and ends the program with 1. */
_Noreturn void fail(const char *format, ...) __attribute__((format(printf, 1, 2)));

/* Ends the program unless a call went well. */
void must(narc_status status, const narc_error *error);

/* `count` zeroed items, or the end of the program. */
void *allocate(size_t count, size_t size);

/* Nanoseconds of a clock that only runs forward. */
double now(void);

/* Sorts `values` and returns the value below which `part` of them lie (0: the least, 0.5: the median). */
double quantile(double *values, size_t count, double part);

/* "3/40 what" on stderr; the number of steps is set once. */
void set_steps(int count);
void begin_step(const char *what);

/* A file in the folder of results, opened for writing. */
FILE *open_result(const char *folder, const char *name);
void close_result(FILE *file);

/* A list with room for `count` contacts, all arrays given. */
narc_contacts allocate_contacts(size_t count);
void free_contacts(narc_contacts *contacts);

#endif
