/* SPDX-License-Identifier: MIT
 *
 * directions.c - figures of the gap as a function of the direction: its maxima, and the search for one.
 */
#include <math.h>
#include <stdio.h>

#include "figures.h"

static const double pi = 3.14159265358979323846;

/* Numbers beside the arcs of a body. */
static void write_numbers(sheet *page, const outline *shape, double distance) {
    for (size_t k = 0; k < shape->count; k++) {
        const narc_arc *arc = &shape->arc[k];
        const double middle = (arc->start + arc->end) / 2;
        char text[8];
        snprintf(text, sizeof text, "%d", (int)k + 1);
        write_words(page, arc->center_x + arc->radius * cos(middle), arc->center_y + arc->radius * sin(middle),
                    distance * cos(middle), 4 - distance * sin(middle), 0, 11, text);
    }
}

/* g over the directions from one angle to another. */
static void trace_gap(sheet *page, const outline *a, const outline *b, double from, double to) {
    const int steps = 500;
    for (int k = 0; k <= steps; k++) {
        const double angle = from + (to - from) * k / steps;
        const narc_point at = on_page(page, angle, gap_at(a, b, wrap_angle(angle)));
        cairo_line_to(page->pen, at.x, at.y);
    }
    cairo_stroke(page->pen);
}

void draw_directions(const char *folder) {
    sheet page = open_page(folder, "directions", 900, 360);
    const outline a = place_outline(make_bean(), 0, 0, 0.25), b = place_outline(make_block(), 0.55, 0.5, 2.75);
    interval intervals[MOST];
    maximum maxima[MOST];
    const size_t count = overlay_fans(&a, &b, intervals), found = find_maxima(intervals, count, maxima);
    const maximum best = find_highest(maxima, found);

    set_view(&page, 128, 185, 50, 50);
    paint_outline(&page, &a, BLUE, 0.13);
    paint_outline(&page, &b, ORANGE, 0.13);
    set_pen(&page, BLUE, 1, 1, 0);
    write_numbers(&page, &a, 10);
    set_pen(&page, ORANGE, 1, 1, 0);
    write_numbers(&page, &b, -10);
    write_words(&page, 0.3, 0.75, 0, 0, 0, 18, "B");
    set_pen(&page, BLUE, 1, 1, 0);
    write_words(&page, -1.2, -0.3, 0, 0, 0, 18, "A");

    const double low = -4.3, high = 0.3, wide = 560 / (2 * pi);
    set_view(&page, 312, 42, wide, 58);
    for (size_t k = 0; k < count; k++) {
        const double start = intervals[k].start, end = fmin(intervals[k].end, 2 * pi);
        const narc_point corner = on_page(&page, start, high);
        if (k % 2) {
            set_pen(&page, PALE, 0.3, 1, 0);
            cairo_rectangle(page.pen, corner.x, corner.y, wide * (end - start), page.scale_y * (high - low));
            cairo_fill(page.pen);
        }
        if (end - start > 0.36) {
            set_pen(&page, GREY, 1, 1, 0);
            write_pair(&page, (start + end) / 2, low, 0, -7, 11, intervals[k].i, intervals[k].j);
        }
    }
    set_pen(&page, INK, 1, 1.2, 0);
    draw_line(&page, 0, 0, 2 * pi, 0);
    draw_line(&page, 0, low, 0, high);
    write_formula(&page, 0, 0, -8, 5, 1, 13, "0");
    write_formula(&page, 0, high, 8, 8, -1, 16, "g(n)");
    for (int k = 0; k <= 4; k++) {
        char text[16];
        snprintf(text, sizeof text, "%d°", 90 * k);
        draw_line(&page, pi / 2 * k, low, pi / 2 * k, low - 0.06);
        write_words(&page, pi / 2 * k, low, 0, 20, 0, 12, text);
    }
    write_words(&page, pi, low, 0, 42, 0, 13, "direction n");
    set_pen(&page, INK, 1, 2.4, 0);
    trace_gap(&page, &a, &b, 0, 2 * pi);
    for (size_t k = 0; k < found; k++) {
        const maximum *m = &maxima[k];
        const double angle = wrap_angle(m->angle);
        const bool top = m->angle == best.angle;
        set_pen(&page, m->kink ? PURPLE : GREEN, 1, 2, 0);
        draw_dot(&page, angle, m->value, top ? 6.5 : 5);
        if (m->kink)
            write_words(&page, angle, m->value, top ? -14 : 0, top ? -8 : -10, top ? 1 : 0, 12, "edge of B");
        else
            write_pair(&page, angle, m->value, 0, -10, 12, intervals[m->interval].i, intervals[m->interval].j);
    }
    set_pen(&page, RED, 1, 1.6, 0);
    const double angle = wrap_angle(best.angle);
    draw_arrow(&page, angle, best.value / 2, angle, 0);
    draw_arrow(&page, angle, best.value / 2, angle, best.value + 0.2);
    write_words(&page, angle, best.value / 2, 8, 0, -1, 12, "depth");
    finish_page(&page);
}

static const interval *interval_of(const interval *intervals, size_t count, double angle) {
    for (size_t k = 0; k < count; k++)
        if (wrap_angle(angle - intervals[k].start) < intervals[k].end - intervals[k].start)
            return &intervals[k];
    return intervals;
}

