/* SPDX-License-Identifier: MIT
 *
 * check.c - is a contact right?
 */
#include "check.h"

#include <math.h>
#include <stdio.h>

/* How far from 1 a normal's length may be, and how far, in radians, a normal may stray from a stored one: a dozen
 * roundings of a float for square root, division and two rotations. */
static const double unit_tolerance = 1e-6;

/* A point is the mean of two surface points. Each is made of the same quantities as the separation, so it is off by
 * at most the same bound; and each is looked for here at half the separation, which adds half of the bound. */
static const double point_bounds = 1.5;

double separation_bound(const struct reference_body *a, const struct reference_body *b) {
    return NARC_ERROR_BOUND * reference_reach(a, b);
}

/* A direction in the axes of a body's shape. */
static double local_angle(const struct reference_body *body, double x, double y) {
    return atan2(y, x) - atan2(body->sine, body->cosine);
}

/* How far a direction lies outside the sector of an arc, in radians. */
static double angle_outside(const narc_arc *arc, double angle) {
    double sweep = arc->end - arc->start;
    sweep = sweep <= 0 ? sweep + 2 * PI : sweep;
    /* Measured from the middle of the sector. */
    double from_middle = remainder(angle - (arc->start + sweep / 2), 2 * PI);
    return fmax(fabs(from_middle) - sweep / 2, 0);
}

static narc_point center_of(const struct reference_body *body, size_t arc) {
    double x = body->arcs[arc].center_x, y = body->arcs[arc].center_y;
    return (narc_point){body->scale * (body->cosine * x - body->sine * y),
                        body->scale * (body->sine * x + body->cosine * y)};
}

/* Do these arcs hold the normal, and have the gap? Where centres nearly coincide, the direction between them is
 * rounded a lot and means little: an angle outside a sector counts times the distance of the centres. */
static const char *check_arcs(const struct reference_body *a, const struct reference_body *b, double gap, size_t arc_a,
                              size_t arc_b, double x, double y) {
    double bound = separation_bound(a, b);
    if (arc_a >= a->count || arc_b >= b->count)
        return "no such arc";
    narc_point from = center_of(a, arc_a), to = center_of(b, arc_b);
    double u_x = b->x - a->x + to.x - from.x, u_y = b->y - a->y + to.y - from.y, distance = hypot(u_x, u_y);
    double outside_a = angle_outside(&a->arcs[arc_a], local_angle(a, x, y));
    double outside_b = angle_outside(&b->arcs[arc_b], local_angle(b, -x, -y));
    if (outside_a > unit_tolerance && outside_a * distance > bound)
        return "A's arc does not hold the normal";
    if (outside_b > unit_tolerance && outside_b * distance > bound)
        return "B's arc does not hold the normal";
    double radii = a->scale * a->arcs[arc_a].radius + b->scale * b->arcs[arc_b].radius;
    return fabs((u_x * x + u_y * y) - radii - gap) > bound ? "the arcs have another gap" : NULL;
}

/* Signed distance from a point in world axes, relative to A's position, to a body. */
static double distance_to(const struct reference_body *a, const struct reference_body *body, double x, double y) {
    double length = hypot(body->cosine, body->sine), scale = body->scale * length, distance = NAN;
    double c = body->cosine / length, s = body->sine / length;
    x -= body->x - a->x;
    y -= body->y - a->y;
    narc_point local = {(c * x + s * y) / scale, (c * y - s * x) / scale};
    narc_compute_distance(body->arcs, body->count, local, &distance);
    return distance * scale;
}

/* Is that the radius of curvature of a feature? A single precision radius, times a scale. */
static bool is_radius(const struct reference_body *body, unsigned feature, double radius) {
    if (feature & NARC_FEATURE_EDGE)
        return radius == INFINITY;
    const double right = body->scale * body->arcs[feature].radius;
    return fabs(radius - right) <= unit_tolerance * right;
}

const char *check_contact(const struct reference_body *a, const struct reference_body *b, double gap,
                          const narc_contact *contact, struct fractions *worst) {
    double bound = separation_bound(a, b), separation = (double)contact->separation;
    double x = (double)contact->normal_x, y = (double)contact->normal_y, length = hypot(x, y);
    double point_x = (double)contact->point_x, point_y = (double)contact->point_y;
    if (!isfinite(separation) || !isfinite(length) || !isfinite(point_x) || !isfinite(point_y))
        return "not finite";
    double separation_error = fabs(separation - gap);
    worst->separation = fmax(worst->separation, separation_error / bound);
    if (separation_error > bound)
        return "separation";
    if (fabs(length - 1) > unit_tolerance)
        return "normal not of length 1";
    x /= length;
    y /= length;
    /* A direction says nothing by itself, for several may be as good; its gap does. */
    double normal_error = fabs(gap - reference_gap_along(a, b, x, y));
    worst->normal = fmax(worst->normal, normal_error / bound);
    if (normal_error > bound)
        return "normal";
    /* Half a separation back and forth along the normal are the points of A and B that touch or are furthest inside. */
    double half_x = x * separation / 2, half_y = y * separation / 2;
    double off_a = fabs(distance_to(a, a, point_x - half_x, point_y - half_y));
    double off_b = fabs(distance_to(a, b, point_x + half_x, point_y + half_y));
    worst->point = fmax(worst->point, fmax(off_a, off_b) / (point_bounds * bound));
    if (off_a > point_bounds * bound)
        return "point not on A";
    if (off_b > point_bounds * bound)
        return "point not on B";
    if (contact->count != 1)
        return "count";
    const unsigned on_a = contact->feature & 0xff, on_b = contact->feature >> 8, arc_a = arc_of_a(contact->feature);
    const unsigned arc_b = arc_of_b(contact->feature);
    const char *wrong = check_arcs(a, b, gap, arc_a, arc_b, x, y);
    if (wrong)
        return wrong;
    if (!is_radius(a, on_a, (double)contact->radius_a) || !is_radius(b, on_b, (double)contact->radius_b))
        return "radius";
    return NULL;
}

static void print_body(const char *name, const struct reference_body *body) {
    print_error("  %s: x %a, y %a, cosine %a, sine %a, scale %a\n", name, body->x, body->y, body->cosine, body->sine,
                body->scale);
    for (size_t i = 0; i < body->count; i++) {
        const narc_arc *arc = &body->arcs[i];
        print_error("    {%a, %a, %a, %a, %a},\n", arc->center_x, arc->center_y, arc->radius, arc->start, arc->end);
    }
}

void print_pair(const struct reference_body *a, const struct reference_body *b) {
    print_body("A", a);
    print_body("B", b);
}
