/* SPDX-License-Identifier: MIT
 *
 * quadratic.h - a small dense quadratic programme. Internal.
 */
#ifndef NARC_FIT_QUADRATIC_H
#define NARC_FIT_QUADRATIC_H

#include <stdbool.h>
#include <stddef.h>

/* Least x.hessian.x / 2 + gradient.x with lower <= x <= upper and, for each row, offset + entries.x >= 0; of the first
 * `equations` rows it is 0. The hessian is symmetric and positive definite, and bounds may be infinite. */
typedef struct narc_quadratic {
    size_t count, rows, equations; /* variables; rows */
    size_t row_capacity;
    double *hessian, *gradient, *lower, *upper; /* [count * count], [count] */
    double *entries, *offset;                   /* entries[row * count + variable] */
    double *solution;                           /* [count] */
    size_t active_count, *active; /* what holds the solution, at most `count`: 2 c is the lower bound of variable c,
                                                   2 c + 1 the upper one, 2 * count + k is row k */
    double *multiplier;           /* of these; of rows that are no equations at least 0 */
    void *memory;                 /* of all arrays */
    double *transform, *triangle, *room; /* see quadratic.c */
    unsigned char *is_active;
    bool settles; /* at its end the solution goes back to the rows that hold it, off which roundings have carried it */
} narc_quadratic;

/* Memory for `count` variables and at most `row_capacity` rows; false if there is none. */
bool narc_open_quadratic(narc_quadratic *quadratic, size_t count, size_t row_capacity);
void narc_close_quadratic(narc_quadratic *quadratic);

/* The entries of a new row with this offset, to be filled in; NULL if there is no room. */
double *narc_add_quadratic_row(narc_quadratic *quadratic, double offset);

/* Fills in the solution, the rows that hold it and their multipliers. False if no x keeps all rows, equations depend on
 * each other, the hessian is not positive definite, or roundings are in the way: then the solution is undefined. */
bool narc_solve_quadratic(narc_quadratic *quadratic);

/* The same after a solution was found and rows were added, which are no equations: it goes on from that solution. */
bool narc_solve_more_rows(narc_quadratic *quadratic);

/* Whether a solution is a corner where gradient.x alone is least, too; the gradient may have changed since. */
bool narc_is_linear_optimum(narc_quadratic *quadratic);

#endif
