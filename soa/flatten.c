/* SPDX-License-Identifier: MIT
 *
 * flatten.c - outlines of shapes and chains as polylines.
 *
 * A chord over the angle h of an arc leaves it by the sagitta r (1 - cos(h / 2)), which is at most r h^2 / 8, as 1 - cos x is
 * at most x^2 / 2. So ceil(sweep sqrt(r / (8 t))) even chords stay within t. Of the tolerance 1/1024 is left to points that are as
 * near to the one before, which are dropped: ends of arcs that are one.
 */
#include <math.h>

#include "broken.h"
#include "elementary.h"
#include "error.h"
#include "outline.h"

/* Where a shape's points go: all that it takes is exact, or rounded once. */
typedef struct pose {
    double x, y, cosine, sine, scale;
} pose;

/* What an arc turns by, clockwise below 0. */
static double find_turn(const narc_arc *arc) {
    const double turn = signbit(arc->radius) ? arc->start - arc->end : arc->end - arc->start;
    const double wrapped = turn < 0 ? turn + 2 * NARC_PI : turn;
    return signbit(arc->radius) ? -wrapped : wrapped;
}

/* `tolerance` in the arcs' unit. */
static double count_chords(const narc_arc *arc, double tolerance) {
    const double chords = ceil(fabs(find_turn(arc)) * sqrt(fabs(arc->radius) / (8 * tolerance)));
    return arc->radius == 0 ? 0 : chords > 1 ? chords : 1;
}

static narc_point find_point(const narc_arc *arc, double part, const pose *at) {
    double x, y;
    narc_find_normal(part == 1 ? arc->end : arc->start + part * find_turn(arc), &x, &y);
    x = arc->center_x + arc->radius * x;
    y = arc->center_y + arc->radius * y;
    return (narc_point){at->x + at->scale * (at->cosine * x - at->sine * y),
                        at->y + at->scale * (at->sine * x + at->cosine * y)};
}

static narc_status check_numbers(const narc_arc *arcs, size_t count, const pose *at, double tolerance,
                                 narc_error *error) {
    for (size_t k = 0; k < count; k++) {
        const double numbers[] = {arcs[k].center_x, arcs[k].center_y, arcs[k].radius, arcs[k].start, arcs[k].end};
        for (size_t i = 0; i < sizeof numbers / sizeof *numbers; i++)
            if (!isfinite(numbers[i]))
                return narc_fail(error, NARC_ERROR_NOT_FINITE, k, numbers[i], "arc %zu: a number is %g", k, numbers[i]);
        if (!(fabs(find_turn(&arcs[k])) <= 2 * NARC_PI + NARC_TOLERANCE))
            return narc_fail(error, NARC_ERROR_SWEEP, k, find_turn(&arcs[k]), "arc %zu: sweep is %.9g rad", k,
                             find_turn(&arcs[k]));
    }
    if (!isfinite(at->x) || !isfinite(at->y) || !(at->scale > 0 && isfinite(at->scale)) ||
        !narc_is_rotation((float)at->cosine, (float)at->sine))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, at->scale, "the body is broken");
    if (!(tolerance > 0 && isfinite(tolerance)))
        return narc_fail(error, isfinite(tolerance) ? NARC_ERROR_ARGUMENT : NARC_ERROR_NOT_FINITE, 0, tolerance,
                         "tolerance is %g, not above 0", tolerance);
    return NARC_OK;
}

static bool are_same(const narc_point *p, const narc_point *q, double same) {
    return narc_hypot(p->x - q->x, p->y - q->y) <= same;
}

narc_status narc_flatten_arcs(const narc_arc *arcs, size_t count, bool closed, const narc_body *body, double tolerance,
                              narc_point *out_points, size_t capacity, size_t *out_count, narc_error *error) {
    if ((!arcs && count > 0) || !out_count || (!out_points && capacity > 0))
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", arcs || count == 0 ? "an output" : "arcs");
    pose at = {0, 0, 1, 0, 1};
    if (body)
        at = (pose){body->x, body->y, (double)body->cosine, (double)body->sine, (double)body->scale};
    narc_status status = check_numbers(arcs, count, &at, tolerance, error);
    if (status != NARC_OK)
        return status;
    const double square = at.cosine * at.cosine + at.sine * at.sine - 1, factor = NARC_INVERSE_LENGTH(square);
    at.cosine *= factor;
    at.sine *= factor;
    const double same = tolerance * 0x1p-10, sagitta = (tolerance - same) / at.scale;
    double needed = 0;
    for (size_t k = 0; k < count; k++)
        needed += count_chords(&arcs[k], sagitta) + 1;
    if (!(needed <= (double)capacity)) {
        *out_count = needed < (double)SIZE_MAX ? (size_t)needed : SIZE_MAX;
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, needed, "up to %.0f points, but there is room for %zu", needed,
                         capacity);
    }
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const size_t chords = (size_t)count_chords(&arcs[k], sagitta);
        for (size_t i = 0; i <= chords; i++) {
            const narc_point p = find_point(&arcs[k], chords > 0 ? (double)i / (double)chords : 0, &at);
            if (found == 0 || !are_same(&p, &out_points[found - 1], same))
                out_points[found++] = p;
        }
    }
    found -= closed && found > 1 && are_same(&out_points[0], &out_points[found - 1], same);
    *out_count = found;
    return NARC_OK;
}
