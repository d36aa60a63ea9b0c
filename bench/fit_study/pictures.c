/* SPDX-License-Identifier: MIT
 *
 * pictures.c - pictures in the form of the paper's figures 2 and 6 to 9, one with the other outlines, one with grains.
 */
#include "pictures.h"

#include <stdlib.h>

#include "draw_fit.h"
#include "fail.h"
#include "output.h"

static const color OUTLINE_FILL = {0.867, 0.867, 0.867, 1}, OUTLINE_LINE = {0.667, 0.667, 0.667, 1};
enum { LAST = SIZES - 1 };

/* In pixels. */
typedef struct style {
    fit_look shape;
    double thin_line; /* around the outline; 0: it is filled only */
    double text;
} style;

/* ---------------------------------------------------------------------------- one shape */

/* The outline and a fit over it. */
static void draw_over(canvas *page, const subject *of, const narc_fit_result *made, const placement *where,
                      const style *look) {
    trace_contours(page, where, &of->contours);
    set_color(page, OUTLINE_FILL);
    cairo_fill_preserve(page->pen);
    if (look->thin_line > 0)
        stroke_path(page, OUTLINE_LINE, look->thin_line);
    cairo_new_path(page->pen);
    draw_fit(page, where, made, &look->shape);
}

static void open_picture(canvas *page, const char *path, double width, double height) {
    open_canvas(page, path, open_output(path), width, height);
    cairo_select_font_face(page->pen, "sans-serif", CAIRO_FONT_SLANT_NORMAL, CAIRO_FONT_WEIGHT_NORMAL);
}

/* Fewer shades, 16 of each primary colour: the file is much smaller, and nobody sees it. */
static void thin_shades(cairo_surface_t *image) {
    enum { STEP = 17 };
    cairo_surface_flush(image);
    unsigned char *bytes = cairo_image_surface_get_data(image);
    const int stride = cairo_image_surface_get_stride(image), height = cairo_image_surface_get_height(image);
    for (int k = 0; k < stride * height; k++)
        bytes[k] = (unsigned char)((bytes[k] + STEP / 2) / STEP * STEP);
    cairo_surface_mark_dirty(image);
}

static void finish_picture(canvas *page) {
    thin_shades(page->surface);
    finish_canvas(page);
    finish_outputs();
    commit_outputs();
}

/* ---------------------------------------------------------------------------- figures 6 to 9 */

/* A row of the grid: the box around its three shapes, and its height. */
typedef struct grid_row {
    family which;
    narc_aabb box;
    double top, height;
} grid_row;

static void draw_row(canvas *page, const subject *of, const grid_row *row, double cell, double margin) {
    static const style look = {.shape = {.line = 3, .dot = 4.5, .shortest = 1.5}, .thin_line = 1, .text = 18};
    for (size_t size = 0; size < SIZES; size++) {
        const narc_fit_result *made = &of->fits[row->which][size].made;
        const double left = (double)size * (cell + 2 * margin) + margin;
        const placement where = place_box(row->box, left, row->top, cell, row->height);
        draw_over(page, of, made, &where, &look);
        char text[64];
        snprintf(text, sizeof text, "%zu-%s: %.4f", sizes[size], row->which == N_ARC ? "arc" : "gon",
                 made->area / made->hull_area);
        draw_text(page, text, left + cell / 2, row->top + row->height + 1.7 * look.text, look.text, cell);
    }
}

void draw_subject(const subject *of, const char *path) {
    const double cell = 290, margin = 16, caption = 48;
    grid_row rows[] = {{.which = N_ARC}, {.which = N_GON}};
    enum { ROWS = sizeof rows / sizeof rows[0] };
    narc_aabb all = EMPTY_BOX;
    for (size_t k = 0; k < ROWS; k++) {
        rows[k].box = EMPTY_BOX;
        for (size_t size = 0; size < SIZES; size++)
            rows[k].box = join_boxes(rows[k].box, bound_fit(&of->fits[rows[k].which][size].made));
        all = join_boxes(all, rows[k].box);
    }
    /* Both rows have the same scale and the outline at the same places across. */
    double height = 0;
    for (size_t k = 0; k < ROWS; k++) {
        rows[k].box.min_x = all.min_x;
        rows[k].box.max_x = all.max_x;
        rows[k].top = height + margin;
        rows[k].height = cell * (rows[k].box.max_y - rows[k].box.min_y) / (all.max_x - all.min_x);
        height += margin + rows[k].height + caption;
    }
    canvas page;
    open_picture(&page, path, SIZES * (cell + 2 * margin), height);
    for (size_t k = 0; k < ROWS; k++)
        draw_row(&page, of, &rows[k], cell, margin);
    finish_picture(&page);
}

