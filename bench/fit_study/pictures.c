/* SPDX-License-Identifier: MIT
 *
 * pictures.c - pictures in the form of the paper's figures 6 to 9, one with the other outlines, one with grains.
 */
#include "pictures.h"

#include "draw_fit.h"
#include "output.h"
#include "study.h"

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

void open_picture(canvas *page, const char *path, double width, double height) {
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

void finish_picture(canvas *page) {
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

/* ---------------------------------------------------------------------------- the others */

/* An 8-arc and arcs with edges side by side, the name and both areas below. */
static void draw_pair(canvas *page, const subject *of, double left, double top, double cell) {
    static const family pair[] = {N_ARC, ARCS_AND_EDGES};
    static const style look = {.shape = {.line = 1.8, .dot = 2.2, .shortest = 0.9}, .text = 13};
    const double margin = 0.06 * cell;
    const narc_aabb box =
        join_boxes(bound_fit(&of->fits[N_ARC][LAST].made), bound_fit(&of->fits[ARCS_AND_EDGES][LAST].made));
    for (size_t k = 0; k < 2; k++) {
        const narc_fit_result *made = &of->fits[pair[k]][LAST].made;
        const double x = left + (double)k * cell;
        const placement where = place_box(box, x + margin, top + margin, cell - 2 * margin, cell - 2 * margin);
        draw_over(page, of, made, &where, &look);
        char text[32];
        snprintf(text, sizeof text, "%.4f", made->area / made->hull_area);
        draw_text(page, text, x + cell / 2, top + cell + look.text, look.text, cell);
    }
    draw_text(page, of->name, left + cell, top + cell + 2.3 * look.text, look.text, 2 * cell);
}

static bool is_other(const subject *of) { return of->of != PAPER && of->of != GRAINS && of->of != IMAGE; }

size_t count_others(const study *all) {
    size_t count = 0;
    for (size_t i = 0; i < all->count; i++)
        count += is_other(&all->subjects[i]);
    return count;
}

void draw_others(const study *all, const char *path) {
    enum { PAIRS_IN_ROW = 5 };
    const double cell = 102, gap = 22, row = cell + 44;
    const size_t rows = (count_others(all) + PAIRS_IN_ROW - 1) / PAIRS_IN_ROW;
    canvas page;
    open_picture(&page, path, PAIRS_IN_ROW * (2 * cell + gap), row * (double)rows);
    size_t drawn = 0;
    for (size_t i = 0; i < all->count; i++) {
        if (is_other(&all->subjects[i])) {
            draw_pair(&page, &all->subjects[i], gap / 2 + (2 * cell + gap) * (double)(drawn % PAIRS_IN_ROW),
                      row * (double)(drawn / PAIRS_IN_ROW), cell);
            drawn++;
        }
    }
    finish_picture(&page);
}

/* ---------------------------------------------------------------------------- grains */

/* An 8-arc over a grain, name and area below. */
static void draw_grain(canvas *page, const subject *of, double left, double top, double cell) {
    static const style look = {.shape = {.line = 2.2, .dot = 3, .shortest = 1.1}, .thin_line = 0.8, .text = 14};
    const double margin = 0.06 * cell;
    const narc_fit_result *made = &of->fits[N_ARC][LAST].made;
    const placement where =
        place_box(bound_fit(made), left + margin, top + margin, cell - 2 * margin, cell - 2 * margin);
    draw_over(page, of, made, &where, &look);
    char text[64];
    snprintf(text, sizeof text, "%s: %.4f", of->name, made->area / made->hull_area);
    draw_text(page, text, left + cell / 2, top + cell + look.text, look.text, cell);
}

void draw_grains(const study *all, const char *path) {
    const double cell = 190, row = cell + 30;
    size_t shown = 0;
    for (size_t i = 0; i < all->count; i++)
        shown += all->subjects[i].of == GRAINS && all->subjects[i].number <= SHOWN_GRAINS;
    canvas page;
    open_picture(&page, path, SHOWN_GRAINS * cell, row * (double)((shown + SHOWN_GRAINS - 1) / SHOWN_GRAINS));
    size_t drawn = 0;
    for (size_t i = 0; i < all->count; i++) {
        const subject *of = &all->subjects[i];
        if (of->of == GRAINS && of->number <= SHOWN_GRAINS) {
            draw_grain(&page, of, cell * (double)(drawn % SHOWN_GRAINS), row * (double)(drawn / SHOWN_GRAINS), cell);
            drawn++;
        }
    }
    finish_picture(&page);
}
