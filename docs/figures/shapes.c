/* SPDX-License-Identifier: MIT
 *
 * shapes.c - figures of shapes: the parts of one, and the gap between two.
 */
#include <math.h>

#include "figures.h"

static const double pi = 3.14159265358979323846;

/* Its centres lie well apart. */
static outline make_five_arc(void) {
    static const narc_point points[] = {{-1.22, -0.55}, {0.93, -0.95}, {1.3, 0.5}, {0.64, 1.06}, {-1.42, 0.36}};
    return outline_near(points, sizeof points / sizeof *points);
}

void draw_shape(const char *folder) {
    sheet page = open_page(folder, "shape", 640, 470);
    const outline shape = make_five_arc();
    set_view(&page, 325, 235, 145, 145);
    for (size_t i = 0; i < shape.count; i++) {
        set_pen(&page, color_of(i), 0.12, 1, 0);
        fill_sector(&page, &shape.arc[i]);
    }
    for (size_t i = 0; i < shape.count; i++) {
        const narc_arc *arc = &shape.arc[i];
        const double d_x = cos(arc->start), d_y = sin(arc->start), r = arc->radius;
        const double v_x = arc->center_x + r * d_x, v_y = arc->center_y + r * d_y;
        const narc_arc *before = &shape.arc[(i + shape.count - 1) % shape.count];
        const narc_arc *deeper = r > before->radius ? arc : before;
        set_pen(&page, GREY, 0.9, 1, 4);
        draw_line(&page, deeper->center_x, deeper->center_y, v_x, v_y);
        set_pen(&page, INK, 1, 1.5, 0);
        draw_arrow(&page, v_x, v_y, v_x + 0.36 * d_x, v_y + 0.36 * d_y);
        write_index(&page, v_x + 0.48 * d_x, v_y + 0.48 * d_y, 0, 5, 16, 'd', i);
    }
    for (size_t i = 0; i < shape.count; i++) {
        set_pen(&page, color_of(i), 1, 4, 0);
        draw_arc(&page, &shape.arc[i]);
    }
    for (size_t i = 0; i < shape.count; i++) {
        const narc_arc *arc = &shape.arc[i];
        const double middle = (arc->start + arc->end) / 2;
        set_pen(&page, color_of(i), 1, 1, 0);
        draw_dot(&page, arc->center_x, arc->center_y, 4.5);
        write_index(&page, arc->center_x, arc->center_y, -16 * cos(middle), 5 + 16 * sin(middle), 16, 'a', i);
        set_pen(&page, INK, 1, 1, 0);
        draw_dot(&page, arc->center_x + arc->radius * cos(arc->start), arc->center_y + arc->radius * sin(arc->start),
                 3);
    }
    finish_page(&page);
}

void draw_gap(const char *folder) {
    sheet page = open_page(folder, "gap", 760, 380);
    const double angle = 0.32, c = cos(angle), s = sin(angle);
    static const narc_point corners[] = {{-1.3, -0.9}, {1.3, -0.8}, {1.1, 0.9}, {-0.8, 1.1}};
    const outline a = place_outline(make_pebble(), -2.2, -0.25, 0.3);
    const outline b = place_outline(outline_of_polygon(corners, 4, 0.5), 2.15, 0.2, 0.75);
    const narc_arc *p = &a.arc[arc_at(&a, angle)], *q = &b.arc[arc_at(&b, angle + pi)];
    set_view(&page, 375, 208, 86, 86);
    paint_outline(&page, &a, BLUE, 0.13);
    paint_outline(&page, &b, ORANGE, 0.13);
    const double a_x = p->center_x + p->radius * c, a_y = p->center_y + p->radius * s;
    const double b_x = q->center_x - q->radius * c, b_y = q->center_y - q->radius * s;
    const double along_a = a_x * c + a_y * s, along_b = b_x * c + b_y * s, low = -1.55, high = 2.05;
    set_pen(&page, BLUE, 1, 1.5, 6);
    draw_line(&page, along_a * c - low * s, along_a * s + low * c, along_a * c - high * s, along_a * s + high * c);
    set_pen(&page, ORANGE, 1, 1.5, 6);
    draw_line(&page, along_b * c - low * s, along_b * s + low * c, along_b * c - high * s, along_b * s + high * c);

    set_pen(&page, GREY, 1, 1.8, 0);
    draw_arrow(&page, p->center_x, p->center_y, q->center_x, q->center_y);
    write_formula(&page, (p->center_x + q->center_x) / 2, (p->center_y + q->center_y) / 2, -8, 20, 0, 18, "u");
    set_pen(&page, BLUE, 1, 1.8, 0);
    draw_line(&page, p->center_x, p->center_y, a_x, a_y);
    draw_dot(&page, a_x, a_y, 4);
    draw_dot(&page, p->center_x, p->center_y, 4.5);
    write_formula(&page, p->center_x, p->center_y, -15, 6, 0, 18, "a_i");
    write_formula(&page, (p->center_x + a_x) / 2, (p->center_y + a_y) / 2, -6, -9, 0, 18, "r_i");
    write_words(&page, -3.1, -0.9, 0, 0, 0, 20, "A");
    set_pen(&page, ORANGE, 1, 1.8, 0);
    draw_line(&page, q->center_x, q->center_y, b_x, b_y);
    draw_dot(&page, b_x, b_y, 4);
    draw_dot(&page, q->center_x, q->center_y, 4.5);
    write_formula(&page, q->center_x, q->center_y, 16, 6, 0, 18, "b_j");
    write_formula(&page, (q->center_x + b_x) / 2, (q->center_y + b_y) / 2, -6, -9, 0, 18, "r_j");
    write_words(&page, 2.5, 0.6, 0, 0, 0, 20, "B");

    const double middle = (along_a + along_b) / 2, up = high - 0.25;
    const double from_x = middle * c - up * s, from_y = middle * s + up * c, half = (along_b - along_a) / 2;
    set_pen(&page, RED, 1, 2.4, 0);
    draw_arrow(&page, from_x, from_y, from_x + half * c, from_y + half * s);
    draw_arrow(&page, from_x, from_y, from_x - half * c, from_y - half * s);
    write_formula(&page, from_x, from_y, 8, 24, 0, 18, "g(n)");
    set_pen(&page, INK, 1, 2, 0);
    draw_arrow(&page, -3.7, 1.35, -3.7 + 0.9 * c, 1.35 + 0.9 * s);
    write_formula(&page, -3.7 + 0.45 * c, 1.35 + 0.45 * s, -6, -8, 0, 18, "n");
    finish_page(&page);
}
