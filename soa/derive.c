/* SPDX-License-Identifier: MIT
 *
 * derive.c - mass properties, perimeter, box, support point and distance of a list of arcs, in closed form.
 */
#include <math.h>

#include "elementary.h"
#include "outline.h"

/* A direction closer than this (radians) to an edge's normal is that normal: a few roundings of a unit vector. */
#define EDGE_NORMAL 1e-15

static bool read_list(const narc_arc *arcs, size_t count, const void *out, narc_outline *out_outline) {
    if (!arcs || !out || count == 0 || count > NARC_MAX_ARCS)
        return false;
    narc_read_outline(arcs, count, out_outline);
    return true;
}

/* ------------------------------------------------------------------------------------------------ mass */

/* t - sin t, by its series where the difference would cancel. */
static double subtract_sine(double t) {
    if (t > 0.5)
        return t - narc_sin(t);
    double s = t * t, sum = 1;
    for (int k = 15; k >= 5; k -= 2) /* the next factor would change 1 by 0.25^7 * 3! / 17!, far below a rounding */
        sum = 1 - s / (k * (k - 1)) * sum;
    return t * s / 6 * sum;
}

void narc_add_triangle(narc_moments *sum, narc_point a, narc_point b) {
    double area = (a.x * b.y - a.y * b.x) / 2;
    sum->area += area;
    sum->x += area * (a.x + b.x) / 3;
    sum->y += area * (a.y + b.y) / 3;
    sum->square += area / 6 * (a.x * a.x + a.y * a.y + b.x * b.x + b.y * b.y + a.x * b.x + a.y * b.y);
}

/* With its centre as the origin and the arc's middle direction m, half its sweep being f: area r^2/2 (2f - sin 2f),
 * first moment 2/3 r^3 sin^3 f along m, second r^4/4 (2f - sin 2f + 2/3 sin 2f sin^2 f). */
void narc_add_segment(narc_moments *sum, double ax, double ay, double r, double x, double y, double sweep) {
    double part = subtract_sine(sweep), c, s;
    narc_find_cosine(sweep / 2, &c, &s);
    double area = r * r / 2 * part, first = 2.0 / 3 * r * r * r * s * s * s;
    double mx = first * (x * c - y * s), my = first * (y * c + x * s);
    double second = r * r * r * r / 4 * (part + 4.0 / 3 * s * c * s * s);
    sum->area += area;
    sum->x += ax * area + mx;
    sum->y += ay * area + my;
    sum->square += (ax * ax + ay * ay) * area + 2 * (ax * mx + ay * my) + second;
}

bool narc_compute_mass(const narc_arc *arcs, size_t count, narc_mass *out_mass) {
    narc_outline o;
    if (!read_list(arcs, count, out_mass, &o))
        return false;
    /* Triangles from the outline's own origin, which lies on it: all are positive. */
    narc_moments sum = {0, 0, 0, 0};
    for (size_t i = 0; i < o.count; i++) {
        narc_point start = narc_find_start(&o, i), end = narc_find_end(&o, i);
        narc_add_triangle(&sum, start, end);
        narc_add_segment(&sum, o.center_x[i], o.center_y[i], o.radius[i], o.normal_x[i], o.normal_y[i], o.sweep[i]);
        narc_add_triangle(&sum, end, narc_find_start(&o, (i + 1) % o.count));
    }
    const bool flat = !(sum.area > 0); /* a segment: its middle */
    const double x = flat ? (o.center_x[0] + o.center_x[1]) / 2 : sum.x / sum.area;
    const double y = flat ? (o.center_y[0] + o.center_y[1]) / 2 : sum.y / sum.area;
    *out_mass = (narc_mass){sum.area, x + o.origin_x, y + o.origin_y, sum.square - sum.area * (x * x + y * y)};
    return true;
}

bool narc_compute_perimeter(const narc_arc *arcs, size_t count, double *out_perimeter) {
    narc_outline o;
    if (!read_list(arcs, count, out_perimeter, &o))
        return false;
    double sum = 0;
    for (size_t i = 0; i < o.count; i++) {
        narc_point from = narc_find_end(&o, i), to = narc_find_start(&o, (i + 1) % o.count);
        sum += o.radius[i] * o.sweep[i] + narc_hypot(to.x - from.x, to.y - from.y);
    }
    *out_perimeter = sum;
    return true;
}

/* ------------------------------------------------------------------------------------------------ box and support */

bool narc_compute_aabb(const narc_arc *arcs, size_t count, double angle, narc_aabb *out_aabb) {
    narc_outline o;
    double c, s;
    if (!isfinite(angle) || !read_list(arcs, count, out_aabb, &o))
        return false;
    narc_find_normal(angle, &c, &s);
    double x = c * o.origin_x - s * o.origin_y, y = s * o.origin_x + c * o.origin_y;
    /* The turned axes, x and y, are (c, -s) and (s, c) in the shape's own. */
    *out_aabb = (narc_aabb){.min_x = x - narc_find_height(&o, -c, s),
                            .min_y = y - narc_find_height(&o, -s, -c),
                            .max_x = x + narc_find_height(&o, c, -s),
                            .max_y = y + narc_find_height(&o, s, c)};
    return true;
}

/* The arc whose sector, closed at its start and open at its end, has the unit vector. */
static size_t find_arc(const narc_outline *o, double x, double y) {
    size_t nearest = 0;
    double most = -2;
    for (size_t i = 0; i < o->count; i++) {
        double along = o->normal_x[i] * x + o->normal_y[i] * y, left = o->normal_x[i] * y - o->normal_y[i] * x;
        if (along > 0 && fabs(left) <= EDGE_NORMAL)
            return i;
        if (along > most) {
            most = along;
            nearest = i;
        }
    }
    for (size_t i = 0; i < o->count; i++)
        if (narc_in_sector(o, i, x, y))
            return i;
    return nearest;
}

bool narc_find_support(const narc_arc *arcs, size_t count, double direction_x, double direction_y,
                       narc_point *out_point, size_t *out_arc) {
    narc_outline o;
    double length = narc_hypot(direction_x, direction_y);
    if (!(length > 0) || !isfinite(length) || !read_list(arcs, count, arcs, &o))
        return false;
    double x = direction_x / length, y = direction_y / length;
    size_t arc = find_arc(&o, x, y);
    if (out_point)
        *out_point = (narc_point){o.center_x[arc] + o.radius[arc] * x + o.origin_x,
                                  o.center_y[arc] + o.radius[arc] * y + o.origin_y};
    if (out_arc)
        *out_arc = count == 1 ? 0 : arc;
    return true;
}

/* ------------------------------------------------------------------------------------------------ distance */

bool narc_compute_distance(const narc_arc *arcs, size_t count, const narc_point *point, double *out_distance) {
    narc_outline o;
    if (!point || !isfinite(point->x) || !isfinite(point->y) || !read_list(arcs, count, out_distance, &o))
        return false;
    *out_distance = narc_find_point_separation(&o, point->x - o.origin_x, point->y - o.origin_y, NULL);
    return true;
}

bool narc_contains_point(const narc_arc *arcs, size_t count, const narc_point *point) {
    double distance;
    return narc_compute_distance(arcs, count, point, &distance) && distance <= 0;
}
