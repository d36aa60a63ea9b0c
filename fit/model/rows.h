/* SPDX-License-Identifier: MIT
 *
 * rows.h - what a fit has to keep, as a finite list of conditions that are smooth in its variables. Internal.
 *
 * Lower rows keep the hull inside (or, where the goal is a distance t to either side, within t of it), upper rows keep
 * the shape within t of the hull:
 *
 *     lower   h(u) - h_K(u) [+ t] >= 0         for a fixed direction u
 *     kink    d.(a - p) + r [+ t] >= 0         corner p inside the line of the edge before an arc, also when d turns
 *     upper   h_K(u) - h(u) + t >= 0           for a fixed direction u
 *
 * A list is made for a chain: the directions where it has least room. When the chain has moved it may need more.
 */
#ifndef NARC_FIT_ROWS_H
#define NARC_FIT_ROWS_H

#include "model/chain.h"
#include "model/profile.h"
#include "outline/hull.h"

typedef enum narc_row_kind { ROW_LOWER, ROW_KINK, ROW_UPPER } narc_row_kind;

typedef struct narc_row {
    narc_row_kind kind;
    size_t arc;           /* of a kink: the arc behind the edge */
    narc_point direction; /* of the others */
    narc_point corner;    /* of the hull, the support point in that direction */
} narc_row;

enum { MAX_ROWS = 1400 };

typedef struct narc_row_list {
    size_t count;
    narc_row items[MAX_ROWS];
} narc_row_list;

/* What is fitted to what. */
typedef struct narc_problem {
    const narc_hull *hull;
    narc_fit_family family;
    narc_fit_goal goal;
    size_t count; /* arcs */
    double min_radius, max_radius;
} narc_problem;

static inline bool narc_must_bound(const narc_problem *problem) { return problem->goal <= NARC_FIT_BOUND_DISTANCE; }

/* Is the goal a largest distance (which the symmetric difference starts from)? */
static inline bool narc_is_distance(const narc_problem *problem) { return problem->goal >= NARC_FIT_BOUND_DISTANCE; }

/* An arc turns by at least this. Normals then stay apart in single precision, and a shorter arc would not matter. */
#define LEAST_SWEEP 1e-3

/* How far an arc may turn; polygons need sides that meet: the tips of thin hulls turn by
 * nearly half a turn. */
static inline double narc_widest_sweep(const narc_problem *problem) {
    return problem->family == NARC_FIT_POLYGON ? 3.1415 : 3.14159265358979323846;
}

/* How many rows: a linear programme goes far and takes many. A step of the local search goes less far, and its time
 * grows with their number. */
typedef enum narc_row_density { ROWS_OF_A_STEP, ROWS_OF_A_PROGRAMME } narc_row_density;

/* The rows for a chain. `intervals` is room for its profile. */
void narc_list_rows(const narc_problem *problem, const narc_chain *chain, narc_row_density density,
                    narc_interval *intervals, narc_row_list *out_rows);

/* Adds rows where a chain with a profile of `count` intervals goes too far by more than `slack`, at most 100 or so.
 * Returns how many. */
size_t narc_add_violated(const narc_problem *problem, const narc_interval *intervals, size_t count, double slack,
                         narc_row_list *rows);

/* The left side of a row for a placed chain, without t; adds its derivatives (in the order of narc_make_layout(), t
 * included) to `derivatives`, which is NULL or zeros. */
double narc_evaluate_row(const narc_problem *problem, const narc_chain *chain, const narc_row *row,
                         double *derivatives);

#endif
