/* SPDX-License-Identifier: MIT
 *
 * report.h - what is printed behind the rows: tables of times, targets; the data of the plots.
 */
#ifndef NARC_BENCH_REPORT_H
#define NARC_BENCH_REPORT_H

#include <stdbool.h>
#include <stdio.h>

/* Markdown: the machine, and the targets and times of those rows that ran. */
void print_report(const char *best_isa, FILE *out);

/* The same behind what folder/bench.md has, and what plots.gp draws: folder/arcs.dat and folder/batches.dat, each only if
 * rows for it ran. */
void write_report(const char *best_isa, const char *folder);

/* Lists the rows that must not be wrong and were; true if there are none. */
bool is_all_right(FILE *out);

/* The time of a row in nanoseconds a question, NaN if it did not run. "BEST" in the name is the best instruction set; of
 * two names with " + " between them the sum. */
double time_of(const char *names, const char *best_isa);

void print_targets(const char *best_isa, FILE *out);

#endif
