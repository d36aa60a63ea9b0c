/* SPDX-License-Identifier: MIT
 *
 * bounds.c - the paper's figure 2: the least circle, axis-aligned box, oriented box and polygon around an outline.
 */
#include <math.h>
#include <stdlib.h>

#include "draw_fit.h"
#include "fail.h"
#include "numbers.h"
#include "pictures.h"

const char *const bound_names[BOUNDS] = {"circle", "AABB", "OBB", "8-gon"};

enum { LAST = SIZES - 1 };

narc_fit_result find_disc(const subject *of) {
    const narc_fit_request request = {.arc_count = 1, .family = NARC_FIT_N_ARC, .goal = NARC_FIT_BOUND_AREA};
    narc_fit_result disc;
    narc_error error;
    if (narc_fit_path(of->path, &request, &disc, &error) != NARC_OK)
        fail("%s: %s", of->name, error.message);
    return disc;
}

/* The rectangle around a hull with a side along `x`, a unit vector, counter-clockwise; its area is returned. */
static double find_box(const hull *around, narc_point x, narc_point out_corners[4]) {
    const narc_point y = {-x.y, x.x};
    double least[2] = {INFINITY, INFINITY}, most[2] = {-INFINITY, -INFINITY};
    for (size_t k = 0; k < around->count; k++) {
        const double at[2] = {dot(around->corners[k], x), dot(around->corners[k], y)};
        for (int axis = 0; axis < 2; axis++) {
            least[axis] = fmin(least[axis], at[axis]);
            most[axis] = fmax(most[axis], at[axis]);
        }
    }
    for (int k = 0; k < 4; k++) {
        const double u = k == 1 || k == 2 ? most[0] : least[0], v = k >= 2 ? most[1] : least[1];
        out_corners[k] = (narc_point){u * x.x + v * y.x, u * x.y + v * y.y};
    }
    return (most[0] - least[0]) * (most[1] - least[1]);
}

/* The least rectangle around a polygon has a side along one of its sides (Freeman and Shapira 1975). */
static double find_oriented_box(const hull *around, narc_point out_corners[4]) {
    double least = INFINITY;
    for (size_t k = 0; k < around->count; k++) {
        narc_point corners[4];
        const double area = find_box(around, around->normals[k], corners);
        if (area < least) {
            least = area;
            for (int corner = 0; corner < 4; corner++)
                out_corners[corner] = corners[corner];
        }
    }
    return least;
}

void measure_bounds(const subject *of, double out_areas[BOUNDS]) {
    narc_point corners[4];
    const narc_fit_result disc = find_disc(of);
    out_areas[CIRCLE] = disc.area / disc.hull_area;
    out_areas[AABB] = find_box(&of->around, (narc_point){1, 0}, corners) / of->around.area;
    out_areas[OBB] = find_oriented_box(&of->around, corners) / of->around.area;
    out_areas[POLYGON] = area_of(of, N_GON, LAST);
}

/* ---------------------------------------------------------------------------- table */

static void print_bounds_of(const char *name, const double areas[BOUNDS], FILE *out) {
    fprintf(out, "| %s |", name);
    for (int which = 0; which < BOUNDS; which++)
        fprintf(out, " %.3f |", areas[which]);
    fputc('\n', out);
}

void print_bounds(const study *all, FILE *out) {
    numbers *values = allocate(BOUNDS, sizeof *values);
    for (int which = 0; which < BOUNDS; which++)
        values[which].count = 0;
    fprintf(out, "### Figure 2: areas of simple shapes, hull = 1\n\n| | circle | AABB | OBB | 8-gon |\n"
                 "| --- | ---: | ---: | ---: | ---: |\n");
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        double areas[BOUNDS];
        if (of->of == GRAINS || of->of == IMAGE)
            continue;
        measure_bounds(of, areas);
        for (int which = 0; which < BOUNDS; which++)
            add_number(&values[which], areas[which]);
        if (of->of == PAPER)
            print_bounds_of(of->name, areas, out);
    }
    double medians[BOUNDS];
    for (int which = 0; which < BOUNDS; which++)
        medians[which] = find_quantile(&values[which], 0.5);
    print_bounds_of("median of all outlines but the grains", medians, out);
    fputc('\n', out);
    free(values);
}

/* ---------------------------------------------------------------------------- picture */

static void draw_outline(canvas *page, const subject *of, const placement *where) {
    trace_contours(page, where, &of->contours);
    set_color(page, (color){0.867, 0.867, 0.867, 1});
    cairo_fill(page->pen);
}

/* A fitted shape over an outline that is placed. */
static void trace_fit(canvas *page, const narc_fit_result *made, const placement *outline) {
    const narc_point origin = place_point(outline, made->origin);
    const placement where = {origin.x, origin.y, outline->cosine, outline->sine};
    trace_arcs(page, &where, made->arcs, made->arc_count);
    cairo_close_path(page->pen);
}

static void trace_bound(canvas *page, const subject *of, bound which, const placement *where) {
    narc_point corners[4];
    const narc_fit_result disc = find_disc(of);
    switch (which) {
    case CIRCLE:
        trace_fit(page, &disc, where);
        break;
    case POLYGON:
        trace_fit(page, &of->fits[N_GON][LAST].made, where);
        break;
    case AABB:
        find_box(&of->around, (narc_point){1, 0}, corners);
        trace_points(page, where, corners, 4);
        break;
    default:
        find_oriented_box(&of->around, corners);
        trace_points(page, where, corners, 4);
    }
}

void draw_bounds(const subject *of, const char *path) {
    const double cell = 230, margin = 18, caption = 44, text = 18;
    double areas[BOUNDS];
    narc_point corners[4];
    canvas page;
    const narc_fit_result disc = find_disc(of);
    narc_aabb box = bound_fit(&disc);
    find_oriented_box(&of->around, corners);
    box = join_boxes(box, bound_points(corners, 4));
    box = join_boxes(box, bound_fit(&of->fits[N_GON][LAST].made));
    measure_bounds(of, areas);
    open_picture(&page, path, BOUNDS * (cell + 2 * margin), cell + 2 * margin + caption);
    for (bound which = CIRCLE; which < BOUNDS; which++) {
        const double left = (int)which * (cell + 2 * margin) + margin;
        const placement where = place_box(box, left, margin, cell, cell);
        char label[64];
        draw_outline(&page, of, &where);
        trace_bound(&page, of, which, &where);
        stroke_path(&page, ARC_TONES[0], 3);
        snprintf(label, sizeof label, "%s: %.3f", bound_names[which], areas[which]);
        draw_text(&page, label, left + cell / 2, margin + cell + 1.7 * text, text, cell);
    }
    finish_picture(&page);
}
