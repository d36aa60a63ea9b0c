/* SPDX-License-Identifier: MIT
 *
 * picture_fits.c - one cell for each fit: the outline filled, its convex hull thin and dashed, the shape on top with
 * arcs in two tones, straight edges in a third and dots at its junctions; a legend below.
 */
#include "picture_fits.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "canvas.h"
#include "fail.h"
#include "progress.h"

/* In pixels; a page with many fits has smaller cells. */
static const double CELL = 440, LARGEST_PAGE = 3000;

/* In cells. */
static const double PADDING = 0.09, CAPTION_HEIGHT = 0.19, LEGEND_HEIGHT = 0.15, NARROWEST_PAGE = 1.4;
static const double LINE = 0.009, THIN_LINE = 0.004, DOT = 0.012, TEXT = 0.05, SMALL_TEXT = 0.036;

/* An edge is drawn, and has a dot at each end, if it is longer than this. */
static const double SHORTEST_EDGE = 1e-3;

static const color OUTLINE_FILL = {0.90, 0.915, 0.93, 1}, OUTLINE_LINE = {0.72, 0.75, 0.79, 1};
static const color POINT = {0.60, 0.63, 0.68, 1}, HULL_LINE = {0.36, 0.39, 0.44, 1};
static const color TONES[2] = {{0.09, 0.34, 0.66, 1}, {0.90, 0.42, 0.08, 1}}, EDGE_LINE = {0.10, 0.55, 0.36, 1};
static const color INK = {0.12, 0.14, 0.18, 1}, WHITE = {1, 1, 1, 1};

/* What is drawn of one outline, relative to its shape's origin. */
typedef struct drawing {
    narc_contours contours;
    narc_point *hull;
    size_t hull_count;
} drawing;

/* ---------------------------------------------------------------------------- geometry */

static int compare_points(const void *left, const void *right) {
    const narc_point *a = left, *b = right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

/* Adds p to a chain of corners that all turn left; those that no longer do are dropped, but none below `keep`. */
static size_t extend_chain(narc_point *chain, size_t length, size_t keep, narc_point p) {
    while (length > keep) {
        const narc_point a = chain[length - 2], b = chain[length - 1];
        if ((b.x - a.x) * (p.y - b.y) - (b.y - a.y) * (p.x - b.x) > 0) {
            break;
        }
        length--;
    }
    chain[length] = p;
    return length + 1;
}

/* The convex hull: lower chain from left to right, upper chain back (Andrew 1979). `out_hull` has room for `count` + 1
 * points. */
static size_t find_hull(const narc_point *points, size_t count, narc_point *out_hull) {
    narc_point *sorted = memcpy(allocate(count, sizeof *sorted), points, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, compare_points);
    size_t length = 0;
    for (size_t i = 0; i < count; i++) {
        length = extend_chain(out_hull, length, 1, sorted[i]);
    }
    const size_t lower = length;
    for (size_t i = count - 1; i-- > 0;) {
        length = extend_chain(out_hull, length, lower, sorted[i]);
    }
    free(sorted);
    return length - 1;
}

static drawing make_drawing(const outline *of, narc_point origin) {
    drawing made;
    narc_error error;
    if (narc_flatten_path(of->path, 0, &made.contours, &error) != NARC_OK) {
        fail_outline(of, error.message);
    }
    for (size_t i = 0; i < made.contours.point_count; i++) {
        made.contours.points[i].x -= origin.x;
        made.contours.points[i].y -= origin.y;
    }
    made.hull = allocate(made.contours.point_count + 1, sizeof *made.hull);
    made.hull_count = find_hull(made.contours.points, made.contours.point_count, made.hull);
    return made;
}

static void free_drawing(drawing *made) {
    narc_release_contours(&made->contours);
    free(made->hull);
}

/* A box around hull and shape. */
static narc_aabb bound_drawing(const drawing *of, const narc_fit_result *fit) {
    narc_aabb box;
    narc_compute_aabb(fit->arcs, fit->arc_count, 0, &box);
    for (size_t i = 0; i < of->hull_count; i++) {
        const narc_point p = of->hull[i];
        box = (narc_aabb){fmin(box.min_x, p.x), fmin(box.min_y, p.y), fmax(box.max_x, p.x), fmax(box.max_y, p.y)};
    }
    return box;
}

/* The outline's point of an arc in the direction `angle`, on the page. */
static narc_point place_on_arc(const placement *where, const narc_arc *arc, double angle) {
    return place_point(
        where, (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)});
}

/* ---------------------------------------------------------------------------- cells */

static void trace_points(canvas *page, const placement *where, const narc_point *points, size_t count) {
    cairo_new_sub_path(page->pen);
    for (size_t i = 0; i < count; i++) {
        const narc_point p = place_point(where, points[i]);
        cairo_line_to(page->pen, p.x, p.y);
    }
    cairo_close_path(page->pen);
}

