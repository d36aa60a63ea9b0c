/* SPDX-License-Identifier: MIT
 *
 * finish.c - rounds a fit to what the store keeps of it, and makes sure of it there.
 */
#include "finish.h"

#include <stdlib.h>
#include <string.h>

#include "difference.h"
#include "error.h"
#include "profile.h"
#include "vector.h"

/* Radii and edges below this, in units of the hull's radius, are taken for 0, and centres this close for one: the steps
 * of the search end there, and single precision is coarser. */
static const double NOTHING = 2e-7;

/* Normals of stored arcs are single-precision unit vectors, off by up to 2^-23 radians or so: sectors are checked with
 * this much more at both ends. */
static const double NORMAL_SLOP = 1.0 / (1 << 21);

/* An edge shorter than this part of the radius is not counted as one. */
static const double SHORT_EDGE = 1e-5;

/* What is bounded has this much room, in parts of the perimeter, for the roundings of checks in double precision. */
static const double DOUBLE_ROOM = 1e-14;

enum { CERTIFY_ROUNDS = 40, SAMPLES = 1000 };

/* ---------------------------------------------------------------------------- from a chain to arcs */

static bool is_one_arc(const narc_arc *a, const narc_arc *b) {
    return hypot(a->center_x - b->center_x, a->center_y - b->center_y) < NOTHING &&
           fabs(a->radius - b->radius) < NOTHING;
}

/* Neighbours that lie on one circle become one arc, as far as arcs may turn. */
static size_t merge_arcs(narc_arc *arcs, size_t count) {
    size_t kept = 1;
    for (size_t i = 1; i < count; i++) {
        narc_arc *last = &arcs[kept - 1];
        if (is_one_arc(last, &arcs[i]) && arcs[i].end - last->start <= PI) {
            last->end = arcs[i].end;
        } else {
            arcs[kept++] = arcs[i];
        }
    }
    const bool wraps = kept > 1 && is_one_arc(&arcs[kept - 1], &arcs[0]);
    if (wraps && arcs[0].end + 2 * PI - arcs[kept - 1].start <= PI) {
        arcs[0].start = arcs[kept - 1].start - 2 * PI;
        kept--;
    }
    return kept;
}

static size_t list_arcs(const chain *of, narc_arc *out_arcs) {
    chain clean = *of;
    for (size_t i = 0; i < clean.count; i++) {
        clean.radius[i] = clean.radius[i] < NOTHING ? 0 : clean.radius[i];
        clean.edge[i] = clean.edge[i] < NOTHING ? 0 : clean.edge[i];
    }
    if (!narc_close_chain(&clean)) {
        clean = *of;
    }
    bool circle = true;
    for (size_t i = 0; i < clean.count; i++) {
        out_arcs[i] = (narc_arc){clean.center[i].x, clean.center[i].y, clean.radius[i], clean.angle[i],
                                 narc_end_angle(&clean, i)};
        circle = circle && is_one_arc(&out_arcs[0], &out_arcs[i]);
    }
    if (circle && clean.radius[0] > 0) {
        out_arcs[0].end = out_arcs[0].start + 2 * PI;
        return 1;
    }
    return merge_arcs(out_arcs, clean.count);
}

/* ---------------------------------------------------------------------------- single precision */

/* GCC 12 drops the rounding of a pair of neighbours when it makes vector code of it; not through a volatile. */
static double to_single(double x) {
    volatile float rounded = (float)x;
    return rounded;
}

static void round_arcs(const narc_arc *from, size_t count, double factor, narc_arc *out_arcs) {
    for (size_t i = 0; i < count; i++) {
        out_arcs[i] = from[i];
        out_arcs[i].center_x = to_single(factor * from[i].center_x);
        out_arcs[i].center_y = to_single(factor * from[i].center_y);
        out_arcs[i].radius = to_single(factor * from[i].radius);
    }
}

/* A list of arcs as a chain whose centres are what they are. */
static void chain_arcs(const narc_arc *arcs, size_t count, chain *out_chain) {
    *out_chain = (chain){.count = count, .start = {arcs[0].center_x, arcs[0].center_y}};
    double last = arcs[0].start;
    for (size_t i = 0; i < count; i++) {
        double angle = arcs[i].start;
        angle += 2 * PI * ceil((last - angle) / (2 * PI) - 0.25);
        out_chain->angle[i] = last = angle;
        out_chain->normal[i] = unit_at(angle);
        out_chain->radius[i] = arcs[i].radius;
        out_chain->center[i] = (narc_point){arcs[i].center_x, arcs[i].center_y};
    }
    out_chain->normal[count] = out_chain->normal[0];
    out_chain->center[count] = out_chain->center[0];
    for (size_t i = 0; i < count; i++) {
        const narc_point step = minus(out_chain->center[i], out_chain->center[(i + count - 1) % count]);
        out_chain->edge[i] = fmax(0, dot(step, turned(out_chain->normal[i])));
    }
}

