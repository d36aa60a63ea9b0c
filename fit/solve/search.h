/* SPDX-License-Identifier: MIT
 *
 * search.h - the local search: from normals to the best chain near them. Internal.
 */
#ifndef NARC_FIT_SEARCH_H
#define NARC_FIT_SEARCH_H

#include <math.h>

#include "model/rows.h"
#include "solve/programme.h"
#include "solve/quadratic.h"

/* Counts the work of a fit, for the caller's progress function. */
typedef struct narc_progress {
    bool (*tell)(size_t done, size_t total, void *context);
    void *context;
    size_t done, limit, total; /* `done` stops at the limit until more is allowed */
    bool cancelled;
} narc_progress;

/* Adds pieces of finished work; 0 only asks the caller. False if the caller wants no more. */
bool narc_advance(narc_progress *progress, size_t pieces);

enum { NARC_MOST_VARIABLES = 3 * MAX_CHAIN + 3 };

/* What is searched for, and the memory for it. The hull is scaled and placed so that its corners are within 1 of the
 * origin. */
typedef struct narc_search {
    narc_problem problem;
    narc_interval *intervals;
    narc_row_list *rows;
    narc_programme programme;
    narc_quadratic quadratic;
    narc_progress *progress;
    double hope; /* of narc_refine(): how many times its last gain a chain may still gain */
} narc_search;

narc_status narc_open_search(narc_search *search, const narc_problem *problem, narc_progress *progress,
                             narc_error *error);
void narc_close_search(narc_search *search);

/* A chain and what the goal makes of it: area, perimeter or largest distance. */
typedef struct narc_candidate {
    narc_chain chain;
    double value;
} narc_candidate;

/* The best chain with exactly these normals (angles, rising, less than a turn in all), by one linear programme, or a
 * few with more rows. False if there is none. */
bool narc_fit_normals(narc_search *search, const double *angles, narc_candidate *out_best);

/* The same with the normals of a chain that fits. The result is no worse than that chain, apart from rounding. */
bool narc_improve(narc_search *search, const narc_chain *chain, narc_candidate *out_best);

/* Goes on from a chain, with its normals too, by sequential quadratic programming: steps that gain less than `gain`, as
 * a part of the value, are few. It ends early where the last gain leaves no hope for the value `target`. */
void narc_refine(narc_search *search, narc_candidate *best, unsigned steps, double gain, double target);

/* Moves a placed chain out until it bounds, if it must, and returns its value. */
double narc_settle(narc_search *search, narc_chain *chain);

/* Bounds on a variable, the same in all steps. */
static inline double narc_radius_limit(const narc_problem *problem) {
    return problem->family == NARC_FIT_POLYGON ? 0 : problem->max_radius;
}
static inline double narc_edge_limit(const narc_problem *problem) {
    return problem->family == NARC_FIT_N_ARC ? 0 : 100;
}

#endif
