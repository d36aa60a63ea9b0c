/* SPDX-License-Identifier: MIT
 *
 * picture_fits.c - one cell for each fit: the outline filled, its convex hull thin and dashed, on top the shape or the
 * chains of arcs, with its junctions and corners; a legend below.
 */
#include "picture_fits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "chains.h"
#include "draw_fit.h"
#include "fail.h"
#include "legend.h"
#include "progress.h"

/* In pixels; a page with many fits has smaller cells. */
static const double CELL = 440, LARGEST_PAGE = 3000;

/* In cells. */
static const double PADDING = 0.09, CAPTION_HEIGHT = 0.19, LEGEND_HEIGHT = 0.15, NARROWEST_PAGE = 1.4;
static const double LINE = 0.009, THIN_LINE = 0.004, DOT = 0.012, TEXT = 0.05, SMALL_TEXT = 0.036;

/* Half the width of a sample in the legend, in cells. */
static const double HALF_SAMPLE = 0.045;

/* Parts overlap: their fills are thin. */
static const color PART_FILLS[] = {
    {0.09, 0.34, 0.66, 0.16}, {0.90, 0.42, 0.08, 0.16}, {0.55, 0.20, 0.58, 0.16}, {0.10, 0.55, 0.36, 0.16}};
enum { PART_COLORS = sizeof PART_FILLS / sizeof PART_FILLS[0] };

/* Chains and parts have many arcs: their lines and dots are thinner by this. */
static const double CHAIN_LINES = 0.5;

/* Edges are drawn, and arcs no corners, if they are longer than this. */
static const double SHORTEST = 1e-3;

static const color OUTLINE_FILL = {0.90, 0.915, 0.93, 1}, OUTLINE_LINE = {0.72, 0.75, 0.79, 1};
static const color HULL_LINE = {0.36, 0.39, 0.44, 1};

typedef enum sample { OUTLINE, HULL, ARCS, EDGES, CORNERS, SAMPLE_COUNT } sample;
static const char *const words[SAMPLE_COUNT] = {"outline", "convex hull", "arcs", "straight edges", "corners"};

/* What is drawn of one outline. */
typedef struct drawing {
    narc_contours contours;
    narc_point *corners; /* of the hull */
    size_t corner_count;
} drawing;

/* A chain and parts need no hull: its outline may lie on a line. */
static drawing make_drawing(const outline *of, bool has_hull) {
    drawing made;
    narc_error error;
    if (narc_flatten_path(of->path, 0, &made.contours, &error) != NARC_OK)
        fail_at(of->file, 0, "%s", error.message);
    made.corners = allocate(made.contours.point_count, sizeof *made.corners);
    made.corner_count = 0;
    if (has_hull && narc_compute_hull(made.contours.points, made.contours.point_count, made.corners, &made.corner_count,
                                      &error) != NARC_OK)
        fail_at(of->file, 0, "%s", error.message);
    return made;
}

static void free_drawing(drawing *made) {
    narc_release_contours(&made->contours);
    free(made->corners);
}

/* ---------------------------------------------------------------------------- cells */

static void stroke_hull(canvas *page, double cell) {
    const double dashes[] = {0.016 * cell, 0.014 * cell};
    cairo_set_dash(page->pen, dashes, 2, 0);
    stroke_path(page, HULL_LINE, THIN_LINE * cell);
    cairo_set_dash(page->pen, NULL, 0, 0);
}

static void draw_outline(canvas *page, const placement *where, const narc_contours *contours, double cell) {
    trace_contours(page, where, contours);
    cairo_set_fill_rule(page->pen, CAIRO_FILL_RULE_EVEN_ODD);
    paint_path(page, OUTLINE_FILL, OUTLINE_LINE, THIN_LINE * cell);
    cairo_set_fill_rule(page->pen, CAIRO_FILL_RULE_WINDING);
}

/* "3 arcs", "1 arc"; nothing of none. */
static void append_count(char *text, size_t size, size_t count, const char *thing) {
    const size_t used = strlen(text);
    if (count > 0)
        snprintf(text + used, size - used, "%s%zu %s%s", used ? ", " : "", count, thing, count == 1 ? "" : "s");
}

static void draw_caption(canvas *page, const char *name, const char *text, double x, double y, double cell) {
    draw_text(page, name, x, y + 0.35 * CAPTION_HEIGHT * cell, TEXT * cell, 0.95 * cell);
    draw_text(page, text, x, y + 0.65 * CAPTION_HEIGHT * cell, SMALL_TEXT * cell, 0.95 * cell);
}

/* The outline's hull and the shape around it, or the shapes of its parts, each filled a little. */
static void draw_collider(canvas *page, const placement *where, const drawing *drawn, const collider *fits, double cell,
                          const fit_look *look, bool *shown) {
    const bool has_hull = drawn->corner_count > 0;
    if (has_hull) {
        trace_points(page, where, drawn->corners, drawn->corner_count);
        stroke_hull(page, cell);
    }
    for (size_t i = 0; i < fits->count && !has_hull; i++)
        fill_fit(page, where, &fits->fits[i], PART_FILLS[i % PART_COLORS]);
    for (size_t i = 0; i < fits->count; i++) {
        const narc_fit_result *fit = &fits->fits[i];
        draw_fit(page, where, fit, look);
        shown[HULL] = shown[HULL] || has_hull;
        shown[EDGES] = shown[EDGES] || fit->edge_count > 0;
        for (size_t k = 0; k < fit->arc_count; k++)
            shown[is_corner(where, &fit->arcs[k], look) ? CORNERS : ARCS] = true;
    }
}

