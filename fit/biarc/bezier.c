/* SPDX-License-Identifier: MIT
 *
 * bezier.c - Bezier curves to arcs: checks, the frame in which the curve is about 1 large, and the output.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "biarc/biarc.h"
#include "error.h"
#include "outline/path.h"

/* Least tolerance, relative to the extent. */
static const double LEAST_TOLERANCE = 1e-9;

/* Points in the frame are (p - middle) / 2^exponent. */
struct frame {
    narc_point middle;
    int exponent;
    double extent;   /* larger side of the controls' bounding box */
    double rounding; /* of points of the curve, in the frame */
};

static narc_status check_controls(const narc_point *controls, size_t degree, double tolerance, narc_error *error) {
    for (size_t k = 0; k <= degree; k++) {
        const narc_point p = controls[k];
        const double value = isfinite(p.x) ? p.y : p.x;
        if (!isfinite(p.x) || !isfinite(p.y)) {
            return narc_fail(error, NARC_ERROR_NOT_FINITE, k, value, "control point %zu is not finite: (%g, %g)", k,
                             p.x, p.y);
        }
        const double largest = fmax(fabs(p.x), fabs(p.y));
        if (largest > NARC_MAX_COORDINATE) {
            return narc_fail(error, NARC_ERROR_SIZE, k, largest,
                             "control point %zu has a coordinate of %g, at most %g is allowed", k, largest,
                             NARC_MAX_COORDINATE);
        }
    }
    if (isnan(tolerance))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, tolerance, "tolerance is not a number");
    if (!(tolerance > 0))
        return narc_fail(error, NARC_ERROR_SIZE, 0, tolerance, "tolerance is %g, it must be positive", tolerance);
    return NARC_OK;
}

static struct frame find_frame(const narc_point *controls, size_t degree) {
    const narc_aabb box = bound_points(controls, degree + 1);
    const double largest = largest_in(box);
    struct frame frame = {.middle = {(box.min_x + box.max_x) / 2, (box.min_y + box.max_y) / 2},
                          .extent = extent_of(box)};
    if (frame.extent > 0) {
        frexp(frame.extent, &frame.exponent);
        /* Moving to the frame and back rounds each coordinate by half an epsilon of the largest, twice; what is done
         * in the frame, where all is below 1, takes some tens of roundings. */
        frame.rounding = 2 * DBL_EPSILON * ldexp(largest, -frame.exponent) + 16 * DBL_EPSILON;
    }
    return frame;
}

static narc_point to_frame(const struct frame *frame, narc_point p) {
    return (narc_point){ldexp(p.x - frame->middle.x, -frame->exponent), ldexp(p.y - frame->middle.y, -frame->exponent)};
}

static narc_point from_frame(const struct frame *frame, narc_point p) {
    return (narc_point){ldexp(p.x, frame->exponent) + frame->middle.x, ldexp(p.y, frame->exponent) + frame->middle.y};
}

/* The curve as a cubic. */
static narc_cubic raise_degree(const narc_point *c, size_t degree) {
    if (degree == 1) {
        return (narc_cubic){
            {c[0], along(c[0], 1. / 3, minus(c[1], c[0])), along(c[1], 1. / 3, minus(c[0], c[1])), c[1]}};
    }
    if (degree == 2) {
        return (narc_cubic){
            {c[0], along(c[0], 2. / 3, minus(c[1], c[0])), along(c[2], 2. / 3, minus(c[1], c[2])), c[2]}};
    }
    return (narc_cubic){{c[0], c[1], c[2], c[3]}};
}

/* Takes over `other` if it has fewer arcs, or as many and they are closer; frees the one that is not kept. */
static void keep_better(narc_arc_list *best, narc_arc_list *other) {
    const bool better = best->count == 0 || other->count < best->count ||
                        (other->count == best->count && other->distance < best->distance);
    free(better ? best->arcs : other->arcs);
    *best = better ? *other : *best;
}

/* Cuts are sought from both ends, so that the direction of the curve makes no difference. */
static narc_status fit_both_ways(const narc_cubic *curve, double tolerance, double rounding, narc_arc_list *best,
                                 narc_error *error) {
    const narc_cubic reversed = narc_reverse_cubic(curve);
    narc_status status = NARC_OK;
    for (int way = 0; way < 2 && status == NARC_OK; way++) {
        narc_arc_list spline = {0};
        status = narc_fit_spline(way ? &reversed : curve, tolerance, rounding, &spline, error);
        if (status != NARC_OK) {
            free(spline.arcs);
        } else {
            if (way)
                narc_reverse_arcs(spline.arcs, spline.count);
            keep_better(best, &spline);
        }
    }
    return status;
}

/* The furthest cuts are not always the best: where a curve turns sharply, less tolerance may lead to cuts that need
 * fewer arcs, and it often leads to as many that are closer. It is tried while the arcs are few. */
