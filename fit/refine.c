/* SPDX-License-Identifier: MIT
 *
 * refine.c - the last steps of the local search: Kraft's sequential quadratic programming, from NLopt.
 *
 * It works on all variables at once, with the rows of the chain that it starts from, which are smooth, and closure as
 * an equation. Then the rows are listed anew.
 */
#include <nlopt.h>
#include <stdlib.h>
#include <string.h>

#include "difference.h"
#include "search.h"
#include "vector.h"

/* One round ends when the variables change by less than this, or after so many evaluations. */
static const double STEP_TOLERANCE = 1e-7;
enum { EVALUATIONS = 40 };

/* A round that makes nothing better for lack of rows gets more, so many times in all. */
enum { ATTEMPTS = 2 };

/* Rows with more room than this, in units of the hull's radius, are left to the next round. */
static const double NEAR = 0.2;

static const double BOX_TURN = 0.3, BOX_LENGTH = 1;

/* So many rounds in a row that gain less than this part of the value, in smaller and smaller boxes, are the last. */
static const double LEAST_GAIN = 1e-7;
enum { PATIENCE = 3 };

typedef struct frame {
    search *with;
    chain form;
    double distance, widest;
    double sweep[MAX_CHAIN];
    double gradient[3 * MAX_CHAIN + 3];
} frame;

/* The variables as NLopt has them: those of narc_layout_of(), with angles in place of turns, and lengths of arcs in
 * place of radii. A flat arc is much like an edge: its length matters, and how it is made up of radius and sweep does
 * not, so that with lengths the problem is far less curved. */
static void write_variables(const chain *from, double distance, double *x) {
    const layout columns = narc_layout_of(from->count);
    for (size_t i = 0; i < from->count; i++) {
        x[columns.radius + i] = from->radius[i] * (narc_end_angle(from, i) - from->angle[i]);
    }
    memcpy(x + columns.edge, from->edge, from->count * sizeof *x);
    memcpy(x + columns.angle, from->angle, from->count * sizeof *x);
    x[columns.start] = from->start.x;
    x[columns.start + 1] = from->start.y;
    x[columns.distance] = distance;
}

static void move_to(frame *in, const double *x) {
    chain *form = &in->form;
    const layout columns = narc_layout_of(form->count);
    memcpy(form->edge, x + columns.edge, form->count * sizeof *x);
    memcpy(form->angle, x + columns.angle, form->count * sizeof *x);
    for (size_t i = 0; i < form->count; i++) {
        in->sweep[i] = fmax(0.1 * LEAST_SWEEP, narc_end_angle(form, i) - form->angle[i]);
        form->radius[i] = x[columns.radius + i] / in->sweep[i];
    }
    form->start = (narc_point){x[columns.start], x[columns.start + 1]};
    in->distance = x[columns.distance];
    narc_place_chain(form);
}

/* From derivatives by radii and normals to those by lengths and normals: r = s / (end - start). */
static void convert_gradient(const frame *in, double *gradient) {
    const size_t n = in->form.count;
    const layout columns = narc_layout_of(n);
    for (size_t i = 0; i < n; i++) {
        const double by_length = gradient[columns.radius + i] / in->sweep[i];
        gradient[columns.radius + i] = by_length;
        gradient[columns.angle + i] += by_length * in->form.radius[i];
        gradient[columns.angle + (i + 1) % n] -= by_length * in->form.radius[i];
    }
}

static double measure(const problem *of, const chain *form, double distance, double *gradient) {
    if (of->goal == NARC_FIT_DIFFERENCE) {
        const double area = narc_difference_area(form, of->around, (narc_point){0, 0}, gradient);
        return isfinite(area) ? area : 1e3; /* far off: more than any area here */
    }
    if (narc_is_distance(of)) {
        const layout columns = narc_layout_of(of->count);
        if (gradient) {
            memset(gradient, 0, columns.count * sizeof *gradient);
            gradient[columns.distance] = 1;
        }
        return distance;
    }
    const bool perimeter = of->goal == NARC_FIT_BOUND_PERIMETER;
    if (gradient) {
        (perimeter ? narc_derive_perimeter : narc_derive_area)(form, gradient);
    }
    return perimeter ? narc_chain_perimeter(form) : narc_chain_area(form);
}

static double objective(unsigned count, const double *x, double *gradient, void *context) {
    frame *in = context;
    (void)count;
    move_to(in, x);
    const double value = measure(&in->with->of, &in->form, in->distance, gradient);
    if (gradient) {
        convert_gradient(in, gradient);
    }
    return value;
}

static void closure(unsigned rows, double *result, unsigned count, const double *x, double *gradient, void *context) {
    frame *in = context;
    move_to(in, x);
    const narc_point gap = minus(in->form.center[in->form.count], in->form.center[0]);
    result[0] = gap.x;
    result[1] = gap.y;
    if (gradient) {
        memset(gradient, 0, (size_t)rows * count * sizeof *gradient);
        narc_derive_gap(&in->form, gradient, gradient + count);
        convert_gradient(in, gradient);
        convert_gradient(in, gradient + count);
    }
}

