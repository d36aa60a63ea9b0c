/* SPDX-License-Identifier: MIT
 *
 * junctions.c - the n-arc through given junctions.
 *
 * An arc's normals at its ends lie half its central angle, alpha, to either side of its chord's normal. So at point
 * i, where arc i - 1 ends and arc i starts, alpha[i-1] + alpha[i] is the angle between the two chords: e[i]. Solved
 * from arc 0 on,
 *
 *     alpha[i] = s[i] + (-1)^i alpha[0],   s[0] = 0,   s[i] = e[i] - s[i-1],
 *
 * and at the last point alpha[n-1] + alpha[0] = e[0] gives alpha[0] for odd n; for even n alpha[0] drops out,
 * leaving a condition on the angles and one free parameter.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "error.h"
#include "outline.h"

/* How much an alpha may exceed pi / 2: a rounding of the sums above. */
#define RIGHT_ANGLE_SLACK 1e-12

/* How far the angle sums may be apart, per point. Spread over the points, the normals of neighbouring arcs then
 * differ by half of NARC_TOLERANCE at most, and as a chord is at most the shape's diameter, its ends move by half of
 * NARC_TOLERANCE times the size. */
#define SUM_TOLERANCE (NARC_TOLERANCE / 2)

typedef struct chord_ring {
    size_t count;
    narc_point point[NARC_MAX_ARCS];
    double chord[NARC_MAX_ARCS];     /* lengths */
    double direction[NARC_MAX_ARCS]; /* angles of the chords' outward normals */
    double offset[NARC_MAX_ARCS];    /* s */
    double low, high;                /* alpha[0] lies between, both excluded but for a right angle */
    double alpha;                    /* alpha[0]: the one solution, or the choice */
} chord_ring;

static double find_alpha(const chord_ring *c, size_t arc, double first) {
    return arc % 2 ? c->offset[arc] - first : c->offset[arc] + first;
}

static narc_status measure_chords(const narc_point *points, size_t count, chord_ring *out_chain, double *out_turns,
                                  narc_error *error) {
    out_chain->count = count;
    narc_status status = narc_check_points(points, count, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        narc_point from = points[i], to = points[(i + 1) % count];
        double x = to.x - from.x, y = to.y - from.y, length = narc_hypot(x, y);
        if (!(length > 0) || !isfinite(length))
            return narc_fail(error, NARC_ERROR_SIZE, i, length, "the chord from point %zu to the next: length is %g", i,
                             length);
        out_chain->point[i] = from;
        out_chain->chord[i] = length;
        out_chain->direction[i] = narc_atan2(-x, y);
    }
    for (size_t i = 0; i < count; i++)
        out_turns[i] = narc_wrap_angle(out_chain->direction[i] - out_chain->direction[(i + count - 1) % count]);
    return narc_check_turns(out_turns, count, error);
}

static narc_status solve_odd(chord_ring *c, const double *turns, narc_error *error) {
    c->low = c->high = c->alpha = (turns[0] - c->offset[c->count - 1]) / 2;
    for (size_t i = 0; i < c->count; i++) {
        double alpha = find_alpha(c, i, c->alpha);
        if (alpha < NARC_TOLERANCE / 2 || alpha > NARC_PI / 2 + RIGHT_ANGLE_SLACK)
            return narc_fail(error, NARC_ERROR_NO_SOLUTION, i, alpha,
                             "arc %zu: its half central angle would have to be %.9g rad, not above 0 and up to pi / 2",
                             i, alpha);
    }
    return NARC_OK;
}

/* The range of alpha[0] that keeps every alpha above 0 and at most pi / 2. */
static narc_status find_range(chord_ring *c, narc_error *error) {
    size_t low_arc = 0, high_arc = 0;
    c->low = 0;
    c->high = NARC_PI / 2;
    for (size_t i = 0; i < c->count; i++) {
        double s = c->offset[i], low = i % 2 ? s - NARC_PI / 2 : -s, high = i % 2 ? s : NARC_PI / 2 - s;
        if (low > c->low) {
            c->low = low;
            low_arc = i;
        }
        if (high < c->high) {
            c->high = high;
            high_arc = i;
        }
    }
    if (c->high - c->low < 2 * NARC_TOLERANCE)
        return narc_fail(error, NARC_ERROR_NO_SOLUTION, low_arc, c->low,
                         "arcs %zu and %zu cannot both have half central angles above 0 and up to pi / 2: arc 0 would "
                         "need more than %.9g and less than %.9g rad",
                         low_arc, high_arc, c->low, c->high);
    return NARC_OK;
}

