/* SPDX-License-Identifier: MIT
 *
 * refine.c - the last steps of the local search: Kraft's sequential quadratic programming, from NLopt.
 *
 * It works on all variables at once, with the rows of the chain that it starts from, which are smooth, and closure as an
 * equation. Then the rows are listed anew.
 */
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

#include "difference.h"
#include "search.h"
#include "vector.h"

/* One round ends when the variables change by less than this, or after so many evaluations. */
static const double STEP_TOLERANCE = 1e-7;
enum { EVALUATIONS = 100 };

/* Rows with more room than this, in units of the hull's radius, are left to the next round. */
static const double NEAR = 0.08;

static const double BOX_TURN = 0.3, BOX_RADIUS = 2, SMALL_RADIUS = 0.3;

/* A round that gains less than this part of the value is the last. */
static const double LEAST_GAIN = 1e-6;

typedef struct frame {
    search *with;
    chain form;
    double distance, widest;
    double gradient[3 * MAX_CHAIN + 3];
} frame;

/* The variables as NLopt has them: those of narc_layout_of(), angles in place of turns. */
static void write_variables(const chain *from, double distance, double *x) {
    const layout columns = narc_layout_of(from->count);
    memcpy(x + columns.radius, from->radius, from->count * sizeof *x);
    memcpy(x + columns.edge, from->edge, from->count * sizeof *x);
    memcpy(x + columns.angle, from->angle, from->count * sizeof *x);
    x[columns.start] = from->start.x;
    x[columns.start + 1] = from->start.y;
    x[columns.distance] = distance;
}

static void read_variables(const double *x, chain *out_form, double *out_distance) {
    const layout columns = narc_layout_of(out_form->count);
    memcpy(out_form->radius, x + columns.radius, out_form->count * sizeof *x);
    memcpy(out_form->edge, x + columns.edge, out_form->count * sizeof *x);
    memcpy(out_form->angle, x + columns.angle, out_form->count * sizeof *x);
    out_form->start = (narc_point){x[columns.start], x[columns.start + 1]};
    *out_distance = x[columns.distance];
    narc_place_chain(out_form);
}

static double objective(unsigned count, const double *x, double *gradient, void *context) {
    frame *in = context;
    const problem *of = &in->with->of;
    read_variables(x, &in->form, &in->distance);
    if (of->goal == NARC_FIT_DIFFERENCE) {
        return narc_difference_area(&in->form, of->around, gradient);
    }
    if (narc_is_distance(of)) {
        if (gradient) {
            memset(gradient, 0, count * sizeof *gradient);
            gradient[narc_layout_of(of->count).distance] = 1;
        }
        return in->distance;
    }
    const bool perimeter = of->goal == NARC_FIT_BOUND_PERIMETER;
    if (gradient) {
        (perimeter ? narc_derive_perimeter : narc_derive_area)(&in->form, gradient);
    }
    return perimeter ? narc_chain_perimeter(&in->form) : narc_chain_area(&in->form);
}

static void closure(unsigned rows, double *result, unsigned count, const double *x, double *gradient, void *context) {
    frame *in = context;
    read_variables(x, &in->form, &in->distance);
    const narc_point gap = minus(in->form.center[in->form.count], in->form.center[0]);
    result[0] = gap.x;
    result[1] = gap.y;
    if (gradient) {
        memset(gradient, 0, (size_t)rows * count * sizeof *gradient);
        narc_derive_gap(&in->form, gradient, gradient + count);
    }
}

static void conditions(unsigned rows, double *result, unsigned count, const double *x, double *gradient,
                       void *context) {
    frame *in = context;
    const problem *of = &in->with->of;
    const layout columns = narc_layout_of(of->count);
    read_variables(x, &in->form, &in->distance);
    for (unsigned k = 0; k < rows; k++) {
        double *of_row = in->gradient;
        memset(of_row, 0, count * sizeof *of_row);
        const double value = narc_evaluate_row(of, &in->form, &in->with->rows->items[k], of_row);
        result[k] = -value - of_row[columns.distance] * in->distance;
        for (unsigned c = 0; c < count && gradient; c++) {
            gradient[(size_t)k * count + c] = -of_row[c];
        }
    }
}

