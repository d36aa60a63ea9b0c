/* SPDX-License-Identifier: MIT
 *
 * canvas.h - a PNG or SVG picture to draw on with cairo.
 */
#ifndef NARC_TOOL_CANVAS_H
#define NARC_TOOL_CANVAS_H

#include <cairo.h>
#include <stdio.h>

#include "narc_fit.h"

typedef enum picture_kind { PICTURE_NONE, PICTURE_PNG, PICTURE_SVG } picture_kind;

/* The kind that the name's suffix asks for; PICTURE_NONE for NULL. Other suffixes are an error. */
picture_kind picture_kind_of(const char *path);

typedef struct color {
    double red, green, blue, alpha;
} color;

typedef struct canvas {
    picture_kind kind;
    const char *path;
    FILE *file;
    cairo_surface_t *surface;
    cairo_t *pen;
    narc_point corner; /* of a stamp's box */
    double size;       /* of that box */
} canvas;

/* A white page. `file` is an open output; the canvas must stay where it is until it is finished. */
void open_canvas(canvas *page, const char *path, FILE *file, double width, double height);

/* Writes the picture. */
void finish_canvas(canvas *page);

/* A drawing that is made once and used many times, in SVG files too: the pen draws it in the box (on a page). */
void open_stamp(canvas *stamp, narc_aabb box);
void close_stamp(canvas *stamp);

/* Draws it where its own origin comes to `where`, turned and enlarged. */
void use_stamp(canvas *page, const canvas *stamp, narc_point where, double cosine, double sine);

void set_color(canvas *page, color paint);

/* Text and fine marks. */
extern const color INK;

/* Text with its middle at x and its baseline at y, made smaller if it is wider than `widest`. */
void draw_text(canvas *page, const char *text, double x, double y, double size, double widest);

/* Where a shape's own coordinates are on the page: x = origin_x + cosine x - sine y, y = origin_y - sine x - cosine y,
 * with the size on the page in cosine and sine. The page's y points down. */
typedef struct placement {
    double origin_x, origin_y;
    double cosine, sine;
} placement;
narc_point place_point(const placement *where, narc_point p);

/* Adds a shape to the path: true arcs, joined by straight edges. */
void trace_arcs(canvas *page, const placement *where, const narc_arc *arcs, size_t count);

/* Adds a piece of a chain of arcs to the path. */
void trace_curve_arc(canvas *page, const placement *where, const narc_curve_arc *arc);

/* Outlines the path, or fills it and outlines it. */
void stroke_path(canvas *page, color line, double width);
void paint_path(canvas *page, color fill, color line, double line_width);

void draw_dot(canvas *page, narc_point center, double radius);

#endif
