/* SPDX-License-Identifier: MIT
 *
 * report.h - what is printed behind the rows: tables of times; the data of the plot.
 */
#ifndef NARC_BENCH_REPORT_H
#define NARC_BENCH_REPORT_H

#include <stdbool.h>
#include <stdio.h>

/* Markdown: the machine, and the times of those rows that ran. */
void print_report(const char *best_isa, FILE *out);

/* The same behind what folder/bench.md has, and what plots.gp draws if rows for it ran: folder/arcs.dat. */
void write_report(const char *best_isa, const char *folder);

/* Lists the rows that must not be wrong and were; true if there are none. */
bool is_all_right(FILE *out);

#endif
