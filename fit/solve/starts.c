/* SPDX-License-Identifier: MIT
 *
 * starts.c - normals to start from: on flush polygons, spread evenly, and spread by length and turning of the hull.
 *
 * An arc fits a corner or a side of the hull best if its sector is just the corner's or, flat, straddles the side's
 * normal. So half as many sides as there are arcs give pairs of normals, one on either side of each side's normal: the
 * flattest arcs that pass through both ends of a side, with corners between them, or wider sectors. Where straight
 * edges are allowed the sides' normals are those of edges. Smooth hulls want normals spread evenly in a
 * mixture of turning and length.
 */
#include "solve/starts.h"

#include <stdlib.h>
#include <string.h>

#include "outline/vector.h"
#include "solve/flush.h"

size_t narc_find_widest(const double *angles, size_t count, double *out_sweep) {
    size_t widest = 0;
    *out_sweep = 0;
    for (size_t k = 0; k < count; k++) {
        const double next = k + 1 < count ? angles[k + 1] : angles[0] + 2 * PI;
        if (next - angles[k] > *out_sweep) {
            *out_sweep = next - angles[k];
            widest = k;
        }
    }
    return widest;
}

/* Draws normals that are too near to each other towards an even spread. Others stay: those on the sides of a hull are the
 * best there are. */
static void spread_normals(double *angles, size_t count) {
    static const double EVEN = 0.02;
    double least = INFINITY;
    for (size_t k = 0; k + 1 < count; k++)
        least = fmin(least, angles[k + 1] - angles[k]);
    if (least < LEAST_SWEEP)
        for (size_t k = 0; k < count; k++)
            angles[k] += EVEN * (angles[0] + 2 * PI * (double)k / (double)count - angles[k]);
}

/* Sorts `count` normals, at least one, within a turn of each other; halves the widest sectors until there are `wanted`;
 * and adds the set unless a sector is too wide. */
static void add_set(narc_start_list *starts, const double *given, size_t count, size_t wanted) {
    if (starts->count == starts->room || count == 0 || count > wanted)
        return;
    double *angles = starts->angles[starts->count];
    memcpy(angles, given, count * sizeof *angles);
    qsort(angles, count, sizeof *angles, compare_numbers);
    double sweep;
    for (; count < wanted; count++) {
        const size_t k = narc_find_widest(angles, count, &sweep);
        memmove(angles + k + 2, angles + k + 1, (count - k - 1) * sizeof *angles);
        angles[k + 1] = angles[k] + sweep / 2;
    }
    spread_normals(angles, count);
    narc_find_widest(angles, count, &sweep);
    const double last = angles[0] + 2 * PI - angles[count - 1]; /* pairs may reach beyond a turn */
    starts->count += sweep <= starts->widest && (count == 1 || last >= LEAST_SWEEP);
}

static void add_even(narc_start_list *starts, size_t count, double phase) {
    double angles[MAX_CHAIN];
    for (size_t k = 0; k < count; k++)
        angles[k] = 2 * PI * ((double)k + phase) / (double)count;
    add_set(starts, angles, count, count);
}

/* The normals at which a measure of the hull's outline, from 0 to 1, reaches `targets`, which rise: `turning` parts of
 * its turning and the rest of its length, both as parts of the whole. */
static void add_measured(narc_start_list *starts, const narc_hull *hull, size_t count, double turning,
                         const double *targets) {
    double angles[MAX_CHAIN], measure = 0;
    size_t next = 0;
    for (size_t k = 0; k < hull->count && next < count; k++) {
        const narc_point corner = hull->corners[k], following = hull->corners[(k + 1) % hull->count];
        const double side = (1 - turning) * length(minus(following, corner)) / hull->perimeter;
        const double end = k + 1 < hull->count ? hull->angles[k + 1] : hull->angles[0] + 2 * PI;
        const double turn = turning * (end - hull->angles[k]) / (2 * PI);
        for (; next < count && targets[next] < measure + side; next++)
            angles[next] = hull->angles[k];
        measure += side;
        for (; next < count && targets[next] < measure + turn; next++)
            angles[next] = hull->angles[k] + (end - hull->angles[k]) * (targets[next] - measure) / turn;
        measure += turn;
    }
    add_set(starts, angles, next, count);
}

static void add_regular(narc_start_list *starts, const narc_hull *hull, size_t count, double turning, double phase) {
    double targets[MAX_CHAIN];
    for (size_t k = 0; k < count; k++)
        targets[k] = ((double)k + phase) / (double)count;
    add_measured(starts, hull, count, turning, targets);
}

