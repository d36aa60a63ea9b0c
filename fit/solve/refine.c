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

#include "model/difference.h"
#include "outline/vector.h"
#include "solve/search.h"

/* One attempt ends when the variables change by less than this, or after so many evaluations: a few steps go as far as
 * the rows are good for. Without rows there is one attempt. */
static const double STEP_TOLERANCE = 1e-7;
enum { EVALUATIONS = 4, BARE_EVALUATIONS = 30 };

/* Where an attempt ends too far for lack of rows the round goes on from there with more of them, so many times in all.
 */
enum { ATTEMPTS = 8 };

/* Rows with more room than this, in units of the hull's radius, are left out until they are missed: the time of a step
 * grows with their number. */
static const double NEAR = 0.1;

static const double BOX_TURN = 0.3, BOX_LENGTH = 1;

/* So many rounds in a row that gain too little, in smaller and smaller boxes, are the last. */
enum { PATIENCE = 3 };

/* A bound on an arc: it turns by more than nothing, and not by too much, and its radius is neither too large nor too
 * small. All are linear: factor * (sweep - than) + length_factor * length <= 0. */
struct limit {
    size_t arc;
    double factor, sweep, length_factor;
};

enum { MOST_VARIABLES = 3 * MAX_CHAIN + 3 };

struct descent {
    narc_search *search;
    narc_chain chain;
    double distance, widest;
    double sweep[MAX_CHAIN];
    size_t limit_count;
    struct limit limits[3 * MAX_CHAIN];
    size_t free_count, free[MOST_VARIABLES]; /* the variables that NLopt has */
    double x[MOST_VARIABLES], gradient[MOST_VARIABLES];
};

/* The variables: those of narc_make_layout(), with angles in place of turns, and lengths of arcs in place of radii. A
 * flat arc is much like an edge: its length matters, and how it is made up of radius and sweep does not, so that with
 * lengths the problem is far less curved. */
static void write_variables(const narc_chain *chain, double distance, double *x) {
    const narc_layout layout = narc_make_layout(chain->count);
    for (size_t i = 0; i < chain->count; i++)
        x[layout.radius + i] = chain->radius[i] * (narc_end_angle(chain, i) - chain->angle[i]);
    memcpy(x + layout.edge, chain->edge, chain->count * sizeof *x);
    memcpy(x + layout.angle, chain->angle, chain->count * sizeof *x);
    x[layout.start] = chain->start.x;
    x[layout.start + 1] = chain->start.y;
    x[layout.distance] = distance;
}

/* NLopt has those of the variables that are not 0 throughout: a step's time grows with the square of their number. */
static void list_free(struct descent *descent) {
    const narc_problem *problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    descent->free_count = 0;
    for (size_t c = 0; c < layout.count; c++) {
        const bool none = c < layout.edge    ? problem->family == NARC_FIT_POLYGON
                          : c < layout.start ? problem->family == NARC_FIT_N_ARC
                                             : c == layout.distance && !narc_is_distance(problem);
        if (!none)
            descent->free[descent->free_count++] = c;
    }
}

static void take_free(const struct descent *descent, const double *all, double *out) {
    for (size_t k = 0; k < descent->free_count; k++)
        out[k] = all[descent->free[k]];
}

static void move_to(struct descent *descent, const double *free) {
    narc_chain *chain = &descent->chain;
    const narc_layout layout = narc_make_layout(chain->count);
    double *x = descent->x;
    for (size_t k = 0; k < descent->free_count; k++)
        x[descent->free[k]] = free[k];
    memcpy(chain->edge, x + layout.edge, chain->count * sizeof *x);
    memcpy(chain->angle, x + layout.angle, chain->count * sizeof *x);
    for (size_t i = 0; i < chain->count; i++) {
        descent->sweep[i] = fmax(0.1 * LEAST_SWEEP, narc_end_angle(chain, i) - chain->angle[i]);
        chain->radius[i] = x[layout.radius + i] / descent->sweep[i];
    }
    chain->start = (narc_point){x[layout.start], x[layout.start + 1]};
    descent->distance = x[layout.distance];
    narc_place_chain(chain);
}

