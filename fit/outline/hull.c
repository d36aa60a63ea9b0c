/* SPDX-License-Identifier: MIT
 *
 * hull.c - convex hull (Andrew's monotone chain) and its support points.
 */
#include "outline/hull.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/vector.h"

/* A corner that turns by less than this, as the sine of the angle, counts as straight: then its two sides have normals
 * that differ by roundings only. */
static const double STRAIGHT = 1e-12;

/* Corners closer than this part of the hull's extent are one. That is far below what single precision tells apart, and
 * the side between two corners further apart keeps its direction, to 1e-6 radians, wherever the hull is moved. */
static const double COINCIDENT = 1e-10;

static bool turns_left(narc_point a, narc_point b, narc_point c, double straight) {
    const narc_point incoming = minus(b, a), outgoing = minus(c, b);
    /* A reversal is no straight line, its sine is as small. */
    const bool any = straight == 0 || dot(incoming, outgoing) < 0;
    return cross(incoming, outgoing) > (any ? 0 : straight * length(incoming) * length(outgoing));
}

/* Adds p to a chain of corners that all turn left; those that no longer do are dropped, but none below `keep`. */
static size_t extend_chain(narc_point *chain, size_t count, size_t keep, narc_point p, double straight) {
    while (count > keep && !turns_left(chain[count - 2], chain[count - 1], p, straight))
        count--;
    chain[count] = p;
    return count + 1;
}

size_t narc_wrap_sorted(const narc_point *sorted, size_t count, double straight, narc_point *out_corners) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++)
        found = extend_chain(out_corners, found, 1, sorted[i], straight);
    const size_t lower = found;
    for (size_t i = count - 1; i-- > 0;)
        found = extend_chain(out_corners, found, lower, sorted[i], straight);
    return count > 1 ? found - 1 : found;
}

static double find_extent(const narc_point *corners, size_t count) {
    double extent = 0;
    for (size_t k = 0; k < count; k++)
        extent = fmax(extent, length(minus(corners[k], corners[0])));
    return extent;
}

/* Drops corners that coincide with the one before, and those that do not turn left, until there are none. Returns how
 * many stay. */
static size_t clean_corners(narc_point *corners, size_t count) {
    const double least = COINCIDENT * find_extent(corners, count);
    size_t before = 0;
    while (count != before && count >= 3) {
        before = count;
        count = 0;
        for (size_t k = 0; k < before; k++) {
            const narc_point last = corners[(count ? count : before) - 1], p = corners[k];
            if (length(minus(p, last)) > least && turns_left(last, p, corners[(k + 1) % before], STRAIGHT))
                corners[count++] = p;
        }
    }
    return count;
}

static void measure_hull(narc_hull *hull) {
    hull->area = 0;
    hull->perimeter = 0;
    double last = 0;
    for (size_t k = 0; k < hull->count; k++) {
        const narc_point a = hull->corners[k], b = hull->corners[(k + 1) % hull->count];
        const narc_point side = minus(b, a);
        hull->normals[k] = (narc_point){side.y / length(side), -side.x / length(side)};
        double angle = narc_atan2(hull->normals[k].y, hull->normals[k].x);
        while (k > 0 && angle < last)
            angle += 2 * PI;
        hull->angles[k] = last = angle;
        hull->perimeter += length(side);
        hull->area += 0.5 * cross(minus(a, hull->corners[0]), minus(b, hull->corners[0]));
    }
}

static narc_status fail_flat(narc_error *error) {
    return narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, 0, "all points of the outline lie on a line, it has no area");
}

narc_status narc_adopt_corners(const narc_point *corners, size_t count, narc_hull *out_hull, narc_error *error) {
    if (count < 3)
        return fail_flat(error);
    narc_hull hull = {.count = count};
    hull.corners = malloc(count * sizeof *hull.corners);
    hull.normals = malloc(count * sizeof *hull.normals);
    hull.angles = malloc(count * sizeof *hull.angles);
    if (!hull.corners || !hull.normals || !hull.angles) {
        narc_release_hull(&hull);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", count);
    }
    memcpy(hull.corners, corners, count * sizeof *corners);
    hull.count = clean_corners(hull.corners, count);
    if (hull.count < 3) {
        narc_release_hull(&hull);
        return fail_flat(error);
    }
    measure_hull(&hull);
    *out_hull = hull;
    return NARC_OK;
}

