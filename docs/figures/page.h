/* SPDX-License-Identifier: MIT
 *
 * page.h - a white SVG page to draw a figure on with cairo. Lengths of lines and text are in pixels; points are in the
 * figure's own coordinates, y up, through the page's view.
 */
#ifndef NARC_FIGURES_PAGE_H
#define NARC_FIGURES_PAGE_H

#include <cairo.h>

#include "geometry.h"

typedef struct color {
    double red, green, blue;
} color;

extern const color INK, GREY, PALE, BLUE, ORANGE, GREEN, RED, PURPLE;

/* One of a few colours for arcs, round and round. */
color color_of(size_t k);

typedef struct sheet {
    cairo_surface_t *surface;
    cairo_t *pen;
    const char *path;
    double origin_x, origin_y, scale_x, scale_y; /* the view */
} sheet;

sheet open_page(const char *folder, const char *name, double width, double height);
void finish_page(sheet *page); /* ends the program if it cannot be written */

/* Where the origin lies on the page, and pixels to a unit along x and y. */
void set_view(sheet *page, double x, double y, double scale_x, double scale_y);
narc_point on_page(const sheet *page, double x, double y);

void set_pen(sheet *page, color ink, double alpha, double width, double dash);
void draw_line(sheet *page, double x0, double y0, double x1, double y1);
void draw_arrow(sheet *page, double x0, double y0, double x1, double y1);
void draw_dot(sheet *page, double x, double y, double radius);
void draw_circle(sheet *page, double x, double y, double radius);
void draw_arc(sheet *page, const narc_arc *arc);
void fill_sector(sheet *page, const narc_arc *arc);
void trace_outline(sheet *page, const outline *shape);
void paint_outline(sheet *page, const outline *shape, color ink, double fill);

/* Text with its middle (align 0), left end (-1) or right end (1) at a point, `right` and `down` pixels away. In
 * formulas letters are slanted, and the character after _ is lowered. */
void write_words(sheet *page, double x, double y, double right, double down, int align, double size, const char *text);
void write_formula(sheet *page, double x, double y, double right, double down, int align, double size,
                   const char *text);

#endif
