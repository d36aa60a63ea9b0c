/* SPDX-License-Identifier: MIT
 *
 * pictures.c - pictures in the form of the paper's figures 6 to 9, and one with the other outlines.
 */
#include <math.h>

#include "../../tools/canvas.h"
#include "../../tools/output.h"
#include "study.h"

static const color OUTLINE_FILL = {0.867, 0.867, 0.867, 1}, OUTLINE_LINE = {0.667, 0.667, 0.667, 1};
static const color TONES[2] = {{0.09, 0.34, 0.66, 1}, {0.90, 0.42, 0.08, 1}}, EDGE_LINE = {0.10, 0.55, 0.36, 1};
static const color INK = {0.12, 0.14, 0.18, 1}, WHITE = {1, 1, 1, 1};

/* How a cell looks, in pixels. */
typedef struct style {
    double line, thin_line, dot; /* thin_line 0: the outline is filled only */
    double text;
} style;

/* ---------------------------------------------------------------------------- one shape */

static const narc_aabb NOWHERE = {INFINITY, INFINITY, -INFINITY, -INFINITY};

static narc_aabb join_boxes(narc_aabb a, narc_aabb b) {
    return (narc_aabb){fmin(a.min_x, b.min_x), fmin(a.min_y, b.min_y), fmax(a.max_x, b.max_x), fmax(a.max_y, b.max_y)};
}

/* The box of a fit in the outline's coordinates. */
static narc_aabb bound_fit(const fit *of) {
    narc_aabb box = NOWHERE;
    if (of->found) {
        narc_compute_aabb(of->made.arcs, of->made.arc_count, 0, &box);
        const narc_point at = of->made.origin;
        box = (narc_aabb){box.min_x + at.x, box.min_y + at.y, box.max_x + at.x, box.max_y + at.y};
    }
    return box;
}

/* The place of a box in the middle of a rectangle, as large as fits. */
static placement place_box(narc_aabb box, double left, double top, double width, double height) {
    const double size = fmin(width / (box.max_x - box.min_x), height / (box.max_y - box.min_y));
    return (placement){.origin_x = left + width / 2 - size * (box.min_x + box.max_x) / 2,
                       .origin_y = top + height / 2 + size * (box.min_y + box.max_y) / 2,
                       .cosine = size,
                       .sine = 0};
}

static void draw_outline(canvas *page, const placement *where, const narc_contours *contours, const style *look) {
    size_t start = 0;
    for (size_t k = 0; k < contours->count; start = contours->ends[k++]) {
        cairo_new_sub_path(page->pen);
        for (size_t i = start; i < contours->ends[k]; i++) {
            const narc_point p = place_point(where, contours->points[i]);
            cairo_line_to(page->pen, p.x, p.y);
        }
        cairo_close_path(page->pen);
    }
    set_color(page, OUTLINE_FILL);
    cairo_fill_preserve(page->pen);
    if (look->thin_line > 0) {
        set_color(page, OUTLINE_LINE);
        cairo_set_line_width(page->pen, look->thin_line);
        cairo_stroke(page->pen);
    }
    cairo_new_path(page->pen);
}

