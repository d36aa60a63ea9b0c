/* SPDX-License-Identifier: MIT
 *
 * starts.h - sets of normals from which the local search sets out. Internal.
 */
#ifndef NARC_FIT_STARTS_H
#define NARC_FIT_STARTS_H

#include "rows.h"

/* The most sets that narc_list_starts() makes. */
enum { MAX_STARTS = 24 };

typedef struct start_list {
    size_t count;
    double widest; /* sets with a wider sector are left out */
    double angles[MAX_STARTS][MAX_CHAIN];
} start_list;

void narc_list_starts(const problem *of, start_list *out_starts);

#endif
