/* SPDX-License-Identifier: MIT
 *
 * canvas.c - a PNG or SVG picture to draw on with cairo.
 */
#define _XOPEN_SOURCE 700 /* strcasecmp */
#include "canvas.h"

#include <cairo-svg.h>
#include <errno.h>
#include <math.h>
#include <string.h>
#include <strings.h>

#include "fail.h"
#include "turn.h"

picture_kind picture_kind_of(const char *path) {
    if (!path)
        return PICTURE_NONE;
    const size_t length = strlen(path);
    const char *suffix = length > 4 ? path + length - 4 : "";
    if (strcasecmp(suffix, ".png") == 0)
        return PICTURE_PNG;
    if (strcasecmp(suffix, ".svg") == 0)
        return PICTURE_SVG;
    fail("a picture's name must end in .png or .svg, not '%s'", path);
}

static cairo_status_t write_bytes(void *context, const unsigned char *bytes, unsigned count) {
    const canvas *page = context;
    if (fwrite(bytes, 1, count, page->file) != count)
        fail("%s: %s", page->path, strerror(errno)); /* cairo would lose the reason */
    return CAIRO_STATUS_SUCCESS;
}

static void start_pen(canvas *page) {
    page->pen = cairo_create(page->surface);
    cairo_set_line_join(page->pen, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(page->pen, CAIRO_LINE_CAP_ROUND);
}

void open_canvas(canvas *page, const char *path, FILE *file, double width, double height) {
    *page = (canvas){.kind = picture_kind_of(path), .path = path, .file = file};
    page->surface = page->kind == PICTURE_SVG
                        ? cairo_svg_surface_create_for_stream(write_bytes, page, width, height)
                        : cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)ceil(width), (int)ceil(height));
    start_pen(page);
    set_color(page, (color){1, 1, 1, 1});
    cairo_paint(page->pen);
    cairo_select_font_face(page->pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

void finish_canvas(canvas *page) {
    cairo_status_t status = cairo_status(page->pen);
    cairo_destroy(page->pen);
    if (status == CAIRO_STATUS_SUCCESS && page->kind == PICTURE_PNG)
        status = cairo_surface_write_to_png_stream(page->surface, write_bytes, page);
    cairo_surface_finish(page->surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(page->surface);
    if (status != CAIRO_STATUS_SUCCESS)
        fail("%s: %s", page->path, cairo_status_to_string(status));
    cairo_surface_destroy(page->surface);
}

/* A box that begins elsewhere than at 0, 0 is not clipped rightly by cairo 1.16. */
void open_stamp(canvas *stamp, narc_aabb box) {
    const cairo_rectangle_t extents = {0, 0, ceil(box.max_x - box.min_x), ceil(box.max_y - box.min_y)};
    *stamp = (canvas){.surface = cairo_recording_surface_create(CAIRO_CONTENT_COLOR_ALPHA, &extents),
                      .corner = {box.min_x, box.min_y},
                      .size = fmax(extents.width, extents.height)};
    start_pen(stamp);
    cairo_translate(stamp->pen, -box.min_x, -box.min_y);
}

void close_stamp(canvas *stamp) {
    if (stamp->surface) {
        cairo_destroy(stamp->pen);
        cairo_surface_destroy(stamp->surface);
    }
}

static double round_to(double value, double grid) { return nearbyint(value * grid) / grid; }

/* Rounded numbers are short in an SVG file. Those of the matrix move no point of the stamp by a 100th of a pixel. */
void use_stamp(canvas *page, const canvas *stamp, narc_point where, double cosine, double sine) {
    const double grid = stamp->size < 50 ? 1e4 : 1e6;
    const narc_point corner = stamp->corner;
    const cairo_matrix_t matrix = {.xx = round_to(cosine, grid),
                                   .yx = round_to(-sine, grid),
                                   .xy = round_to(sine, grid),
                                   .yy = round_to(cosine, grid),
                                   .x0 = round_to(where.x + cosine * corner.x + sine * corner.y, 100),
                                   .y0 = round_to(where.y - sine * corner.x + cosine * corner.y, 100)};
    cairo_save(page->pen);
    cairo_transform(page->pen, &matrix);
    cairo_set_source_surface(page->pen, stamp->surface, 0, 0);
    cairo_paint(page->pen);
    cairo_restore(page->pen);
}

void set_color(canvas *page, color paint) {
    cairo_set_source_rgba(page->pen, paint.red, paint.green, paint.blue, paint.alpha);
}

const color INK = {0.12, 0.14, 0.18, 1};

void draw_text(canvas *page, const char *text, double x, double y, double size, double widest) {
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

narc_point place_point(const placement *where, narc_point p) {
    return (narc_point){where->origin_x + where->cosine * p.x - where->sine * p.y,
                        where->origin_y - where->sine * p.x - where->cosine * p.y};
}

/* From here to leave_shape() the pen draws in the shape's own coordinates. */
static void enter_shape(canvas *page, const placement *where) {
    const cairo_matrix_t matrix = {.xx = where->cosine,
                                   .yx = -where->sine,
                                   .xy = -where->sine,
                                   .yy = -where->cosine,
                                   .x0 = where->origin_x,
                                   .y0 = where->origin_y};
    cairo_save(page->pen);
    cairo_transform(page->pen, &matrix);
    cairo_new_sub_path(page->pen);
}

static void leave_shape(canvas *page) { cairo_restore(page->pen); }

void trace_arcs(canvas *page, const placement *where, const narc_arc *arcs, size_t count) {
    enter_shape(page, where);
    for (size_t i = 0; i < count; i++) {
        /* cairo joins an arc to what is there by a line: the edge between arcs, or nothing. */
        const narc_arc *a = &arcs[i];
        if (signbit(a->radius)) /* concave, of a chain */
            cairo_arc_negative(page->pen, a->center_x, a->center_y, -a->radius, a->start + FULL_TURN / 2,
                               a->end + FULL_TURN / 2);
        else
            cairo_arc(page->pen, a->center_x, a->center_y, a->radius, a->start, a->end);
    }
    leave_shape(page);
}

void trace_curve_arc(canvas *page, const placement *where, const narc_curve_arc *arc) {
    enter_shape(page, where);
    if (arc->turn == 0) {
        cairo_move_to(page->pen, arc->start.x, arc->start.y);
        cairo_line_to(page->pen, arc->end.x, arc->end.y);
    } else {
        const double start = atan2(arc->start.y - arc->center.y, arc->start.x - arc->center.x);
        (arc->turn > 0 ? cairo_arc : cairo_arc_negative)(page->pen, arc->center.x, arc->center.y, arc->radius, start,
                                                         start + arc->turn);
    }
    leave_shape(page);
}

void stroke_path(canvas *page, color line, double width) {
    set_color(page, line);
    cairo_set_line_width(page->pen, width);
    cairo_stroke(page->pen);
}

void paint_path(canvas *page, color fill, color line, double line_width) {
    set_color(page, fill);
    cairo_fill_preserve(page->pen);
    stroke_path(page, line, line_width);
}

void draw_dot(canvas *page, narc_point center, double radius) {
    cairo_new_sub_path(page->pen);
    cairo_arc(page->pen, center.x, center.y, radius, 0, FULL_TURN);
    cairo_fill(page->pen);
}
