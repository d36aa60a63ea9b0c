/* SPDX-License-Identifier: MIT
 *
 * svg_shapes.c - the elements of an SVG file that have an outline.
 */
#include "svg_shapes.h"

#include <math.h>
#include <string.h>

static const double PI = 3.14159265358979323846;

narc_status narc_get_length(const xmlNode *node, const char *name, double whole, double fallback, double *out_length,
                            narc_svg_fault *fault) {
    const char *text = narc_get_attribute(node, name);
    fault->attribute = name;
    if (!text) {
        *out_length = fallback;
        return NARC_OK;
    }
    return narc_parse_length(text, whole, out_length, fault);
}

/* A length that must not be negative; "auto" is as good as none. */
static narc_status get_size(const xmlNode *node, const char *name, double whole, double fallback, double *out_length,
                            narc_svg_fault *fault) {
    const char *text = narc_get_attribute(node, name);
    if (text && strcmp(text, "auto") == 0) {
        *out_length = fallback;
        return NARC_OK;
    }
    const narc_status status = narc_get_length(node, name, whole, fallback, out_length, fault);
    if (!status && *out_length < 0) {
        return narc_set_fault(fault, NARC_ERROR_SIZE, "a negative length", text, *out_length);
    }
    return status;
}

/* Two radii, of which a missing one is as the other; 0 if both are. */
static narc_status get_radii(const xmlNode *node, double whole_x, double whole_y, double *out_x, double *out_y,
                             narc_svg_fault *fault) {
    narc_status status = get_size(node, "rx", whole_x, NAN, out_x, fault);
    if (!status) {
        status = get_size(node, "ry", whole_y, NAN, out_y, fault);
    }
    if (!status) {
        *out_x = isnan(*out_x) ? *out_y : *out_x;
        *out_y = isnan(*out_y) ? *out_x : *out_y;
        if (isnan(*out_x)) {
            *out_x = *out_y = 0;
        }
    }
    return status;
}

/* The box of a rect: x, y, width, height. */
static narc_status get_box(const xmlNode *node, const narc_svg_view *view, double box[4], narc_svg_fault *fault) {
    narc_status status = narc_get_length(node, "x", view->width, 0, &box[0], fault);
    if (!status) {
        status = narc_get_length(node, "y", view->height, 0, &box[1], fault);
    }
    if (!status) {
        status = get_size(node, "width", view->width, 0, &box[2], fault);
    }
    return status ? status : get_size(node, "height", view->height, 0, &box[3], fault);
}

static narc_status draw_plain_rect(const double box[4], narc_svg_pen *pen, narc_svg_fault *fault) {
    const double right = box[0] + box[2], bottom = box[1] + box[3];
    const narc_point corners[3] = {{right, box[1]}, {right, bottom}, {box[0], bottom}};
    narc_status status = NARC_OK;
    narc_pen_move(pen, (narc_point){box[0], box[1]});
    for (int k = 0; k < 3 && !status; k++) {
        status = narc_pen_line(pen, corners[k], fault);
    }
    return status;
}

/* Side k of the rounded rectangle and the corner behind it; y points down, so that the turns are by growing angle. */
static narc_status draw_rounded_rect(const double box[4], double rx, double ry, narc_svg_pen *pen,
                                     narc_svg_fault *fault) {
    const double left = box[0], top = box[1], right = left + box[2], bottom = top + box[3];
    const narc_ellipse ellipse = {.radius_x = rx, .radius_y = ry};
    const narc_point before[4] = {{right - rx, top}, {right, bottom - ry}, {left + rx, bottom}, {left, top + ry}};
    const narc_point behind[4] = {{right, top + ry}, {right - rx, bottom}, {left, bottom - ry}, {left + rx, top}};
    narc_status status = NARC_OK;
    narc_pen_move(pen, behind[3]);
    for (int k = 0; k < 4 && !status; k++) {
        const bool side = pen->at.x != before[k].x || pen->at.y != before[k].y;
        status = side ? narc_pen_line(pen, before[k], fault) : NARC_OK;
        if (!status) {
            status = narc_pen_turn(pen, &ellipse, (k - 1) * (PI / 2), PI / 2, behind[k], fault);
        }
    }
    return status;
}