/* From derivatives by radii and normals to those by lengths and normals: r = s / (end - start). */
static void convert_gradient(const struct descent *descent, double *gradient) {
    const size_t n = descent->chain.count;
    const narc_layout layout = narc_make_layout(n);
    for (size_t i = 0; i < n; i++) {
        const double by_length = gradient[layout.radius + i] / descent->sweep[i];
        gradient[layout.radius + i] = by_length;
        gradient[layout.angle + i] += by_length * descent->chain.radius[i];
        gradient[layout.angle + (i + 1) % n] -= by_length * descent->chain.radius[i];
    }
}

static double measure(const narc_problem *problem, const narc_chain *chain, double distance, double *gradient) {
    if (problem->goal == NARC_FIT_DIFFERENCE) {
        const double area = narc_difference_area(chain, problem->hull, (narc_point){0, 0}, gradient);
        return isfinite(area) ? area : 1e3; /* far off: more than any area here */
    }
    if (narc_is_distance(problem)) {
        const narc_layout layout = narc_make_layout(problem->count);
        if (gradient) {
            memset(gradient, 0, layout.count * sizeof *gradient);
            gradient[layout.distance] = 1;
        }
        return distance;
    }
    const bool perimeter = problem->goal == NARC_FIT_BOUND_PERIMETER;
    if (gradient)
        (perimeter ? narc_derive_perimeter : narc_derive_area)(chain, gradient);
    return perimeter ? narc_chain_perimeter(chain) : narc_chain_area(chain);
}

static double objective(unsigned count, const double *x, double *gradient, void *context) {
    struct descent *descent = context;
    double *all = gradient ? descent->gradient : NULL;
    (void)count;
    move_to(descent, x);
    const double value = measure(&descent->search->problem, &descent->chain, descent->distance, all);
    if (gradient) {
        convert_gradient(descent, all);
        take_free(descent, all, gradient);
    }
    return value;
}

static void closure(unsigned rows, double *result, unsigned count, const double *x, double *gradient, void *context) {
    struct descent *descent = context;
    move_to(descent, x);
    const narc_point gap = minus(descent->chain.center[descent->chain.count], descent->chain.center[0]);
    result[0] = gap.x;
    result[1] = gap.y;
    (void)rows;
    if (gradient) {
        double x_row[MOST_VARIABLES] = {0}, y_row[MOST_VARIABLES] = {0};
        narc_derive_gap(&descent->chain, x_row, y_row);
        convert_gradient(descent, x_row);
        convert_gradient(descent, y_row);
        take_free(descent, x_row, gradient);
        take_free(descent, y_row, gradient + count);
    }
}

static void conditions(unsigned rows, double *result, unsigned count, const double *x, double *gradient,
                       void *context) {
    struct descent *descent = context;
    const narc_problem *problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    move_to(descent, x);
    for (unsigned k = 0; k < rows; k++) {
        double *of_row = descent->gradient;
        memset(of_row, 0, layout.count * sizeof *of_row);
        const double value = narc_evaluate_row(problem, &descent->chain, &descent->search->rows->items[k], of_row);
        result[k] = -value - of_row[layout.distance] * descent->distance;
        convert_gradient(descent, of_row);
        for (unsigned c = 0; c < count && gradient; c++)
            gradient[(size_t)k * count + c] = -of_row[descent->free[c]];
    }
}

static double read_sweep(const narc_layout *layout, size_t n, size_t arc, const double *x) {
    const size_t next = (arc + 1) % n;
    return x[layout->angle + next] - x[layout->angle + arc] + (next ? 0 : 2 * PI);
}

