/* SPDX-License-Identifier: MIT
 *
 * picture_glyphs.c - one cell for each glyph: its outline filled, the polygon dashed (around the glyph, if the glyph's
 * hull has enough corners), the n-arc on top with arcs in two tones and dots at its junctions; a legend below.
 */
#include "picture_glyphs.h"

#include <math.h>
#include <string.h>

#include "canvas.h"
#include "progress.h"

/* In pixels; a page with many glyphs has smaller cells. */
static const double CELL = 440, LARGEST_PAGE = 3000;

/* In cells. */
static const double PADDING = 0.09, NAME_HEIGHT = 0.13, LEGEND_HEIGHT = 0.16;
static const double LINE = 0.009, THIN_LINE = 0.004, DOT = 0.013, TEXT = 0.05, SMALL_TEXT = 0.036;

static const color GLYPH_FILL = {0.90, 0.915, 0.93, 1}, GLYPH_LINE = {0.72, 0.75, 0.79, 1};
static const color POLYGON_LINE = {0.45, 0.48, 0.53, 1};
static const color TONES[2] = {{0.09, 0.34, 0.66, 1}, {0.90, 0.42, 0.08, 1}};
static const color INK = {0.12, 0.14, 0.18, 1}, WHITE = {1, 1, 1, 1};

static void include_point(narc_aabb *box, narc_point p) {
    *box = (narc_aabb){fmin(box->min_x, p.x), fmin(box->min_y, p.y), fmax(box->max_x, p.x), fmax(box->max_y, p.y)};
}

/* A box around all that is drawn of a glyph. */
static narc_aabb bound_glyph(const glyph *of) {
    narc_aabb box;
    narc_compute_aabb(of->arcs, of->arc_count, 0, &box);
    for (size_t i = 0; i < of->arc_count; i++) {
        include_point(&box, of->polygon[i]);
    }
    for (size_t i = 0; i < of->outline_count; i++) {
        include_point(&box, of->outline[i]);
    }
    return box;
}

static void trace_outline(canvas *page, const placement *where, const narc_point *points, size_t count) {
    cairo_new_sub_path(page->pen);
    for (size_t i = 0; i < count; i++) {
        const narc_point p = place_point(where, points[i]);
        cairo_line_to(page->pen, p.x, p.y);
    }
    cairo_close_path(page->pen);
}

/* Text with its middle at x and its baseline at y. */
static void draw_text(canvas *page, const char *text, double x, double y, double size) {
    cairo_text_extents_t extents;
    set_color(page, INK);
    cairo_set_font_size(page->pen, size);
    cairo_text_extents(page->pen, text, &extents);
    cairo_move_to(page->pen, x - extents.x_advance / 2, y);
    cairo_show_text(page->pen, text);
}

static void draw_polygon_line(canvas *page, double cell) {
    const double dashes[] = {0.016 * cell, 0.014 * cell};
    set_color(page, POLYGON_LINE);
    cairo_set_line_width(page->pen, THIN_LINE * cell);
    cairo_set_dash(page->pen, dashes, 2, 0);
    cairo_stroke(page->pen);
    cairo_set_dash(page->pen, NULL, 0, 0);
}

static void draw_junction(canvas *page, narc_point p, double cell) {
    set_color(page, INK);
    draw_dot(page, p, DOT * cell);
    set_color(page, WHITE);
    draw_dot(page, p, 0.55 * DOT * cell);
}

