/* SPDX-License-Identifier: MIT
 *
 * loops.c - contours that cross or touch themselves as loops that do not, and the area of contours that cross.
 *
 * A contour is walked, and where it comes to a point again, what lies between is a loop of its own: of two lines that
 * cross each is followed by the other one's rest, so loops touch there. What is walked there and back is a loop without
 * an area.
 */
#include <stdlib.h>
#include <string.h>

#include "error.h"
#include "outline/crossings.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "parts/region.h"

/* The points of all contours, with those where a contour crosses itself, and the number of the place of each. */
typedef struct walk {
    narc_point *points;
    size_t *places, *ends;
    size_t count;
} walk;

static bool is_own(const narc_contours *contours, const narc_crossing *at) {
    return narc_find_contour(contours->ends, contours->count, at->line) ==
           narc_find_contour(contours->ends, contours->count, at->other);
}

static void list_points(const narc_contours *contours, const narc_crossings *crossings, walk *out) {
    size_t next = 0;
    for (size_t k = 0, i = 0; k < contours->count; k++) {
        const size_t begin = out->count;
        for (; i < contours->ends[k]; i++) {
            out->points[out->count++] = contours->points[i];
            for (; next < crossings->count && crossings->items[next].line == i; next++) {
                const narc_crossing *at = &crossings->items[next];
                if (at->part > 0 && is_own(contours, at))
                    out->points[out->count++] = at->at;
            }
        }
        size_t kept = begin;
        for (size_t j = begin; j < out->count; j++)
            if (j == begin || memcmp(&out->points[j], &out->points[kept - 1], sizeof *out->points) != 0)
                out->points[kept++] = out->points[j];
        out->count = out->ends[k] = kept;
    }
}

static int compare_points(const void *left, const void *right) {
    const narc_point *a = *(const narc_point *const *)left, *b = *(const narc_point *const *)right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

static void number_places(walk *w, const narc_point **sorted) {
    for (size_t k = 0; k < w->count; k++)
        sorted[k] = &w->points[k];
    qsort(sorted, w->count, sizeof *sorted, compare_points);
    for (size_t k = 0, place = 0; k < w->count; k++) {
        place += k > 0 && compare_points(&sorted[k - 1], &sorted[k]) != 0;
        w->places[sorted[k] - w->points] = place;
    }
}

/* Walks all contours. `stack` has points of the loops that are open, `heights` of each place where it stands there, from
 * 1. The loops' points, in their order, come to `out_points`. */
static void take_loops(const walk *w, size_t *stack, size_t *heights, narc_contours *out) {
    for (size_t i = 0, k = 0; i < w->count; k++) {
        size_t height = 0;
        for (; i <= w->ends[k]; i++) {
            const bool is_end = i == w->ends[k];
            const size_t from = is_end ? 1 : heights[w->places[i]], begin = out->point_count;
            for (size_t j = from; from && j <= height; j++) {
                out->points[out->point_count++] = w->points[stack[j - 1]];
                heights[w->places[stack[j - 1]]] = 0;
            }
            if (out->point_count > begin)
                out->ends[out->count++] = out->point_count;
            height = from ? from - 1 : height;
            if (is_end)
                break;
            stack[height++] = i;
            heights[w->places[i]] = height;
        }
    }
}

narc_status narc_split_contours(const narc_contours *contours, narc_contours *out_loops, bool *out_crosses,
                                narc_error *error) {
    narc_crossings crossings;
    const narc_status status = narc_find_crossings(contours, true, 0, &crossings, error);
    if (status)
        return status;
    const size_t most = contours->point_count + crossings.count + 1;
    walk w = {.points = malloc(most * sizeof *w.points),
              .places = malloc(most * sizeof *w.places),
              .ends = malloc((contours->count + 1) * sizeof *w.ends)};
    const narc_point **sorted = malloc(most * sizeof *sorted);
    size_t *stack = malloc(most * sizeof *stack), *heights = calloc(most, sizeof *heights);
    narc_contours loops = {.points = malloc(most * sizeof *loops.points),
                           .ends = malloc(most * sizeof *loops.ends),
                           .flatness = contours->flatness};
    const bool done = w.points && w.places && w.ends && sorted && stack && heights && loops.points && loops.ends;
    if (done) {
        list_points(contours, &crossings, &w);
        number_places(&w, sorted);
        take_loops(&w, stack, heights, &loops);
        *out_crosses = crossings.count > 0;
        *out_loops = loops;
    } else {
        narc_release_contours(&loops);
    }
    free(crossings.items);
    free(w.points);
    free(w.places);
    free(w.ends);
    free(sorted);
    free(stack);
    free(heights);
    return done ? NARC_OK
                : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for an outline of %zu points",
                            contours->point_count);
}

