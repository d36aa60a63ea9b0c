/* SPDX-License-Identifier: MIT
 *
 * search.c - the best chain with given normals, by linear programmes.
 *
 * With the normals fixed, closure, perimeter and support function are linear in radii, lengths and position. The square
 * root of the area is concave in them (Brunn and Minkowski): a linear programme that takes the area's derivatives never
 * makes it larger, and the least area is at a corner of the feasible set, where linear programmes end.
 */
#include "solve/search.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "model/difference.h"
#include "outline/vector.h"

/* A solution that goes too far by more than the slack, in units of the hull's radius, gets more rows, so many times. */
static const double SLACK = 1e-7;
enum { ROUNDS = 3 };

/* A shape with less than this part of the hull's area fits nothing. */
static const double LEAST_AREA = 0.25;

bool narc_advance(narc_progress *progress, size_t pieces) {
    progress->done = progress->done + pieces < progress->limit ? progress->done + pieces : progress->limit;
    progress->cancelled =
        progress->cancelled || (progress->tell && !progress->tell(progress->done, progress->total, progress->context));
    return !progress->cancelled;
}

narc_status narc_open_search(narc_search *search, const narc_problem *problem, narc_progress *progress,
                             narc_error *error) {
    *search = (narc_search){.problem = *problem, .progress = progress};
    search->intervals = malloc(narc_count_intervals(problem->count, problem->hull->count) * sizeof *search->intervals);
    search->rows = malloc(sizeof *search->rows);
    if (!search->intervals || !search->rows ||
        !narc_open_programme(&search->programme, narc_make_layout(problem->count).count,
                             2 + problem->count + MAX_ROWS) ||
        !narc_open_quadratic(&search->quadratic, narc_make_layout(problem->count).count,
                             2 + 4 * problem->count + MAX_ROWS)) {
        narc_close_search(search);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory to fit %zu arcs to %zu corners",
                         problem->count, problem->hull->count);
    }
    return NARC_OK;
}

void narc_close_search(narc_search *search) {
    free(search->intervals);
    free(search->rows);
    narc_close_programme(&search->programme);
    narc_close_quadratic(&search->quadratic);
    *search = (narc_search){0};
}

static void set_columns(narc_search *search, const narc_chain *chain) {
    const narc_layout layout = narc_make_layout(chain->count);
    narc_programme *programme = &search->programme;
    narc_clear_programme(programme);
    for (size_t i = 0; i < chain->count; i++) {
        programme->lower[layout.radius + i] = search->problem.min_radius;
        programme->lower[layout.edge + i] = 0;
        programme->upper[layout.radius + i] = narc_radius_limit(&search->problem);
        programme->upper[layout.edge + i] = narc_edge_limit(&search->problem);
        programme->lower[layout.angle + i] = programme->upper[layout.angle + i] = 0;
    }
    programme->lower[layout.distance] = 0;
    programme->upper[layout.distance] = narc_is_distance(&search->problem) ? INFINITY : 0;
    if (narc_is_distance(&search->problem))
        programme->objective[layout.distance] = 1;
    else if (search->problem.goal == NARC_FIT_BOUND_PERIMETER)
        narc_derive_perimeter(chain, programme->objective);
    else
        narc_derive_area(chain, programme->objective);
}

/* The programme's row for a condition, which is linear as long as the normals stay. */
static void add_condition(narc_search *search, const narc_chain *chain, const narc_row *row) {
    const narc_layout layout = narc_make_layout(chain->count);
    double *entries = narc_add_row(&search->programme, 0, false);
    if (!entries)
        return;
    const double value = narc_evaluate_row(&search->problem, chain, row, entries);
    double linear = entries[layout.start] * chain->start.x + entries[layout.start + 1] * chain->start.y;
    for (size_t i = 0; i < chain->count; i++)
        linear += entries[layout.radius + i] * chain->radius[i] + entries[layout.edge + i] * chain->edge[i];
    search->programme.row_lower[search->programme.rows - 1] = linear - value;
}

