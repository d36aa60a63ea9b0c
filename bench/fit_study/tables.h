/* SPDX-License-Identifier: MIT
 *
 * tables.h - the report; every fit, as CSV; and for plots.gp.
 */
#ifndef NARC_STUDY_TABLES_H
#define NARC_STUDY_TABLES_H

#include "study.h"

void print_results(const study *all, FILE *out);
void print_csv(const study *all, FILE *out);
void print_points(const study *all, FILE *out);

#endif