static void draw_glyph(canvas *page, const glyph *of, double left, double top, double cell) {
    const narc_aabb box = bound_glyph(of);
    const double width = box.max_x - box.min_x, height = box.max_y - box.min_y;
    const double size = cell * (1 - 2 * PADDING) / fmax(width, height);
    const placement where = {.origin_x = left + cell / 2 - size * (box.min_x + box.max_x) / 2,
                             .origin_y = top + cell / 2 + size * (box.min_y + box.max_y) / 2,
                             .cosine = size,
                             .sine = 0};
    size_t start = 0;
    for (size_t k = 0; k < of->end_count; start = of->ends[k++]) {
        trace_outline(page, &where, of->outline + start, of->ends[k] - start);
    }
    paint_path(page, GLYPH_FILL, GLYPH_LINE, THIN_LINE * cell);

    trace_outline(page, &where, of->polygon, of->arc_count);
    draw_polygon_line(page, cell);

    for (size_t i = 0; i < of->arc_count; i++) {
        trace_arcs(page, &where, &of->arcs[i], 1);
        set_color(page, TONES[i % 2]);
        cairo_set_line_width(page->pen, LINE * cell);
        cairo_stroke(page->pen);
    }
    for (size_t i = 0; i < of->arc_count; i++) {
        const narc_arc *arc = &of->arcs[i];
        const narc_point junction = {arc->center_x + arc->radius * cos(arc->start),
                                     arc->center_y + arc->radius * sin(arc->start)};
        draw_junction(page, place_point(&where, junction), cell);
    }
    char name[64];
    snprintf(name, sizeof name, "%s, %zu arcs", of->name, of->arc_count);
    draw_text(page, name, left + cell / 2, top + cell * (1 + 0.4 * NAME_HEIGHT), TEXT * cell);
}

/* What the lines mean: three samples with a word each, around the middle of the page. */
static void draw_legend(canvas *page, double middle, double y, double cell) {
    static const char *const words[] = {"glyph", "polygon", "n-arc"};
    for (int k = 0; k < 3; k++) {
        const double x = middle + (k - 1) * 0.3 * cell - 0.06 * cell, half = 0.045 * cell;
        if (k == 0) {
            cairo_rectangle(page->pen, x - half, y - 0.4 * half, 2 * half, 0.8 * half);
            paint_path(page, GLYPH_FILL, GLYPH_LINE, THIN_LINE * cell);
        } else if (k == 1) {
            cairo_move_to(page->pen, x - half, y);
            cairo_line_to(page->pen, x + half, y);
            draw_polygon_line(page, cell);
        } else {
            for (int tone = 0; tone < 2; tone++) {
                cairo_move_to(page->pen, tone ? x : x - half, y);
                cairo_line_to(page->pen, tone ? x + half : x, y);
                set_color(page, TONES[tone]);
                cairo_set_line_width(page->pen, LINE * cell);
                cairo_stroke(page->pen);
            }
            draw_junction(page, (narc_point){x, y}, cell);
        }
        cairo_set_font_size(page->pen, SMALL_TEXT * cell);
        cairo_text_extents_t extents;
        cairo_text_extents(page->pen, words[k], &extents);
        draw_text(page, words[k], x + half + 0.02 * cell + extents.x_advance / 2, y + 0.3 * SMALL_TEXT * cell,
                  SMALL_TEXT * cell);
    }
}

void draw_glyphs(const char *path, FILE *file, const glyph *glyphs, size_t count) {
    const size_t columns = count <= 5 ? count : (size_t)ceil(sqrt(1.5 * (double)count));
    const size_t rows = (count + columns - 1) / columns;
    const double width = (double)columns, height = (double)rows * (1 + NAME_HEIGHT) + LEGEND_HEIGHT;
    const double cell = fmin(CELL, LARGEST_PAGE / fmax(width, height));
    canvas page;
    open_canvas(&page, path, file, cell * width, cell * height);
    cairo_select_font_face(page.pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    for (size_t i = 0; i < count; i++) {
        draw_glyph(&page, &glyphs[i], cell * (double)(i % columns), cell * (1 + NAME_HEIGHT) * (double)(i / columns),
                   cell);
        show_progress("drawing", i, count);
    }
    draw_legend(&page, cell * width / 2, cell * (height - LEGEND_HEIGHT / 2), cell);
    finish_canvas(&page);
}
