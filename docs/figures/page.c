/* SPDX-License-Identifier: MIT
 *
 * page.c - drawing a figure with cairo.
 */
#include "page.h"

#include <cairo-svg.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

const color INK = {0.13, 0.15, 0.20}, GREY = {0.50, 0.53, 0.58}, PALE = {0.80, 0.82, 0.85}, BLUE = {0.15, 0.42, 0.72},
            ORANGE = {0.85, 0.42, 0.08}, GREEN = {0.10, 0.55, 0.33}, RED = {0.80, 0.16, 0.20},
            PURPLE = {0.48, 0.25, 0.65};

color color_of(size_t k) {
    static const color colors[] = {{0.15, 0.42, 0.72}, {0.85, 0.42, 0.08}, {0.10, 0.55, 0.33}, {0.48, 0.25, 0.65},
                                   {0.80, 0.16, 0.30}, {0.05, 0.56, 0.62}, {0.62, 0.50, 0.05}, {0.45, 0.35, 0.28}};
    return colors[k % (sizeof colors / sizeof *colors)];
}

sheet open_page(const char *folder, const char *name, double width, double height) {
    static char path[4096];
    sheet page = {.path = path, .scale_x = 1, .scale_y = 1};
    snprintf(path, sizeof path, "%s/%s.svg", folder, name);
    page.surface = cairo_svg_surface_create(path, width, height);
    page.pen = cairo_create(page.surface);
    cairo_set_source_rgb(page.pen, 1, 1, 1);
    cairo_paint(page.pen);
    cairo_set_line_join(page.pen, CAIRO_LINE_JOIN_ROUND);
    return page;
}

void finish_page(sheet *page) {
    cairo_status_t status = cairo_status(page->pen);
    cairo_destroy(page->pen);
    cairo_surface_finish(page->surface);
    status = status ? status : cairo_surface_status(page->surface);
    cairo_surface_destroy(page->surface);
    if (status != CAIRO_STATUS_SUCCESS) {
        fprintf(stderr, "figures: %s: %s\n", page->path, cairo_status_to_string(status));
        exit(1);
    }
}

void set_view(sheet *page, double x, double y, double scale_x, double scale_y) {
    page->origin_x = x;
    page->origin_y = y;
    page->scale_x = scale_x;
    page->scale_y = scale_y;
}

narc_point on_page(const sheet *page, double x, double y) {
    return (narc_point){page->origin_x + page->scale_x * x, page->origin_y - page->scale_y * y};
}

void set_pen(sheet *page, color ink, double alpha, double width, double dash) {
    cairo_set_source_rgba(page->pen, ink.red, ink.green, ink.blue, alpha);
    cairo_set_line_width(page->pen, width);
    cairo_set_dash(page->pen, &dash, dash > 0, 0);
}

void draw_line(sheet *page, double x0, double y0, double x1, double y1) {
    const narc_point from = on_page(page, x0, y0), to = on_page(page, x1, y1);
    cairo_move_to(page->pen, from.x, from.y);
    cairo_line_to(page->pen, to.x, to.y);
    cairo_stroke(page->pen);
}

void draw_arrow(sheet *page, double x0, double y0, double x1, double y1) {
    const narc_point from = on_page(page, x0, y0), to = on_page(page, x1, y1);
    const double angle = atan2(to.y - from.y, to.x - from.x), width = cairo_get_line_width(page->pen);
    const double length = 5 + 2.5 * width, half = 0.38 * length, c = cos(angle), s = sin(angle);
    cairo_move_to(page->pen, from.x, from.y);
    cairo_line_to(page->pen, to.x - 0.7 * length * c, to.y - 0.7 * length * s);
    cairo_stroke(page->pen);
    cairo_move_to(page->pen, to.x, to.y);
    cairo_line_to(page->pen, to.x - length * c - half * s, to.y - length * s + half * c);
    cairo_line_to(page->pen, to.x - length * c + half * s, to.y - length * s - half * c);
    cairo_close_path(page->pen);
    cairo_fill(page->pen);
}

