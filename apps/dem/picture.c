/* SPDX-License-Identifier: MIT
 *
 * picture.c - pictures of grains and walls: bodies in colours for their speed, contacts or pressure, and forces as lines
 * from centre to contact to centre, as wide as the force is large.
 */
#define _XOPEN_SOURCE 700 /* strcasecmp */
#include <math.h>
#include <stdlib.h>
#include <string.h>
#include <strings.h>

#include <cairo-svg.h>

#include "frames.h"

/* In pixels: the strip below the picture, its text, the colour bar. Smaller grains have no outline: it would fill
 * them. */
static const double LEGEND = 30, TEXT = 13, BAR_WIDTH = 160, BAR_HEIGHT = 10, SMALLEST_OUTLINED = 5, THINNEST = 0.25;

/* In grains: the line of the mean force, the widest one, outlines. */
static const double MEAN_LINE = 0.07, WIDEST_LINE = 0.45, OUTLINE = 0.04;

/* A picture has at most this many pixels in a direction: cairo has room for 32,767. */
static const double MOST_PIXELS = 20000;

typedef struct color {
    double red, green, blue, alpha;
} color;

static const color WHITE = {1, 1, 1, 1}, INK = {0.12, 0.14, 0.18, 1}, WALL_FILL = {0.62, 0.64, 0.67, 1},
                   WALL_LINE = {0.40, 0.42, 0.45, 1};
static const color GRAIN_LINE = {0.35, 0.32, 0.28, 1}, FORCE = {0.10, 0.12, 0.30, 0.85};

/* From nothing to the largest value. */
static const color SPEED_STOPS[3] = {{0.93, 0.86, 0.70, 1}, {0.95, 0.58, 0.22, 1}, {0.66, 0.08, 0.20, 1}};
static const color OTHER_STOPS[3] = {{0.97, 0.96, 0.90, 1}, {0.50, 0.76, 0.74, 1}, {0.10, 0.33, 0.55, 1}};

typedef struct view {
    const dem *world;
    const dem_look *look;
    const dem_load *loads;
    dem_region region;
    double zoom;        /* pixels per unit of length */
    double low, height; /* the region's lower side on the page, the page's height */
    double top;         /* the value of the last colour */
} view;

/* ------------------------------------------------------------------------------------------------ colours */

static color find_color(const view *seen, double share) {
    const dem_coloring coloring = seen->look->coloring;
    const color *stops = coloring == DEM_SPEED || coloring == DEM_PLAIN ? SPEED_STOPS : OTHER_STOPS;
    const double place = 2 * fmin(fmax(share, 0), 1);
    const color a = stops[place < 1 ? 0 : 1], b = stops[place < 1 ? 1 : 2];
    const double t = place < 1 ? place : place - 1;
    return (color){a.red + t * (b.red - a.red), a.green + t * (b.green - a.green), a.blue + t * (b.blue - a.blue), 1};
}

static double find_value(const view *seen, size_t k) {
    const dem_bodies *b = &seen->world->bodies;
    const dem_load *load = &seen->loads[k];
    switch (seen->look->coloring) {
    case DEM_SPEED:
        return sqrt(b->vx[k] * b->vx[k] + b->vy[k] * b->vy[k]);
    case DEM_COORDINATION:
        return load->contacts;
    case DEM_PRESSURE:
        return 0.5 * (load->stress_xx + load->stress_yy);
    case DEM_PLAIN:
        return 0;
    }
    return 0;
}

/* What the input says, or the largest value; of coordination 6, the most that equal discs have. */
static double find_top(const view *seen) {
    double top = 0;
    if (seen->look->top > 0)
        return seen->look->top;
    if (seen->look->coloring == DEM_COORDINATION)
        return 6;
    for (size_t k = 0; k < seen->world->grain_count; k++)
        top = fmax(top, find_value(seen, k));
    return top;
}