narc_status narc_make_hull(const narc_point *points, size_t count, narc_hull *out_hull, narc_error *error) {
    if (count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    narc_point *sorted = malloc(count * sizeof *sorted), *corners = malloc((count + 1) * sizeof *corners);
    narc_status status;
    if (!sorted || !corners) {
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu points", count);
    } else {
        memcpy(sorted, points, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, compare_points);
        status = narc_adopt_corners(corners, narc_wrap_sorted(sorted, count, STRAIGHT, corners), out_hull, error);
    }
    free(sorted);
    free(corners);
    return status;
}

/* Of the perimeter: a side as long as that was drawn as one, and keeps both ends. */
static const double LONG_SIDE = 1.0 / 64;

/* Are the corners between `first` and `last` within the tolerance of the segment between these two? */
static bool is_flat_run(const narc_hull *hull, size_t first, size_t last, double tolerance) {
    const narc_point a = hull->corners[first], side = minus(hull->corners[last % hull->count], a);
    if (last - first >= hull->count)
        return false;
    for (size_t k = first; k < last; k++)
        if (length(minus(hull->corners[(k + 1) % hull->count], hull->corners[k])) > LONG_SIDE * hull->perimeter)
            return false;
    for (size_t k = first + 1; k < last; k++) {
        const narc_point p = minus(hull->corners[k], a);
        const double part = dot(p, side);
        if (part < 0 || part > dot(side, side) || fabs(cross(side, p)) > tolerance * length(side))
            return false;
    }
    return true;
}

/* Each run is as long as it can be, by doubling its length and then halving the doubt. */
narc_status narc_thin_hull(narc_hull *hull, double tolerance, narc_error *error) {
    narc_point *kept = malloc(hull->count * sizeof *kept);
    if (!kept)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", hull->count);
    size_t count = 0;
    for (size_t first = 0; first < hull->count;) {
        kept[count++] = hull->corners[first];
        size_t step = 1;
        while (first + 2 * step <= hull->count && is_flat_run(hull, first, first + 2 * step, tolerance))
            step *= 2;
        for (size_t more = step / 2; more > 0; more /= 2)
            if (first + step + more <= hull->count && is_flat_run(hull, first, first + step + more, tolerance))
                step += more;
        first += step;
    }
    narc_hull thinned;
    const narc_status status = count < 3 ? NARC_OK : narc_adopt_corners(kept, count, &thinned, error);
    free(kept);
    if (status == NARC_OK && count >= 3) {
        thinned.inflation = hull->inflation + tolerance;
        narc_release_hull(hull);
        *hull = thinned;
    }
    return status;
}

void narc_release_hull(narc_hull *hull) {
    free(hull->corners);
    free(hull->normals);
    free(hull->angles);
    *hull = (narc_hull){0};
}

size_t narc_find_corner(const narc_hull *hull, double angle) {
    const double start = hull->angles[0];
    angle -= 2 * PI * floor((angle - start) / (2 * PI));
    /* The first side whose normal lies beyond the angle begins at the corner. */
    size_t low = 0, high = hull->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (hull->angles[middle] <= angle)
            low = middle + 1;
        else
            high = middle;
    }
    return low % hull->count;
}

narc_status narc_compute_hull(const narc_point *points, size_t count, narc_point *out_corners, size_t *out_count,
                              narc_error *error) {
    if (!points || !out_corners || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "points, out_corners or out_count is NULL");
    narc_hull hull;
    const narc_status status = narc_make_hull(points, count, &hull, error);
    if (!status) {
        memcpy(out_corners, hull.corners, hull.count * sizeof *hull.corners);
        *out_count = hull.count;
        narc_release_hull(&hull);
    }
    return status;
}