static void limits(unsigned rows, double *result, unsigned count, const double *free, double *gradient, void *context) {
    struct descent *descent = context;
    const size_t n = descent->chain.count;
    const narc_layout layout = narc_make_layout(n);
    const double *x = descent->x;
    move_to(descent, free);
    for (size_t k = 0; k < rows; k++) {
        const struct limit *limit = &descent->limits[k];
        result[k] = limit->factor * (read_sweep(&layout, n, limit->arc, x) - limit->sweep) +
                    limit->length_factor * x[layout.radius + limit->arc];
        if (gradient) {
            double *entries = descent->gradient;
            memset(entries, 0, layout.count * sizeof *entries);
            entries[layout.angle + (limit->arc + 1) % n] += limit->factor;
            entries[layout.angle + limit->arc] -= limit->factor;
            entries[layout.radius + limit->arc] += limit->length_factor;
            take_free(descent, entries, gradient + k * count);
        }
    }
}

/* The limits that a round may come to within its box. */
static void list_limits(struct descent *descent, double box, const double *x) {
    const size_t n = descent->chain.count;
    const narc_layout layout = narc_make_layout(n);
    const double most = narc_radius_limit(&descent->search->problem), least = descent->search->problem.min_radius;
    descent->limit_count = 0;
    for (size_t k = 0; k < n; k++) {
        const double sweep = read_sweep(&layout, n, k, x), narrow = fmax(LEAST_SWEEP, sweep - 2 * box);
        if (narrow == LEAST_SWEEP)
            descent->limits[descent->limit_count++] = (struct limit){k, -1, LEAST_SWEEP, 0};
        if (sweep + 2 * box > descent->widest)
            descent->limits[descent->limit_count++] = (struct limit){k, 1, descent->widest, 0};
        if (most > 0 && x[layout.radius + k] + BOX_LENGTH > most * narrow)
            descent->limits[descent->limit_count++] = (struct limit){k, -most, 0, 1};
        if (least > 0)
            descent->limits[descent->limit_count++] = (struct limit){k, least, 0, -1};
    }
}

/* Keeps only rows with little room. */
static void keep_near(const narc_problem *problem, const narc_chain *chain, double distance, narc_row_list *rows) {
    size_t kept = 0;
    for (size_t k = 0; k < rows->count; k++)
        if (narc_evaluate_row(problem, chain, &rows->items[k], NULL) + (narc_is_distance(problem) ? distance : 0) <
            NEAR)
            rows->items[kept++] = rows->items[k];
    rows->count = kept;
}

/* Besides the lasting bounds, a round keeps within a box around where it begins: further away its rows say little. */
static void set_bounds(nlopt_opt solver, const struct descent *descent, double box) {
    const narc_problem *problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    for (size_t k = 0; k < descent->free_count; k++) {
        const size_t c = descent->free[k];
        double lower = -HUGE_VAL, upper = HUGE_VAL;
        if (c < layout.start || c == layout.distance)
            lower = 0;
        if (c >= layout.edge && c < layout.start)
            upper = narc_edge_limit(problem);
        if (c >= layout.angle && c < layout.distance) {
            lower = descent->x[c] - box;
            upper = descent->x[c] + box;
        }
        nlopt_set_lower_bound(solver, (int)k, lower);
        nlopt_set_upper_bound(solver, (int)k, upper);
    }
}

