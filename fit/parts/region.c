/* SPDX-License-Identifier: MIT
 *
 * region.c - contours with the inside on their left, and simpler ones near them.
 */
#include "parts/region.h"

#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/path.h"
#include "outline/vector.h"

/* Lines longer than this part of the extent are divided, so that cuts can end on them. */
static const double LONGEST_LINE = 1.0 / 32;

/* ---------------------------------------------------------------------------- contours */

static bool add_point(narc_region *region, narc_point p) {
    narc_point *points = narc_grow(region->points, &region->point_capacity, region->point_count + 1, sizeof *points);
    if (!points)
        return false;
    region->points = points;
    points[region->point_count++] = p;
    return true;
}

static bool divide_lines(narc_region *region, const narc_contours *contours) {
    region->ends = malloc(contours->count * sizeof *region->ends);
    if (!region->ends)
        return false;
    for (size_t k = 0; k < contours->count; k++) {
        const size_t begin = begin_of(contours->ends, k), end = contours->ends[k];
        for (size_t i = begin; i < end; i++) {
            const narc_point p = contours->points[i], q = contours->points[i + 1 < end ? i + 1 : begin];
            const double pieces = ceil(length(minus(q, p)) / (LONGEST_LINE * region->extent));
            for (double piece = 0; piece < fmax(1, pieces); piece++)
                if (!add_point(region, along(p, piece / fmax(1, pieces), minus(q, p))))
                    return false;
        }
        region->ends[region->count++] = region->point_count;
    }
    return true;
}

static double measure_contour(const narc_region *region, size_t k) {
    const size_t begin = begin_of(region->ends, k), end = region->ends[k];
    double twice = 0;
    for (size_t i = begin; i < end; i++) {
        const narc_point next = region->points[i + 1 < end ? i + 1 : begin], base = region->points[begin];
        twice += cross(minus(region->points[i], base), minus(next, base));
    }
    return 0.5 * twice;
}

double narc_measure_region(const narc_region *region) {
    double area = 0;
    for (size_t k = 0; k < region->count; k++)
        area += measure_contour(region, k);
    return area;
}

/* ---------------------------------------------------------------------------- simpler contours */

/* Marks what is left of the points after `first` and before `last`, of a contour of `count` (Douglas and Peucker). The
 * stack has ends of stretches; of two halves the shorter one comes first, so it holds few. */
static void keep_points(const narc_point *points, size_t count, size_t first, size_t last, double slack, double longest,
                        bool *kept) {
    size_t stack[2 * 64], depth = 0;
    for (;;) {
        double furthest = slack * slack;
        size_t worst = 0;
        const narc_point a = points[first], b = points[last % count];
        for (size_t k = first + 1; k < last; k++) {
            const double distance = side_distance(points[k], a, b);
            if (distance > furthest) {
                furthest = distance;
                worst = k;
            }
        }
        if (!worst && last - first > 1 && length(minus(b, a)) > longest)
            worst = (first + last) / 2;
        if (worst) {
            kept[worst] = true;
            const bool low_first = worst - first < last - worst;
            stack[depth++] = low_first ? worst : first;
            stack[depth++] = low_first ? last : worst;
            first = low_first ? first : worst;
            last = low_first ? worst : last;
        } else if (depth) {
            last = stack[--depth];
            first = stack[--depth];
        } else {
            return;
        }
    }
}

static size_t find_furthest(const narc_point *points, size_t count) {
    size_t found = 0;
    for (size_t k = 1; k < count; k++)
        if (length(minus(points[k], points[0])) > length(minus(points[found], points[0])))
            found = k;
    return found;
}

static bool simplify_contours(narc_region *region) {
    bool *kept = calloc(region->point_count, sizeof *kept);
    region->kept = malloc(region->point_count * sizeof *region->kept);
    region->kept_ends = malloc(region->count * sizeof *region->kept_ends);
    size_t found = 0;
    for (size_t k = 0; kept && region->kept && region->kept_ends && k < region->count; k++) {
        const size_t begin = begin_of(region->ends, k), count = region->ends[k] - begin;
        const narc_point *points = region->points + begin;
        const size_t middle = find_furthest(points, count);
        const double longest = 2 * LONGEST_LINE * region->extent;
        kept[begin] = kept[begin + middle] = true;
        keep_points(points, count, 0, middle, region->slack, longest, kept + begin);
        keep_points(points, count, middle, count, region->slack, longest, kept + begin);
        for (size_t i = begin; i < begin + count; i++)
            if (kept[i])
                region->kept[found++] = (uint32_t)i;
        region->kept_ends[k] = found;
    }
    free(kept);
    return kept && region->kept && region->kept_ends;
}

