/* SPDX-License-Identifier: MIT
 *
 * rows.c - the directions in which a fit has least room.
 */
#include "rows.h"

#include "vector.h"

/* Of many directions the one with least room in each bin is listed, and all where the room is locally least. Some six
 * bins an arc are dense enough that what goes too far between two of them is caught by a few rows more. */
enum { FEW_INTERVALS = 400 };
static size_t count_bins(const problem *of) { return 32 + 2 * of->count; }

/* An interval wider than this (the cosine of its angle) with less room than this, in units of the hull's radius, is
 * listed at FAN + 1 directions: where a corner of the chain meets a corner of the hull, all are as near to touching. */
static const double FAN_COSINE = 0.995, FAN_ROOM = 0.05;
enum { FAN = 3 };

static void add(row_list *rows, row added) {
    if (rows->count < MAX_ROWS) {
        rows->items[rows->count++] = added;
    }
}

static void add_extreme(const problem *of, row_list *rows, const interval *in, bool upper) {
    add(rows, (row){.kind = upper ? ROW_UPPER : ROW_LOWER,
                    .direction = upper ? in->largest.direction : in->least.direction,
                    .corner = of->around->corners[in->corner]});
}

/* How much room an interval has; where the shape must stay within t of the hull, larger differences are less room. */
static double read_room(const interval *of, bool upper) {
    return upper ? -of->largest.difference : of->least.difference;
}

static bool is_extreme(const interval *all, size_t count, size_t k, bool upper) {
    const double here = read_room(&all[k], upper);
    return here <= read_room(&all[(k + count - 1) % count], upper) && here <= read_room(&all[(k + 1) % count], upper);
}

static void add_directions(const problem *of, const interval *all, size_t count, bool upper, row_list *rows) {
    /* Roundings make many local extremes of fine hulls: there the bins have to do. */
    const size_t bins = count_bins(of) * (count > FEW_INTERVALS ? 2 : 1);
    const bool few = count <= FEW_INTERVALS;
    size_t best = 0;
    for (size_t k = 0; k < count; k++) {
        best = read_room(&all[k], upper) < read_room(&all[best], upper) ? k : best;
        const bool ends_bin = k + 1 == count || k * bins / count != (k + 1) * bins / count;
        const bool local = is_extreme(all, count, k, upper);
        if (local && few) {
            add_extreme(of, rows, &all[k], upper);
        }
        if (ends_bin && !(local && few && best == k)) {
            add_extreme(of, rows, &all[best], upper);
        }
        best = ends_bin ? k + 1 : best;
    }
}

static void add_fans(const problem *of, const interval *all, size_t count, row_list *rows) {
    for (size_t k = 0; k < count; k++) {
        const narc_point from = all[k].from, to = all[k].to;
        if (all[k].least.difference >= FAN_ROOM || dot(from, to) >= FAN_COSINE) {
            continue;
        }
        for (unsigned f = 0; f <= FAN; f++) {
            const double t = (double)f / FAN;
            const narc_point between = along((narc_point){(1 - t) * from.x, (1 - t) * from.y}, t, to);
            const double size = length(between);
            add(rows, (row){.kind = ROW_LOWER,
                            .direction = {between.x / size, between.y / size},
                            .corner = of->around->corners[all[k].corner]});
        }
    }
}

/* The corner that an edge's line is to touch, and its neighbours: so a line may lie on either of its sides. */
static void add_kinks(const problem *of, const chain *at, size_t j, row_list *rows) {
    const hull *around = of->around;
    const size_t m = around->count, middle = narc_find_corner(around, at->angle[j]);
    const size_t corners[] = {(middle + m - 1) % m, middle, (middle + 1) % m};
    for (size_t k = 0; k < 3; k++) {
        add(rows, (row){.kind = ROW_KINK, .arc = j, .corner = around->corners[corners[k]]});
    }
}

void narc_list_rows(const problem *of, const chain *at, interval *intervals, row_list *out_rows) {
    const size_t count = narc_make_profile(at, of->around, 0, intervals);
    out_rows->count = 0;
    for (size_t j = 0; j < of->count && of->family != NARC_FIT_N_ARC; j++) {
        add_kinks(of, at, j, out_rows);
    }
    if (of->family != NARC_FIT_POLYGON) {
        add_directions(of, intervals, count, false, out_rows);
        add_fans(of, intervals, count, out_rows);
    }
    if (narc_is_distance(of)) {
        add_directions(of, intervals, count, true, out_rows);
    }
}

size_t narc_add_violated(const problem *of, const interval *intervals, size_t count, double slack, row_list *rows) {
    size_t added = 0;
    for (int upper = 0; upper < 2; upper++) {
        if (upper ? !narc_is_distance(of) : of->family == NARC_FIT_POLYGON) {
            continue;
        }
        for (size_t k = 0; k < count && added < 100; k++) {
            if (read_room(&intervals[k], upper) < -slack && is_extreme(intervals, count, k, upper)) {
                add_extreme(of, rows, &intervals[k], upper);
                added++;
            }
        }
    }
    return added;
}

/* The arc of the chain that holds a direction. */
static size_t find_arc(const chain *at, narc_point u) {
    double angle = atan2(u.y, u.x) - at->angle[0];
    angle -= 2 * PI * floor(angle / (2 * PI));
    size_t i = 0;
    while (i + 1 < at->count && at->angle[i + 1] - at->angle[0] <= angle) {
        i++;
    }
    return i;
}

double narc_evaluate_row(const problem *of, const chain *at, const row *which, double *derivatives) {
    const layout columns = narc_layout_of(at->count);
    const bool kink = which->kind == ROW_KINK;
    const size_t i = kink ? which->arc : find_arc(at, which->direction);
    const narc_point u = kink ? at->normal[i] : which->direction;
    const double sign = which->kind == ROW_UPPER ? -1 : 1;
    if (derivatives) {
        narc_derive_center(at, i, u, sign, derivatives);
        derivatives[columns.radius + i] += sign;
        derivatives[columns.angle + i] += kink ? dot(minus(at->center[i], which->corner), turned(u)) : 0;
        derivatives[columns.distance] += which->kind == ROW_UPPER || !narc_must_bound(of) ? 1 : 0;
    }
    return sign * (dot(minus(at->center[i], which->corner), u) + at->radius[i] - of->around->inflation);
}
