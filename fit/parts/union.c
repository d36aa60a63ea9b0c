/* SPDX-License-Identifier: MIT
 *
 * union.c - the area that shapes cover together.
 */
#include <stdlib.h>

#include "error.h"
#include "narc_fit.h"
#include "outline/vector.h"

/* Lines across, in whose middle the union is measured, and chords of each arc. */
enum { LINES = 4096, CHORDS = 64 };

typedef struct interval {
    double left, right;
} interval;

static int compare_intervals(const void *left, const void *right) {
    const interval *a = left, *b = right;
    return (a->left > b->left) - (a->left < b->left);
}

static void widen_by_line(interval *lines, narc_aabb box, narc_point a, narc_point b) {
    const double height = (box.max_y - box.min_y) / LINES, low = fmin(a.y, b.y), high = fmax(a.y, b.y);
    for (double k = fmax(0, ceil((low - box.min_y) / height - 0.5)); k < LINES; k++) {
        const double y = box.min_y + (k + 0.5) * height;
        if (y >= high)
            break;
        const double x = a.x + (y - a.y) / (b.y - a.y) * (b.x - a.x);
        interval *at = &lines[(size_t)k];
        *at = (interval){fmin(at->left, x), fmax(at->right, x)};
    }
}

/* Where each line crosses a shape, whose arcs are chords. */
static void cross_shape(const narc_fit_result *fit, narc_aabb box, interval *out_lines) {
    for (size_t k = 0; k < LINES; k++)
        out_lines[k] = (interval){INFINITY, -INFINITY};
    narc_point before = {0, 0};
    for (size_t k = 0; k <= fit->arc_count; k++) {
        const narc_arc *arc = &fit->arcs[k % fit->arc_count];
        const int chords = k == fit->arc_count || arc->radius == 0 ? 0 : CHORDS;
        for (int i = 0; i <= chords; i++) {
            const narc_point n = unit_at(arc->start + (arc->end - arc->start) * i / CHORDS);
            const narc_point p = {fit->origin.x + arc->center_x + arc->radius * n.x,
                                  fit->origin.y + arc->center_y + arc->radius * n.y};
            if (k || i)
                widen_by_line(out_lines, box, before, p);
            before = p;
        }
    }
}

static double cover_line(interval *crossed, size_t count) {
    double covered = 0, reach = -INFINITY;
    qsort(crossed, count, sizeof *crossed, compare_intervals);
    for (size_t k = 0; k < count; k++) {
        if (crossed[k].right > reach && crossed[k].left < crossed[k].right) {
            covered += crossed[k].right - fmax(reach, crossed[k].left);
            reach = crossed[k].right;
        }
    }
    return covered;
}

narc_status narc_measure_union(const narc_fit_result *fits, size_t count, double *out_area, narc_error *error) {
    if ((!fits && count) || !out_area)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", out_area ? "fits" : "out_area");
    narc_aabb box = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    for (size_t k = 0; k < count; k++) {
        narc_aabb one;
        narc_compute_aabb(fits[k].arcs, fits[k].arc_count, 0, &one);
        box.min_y = fmin(box.min_y, one.min_y + fits[k].origin.y);
        box.max_y = fmax(box.max_y, one.max_y + fits[k].origin.y);
    }
    interval *lines = malloc((count + 1) * LINES * sizeof *lines), *crossed = malloc((count + 1) * sizeof *crossed);
    double sum = 0;
    for (size_t k = 0; k < count && lines && crossed; k++)
        cross_shape(&fits[k], box, lines + k * LINES);
    for (size_t line = 0; line < LINES && lines && crossed && count; line++) {
        for (size_t k = 0; k < count; k++)
            crossed[k] = lines[k * LINES + line];
        sum += cover_line(crossed, count);
    }
    free(crossed);
    free(lines);
    if (!lines || !crossed)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "not enough memory for %zu shapes", count);
    *out_area = count ? sum * (box.max_y - box.min_y) / LINES : 0;
    return NARC_OK;
}