/* The variance of the logarithms of the radii, chord / (2 sin alpha). */
static double find_variance(const chord_ring *c, double first) {
    double sum = 0, squares = 0, count = (double)c->count;
    for (size_t i = 0; i < c->count; i++) {
        double value = narc_log(c->chord[i] / c->chord[0] / narc_sin(find_alpha(c, i, first)));
        sum += value;
        squares += value * value;
    }
    return squares / count - sum / count * (sum / count);
}

/* Samples the range and refines the best sample by golden sections. */
static double choose_alpha(const chord_ring *c) {
    enum { SAMPLES = 32, SECTIONS = 50 }; /* 0.618^50 of two samples' distance: 1e-12 of the range */
    double step = (c->high - c->low) / (SAMPLES + 1), best = INFINITY, from = c->low, to = c->high;
    for (int k = 1; k <= SAMPLES; k++) {
        double variance = find_variance(c, c->low + k * step);
        if (variance < best) {
            best = variance;
            from = c->low + (k - 1) * step;
            to = c->low + (k + 1) * step;
        }
    }
    double golden = (sqrt(5.0) - 1) / 2, a = to - golden * (to - from), b = from + golden * (to - from);
    double at_a = find_variance(c, a), at_b = find_variance(c, b);
    for (int k = 0; k < SECTIONS; k++) {
        if (at_a < at_b) {
            to = b;
            b = a;
            at_b = at_a;
            a = to - golden * (to - from);
            at_a = find_variance(c, a);
        } else {
            from = a;
            a = b;
            at_a = at_b;
            b = from + golden * (to - from);
            at_b = find_variance(c, b);
        }
    }
    return (from + to) / 2;
}

static narc_status solve_even(chord_ring *c, double *turns, narc_error *error) {
    double apart = 0, odd_sum = 0;
    for (size_t i = 0; i < c->count; i++) {
        apart += i % 2 ? -turns[i] : turns[i];
        odd_sum += i % 2 ? turns[i] : 0;
    }
    double share = apart / (double)c->count;
    if (fabs(share) > SUM_TOLERANCE)
        return narc_fail(
            error, NARC_ERROR_NO_SOLUTION, 0, odd_sum + apart,
            "the exterior angles at the even points add up to %.9g rad and those at the odd points to %.9g, "
            "not to pi",
            odd_sum + apart, odd_sum);
    for (size_t i = 0; i < c->count; i++) {
        turns[i] -= i % 2 ? -share : share;
        c->offset[i] = i ? turns[i] - c->offset[i - 1] : 0;
    }
    narc_status status = find_range(c, error);
    if (status == NARC_OK)
        c->alpha = choose_alpha(c);
    return status;
}

static narc_status solve(const narc_point *points, size_t count, chord_ring *out_chain, narc_error *error) {
    double turns[NARC_MAX_ARCS];
    if (!points)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "points is NULL");
    if (count < 3 || count > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu points, not 3 to %d", count,
                         NARC_MAX_ARCS);
    narc_status status = measure_chords(points, count, out_chain, turns, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++)
        out_chain->offset[i] = i ? turns[i] - out_chain->offset[i - 1] : 0;
    return count % 2 ? solve_odd(out_chain, turns, error) : solve_even(out_chain, turns, error);
}

static double find_radius(const chord_ring *c, double alpha) { return c->chord[0] / (2 * narc_sin(alpha)); }

static void find_radii(const chord_ring *c, double *out_min, double *out_max, double *out_chosen) {
    *out_min = find_radius(c, c->high);
    *out_max = c->low > 0 ? find_radius(c, c->low) : INFINITY;
    *out_chosen = find_radius(c, c->alpha);
}

