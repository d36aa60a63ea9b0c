/* SPDX-License-Identifier: MIT
 *
 * picture_bodies.c - bodies filled, those that collide or are hit in another colour and on top, then rays, and contact
 * points or hits with their normals; a legend below, if there is anything of these. Lines and dots are in proportion to the bodies on the page, so
 * that 20 and 20,000 of them look alike.
 */
#include "picture_bodies.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "canvas.h"
#include "draw_fit.h"
#include "fail.h"
#include "legend.h"
#include "progress.h"
#include "turn.h"

/* In pixels: a body as one likes to see it; the page's limits; its margin. */
static const double GOOD_BODY = 110, SMALLEST_PAGE = 900, LARGEST_PAGE = 3000, MARGIN = 24, NARROWEST_PAGE = 160;

/* The narrowest page that has a legend; of the page's longer side: the size of its text; of that: the legend's height. */
static const double NARROWEST_LEGEND = 600, TEXT = 0.016, LEGEND_HEIGHT = 3;

/* In bodies. */
static const double OUTLINE = 0.022, NORMAL_LENGTH = 0.30, NORMAL_LINE = 0.028, DOT = 0.042;

/* In pixels: lines stay visible, and do not get clumsy. Smaller bodies have no outline: it would fill them. */
static const double THINNEST = 0.3, THICKEST = 2.2, SMALLEST_OUTLINED = 3;

static const color FREE_FILL = {0.83, 0.88, 0.93, 0.9}, FREE_LINE = {0.42, 0.53, 0.66, 1};
static const color HIT_FILL = {0.99, 0.80, 0.60, 0.8}, HIT_LINE = {0.83, 0.40, 0.12, 1};
static const color CONTACT = {0.10, 0.10, 0.28, 1}, NEAR_CONTACT = {0.35, 0.55, 0.42, 1};

/* An SVG file grows by a tenth of a kilobyte with each body and each contact: so many are 50 megabytes, and librsvg draws
 * no more. Bodies alone are counted before they meet. */
enum { MOST_SVG_BODIES = 200000, MOST_SVG_ITEMS = 500000 };

typedef enum sample { FREE, HIT, TOUCHING, APART, SAMPLE_COUNT } sample;

typedef struct view {
    double middle_x, middle_y; /* in the world */
    double page_x, page_y;     /* the same on the page */
    double zoom;               /* pixels per unit of length */
    double width, height;      /* of the page */
    double text;               /* its size in the legend */
    double reach;              /* what is further from the world's origin is left out */
    bool shown[SAMPLE_COUNT];
} view;

static double clamp(double value, double low, double high) { return fmin(fmax(value, low), high); }

static bool is_endless(const body_scene *scene, size_t index) {
    return scene->shapes->items[scene->bodies->items[index].item].form == NARC_FORM_HALF_PLANE;
}

/* In pixels, for lines and marks: ground without end is like other bodies. */
static double pixel_size(const view *seen, const body_scene *scene, size_t index) {
    return is_endless(scene, index) ? GOOD_BODY : seen->zoom * box_size(scene->boxes[index]);
}

static bool is_within(double reach, narc_aabb box) {
    return box.min_x >= -reach && box.min_y >= -reach && box.max_x <= reach && box.max_y <= reach;
}

/* Of ground without end its place. */
static narc_aabb find_box(const body_scene *scene, size_t index) {
    const body *b = &scene->bodies->items[index];
    return is_endless(scene, index) ? (narc_aabb){b->x, b->y, b->x, b->y} : scene->boxes[index];
}

static bool has_body(const view *seen, const body_scene *scene, size_t index) {
    return is_within(seen->reach, find_box(scene, index));
}

static bool has_contact(const view *seen, const body_scene *scene, size_t k) {
    const pair of = scene->pairs->items[scene->contacts[k].pair];
    return isfinite(scene->contacts[k].separation) && has_body(seen, scene, of.a) && has_body(seen, scene, of.b);
}

static bool has_ray(const view *seen, const drawn_ray *ray) {
    return is_within(seen->reach, (narc_aabb){ray->x, ray->y, ray->x, ray->y});
}

static bool has_hit(const view *seen, const body_scene *scene, const drawn_ray *ray) {
    return ray->hit.count && has_body(seen, scene, ray->hit.body);
}