static void set_color(cairo_t *pen, color paint) {
    cairo_set_source_rgba(pen, paint.red, paint.green, paint.blue, paint.alpha);
}

static void stroke_path(cairo_t *pen, color line, double width) {
    set_color(pen, line);
    cairo_set_line_width(pen, width);
    cairo_stroke(pen);
}

static void paint_path(cairo_t *pen, color fill, color line, double width) {
    set_color(pen, fill);
    cairo_fill_preserve(pen);
    stroke_path(pen, line, width);
}

/* ------------------------------------------------------------------------------------------------ bodies */

static narc_point to_page(const view *seen, double x, double y) {
    return (narc_point){seen->zoom * (x - seen->region.low_x), seen->low - seen->zoom * (y - seen->region.low_y)};
}

static void trace_body(cairo_t *pen, const view *seen, size_t k, double x, double y) {
    const dem_bodies *b = &seen->world->bodies;
    const narc_point origin = to_page(seen, x, y);
    const double zoom = seen->zoom * (double)b->scale[k], c = zoom * b->cosine[k], s = zoom * b->sine[k];
    const cairo_matrix_t matrix = {.xx = c, .yx = -s, .xy = -s, .yy = -c, .x0 = origin.x, .y0 = origin.y};
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(seen->world->store, b->shape[k], arcs);
    cairo_save(pen);
    cairo_transform(pen, &matrix);
    cairo_new_sub_path(pen);
    for (size_t i = 0; i < count; i++) /* cairo joins arcs by lines: the edges */
        cairo_arc(pen, arcs[i].center_x, arcs[i].center_y, arcs[i].radius, arcs[i].start, arcs[i].end);
    cairo_restore(pen);
    cairo_close_path(pen);
}

static bool is_seen(const view *seen, double x, double y, double reach) {
    const dem_region *r = &seen->region;
    return x + reach > r->low_x && x - reach < r->high_x && y + reach > r->low_y && y - reach < r->high_y;
}

static void draw_grain(cairo_t *pen, const view *seen, size_t k, double x, double y) {
    const double size = seen->zoom * seen->world->bodies.extent[k];
    const color fill = find_color(seen, seen->top > 0 ? find_value(seen, k) / seen->top : 0);
    trace_body(pen, seen, k, x, y);
    if (size >= SMALLEST_OUTLINED) {
        paint_path(pen, fill, GRAIN_LINE, fmax(OUTLINE * size, THINNEST));
        return;
    }
    set_color(pen, fill);
    cairo_fill(pen);
}

/* With its images across periodic borders. */
static void draw_images(cairo_t *pen, const view *seen, size_t k) {
    const dem_settings *s = &seen->world->settings;
    const dem_bodies *b = &seen->world->bodies;
    const int along_x = s->periodic_x, along_y = s->periodic_y;
    for (int i = -along_x; i <= along_x; i++)
        for (int j = -along_y; j <= along_y; j++) {
            const double x = b->x[k] + i * (s->high_x - s->low_x), y = b->y[k] + j * (s->high_y - s->low_y);
            if (is_seen(seen, x, y, b->reach[k]))
                draw_grain(pen, seen, k, x, y);
        }
}

static void draw_wall(cairo_t *pen, const view *seen, size_t wall) {
    const dem *d = seen->world;
    const size_t k = d->grain_count + wall;
    dem_vec corners[4];
    if (d->walls[wall].kind == DEM_PLATE) {
        dem_outline_plate(d, wall, &seen->region, corners);
        for (size_t i = 0; i < 4; i++) {
            const narc_point p = to_page(seen, corners[i].x, corners[i].y);
            (i == 0 ? cairo_move_to : cairo_line_to)(pen, p.x, p.y);
        }
        cairo_close_path(pen);
    } else {
        trace_body(pen, seen, k, d->bodies.x[k], d->bodies.y[k]);
    }
    paint_path(pen, WALL_FILL, WALL_LINE, 1);
}

