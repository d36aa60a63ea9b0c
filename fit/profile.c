/* SPDX-License-Identifier: MIT
 *
 * profile.c - the difference of the support functions of a chain and a hull.
 */
#include "profile.h"

#include "vector.h"

size_t narc_count_intervals(size_t arcs, size_t corners) { return 2 * (arcs + corners) + 2; }

/* Does q point into the sector from u to v, which is less than a half turn wide? */
static bool is_between(narc_point q, narc_point u, narc_point v) {
    return cross(u, q) >= 0 && cross(q, v) >= 0 && dot(q, plus(u, v)) > 0;
}

static void include(interval *in, narc_point direction, double difference) {
    if (difference < in->least.difference) {
        in->least = (extreme){direction, difference};
    }
    if (difference > in->largest.difference) {
        in->largest = (extreme){direction, difference};
    }
}

static interval make_interval(const chain *of, const hull *around, size_t arc, size_t corner, narc_point from,
                              narc_point to) {
    const narc_point q = minus(around->corners[corner], of->center[arc]), away = {-q.x, -q.y};
    const double base = of->radius[arc] - around->inflation, distance = length(q);
    interval made = {.arc = arc, .corner = corner, .from = from, .to = to, .least = {from, base - dot(q, from)}};
    made.largest = made.least;
    include(&made, to, base - dot(q, to));
    if (distance > 0 && is_between(q, from, to)) {
        include(&made, (narc_point){q.x / distance, q.y / distance}, base - distance);
    }
    if (distance > 0 && is_between(away, from, to)) {
        include(&made, (narc_point){away.x / distance, away.y / distance}, base + distance);
    }
    return made;
}

/* Walks the directions from one angle to another, less than a half turn. */
static size_t walk_sector(const chain *of, const hull *around, size_t arc, double from, double to,
                          interval *out_intervals) {
    size_t count = 0, corner = narc_find_corner(around, from);
    narc_point at = unit_at(from);
    const narc_point end = unit_at(to);
    double left = to - from;
    /* How far it is from `from` to the normal at which the corner ends. */
    double next = around->angles[corner] - from;
    next -= 2 * PI * floor(next / (2 * PI));
    next = next > 2 * PI - 1e-9 ? 0 : next; /* a rounding below 0 */
    for (size_t steps = 0; steps <= around->count && next < left; steps++) {
        const narc_point until = around->normals[corner];
        out_intervals[count++] = make_interval(of, around, arc, corner, at, until);
        at = until;
        const size_t following = (corner + 1) % around->count;
        double turn = around->angles[following] - around->angles[corner];
        next += turn < 0 ? turn + 2 * PI : turn;
        corner = following;
    }
    out_intervals[count++] = make_interval(of, around, arc, corner, at, end);
    return count;
}

size_t narc_make_profile(const chain *of, const hull *around, double slop, interval *out_intervals) {
    size_t count = 0;
    for (size_t i = 0; i < of->count; i++) {
        const double from = of->angle[i] - slop, sweep = narc_end_angle(of, i) + slop - from;
        const unsigned parts = sweep > 1.5 * PI ? 4 : 2; /* a circle, or any other arc */
        for (unsigned k = 0; k < parts; k++) {
            count += walk_sector(of, around, i, from + sweep * k / parts, from + sweep * (k + 1) / parts,
                                 out_intervals + count);
        }
    }
    return count;
}

double narc_least_difference(const interval *intervals, size_t count) {
    double least = INFINITY;
    for (size_t k = 0; k < count; k++) {
        least = fmin(least, intervals[k].least.difference);
    }
    return least;
}

double narc_largest_difference(const interval *intervals, size_t count) {
    double largest = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        largest = fmax(largest, intervals[k].largest.difference);
    }
    return largest;
}