static void stroke(canvas *page, color line, double width) {
    set_color(page, line);
    cairo_set_line_width(page->pen, width);
    cairo_stroke(page->pen);
}

static void stroke_hull(canvas *page, double cell) {
    const double dashes[] = {0.016 * cell, 0.014 * cell};
    cairo_set_dash(page->pen, dashes, 2, 0);
    stroke(page, HULL_LINE, THIN_LINE * cell);
    cairo_set_dash(page->pen, NULL, 0, 0);
}

static void draw_junction(canvas *page, narc_point p, double cell) {
    set_color(page, INK);
    draw_dot(page, p, DOT * cell);
    set_color(page, WHITE);
    draw_dot(page, p, 0.55 * DOT * cell);
}

/* The outline filled; points in no order as dots. */
static void draw_outline(canvas *page, const placement *where, const outline *of, const narc_contours *contours,
                         double cell) {
    if (of->cloud) {
        set_color(page, POINT);
        for (size_t i = 0; i < contours->point_count; i++) {
            draw_dot(page, place_point(where, contours->points[i]), THIN_LINE * cell);
        }
        return;
    }
    size_t start = 0;
    for (size_t k = 0; k < contours->count; start = contours->ends[k++]) {
        trace_points(page, where, contours->points + start, contours->ends[k] - start);
    }
    paint_path(page, OUTLINE_FILL, OUTLINE_LINE, THIN_LINE * cell);
}

/* Arcs and edges first, then the dots on them. */
static void draw_shape(canvas *page, const placement *where, const narc_fit_result *fit, double cell) {
    for (int dots = 0; dots < 2; dots++) {
        for (size_t i = 0; i < fit->arc_count; i++) {
            const narc_arc *arc = &fit->arcs[i], *next = &fit->arcs[(i + 1) % fit->arc_count];
            const narc_point start = place_on_arc(where, arc, arc->start), end = place_on_arc(where, arc, arc->end);
            const narc_point behind = place_on_arc(where, next, next->start);
            const bool has_edge = hypot(behind.x - end.x, behind.y - end.y) > SHORTEST_EDGE * cell;
            if (dots) {
                draw_junction(page, start, cell);
                if (has_edge && arc->radius > 0) {
                    draw_junction(page, end, cell);
                }
                continue;
            }
            trace_arcs(page, where, arc, 1);
            stroke(page, TONES[i % 2], LINE * cell);
            if (has_edge) {
                cairo_move_to(page->pen, end.x, end.y);
                cairo_line_to(page->pen, behind.x, behind.y);
                stroke(page, EDGE_LINE, LINE * cell);
            }
        }
    }
}

/* Text with its middle at x and its baseline at y, made smaller if it is wider than `widest`. */
static void draw_text(canvas *page, const char *text, double x, double y, double size, double widest) {
    cairo_text_extents_t extents;
    set_color(page, INK);
    cairo_set_font_size(page->pen, size);
    cairo_text_extents(page->pen, text, &extents);
    if (extents.x_advance > widest) {
        cairo_set_font_size(page->pen, size * widest / extents.x_advance);
        cairo_text_extents(page->pen, text, &extents);
    }
    cairo_move_to(page->pen, x - extents.x_advance / 2, y);
    cairo_show_text(page->pen, text);
}

static void draw_caption(canvas *page, const char *name, const narc_fit_result *fit, double x, double y, double cell) {
    char edges[48] = "", text[128];
    if (fit->edge_count) {
        snprintf(edges, sizeof edges, ", %zu edge%s", fit->edge_count, fit->edge_count == 1 ? "" : "s");
    }
    snprintf(text, sizeof text, "%zu arc%s%s, %.4f of the hull's area", fit->arc_count, fit->arc_count == 1 ? "" : "s",
             edges, fit->area / fit->hull_area);
    draw_text(page, name, x, y + 0.35 * CAPTION_HEIGHT * cell, TEXT * cell, 0.95 * cell);
    draw_text(page, text, x, y + 0.65 * CAPTION_HEIGHT * cell, SMALL_TEXT * cell, 0.95 * cell);
}

static void draw_cell(canvas *page, const outline *of, const narc_fit_result *fit, double left, double top,
                      double cell) {
    drawing drawn = make_drawing(of, fit->origin);
    const narc_aabb box = bound_drawing(&drawn, fit);
    const double size = cell * (1 - 2 * PADDING) / fmax(box.max_x - box.min_x, box.max_y - box.min_y);
    const placement where = {.origin_x = left + cell / 2 - size * (box.min_x + box.max_x) / 2,
                             .origin_y = top + cell / 2 + size * (box.min_y + box.max_y) / 2,
                             .cosine = size,
                             .sine = 0};
    draw_outline(page, &where, of, &drawn.contours, cell);
    trace_points(page, &where, drawn.hull, drawn.hull_count);
    stroke_hull(page, cell);
    draw_shape(page, &where, fit, cell);
    draw_caption(page, of->name, fit, left + cell / 2, top + cell, cell);
    free_drawing(&drawn);
}

