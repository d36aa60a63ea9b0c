/* SPDX-License-Identifier: MIT
 *
 * refine.c - the last steps of the local search: sequential quadratic programming.
 *
 * It works on all variables at once. A step is a quadratic programme: the rows of the chain that it starts from, which are
 * smooth, and closure as an equation, both made linear, and the curvature that the steps before have shown (Powell 1978).
 * Where it ends the chain is closed and moved out until it bounds, so that a step is judged by what it leads to; rows that
 * are missed there come in, and then the step is shortened. Rows are listed anew for each step.
 */
#include <stdlib.h>
#include <string.h>

#include "model/difference.h"
#include "outline/vector.h"
#include "solve/search.h"

/* What goes too far by more than this was for lack of a row. */
static const double ROW_TOLERANCE = 1e-7;

/* A step is solved again with rows that it missed, so many times, once more with rows corrected by what they are where it
 * leads, and then shortened by this, so many times; where there are no rows only shortened. */
enum { RETRIES = 3, SHORTENINGS = 6, BARE_SHORTENINGS = 12 };
static const double SHORTER = 0.4;

/* A step that gains this part of what it promises is good. */
static const double FAIR = 0.3;

/* Rows with more room than this, in units of the hull's radius, are left out until they are missed: the time of a step
 * grows with their number. */
static const double NEAR = 0.1;

/* Normals turn by at most this in a step, and by less after steps that had to be shortened. */
static const double BOX_TURN = 0.3, BOX_LENGTH = 1, LEAST_BOX = 1e-5;

/* So many steps in a row that gain too little are the last. Without rows the curvature alone tells how far to go, and there
 * are so many times as many. The caller is asked whether to go on after some steps. */
enum { PATIENCE = 2, BARE_STEPS = 4, STEPS_OF_A_REPORT = 8 };

/* After so many steps those that follow a whole one gain at most some times as much, together. */
enum { HOPEFUL_STEPS = 2 };

/* A bound on an arc: it turns by more than nothing, and not by too much, and its radius is neither too large nor too
 * small. All are linear: factor * (sweep - than) + length_factor * length <= 0. */
struct limit {
    size_t arc;
    double factor, sweep, length_factor;
};