static bool take_solution(const narc_search *search, const narc_chain *chain, narc_chain *out_form) {
    const narc_layout layout = narc_make_layout(chain->count);
    const double *x = search->programme.solution;
    *out_form = *chain;
    for (size_t i = 0; i < chain->count; i++) {
        out_form->radius[i] = fmax(search->problem.min_radius, x[layout.radius + i]);
        out_form->edge[i] = fmax(0, x[layout.edge + i]);
    }
    out_form->start = (narc_point){x[layout.start], x[layout.start + 1]};
    return narc_close_chain(out_form, search->problem.min_radius);
}

double narc_settle(narc_search *search, narc_chain *chain) {
    const narc_problem *problem = &search->problem;
    narc_difference_range range = {0, 0};
    if (narc_must_bound(problem) || narc_is_distance(problem))
        range = narc_find_range(search->intervals, narc_make_profile(chain, problem->hull, search->intervals));
    if (narc_must_bound(problem) && range.least < 0) {
        narc_offset_chain(chain, -range.least, problem->family == NARC_FIT_POLYGON);
        if (narc_is_distance(problem))
            range = narc_find_range(search->intervals, narc_make_profile(chain, problem->hull, search->intervals));
    }
    switch (problem->goal) {
    case NARC_FIT_BOUND_AREA:
        return narc_chain_area(chain);
    case NARC_FIT_BOUND_PERIMETER:
        return narc_chain_perimeter(chain);
    case NARC_FIT_DIFFERENCE: /* no shape at all may differ by less than any n-arc, but that is no fit */
        return narc_chain_area(chain) < LEAST_AREA * problem->hull->area
                   ? INFINITY
                   : narc_difference_area(chain, problem->hull, (narc_point){0, 0}, NULL);
    default:
        return fmax(-range.least, range.largest);
    }
}

/* One step from a chain: the programme, again with more rows where its solution goes too far for lack of them. */
static bool make_step(narc_search *search, const narc_chain *chain, narc_candidate *out_next) {
    set_columns(search, chain);
    double *x = narc_add_row(&search->programme, 0, true), *y = narc_add_row(&search->programme, 0, true);
    narc_derive_gap(chain, x, y);
    narc_list_rows(&search->problem, chain, ROWS_OF_A_PROGRAMME, search->intervals, search->rows);
    size_t built = 0;
    bool found = false;
    for (unsigned round = 0; round < ROUNDS && built < search->rows->count; round++) {
        for (; built < search->rows->count; built++)
            add_condition(search, chain, &search->rows->items[built]);
        narc_candidate next;
        if (!narc_solve_programme(&search->programme) || !take_solution(search, chain, &next.chain))
            return found;
        const size_t count = narc_make_profile(&next.chain, search->problem.hull, search->intervals);
        const double distance = search->programme.solution[narc_make_layout(chain->count).distance];
        narc_add_violated(&search->problem, search->intervals, count, distance + SLACK, search->rows);
        next.value = narc_settle(search, &next.chain);
        if (!found || next.value < out_next->value)
            *out_next = next;
        found = found || isfinite(next.value);
    }
    return found;
}

/* The first step is from a large circle, or polygon: every chain with these normals can be reached from there. */
bool narc_fit_normals(narc_search *search, const double *angles, narc_candidate *out_best) {
    narc_chain chain = {.count = search->problem.count};
    memcpy(chain.angle, angles, chain.count * sizeof *angles);
    narc_place_chain(&chain);
    narc_offset_chain(&chain, 1 + search->problem.hull->inflation + search->problem.min_radius,
                      search->problem.family == NARC_FIT_POLYGON);
    return make_step(search, &chain, out_best);
}

bool narc_improve(narc_search *search, const narc_chain *chain, narc_candidate *out_best) {
    narc_chain placed = *chain;
    narc_place_chain(&placed);
    return make_step(search, &placed, out_best);
}
