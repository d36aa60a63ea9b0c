/* SPDX-License-Identifier: MIT
 *
 * starts.h - sets of normals from which the local search sets out. Internal.
 */
#ifndef NARC_FIT_STARTS_H
#define NARC_FIT_STARTS_H

#include "rows.h"

typedef struct start_list {
    size_t count, room;
    double widest; /* sets with a wider sector are left out */
    double (*angles)[MAX_CHAIN];
} start_list;

/* Fills `room` sets: the reasonable ones first, then random ones. */
void narc_list_starts(const problem *of, start_list *out_starts);

#endif
