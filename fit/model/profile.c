/* SPDX-License-Identifier: MIT
 *
 * profile.c - the difference of the support functions of a chain and a hull.
 */
#include "model/profile.h"

#include "outline/vector.h"

size_t narc_count_intervals(size_t arcs, size_t corners) { return 2 * (arcs + corners) + 2; }

/* Does q point into the sector from u to v, which is less than a half turn wide? */
static bool is_between(narc_point q, narc_point u, narc_point v) {
    return cross(u, q) >= 0 && cross(q, v) >= 0 && dot(q, plus(u, v)) > 0;
}

static void include(narc_interval *interval, narc_point direction, double difference) {
    if (difference < interval->least.difference)
        interval->least = (narc_extreme){direction, difference};
    if (difference > interval->largest.difference)
        interval->largest = (narc_extreme){direction, difference};
}

static narc_interval make_interval(const narc_chain *chain, const narc_hull *hull, size_t arc, size_t corner,
                                   narc_point start, narc_point end) {
    const narc_point q = minus(hull->corners[corner], chain->center[arc]), away = {-q.x, -q.y};
    const double base = chain->radius[arc] - hull->inflation;
    narc_interval interval = {
        .arc = arc, .corner = corner, .start = start, .end = end, .least = {start, base - dot(q, start)}};
    interval.largest = interval.least;
    include(&interval, end, base - dot(q, end));
    if (is_between(q, start, end)) {
        const double distance = length(q);
        include(&interval, (narc_point){q.x / distance, q.y / distance}, base - distance);
    } else if (is_between(away, start, end)) {
        const double distance = length(q);
        include(&interval, (narc_point){away.x / distance, away.y / distance}, base + distance);
    }
    return interval;
}

/* Walks the directions from one angle to another, less than a half turn. */
static size_t walk_sector(const narc_chain *chain, const narc_hull *hull, size_t arc, double start_angle,
                          double end_angle, narc_point start, narc_point end, narc_interval *out_intervals) {
    size_t count = 0, corner = narc_find_corner(hull, start_angle);
    double left = end_angle - start_angle;
    /* How far it is from the start to the normal at which the corner ends. */
    double next = hull->angles[corner] - start_angle;
    next -= 2 * PI * floor(next / (2 * PI));
    next = next > 2 * PI - 1e-9 ? 0 : next; /* a rounding below 0 */
    for (size_t steps = 0; steps <= hull->count && next < left; steps++) {
        const narc_point until = hull->normals[corner];
        out_intervals[count++] = make_interval(chain, hull, arc, corner, start, until);
        start = until;
        const size_t following = (corner + 1) % hull->count;
        double turn = hull->angles[following] - hull->angles[corner];
        next += turn < 0 ? turn + 2 * PI : turn;
        corner = following;
    }
    out_intervals[count++] = make_interval(chain, hull, arc, corner, start, end);
    return count;
}

size_t narc_make_profile(const narc_chain *chain, const narc_hull *hull, narc_interval *out_intervals) {
    size_t count = 0;
    for (size_t i = 0; i < chain->count; i++) {
        const double start = chain->angle[i], sweep = narc_end_angle(chain, i) - start;
        const unsigned parts = sweep > 1.5 * PI ? 4 : 2; /* a circle, or any other arc */
        narc_point from = chain->normal[i];
        for (unsigned k = 0; k < parts; k++) {
            const double end = start + sweep * (k + 1) / parts;
            const narc_point to = unit_at(end);
            count += walk_sector(chain, hull, i, start + sweep * k / parts, end, from, to, out_intervals + count);
            from = to;
        }
    }
    return count;
}

narc_difference_range narc_find_range(const narc_interval *intervals, size_t count) {
    narc_difference_range range = {INFINITY, -INFINITY};
    for (size_t k = 0; k < count; k++) {
        range.least = fmin(range.least, intervals[k].least.difference);
        range.largest = fmax(range.largest, intervals[k].largest.difference);
    }
    return range;
}
