/* SPDX-License-Identifier: MIT
 *
 * report.h - what is printed behind the rows: the targets and a table of times; the data of the plots; and their parts.
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

/* ------------------------------------------------------------------------------------------------ its parts */

/* Of settled piles; of the other scenes. */
void print_settled_targets(const struct report *report, FILE *out);
void print_targets(const struct report *report, FILE *out);

void print_settled_times(const struct report *report, FILE *out);

/* The time of a row in nanoseconds per pair, NaN if it did not run. "BEST" in the name is the best instruction set; of
 * two names with " + " between them the sum. */
double time_of(const struct report *report, const char *names);

/* Copies `text` with `value` in the place of the word `key`, if it is there. */
void replace_word(const char *text, const char *key, const char *value, char *out, size_t size);

/* A cell of a table: empty if the value is NaN. */
void print_cell(FILE *out, double value);

#endif
