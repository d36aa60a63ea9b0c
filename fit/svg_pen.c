/* SPDX-License-Identifier: MIT
 *
 * svg_pen.c - draws in the coordinates of an SVG element, elliptical arcs too.
 */
#include "svg_pen.h"

#include <float.h>
#include <math.h>

static const double PI = 3.14159265358979323846;

/* Maps a point to the path's coordinates. */
static narc_status map_point(const narc_svg_pen *pen, narc_point point, narc_point *out_point, narc_svg_fault *fault) {
    const narc_point p = narc_apply_affine(&pen->map, point);
    if (!isfinite(p.x) || !isfinite(p.y)) {
        return narc_set_fault(fault, NARC_ERROR_NOT_FINITE, "a coordinate that is not finite", NULL,
                              isfinite(p.x) ? p.y : p.x);
    }
    if (fabs(p.x) > NARC_MAX_COORDINATE || fabs(p.y) > NARC_MAX_COORDINATE) {
        return narc_set_fault(fault, NARC_ERROR_SIZE, "a coordinate beyond 1e9", NULL,
                              fabs(p.x) > NARC_MAX_COORDINATE ? p.x : p.y);
    }
    *out_point = p;
    return NARC_OK;
}

/* Are the points at one place, or on one line? Up to rounding: a coordinate that was mapped is known to some
 * DBL_EPSILON of the largest one. Control points on a line mean a curve on it. */
static bool is_flat(const narc_point *points, size_t count, bool one_place) {
    const narc_point first = points[0];
    narc_point far = {0, 0};
    double largest = 0, reach = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_point to = {points[k].x - first.x, points[k].y - first.y};
        largest = fmax(largest, fmax(fabs(points[k].x), fabs(points[k].y)));
        if (hypot(to.x, to.y) > reach) {
            reach = hypot(to.x, to.y);
            far = to;
        }
    }
    const double rounding = 16 * DBL_EPSILON * largest;
    bool flat = !one_place || reach <= rounding;
    for (size_t k = 0; k < count && flat; k++) {
        const double cross = far.x * (points[k].y - first.y) - far.y * (points[k].x - first.x);
        flat = fabs(cross) <= rounding * reach;
    }
    return flat;
}

static void end_contour(narc_svg_pen *pen) {
    const size_t first = pen->mark.point_count;
    if (pen->down && !pen->dots && is_flat(pen->path->points + first, pen->path->point_count - first, pen->lines)) {
        narc_rewind_path(pen->path, pen->mark);
    }
    pen->down = false;
}

void narc_pen_move(narc_svg_pen *pen, narc_point to) {
    end_contour(pen);
    pen->start = pen->at = to;
}

/* Draws to the last of `points`; the others are control points. */
static narc_status draw(narc_svg_pen *pen, const narc_point *points, size_t count, narc_svg_fault *fault) {
    narc_point mapped[3], start;
    for (size_t k = 0; k < count; k++) {
        const narc_status status = map_point(pen, points[k], &mapped[k], fault);
        if (status) {
            return status;
        }
    }
    if (pen->budget == 0) {
        return narc_set_fault(fault, NARC_ERROR_SIZE, "elements are used again too often", NULL, 0);
    }
    pen->budget--;
    narc_status status = NARC_OK;
    if (!pen->down) {
        status = map_point(pen, pen->start, &start, fault);
        if (status) {
            return status;
        }
        pen->mark = narc_mark_path(pen->path);
        status = narc_move_to(pen->path, start, NULL);
    }
    if (!status) {
        status = count == 1   ? narc_line_to(pen->path, mapped[0], NULL)
                 : count == 2 ? narc_quadratic_to(pen->path, mapped[0], mapped[1], NULL)
                              : narc_cubic_to(pen->path, mapped[0], mapped[1], mapped[2], NULL);
    }
    pen->down = true;
    pen->at = points[count - 1];
    return status ? narc_set_fault(fault, status, "no memory for the outline", NULL, 0) : NARC_OK;
}

narc_status narc_pen_line(narc_svg_pen *pen, narc_point to, narc_svg_fault *fault) { return draw(pen, &to, 1, fault); }

narc_status narc_pen_quadratic(narc_svg_pen *pen, narc_point control, narc_point to, narc_svg_fault *fault) {
    return draw(pen, (const narc_point[]){control, to}, 2, fault);
}