static narc_point point_on(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

static void draw_junction(canvas *page, narc_point p, double radius) {
    set_color(page, INK);
    draw_dot(page, p, radius);
    set_color(page, WHITE);
    draw_dot(page, p, 0.5 * radius);
}

static void stroke(canvas *page, color line, double width) {
    set_color(page, line);
    cairo_set_line_width(page->pen, width);
    cairo_stroke(page->pen);
}

/* Arcs and edges first, then the dots where they meet. */
static void draw_shape(canvas *page, const placement *outline, const narc_fit_result *of, const style *look) {
    const narc_point origin = place_point(outline, of->origin);
    const placement where = {origin.x, origin.y, outline->cosine, outline->sine};
    const double shortest_edge = 0.5 * look->line; /* on the page; shorter ones cannot be seen */
    for (int dots = 0; dots < 2; dots++) {
        for (size_t i = 0; i < of->arc_count; i++) {
            const narc_arc *arc = &of->arcs[i], *next = &of->arcs[(i + 1) % of->arc_count];
            const narc_point start = place_point(&where, point_on(arc, arc->start));
            const narc_point end = place_point(&where, point_on(arc, arc->end));
            const narc_point behind = place_point(&where, point_on(next, next->start));
            const bool has_edge = hypot(behind.x - end.x, behind.y - end.y) > shortest_edge;
            if (dots) {
                draw_junction(page, start, look->dot);
                draw_junction(page, end, look->dot);
                continue;
            }
            trace_arcs(page, &where, arc, 1);
            stroke(page, TONES[i % 2], look->line);
            if (has_edge) {
                cairo_move_to(page->pen, end.x, end.y);
                cairo_line_to(page->pen, behind.x, behind.y);
                stroke(page, EDGE_LINE, look->line);
            }
        }
    }
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
    for (int k = 0; k < stride * height; k++) {
        bytes[k] = (unsigned char)((bytes[k] + STEP / 2) / STEP * STEP);
    }
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
    static const style look = {.line = 3, .thin_line = 1, .dot = 4.5, .text = 18};
    for (size_t size = 0; size < SIZES; size++) {
        const narc_fit_result *made = &of->fits[row->which][size].made;
        const double left = (double)size * (cell + 2 * margin) + margin;
        const placement where = place_box(row->box, left, row->top, cell, row->height);
        draw_outline(page, &where, &of->contours, &look);
        draw_shape(page, &where, made, &look);
        char text[64];
        snprintf(text, sizeof text, "%zu-%s: %.4f", sizes[size], row->which == N_ARC ? "arc" : "gon",
                 made->area / made->hull_area);
        draw_text(page, text, left + cell / 2, row->top + row->height + 1.7 * look.text, look.text);
    }
}

void draw_subject(const subject *of, const char *path) {
    const double cell = 290, margin = 16, caption = 48;
    grid_row rows[] = {{.which = N_ARC}, {.which = N_GON}};
    enum { ROWS = sizeof rows / sizeof rows[0] };
    narc_aabb all = NOWHERE;
    for (size_t k = 0; k < ROWS; k++) {
        rows[k].box = NOWHERE;
        for (size_t size = 0; size < SIZES; size++) {
            rows[k].box = join_boxes(rows[k].box, bound_fit(&of->fits[rows[k].which][size]));
        }
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
    for (size_t k = 0; k < ROWS; k++) {
        draw_row(&page, of, &rows[k], cell, margin);
    }
    finish_picture(&page);
}

/* ---------------------------------------------------------------------------- the others */

/* An 8-arc and arcs with edges side by side, the name and both areas below. */
static void draw_pair(canvas *page, const subject *of, double left, double top, double cell) {
    static const family pair[] = {N_ARC, ARCS_AND_EDGES};
    static const style look = {.line = 1.8, .dot = 2.2, .text = 13};
    enum { LAST = SIZES - 1 };
    const double margin = 0.06 * cell;
    const narc_aabb box = join_boxes(bound_fit(&of->fits[N_ARC][LAST]), bound_fit(&of->fits[ARCS_AND_EDGES][LAST]));
    for (size_t k = 0; k < 2; k++) {
        const narc_fit_result *made = &of->fits[pair[k]][LAST].made;
        const double x = left + (double)k * cell;
        const placement where = place_box(box, x + margin, top + margin, cell - 2 * margin, cell - 2 * margin);
        draw_outline(page, &where, &of->contours, &look);
        draw_shape(page, &where, made, &look);
        char text[32];
        snprintf(text, sizeof text, "%.4f", made->area / made->hull_area);
        draw_text(page, text, x + cell / 2, top + cell + look.text, look.text);
    }
    draw_text(page, of->name, left + cell, top + cell + 2.3 * look.text, look.text);
}

void draw_others(const study *all, const char *path) {
    enum { PAIRS_IN_ROW = 5 };
    const double cell = 102, gap = 22, row = cell + 44;
    size_t count = 0;
    for (size_t i = PAPER_SUBJECTS; i < all->count; i++) {
        count += all->subjects[i].of != IMAGE;
    }
    canvas page;
    open_picture(&page, path, PAIRS_IN_ROW * (2 * cell + gap),
                 row * (double)((count + PAIRS_IN_ROW - 1) / PAIRS_IN_ROW));
    size_t drawn = 0;
    for (size_t i = PAPER_SUBJECTS; i < all->count; i++) {
        if (all->subjects[i].of != IMAGE) {
            draw_pair(&page, &all->subjects[i], gap / 2 + (2 * cell + gap) * (double)(drawn % PAIRS_IN_ROW),
                      row * (double)(drawn / PAIRS_IN_ROW), cell);
            drawn++;
        }
    }
    finish_picture(&page);
}