void draw_search(const char *folder) {
    sheet page = open_page(folder, "search", 900, 390);
    const double b_x = 0.6, b_y = 1.05;
    const outline a = place_outline(make_bean(), 0, 0, 0.35), b = place_outline(make_bean(), b_x, b_y, 2.2);
    interval intervals[MOST];
    maximum maxima[MOST];
    const size_t count = overlay_fans(&a, &b, intervals);
    const maximum best = find_highest(maxima, find_maxima(intervals, count, maxima));
    const double axis = atan2(b_y, b_x) - 0.35;
    const interval *first = interval_of(intervals, count, axis);
    const double next = atan2(first->u_y, first->u_x), angles[] = {axis, next, best.angle};
    const color inks[] = {PURPLE, ORANGE, GREEN};

    set_view(&page, 128, 245, 50, 50);
    paint_outline(&page, &a, BLUE, 0.13);
    paint_outline(&page, &b, ORANGE, 0.13);
    set_pen(&page, BLUE, 1, 1, 0);
    write_words(&page, -1.15, -0.4, 0, 0, 0, 18, "A");
    set_pen(&page, ORANGE, 1, 1, 0);
    write_words(&page, 0, 2.45, 0, 0, 0, 18, "B");
    for (int k = 0; k < 3; k++) {
        const double c = cos(angles[k]), s = sin(angles[k]);
        set_pen(&page, inks[k], 1, 2.2, 0);
        draw_arrow(&page, 0.2, 0.4, 0.2 + 2.3 * c, 0.4 + 2.3 * s);
        write_words(&page, 0.2 + 2.55 * c, 0.4 + 2.55 * s, 0, 5, 0, 14, (const char *[]){"1", "2", "3"}[k]);
    }

    const double from = 0, to = 2.75, low = -3.15, wide = 550 / (to - from);
    set_view(&page, 320, 55, wide, 90);
    for (size_t k = 0; k < count; k++) {
        const double start = fmax(from, intervals[k].start), end = fmin(intervals[k].end, to);
        if (start >= end)
            continue;
        const narc_point corner = on_page(&page, start, 0.3);
        set_pen(&page, PALE, k % 2 ? 0.3 : 0, 1, 0);
        cairo_rectangle(page.pen, corner.x, corner.y, wide * (end - start), page.scale_y * (0.3 - low));
        cairo_fill(page.pen);
        set_pen(&page, GREY, 1, 1, 0);
        if (end - start > 0.2)
            write_pair(&page, (start + end) / 2, low, 0, -7, 11, intervals[k].i, intervals[k].j);
    }
    set_pen(&page, INK, 1, 1.2, 0);
    draw_line(&page, from, 0, to, 0);
    draw_line(&page, from, low, from, 0.3);
    write_formula(&page, from, 0, -8, 5, 1, 13, "0");
    write_formula(&page, from, 0.3, 8, 8, -1, 16, "g(n)");
    write_words(&page, (from + to) / 2, low, 0, 22, 0, 13, "direction n");
    set_pen(&page, INK, 1, 2.6, 0);
    trace_gap(&page, &a, &b, from, to);
    set_pen(&page, PURPLE, 1, 1.6, 5);
    for (int k = 0; k <= 400; k++) {
        const double t = 0.45 + (to - 0.45) * k / 400;
        const narc_point at = on_page(&page, t, cos(t) * first->u_x + sin(t) * first->u_y - first->radii);
        cairo_line_to(page.pen, at.x, at.y);
    }
    cairo_stroke(page.pen);
    const double top = hypot(first->u_x, first->u_y) - first->radii, value = gap_at(&a, &b, next);
    set_pen(&page, PURPLE, 1, 1.6, 0);
    draw_arrow(&page, next, top, next, value + 0.06);
    write_words(&page, next, top, 0, -9, 0, 13, "the top of its sinusoid lies along u");
    set_pen(&page, ORANGE, 1, 1.6, 0);
    /* The climb, just below the curve. */
    const int hops = 16;
    for (int k = 0; k < hops; k++) {
        const double t0 = next + (best.angle - next) * (0.1 + 0.8 * k / hops);
        const double t1 = next + (best.angle - next) * (0.1 + 0.8 * (k + 1) / hops);
        const double y0 = gap_at(&a, &b, t0) - 0.12, y1 = gap_at(&a, &b, t1) - 0.12;
        set_pen(&page, GREEN, 1, 1.8, 0);
        if (k + 1 < hops)
            draw_line(&page, t0, y0, t1, y1);
        else
            draw_arrow(&page, t0, y0, t1, y1);
    }
    static const char *const texts[] = {"1  probe along the axis", "2  probe along u", "3  hill climb"};
    static const int aligns[] = {-1, -1, 1};
    for (int k = 0; k < 3; k++) {
        set_pen(&page, inks[k], 1, 1.6, 0);
        draw_dot(&page, angles[k], gap_at(&a, &b, angles[k]), 5.5);
        write_words(&page, angles[k], gap_at(&a, &b, angles[k]), 10 * -aligns[k],
                    k == 0   ? 16
                    : k == 1 ? 0
                             : -8,
                    aligns[k], 13, texts[k]);
    }
    finish_page(&page);
}