/* ---------------------------------------------------------------------------- legend */

typedef enum sample { OUTLINE, CLOUD, HULL, ARCS, EDGES, SAMPLE_COUNT } sample;
static const char *const words[SAMPLE_COUNT] = {"outline", "points", "convex hull", "arcs", "straight edges"};

/* In cells: half a sample's width, the gaps behind a sample and behind a word. */
static const double HALF_SAMPLE = 0.045, SAMPLE_GAP = 0.02, WORD_GAP = 0.07;

static void draw_sample(canvas *page, sample of, double x, double y, double cell) {
    const double half = HALF_SAMPLE * cell;
    if (of == CLOUD) {
        set_color(page, POINT);
        for (int k = -1; k <= 1; k++) {
            draw_dot(page, (narc_point){x + 0.6 * k * half, y}, THIN_LINE * cell);
        }
    } else if (of == OUTLINE) {
        cairo_rectangle(page->pen, x - half, y - 0.4 * half, 2 * half, 0.8 * half);
        paint_path(page, OUTLINE_FILL, OUTLINE_LINE, THIN_LINE * cell);
    } else if (of == ARCS) {
        for (int tone = 0; tone < 2; tone++) {
            cairo_move_to(page->pen, tone ? x : x - half, y);
            cairo_line_to(page->pen, tone ? x + half : x, y);
            stroke(page, TONES[tone], LINE * cell);
        }
        draw_junction(page, (narc_point){x, y}, cell);
    } else {
        cairo_move_to(page->pen, x - half, y);
        cairo_line_to(page->pen, x + half, y);
        if (of == HULL) {
            stroke_hull(page, cell);
        } else {
            stroke(page, EDGE_LINE, LINE * cell);
        }
    }
}

/* Samples of what the page shows with a word each, in one line around the middle of the page. */
static void draw_legend(canvas *page, const bool *shown, double middle, double y, double cell) {
    double widths[SAMPLE_COUNT] = {0}, width = -WORD_GAP * cell;
    cairo_set_font_size(page->pen, SMALL_TEXT * cell);
    for (int k = 0; k < SAMPLE_COUNT; k++) {
        cairo_text_extents_t extents;
        cairo_text_extents(page->pen, words[k], &extents);
        widths[k] = extents.x_advance;
        width += shown[k] ? widths[k] + (2 * HALF_SAMPLE + SAMPLE_GAP + WORD_GAP) * cell : 0;
    }
    double x = middle - width / 2;
    for (int k = 0; k < SAMPLE_COUNT; k++) {
        if (shown[k]) {
            draw_sample(page, (sample)k, x + HALF_SAMPLE * cell, y, cell);
            x += (2 * HALF_SAMPLE + SAMPLE_GAP) * cell;
            draw_text(page, words[k], x + widths[k] / 2, y + 0.3 * SMALL_TEXT * cell, SMALL_TEXT * cell, widths[k]);
            x += widths[k] + WORD_GAP * cell;
        }
    }
}

void draw_fits(const char *path, FILE *file, const outline_list *outlines, const narc_fit_result *fits) {
    const size_t count = outlines->count, columns = count <= 5 ? count : (size_t)ceil(sqrt(1.5 * (double)count));
    const size_t rows = (count + columns - 1) / columns;
    const double width = fmax((double)columns, NARROWEST_PAGE);
    const double height = (double)rows * (1 + CAPTION_HEIGHT) + LEGEND_HEIGHT;
    const double cell = fmin(CELL, LARGEST_PAGE / fmax(width, height));
    const double left = cell * (width - (double)columns) / 2;
    canvas page;
    open_canvas(&page, path, file, cell * width, cell * height);
    cairo_select_font_face(page.pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    bool shown[SAMPLE_COUNT] = {[HULL] = true};
    for (size_t i = 0; i < count; i++) {
        draw_cell(&page, &outlines->items[i], &fits[i], left + cell * (double)(i % columns),
                  cell * (1 + CAPTION_HEIGHT) * (double)(i / columns), cell);
        shown[outlines->items[i].cloud ? CLOUD : OUTLINE] = true;
        shown[EDGES] = shown[EDGES] || fits[i].edge_count > 0;
        for (size_t k = 0; k < fits[i].arc_count; k++) {
            shown[ARCS] = shown[ARCS] || fits[i].arcs[k].radius > 0;
        }
        show_progress("drawing", i, count);
    }
    draw_legend(&page, shown, cell * width / 2, cell * (height - LEGEND_HEIGHT / 2), cell);
    finish_canvas(&page);
}
