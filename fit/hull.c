/* SPDX-License-Identifier: MIT
 *
 * hull.c - convex hull (Andrew's monotone chain) and its support points.
 */
#include "hull.h"

#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "vector.h"

/* A corner that turns by less than this, as the sine of the angle, counts as straight: then its two sides have normals
 * that differ by roundings only. */
static const double STRAIGHT = 1e-12;

static int compare_points(const void *left, const void *right) {
    const narc_point *a = left, *b = right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

static bool turns_left(narc_point a, narc_point b, narc_point c) {
    const narc_point in = minus(b, a), out = minus(c, b);
    const bool turns_back = dot(in, out) < 0; /* a reversal is no straight line, its sine is as small */
    return cross(in, out) > (turns_back ? 0 : STRAIGHT * length(in) * length(out));
}

/* Adds p to a chain of corners that all turn left; those that no longer do are dropped, but none below `keep`. */
static size_t extend_chain(narc_point *chain, size_t count, size_t keep, narc_point p) {
    while (count > keep && !turns_left(chain[count - 2], chain[count - 1], p)) {
        count--;
    }
    chain[count] = p;
    return count + 1;
}

/* Both chains of `sorted` points into `corners` (room for count + 1). Returns how many there are. */
static size_t chain_corners(const narc_point *sorted, size_t count, narc_point *corners) {
    size_t found = 0;
    for (size_t i = 0; i < count; i++) {
        found = extend_chain(corners, found, 1, sorted[i]);
    }
    const size_t lower = found;
    for (size_t i = count - 1; i-- > 0;) {
        found = extend_chain(corners, found, lower, sorted[i]);
    }
    return found - 1;
}

static void measure_hull(hull *of) {
    of->area = 0;
    of->perimeter = 0;
    double last = 0;
    for (size_t k = 0; k < of->count; k++) {
        const narc_point a = of->corners[k], b = of->corners[(k + 1) % of->count];
        const narc_point side = minus(b, a);
        of->normals[k] = (narc_point){side.y / length(side), -side.x / length(side)};
        double angle = atan2(of->normals[k].y, of->normals[k].x);
        while (k > 0 && angle < last) {
            angle += 2 * PI;
        }
        of->angles[k] = last = angle;
        of->perimeter += length(side);
        of->area += 0.5 * cross(minus(a, of->corners[0]), minus(b, of->corners[0]));
    }
}

narc_status narc_adopt_corners(const narc_point *corners, size_t count, hull *out_hull, narc_error *error) {
    hull made = {.count = count};
    made.corners = malloc(count * sizeof *made.corners);
    made.normals = malloc(count * sizeof *made.normals);
    made.angles = malloc(count * sizeof *made.angles);
    if (!made.corners || !made.normals || !made.angles) {
        narc_release_hull(&made);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", count);
    }
    memcpy(made.corners, corners, count * sizeof *corners);
    measure_hull(&made);
    *out_hull = made;
    return NARC_OK;
}

narc_status narc_make_hull(const narc_point *points, size_t count, hull *out_hull, narc_error *error) {
    if (count == 0) {
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    }
    narc_point *sorted = malloc(count * sizeof *sorted), *corners = malloc((count + 1) * sizeof *corners);
    narc_status status;
    if (!sorted || !corners) {
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu points", count);
    } else {
        memcpy(sorted, points, count * sizeof *sorted);
        qsort(sorted, count, sizeof *sorted, compare_points);
        const size_t found = count < 3 ? 0 : chain_corners(sorted, count, corners);
        status = found < 3 ? narc_fail(error, NARC_ERROR_NOT_CONVEX, 0, 0,
                                       "all points of the outline lie on a line, it has no area")
                           : narc_adopt_corners(corners, found, out_hull, error);
    }
    free(sorted);
    free(corners);
    return status;
}

/* Are the corners between `from` and `to` within the tolerance of the segment between these two? */
static bool is_flat_run(const hull *of, size_t from, size_t to, double tolerance) {
    const narc_point a = of->corners[from], side = minus(of->corners[to % of->count], a);
    if (to - from >= of->count) {
        return false;
    }
    for (size_t k = from + 1; k < to; k++) {
        const narc_point p = minus(of->corners[k], a);
        const double part = dot(p, side);
        if (part < 0 || part > dot(side, side) || fabs(cross(side, p)) > tolerance * length(side)) {
            return false;
        }
    }
    return true;
}

/* Each run is as long as it can be, by doubling its length and then halving the doubt. */
narc_status narc_thin_hull(hull *of, double tolerance, narc_error *error) {
    narc_point *kept = malloc(of->count * sizeof *kept);
    if (!kept) {
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for a hull of %zu corners", of->count);
    }
    size_t count = 0;
    for (size_t from = 0; from < of->count;) {
        kept[count++] = of->corners[from];
        size_t step = 1;
        while (from + 2 * step <= of->count && is_flat_run(of, from, from + 2 * step, tolerance)) {
            step *= 2;
        }
        for (size_t more = step / 2; more > 0; more /= 2) {
            if (from + step + more <= of->count && is_flat_run(of, from, from + step + more, tolerance)) {
                step += more;
            }
        }
        from += step;
    }
    hull thinned;
    const narc_status status = count < 3 ? NARC_OK : narc_adopt_corners(kept, count, &thinned, error);
    free(kept);
    if (status == NARC_OK && count >= 3) {
        thinned.inflation = of->inflation + tolerance;
        narc_release_hull(of);
        *of = thinned;
    }
    return status;
}

void narc_release_hull(hull *of) {
    free(of->corners);
    free(of->normals);
    free(of->angles);
    *of = (hull){0};
}

size_t narc_find_corner(const hull *of, double angle) {
    const double start = of->angles[0];
    angle -= 2 * PI * floor((angle - start) / (2 * PI));
    /* The first side whose normal lies beyond the angle begins at the corner. */
    size_t low = 0, high = of->count;
    while (low < high) {
        const size_t middle = (low + high) / 2;
        if (of->angles[middle] <= angle) {
            low = middle + 1;
        } else {
            high = middle;
        }
    }
    return low % of->count;
}
