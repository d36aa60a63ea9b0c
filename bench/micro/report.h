/* SPDX-License-Identifier: MIT
 *
 * report.h - what is printed behind the rows: the targets and a table of times; and the data of the plots.
 */
#ifndef NARC_BENCH_REPORT_H
#define NARC_BENCH_REPORT_H

#include <stdbool.h>
#include <stdio.h>

#include "bench.h"

struct report {
    struct bench_row *const *rows;
    size_t row_count;
    const char *best_isa;
    size_t packing_pairs;
};

/* Markdown: the machine, and of those rows that ran the targets and the times. */
void print_report(const struct report *report, FILE *out);

/* The same in folder/bench.md, and what plots.gp draws: folder/arcs.dat and folder/batches.dat, each only if rows for
 * it ran. */
void write_report(const struct report *report, const char *folder);

/* Lists the rows that must not be wrong and were; true if there are none. */
bool is_all_right(const struct report *report, FILE *out);

#endif
