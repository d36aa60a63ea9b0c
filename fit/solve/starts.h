/* SPDX-License-Identifier: MIT
 *
 * starts.h - sets of normals from which the local search sets out. Internal.
 */
#ifndef NARC_FIT_STARTS_H
#define NARC_FIT_STARTS_H

#include "model/rows.h"

typedef struct narc_start_list {
    size_t count, room;
    double widest; /* sets with a wider sector are left out */
    double (*angles)[MAX_CHAIN];
    bool no_memory; /* ran out: some are missing */
} narc_start_list;

/* Fills `room` sets: the reasonable ones first, then random ones, other ones in each round. */
void narc_list_starts(const narc_problem *problem, uint64_t round, narc_start_list *out_starts);

/* The widest sector of a list of normals, by the normal it begins with. */
size_t narc_find_widest(const double *angles, size_t count, double *out_sweep);

/* Numbers from 0 to 1 that look random and are the same each time: a counter put through Steele's SplitMix64. */
double narc_next_random(uint64_t *state);

#endif