void draw_dot(sheet *page, double x, double y, double radius) {
    const narc_point at = on_page(page, x, y);
    cairo_new_path(page->pen);
    cairo_arc(page->pen, at.x, at.y, radius, 0, 2 * pi);
    cairo_fill(page->pen);
}

void draw_circle(sheet *page, double x, double y, double radius) {
    const narc_point at = on_page(page, x, y);
    cairo_new_path(page->pen);
    cairo_arc(page->pen, at.x, at.y, radius * page->scale_x, 0, 2 * pi);
    cairo_stroke(page->pen);
}

/* The page's y points down, so angles change their sign. */
static void trace_arc(sheet *page, const narc_arc *arc) {
    const narc_point center = on_page(page, arc->center_x, arc->center_y);
    cairo_arc_negative(page->pen, center.x, center.y, arc->radius * page->scale_x, -arc->start, -arc->end);
}

void draw_arc(sheet *page, const narc_arc *arc) {
    cairo_new_path(page->pen);
    trace_arc(page, arc);
    cairo_stroke(page->pen);
}

void fill_sector(sheet *page, const narc_arc *arc) {
    const narc_point center = on_page(page, arc->center_x, arc->center_y);
    cairo_new_path(page->pen);
    cairo_move_to(page->pen, center.x, center.y);
    trace_arc(page, arc);
    cairo_close_path(page->pen);
    cairo_fill(page->pen);
}

void trace_outline(sheet *page, const outline *shape) {
    cairo_new_path(page->pen);
    for (size_t k = 0; k < shape->count; k++)
        trace_arc(page, &shape->arc[k]);
    cairo_close_path(page->pen);
}

void paint_outline(sheet *page, const outline *shape, color ink, double fill) {
    trace_outline(page, shape);
    set_pen(page, ink, fill, 2.2, 0);
    cairo_fill_preserve(page->pen);
    set_pen(page, ink, 1, 2.2, 0);
    cairo_stroke(page->pen);
}

static void choose_font(sheet *page, bool slanted, double size) {
    cairo_select_font_face(page->pen, slanted ? "DejaVu Serif" : "DejaVu Sans",
                           slanted ? CAIRO_FONT_SLANT_ITALIC : CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    cairo_set_font_size(page->pen, size);
}

void write_words(sheet *page, double x, double y, double right, double down, int align, double size, const char *text) {
    const narc_point at = on_page(page, x, y);
    cairo_text_extents_t extents;
    choose_font(page, false, size);
    cairo_text_extents(page->pen, text, &extents);
    cairo_move_to(page->pen, at.x + right - extents.x_advance * (align + 1) / 2, at.y + down);
    cairo_show_text(page->pen, text);
    cairo_new_path(page->pen);
}

/* Writes, or only measures, a formula a character at a time; returns its width. */
static double run_formula(sheet *page, double x, double y, double size, const char *text, bool show) {
    const double start = x;
    for (bool low = false; *text; text++) {
        if (*text == '_') {
            low = true;
            continue;
        }
        char glyph[5] = {*text};
        for (int k = 1; k < 4 && ((unsigned char)text[1] & 0xc0) == 0x80; k++) /* the rest of a UTF-8 character */
            glyph[k] = *++text;
        const bool letter = (glyph[0] | 32) >= 'a' && (glyph[0] | 32) <= 'z';
        cairo_text_extents_t extents;
        choose_font(page, letter, low ? 0.72 * size : size);
        cairo_text_extents(page->pen, glyph, &extents);
        if (show) {
            cairo_move_to(page->pen, x, low ? y + 0.22 * size : y);
            cairo_show_text(page->pen, glyph);
        }
        x += extents.x_advance;
        low = false;
    }
    return x - start;
}

void write_formula(sheet *page, double x, double y, double right, double down, int align, double size,
                   const char *text) {
    const narc_point at = on_page(page, x, y);
    const double width = run_formula(page, 0, 0, size, text, false);
    run_formula(page, at.x + right - width * (align + 1) / 2, at.y + down, size, text, true);
    cairo_new_path(page->pen);
}