static void describe_collider(const collider *fits, char *text, size_t size) {
    size_t arcs = 0, edges = 0;
    for (size_t i = 0; i < fits->count; i++) {
        arcs += fits->fits[i].arc_count;
        edges += fits->fits[i].edge_count;
    }
    if (fits->outline_area > 0)
        append_count(text, size, fits->count, "part");
    append_count(text, size, arcs, "arc");
    append_count(text, size, edges, "edge");
    const size_t used = strlen(text);
    if (fits->outline_area > 0)
        snprintf(text + used, size - used, ", %.4f of the outline's area", fits->area / fits->outline_area);
    else
        snprintf(text + used, size - used, ", %.4f of the hull's area", fits->fits->area / fits->fits->hull_area);
}

/* One of `fits` and `chains` is NULL. Notes what the legend has to explain. */
static void draw_cell(canvas *page, const outline *of, const collider *fits, const narc_arc_chains *chains, double left,
                      double top, double cell, bool *shown) {
    fit_look look = {.line = LINE * cell, .dot = DOT * cell, .shortest = SHORTEST * cell};
    drawing drawn = make_drawing(of, fits && fits->outline_area == 0);
    narc_aabb box = bound_points(drawn.contours.points, drawn.contours.point_count);
    for (size_t i = 0; fits && i < fits->count; i++)
        box = join_boxes(box, bound_fit(&fits->fits[i]));
    const double inner = cell * (1 - 2 * PADDING);
    const placement where = place_box(box, left + PADDING * cell, top + PADDING * cell, inner, inner);
    char text[128] = "";
    draw_outline(page, &where, &drawn.contours, cell);
    shown[OUTLINE] = true;
    if (chains || fits->count > 1) {
        look.line *= CHAIN_LINES;
        look.dot *= CHAIN_LINES;
    }
    if (fits) {
        draw_collider(page, &where, &drawn, fits, cell, &look, shown);
        describe_collider(fits, text, sizeof text);
    } else {
        draw_chains(page, &where, chains, &look);
        const size_t curved = count_curved(chains);
        shown[ARCS] = shown[ARCS] || curved > 0;
        shown[EDGES] = shown[EDGES] || curved < chains->arc_count;
        append_count(text, sizeof text, curved, "arc");
        append_count(text, sizeof text, chains->arc_count - curved, "line");
    }
    draw_caption(page, of->name, text, left + cell / 2, top + cell, cell);
    free_drawing(&drawn);
}

/* ---------------------------------------------------------------------------- legend */

static void draw_sample_of(canvas *page, int of, double x, double y, double half) {
    const double cell = half / HALF_SAMPLE;
    if (of == OUTLINE) {
        cairo_rectangle(page->pen, x - half, y - 0.4 * half, 2 * half, 0.8 * half);
        paint_path(page, OUTLINE_FILL, OUTLINE_LINE, THIN_LINE * cell);
    } else if (of == ARCS) {
        for (int tone = 0; tone < 2; tone++) {
            cairo_move_to(page->pen, tone ? x : x - half, y);
            cairo_line_to(page->pen, tone ? x + half : x, y);
            stroke_path(page, ARC_TONES[tone], LINE * cell);
        }
        draw_junction(page, (narc_point){x, y}, DOT * cell);
    } else if (of == CORNERS) {
        draw_corner(page, (narc_point){x, y}, DOT * cell);
    } else {
        cairo_move_to(page->pen, x - half, y);
        cairo_line_to(page->pen, x + half, y);
        if (of == HULL)
            stroke_hull(page, cell);
        else
            stroke_path(page, EDGE_TONE, LINE * cell);
    }
}

void draw_fits(const char *path, FILE *file, const outline_list *outlines, const collider *fits,
               const narc_arc_chains *chains) {
    const size_t count = outlines->count, columns = count <= 5 ? count : (size_t)ceil(sqrt(1.5 * (double)count));
    const size_t rows = (count + columns - 1) / columns;
    const double width = fmax((double)columns, NARROWEST_PAGE);
    const double height = (double)rows * (1 + CAPTION_HEIGHT) + LEGEND_HEIGHT;
    const double cell = fmin(CELL, LARGEST_PAGE / fmax(width, height));
    const double left = cell * (width - (double)columns) / 2;
    canvas page;
    open_canvas(&page, path, file, cell * width, cell * height);
    bool shown[SAMPLE_COUNT] = {false};
    for (size_t i = 0; i < count; i++) {
        draw_cell(&page, &outlines->items[i], fits ? &fits[i] : NULL, chains ? &chains[i] : NULL,
                  left + cell * (double)(i % columns), cell * (1 + CAPTION_HEIGHT) * (double)(i / columns), cell,
                  shown);
        show_progress("drawing", i, count);
    }
    draw_legend(&page, words, shown, SAMPLE_COUNT, draw_sample_of, cell * width / 2,
                cell * (height - LEGEND_HEIGHT / 2), SMALL_TEXT * cell, cell * (width - PADDING));
    finish_canvas(&page);
}
