/* SPDX-License-Identifier: MIT
 *
 * search.h - the local search: from normals to the best chain near them. Internal.
 */
#ifndef NARC_FIT_SEARCH_H
#define NARC_FIT_SEARCH_H

#include <math.h>

#include "programme.h"
#include "rows.h"

/* What is searched for, and the memory for it. The hull is scaled and placed so that its corners are within 1 of the
 * origin. */
typedef struct search {
    problem of;
    interval *intervals;
    row_list *rows;
    programme lp;
} search;

narc_status narc_open_search(search *made, const problem *of, narc_error *error);
void narc_close_search(search *made);

/* A chain and what the goal makes of it: area, perimeter or largest distance. */
typedef struct candidate {
    chain form;
    double value;
} candidate;

/* The best chain with exactly these normals (angles, rising, less than a turn in all), by one linear programme, or a
 * few with more rows. False if there is none. */
bool narc_fit_normals(search *with, const double *angles, candidate *out_best);

/* Goes on from a chain, with its normals too, by sequential quadratic programming. */
void narc_refine(search *with, candidate *best, unsigned rounds);

/* What a placed chain is worth after it was made to bound, if it must. */
double narc_settle(search *with, chain *form);

/* Bounds on a variable, the same in all steps. */
static inline double narc_radius_limit(const problem *of) {
    return of->family == NARC_FIT_POLYGON ? 0 : of->max_radius;
}
static inline double narc_edge_limit(const problem *of) { return of->family == NARC_FIT_N_ARC ? 0 : 100; }

#endif