/* ---------------------------------------------------------------------------- figure 2 */

void draw_bounds(const subject *of, const char *path) {
    const double cell = 230, margin = 18, caption = 44, text = 18;
    const bounds found = find_bounds(of);
    const narc_fit_result *fits[BOUNDS] = {[CIRCLE] = &found.circle, [POLYGON] = &of->fits[N_GON][LAST].made};
    const narc_aabb box =
        join_boxes(join_boxes(bound_fit(fits[CIRCLE]), bound_fit(fits[POLYGON])), bound_points(found.boxes[OBB], 4));
    canvas page;
    open_picture(&page, path, BOUNDS * (cell + 2 * margin), cell + 2 * margin + caption);
    for (int which = CIRCLE; which < BOUNDS; which++) {
        const double left = which * (cell + 2 * margin) + margin;
        const placement where = place_box(box, left, margin, cell, cell);
        char label[64];
        trace_contours(&page, &where, &of->contours);
        set_color(&page, OUTLINE_FILL);
        cairo_fill(page.pen);
        if (fits[which]) {
            const narc_point origin = place_point(&where, fits[which]->origin);
            const placement there = {origin.x, origin.y, where.cosine, where.sine};
            trace_arcs(&page, &there, fits[which]->arcs, fits[which]->arc_count);
            cairo_close_path(page.pen);
        } else {
            trace_points(&page, &where, found.boxes[which], 4);
        }
        stroke_path(&page, ARC_TONES[0], 3);
        snprintf(label, sizeof label, "%s: %.3f", bound_names[which], found.areas[which]);
        draw_text(&page, label, left + cell / 2, margin + cell + 1.7 * text, text, cell);
    }
    finish_picture(&page);
}

/* ---------------------------------------------------------------------------- many outlines */

/* The fits of an outline side by side, their areas below, and its name. */
static void draw_fits(canvas *page, const subject *of, const family *shown, size_t count, const style *look,
                      narc_point corner, double cell) {
    const double margin = 0.06 * cell;
    narc_aabb box = EMPTY_BOX;
    for (size_t k = 0; k < count; k++)
        box = join_boxes(box, bound_fit(&of->fits[shown[k]][LAST].made));
    for (size_t k = 0; k < count; k++) {
        const double x = corner.x + (double)k * cell;
        const placement where = place_box(box, x + margin, corner.y + margin, cell - 2 * margin, cell - 2 * margin);
        char text[64];
        draw_over(page, of, &of->fits[shown[k]][LAST].made, &where, look);
        snprintf(text, sizeof text, "%s%s%.4f", count > 1 ? "" : of->name, count > 1 ? "" : ": ",
                 value_of(of, shown[k], LAST, AREA));
        draw_text(page, text, x + cell / 2, corner.y + cell + look->text, look->text, cell);
    }
    if (count > 1)
        draw_text(page, of->name, corner.x + (double)count * cell / 2, corner.y + cell + 2.3 * look->text, look->text,
                  (double)count * cell);
}

/* 8-arcs of grains, the first of each sand; or 8-arcs and arcs with edges of all others but the paper's. */
void draw_many(const study *all, bool grains, const char *path) {
    static const family pair[] = {N_ARC, ARCS_AND_EDGES};
    static const style looks[] = {
        {.shape = {.line = 1.8, .dot = 2.2, .shortest = 0.9}, .text = 13},
        {.shape = {.line = 2.2, .dot = 3, .shortest = 1.1}, .thin_line = 0.8, .text = 14},
    };
    const double cell = grains ? 190 : 102, gap = grains ? 0 : 22, row = cell + (grains ? 30 : 44);
    const size_t shown = grains ? 1 : 2, in_row = grains ? SHOWN_GRAINS : 5;
    const subject **some = allocate(all->count, sizeof *some);
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (grains ? of->of == GRAINS && of->number <= SHOWN_GRAINS : of->of != PAPER && of->of != GRAINS)
            some[count++] = of;
    }
    if (count > 0) {
        const double width = (double)shown * cell + gap;
        canvas page;
        open_picture(&page, path, (double)in_row * width, row * (double)((count + in_row - 1) / in_row));
        for (size_t k = 0; k < count; k++)
            draw_fits(&page, some[k], pair, shown, &looks[grains],
                      (narc_point){gap / 2 + width * (double)(k % in_row), row * (double)(k / in_row)}, cell);
        finish_picture(&page);
    }
    free(some);
}
