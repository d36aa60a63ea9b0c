/* SPDX-License-Identifier: MIT
 *
 * geometry.c - placed shapes, the gap and the normal fans of the figures.
 */
#include "geometry.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>

static const double pi = 3.14159265358979323846;

static void require(narc_status status, const narc_error *error) {
    if (status == NARC_OK)
        return;
    fprintf(stderr, "figures: %s\n", error->message);
    exit(1);
}

outline outline_near(const narc_point *points, size_t count) {
    outline shape;
    narc_error error;
    narc_point junctions[NARC_MAX_ARCS];
    require(narc_adjust_polygon(points, count, junctions, &error), &error);
    require(narc_build_points(junctions, count, 0, shape.arc, &shape.count, &error), &error);
    return shape;
}

outline outline_of_polygon(const narc_point *points, size_t count, double radius) {
    outline shape;
    narc_error error;
    require(narc_build_polygon(points, count, radius, shape.arc, &shape.count, &error), &error);
    return shape;
}

outline place_outline(outline shape, double x, double y, double angle) {
    for (size_t i = 0; i < shape.count; i++) {
        narc_arc *arc = &shape.arc[i];
        const double c_x = arc->center_x, c_y = arc->center_y;
        arc->center_x = x + cos(angle) * c_x - sin(angle) * c_y;
        arc->center_y = y + sin(angle) * c_x + cos(angle) * c_y;
        const double sweep = wrap_angle(arc->end - arc->start);
        arc->start = wrap_angle(arc->start + angle);
        arc->end = arc->start + sweep;
    }
    return shape;
}

double wrap_angle(double angle) {
    angle = fmod(angle, 2 * pi);
    return angle < 0 ? angle + 2 * pi : angle;
}

size_t arc_at(const outline *shape, double angle) {
    size_t holder = 0;
    double least = INFINITY;
    for (size_t i = 0; i < shape->count; i++) {
        const double past = wrap_angle(angle - shape->arc[i].start);
        if (past < least) {
            least = past;
            holder = i;
        }
    }
    return holder;
}

static interval interval_at(const outline *a, const outline *b, double start, double end) {
    const double middle = (start + end) / 2;
    interval here = {.start = start, .end = end, .i = arc_at(a, middle), .j = arc_at(b, middle + pi)};
    const narc_arc *p = &a->arc[here.i], *q = &b->arc[here.j];
    here.u_x = q->center_x - p->center_x;
    here.u_y = q->center_y - p->center_y;
    here.radii = p->radius + q->radius;
    return here;
}

double gap_at(const outline *a, const outline *b, double angle) {
    const interval here = interval_at(a, b, angle, angle);
    return here.u_x * cos(angle) + here.u_y * sin(angle) - here.radii;
}

static int compare(const void *left, const void *right) {
    const double l = *(const double *)left, r = *(const double *)right;
    return (l > r) - (l < r);
}

size_t overlay_fans(const outline *a, const outline *b, interval *out) {
    double angle[4 * NARC_MAX_ARCS + 1];
    size_t count = 0;
    for (size_t i = 0; i < a->count; i++)
        angle[count++] = wrap_angle(a->arc[i].start);
    for (size_t j = 0; j < b->count; j++)
        angle[count++] = wrap_angle(b->arc[j].start + pi);
    qsort(angle, count, sizeof *angle, compare);
    angle[count] = angle[0] + 2 * pi;
    for (size_t k = 0; k < count; k++)
        out[k] = interval_at(a, b, angle[k], angle[k + 1]);
    return count;
}

size_t find_maxima(const interval *intervals, size_t count, maximum *out) {
    size_t found = 0;
    for (size_t k = 0; k < count; k++) {
        const interval *now = &intervals[k], *last = &intervals[(k + count - 1) % count];
        const double along = wrap_angle(atan2(now->u_y, now->u_x) - now->start), c = cos(now->start);
        const double s = sin(now->start), rise = c * last->u_y - s * last->u_x, fall = c * now->u_y - s * now->u_x;
        if (rise > 0 && fall < 0)
            out[found++] = (maximum){now->start, c * now->u_x + s * now->u_y - now->radii, k, true};
        else if (along < now->end - now->start)
            out[found++] = (maximum){now->start + along, hypot(now->u_x, now->u_y) - now->radii, k, false};
    }
    return found;
}

maximum find_highest(const maximum *maxima, size_t count) {
    maximum best = maxima[0];
    for (size_t k = 1; k < count; k++)
        best = maxima[k].value > best.value ? maxima[k] : best;
    return best;
}

double find_inner_radius(const outline *shape, double angle) {
    const narc_arc *here = &shape->arc[arc_at(shape, angle)];
    double least = here->radius;
    const double p_x = here->center_x + here->radius * cos(angle), p_y = here->center_y + here->radius * sin(angle);
    for (int k = 0; k < 3600; k++) {
        const double m = 2 * pi * k / 3600, width = 1 - cos(m - angle);
        const narc_arc *arc = &shape->arc[arc_at(shape, m)];
        const double room = (arc->center_x - p_x) * cos(m) + (arc->center_y - p_y) * sin(m) + arc->radius;
        if (width > 1e-4)
            least = fmin(least, room / width);
    }
    return least;
}

outline subtract_outlines(const outline *a, const outline *b) {
    interval intervals[2 * NARC_MAX_ARCS];
    outline difference = {.count = overlay_fans(a, b, intervals)};
    for (size_t k = 0; k < difference.count; k++)
        difference.arc[k] =
            (narc_arc){-intervals[k].u_x, -intervals[k].u_y, intervals[k].radii, intervals[k].start, intervals[k].end};
    return difference;
}