static narc_status draw_rect(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen, narc_svg_fault *fault) {
    double box[4], rx, ry;
    narc_status status = get_box(node, view, box, fault);
    if (!status) {
        status = get_radii(node, view->width, view->height, &rx, &ry, fault);
    }
    if (status || box[2] == 0 || box[3] == 0) {
        return status;
    }
    fault->attribute = "x, y, width, height";
    rx = fmin(rx, box[2] / 2);
    ry = fmin(ry, box[3] / 2);
    return rx > 0 && ry > 0 ? draw_rounded_rect(box, rx, ry, pen, fault) : draw_plain_rect(box, pen, fault);
}

static narc_status draw_ellipse(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen,
                                narc_svg_fault *fault) {
    const bool circle = strcmp(narc_get_svg_name(node), "circle") == 0;
    narc_point center;
    narc_ellipse ellipse = {0};
    narc_status status = narc_get_length(node, "cx", view->width, 0, &center.x, fault);
    if (!status) {
        status = narc_get_length(node, "cy", view->height, 0, &center.y, fault);
    }
    if (!status && circle) {
        status = get_size(node, "r", hypot(view->width, view->height) / sqrt(2), 0, &ellipse.radius_x, fault);
        ellipse.radius_y = ellipse.radius_x;
    } else if (!status) {
        status = get_radii(node, view->width, view->height, &ellipse.radius_x, &ellipse.radius_y, fault);
    }
    if (status || !(ellipse.radius_x > 0 && ellipse.radius_y > 0)) {
        return status;
    }
    fault->attribute = circle ? "cx, cy, r" : "cx, cy, rx, ry";
    const narc_point start = {center.x + ellipse.radius_x, center.y};
    narc_pen_move(pen, start);
    return narc_pen_turn(pen, &ellipse, 0, 2 * PI, start, fault);
}

static narc_status draw_line(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen, narc_svg_fault *fault) {
    narc_point from, to;
    narc_status status = narc_get_length(node, "x1", view->width, 0, &from.x, fault);
    if (!status) {
        status = narc_get_length(node, "y1", view->height, 0, &from.y, fault);
    }
    if (!status) {
        status = narc_get_length(node, "x2", view->width, 0, &to.x, fault);
    }
    if (!status) {
        status = narc_get_length(node, "y2", view->height, 0, &to.y, fault);
    }
    if (status) {
        return status;
    }
    fault->attribute = "x1, y1, x2, y2";
    narc_pen_move(pen, from);
    return narc_pen_line(pen, to, fault);
}

static narc_status draw_points(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen,
                               narc_svg_fault *fault) {
    (void)view;
    const char *text = narc_get_attribute(node, "points");
    const char *at = narc_skip_space(text ? text : "");
    fault->attribute = "points";
    for (size_t count = 0; *at; count++) {
        const char *start = at;
        narc_point point;
        if (!narc_take_number(&at, &point.x)) {
            return narc_set_fault(fault, NARC_ERROR_FORMAT, "a number is missing", at, 0);
        }
        at = narc_skip_comma(at);
        if (!narc_take_number(&at, &point.y)) {
            return narc_set_fault(fault, NARC_ERROR_FORMAT, "a point of a single number", start, 0);
        }
        at = narc_skip_comma(at);
        const narc_status status = count ? narc_pen_line(pen, point, fault) : NARC_OK;
        if (status) {
            fault->at = start;
            return status;
        }
        if (count == 0) {
            narc_pen_move(pen, point);
        }
    }
    return NARC_OK;
}

static narc_status draw_path(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen, narc_svg_fault *fault) {
    (void)view;
    const char *text = narc_get_attribute(node, "d");
    fault->attribute = "d";
    return text && strcmp(text, "none") != 0 ? narc_draw_svg_path(text, pen, fault) : NARC_OK;
}

narc_status narc_draw_svg_shape(const xmlNode *node, const narc_svg_view *view, narc_svg_pen *pen,
                                narc_svg_fault *fault) {
    static const struct shape {
        const char *name;
        narc_status (*draw)(const xmlNode *, const narc_svg_view *, narc_svg_pen *, narc_svg_fault *);
    } shapes[] = {{"path", draw_path}, {"rect", draw_rect},       {"circle", draw_ellipse}, {"ellipse", draw_ellipse},
                  {"line", draw_line}, {"polyline", draw_points}, {"polygon", draw_points}};
    const char *name = narc_get_svg_name(node);
    for (size_t k = 0; k < sizeof(shapes) / sizeof(shapes[0]); k++) {
        if (strcmp(name, shapes[k].name) == 0) {
            return shapes[k].draw(node, view, pen, fault);
        }
    }
    return NARC_OK;
}