/* ---------------------------------------------------------------------------- holes */

/* By the contour itself: simpler ones may cross where two are near each other. */
static bool is_inside(const narc_region *region, size_t k, narc_point p) {
    const size_t begin = begin_of(region->ends, k);
    return is_around(region->points + begin, region->ends[k] - begin, p);
}

/* Contours are compared next to their points, by this part of their lines: loops of one contour touch at points. */
static const double NEXT_TO = 0x1p-20;

/* Is contour k inside contour `around` with all its points? Contours that cross are both outer ones. */
static bool is_within(const narc_region *region, size_t k, size_t around, const narc_aabb *boxes) {
    const narc_aabb a = boxes[k], b = boxes[around];
    if (k == around || a.min_x < b.min_x || a.min_y < b.min_y || a.max_x > b.max_x || a.max_y > b.max_y)
        return false;
    const size_t begin = begin_of(region->kept_ends, k), end = region->kept_ends[k];
    for (size_t i = begin; i < end; i++) {
        const narc_point p = region->points[region->kept[i]];
        const narc_point side = minus(region->points[region->kept[i + 1 < end ? i + 1 : begin]], p);
        if (!is_inside(region, around, along(p, NEXT_TO, side)) ||
            !is_inside(region, around, along(p, 1 - NEXT_TO, side)))
            return false;
    }
    return true;
}

static void reverse_contour(narc_region *region, size_t k) {
    for (size_t i = begin_of(region->ends, k), j = region->ends[k] - 1; i < j; i++, j--) {
        const narc_point p = region->points[i];
        region->points[i] = region->points[j];
        region->points[j] = p;
    }
}

/* A contour in an odd number of others is a hole in the smallest of them; then contours are turned as they must be. */
static bool find_holes(narc_region *region) {
    narc_aabb *boxes = malloc(region->count * sizeof *boxes);
    double *areas = malloc(region->count * sizeof *areas);
    region->parents = malloc(region->count * sizeof *region->parents);
    const bool done = boxes && areas && region->parents;
    for (size_t k = 0; done && k < region->count; k++) {
        boxes[k] =
            bound_points(region->points + begin_of(region->ends, k), region->ends[k] - begin_of(region->ends, k));
        areas[k] = measure_contour(region, k);
    }
    for (size_t k = 0; done && k < region->count; k++) {
        size_t depth = 0, parent = SIZE_MAX;
        for (size_t other = 0; other < region->count; other++) {
            if (is_within(region, k, other, boxes)) {
                depth++;
                parent = parent == SIZE_MAX || fabs(areas[other]) < fabs(areas[parent]) ? other : parent;
            }
        }
        region->parents[k] = depth % 2 ? parent : SIZE_MAX;
    }
    for (size_t k = 0; done && k < region->count; k++)
        if ((region->parents[k] == SIZE_MAX) != (areas[k] > 0))
            reverse_contour(region, k);
    free(boxes);
    free(areas);
    return done;
}

narc_status narc_make_region(const narc_contours *contours, double slack, narc_region *out_region, narc_error *error) {
    const narc_aabb box = bound_points(contours->points, contours->point_count);
    narc_region region = {.slack = slack, .corner = {box.min_x, box.min_y}, .extent = extent_of(box)};
    if (contours->point_count == 0)
        return narc_fail(error, NARC_ERROR_COUNT, 0, 0, "the outline has no points");
    if (!(region.extent > 0))
        return narc_fail(error, NARC_ERROR_SIZE, 0, 0, "all points of the outline are in one place");
    /* Turned contours have other points left: they are simplified again. */
    bool done = divide_lines(&region, contours) && simplify_contours(&region) && find_holes(&region);
    free(region.kept);
    free(region.kept_ends);
    region.kept = NULL;
    region.kept_ends = NULL;
    done = done && simplify_contours(&region);
    if (!done) {
        narc_release_region(&region);
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for an outline of %zu points",
                         contours->point_count);
    }
    *out_region = region;
    return NARC_OK;
}

void narc_release_region(narc_region *region) {
    free(region->points);
    free(region->ends);
    free(region->parents);
    free(region->kept);
    free(region->kept_ends);
    free(region->distances);
    free(region->sums);
    free(region->lines);
    free(region->bucket_ends);
    free(region->bucket_items);
    free(region->row_ends);
    free(region->row_items);
    *region = (narc_region){0};
}