/* What the picture will have. */
static void find_samples(const body_scene *scene, view *seen) {
    bool *shown = seen->shown;
    for (size_t i = 0; i < scene->bodies->count; i++)
        shown[scene->marked[i] ? HIT : FREE] |= has_body(seen, scene, i);
    for (size_t k = 0; k < scene->contact_count; k++)
        shown[scene->contacts[k].separation < 0 ? TOUCHING : APART] |= has_contact(seen, scene, k);
    for (size_t k = 0; k < scene->ray_count; k++) {
        shown[TOUCHING] |= has_ray(seen, &scene->rays[k]) && has_hit(seen, scene, &scene->rays[k]);
        shown[APART] |= has_ray(seen, &scene->rays[k]);
    }
}

/* Bodies alone need none. */
static bool has_legend(const bool *shown) { return shown[HIT] || shown[TOUCHING] || shown[APART]; }

/* Where all lies that is within reach, and the mean size of the bodies; out_count: how many these are. */
static narc_aabb bound_world(const view *seen, const body_scene *scene, double *out_mean, size_t *out_count) {
    narc_aabb world = EMPTY_BOX;
    double sizes = 0;
    *out_count = 0;
    for (size_t i = 0; i < scene->bodies->count; i++) {
        if (has_body(seen, scene, i)) {
            world = join_boxes(world, find_box(scene, i));
            sizes += box_size(find_box(scene, i));
            ++*out_count;
        }
    }
    if (*out_count == 0)
        world = (narc_aabb){-1, -1, 1, 1};
    for (size_t k = 0; k < scene->ray_count; k++) {
        const drawn_ray *ray = &scene->rays[k];
        if (has_ray(seen, ray))
            world = join_boxes(world, (narc_aabb){ray->x, ray->y, ray->x, ray->y});
    }
    *out_mean = *out_count ? sizes / (double)*out_count : box_size(world);
    if (box_size(world) > 0)
        return world;
    *out_mean = 1; /* Ground without end alone has no size of its own. */
    return (narc_aabb){world.min_x - 1, world.min_y - 1, world.max_x + 1, world.max_y + 1};
}

/* Chooses the page's size and how the world lies on it. */
static view choose_view(const char *path, const body_scene *scene) {
    view seen = {.reach = INFINITY};
    const size_t all = scene->bodies->count;
    size_t count;
    double mean;
    narc_aabb world = bound_world(&seen, scene, &mean, &count);
    if (!(box_size(world) <= NARC_MAX_DISTANCE)) {
        seen.reach = NARC_MAX_DISTANCE / 2;
        world = bound_world(&seen, scene, &mean, &count);
        if (count == 0 && all > 0)
            fail("%s: the bodies are too far from the origin to draw", path);
        warn_at(path, "%zu of %zu bodies%s that are more than %g from the origin are left out", all - count, all,
                scene->ray_count ? ", and rays," : "", seen.reach);
    }
    const double size = box_size(world);
    if (!(size > 0))
        fail("%s: the bodies are too far from the origin to draw", path);
    const double side = clamp(GOOD_BODY * size / mean, SMALLEST_PAGE, LARGEST_PAGE) - 2 * MARGIN;
    find_samples(scene, &seen);
    const bool legend = has_legend(seen.shown);
    seen.zoom = side / size;
    seen.width = fmax(seen.zoom * (world.max_x - world.min_x) + 2 * MARGIN, legend ? NARROWEST_LEGEND : NARROWEST_PAGE);
    seen.height = fmax(seen.zoom * (world.max_y - world.min_y) + 2 * MARGIN, NARROWEST_PAGE);
    seen.middle_x = world.min_x + (world.max_x - world.min_x) / 2;
    seen.middle_y = world.min_y + (world.max_y - world.min_y) / 2;
    seen.page_x = ceil(seen.width) / 2;
    seen.page_y = ceil(seen.height) / 2;
    seen.text = TEXT * fmax(seen.width, seen.height);
    seen.width = ceil(seen.width);
    seen.height = ceil(seen.height + (legend ? LEGEND_HEIGHT * seen.text - MARGIN : 0));
    return seen;
}