/* ------------------------------------------------------------------------------------------------ forces */

static void draw_force(cairo_t *pen, const view *seen, size_t k, double width) {
    const dem *d = seen->world;
    const dem_bodies *b = &d->bodies;
    const size_t p = d->contacts.rows[k].pair, i = d->pairs.a[p], j = d->pairs.b[p];
    const narc_point from = to_page(seen, b->x[i], b->y[i]);
    const narc_point at =
        to_page(seen, b->x[i] + (double)d->contacts.rows[k].point_x, b->y[i] + (double)d->contacts.rows[k].point_y);
    cairo_move_to(pen, from.x, from.y);
    cairo_line_to(pen, at.x, at.y);
    if (j < d->grain_count) {
        const narc_point to =
            to_page(seen, b->x[j] + (double)d->pairs.shift_x[p], b->y[j] + (double)d->pairs.shift_y[p]);
        cairo_line_to(pen, to.x, to.y);
    }
    stroke_path(pen, FORCE, width);
}

/* A line's width is in proportion to the normal force, the mean force's a share of the mean grain. */
static void draw_forces(cairo_t *pen, const view *seen) {
    const dem *d = seen->world;
    double sum = 0, sizes = 0;
    for (size_t k = 0; k < d->contacts.count; k++)
        sum += fmax(dem_normal_force(d, k), 0);
    for (size_t k = 0; k < d->grain_count; k++)
        sizes += d->bodies.extent[k];
    const double size = seen->zoom * sizes / (double)d->grain_count;
    for (size_t k = 0; k < d->contacts.count && sum > 0; k++) {
        const double share = dem_normal_force(d, k) * (double)d->contacts.count / sum;
        const double width = fmin(MEAN_LINE * share, WIDEST_LINE) * size;
        if (width > 0.05) /* of a pixel: paler than can be seen */
            draw_force(pen, seen, k, width);
    }
}

/* ------------------------------------------------------------------------------------------------ the page */

static void write_text(cairo_t *pen, const char *text, double x, double y, bool ends_there) {
    cairo_text_extents_t extents;
    set_color(pen, INK);
    cairo_set_font_size(pen, TEXT);
    cairo_text_extents(pen, text, &extents);
    cairo_move_to(pen, ends_there ? x - extents.x_advance : x, y);
    cairo_show_text(pen, text);
}

static void draw_legend(cairo_t *pen, const view *seen, double width) {
    static const char *const names[] = {"", "speed", "contacts of a grain", "pressure"};
    char text[100];
    const double y = seen->height - 0.5 * LEGEND, base = y + 0.35 * TEXT, left = 70;
    set_color(pen, WHITE);
    cairo_rectangle(pen, 0, seen->low, width, LEGEND);
    cairo_fill(pen);
    snprintf(text, sizeof text, "time %.4g", seen->world->time);
    write_text(pen, text, width - 8, base, true);
    if (seen->look->coloring == DEM_PLAIN || width < 500)
        return;
    for (int i = 0; i < (int)BAR_WIDTH; i++) {
        set_color(pen, find_color(seen, i / BAR_WIDTH));
        cairo_rectangle(pen, left + i, y - 0.5 * BAR_HEIGHT, 1.5, BAR_HEIGHT);
        cairo_fill(pen);
    }
    write_text(pen, "0", left - 8, base, true);
    snprintf(text, sizeof text, "%.3g  %s", seen->top, names[seen->look->coloring]);
    write_text(pen, text, left + BAR_WIDTH + 8, base, false);
}

static void draw_all(cairo_t *pen, const view *seen, double width) {
    const dem *d = seen->world;
    for (size_t w = 0; w < d->wall_count; w++)
        if (d->walls[w].kind == DEM_PLATE) /* grains overlap them by little, and hide that */
            draw_wall(pen, seen, w);
    for (size_t k = 0; k < d->grain_count; k++)
        draw_images(pen, seen, k);
    for (size_t w = 0; w < d->wall_count; w++)
        if (d->walls[w].kind == DEM_BOX)
            draw_wall(pen, seen, w);
    if (seen->look->forces)
        draw_forces(pen, seen);
    draw_legend(pen, seen, width);
}

