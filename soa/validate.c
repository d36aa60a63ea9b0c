/* SPDX-License-Identifier: MIT
 *
 * validate.c - is a list of arcs a closed convex outline?
 */
#include "elementary.h"
#include "error.h"
#include "outline.h"

#include <math.h>

/* An outline flatter than this, relative to its size, is a line: what is left of its width is rounding. Only a segment
 * may be. */
#define FLAT 1e-13

/* No coordinate of a valid shape is larger: its bounding circle has at most NARC_MAX_SIZE as its radius and as its
 * distance from the origin, and a centre is at most its arc's radius further out. Checked early, so that nothing
 * overflows. */
#define MAX_COORDINATE (NARC_MAX_SIZE * (NARC_MAX_RADIUS_RATIO + 2))

static narc_status check_numbers(const narc_arc *arcs, size_t count, narc_error *error) {
    for (size_t i = 0; i < count; i++) {
        const struct {
            const char *name;
            double value;
        } numbers[] = {{"center x", arcs[i].center_x},
                       {"center y", arcs[i].center_y},
                       {"radius", arcs[i].radius},
                       {"start", arcs[i].start},
                       {"end", arcs[i].end}};
        for (size_t k = 0; k < sizeof numbers / sizeof numbers[0]; k++)
            if (!isfinite(numbers[k].value))
                return narc_fail(error, NARC_ERROR_NOT_FINITE, i, numbers[k].value, "arc %zu: %s is %g", i,
                                 numbers[k].name, numbers[k].value);
    }
    for (size_t i = 0; i < count; i++)
        if (arcs[i].radius < 0)
            return narc_fail(error, NARC_ERROR_RADIUS, i, arcs[i].radius, "arc %zu: radius is %g", i, arcs[i].radius);
    return NARC_OK;
}

static narc_status check_turns(const narc_arc *arcs, size_t count, narc_error *error) {
    double limit = count == 1 ? 2 * NARC_PI : NARC_PI, sum = 0;
    for (size_t i = 0; i < count; i++) {
        double sweep = narc_find_sweep(&arcs[i]);
        if (sweep > limit + NARC_TOLERANCE)
            return narc_fail(error, NARC_ERROR_SWEEP, i, sweep, "arc %zu: sweep is %.9g rad, more than %s a turn", i,
                             sweep, count == 1 ? "once" : "half");
        if (sweep < NARC_TOLERANCE)
            return narc_fail(error, NARC_ERROR_SWEEP, i, sweep, "arc %zu: sweep is %.9g rad, %s", i, sweep,
                             sweep < 0 ? "it turns backwards" : "it turns by nothing");
        if (count == 1 && sweep < limit - NARC_TOLERANCE)
            return narc_fail(error, NARC_ERROR_SWEEP, 0, sweep,
                             "arc 0: sweep is %.9g rad, one arc alone is a full turn", sweep);
        sum += sweep;
    }
    for (size_t i = 0; i < count && count > 1; i++) {
        size_t before = (i + count - 1) % count;
        double apart = narc_wrap_angle(arcs[i].start - arcs[before].end);
        if (fabs(apart) > NARC_TOLERANCE)
            return narc_fail(error, NARC_ERROR_NOT_CLOSED, i, apart,
                             "arc %zu: its start normal is %.9g rad from the end normal of arc %zu", i, apart, before);
    }
    if (fabs(sum - 2 * NARC_PI) > NARC_PI) /* the normals join, so the sum is near some whole number of turns */
        return narc_fail(error, NARC_ERROR_SWEEP, 0, sum, "the arcs turn by %.9g rad in all, not by one turn", sum);
    return NARC_OK;
}

/* The vector from the end of one arc to the start of the next must have the direction of the edge between them,
 * which is their common normal turned left; in an n-arc it is zero. */
narc_status narc_check_edges(const narc_outline *o, double tolerance, narc_error *error) {
    for (size_t i = 0; i < o->count; i++) {
        size_t before = (i + o->count - 1) % o->count;
        narc_point from = narc_find_end(o, before), to = narc_find_start(o, i);
        double x = to.x - from.x, y = to.y - from.y;
        double off = x * o->normal_x[i] + y * o->normal_y[i], along = y * o->normal_x[i] - x * o->normal_y[i];
        if (fabs(off) > tolerance)
            return narc_fail(error, NARC_ERROR_NOT_CLOSED, i, off,
                             "arc %zu: starts %.6g away from where the edge from arc %zu should meet it", i, fabs(off),
                             before);
        if (along < -tolerance)
            return narc_fail(error, NARC_ERROR_NOT_CONVEX, i, along,
                             "arc %zu: the edge from arc %zu runs backwards, its length is %.6g", i, before, along);
    }
    return NARC_OK;
}