/* ---------------------------------------------------------------------------- the area of what crosses */

/* A line that goes up or down, and where it is in the middle of a slab. */
typedef struct riser {
    narc_point low, high;
    double x;
    int way; /* 1: down, with the inside on its left, to the right of it */
} riser;

static int compare_numbers(const void *left, const void *right) {
    const double a = *(const double *)left, b = *(const double *)right;
    return (a > b) - (a < b);
}

static int compare_lows(const void *left, const void *right) {
    const riser *a = left, *b = right;
    return (a->low.y > b->low.y) - (a->low.y < b->low.y);
}

static int compare_places(const void *left, const void *right) {
    const riser *a = left, *b = right;
    return (a->x > b->x) - (a->x < b->x);
}

static size_t list_risers(const narc_region *region, riser *out) {
    size_t count = 0;
    for (size_t k = 0, begin = 0; k < region->count; begin = region->ends[k++])
        for (size_t i = begin; i < region->ends[k]; i++) {
            const narc_point p = region->points[i], q = region->points[i + 1 < region->ends[k] ? i + 1 : begin];
            if (p.y != q.y)
                out[count++] = p.y < q.y ? (riser){p, q, 0, -1} : (riser){q, p, 0, 1};
        }
    qsort(out, count, sizeof *out, compare_lows);
    return count;
}

/* Between heights where no line ends or crosses another one, trapezoids: where more contours go round than holes. */
static double add_slabs(const double *heights, size_t height_count, const riser *risers, size_t riser_count,
                        riser *active) {
    size_t next = 0, count = 0;
    double area = 0;
    for (size_t k = 0; k + 1 < height_count; k++) {
        const double low = heights[k], high = heights[k + 1], middle = low + (high - low) / 2;
        size_t kept = 0;
        for (; next < riser_count && risers[next].low.y <= low; next++)
            active[count++] = risers[next];
        for (size_t i = 0; i < count; i++)
            if (active[i].high.y > low)
                active[kept++] = active[i];
        count = kept;
        for (size_t i = 0; i < count; i++) {
            const narc_point a = active[i].low, side = minus(active[i].high, a);
            active[i].x = a.x + (middle - a.y) / side.y * side.x;
        }
        qsort(active, count, sizeof *active, compare_places);
        int winding = 0;
        for (size_t i = 0; i < count; i++) {
            area += winding > 0 ? (high - low) * (active[i].x - active[i - 1].x) : 0;
            winding += active[i].way;
        }
    }
    return area;
}

narc_status narc_measure_crossing(const narc_region *region, double *out_area, narc_error *error) {
    const narc_contours contours = {region->points, region->point_count, region->ends, region->count, 0};
    narc_crossings crossings;
    const narc_status status = narc_find_crossings(&contours, true, 0, &crossings, error);
    if (status)
        return status;
    size_t count = 0;
    double *heights = malloc((region->point_count + crossings.count) * sizeof *heights);
    riser *risers = malloc(region->point_count * sizeof *risers),
          *active = malloc(region->point_count * sizeof *active);
    const bool done = heights && risers && active;
    for (size_t k = 0; done && k < region->point_count; k++)
        heights[count++] = region->points[k].y;
    for (size_t k = 0; done && k < crossings.count; k++)
        heights[count++] = crossings.items[k].at.y;
    if (done) {
        qsort(heights, count, sizeof *heights, compare_numbers);
        *out_area = add_slabs(heights, count, risers, list_risers(region, risers), active);
    }
    free(crossings.items);
    free(heights);
    free(risers);
    free(active);
    return done ? NARC_OK : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for an outline's area");
}
