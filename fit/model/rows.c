/* SPDX-License-Identifier: MIT
 *
 * rows.c - the directions in which a fit has least room.
 */
#include "model/rows.h"

#include "outline/vector.h"

/* Of many directions the one with least room in each bin is listed, and all where the room is locally least. For a
 * programme some six bins an arc are dense enough that what goes too far between two of them is caught by a few rows
 * more. */
enum { FEW_INTERVALS = 400 };
static size_t count_bins(const narc_problem *problem, narc_row_density density) {
    return density == ROWS_OF_A_PROGRAMME ? 32 + 2 * problem->count : 8 + problem->count;
}

/* An interval wider than this (the cosine of its angle) with less room than this, in units of the hull's radius, is
 * listed at both ends, and in a programme at FAN + 1 directions: where a corner of the chain meets a corner of the
 * hull, all of its directions are equally near to touching. */
static const double FAN_COSINE = 0.995, FAN_ROOM = 0.05;
enum { FAN = 3 };

static void add(narc_row_list *rows, narc_row added) {
    if (rows->count < MAX_ROWS)
        rows->items[rows->count++] = added;
}

static void add_extreme(const narc_problem *problem, narc_row_list *rows, const narc_interval *interval, bool upper) {
    add(rows, (narc_row){.kind = upper ? ROW_UPPER : ROW_LOWER,
                         .direction = upper ? interval->largest.direction : interval->least.direction,
                         .corner = problem->hull->corners[interval->corner]});
}

/* How much room an interval has; where the shape must stay within t of the hull, larger differences are less room. */
static double read_room(const narc_interval *interval, bool upper) {
    return upper ? -interval->largest.difference : interval->least.difference;
}

static bool is_extreme(const narc_interval *all, size_t count, size_t k, bool upper) {
    const double here = read_room(&all[k], upper);
    return here <= read_room(&all[(k + count - 1) % count], upper) && here <= read_room(&all[(k + 1) % count], upper);
}

static void add_directions(const narc_problem *problem, narc_row_density density, const narc_interval *all,
                           size_t count, bool upper, narc_row_list *rows) {
    /* Roundings make many local extremes of fine hulls: there the bins have to do. */
    const size_t bins = count_bins(problem, density) * (count > FEW_INTERVALS ? 2 : 1);
    const bool few = count <= FEW_INTERVALS;
    size_t best = 0;
    for (size_t k = 0; k < count; k++) {
        best = read_room(&all[k], upper) < read_room(&all[best], upper) ? k : best;
        const bool ends_bin = k + 1 == count || k * bins / count != (k + 1) * bins / count;
        const bool local = is_extreme(all, count, k, upper);
        if (local && few)
            add_extreme(problem, rows, &all[k], upper);
        if (ends_bin && !(local && few && best == k))
            add_extreme(problem, rows, &all[best], upper);
        best = ends_bin ? k + 1 : best;
    }
}

static void add_fans(const narc_problem *problem, narc_row_density density, const narc_interval *all, size_t count,
                     narc_row_list *rows) {
    const unsigned steps = density == ROWS_OF_A_PROGRAMME ? FAN : 1;
    for (size_t k = 0; k < count; k++) {
        const narc_point start = all[k].start, end = all[k].end;
        if (all[k].least.difference >= FAN_ROOM || dot(start, end) >= FAN_COSINE)
            continue;
        for (unsigned f = 0; f <= steps; f++) {
            const double t = (double)f / steps;
            const narc_point direction = along((narc_point){(1 - t) * start.x, (1 - t) * start.y}, t, end);
            const double size = length(direction);
            add(rows, (narc_row){.kind = ROW_LOWER,
                                 .direction = {direction.x / size, direction.y / size},
                                 .corner = problem->hull->corners[all[k].corner]});
        }
    }
}

/* The corner that an edge's line is to touch, and its neighbours: so a line may lie on either of its sides. */
static void add_kinks(const narc_problem *problem, const narc_chain *chain, size_t j, narc_row_list *rows) {
    const narc_hull *hull = problem->hull;
    const size_t m = hull->count, middle = narc_find_corner(hull, chain->angle[j]);
    const size_t corners[] = {(middle + m - 1) % m, middle, (middle + 1) % m};
    for (size_t k = 0; k < 3; k++)
        add(rows, (narc_row){.kind = ROW_KINK, .arc = j, .corner = hull->corners[corners[k]]});
}

void narc_list_rows(const narc_problem *problem, const narc_chain *chain, narc_row_density density,
                    narc_interval *intervals, narc_row_list *out_rows) {
    const size_t count = narc_make_profile(chain, problem->hull, intervals);
    out_rows->count = 0;
    for (size_t j = 0; j < problem->count && problem->family != NARC_FIT_N_ARC; j++)
        add_kinks(problem, chain, j, out_rows);
    if (problem->family != NARC_FIT_POLYGON) {
        add_directions(problem, density, intervals, count, false, out_rows);
        add_fans(problem, density, intervals, count, out_rows);
    }
    if (narc_is_distance(problem))
        add_directions(problem, density, intervals, count, true, out_rows);
}

size_t narc_add_violated(const narc_problem *problem, const narc_interval *intervals, size_t count, double slack,
                         narc_row_list *rows) {
    size_t added = 0;
    for (int upper = 0; upper < 2; upper++) {
        if (upper ? !narc_is_distance(problem) : problem->family == NARC_FIT_POLYGON)
            continue;
        for (size_t k = 0; k < count && added < 100; k++) {
            if (read_room(&intervals[k], upper) < -slack && is_extreme(intervals, count, k, upper)) {
                add_extreme(problem, rows, &intervals[k], upper);
                added++;
            }
        }
    }
    return added;
}

/* The arc of the chain that holds a direction. */
static size_t find_arc(const narc_chain *chain, narc_point u) {
    double angle = narc_atan2(u.y, u.x) - chain->angle[0];
    angle -= 2 * PI * floor(angle / (2 * PI));
    size_t i = 0;
    while (i + 1 < chain->count && chain->angle[i + 1] - chain->angle[0] <= angle)
        i++;
    return i;
}

double narc_evaluate_row(const narc_problem *problem, const narc_chain *chain, const narc_row *row,
                         double *derivatives) {
    const narc_layout layout = narc_make_layout(chain->count);
    const bool kink = row->kind == ROW_KINK;
    const size_t i = kink ? row->arc : find_arc(chain, row->direction);
    const narc_point u = kink ? chain->normal[i] : row->direction;
    const double sign = row->kind == ROW_UPPER ? -1 : 1;
    if (derivatives) {
        narc_derive_center(chain, i, u, sign, derivatives);
        derivatives[layout.radius + i] += sign;
        derivatives[layout.angle + i] += kink ? dot(minus(chain->center[i], row->corner), turned(u)) : 0;
        derivatives[layout.distance] += row->kind == ROW_UPPER || !narc_must_bound(problem) ? 1 : 0;
    }
    return sign * (dot(minus(chain->center[i], row->corner), u) + chain->radius[i] - problem->hull->inflation);
}