narc_status narc_pen_cubic(narc_svg_pen *pen, const narc_point controls[2], narc_point to, narc_svg_fault *fault) {
    return draw(pen, (const narc_point[]){controls[0], controls[1], to}, 3, fault);
}

/* A path's contours close by themselves; what is drawn next begins another one at the same place. */
void narc_pen_close(narc_svg_pen *pen) { narc_pen_move(pen, pen->start); }

/* The point and the tangent's control vector of a turning pen at an angle. Points are reckoned from the first one by
 * the chord to it, p(b) - p(a) = 2 sin((b - a)/2) (-sin m, cos m) with m = (a + b)/2, not from the centre: a nearly
 * straight arc has a centre so far away that its coordinates say nothing about the arc. */
static narc_point turn_chord(const narc_affine *map, double a, double b) {
    const double length = 2 * sin((b - a) / 2), m = (a + b) / 2;
    return narc_apply_affine(map, (narc_point){-length * sin(m), length * cos(m)});
}

static narc_point turn_tangent(const narc_affine *map, double angle, double length) {
    return narc_apply_affine(map, (narc_point){-length * sin(angle), length * cos(angle)});
}

narc_status narc_pen_turn(narc_svg_pen *pen, const narc_ellipse *ellipse, double from, double turn, narc_point to,
                          narc_svg_fault *fault) {
    const double c = cos(ellipse->tilt), s = sin(ellipse->tilt);
    const narc_affine map = {
        c * ellipse->radius_x, s * ellipse->radius_x, -s * ellipse->radius_y, c * ellipse->radius_y, 0, 0};
    /* A turn that misses a whole number of pieces by rounding alone gets no piece more. */
    const int pieces = (int)fmax(1, ceil(fabs(turn) / (PI / 6) - 1e-9));
    const double reach = 4.0 / 3 * tan(turn / pieces / 4);
    const narc_point first = pen->at;
    for (int k = 0; k < pieces; k++) {
        const double a = from + turn * k / pieces, b = from + turn * (k + 1) / pieces;
        const narc_point chord = turn_chord(&map, from, b);
        const narc_point end = k + 1 == pieces ? to : (narc_point){first.x + chord.x, first.y + chord.y};
        const narc_point leave = turn_tangent(&map, a, reach), arrive = turn_tangent(&map, b, reach);
        const narc_point controls[2] = {{pen->at.x + leave.x, pen->at.y + leave.y},
                                        {end.x - arrive.x, end.y - arrive.y}};
        const narc_status status = narc_pen_cubic(pen, controls, end, fault);
        if (status) {
            return status;
        }
    }
    return NARC_OK;
}

/* In the frame where the ellipse is a unit circle, the chord from the pen to `to` is 2d (ux, uy) with d <= 1, and the
 * centre is sqrt(1 - d^2) from its middle, at right angles to it: on the side to which x turned towards y points if
 * just one of large and sweep is set, else on the other. Half the arc's angle is asin(d), or pi less that. */
narc_status narc_pen_arc(narc_svg_pen *pen, const narc_svg_arc *arc, narc_point to, narc_svg_fault *fault) {
    const double dx = (to.x - pen->at.x) / 2, dy = (to.y - pen->at.y) / 2;
    const double tilt = fmod(arc->tilt, 360) * (PI / 180), c = cos(tilt), s = sin(tilt);
    const double rx = fabs(arc->radius_x), ry = fabs(arc->radius_y);
    if (dx == 0 && dy == 0) {
        return NARC_OK;
    }
    const double hx = (c * dx + s * dy) / rx, hy = (c * dy - s * dx) / ry, half_chord = hypot(hx, hy);
    if (rx == 0 || ry == 0 || half_chord == 0) {
        return narc_pen_line(pen, to, fault);
    }
    const double enlarge = fmax(1, half_chord), d = fmin(1, half_chord);
    const double ux = hx / half_chord, uy = hy / half_chord, away = sqrt((1 - d) * (1 + d));
    const double side = arc->large == arc->sweep ? -away : away;
    const double from = atan2(-d * uy - side * ux, -d * ux + side * uy);
    const double half = arc->large ? PI - asin(d) : asin(d);
    const narc_ellipse ellipse = {.radius_x = rx * enlarge, .radius_y = ry * enlarge, .tilt = tilt};
    return narc_pen_turn(pen, &ellipse, from, arc->sweep ? 2 * half : -2 * half, to, fault);
}
