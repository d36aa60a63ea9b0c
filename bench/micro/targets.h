/* SPDX-License-Identifier: MIT
 *
 * targets.h - what was aimed at, and what was reached.
 */
#ifndef NARC_BENCH_TARGETS_H
#define NARC_BENCH_TARGETS_H

#include "report.h"

/* Of settled piles; of the other scenes. */
void print_settled_targets(const struct report *report, FILE *out);
void print_targets(const struct report *report, FILE *out);

#endif
