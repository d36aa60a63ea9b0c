/* SPDX-License-Identifier: MIT
 *
 * picture_bodies.c - bodies filled, colliding ones in another colour and on top, then contact points with their
 * normals. Lines and dots are in proportion to the bodies on the page, so that 20 and 20,000 of them look alike.
 */
#include "picture_bodies.h"

#include <math.h>

#include "canvas.h"
#include "fail.h"
#include "progress.h"

/* In pixels: a body as one likes to see it; the page's limits; its margin. */
static const double GOOD_BODY = 110, SMALLEST_PAGE = 900, LARGEST_PAGE = 3000, MARGIN = 24, NARROWEST_PAGE = 160;

/* In bodies. */
static const double OUTLINE = 0.022, NORMAL_LENGTH = 0.30, NORMAL_LINE = 0.028, DOT = 0.042;

/* In pixels: lines stay visible, and do not get clumsy. Smaller bodies have no outline: it would fill them. */
static const double THINNEST = 0.3, THICKEST = 2.2, SMALLEST_OUTLINED = 3;

static const color FREE_FILL = {0.83, 0.88, 0.93, 0.9}, FREE_LINE = {0.42, 0.53, 0.66, 1};
static const color HIT_FILL = {0.99, 0.80, 0.60, 0.8}, HIT_LINE = {0.83, 0.40, 0.12, 1};
static const color CONTACT = {0.10, 0.10, 0.28, 1}, NEAR_CONTACT = {0.35, 0.55, 0.42, 1};

/* An SVG file grows by a kilobyte or more with each body: this many are 200 megabytes, too many for viewers. */
enum { MOST_SVG_BODIES = 200000 };

typedef struct view {
    double middle_x, middle_y; /* in the world */
    double page_x, page_y;     /* the same on the page */
    double zoom;               /* pixels per unit of length */
} view;

static double clamp(double value, double low, double high) { return fmin(fmax(value, low), high); }

static double box_size(narc_aabb box) { return fmax(box.max_x - box.min_x, box.max_y - box.min_y); }

/* Chooses the page's size and how the world lies on it. */
static view choose_view(const char *path, const body_scene *scene, double *out_width, double *out_height) {
    const size_t count = scene->bodies->count;
    narc_aabb world = count ? scene->boxes[0] : (narc_aabb){-1, -1, 1, 1};
    double sizes = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_aabb box = scene->boxes[i];
        world = (narc_aabb){fmin(world.min_x, box.min_x), fmin(world.min_y, box.min_y), fmax(world.max_x, box.max_x),
                            fmax(world.max_y, box.max_y)};
        sizes += box_size(box);
    }
    const double size = box_size(world), mean = count ? sizes / (double)count : size;
    if (!(size > 0 && size <= NARC_MAX_DISTANCE))
        fail("%s: the bodies are too far apart to draw", path);
    const double side = clamp(GOOD_BODY * size / mean, SMALLEST_PAGE, LARGEST_PAGE) - 2 * MARGIN;
    const double zoom = side / size;
    *out_width = ceil(fmax(zoom * (world.max_x - world.min_x) + 2 * MARGIN, NARROWEST_PAGE));
    *out_height = ceil(fmax(zoom * (world.max_y - world.min_y) + 2 * MARGIN, NARROWEST_PAGE));
    return (view){.middle_x = world.min_x + (world.max_x - world.min_x) / 2,
                  .middle_y = world.min_y + (world.max_y - world.min_y) / 2,
                  .page_x = *out_width / 2,
                  .page_y = *out_height / 2,
                  .zoom = zoom};
}

static narc_point to_page(const view *seen, double x, double y) {
    return (narc_point){seen->page_x + seen->zoom * (x - seen->middle_x),
                        seen->page_y - seen->zoom * (y - seen->middle_y)};
}

static void draw_body(canvas *page, const view *seen, const body_scene *scene, size_t index) {
    const body *drawn = &scene->bodies->items[index];
    const shape *form = &scene->shapes->items[drawn->shape];
    const double zoom = seen->zoom * (double)drawn->scale, size = seen->zoom * box_size(scene->boxes[index]);
    const narc_point origin = to_page(seen, drawn->x, drawn->y);
    const placement where = {origin.x, origin.y, zoom * (double)drawn->cosine, zoom * (double)drawn->sine};
    const bool hit = scene->colliding[index];
    trace_arcs(page, &where, form->arcs, form->arc_count);
    cairo_close_path(page->pen);
    if (size < SMALLEST_OUTLINED) {
        set_color(page, hit ? HIT_LINE : FREE_LINE);
        cairo_fill(page->pen);
    } else {
        paint_path(page, hit ? HIT_FILL : FREE_FILL, hit ? HIT_LINE : FREE_LINE,
                   clamp(OUTLINE * size, THINNEST, THICKEST));
    }
}

/* The contact point and the normal of contact k, sized after the smaller body. */
static void draw_contact(canvas *page, const view *seen, const body_scene *scene, size_t k) {
    const narc_contacts *contacts = scene->contacts;
    const pair of = scene->pairs->items[contacts->pair[k]];
    const double size = seen->zoom * fmin(box_size(scene->boxes[of.a]), box_size(scene->boxes[of.b]));
    const body *a = &scene->bodies->items[of.a];
    const narc_point p = to_page(seen, a->x + (double)contacts->point_x[k], a->y + (double)contacts->point_y[k]);
    const double length = NORMAL_LENGTH * size;
    set_color(page, contacts->separation[k] < 0 ? CONTACT : NEAR_CONTACT);
    cairo_set_line_width(page->pen, clamp(NORMAL_LINE * size, THINNEST, THICKEST));
    cairo_move_to(page->pen, p.x, p.y);
    cairo_line_to(page->pen, p.x + length * (double)contacts->normal_x[k],
                  p.y - length * (double)contacts->normal_y[k]);
    cairo_stroke(page->pen);
    draw_dot(page, p, clamp(DOT * size, 0.8 * THINNEST, 2 * THICKEST));
}

void check_picture_size(const char *path, size_t body_count) {
    if (picture_kind_of(path) == PICTURE_SVG && body_count > MOST_SVG_BODIES) {
        fail("%s: %zu bodies, an .svg picture has at most %d; a .png picture can have more", path, body_count,
             MOST_SVG_BODIES);
    }
}

void draw_bodies(const char *path, FILE *file, const body_scene *scene) {
    double width, height;
    const view seen = choose_view(path, scene, &width, &height);
    canvas page;
    open_canvas(&page, path, file, width, height);
    const size_t count = scene->bodies->count, steps = 2 * count + scene->contact_count;
    for (size_t i = 0; i < 2 * count; i++) {
        if (scene->colliding[i % count] == (i >= count))
            draw_body(&page, &seen, scene, i % count);
        show_progress("drawing", i, steps);
    }
    for (size_t k = 0; k < scene->contact_count; k++) {
        if (isfinite(scene->contacts->separation[k]))
            draw_contact(&page, &seen, scene, k);
        show_progress("drawing", 2 * count + k, steps);
    }
    finish_canvas(&page);
}