/* Each arc turns by more than nothing and by at most half a turn. */
static void sweeps(unsigned rows, double *result, unsigned count, const double *x, double *gradient, void *context) {
    const frame *in = context;
    const size_t n = rows / 2;
    const layout columns = narc_layout_of(n);
    if (gradient) {
        memset(gradient, 0, (size_t)rows * count * sizeof *gradient);
    }
    for (size_t k = 0; k < n; k++) {
        const size_t next = (k + 1) % n;
        const double sweep = x[columns.angle + next] - x[columns.angle + k] + (next ? 0 : 2 * PI);
        result[k] = LEAST_SWEEP - sweep;
        result[n + k] = sweep - in->widest;
        if (gradient) {
            gradient[k * count + columns.angle + next] -= 1;
            gradient[k * count + columns.angle + k] += 1;
            gradient[(n + k) * count + columns.angle + next] += 1;
            gradient[(n + k) * count + columns.angle + k] -= 1;
        }
    }
}

/* Keeps only rows with little room. */
static void keep_near(const problem *of, const chain *at, double distance, row_list *rows) {
    size_t kept = 0;
    for (size_t k = 0; k < rows->count; k++) {
        if (narc_evaluate_row(of, at, &rows->items[k], NULL) + (narc_is_distance(of) ? distance : 0) < NEAR) {
            rows->items[kept++] = rows->items[k];
        }
    }
    rows->count = kept;
}

/* Besides the lasting bounds, a round keeps within a box around where it begins: further away its rows say little. */
static void set_bounds(nlopt_opt solver, const problem *of, const layout *columns, double box, const double *x) {
    for (unsigned c = 0; c < columns->count; c++) {
        double lower = -HUGE_VAL, upper = HUGE_VAL;
        if (c < columns->edge) {
            const double reach = BOX_RADIUS * (x[c] + SMALL_RADIUS);
            lower = fmax(0, x[c] - reach);
            upper = fmin(narc_radius_limit(of), x[c] + reach);
        } else if (c < columns->start) {
            lower = 0;
            upper = narc_edge_limit(of);
        } else if (c >= columns->angle && c < columns->distance) {
            lower = x[c] - box;
            upper = x[c] + box;
        } else if (c == columns->distance) {
            lower = 0;
        }
        nlopt_set_lower_bound(solver, (int)c, lower);
        nlopt_set_upper_bound(solver, (int)c, upper);
    }
}

static bool solve_round(search *with, const candidate *from, double box, candidate *out_next) {
    const layout columns = narc_layout_of(with->of.count);
    const unsigned count = (unsigned)columns.count, arcs = (unsigned)with->of.count;
    const double no_turns[MAX_CHAIN] = {0};
    with->rows->count = 0;
    if (with->of.goal != NARC_FIT_DIFFERENCE) {
        narc_list_rows(&with->of, &from->form, no_turns, with->intervals, with->rows);
        keep_near(&with->of, &from->form, from->value, with->rows);
    }
    frame in = {.with = with, .form = from->form, .widest = narc_widest_sweep(&with->of)};
    double x[3 * MAX_CHAIN + 3], least = 0;
    write_variables(&from->form, narc_is_distance(&with->of) ? from->value : 0, x);
    nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, count);
    if (!solver) {
        return false;
    }
    set_bounds(solver, &with->of, &columns, box, x);
    nlopt_set_min_objective(solver, objective, &in);
    nlopt_add_equality_mconstraint(solver, 2, closure, &in, NULL);
    nlopt_add_inequality_mconstraint(solver, 2 * arcs, sweeps, &in, NULL);
    if (with->rows->count) {
        nlopt_add_inequality_mconstraint(solver, (unsigned)with->rows->count, conditions, &in, NULL);
    }
    nlopt_set_xtol_abs1(solver, STEP_TOLERANCE);
    nlopt_set_maxeval(solver, EVALUATIONS);
    nlopt_optimize(solver, x, &least);
    nlopt_destroy(solver);
    out_next->form.count = with->of.count;
    read_variables(x, &out_next->form, &least);
    for (size_t k = 0; k < with->of.count; k++) {
        if (!isfinite(x[columns.angle + k]) ||
            narc_end_angle(&out_next->form, k) - out_next->form.angle[k] < 0.5 * LEAST_SWEEP) {
            return false;
        }
    }
    size_t intervals;
    if (!narc_close_chain(&out_next->form)) {
        return false;
    }
    out_next->value = narc_settle(with, &out_next->form, &intervals);
    return isfinite(out_next->value);
}

void narc_refine(search *with, candidate *best, unsigned rounds) {
    double box = BOX_TURN;
    for (unsigned round = 0; round < rounds; round++) {
        candidate next;
        if (!solve_round(with, best, box, &next) || !(next.value < best->value)) {
            box *= 0.3;
            continue;
        }
        const bool done = next.value > best->value * (1 - LEAST_GAIN);
        *best = next;
        if (done) {
            break;
        }
    }
}
