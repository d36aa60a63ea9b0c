/* SPDX-License-Identifier: MIT
 *
 * programme.c - linear programmes as quadratic ones with a little curvature, around where the last one ended: the solution
 * of the first is mostly a corner already that is the linear programme's (its multipliers tell), and if not, the next
 * ones end at one (the proximal point method, which ends after a few programmes where all rows are linear).
 */
#include "solve/programme.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

/* Of the first programme, around 0, and of those around the last solution. The less curvature the further a step goes,
 * and the more is lost in roundings. */
static const double CURVATURE = 1e-5, LESS_CURVATURE = 1e-7;
enum { STEPS = 10 };

/* A step that moves, or gains, by less has ended. */
static const double STILL = 1e-9;

bool narc_open_programme(narc_programme *programme, size_t columns, size_t row_capacity) {
    *programme = (narc_programme){.columns = columns, .row_capacity = row_capacity};
    const size_t entries = row_capacity * columns;
    double **const arrays[] = {&programme->objective, &programme->lower,     &programme->upper,
                               &programme->solution,  &programme->row_lower, &programme->entries};
    const size_t sizes[] = {columns, columns, columns, columns, row_capacity, entries};
    const size_t size = (4 * columns + row_capacity + entries) * sizeof(double);
    double *next = programme->memory = malloc(size + columns * sizeof *programme->listed);
    if (!next || !narc_open_quadratic(&programme->quadratic, columns, row_capacity)) {
        narc_close_programme(programme);
        return false;
    }
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; next += sizes[k++])
        *arrays[k] = next;
    programme->listed = (size_t *)next;
    narc_clear_programme(programme);
    return true;
}

void narc_close_programme(narc_programme *programme) {
    free(programme->memory);
    narc_close_quadratic(&programme->quadratic);
    *programme = (narc_programme){0};
}

void narc_clear_programme(narc_programme *programme) {
    programme->rows = programme->loaded = programme->equations = 0;
    for (size_t k = 0; k < programme->columns; k++) {
        programme->objective[k] = 0;
        programme->lower[k] = -INFINITY;
        programme->upper[k] = INFINITY;
    }
}

double *narc_add_row(narc_programme *programme, double lower, bool is_equation) {
    if (programme->rows == programme->row_capacity)
        return NULL;
    double *row = programme->entries + programme->rows * programme->columns;
    memset(row, 0, programme->columns * sizeof *row);
    programme->row_lower[programme->rows++] = lower;
    programme->equations += is_equation;
    return row;
}

static void load_columns(narc_programme *programme) {
    narc_quadratic *const q = &programme->quadratic;
    q->count = q->rows = 0;
    q->equations = programme->equations;
    q->settles = true;
    for (size_t c = 0; c < programme->columns; c++) {
        programme->solution[c] = programme->lower[c];
        if (programme->lower[c] < programme->upper[c]) {
            q->lower[q->count] = programme->lower[c];
            q->upper[q->count] = programme->upper[c];
            programme->listed[q->count++] = c;
        }
    }
    memset(q->hessian, 0, q->count * q->count * sizeof *q->hessian);
}

/* Columns without room are 0 (their bounds are, wherever entries are not). */
static void load_rows(narc_programme *programme) {
    narc_quadratic *const q = &programme->quadratic;
    for (; programme->loaded < programme->rows; programme->loaded++) {
        const double *const entries = programme->entries + programme->loaded * programme->columns;
        double *const row = narc_add_quadratic_row(q, -programme->row_lower[programme->loaded]);
        for (size_t k = 0; k < q->count; k++)
            row[k] = entries[programme->listed[k]];
    }
}

/* The objective with so much curvature around a place. */
static void set_objective(narc_programme *programme, double curvature, const double *around) {
    narc_quadratic *const q = &programme->quadratic;
    for (size_t k = 0; k < q->count; k++) {
        q->hessian[k * q->count + k] = curvature;
        q->gradient[k] = programme->objective[programme->listed[k]] - (around ? curvature * around[k] : 0);
    }
}

static void take_solution(narc_programme *programme) {
    for (size_t k = 0; k < programme->quadratic.count; k++)
        programme->solution[programme->listed[k]] = programme->quadratic.solution[k];
}

bool narc_solve_programme(narc_programme *programme) {
    narc_quadratic *const q = &programme->quadratic;
    const bool is_first = programme->loaded == 0;
    if (is_first) {
        load_columns(programme);
        set_objective(programme, CURVATURE, NULL);
    }
    load_rows(programme);
    if (!(is_first ? narc_solve_quadratic : narc_solve_more_rows)(q))
        return false;
    take_solution(programme);
    for (unsigned step = 0; step < STEPS; step++) {
        set_objective(programme, 0, NULL);
        if (narc_is_linear_optimum(q))
            break;
        set_objective(programme, LESS_CURVATURE, q->solution);
        if (!narc_solve_quadratic(q))
            return false;
        double moved = 0, gained = 0;
        for (size_t k = 0; k < q->count; k++) {
            const size_t column = programme->listed[k];
            const double way = q->solution[k] - programme->solution[column];
            moved = fmax(moved, fabs(way));
            gained -= programme->objective[column] * way;
        }
        take_solution(programme);
        if (moved < STILL || gained < STILL)
            break;
    }
    return true;
}
