/* SPDX-License-Identifier: MIT
 *
 * search.c - the best chain with given normals, by linear programmes.
 *
 * With the normals fixed, closure, perimeter and support function are linear in radii, lengths and position. The square
 * root of the area is concave in them (Brunn and Minkowski): a linear programme that takes the area's derivatives never
 * makes it larger, and the least area is at a corner of the feasible set, where linear programmes end.
 */
#include "search.h"

#include <stdlib.h>
#include <string.h>

#include "difference.h"
#include "error.h"
#include "vector.h"

/* A solution that goes too far by more than the slack, in units of the hull's radius, gets more rows, so many times. */
static const double SLACK = 1e-7;
enum { ROUNDS = 5 };

/* A shape with less than this part of the hull's area fits nothing. */
static const double LEAST_AREA = 0.25;

narc_status narc_open_search(search *made, const problem *of, narc_error *error) {
    *made = (search){.of = *of};
    made->intervals = malloc(narc_count_intervals(of->count, of->around->count) * sizeof *made->intervals);
    made->rows = malloc(sizeof *made->rows);
    if (!made->intervals || !made->rows ||
        !narc_open_programme(&made->lp, narc_layout_of(of->count).count, 2 + of->count + MAX_ROWS)) {
        narc_close_search(made);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory to fit %zu arcs to %zu corners", of->count,
                         of->around->count);
    }
    return NARC_OK;
}

void narc_close_search(search *made) {
    free(made->intervals);
    free(made->rows);
    narc_close_programme(&made->lp);
    *made = (search){0};
}

static void set_columns(search *with, const chain *at) {
    const layout columns = narc_layout_of(at->count);
    programme *lp = &with->lp;
    narc_clear_programme(lp);
    for (size_t i = 0; i < at->count; i++) {
        lp->lower[columns.radius + i] = lp->lower[columns.edge + i] = 0;
        lp->upper[columns.radius + i] = narc_radius_limit(&with->of);
        lp->upper[columns.edge + i] = narc_edge_limit(&with->of);
        lp->lower[columns.angle + i] = lp->upper[columns.angle + i] = 0;
    }
    lp->lower[columns.distance] = 0;
    lp->upper[columns.distance] = narc_is_distance(&with->of) ? INFINITY : 0;
    if (narc_is_distance(&with->of)) {
        lp->objective[columns.distance] = 1;
    } else if (with->of.goal == NARC_FIT_BOUND_PERIMETER) {
        narc_derive_perimeter(at, lp->objective);
    } else {
        narc_derive_area(at, lp->objective);
    }
}

/* The programme's row for a condition, which is linear as long as the normals stay. */
static void add_condition(search *with, const chain *at, const row *which) {
    const layout columns = narc_layout_of(at->count);
    double *entries = narc_add_row(&with->lp, 0, INFINITY);
    if (!entries) {
        return;
    }
    const double value = narc_evaluate_row(&with->of, at, which, entries);
    double linear = entries[columns.start] * at->start.x + entries[columns.start + 1] * at->start.y;
    for (size_t i = 0; i < at->count; i++) {
        linear += entries[columns.radius + i] * at->radius[i] + entries[columns.edge + i] * at->edge[i];
    }
    with->lp.row_lower[with->lp.rows - 1] = linear - value;
}

static bool take_solution(const search *with, const chain *from, chain *out_form) {
    const layout columns = narc_layout_of(from->count);
    const double *x = with->lp.solution;
    *out_form = *from;
    for (size_t i = 0; i < from->count; i++) {
        out_form->radius[i] = fmax(0, x[columns.radius + i]);
        out_form->edge[i] = fmax(0, x[columns.edge + i]);
    }
    out_form->start = (narc_point){x[columns.start], x[columns.start + 1]};
    return narc_close_chain(out_form);
}

double narc_settle(search *with, chain *form) {
    size_t count = narc_make_profile(form, with->of.around, 0, with->intervals);
    const double least = narc_least_difference(with->intervals, count);
    if (narc_must_bound(&with->of) && least < 0) {
        narc_offset_chain(form, -least, with->of.family == NARC_FIT_POLYGON);
        count = narc_make_profile(form, with->of.around, 0, with->intervals);
    }
    switch (with->of.goal) {
    case NARC_FIT_BOUND_AREA:
        return narc_chain_area(form);
    case NARC_FIT_BOUND_PERIMETER:
        return narc_chain_perimeter(form);
    case NARC_FIT_DIFFERENCE: /* no shape at all may differ by less than any n-arc, but that is no fit */
        return narc_chain_area(form) < LEAST_AREA * with->of.around->area
                   ? INFINITY
                   : narc_difference_area(form, with->of.around, (narc_point){0, 0}, NULL);
    default:
        return fmax(-narc_least_difference(with->intervals, count), narc_largest_difference(with->intervals, count));
    }
}

/* One step from a chain: the programme, again with more rows where its solution goes too far for lack of them. */
static bool make_step(search *with, const chain *from, candidate *out_next) {
    set_columns(with, from);
    double *x = narc_add_row(&with->lp, 0, 0), *y = narc_add_row(&with->lp, 0, 0);
    narc_derive_gap(from, x, y);
    narc_list_rows(&with->of, from, with->intervals, with->rows);
    size_t built = 0;
    bool found = false;
    for (unsigned round = 0; round < ROUNDS && built < with->rows->count; round++) {
        for (; built < with->rows->count; built++) {
            add_condition(with, from, &with->rows->items[built]);
        }
        candidate next;
        if (!narc_solve_programme(&with->lp) || !take_solution(with, from, &next.form)) {
            return found;
        }
        const size_t count = narc_make_profile(&next.form, with->of.around, 0, with->intervals);
        const double distance = with->lp.solution[narc_layout_of(from->count).distance];
        narc_add_violated(&with->of, with->intervals, count, distance + SLACK, with->rows);
        next.value = narc_settle(with, &next.form);
        if (!found || next.value < out_next->value) {
            *out_next = next;
        }
        found = found || isfinite(next.value);
    }
    return found;
}

/* The first step is from a large circle, or polygon: every chain with these normals can be reached from there. */
bool narc_fit_normals(search *with, const double *angles, candidate *out_best) {
    chain form = {.count = with->of.count};
    memcpy(form.angle, angles, form.count * sizeof *angles);
    narc_place_chain(&form);
    narc_offset_chain(&form, 1 + with->of.around->inflation, with->of.family == NARC_FIT_POLYGON);
    return make_step(with, &form, out_best);
}