static narc_point to_page(const view *seen, double x, double y) {
    return (narc_point){seen->page_x + seen->zoom * (x - seen->middle_x),
                        seen->page_y - seen->zoom * (y - seen->middle_y)};
}

/* ---------------------------------------------------------------------------- bodies and contacts */

/* What a picture draws again and again. A PNG image draws each anew, with lines of its own. */
typedef struct stamps {
    canvas *bodies; /* free and colliding ones of each shape; NULL: there are no stamps */
    double *zooms;  /* pixels per unit of length of each */
    canvas contacts[2];
    double sizes[2]; /* the size of the bodies, in pixels */
} stamps;

static void paint_body(canvas *page, const placement *where, const narc_named_shape *form, bool hit, double size) {
    trace_arcs(page, where, form->arcs, form->arc_count);
    cairo_close_path(page->pen);
    if (size < SMALLEST_OUTLINED) {
        set_color(page, hit ? HIT_LINE : FREE_LINE);
        cairo_fill(page->pen);
    } else {
        paint_path(page, hit ? HIT_FILL : FREE_FILL, hit ? HIT_LINE : FREE_LINE,
                   clamp(OUTLINE * size, THINNEST, THICKEST));
    }
}

static void open_body_stamp(canvas *stamp, const narc_named_shape *form, bool hit, double size, double zoom) {
    narc_aabb box;
    narc_compute_aabb(form->arcs, form->arc_count, 0, &box);
    open_stamp(stamp, (narc_aabb){zoom * box.min_x - THICKEST, -zoom * box.max_y - THICKEST,
                                  zoom * box.max_x + THICKEST, -zoom * box.min_y + THICKEST});
    paint_body(stamp, &(placement){0, 0, zoom, 0}, form, hit, size);
}

/* An entry of a chain: its line. Of a run, which is closed behind (narc_chains.h), the front. */
static void paint_entry(canvas *page, const placement *where, const narc_shapes *store, uint32_t shape, bool hit,
                        double size) {
    narc_arc arcs[NARC_MAX_ARCS];
    const size_t count = narc_get_arcs(store, shape, arcs);
    const bool run = narc_shape_flags(store, shape) & NARC_SHAPE_RUN;
    trace_arcs(page, where, arcs, run ? count - 4 : count);
    stroke_path(page, hit ? HIT_LINE : FREE_LINE, clamp(2 * OUTLINE * size, THINNEST, THICKEST));
}

/* The part of it that may be on the page, seen from the page's middle. */
static void paint_half_plane(canvas *page, const view *seen, narc_point origin, double cosine, double sine, bool hit) {
    const double reach = seen->width + seen->height, x = seen->width / 2, y = seen->height / 2;
    const double above = clamp((x - origin.x) * -sine + (y - origin.y) * -cosine, -2 * reach, 2 * reach);
    const double corners[4][2] = {{-reach, 0}, {reach, 0}, {reach, -4 * reach}, {-reach, -4 * reach}};
    for (int k = 0; k < 4; k++) {
        const double side = corners[k][0], up = corners[k][1] - above;
        cairo_line_to(page->pen, x + side * cosine - up * sine, y - side * sine - up * cosine);
    }
    cairo_close_path(page->pen);
    paint_path(page, hit ? HIT_FILL : FREE_FILL, hit ? HIT_LINE : FREE_LINE, THICKEST);
}

static void draw_body(canvas *page, const view *seen, const body_scene *scene, stamps *made, size_t index) {
    const body *drawn = &scene->bodies->items[index];
    const narc_named_shape *form = &scene->shapes->items[drawn->item];
    const double zoom = seen->zoom * (double)drawn->scale, size = pixel_size(seen, scene, index);
    const double cosine = (double)drawn->cosine, sine = (double)drawn->sine;
    const narc_point origin = to_page(seen, drawn->x, drawn->y);
    const placement where = {origin.x, origin.y, zoom * cosine, zoom * sine};
    const bool hit = scene->marked[index];
    if (form->form == NARC_FORM_HALF_PLANE) {
        paint_half_plane(page, seen, origin, cosine, sine, hit);
        return;
    }
    if (form->form != NARC_FORM_SHAPE) {
        paint_entry(page, &where, scene->store, drawn->shape, hit, size);
        return;
    }
    if (!made->bodies) {
        paint_body(page, &where, form, hit, size);
        return;
    }
    const size_t k = 2 * (size_t)drawn->item + hit;
    if (!made->bodies[k].surface) {
        open_body_stamp(&made->bodies[k], form, hit, size, zoom);
        made->zooms[k] = zoom;
    }
    const double ratio = zoom / made->zooms[k];
    use_stamp(page, &made->bodies[k], origin, ratio * cosine, ratio * sine);
}