static narc_status fit_best(const narc_cubic *curve, double tolerance, double rounding, narc_arc_list *best,
                            narc_error *error) {
    enum { TRIES = 5, FEW_ARCS = 24 };
    narc_status status = fit_both_ways(curve, tolerance, rounding, best, error);
    for (int k = 0; k < TRIES && status == NARC_OK && best->count <= FEW_ARCS; k++) {
        narc_arc_list closer = {0};
        tolerance *= 0.65;
        const narc_status tried =
            tolerance < 1e-9 ? NARC_ERROR_SIZE : fit_both_ways(curve, tolerance, rounding, &closer, NULL);
        if (tried != NARC_OK) {
            free(closer.arcs);
            if (tried == NARC_ERROR_MEMORY) /* otherwise what there is stays the best */
                status = narc_fail(error, tried, 0, 0, "no memory for arcs");
            break;
        }
        const bool too_many = closer.count > best->count;
        keep_better(best, &closer);
        if (too_many)
            break;
    }
    return status;
}

/* The checks of a curve, and its frame. */
static narc_status prepare(const narc_point *controls, size_t degree, double tolerance, struct frame *out_frame,
                           narc_error *error) {
    const narc_status status = check_controls(controls, degree, tolerance, error);
    if (status)
        return status;
    *out_frame = find_frame(controls, degree);
    const double extent = ldexp(out_frame->extent, -out_frame->exponent);
    const double least = ldexp(fmax(LEAST_TOLERANCE * extent, 16 * out_frame->rounding), out_frame->exponent);
    if (extent > 0 && tolerance < least)
        return narc_fail(error, NARC_ERROR_SIZE, 0, tolerance, "tolerance is %g, at least %g is needed for this curve",
                         tolerance, least);
    return NARC_OK;
}

narc_status narc_check_curve(const narc_point *controls, size_t degree, double tolerance, narc_error *error) {
    struct frame frame;
    return prepare(controls, degree, tolerance, &frame, error);
}

narc_status narc_add_curve(const narc_point *controls, size_t degree, double tolerance, narc_arc_list *to,
                           narc_error *error) {
    struct frame frame;
    narc_arc_list spline = {0};
    narc_status status = prepare(controls, degree, tolerance, &frame, error);
    if (status || frame.extent == 0)
        return status;
    narc_point local[4];
    for (size_t k = 0; k <= degree; k++)
        local[k] = to_frame(&frame, controls[k]);
    const narc_cubic curve = raise_degree(local, degree);
    /* A tolerance of many times the curve means no more than that of a few times. */
    const double most = 16 * ldexp(frame.extent, -frame.exponent);
    const double limit = fmin(ldexp(tolerance, -frame.exponent), most) - 2 * frame.rounding;
    status = fit_best(&curve, limit, frame.rounding, &spline, error);
    narc_curve_arc *arcs = status ? NULL : narc_grow(to->arcs, &to->capacity, to->count + spline.count, sizeof *arcs);
    if (!status && !arcs)
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
    for (size_t k = 0; k < spline.count && !status; k++) {
        narc_curve_arc arc = spline.arcs[k];
        arc.start = k ? from_frame(&frame, arc.start) : controls[0];
        arc.end = k + 1 < spline.count ? from_frame(&frame, arc.end) : controls[degree];
        arc.center = from_frame(&frame, arc.center);
        arc.radius = ldexp(arc.radius, frame.exponent);
        arcs[to->count + k] = arc;
    }
    if (!status) {
        /* The sum of what was subtracted above may be a rounding more. */
        const double distance = fmin(ldexp(spline.distance + 2 * frame.rounding, frame.exponent), tolerance);
        to->arcs = arcs;
        to->count += spline.count;
        to->distance = fmax(to->distance, distance);
    }
    free(spline.arcs);
    return status;
}

narc_status narc_fit_bezier(const narc_point *controls, size_t degree, double tolerance, narc_curve_arc *out_arcs,
                            size_t capacity, size_t *out_count, double *out_distance, narc_error *error) {
    if (!controls || !out_count || !out_distance || (!out_arcs && capacity > 0)) {
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL",
                         !controls       ? "controls"
                         : !out_count    ? "out_count"
                         : !out_distance ? "out_distance"
                                         : "out_arcs");
    }
    if (degree < 1 || degree > 3)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)degree, "degree is %zu, it must be 1 to 3", degree);
    narc_arc_list list = {0};
    narc_status status = narc_add_curve(controls, degree, tolerance, &list, error);
    for (size_t k = 0; k < list.count && k < capacity; k++)
        out_arcs[k] = list.arcs[k];
    if (!status) {
        *out_count = list.count;
        if (out_arcs && capacity < list.count)
            status = narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)list.count,
                               "room for %zu arcs, but there are %zu", capacity, list.count);
        else
            *out_distance = list.distance;
    }
    free(list.arcs);
    return status;
}
