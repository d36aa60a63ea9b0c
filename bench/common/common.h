/* SPDX-License-Identifier: MIT
 *
 * common.h - memory, errors, the clock, order statistics, results, and what a report says of the machine.
 */
#ifndef NARC_BENCH_COMMON_H
#define NARC_BENCH_COMMON_H

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

/* Nanoseconds of processor time that this thread has used: what else the machine does is not in it. */
double now(void);

/* Sorts `values` and returns the value below which `part` of them lie (0: the least, 0.5: the median). */
double quantile(double *values, size_t count, double part);

/* A file in the folder of results, opened for writing. */
FILE *open_result(const char *folder, const char *name);
void close_result(FILE *file);

/* OpenMP's threads, all of them: for what is not timed. */
const narc_workers *all_workers(void);

/* The processor's name as the system tells it, the compiler's with its version, and the compiler's flags. */
const char *processor_name(void);
extern const char *const compiler_name, *const compiler_flags;

/* Makes the fastest instruction set current, or the one that NARC_ISA names, and returns its name. */
const char *choose_best_isa(void);

/* The value behind `prefix`, such as "--out=", if the argument begins with it; else NULL. */
const char *option_value(const char *argument, const char *prefix);

#endif