/* A contact point and its normal, sized after a body. */
static void paint_contact(canvas *page, narc_point p, narc_point normal, bool touching, double size) {
    const double length = NORMAL_LENGTH * size;
    set_color(page, touching ? CONTACT : NEAR_CONTACT);
    cairo_set_line_width(page->pen, clamp(NORMAL_LINE * size, THINNEST, THICKEST));
    cairo_move_to(page->pen, p.x, p.y);
    cairo_line_to(page->pen, p.x + length * normal.x, p.y - length * normal.y);
    cairo_stroke(page->pen);
    draw_dot(page, p, clamp(DOT * size, 0.8 * THINNEST, 2 * THICKEST));
}

/* Contact k, sized after the smaller body. */
static void draw_contact(canvas *page, const view *seen, const body_scene *scene, stamps *made, size_t k) {
    const narc_contact *contact = &scene->contacts[k];
    const pair of = scene->pairs->items[contact->pair];
    const double size = fmin(pixel_size(seen, scene, of.a), pixel_size(seen, scene, of.b));
    const body *a = &scene->bodies->items[of.a];
    const narc_point p = to_page(seen, a->x + (double)contact->point_x, a->y + (double)contact->point_y);
    const narc_point normal = {(double)contact->normal_x, (double)contact->normal_y};
    const bool touching = contact->separation < 0;
    canvas *stamp = &made->contacts[touching];
    if (!made->bodies) {
        paint_contact(page, p, normal, touching, size);
        return;
    }
    if (!stamp->surface) {
        const double margin = 2 * THICKEST;
        open_stamp(stamp, (narc_aabb){-margin, -margin, NORMAL_LENGTH * size + margin, margin});
        paint_contact(stamp, (narc_point){0, 0}, (narc_point){1, 0}, touching, size);
        made->sizes[touching] = size;
    }
    const double ratio = size / made->sizes[touching];
    use_stamp(page, stamp, p, ratio * normal.x, ratio * normal.y);
}

/* Ray k, and where it hits with the normal there, sized after the body. Only the nearest hit of a ray, or its end, has a
 * line from its start; what ends beyond the page is cut off there. */
static void draw_ray(canvas *page, const view *seen, const body_scene *scene, size_t k) {
    const drawn_ray *ray = &scene->rays[k];
    const narc_point from = to_page(seen, ray->x, ray->y);
    narc_point to = to_page(seen, ray->end_x, ray->end_y);
    const double length = hypot(to.x - from.x, to.y - from.y), longest = seen->width + seen->height;
    if (!has_hit(seen, scene, ray) && length > longest)
        to = (narc_point){from.x + (to.x - from.x) / length * longest, from.y + (to.y - from.y) / length * longest};
    if (k % scene->hits_per_ray == 0) {
        set_color(page, NEAR_CONTACT);
        cairo_set_line_width(page->pen, 2 * THINNEST);
        cairo_move_to(page->pen, from.x, from.y);
        cairo_line_to(page->pen, to.x, to.y);
        cairo_stroke(page->pen);
        draw_dot(page, from, THICKEST);
    }
    if (has_hit(seen, scene, ray)) {
        const double size = pixel_size(seen, scene, ray->hit.body);
        paint_contact(page, to, (narc_point){(double)ray->hit.normal_x, (double)ray->hit.normal_y}, true, size);
    }
}

/* ---------------------------------------------------------------------------- legend */