/* One attempt, from the descent's chain to another. False if there is no memory. */
static bool run_solver(struct descent *descent, double box, double gain) {
    double least, x[MOST_VARIABLES];
    list_free(descent);
    nlopt_opt solver = nlopt_create(NLOPT_LD_SLSQP, (unsigned)descent->free_count);
    if (!solver)
        return false;
    write_variables(&descent->chain, descent->distance, descent->x);
    take_free(descent, descent->x, x);
    set_bounds(solver, descent, box);
    nlopt_set_min_objective(solver, objective, descent);
    list_limits(descent, box, descent->x);
    const unsigned limit_count = (unsigned)descent->limit_count, row_count = (unsigned)descent->search->rows->count;
    nlopt_result results[5] = {
        nlopt_add_equality_mconstraint(solver, 2, closure, descent, NULL),
        limit_count ? nlopt_add_inequality_mconstraint(solver, limit_count, limits, descent, NULL) : NLOPT_SUCCESS,
        row_count ? nlopt_add_inequality_mconstraint(solver, row_count, conditions, descent, NULL) : NLOPT_SUCCESS,
        nlopt_set_xtol_abs1(solver, STEP_TOLERANCE)};
    nlopt_set_ftol_rel(solver, gain);
    nlopt_set_maxeval(solver, row_count ? EVALUATIONS : BARE_EVALUATIONS);
    results[4] = nlopt_optimize(solver, x, &least);
    nlopt_destroy(solver);
    move_to(descent, x);
    bool has_memory = true;
    for (size_t k = 0; k < sizeof results / sizeof results[0]; k++)
        has_memory = has_memory && results[k] != NLOPT_OUT_OF_MEMORY;
    return has_memory;
}

/* False if the sectors are out of order or the chain can't be closed. */
static bool take_chain(narc_search *search, const narc_chain *chain, narc_candidate *out_next) {
    out_next->chain = *chain;
    for (size_t k = 0; k < chain->count; k++)
        if (!(narc_end_angle(chain, k) - chain->angle[k] > 0.5 * LEAST_SWEEP))
            return false;
    for (size_t k = 0; k < chain->count; k++)
        out_next->chain.radius[k] = fmax(search->problem.min_radius, out_next->chain.radius[k]);
    if (!narc_close_chain(&out_next->chain, search->problem.min_radius))
        return false;
    out_next->value = narc_settle(search, &out_next->chain);
    return isfinite(out_next->value);
}

/* Adds rows where a chain goes too far for lack of them. */
static size_t add_missing(narc_search *search, const narc_chain *chain, double distance) {
    const size_t count = narc_make_profile(chain, search->problem.hull, search->intervals);
    const double slack = STEP_TOLERANCE + (narc_is_distance(&search->problem) ? distance : 0);
    return narc_add_violated(&search->problem, search->intervals, count, slack, search->rows);
}

static bool solve_round(narc_search *search, const narc_candidate *candidate, double box, double gain,
                        narc_candidate *out_next) {
    const bool bare = search->problem.goal == NARC_FIT_DIFFERENCE;
    struct descent descent = {
        .search = search, .chain = candidate->chain, .widest = narc_widest_sweep(&search->problem)};
    descent.distance = narc_is_distance(&search->problem) ? candidate->value : 0;
    search->rows->count = 0;
    if (!bare) {
        narc_list_rows(&search->problem, &candidate->chain, ROWS_OF_A_STEP, search->intervals, search->rows);
        keep_near(&search->problem, &candidate->chain, candidate->value, search->rows);
    }
    bool found = false;
    for (unsigned attempt = 0; attempt < ATTEMPTS; attempt++) {
        if (!run_solver(&descent, box, gain)) {
            search->no_memory = true;
            return false;
        }
        narc_candidate next;
        if (!take_chain(search, &descent.chain, &next))
            break;
        if (!found || next.value < out_next->value)
            *out_next = next;
        found = true;
        if (bare || add_missing(search, &descent.chain, descent.distance) == 0)
            break;
    }
    return found;
}

void narc_refine(narc_search *search, narc_candidate *best, unsigned rounds, double gain) {
    double box = BOX_TURN;
    unsigned idle = 0;
    for (unsigned round = 0;
         round < rounds && idle < PATIENCE && !search->no_memory && narc_advance(search->progress, 0); round++) {
        narc_candidate next;
        const bool better = solve_round(search, best, box, 0.1 * gain, &next) && next.value < best->value;
        const bool gains = better && next.value < best->value * (1 - gain);
        idle = gains ? 0 : idle + 1;
        box *= gains ? 1 : 0.3;
        if (better)
            *best = next;
    }
}