/* What the store makes of a list of arcs. */
static narc_status store_arcs(const narc_arc *arcs, size_t count, chain *out_chain, narc_error *error) {
    narc_shapes *shapes = NULL;
    narc_status status = narc_create_shapes(NULL, &shapes);
    if (status != NARC_OK) {
        return narc_fail(error, status, 0, 0, "not enough memory for a shape");
    }
    status = narc_add_shape(shapes, arcs, count, NULL, error);
    if (status == NARC_OK) {
        narc_arc stored[NARC_MAX_ARCS];
        chain_arcs(stored, narc_get_arcs(shapes, 0, stored), out_chain);
    }
    narc_destroy_shapes(shapes);
    return status;
}

static bool find_range(const chain *of, const hull *around, double slop, double *out_least, double *out_largest) {
    interval *intervals = malloc(narc_count_intervals(of->count, around->count) * sizeof *intervals);
    if (intervals) {
        const size_t count = narc_make_profile(of, around, slop, intervals);
        *out_least = narc_least_difference(intervals, count);
        *out_largest = narc_largest_difference(intervals, count);
    }
    free(intervals);
    return intervals;
}

/* Rounds the arcs, larger by as little as makes them bound the hull as the store keeps them. */
static narc_status round_and_certify(narc_arc *arcs, size_t count, const hull *around, bool bound,
                                     double *out_clearance, double *out_factor, narc_error *error) {
    double factor = 1, inner = 0;
    for (unsigned round = 0; round < CERTIFY_ROUNDS; round++) {
        narc_arc rounded[NARC_MAX_ARCS];
        chain stored;
        round_arcs(arcs, count, factor, rounded);
        const narc_status status = store_arcs(rounded, count, &stored, error);
        if (status != NARC_OK) {
            return status;
        }
        double least, largest;
        if (!find_range(&stored, around, NORMAL_SLOP, &least, &largest)) {
            return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners",
                             around->count);
        }
        if (!bound || least > DOUBLE_ROOM * around->perimeter) {
            *out_clearance = least;
            *out_factor = factor;
            memcpy(arcs, rounded, count * sizeof *arcs);
            return NARC_OK;
        }
        if (round == 0) {
            narc_compute_distance(rounded, count, (narc_point){0, 0}, &inner);
        }
        /* The origin is inside by -inner: scaling moves the outline out by that times the factor's growth, or more. */
        factor *= 1 + (round + 1) * (fmin(least, 0) / fmin(inner, -1e-300) + 1e-9);
    }
    return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, 0, "the outline is too thin for single precision");
}

/* ---------------------------------------------------------------------------- measures */

static double distance_to_side(const hull *around, size_t k, narc_point x) {
    const narc_point p = around->corners[k], e = minus(around->corners[(k + 1) % around->count], p);
    const double part = dot(minus(x, p), e) / dot(e, e);
    return length(minus(x, along(p, fmin(fmax(part, 0), 1), e)));
}

static double distance_to_outline(const hull *around, narc_point x) {
    double least = INFINITY;
    for (size_t k = 0; k < around->count; k++) {
        least = fmin(least, distance_to_side(around, k, x));
    }
    return least;
}

/* The mean over the shape's outline, by the midpoint rule on pieces of like lengths. */
static double mean_distance(const chain *of, const hull *around) {
    const double perimeter = narc_chain_perimeter(of);
    double sum = 0;
    for (size_t i = 0; i < of->count; i++) {
        const narc_point a = of->center[i], d = of->normal[i];
        const double sweep = narc_end_angle(of, i) - of->angle[i], r = of->radius[i];
        const unsigned arc_pieces = (unsigned)ceil(SAMPLES * r * sweep / perimeter);
        for (unsigned k = 0; k < arc_pieces; k++) {
            const narc_point x = along(a, r, unit_at(of->angle[i] + sweep * (k + 0.5) / arc_pieces));
            sum += r * sweep / arc_pieces * distance_to_outline(around, x);
        }
        const unsigned edge_pieces = (unsigned)ceil(SAMPLES * of->edge[i] / perimeter);
        for (unsigned k = 0; k < edge_pieces; k++) {
            const narc_point end = along(a, r, d);
            const narc_point x = along(end, -of->edge[i] * (k + 0.5) / edge_pieces, turned(d));
            sum += of->edge[i] / edge_pieces * distance_to_outline(around, x);
        }
    }
    return sum / perimeter;
}

/* The area of the symmetric difference is that of the shape before it was rounded: rounding leaves gaps between arcs,
 * and edges that are not quite square to their normals, which matter more than the difference does where edges lie on
 * sides of the hull. */