static void draw_sample_of(canvas *page, int of, double x, double y, double half) {
    if (of == FREE || of == HIT) {
        cairo_new_sub_path(page->pen);
        cairo_arc(page->pen, x, y, 0.6 * half, 0, FULL_TURN);
        paint_path(page, of == HIT ? HIT_FILL : FREE_FILL, of == HIT ? HIT_LINE : FREE_LINE, OUTLINE * 2 * half);
    } else {
        set_color(page, of == TOUCHING ? CONTACT : NEAR_CONTACT);
        cairo_set_line_width(page->pen, 0.12 * half);
        cairo_move_to(page->pen, x - 0.6 * half, y);
        cairo_line_to(page->pen, x + 0.6 * half, y);
        cairo_stroke(page->pen);
        draw_dot(page, (narc_point){x - 0.6 * half, y}, 0.2 * half);
    }
}

static void draw_legend_of(canvas *page, const view *seen, const body_scene *scene) {
    static const char *const words[SAMPLE_COUNT] = {
        "collides with none", "collides", "contact: point, normal from a to b", "the same of a pair that is apart"};
    static const char *const filter_words[SAMPLE_COUNT] = {"in no pair that passes", "in a pair that passes", "", ""};
    static const char *const ray_words[SAMPLE_COUNT] = {"is hit by none", "is hit", "hit: point, normal outwards",
                                                        "ray"};
    if (has_legend(seen->shown)) {
        draw_legend(page,
                    scene->is_filter   ? filter_words
                    : scene->ray_count ? ray_words
                                       : words,
                    seen->shown, SAMPLE_COUNT, draw_sample_of, seen->width / 2,
                    seen->height - 0.5 * LEGEND_HEIGHT * seen->text, seen->text, seen->width - 2 * MARGIN);
    }
}

/* ---------------------------------------------------------------------------- pictures */

void check_picture_size(const char *path, size_t body_count) {
    if (picture_kind_of(path) == PICTURE_SVG && body_count > MOST_SVG_BODIES) {
        fail("%s: %zu bodies, an .svg picture has at most %d; a .png picture can have more", path, body_count,
             MOST_SVG_BODIES);
    }
}

static void check_items(const char *path, const body_scene *scene) {
    const size_t marks = scene->contact_count + scene->ray_count;
    if (picture_kind_of(path) == PICTURE_SVG && marks > MOST_SVG_ITEMS - scene->bodies->count) {
        fail("%s: %zu bodies and %zu %s, an .svg picture has at most %d of both; a .png picture can have more", path,
             scene->bodies->count, marks, scene->ray_count ? "rays" : "contacts", MOST_SVG_ITEMS);
    }
}

static stamps make_stamps(picture_kind kind, size_t shape_count) {
    stamps made = {0};
    if (kind == PICTURE_SVG) {
        made.bodies = allocate(2 * shape_count, sizeof *made.bodies);
        made.zooms = allocate(2 * shape_count, sizeof *made.zooms);
        memset(made.bodies, 0, 2 * shape_count * sizeof *made.bodies);
    }
    return made;
}

static void free_stamps(stamps *made, size_t shape_count) {
    for (size_t k = 0; made->bodies && k < 2 * shape_count; k++)
        close_stamp(&made->bodies[k]);
    for (int k = 0; k < 2; k++)
        close_stamp(&made->contacts[k]);
    free(made->bodies);
    free(made->zooms);
}

void draw_bodies(const char *path, FILE *file, const body_scene *scene) {
    check_items(path, scene);
    const view seen = choose_view(path, scene);
    canvas page;
    open_canvas(&page, path, file, seen.width, seen.height);
    stamps made = make_stamps(page.kind, scene->shapes->count);
    const size_t count = scene->bodies->count, steps = 2 * count + scene->contact_count + scene->ray_count;
    for (size_t i = 0; i < 2 * count; i++) {
        if (scene->marked[i % count] == (i >= count) && has_body(&seen, scene, i % count))
            draw_body(&page, &seen, scene, &made, i % count);
        show_progress("drawing", i, steps);
    }
    for (size_t k = 0; k < scene->contact_count; k++) {
        if (has_contact(&seen, scene, k))
            draw_contact(&page, &seen, scene, &made, k);
        show_progress("drawing", 2 * count + k, steps);
    }
    for (size_t k = 0; k < scene->ray_count; k++) {
        if (has_ray(&seen, &scene->rays[k]))
            draw_ray(&page, &seen, scene, k);
        show_progress("drawing", 2 * count + k, steps);
    }
    draw_legend_of(&page, &seen, scene);
    finish_canvas(&page);
    free_stamps(&made, scene->shapes->count);
}
