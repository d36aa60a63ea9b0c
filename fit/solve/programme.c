/* SPDX-License-Identifier: MIT
 *
 * programme.c - linear programmes through the C interface of COIN CLP.
 */
#include "solve/programme.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <coin/Clp_C_Interface.h>

#include "solve/guard.h"

/* Rows hold to this, in units of the outline's radius. What is left over is repaired exactly afterwards. */
static const double FEASIBLE = 1e-9;

/* The GNU C library takes a block of this size from the system, and when it is released keeps as much free memory from
 * then on. Otherwise each programme's memory would come from the system and go back: a sixth of a fit's time. */
enum { LARGE_BLOCK = 1 << 21 };

static void make_model(void *context) {
    narc_programme *programme = context;
    programme->model = Clp_newModel();
    Clp_setLogLevel(programme->model, 0);
    Clp_setPrimalTolerance(programme->model, FEASIBLE);
    /* All lengths are near 1. With its own scaling CLP may end at what is an optimum of the scaled problem only. */
    Clp_scaling(programme->model, 0);
}

bool narc_open_programme(narc_programme *programme, size_t columns, size_t row_capacity) {
    *programme = (narc_programme){.columns = columns, .row_capacity = row_capacity};
    const size_t entries = row_capacity * columns, longer = columns > row_capacity ? columns : row_capacity;
    double **const arrays[] = {&programme->objective, &programme->lower,     &programme->upper,   &programme->solution,
                               &programme->row_lower, &programme->row_upper, &programme->entries, &programme->packed};
    const size_t sizes[] = {columns, columns, columns, columns, row_capacity, row_capacity, entries, entries};
    const size_t size =
        (4 * columns + 2 * row_capacity + 2 * entries) * sizeof(double) + (entries + longer + 1) * sizeof(int);
    double *next = programme->memory = malloc(size > LARGE_BLOCK ? size : LARGE_BLOCK);
    if (!next)
        return false;
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; next += sizes[k++])
        *arrays[k] = next;
    programme->packed_index = (int *)next;
    programme->packed_start = programme->packed_index + entries;
    if (!narc_call_guarded(make_model, programme)) {
        narc_close_programme(programme);
        return false;
    }
    narc_clear_programme(programme);
    return true;
}

void narc_close_programme(narc_programme *programme) {
    free(programme->memory);
    if (programme->model)
        Clp_deleteModel(programme->model);
    *programme = (narc_programme){0};
}

void narc_clear_programme(narc_programme *programme) {
    programme->rows = programme->loaded = 0;
    for (size_t k = 0; k < programme->columns; k++) {
        programme->objective[k] = 0;
        programme->lower[k] = -INFINITY;
        programme->upper[k] = INFINITY;
    }
}

double *narc_add_row(narc_programme *programme, double lower, double upper) {
    if (programme->rows == programme->row_capacity)
        return NULL;
    double *row = programme->entries + programme->rows * programme->columns;
    memset(row, 0, programme->columns * sizeof *row);
    programme->row_lower[programme->rows] = lower;
    programme->row_upper[programme->rows++] = upper;
    return row;
}

/* CLP takes its matrix by columns, without zeros. */
static void load_columns(narc_programme *programme) {
    int used = 0;
    for (size_t column = 0; column < programme->columns; column++) {
        programme->packed_start[column] = used;
        for (size_t row = 0; row < programme->rows; row++) {
            const double entry = programme->entries[row * programme->columns + column];
            if (entry != 0) {
                programme->packed[used] = entry;
                programme->packed_index[used++] = (int)row;
            }
        }
    }
    programme->packed_start[programme->columns] = used;
    Clp_loadProblem(programme->model, (int)programme->columns, (int)programme->rows, programme->packed_start,
                    programme->packed_index, programme->packed, programme->lower, programme->upper,
                    programme->objective, programme->row_lower, programme->row_upper);
}

/* Rows that come later it takes by rows. */
static void add_rows(narc_programme *programme) {
    int used = 0;
    const size_t added = programme->rows - programme->loaded;
    for (size_t k = 0; k < added; k++) {
        programme->packed_start[k] = used;
        const double *row = programme->entries + (programme->loaded + k) * programme->columns;
        for (size_t column = 0; column < programme->columns; column++) {
            if (row[column] != 0) {
                programme->packed[used] = row[column];
                programme->packed_index[used++] = (int)column;
            }
        }
    }
    programme->packed_start[added] = used;
    Clp_addRows(programme->model, (int)added, programme->row_lower + programme->loaded,
                programme->row_upper + programme->loaded, programme->packed_start, programme->packed_index,
                programme->packed);
}

/* With rows added, the dual method goes on from the last solution. */
static void solve_model(void *context) {
    narc_programme *programme = context;
    Clp_Simplex *model = programme->model;
    if (programme->loaded == 0)
        load_columns(programme);
    else
        add_rows(programme);
    programme->loaded = programme->rows;
    Clp_dual(model, 0);
    if (Clp_status(model) != 0)
        Clp_primal(model, 0);
}

bool narc_solve_programme(narc_programme *programme) {
    if (!narc_call_guarded(solve_model, programme)) {
        programme->no_memory = true;
        programme->model = NULL; /* CLP leaves it half changed: to delete it may release memory twice */
        return false;
    }
    if (Clp_status(programme->model) != 0)
        return false;
    memcpy(programme->solution, Clp_primalColumnSolution(programme->model),
           programme->columns * sizeof *programme->solution);
    return true;
}
