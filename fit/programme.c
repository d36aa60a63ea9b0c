/* SPDX-License-Identifier: MIT
 *
 * programme.c - linear programmes through the C interface of COIN CLP.
 */
#include "programme.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include <coin/Clp_C_Interface.h>

/* Rows hold to this, in units of the outline's radius. What is left over is repaired exactly afterwards. */
static const double FEASIBLE = 1e-9;

bool narc_open_programme(programme *made, size_t columns, size_t row_capacity) {
    *made = (programme){.columns = columns, .row_capacity = row_capacity};
    double **const arrays[] = {&made->objective, &made->lower, &made->upper, &made->solution};
    bool whole = true;
    for (size_t k = 0; k < sizeof arrays / sizeof arrays[0]; k++) {
        *arrays[k] = malloc(columns * sizeof(double));
        whole = whole && *arrays[k];
    }
    made->row_lower = malloc(row_capacity * sizeof(double));
    made->row_upper = malloc(row_capacity * sizeof(double));
    made->entries = malloc(row_capacity * columns * sizeof(double));
    made->packed = malloc(row_capacity * columns * sizeof(double));
    made->packed_index = malloc(row_capacity * columns * sizeof(int));
    made->packed_start = malloc((columns + 1) * sizeof(int));
    made->model = Clp_newModel();
    if (!whole || !made->row_lower || !made->row_upper || !made->entries || !made->packed || !made->packed_index ||
        !made->packed_start || !made->model) {
        narc_close_programme(made);
        return false;
    }
    Clp_setLogLevel(made->model, 0);
    Clp_setPrimalTolerance(made->model, FEASIBLE);
    /* All lengths are near 1. With its own scaling CLP may end at what is an optimum of the scaled problem only. */
    Clp_scaling(made->model, 0);
    narc_clear_programme(made);
    return true;
}

void narc_close_programme(programme *made) {
    free(made->objective);
    free(made->lower);
    free(made->upper);
    free(made->solution);
    free(made->row_lower);
    free(made->row_upper);
    free(made->entries);
    free(made->packed);
    free(made->packed_index);
    free(made->packed_start);
    if (made->model) {
        Clp_deleteModel(made->model);
    }
    *made = (programme){0};
}

void narc_clear_programme(programme *of) {
    of->rows = 0;
    for (size_t k = 0; k < of->columns; k++) {
        of->objective[k] = 0;
        of->lower[k] = -INFINITY;
        of->upper[k] = INFINITY;
    }
}

double *narc_add_row(programme *of, double lower, double upper) {
    if (of->rows == of->row_capacity) {
        return NULL;
    }
    double *row = of->entries + of->rows * of->columns;
    memset(row, 0, of->columns * sizeof *row);
    of->row_lower[of->rows] = lower;
    of->row_upper[of->rows++] = upper;
    return row;
}

/* CLP takes its matrix by columns, without zeros. */
static void pack(programme *of) {
    int used = 0;
    for (size_t column = 0; column < of->columns; column++) {
        of->packed_start[column] = used;
        for (size_t row = 0; row < of->rows; row++) {
            const double entry = of->entries[row * of->columns + column];
            if (entry != 0) {
                of->packed[used] = entry;
                of->packed_index[used++] = (int)row;
            }
        }
    }
    of->packed_start[of->columns] = used;
}

bool narc_solve_programme(programme *of) {
    Clp_Simplex *model = of->model;
    pack(of);
    Clp_loadProblem(model, (int)of->columns, (int)of->rows, of->packed_start, of->packed_index, of->packed, of->lower,
                    of->upper, of->objective, of->row_lower, of->row_upper);
    Clp_dual(model, 0);
    if (Clp_status(model) != 0) {
        Clp_primal(model, 0);
    }
    if (Clp_status(model) != 0) {
        return false;
    }
    memcpy(of->solution, Clp_primalColumnSolution(model), of->columns * sizeof *of->solution);
    return true;
}
