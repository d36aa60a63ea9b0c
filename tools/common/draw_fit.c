/* SPDX-License-Identifier: MIT
 *
 * draw_fit.c - an outline and the shape fitted to it, on a page.
 */
#include "draw_fit.h"

#include <math.h>

const color ARC_TONES[3] = {{0.09, 0.34, 0.66, 1}, {0.90, 0.42, 0.08, 1}, {0.55, 0.20, 0.58, 1}},
            EDGE_TONE = {0.10, 0.55, 0.36, 1};

static const color WHITE = {1, 1, 1, 1};

/* Of a dot's radius: the white inside. */
static const double DOT_INSIDE = 0.55;

const narc_aabb EMPTY_BOX = {INFINITY, INFINITY, -INFINITY, -INFINITY};

narc_aabb join_boxes(narc_aabb a, narc_aabb b) {
    return (narc_aabb){fmin(a.min_x, b.min_x), fmin(a.min_y, b.min_y), fmax(a.max_x, b.max_x), fmax(a.max_y, b.max_y)};
}

double box_size(narc_aabb box) { return fmax(box.max_x - box.min_x, box.max_y - box.min_y); }

narc_aabb bound_fit(const narc_fit_result *fit) {
    narc_aabb box;
    narc_compute_aabb(fit->arcs, fit->arc_count, 0, &box);
    const narc_point at = fit->origin;
    return (narc_aabb){box.min_x + at.x, box.min_y + at.y, box.max_x + at.x, box.max_y + at.y};
}

narc_aabb bound_points(const narc_point *points, size_t count) {
    narc_aabb box = EMPTY_BOX;
    for (size_t i = 0; i < count; i++) {
        const narc_point p = points[i];
        box = join_boxes(box, (narc_aabb){p.x, p.y, p.x, p.y});
    }
    return box;
}

placement place_box(narc_aabb box, double left, double top, double width, double height) {
    const double size = fmin(width / (box.max_x - box.min_x), height / (box.max_y - box.min_y));
    return (placement){.origin_x = left + width / 2 - size * (box.min_x + box.max_x) / 2,
                       .origin_y = top + height / 2 + size * (box.min_y + box.max_y) / 2,
                       .cosine = size,
                       .sine = 0};
}

void trace_points(canvas *page, const placement *where, const narc_point *points, size_t count) {
    cairo_new_sub_path(page->pen);
    for (size_t i = 0; i < count; i++) {
        const narc_point p = place_point(where, points[i]);
        cairo_line_to(page->pen, p.x, p.y);
    }
    cairo_close_path(page->pen);
}

void trace_contours(canvas *page, const placement *where, const narc_contours *contours) {
    size_t start = 0;
    for (size_t k = 0; k < contours->count; start = contours->ends[k++])
        trace_points(page, where, contours->points + start, contours->ends[k] - start);
}

void draw_junction(canvas *page, narc_point center, double radius) {
    set_color(page, INK);
    draw_dot(page, center, radius);
    set_color(page, WHITE);
    draw_dot(page, center, DOT_INSIDE * radius);
}

void draw_corner(canvas *page, narc_point center, double radius) {
    set_color(page, INK);
    draw_dot(page, center, radius);
}

bool is_corner(const placement *where, const narc_arc *arc, const fit_look *look) {
    return arc->radius * (arc->end - arc->start) * hypot(where->cosine, where->sine) <= look->shortest;
}

/* The colour of arc `index` of `count`. */
static color choose_tone(size_t index, size_t count) {
    return ARC_TONES[count > 1 && count % 2 == 1 && index == count - 1 ? 2 : index % 2];
}

/* The point of an arc in the direction `angle`, on the page. */
static narc_point place_on_arc(const placement *where, const narc_arc *arc, double angle) {
    return place_point(
        where, (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)});
}

/* Corners lie over junctions: an arc that begins at a corner has a ring there. */
typedef enum layer { LINES, JUNCTIONS, CORNERS, LAYER_COUNT } layer;

/* What a layer has of arc i and the edge behind it. */
static void draw_piece(canvas *page, const placement *where, const narc_fit_result *fit, size_t i, color tone,
                       layer shown, const fit_look *look) {
    const narc_arc *arc = &fit->arcs[i], *next = &fit->arcs[(i + 1) % fit->arc_count];
    const narc_point start = place_on_arc(where, arc, arc->start), end = place_on_arc(where, arc, arc->end);
    const narc_point behind = place_on_arc(where, next, next->start);
    const bool has_edge = hypot(behind.x - end.x, behind.y - end.y) > look->shortest;
    if (shown == CORNERS && is_corner(where, arc, look)) {
        draw_corner(page, start, look->dot);
    } else if (shown == JUNCTIONS) {
        draw_junction(page, start, look->dot);
        if (has_edge)
            draw_junction(page, end, look->dot);
    } else if (shown == LINES) {
        trace_arcs(page, where, arc, 1);
        stroke_path(page, tone, look->line);
        if (has_edge) {
            cairo_move_to(page->pen, end.x, end.y);
            cairo_line_to(page->pen, behind.x, behind.y);
            stroke_path(page, EDGE_TONE, look->line);
        }
    }
}

static placement place_fit(const placement *outline, const narc_fit_result *fit) {
    const narc_point origin = place_point(outline, fit->origin);
    return (placement){origin.x, origin.y, outline->cosine, outline->sine};
}

void fill_fit(canvas *page, const placement *outline, const narc_fit_result *fit, color fill) {
    const placement where = place_fit(outline, fit);
    trace_arcs(page, &where, fit->arcs, fit->arc_count);
    set_color(page, fill);
    cairo_fill(page->pen);
}

void draw_fit(canvas *page, const placement *outline, const narc_fit_result *fit, const fit_look *look) {
    const placement where = place_fit(outline, fit);
    size_t visible = 0;
    for (size_t i = 0; i < fit->arc_count; i++)
        visible += !is_corner(outline, &fit->arcs[i], look);
    for (int shown = 0; shown < LAYER_COUNT; shown++) {
        for (size_t i = 0, index = 0; i < fit->arc_count; i++) {
            draw_piece(page, &where, fit, i, choose_tone(index, visible), (layer)shown, look);
            index += !is_corner(outline, &fit->arcs[i], look);
        }
    }
}

void draw_chains(canvas *page, const placement *outline, const narc_arc_chains *chains, const fit_look *look) {
    for (size_t k = 0, begin = 0; k < chains->count; begin = chains->ends[k++]) {
        for (size_t i = begin; i < chains->ends[k]; i++) {
            trace_curve_arc(page, outline, &chains->arcs[i]);
            stroke_path(page, chains->arcs[i].turn == 0 ? EDGE_TONE : choose_tone(i - begin, chains->ends[k] - begin),
                        look->line);
        }
    }
    for (size_t i = 0; i < chains->arc_count; i++)
        draw_junction(page, place_point(outline, chains->arcs[i].start), look->dot);
}
