/* SPDX-License-Identifier: MIT
 *
 * loops.c - contours that cross or touch themselves as loops that do not, and the area of contours that cross.
 *
 * Where two lines of a contour cross each is followed by the other one's rest: so they no longer cross, but touch, and
 * what was one contour is loops. The same is done where a contour comes to a point again, if that makes two loops of one.
 * What is walked there and back is a loop without an area.
 */
#include <stdlib.h>

#include "error.h"
#include "outline/crossings.h"
#include "outline/path.h"
#include "outline/vector.h"
#include "parts/region.h"

/* A point of a contour, or one where its group crosses itself, and which follows. */
typedef struct step {
    narc_point at;
    size_t group, next;
    bool crosses, taken;
} step;

/* The number of a contour, or of the group that it is in. */
static size_t find_group(const narc_contours *contours, const size_t *groups, size_t point) {
    const size_t contour = narc_find_contour(contours->ends, contours->count, point);
    return groups ? groups[contour] : contour;
}

static size_t add_step(step *steps, size_t count, narc_point at, size_t group, bool crosses) {
    steps[count] = (step){at, group, count + 1, crosses, false};
    return count + 1;
}

static size_t list_steps(const narc_contours *contours, const size_t *groups, const narc_crossings *crossings,
                         step *out) {
    size_t count = 0;
    for (size_t k = 0, i = 0, next = 0; k < contours->count; k++) {
        const size_t begin = count, group = groups ? groups[k] : k;
        for (; i < contours->ends[k]; i++) {
            if (count == begin || !is_same(contours->points[i], out[count - 1].at))
                count = add_step(out, count, contours->points[i], group, false);
            for (; next < crossings->count && crossings->items[next].line == i; next++) {
                const narc_crossing *at = &crossings->items[next];
                if (at->part > 0 && find_group(contours, groups, at->other) == group &&
                    !is_same(at->at, out[count - 1].at))
                    count = add_step(out, count, at->at, group, at->crosses);
            }
        }
        out[count - 1].next = begin;
    }
    return count;
}

static int compare_steps(const void *left, const void *right) {
    const step *a = *(step *const *)left, *b = *(step *const *)right;
    return a->at.x != b->at.x   ? (a->at.x > b->at.x) - (a->at.x < b->at.x)
           : a->at.y != b->at.y ? (a->at.y > b->at.y) - (a->at.y < b->at.y)
                                : (a > b) - (a < b);
}

static bool is_in_loop(const step *steps, size_t a, size_t b) {
    size_t k = steps[a].next;
    while (k != a && k != b)
        k = steps[k].next;
    return k == b;
}

/* Where a contour comes again to a point, the ways on from there change places. */
static void link_steps(step *steps, size_t count, step **sorted) {
    for (size_t k = 0; k < count; k++)
        sorted[k] = &steps[k];
    qsort(sorted, count, sizeof *sorted, compare_steps);
    for (size_t k = 1; k < count; k++) {
        step *a = sorted[k - 1], *b = sorted[k];
        if (is_same(a->at, b->at) && a->group == b->group &&
            ((a->crosses && b->crosses) || is_in_loop(steps, (size_t)(a - steps), (size_t)(b - steps)))) {
            const size_t next = a->next;
            a->next = b->next;
            b->next = next;
        }
    }
}

static void take_loops(step *steps, size_t count, narc_contours *out) {
    for (size_t k = 0; k < count; k++) {
        for (size_t i = k; !steps[i].taken; i = steps[i].next) {
            steps[i].taken = true;
            out->points[out->point_count++] = steps[i].at;
        }
        if (out->point_count > (out->count ? out->ends[out->count - 1] : 0))
            out->ends[out->count++] = out->point_count;
    }
}

static narc_status split_groups(const narc_contours *contours, const size_t *groups, const narc_crossings *crossings,
                                narc_contours *out_loops, narc_error *error) {
    const size_t most = contours->point_count + crossings->count + 1;
    step *steps = malloc(most * sizeof *steps), **sorted = malloc(most * sizeof *sorted);
    narc_contours loops = {.points = malloc(most * sizeof *loops.points),
                           .ends = malloc(most * sizeof *loops.ends),
                           .flatness = contours->flatness};
    const bool done = steps && sorted && loops.points && loops.ends;
    if (done) {
        const size_t count = list_steps(contours, groups, crossings, steps);
        link_steps(steps, count, sorted);
        take_loops(steps, count, &loops);
        *out_loops = loops;
    } else {
        narc_release_contours(&loops);
    }
    free(steps);
    free(sorted);
    return done ? NARC_OK
                : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for an outline of %zu points",
                            contours->point_count);
}

narc_status narc_split_contours(const narc_contours *contours, narc_contours *out_loops, bool *out_crosses,
                                narc_error *error) {
    narc_crossings crossings;
    narc_status status = narc_find_crossings(contours, true, 0, &crossings, error);
    if (status)
        return status;
    status = split_groups(contours, NULL, &crossings, out_loops, error);
    *out_crosses = crossings.count > 0;
    free(crossings.items);
    return status;
}

/* Holes that cross get the number of the first of them. */
static bool join_holes(const narc_region *region, const narc_crossings *crossings, size_t *groups) {
    bool any = false;
    for (size_t k = 0; k < region->count; k++)
        groups[k] = k;
    for (size_t i = 0; i < crossings->count; i++) {
        const size_t a = narc_find_contour(region->ends, region->count, crossings->items[i].line);
        const size_t b = narc_find_contour(region->ends, region->count, crossings->items[i].other);
        const size_t low = groups[a] < groups[b] ? groups[a] : groups[b], high = groups[a] + groups[b] - low;
        if (a == b || !crossings->items[i].crosses || region->parents[a] == SIZE_MAX || region->parents[b] == SIZE_MAX)
            continue;
        any = true;
        for (size_t k = 0; k < region->count; k++)
            groups[k] = groups[k] == high ? low : groups[k];
    }
    return any;
}

narc_status narc_split_holes(const narc_region *region, narc_contours *out_loops, narc_error *error) {
    const narc_contours contours = {region->points, region->point_count, region->ends, region->count, 0};
    narc_crossings crossings = {0};
    size_t *groups = malloc(region->count * sizeof *groups);
    narc_status status = groups ? narc_find_crossings(&contours, true, 0, &crossings, error)
                                : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for the holes");
    *out_loops = (narc_contours){0};
    if (!status && join_holes(region, &crossings, groups))
        status = split_groups(&contours, groups, &crossings, out_loops, error);
    free(crossings.items);
    free(groups);
    return status;
}

/* ---------------------------------------------------------------------------- the area of what crosses */

/* A line that goes up or down, and where it is in the middle of a slab. */
typedef struct riser {
    narc_point low, high;
    double x;
    int way; /* 1: down, with the inside on its left, to the right of it */
} riser;

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
