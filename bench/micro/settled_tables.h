/* SPDX-License-Identifier: MIT
 *
 * settled_tables.h - the tables of times of settled piles.
 */
#ifndef NARC_BENCH_SETTLED_TABLES_H
#define NARC_BENCH_SETTLED_TABLES_H

#include "report.h"

void print_settled_times(const struct report *report, FILE *out);

#endif