/* The region; else the periodic cell and, where there is none, all bodies with some room for plates. */
static dem_region choose_region(const dem *d, const dem_look *look) {
    const dem_settings *s = &d->settings;
    if (look->region.given)
        return look->region;
    dem_region r = dem_bound_all(d);
    r.low_x = s->periodic_x ? s->low_x : r.low_x - d->grain_extent;
    r.high_x = s->periodic_x ? s->high_x : r.high_x + d->grain_extent;
    r.low_y = s->periodic_y ? s->low_y : r.low_y - d->grain_extent;
    r.high_y = s->periodic_y ? s->high_y : r.high_y + d->grain_extent;
    return r;
}

dem_picture dem_picture_kind(const char *path) {
    const size_t length = strlen(path);
    const char *suffix = length > 4 ? path + length - 4 : "";
    return strcasecmp(suffix, ".png") == 0 ? DEM_PNG : strcasecmp(suffix, ".svg") == 0 ? DEM_SVG : DEM_NO_PICTURE;
}

/* What cannot be written dem_close_file() tells. */
static cairo_status_t write_bytes(void *file, const unsigned char *bytes, unsigned count) {
    fwrite(bytes, 1, count, file);
    return CAIRO_STATUS_SUCCESS;
}

static cairo_status_t write_page(FILE *file, const view *seen, double width, bool is_svg) {
    cairo_surface_t *surface =
        is_svg ? cairo_svg_surface_create_for_stream(write_bytes, file, width, seen->height)
               : cairo_image_surface_create(CAIRO_FORMAT_RGB24, (int)width, (int)ceil(seen->height));
    cairo_t *pen = cairo_create(surface);
    cairo_set_line_join(pen, CAIRO_LINE_JOIN_ROUND);
    cairo_set_line_cap(pen, CAIRO_LINE_CAP_ROUND);
    set_color(pen, WHITE);
    cairo_paint(pen);
    cairo_select_font_face(pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
    draw_all(pen, seen, width);
    cairo_status_t status = cairo_status(pen);
    cairo_destroy(pen);
    if (status == CAIRO_STATUS_SUCCESS && !is_svg)
        status = cairo_surface_write_to_png_stream(surface, write_bytes, file);
    cairo_surface_finish(surface);
    if (status == CAIRO_STATUS_SUCCESS)
        status = cairo_surface_status(surface);
    cairo_surface_destroy(surface);
    return status;
}

bool dem_draw_picture(const dem *d, const dem_look *look, const char *path, char *error) {
    view seen = {.world = d, .look = look, .region = choose_region(d, look)};
    const double wide = seen.region.high_x - seen.region.low_x, high = seen.region.high_y - seen.region.low_y;
    dem_load *loads = dem_find_loads(d, error);
    dem_file file;
    if (!loads || !dem_open_file(&file, path, error)) {
        free(loads);
        return false;
    }
    seen.loads = loads;
    seen.zoom = fmin(look->width / wide, (MOST_PIXELS - LEGEND) / high);
    const double width = fmax(ceil(seen.zoom * wide), 1);
    seen.low = fmax(ceil(seen.zoom * high), 1);
    seen.height = seen.low + LEGEND;
    seen.top = find_top(&seen);
    const cairo_status_t status = write_page(file.file, &seen, width, dem_picture_kind(path) == DEM_SVG);
    free(loads);
    if (status != CAIRO_STATUS_SUCCESS)
        snprintf(error, 512, "%.400s: %s", path, cairo_status_to_string(status));
    return dem_close_file(&file, status == CAIRO_STATUS_SUCCESS, error);
}