struct descent {
    narc_search *search;
    narc_chain chain;
    double distance, widest;
    double sweep[MAX_CHAIN];
    size_t limit_count;
    struct limit limits[4 * MAX_CHAIN];
    size_t free_count, free[NARC_MOST_VARIABLES]; /* the variables that are not 0 throughout */
    size_t first_row;                             /* of the programme: conditions begin there */
    double x[NARC_MOST_VARIABLES], gradient[NARC_MOST_VARIABLES];
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

/* A step's time grows with the square of their number. */
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

/* Of all variables those that are free, times a factor. */
static void take_free(const struct descent *descent, const double *all, double factor, double *out) {
    for (size_t k = 0; k < descent->free_count; k++)
        out[k] = factor * all[descent->free[k]];
}

/* Sets descent->x, and what a gradient's conversion needs, to a chain. */
static void begin_at(struct descent *descent, const narc_candidate *at) {
    descent->chain = at->chain;
    descent->distance = narc_is_distance(&descent->search->problem) ? at->value : 0;
    for (size_t i = 0; i < at->chain.count; i++)
        descent->sweep[i] = fmax(0.1 * LEAST_SWEEP, narc_end_angle(&at->chain, i) - at->chain.angle[i]);
    write_variables(&at->chain, descent->distance, descent->x);
}

/* Moves the chain by a share of the programme's solution from x, which stays. */
static void move_by(struct descent *descent, double share) {
    narc_chain *const chain = &descent->chain;
    const narc_layout layout = narc_make_layout(chain->count);
    const double *const step = descent->search->quadratic.solution;
    double x[NARC_MOST_VARIABLES];
    memcpy(x, descent->x, layout.count * sizeof *x);
    for (size_t k = 0; k < descent->free_count; k++)
        x[descent->free[k]] += share * step[k];
    memcpy(chain->edge, x + layout.edge, chain->count * sizeof *x);
    memcpy(chain->angle, x + layout.angle, chain->count * sizeof *x);
    for (size_t i = 0; i < chain->count; i++)
        chain->radius[i] = x[layout.radius + i] / fmax(0.1 * LEAST_SWEEP, narc_end_angle(chain, i) - chain->angle[i]);
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

/* The derivatives of what is made least, by all variables, into descent->gradient. */
static void derive_objective(struct descent *descent) {
    const narc_problem *const problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    double *const out = descent->gradient;
    if (problem->goal == NARC_FIT_DIFFERENCE) {
        narc_difference_area(&descent->chain, problem->hull, (narc_point){0, 0}, out);
    } else if (narc_is_distance(problem)) {
        memset(out, 0, layout.count * sizeof *out);
        out[layout.distance] = 1;
    } else {
        (problem->goal == NARC_FIT_BOUND_PERIMETER ? narc_derive_perimeter : narc_derive_area)(&descent->chain, out);
    }
    convert_gradient(descent, out);
}

/* The derivatives of a condition, likewise; returns its value. */
static double derive_condition(struct descent *descent, const narc_row *row) {
    const narc_problem *const problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    double *const out = descent->gradient;
    memset(out, 0, layout.count * sizeof *out);
    const double room = narc_evaluate_row(problem, &descent->chain, row, out);
    const double value = room + out[layout.distance] * descent->distance;
    convert_gradient(descent, out);
    return value;
}

/* The derivatives of the gap. */
static void derive_closure(struct descent *descent, double out[2][NARC_MOST_VARIABLES]) {
    memset(out[0], 0, sizeof out[0]);
    memset(out[1], 0, sizeof out[1]);
    narc_derive_gap(&descent->chain, out[0], out[1]);
    convert_gradient(descent, out[0]);
    convert_gradient(descent, out[1]);
}

/* ---------------------------------------------------------------------------- the programme of a step */

static void add_closure(struct descent *descent) {
    narc_quadratic *const q = &descent->search->quadratic;
    const narc_point gap = minus(descent->chain.center[descent->chain.count], descent->chain.center[0]);
    double rows[2][NARC_MOST_VARIABLES];
    derive_closure(descent, rows);
    take_free(descent, rows[0], 1, narc_add_quadratic_row(q, gap.x));
    take_free(descent, rows[1], 1, narc_add_quadratic_row(q, gap.y));
    q->equations = 2;
}

static double read_sweep(const narc_layout *layout, size_t n, size_t arc, const double *x) {
    const size_t next = (arc + 1) % n;
    return x[layout->angle + next] - x[layout->angle + arc] + (next ? 0 : 2 * PI);
}

/* The limits that a step may come to within its box. */
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

static void add_limits(struct descent *descent) {
    const size_t n = descent->chain.count;
    const narc_layout layout = narc_make_layout(n);
    for (size_t k = 0; k < descent->limit_count; k++) {
        const struct limit *const limit = &descent->limits[k];
        const double value = limit->factor * (read_sweep(&layout, n, limit->arc, descent->x) - limit->sweep) +
                             limit->length_factor * descent->x[layout.radius + limit->arc];
        double *const entries = descent->gradient;
        memset(entries, 0, layout.count * sizeof *entries);
        entries[layout.angle + (limit->arc + 1) % n] += limit->factor;
        entries[layout.angle + limit->arc] -= limit->factor;
        entries[layout.radius + limit->arc] += limit->length_factor;
        take_free(descent, entries, -1, narc_add_quadratic_row(&descent->search->quadratic, -value));
    }
}

/* Those of the list that the programme has not. The chain is where the step begins. */
static void add_conditions(struct descent *descent) {
    narc_quadratic *const q = &descent->search->quadratic;
    const narc_row_list *const rows = descent->search->rows;
    for (size_t k = q->rows - descent->first_row; k < rows->count; k++) {
        const double value = derive_condition(descent, &rows->items[k]);
        take_free(descent, descent->gradient, 1, narc_add_quadratic_row(q, value));
    }
}

/* Besides the lasting bounds, a step keeps within a box around where it begins: further away its rows say little. */
static void set_bounds(struct descent *descent, double box) {
    const narc_problem *const problem = &descent->search->problem;
    const narc_layout layout = narc_make_layout(problem->count);
    narc_quadratic *const q = &descent->search->quadratic;
    for (size_t k = 0; k < descent->free_count; k++) {
        const size_t c = descent->free[k];
        const bool is_edge = c >= layout.edge && c < layout.start, is_angle = c >= layout.angle && c < layout.distance;
        q->lower[k] = is_angle ? -box : c < layout.start || c == layout.distance ? -descent->x[c] : -INFINITY;
        q->upper[k] = is_angle ? box : is_edge ? narc_edge_limit(problem) - descent->x[c] : INFINITY;
    }
}

static void state_programme(struct descent *descent, const narc_candidate *from, double box) {
    narc_search *const search = descent->search;
    begin_at(descent, from);
    search->quadratic.rows = 0;
    derive_objective(descent);
    take_free(descent, descent->gradient, 1, search->quadratic.gradient);
    add_closure(descent);
    list_limits(descent, box, descent->x);
    add_limits(descent);
    descent->first_row = search->quadratic.rows;
    search->rows->count = 0;
    if (search->problem.goal != NARC_FIT_DIFFERENCE) {
        narc_list_rows(&search->problem, &from->chain, ROWS_OF_A_STEP, search->intervals, search->rows);
        keep_near(&search->problem, &from->chain, from->value, search->rows);
    }
    add_conditions(descent);
    set_bounds(descent, box);
}

/* ---------------------------------------------------------------------------- curvature */

static void forget_curvature(narc_quadratic *q) {
    memset(q->hessian, 0, q->count * q->count * sizeof *q->hessian);
    for (size_t k = 0; k < q->count; k++)
        q->hessian[k * q->count + k] = 1;
}

/* Takes from a gradient those of the rows that hold the step, times their multipliers, as they are where the chain is now.
 * Those of limits and bounds are the same everywhere. */
static void take_rows_away(struct descent *descent, double *gradient) {
    const narc_quadratic *const q = &descent->search->quadratic;
    double gap[2][NARC_MOST_VARIABLES], row[NARC_MOST_VARIABLES];
    derive_closure(descent, gap);
    for (size_t a = 0; a < q->active_count; a++) {
        const size_t k = q->active[a] - 2 * q->count; /* of bounds wrapped round */
        if (k < q->equations) {
            take_free(descent, gap[k], q->multiplier[a], row);
        } else if (k >= descent->first_row && k < q->rows) {
            derive_condition(descent, &descent->search->rows->items[k - descent->first_row]);
            take_free(descent, descent->gradient, q->multiplier[a], row);
        } else {
            continue;
        }
        for (size_t c = 0; c < q->count; c++)
            gradient[c] -= row[c];
    }
}

/* The gradient of the Lagrangian at a chain. */
static void derive_lagrangian(struct descent *descent, const narc_candidate *at, double *out) {
    begin_at(descent, at);
    derive_objective(descent);
    take_free(descent, descent->gradient, 1, out);
    take_rows_away(descent, out);
}

/* The damped update of Broyden, Fletcher, Goldfarb and Shanno: after a move the gradient has changed by `change`. */
static void learn_curvature(narc_quadratic *q, const double *move, double *change) {
    const size_t n = q->count;
    double product[NARC_MOST_VARIABLES], expected = 0, seen = 0;
    for (size_t i = 0; i < n; i++) {
        product[i] = 0;
        for (size_t k = 0; k < n; k++)
            product[i] += q->hessian[i * n + k] * move[k];
        expected += move[i] * product[i];
        seen += move[i] * change[i];
    }
    if (!(expected > 1e-20))
        return;
    if (seen < 0.2 * expected) {
        const double part = 0.8 * expected / (expected - seen);
        for (size_t i = 0; i < n; i++)
            change[i] = part * change[i] + (1 - part) * product[i];
        seen = 0.2 * expected;
    }
    for (size_t i = 0; i < n; i++)
        for (size_t k = 0; k < n; k++)
            q->hessian[i * n + k] += change[i] * change[k] / seen - product[i] * product[k] / expected;
}

/* ---------------------------------------------------------------------------- steps */

/* False if the sectors are out of order or the chain can't be closed. */
static bool take_chain(narc_search *search, const narc_chain *chain, narc_candidate *out_next) {
    out_next->chain = *chain;
    out_next->value = INFINITY;
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
    const double slack = ROW_TOLERANCE + (narc_is_distance(&search->problem) ? distance : 0);
    return narc_add_violated(&search->problem, search->intervals, count, slack, search->rows);
}

/* Offsets of rows such that the programme's last solution has their true values there: what is bent is seen. The chain is
 * where that solution leads. */
static void correct_offsets(struct descent *descent) {
    narc_quadratic *const q = &descent->search->quadratic;
    const narc_problem *const problem = &descent->search->problem;
    const narc_row_list *const rows = descent->search->rows;
    const narc_point gap = minus(descent->chain.center[descent->chain.count], descent->chain.center[0]);
    for (size_t k = 0; k < q->rows; k++) {
        if (k >= q->equations && k < descent->first_row)
            continue;
        double value = k == 0 ? gap.x : gap.y;
        if (k >= descent->first_row) {
            value = narc_evaluate_row(problem, &descent->chain, &rows->items[k - descent->first_row], NULL);
            value += narc_is_distance(problem) ? descent->distance : 0;
        }
        for (size_t c = 0; c < q->count; c++)
            value -= q->entries[k * q->count + c] * q->solution[c];
        q->offset[k] = value;
    }
}

/* Tries a step that was not good once more with such offsets, since a step along bent rows leaves them. If that is no
 * better the solution stays as it was; rows and multipliers are those of the second try. */
static bool take_corrected(struct descent *descent, const narc_candidate *from, narc_candidate *out_next) {
    narc_quadratic *const q = &descent->search->quadratic;
    double first[NARC_MOST_VARIABLES];
    memcpy(first, q->solution, q->count * sizeof *first);
    correct_offsets(descent);
    if (narc_solve_quadratic(q)) {
        narc_candidate corrected;
        move_by(descent, 1);
        if (take_chain(descent->search, &descent->chain, &corrected) && corrected.value < from->value &&
            corrected.value <= out_next->value) {
            *out_next = corrected;
            return true;
        }
    }
    memcpy(q->solution, first, q->count * sizeof *first);
    return false;
}

/* Where a step leads: solved again with rows that it missed, and shortened, until it gains. False if it never does;
 * *out_share is how much of it was taken. */
static bool take_step(struct descent *descent, const narc_candidate *from, double *out_share,
                      narc_candidate *out_next) {
    narc_search *const search = descent->search;
    narc_quadratic *const q = &search->quadratic;
    const bool bare = search->problem.goal == NARC_FIT_DIFFERENCE;
    *out_share = 1;
    for (unsigned retry = 0;; retry++) {
        if (!(retry ? narc_solve_more_rows : narc_solve_quadratic)(q))
            return false;
        double promised = 0;
        for (size_t k = 0; k < q->count; k++)
            promised -= q->gradient[k] * q->solution[k];
        move_by(descent, 1);
        const bool whole = take_chain(search, &descent->chain, out_next);
        if (whole && out_next->value < from->value && from->value - out_next->value > FAIR * promised)
            return true;
        if (retry == RETRIES || bare || add_missing(search, &descent->chain, descent->distance) == 0)
            break;
        begin_at(descent, from);
        add_conditions(descent);
    }
    if (!bare && take_corrected(descent, from, out_next))
        return true;
    for (unsigned k = 0; k < (bare ? BARE_SHORTENINGS : SHORTENINGS) && !(out_next->value < from->value); k++) {
        *out_share *= SHORTER;
        move_by(descent, *out_share);
        take_chain(search, &descent->chain, out_next);
    }
    return out_next->value < from->value;
}

void narc_refine(narc_search *search, narc_candidate *best, unsigned steps, double gain, double target) {
    struct descent descent = {.search = search, .widest = narc_widest_sweep(&search->problem)};
    narc_quadratic *const q = &search->quadratic;
    list_free(&descent);
    q->count = descent.free_count;
    forget_curvature(q);
    steps *= search->problem.goal == NARC_FIT_DIFFERENCE ? BARE_STEPS : 1;
    double box = BOX_TURN;
    unsigned idle = 0;
    bool fresh = true;
    for (unsigned step = 0; step < steps && idle < PATIENCE && box > LEAST_BOX; step++) {
        if (step % STEPS_OF_A_REPORT == 0 && !narc_advance(search->progress, 0))
            break;
        double share, before[NARC_MOST_VARIABLES], after[NARC_MOST_VARIABLES], from[NARC_MOST_VARIABLES];
        narc_candidate next;
        state_programme(&descent, best, box);
        if (!take_step(&descent, best, &share, &next)) {
            box *= fresh ? 0.2 : 0.5;
            idle += fresh;
            fresh = true;
            forget_curvature(q);
            continue;
        }
        derive_lagrangian(&descent, best, before);
        take_free(&descent, descent.x, 1, from);
        derive_lagrangian(&descent, &next, after);
        for (size_t k = 0; k < q->count; k++) {
            from[k] = descent.x[descent.free[k]] - from[k];
            after[k] -= before[k];
        }
        learn_curvature(q, from, after);
        fresh = false;
        box *= share < 1 ? 0.5 : 1;
        const double gained = best->value - next.value;
        idle = gained < gain * best->value ? idle + 1 : 0;
        *best = next;
        if (step >= HOPEFUL_STEPS && share == 1 && best->value - search->hope * gained > target)
            break;
    }
}