double narc_next_random(uint64_t *state) {
    uint64_t x = *state += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return (double)((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

static void add_random(narc_start_list *starts, const narc_hull *hull, size_t count, uint64_t *state) {
    double targets[MAX_CHAIN];
    for (size_t k = 0; k < count; k++)
        targets[k] = narc_next_random(state);
    qsort(targets, count, sizeof *targets, compare_numbers);
    add_measured(starts, hull, count, 0.2 + 0.6 * narc_next_random(state), targets);
}

/* Where two sides of a bounding polygon with these normals meet. */
static narc_point meet_sides(const narc_hull *hull, double before, double after) {
    const narc_point p = unit_at(before), q = unit_at(after);
    const double at_p = dot(p, hull->corners[narc_find_corner(hull, before)]) + hull->inflation;
    const double at_q = dot(q, hull->corners[narc_find_corner(hull, after)]) + hull->inflation, turn = cross(p, q);
    return (narc_point){(at_p * q.y - at_q * p.y) / turn, (at_q * p.x - at_p * q.x) / turn};
}

/* Two normals at each side of a flush polygon, `apart` to either side of the side's own. */
static void add_pairs(narc_start_list *starts, const narc_hull *hull, size_t count, size_t sides, double apart) {
    double flush[MAX_CHAIN], angles[MAX_CHAIN];
    const size_t found = narc_find_flush_polygon(hull, sides, flush, &starts->no_memory);
    for (size_t k = 0; k < found; k++) {
        angles[2 * k] = flush[k] - apart;
        angles[2 * k + 1] = flush[k] + apart;
    }
    add_set(starts, angles, 2 * found, count);
}

/* A corner for each corner of a flush polygon, and for each side the flattest arc from one of its ends to the other:
 * half of its sector has the sine of half the side over the radius. Thin polygons leave no room for wider sectors, the
 * thinnest not even for these. */
static void add_chords(narc_start_list *starts, const narc_problem *problem, size_t sides) {
    double flush[MAX_CHAIN], angles[MAX_CHAIN];
    const size_t found = narc_find_flush_polygon(problem->hull, sides, flush, &starts->no_memory);
    narc_point corners[MAX_CHAIN]; /* corner k begins side k */
    for (size_t k = 0; k < found; k++)
        corners[k] = meet_sides(problem->hull, flush[(k + found - 1) % found], flush[k]);
    for (size_t k = 0; k < found; k++) {
        const double side = length(minus(corners[(k + 1) % found], corners[k]));
        const double half = narc_asin(fmin(1, 0.5 * side / problem->max_radius));
        angles[2 * k] = flush[k] - half;
        angles[2 * k + 1] = flush[k] + half;
    }
    for (size_t k = 0; k < found; k++) {
        const double turn = k + 1 < found ? 0 : 2 * PI;
        double *end = &angles[2 * k + 1], *next = &angles[2 * ((k + 1) % found)];
        const double middle = 0.5 * (*end + *next + turn);
        *end = fmin(*end, middle - 0.51 * LEAST_SWEEP);
        *next = fmax(*next, middle - turn + 0.51 * LEAST_SWEEP);
    }
    add_set(starts, angles, 2 * found, problem->count);
}

static void add_flush(narc_start_list *starts, const narc_hull *hull, size_t count, size_t sides) {
    double flush[MAX_CHAIN];
    const size_t found = narc_find_flush_polygon(hull, sides, flush, &starts->no_memory);
    add_set(starts, flush, found, count);
}

void narc_list_starts(const narc_problem *problem, uint64_t round, narc_start_list *out_starts) {
    const size_t n = problem->count;
    out_starts->count = 0;
    out_starts->widest = narc_widest_sweep(problem) + 1e-9;
    if (problem->family != NARC_FIT_N_ARC) {
        add_flush(out_starts, problem->hull, n, n);
        add_flush(out_starts, problem->hull, n, n - 1);
    }
    if (problem->family != NARC_FIT_POLYGON) {
        add_chords(out_starts, problem, n / 2);
        add_pairs(out_starts, problem->hull, n, n / 2, 0.12);
        add_pairs(out_starts, problem->hull, n, (n - 1) / 2, 0.03);
        add_pairs(out_starts, problem->hull, n, n / 3, 0.05);
    }
    for (unsigned k = 0; k < 4; k++) {
        const double phase = (double)k / 4;
        add_regular(out_starts, problem->hull, n, 0.5, phase);
        add_regular(out_starts, problem->hull, n, k % 2 ? 0.2 : 0.8, phase);
        add_even(out_starts, n, phase);
    }
    uint64_t state = 1 + round;
    for (size_t k = 0; k < out_starts->room && out_starts->count < out_starts->room; k++)
        add_random(out_starts, problem->hull, n, &state);
}
