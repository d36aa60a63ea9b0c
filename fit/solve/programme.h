/* SPDX-License-Identifier: MIT
 *
 * programme.h - a small linear programme. Internal.
 */
#ifndef NARC_FIT_PROGRAMME_H
#define NARC_FIT_PROGRAMME_H

#include <stdbool.h>
#include <stddef.h>

#include "solve/quadratic.h"

/* Least objective.x with lower <= x <= upper and, for each row, row.x >= row_lower, or equal: rows that are equations
 * come first. Bounds may be infinite. */
typedef struct narc_programme {
    size_t columns, rows;
    void *memory;                      /* of all arrays */
    double *objective, *lower, *upper; /* of the columns */
    double *row_lower, *entries;       /* entries[row * columns + column] */
    size_t equations;                  /* the first rows */
    size_t row_capacity, loaded;       /* rows that the solver has */
    double *solution;
    narc_quadratic quadratic; /* solves it: of the columns with room between their bounds, which are listed */
    size_t *listed;
} narc_programme;

/* Memory for `columns` columns and at most `row_capacity` rows; false if there is none. */
bool narc_open_programme(narc_programme *programme, size_t columns, size_t row_capacity);
void narc_close_programme(narc_programme *programme);

/* Removes all rows; bounds of all columns become infinite, the objective 0. */
void narc_clear_programme(narc_programme *programme);

/* A new row of zeros, to be filled in; NULL if there is no room. */
double *narc_add_row(narc_programme *programme, double lower, bool is_equation);

/* Fills in `solution`; where there is no end of it, one that is far out. False if there is none. It may be called again with more rows;
 * objective and bounds stay until the programme is cleared. */
bool narc_solve_programme(narc_programme *programme);

#endif