static double measure_difference(const narc_arc *arcs, size_t count, double factor, const hull *around) {
    narc_arc scaled[NARC_MAX_ARCS] = {0};
    for (size_t i = 0; i < count; i++) {
        scaled[i] = (narc_arc){factor * arcs[i].center_x, factor * arcs[i].center_y, factor * arcs[i].radius,
                               arcs[i].start, arcs[i].end};
    }
    chain form;
    chain_arcs(scaled, count, &form);
    const double area = narc_difference_area(&form, around, (narc_point){0, 0}, NULL);
    return isfinite(area) ? area : narc_chain_area(&form) + around->area; /* the shape's centroid is outside the hull */
}

static bool measure(const hull *around, narc_fit_result *of) {
    chain form;
    chain_arcs(of->arcs, of->arc_count, &form);
    hull bare = *around;
    bare.inflation = 0;
    double least, largest;
    if (!find_range(&form, &bare, 0, &least, &largest)) {
        return false;
    }
    narc_mass mass;
    narc_compute_mass(of->arcs, of->arc_count, &mass);
    narc_compute_perimeter(of->arcs, of->arc_count, &of->perimeter);
    of->area = mass.area;
    of->hull_area = around->area;
    of->hull_perimeter = around->perimeter;
    of->max_distance = fmax(-least, largest);
    of->mean_distance = mean_distance(&form, around);
    of->edge_count = 0;
    for (size_t i = 0; i < form.count; i++) {
        of->edge_count += form.edge[i] > SHORT_EDGE * around->perimeter;
    }
    return true;
}

/* ---------------------------------------------------------------------------- all of it */

/* A point of the scaled hull's plane as seen from `origin` there, in the outline's units and directions. */
static narc_point place_point(const scale *at, narc_point origin, narc_point p) {
    const narc_point from = minus(p, origin);
    const narc_point x = unit_at(at->angle), y = turned(x);
    return (narc_point){at->radius * (from.x * x.x + from.y * y.x), at->radius * (from.x * x.y + from.y * y.y)};
}

/* The hull in the outline's units, seen from the shape's origin. */
static narc_status place_hull(const hull *around, const scale *at, narc_point origin, narc_point rounding, hull *out,
                              narc_error *error) {
    narc_point *corners = malloc(around->count * sizeof *corners);
    if (!corners) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", around->count);
    }
    for (size_t k = 0; k < around->count; k++) {
        corners[k] = plus(place_point(at, origin, around->corners[k]), rounding);
    }
    const narc_status status = narc_adopt_corners(corners, around->count, out, error);
    if (status == NARC_OK) {
        out->inflation = at->radius * around->inflation;
    }
    free(corners);
    return status;
}

narc_status narc_finish_arcs(const narc_arc *arcs, size_t count, const hull *around, const scale *at, bool bound,
                             narc_fit_result *out_result, narc_error *error) {
    narc_fit_result made = {.arc_count = count};
    narc_mass mass;
    narc_compute_mass(arcs, count, &mass);
    const narc_point origin = {mass.centroid_x, mass.centroid_y};
    for (size_t i = 0; i < count; i++) {
        const narc_point center = place_point(at, origin, (narc_point){arcs[i].center_x, arcs[i].center_y});
        made.arcs[i] = (narc_arc){center.x, center.y, at->radius * arcs[i].radius, arcs[i].start + at->angle,
                                  arcs[i].end + at->angle};
    }
    const narc_point step = place_point(at, (narc_point){0, 0}, origin);
    made.origin = plus(at->middle, step);
    /* The origin is rounded, a lot where the outline is far away: the hull is placed as it is seen from there. */
    const narc_point rounding = minus(step, minus(made.origin, at->middle));
    hull placed;
    narc_status status = place_hull(around, at, origin, rounding, &placed, error);
    if (status != NARC_OK) {
        return status;
    }
    narc_arc exact[NARC_MAX_ARCS];
    double factor = 1;
    memcpy(exact, made.arcs, count * sizeof *exact);
    status = round_and_certify(made.arcs, count, &placed, bound, &made.clearance, &factor, error);
    if (status == NARC_OK && !measure(&placed, &made)) {
        status =
            narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", around->count);
    }
    made.difference_area = measure_difference(exact, count, factor, &placed);
    narc_release_hull(&placed);
    if (status == NARC_OK) {
        *out_result = made;
    }
    return status;
}

narc_status narc_finish_fit(const chain *of, const hull *around, const scale *at, bool bound,
                            narc_fit_result *out_result, narc_error *error) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = list_arcs(of, arcs);
    return narc_finish_arcs(arcs, count, around, at, bound, out_result, error);
}
