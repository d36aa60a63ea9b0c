/* SPDX-License-Identifier: MIT
 *
 * fans.c - figures of both shapes together: their normal fans, and their difference.
 */
#include <math.h>

#include "figures.h"

static const double pi = 3.14159265358979323846;

static void draw_ring(sheet *page, double inner, double outer, double start, double end, color ink, double alpha) {
    set_pen(page, ink, alpha, 1, 0);
    const narc_point center = on_page(page, 0, 0);
    cairo_new_path(page->pen);
    cairo_arc_negative(page->pen, center.x, center.y, outer, -start, -end);
    cairo_arc(page->pen, center.x, center.y, inner, -end, -start);
    cairo_close_path(page->pen);
    cairo_fill_preserve(page->pen);
    set_pen(page, ink, 1, 1.2, 0);
    cairo_stroke(page->pen);
}

void draw_fans(const char *folder) {
    sheet page = open_page(folder, "fans", 640, 470);
    const outline a = place_outline(make_pebble(), 0, 0, 0.3), b = place_outline(make_block(), 0, 0, 0.5);
    interval intervals[MOST];
    const size_t count = overlay_fans(&a, &b, intervals);
    set_view(&page, 225, 235, 1, 1);
    for (size_t k = 0; k < count; k++) {
        const interval *now = &intervals[k];
        const double middle = (now->start + now->end) / 2, c = cos(middle), s = sin(middle);
        draw_ring(&page, 116, 162, now->start, now->end, k % 2 ? GREEN : PURPLE, 0.13);
        set_pen(&page, INK, 1, 1, 0);
        if (now->end - now->start > 0.3)
            write_pair(&page, 139 * c, 139 * s, 0, 4, 12, now->i, now->j);
    }
    for (size_t i = 0; i < a.count; i++) {
        const double start = a.arc[i].start, end = a.arc[i].end, middle = (start + end) / 2;
        draw_ring(&page, 166, 206, start, end, BLUE, 0.13);
        set_pen(&page, BLUE, 0.9, 1, 3);
        draw_line(&page, 70 * cos(start), 70 * sin(start), 166 * cos(start), 166 * sin(start));
        set_pen(&page, BLUE, 1, 1, 0);
        write_index(&page, 186 * cos(middle), 186 * sin(middle), 0, 5, 15, 'a', i);
    }
    for (size_t j = 0; j < b.count; j++) {
        const double start = b.arc[j].start + pi, end = b.arc[j].end + pi, middle = (start + end) / 2;
        draw_ring(&page, 72, 112, start, end, ORANGE, 0.13);
        set_pen(&page, ORANGE, 0.9, 1, 3);
        draw_line(&page, 112 * cos(start), 112 * sin(start), 206 * cos(start), 206 * sin(start));
        set_pen(&page, ORANGE, 1, 1, 0);
        write_index(&page, 92 * cos(middle), 92 * sin(middle), 0, 5, 15, 'b', j);
    }
    /* The walk. */
    set_pen(&page, INK, 1, 1.6, 0);
    const narc_point center = on_page(&page, 0, 0);
    cairo_new_path(page.pen);
    cairo_arc_negative(page.pen, center.x, center.y, 46, 0.25 * pi, -1.05 * pi);
    cairo_stroke(page.pen);
    draw_arrow(&page, 46 * cos(1.02 * pi), 46 * sin(1.02 * pi), 46 * cos(1.14 * pi), 46 * sin(1.14 * pi));
    write_words(&page, 0, 0, 0, 5, 0, 13, "walk");

    static const struct {
        double y;
        const char *text, *more;
    } key[] = {{150, "normals of A's arcs", ""},
               {205, "both: m + n intervals,", "a pair (i, j) in each"},
               {278, "normals of B's arcs,", "negated"}};
    const color inks[] = {BLUE, PURPLE, ORANGE};
    set_view(&page, 0, 0, 1, 1);
    for (int k = 0; k < 3; k++) {
        set_pen(&page, inks[k], 0.25, 1, 0);
        cairo_rectangle(page.pen, 455, key[k].y, 16, 16);
        cairo_fill(page.pen);
        set_pen(&page, INK, 1, 1, 0);
        write_words(&page, 480, -key[k].y, 0, 13, -1, 13, key[k].text);
        write_words(&page, 480, -key[k].y, 0, 32, -1, 13, key[k].more);
    }
    finish_page(&page);
}

void draw_certificate(const char *folder) {
    sheet page = open_page(folder, "certificate", 640, 480);
    const outline a = place_outline(make_pebble(), 0, 0, 0.2), b = place_outline(make_pebble(), 0.35, 1.35, 1.9);
    const outline difference = subtract_outlines(&a, &b);
    interval intervals[MOST];
    maximum maxima[MOST];
    const size_t count = overlay_fans(&a, &b, intervals);
    const maximum best = find_highest(maxima, find_maxima(intervals, count, maxima));
    const double d = -best.value, c = cos(best.angle), s = sin(best.angle), x = 0.95;
    const double t = find_inner_radius(&a, best.angle) + find_inner_radius(&b, wrap_angle(best.angle + pi));
    const double m_x = cos(best.angle - x), m_y = sin(best.angle - x);
    const double center_x = (d - t) * c, center_y = (d - t) * s, reach = d * cos(x) + t * (1 - cos(x));
    set_view(&page, 300, 165, 62, 62);
    paint_outline(&page, &difference, GREY, 0.10);
    write_formula(&page, -2.1, -1.4, 0, 0, 0, 18, "K");

    /* Support lines of the circle: along n and along m. */
    set_pen(&page, INK, 1, 1.3, 5);
    draw_line(&page, d * c - 3 * s, d * s + 3 * c, d * c + 2 * s, d * s - 2 * c);
    set_pen(&page, PURPLE, 1, 1.3, 5);
    draw_line(&page, reach * m_x - 1.1 * m_y, reach * m_y + 1.1 * m_x, reach * m_x + 2.6 * m_y,
              reach * m_y - 2.6 * m_x);
    set_pen(&page, GREEN, 1, 2.4, 0);
    draw_circle(&page, center_x, center_y, t);
    draw_dot(&page, center_x, center_y, 4);
    draw_line(&page, center_x, center_y, center_x - t * s, center_y + t * c);
    write_formula(&page, center_x - 0.5 * t * s, center_y + 0.5 * t * c, 0, -8, 0, 18, "t");
    set_pen(&page, RED, 1, 2, 0);
    draw_circle(&page, 0, 0, d);
    draw_line(&page, 0, 0, -d * s, d * c);
    write_formula(&page, -0.5 * d * s, 0.5 * d * c, 0, -7, 0, 16, "d");
    set_pen(&page, PURPLE, 1, 1.8, 0);
    draw_arrow(&page, 0, 0, reach * m_x, reach * m_y);
    draw_arrow(&page, reach * m_x, reach * m_y, (reach + 0.8) * m_x, (reach + 0.8) * m_y);
    write_formula(&page, (reach + 0.95) * m_x, (reach + 0.95) * m_y, 4, 4, 0, 18, "m");
    set_pen(&page, INK, 1, 2, 0);
    draw_arrow(&page, d * c, d * s, (d + 0.8) * c, (d + 0.8) * s);
    write_formula(&page, (d + 0.8) * c, (d + 0.8) * s, -14, 10, 0, 18, "n");
    draw_dot(&page, 0, 0, 4);
    write_formula(&page, 0, 0, -10, 16, 0, 14, "0");
    draw_dot(&page, d * c, d * s, 4);
    finish_page(&page);
}