/* The first alpha that belongs to the caller's radius. */
static narc_status choose_radius(chord_ring *c, double radius, narc_error *error) {
    double least, most, chosen;
    find_radii(c, &least, &most, &chosen);
    if (c->count % 2) {
        if (fabs(radius - chosen) <= NARC_TOLERANCE * chosen)
            return NARC_OK;
        return narc_fail(error, NARC_ERROR_RADIUS, 0, radius,
                         "radius is %.9g, but an odd number of points has one solution, %.9g", radius, chosen);
    }
    c->alpha = narc_asin(fmin(1, c->chord[0] / (2 * radius)));
    if (radius < least * (1 - RIGHT_ANGLE_SLACK) || radius > most)
        return narc_fail(error, NARC_ERROR_RADIUS, 0, radius, "radius is %.9g, not between %.9g and %.9g", radius,
                         least, most);
    for (size_t i = 0; i < c->count; i++) {
        double alpha = find_alpha(c, i, c->alpha);
        if (alpha < NARC_TOLERANCE / 2 || alpha > NARC_PI / 2 + RIGHT_ANGLE_SLACK)
            return narc_fail(error, NARC_ERROR_RADIUS, i, radius,
                             "radius is %.9g, with which the half central angle of arc %zu is %.9g rad", radius, i,
                             alpha);
    }
    return NARC_OK;
}

/* Each arc gets the normals it shares with its neighbours (means, where a spread residual left two) and the radius and
 * place that put its ends on its points, so that what little the normals are off moves the ends by little. */
static void make_arcs(const chord_ring *c, narc_arc *out_arcs) {
    double normal[NARC_MAX_ARCS];
    for (size_t i = 0; i < c->count; i++) {
        size_t before = (i + c->count - 1) % c->count;
        double end = c->direction[before] + find_alpha(c, before, c->alpha);
        double start = c->direction[i] - find_alpha(c, i, c->alpha);
        normal[i] = narc_wrap_angle(start + narc_wrap_angle(end - start) / 2);
    }
    for (size_t i = 0; i < c->count; i++) {
        size_t next = (i + 1) % c->count;
        narc_point from = c->point[i], to = c->point[next], a, b;
        narc_arc *arc = &out_arcs[i];
        *arc = (narc_arc){.start = normal[i], .end = normal[next]};
        narc_find_normal(arc->start, &a.x, &a.y);
        narc_find_normal(arc->end, &b.x, &b.y);
        arc->radius = c->chord[i] / (2 * narc_sin(narc_find_sweep(arc) / 2));
        arc->center_x = (from.x + to.x) / 2 - arc->radius * (a.x + b.x) / 2;
        arc->center_y = (from.y + to.y) / 2 - arc->radius * (a.y + b.y) / 2;
    }
}

narc_status narc_build_points(const narc_point *points, size_t count, double radius, narc_arc *out_arcs,
                              size_t *out_count, narc_error *error) {
    chord_ring c;
    narc_arc arcs[NARC_MAX_ARCS];
    if (!out_arcs || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an output is NULL");
    if (!isfinite(radius))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, radius, "radius is %g", radius);
    if (radius < 0)
        return narc_fail(error, NARC_ERROR_RADIUS, 0, radius, "radius is %g, not 0 or more", radius);
    narc_status status = solve(points, count, &c, error);
    if (status == NARC_OK && radius != 0)
        status = choose_radius(&c, radius, error);
    if (status != NARC_OK)
        return status;
    make_arcs(&c, arcs);
    status = narc_validate_arcs(arcs, count, error);
    if (status != NARC_OK)
        return status;
    memcpy(out_arcs, arcs, count * sizeof *arcs);
    *out_count = count;
    return NARC_OK;
}

narc_status narc_find_radius_range(const narc_point *points, size_t count, double *out_min, double *out_max,
                                   double *out_chosen, narc_error *error) {
    chord_ring c;
    if (!out_min || !out_max || !out_chosen)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an output is NULL");
    narc_status status = solve(points, count, &c, error);
    if (status == NARC_OK)
        find_radii(&c, out_min, out_max, out_chosen);
    return status;
}