static void conditions(unsigned rows, double *result, unsigned count, const double *x, double *gradient,
                       void *context) {
    frame *in = context;
    const problem *of = &in->with->of;
    const layout columns = narc_layout_of(of->count);
    move_to(in, x);
    for (unsigned k = 0; k < rows; k++) {
        double *of_row = in->gradient;
        memset(of_row, 0, count * sizeof *of_row);
        const double value = narc_evaluate_row(of, &in->form, &in->with->rows->items[k], of_row);
        result[k] = -value - of_row[columns.distance] * in->distance;
        convert_gradient(in, of_row);
        for (unsigned c = 0; c < count && gradient; c++) {
            gradient[(size_t)k * count + c] = -of_row[c];
        }
    }
}

/* Each arc turns by more than nothing and not by too much, and its radius has a limit. */
static void sweeps(unsigned rows, double *result, unsigned count, const double *x, double *gradient, void *context) {
    const frame *in = context;
    const size_t n = rows / 3;
    const layout columns = narc_layout_of(n);
    const double limit = narc_radius_limit(&in->with->of);
    if (gradient) {
        memset(gradient, 0, (size_t)rows * count * sizeof *gradient);
    }
    for (size_t k = 0; k < n; k++) {
        const size_t next = (k + 1) % n;
        const double sweep = x[columns.angle + next] - x[columns.angle + k] + (next ? 0 : 2 * PI);
        const double factors[] = {-1, 1, -limit};
        result[k] = LEAST_SWEEP - sweep;
        result[n + k] = sweep - in->widest;
        result[2 * n + k] = x[columns.radius + k] - limit * sweep;
        for (size_t which = 0; which < 3 && gradient; which++) {
            double *entries = gradient + (which * n + k) * count;
            entries[columns.angle + next] += factors[which];
            entries[columns.angle + k] -= factors[which];
            entries[columns.radius + k] += which == 2 ? 1 : 0;
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
            lower = 0;
            upper = of->family == NARC_FIT_POLYGON ? 0 : x[c] + BOX_LENGTH;
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

static void run_solver(frame *in, const layout *columns, double box, double *x) {
    const unsigned count = (unsigned)columns->count, arcs = (unsigned)in->form.count;
    double least;
    nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, count);
    if (!solver) {
        return;
    }
    set_bounds(solver, &in->with->of, columns, box, x);
    nlopt_set_min_objective(solver, objective, in);
    nlopt_add_equality_mconstraint(solver, 2, closure, in, NULL);
    nlopt_add_inequality_mconstraint(solver, 3 * arcs, sweeps, in, NULL);
    if (in->with->rows->count) {
        nlopt_add_inequality_mconstraint(solver, (unsigned)in->with->rows->count, conditions, in, NULL);
    }
    nlopt_set_xtol_abs1(solver, STEP_TOLERANCE);
    nlopt_set_maxeval(solver, EVALUATIONS);
    nlopt_optimize(solver, x, &least);
    nlopt_destroy(solver);
}

/* False if the sectors are out of order or the chain can't be closed. */
static bool take_chain(search *with, const chain *form, candidate *out_next) {
    out_next->form = *form;
    for (size_t k = 0; k < form->count; k++) {
        if (!(narc_end_angle(form, k) - form->angle[k] > 0.5 * LEAST_SWEEP)) {
            return false;
        }
    }
    if (!narc_close_chain(&out_next->form)) {
        return false;
    }
    out_next->value = narc_settle(with, &out_next->form);
    return isfinite(out_next->value);
}

/* Adds rows where a chain goes too far for lack of them. */
static size_t add_missing(search *with, const chain *form, double distance) {
    const size_t count = narc_make_profile(form, with->of.around, 0, with->intervals);
    const double slack = STEP_TOLERANCE + (narc_is_distance(&with->of) ? distance : 0);
    return narc_add_violated(&with->of, with->intervals, count, slack, with->rows);
}

static bool solve_round(search *with, const candidate *from, double box, candidate *out_next) {
    const layout columns = narc_layout_of(with->of.count);
    with->rows->count = 0;
    if (with->of.goal != NARC_FIT_DIFFERENCE) {
        narc_list_rows(&with->of, &from->form, with->intervals, with->rows);
        keep_near(&with->of, &from->form, from->value, with->rows);
    }
    bool found = false;
    for (unsigned attempt = 0; attempt < ATTEMPTS; attempt++) {
        frame in = {.with = with, .form = from->form, .widest = narc_widest_sweep(&with->of)};
        double x[3 * MAX_CHAIN + 3];
        write_variables(&from->form, narc_is_distance(&with->of) ? from->value : 0, x);
        run_solver(&in, &columns, box, x);
        move_to(&in, x);
        candidate next;
        if (!take_chain(with, &in.form, &next)) {
            break;
        }
        if (!found || next.value < out_next->value) {
            *out_next = next;
        }
        found = true;
        if (next.value < from->value || with->of.goal == NARC_FIT_DIFFERENCE ||
            add_missing(with, &in.form, in.distance) == 0) {
            break;
        }
    }
    return found;
}

void narc_refine(search *with, candidate *best, unsigned rounds) {
    double box = BOX_TURN;
    unsigned idle = 0;
    for (unsigned round = 0; round < rounds && idle < PATIENCE; round++) {
        candidate next;
        const bool better = solve_round(with, best, box, &next) && next.value < best->value;
        const bool gains = better && next.value < best->value * (1 - LEAST_GAIN);
        idle = gains ? 0 : idle + 1;
        box *= gains ? 1 : 0.3;
        if (better) {
            *best = next;
        }
    }
}