static bool is_flat(const narc_outline *o, double size) {
    double twice_area = 0;
    narc_point from = narc_find_end(o, o->count - 1);
    for (size_t i = 0; i < o->count; i++) {
        if (o->radius[i] > FLAT * size)
            return false;
        narc_point to = narc_find_start(o, i);
        twice_area += from.x * to.y - from.y * to.x;
        from = to;
    }
    return twice_area <= 2 * FLAT * size * size;
}

static narc_status check_size(const narc_outline *o, narc_circle bound, narc_error *error) {
    double size = bound.radius, away = narc_hypot(bound.x, bound.y);
    if (!(size >= NARC_MIN_SIZE && size <= NARC_MAX_SIZE))
        return narc_fail(error, NARC_ERROR_SIZE, 0, size, "the shape's bounding radius is %g, not in %g .. %g", size,
                         NARC_MIN_SIZE, NARC_MAX_SIZE);
    if (away > NARC_MAX_SIZE)
        return narc_fail(error, NARC_ERROR_SIZE, 0, away, "the shape is %g away from its origin, more than %g", away,
                         NARC_MAX_SIZE);
    if (is_flat(o, size) && !narc_is_segment(o))
        return narc_fail(error, NARC_ERROR_SIZE, 0, 0, "the shape encloses no area");
    for (size_t i = 0; i < o->count; i++)
        if (o->radius[i] > NARC_MAX_RADIUS_RATIO * size)
            return narc_fail(error, NARC_ERROR_RADIUS, i, o->radius[i],
                             "arc %zu: radius is %.9g, more than %g times the shape's bounding radius %.9g", i,
                             o->radius[i], NARC_MAX_RADIUS_RATIO, size);
    return NARC_OK;
}

narc_status narc_check_points(const narc_point *points, size_t count, narc_error *error) {
    for (size_t i = 0; i < count; i++)
        if (!isfinite(points[i].x) || !isfinite(points[i].y))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, i, isfinite(points[i].x) ? points[i].y : points[i].x,
                             "point %zu: a coordinate is not finite", i);
    return NARC_OK;
}

narc_status narc_check_turns(const double *turns, size_t count, narc_error *error) {
    double sum = 0;
    size_t first = count;
    for (size_t i = 0; i < count; i++) {
        sum += turns[i];
        first = first == count && turns[i] < NARC_TOLERANCE ? i : first;
    }
    if (first < count)
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, first, turns[first],
                         "point %zu: the outline turns by %.6g rad, not left (counter-clockwise)%s", first,
                         turns[first], sum < -NARC_PI ? ": it is clockwise: reverse the points" : "");
    if (sum > 3 * NARC_PI) /* a closed outline makes a whole number of turns */
        return narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, sum, "the outline turns by %.6g rad in all, not once", sum);
    return NARC_OK;
}

narc_status narc_check_arcs(const narc_arc *arcs, size_t count, narc_outline *out_outline, narc_circle *out_bound,
                            narc_error *error) {
    narc_status status;
    if (!arcs)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "arcs is NULL");
    if (count == 0 || count > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu arcs, not 1 to %d", count,
                         NARC_MAX_ARCS);
    if ((status = check_numbers(arcs, count, error)) != NARC_OK ||
        (status = check_turns(arcs, count, error)) != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        double largest = fmax(arcs[i].radius, fmax(fabs(arcs[i].center_x), fabs(arcs[i].center_y)));
        if (largest > MAX_COORDINATE)
            return narc_fail(error, NARC_ERROR_SIZE, i, largest, "arc %zu: a coordinate or radius is %g, more than %g",
                             i, largest, MAX_COORDINATE);
    }
    narc_read_outline(arcs, count, out_outline);
    for (size_t i = 0; i < out_outline->count; i++)
        if (out_outline->sweep[i] < NARC_TOLERANCE / 2) /* the neighbours' normals left it nothing */
            return narc_fail(error, NARC_ERROR_SWEEP, i, out_outline->sweep[i],
                             "arc %zu: sweep is %.9g rad between its neighbours, it turns by nothing", i,
                             out_outline->sweep[i]);
    narc_bound_outline(out_outline, out_bound);
    if ((status = narc_check_edges(out_outline, NARC_TOLERANCE * out_bound->radius, error)) != NARC_OK)
        return status;
    out_bound->x += out_outline->origin_x;
    out_bound->y += out_outline->origin_y;
    return check_size(out_outline, *out_bound, error);
}

narc_status narc_validate_arcs(const narc_arc *arcs, size_t count, narc_error *error) {
    narc_outline outline;
    narc_circle bound;
    return narc_check_arcs(arcs, count, &outline, &bound, error);
}
