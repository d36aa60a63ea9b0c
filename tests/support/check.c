/* SPDX-License-Identifier: MIT
 *
 * check.c - are contacts and manifolds right?
 */
#include "check.h"

#include <math.h>
#include <stdio.h>
#include <string.h>

#include "manifold_reference.h"

/* How far from 1 a normal's length may be, and how far, in radians, a normal may be off a stored one: a dozen
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

double distance_to(const struct reference_body *a, const struct reference_body *body, double x, double y) {
    double length = hypot(body->cosine, body->sine), scale = body->scale * length, distance = NAN;
    double c = body->cosine / length, s = body->sine / length;
    x -= body->x - a->x;
    y -= body->y - a->y;
    narc_point local = {(c * x + s * y) / scale, (c * y - s * x) / scale};
    narc_compute_distance(body->arcs, body->count, &local, &distance);
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

const char *check_answer(const struct reference_body *a, const struct reference_body *b, double gap, size_t k,
                         bool overlap, const narc_contact *contact, struct fractions *worst) {
    const char *const wrong = check_contact(a, b, gap, contact, worst);
    if (fabs(gap) > separation_bound(a, b) && overlap != (gap < 0))
        return "overlap";
    if (overlap != (contact->separation < 0))
        return "overlap and contact differ";
    return contact->pair != k ? "pair index" : wrong;
}

void count_pair(struct contact_summary *summary, double gap, double bound, const struct fractions *errors) {
    summary->pairs++;
    summary->colliding += gap < 0;
    summary->inside_band += fabs(gap) <= bound;
    summary->worst.separation = fmax(summary->worst.separation, errors->separation);
    summary->worst.normal = fmax(summary->worst.normal, errors->normal);
    summary->worst.point = fmax(summary->worst.point, errors->point);
}

/* ------------------------------------------------------------------------------------------------ manifolds */

const double manifold_bounds = 4;

static bool same_radius(double expected, double found) {
    return expected == found || fabs(expected - found) <= 1e-6 * expected;
}

/* Point i of a manifold against one of the reference; NULL, or what is wrong. */
static const char *check_manifold_point(const struct reference_point *right, const narc_manifold_point *point,
                                        double bound, double *worst) {
    const double off = hypot((double)point->x - right->x, (double)point->y - right->y);
    const double error = fmax(off, fabs((double)point->separation - right->separation));
    *worst = fmax(*worst, error / bound);
    if (!(error <= bound))
        return "point or separation";
    return point->feature != right->feature ? "feature" : NULL;
}

/* Radii are those of the deepest point; of a stretch either end may be it. */
static bool has_radii(const struct reference_manifold *right, const narc_manifold *m, const narc_contact *contact) {
    for (size_t i = 0; i < m->count; i++) {
        const bool deepest = right->stretch ? m->point[i].separation == contact->separation : i == right->deepest;
        if (deepest && same_radius(right->point[i].radius_a, (double)m->radius_a) &&
            same_radius(right->point[i].radius_b, (double)m->radius_b))
            return true;
    }
    return false;
}

/* How far a contact's normal may be from the one that reaches were computed from, in radians: a dozen roundings of a
 * float for square root, division and two rotations. */
static const double normal_doubt = 1e-6;

/* Is that how far the normal may turn on what touches, clockwise and counter-clockwise? `sign`: 1 of A, -1 of B. */
static bool is_reach(const struct reference_body *body, unsigned feature, double x, double y, double sign,
                     const uint16_t reach[2]) {
    if (feature & NARC_FEATURE_EDGE)
        return reach[0] == 0 && reach[1] == 0;
    if (body->count == 1)
        return reach[0] == NARC_REACH_ONE && reach[1] == NARC_REACH_ONE;
    const narc_arc *arc = &body->arcs[feature];
    const double angle = atan2(sign * y, sign * x) - atan2(body->sine, body->cosine);
    for (size_t i = 0; i < 2; i++) {
        double turn = remainder(i ? arc->end - angle : angle - arc->start, 2 * PI);
        turn = turn < -PI / 2 ? turn + 2 * PI : turn; /* half a turn, and a rounding */
        const double right = NARC_REACH_ONE * sin(fmin(fmax(turn, 0), PI / 2)), doubt = NARC_REACH_ONE * normal_doubt;
        if (reach[i] < right - 1 - doubt || reach[i] > right + doubt)
            return false;
    }
    return true;
}

/* A manifold found with an infinite margin against the contact and the reference. */
const char *check_manifold(const struct reference_body *a, const struct reference_body *b, const narc_contact *found,
                           const narc_manifold *m, struct manifold_summary *summary) {
    const struct exact_contact contact = {(double)found->separation, (double)found->normal_x, (double)found->normal_y,
                                          (double)found->point_x,    (double)found->point_y,  arc_of_a(found->feature),
                                          arc_of_b(found->feature)};
    const struct reference_manifold right = reference_find_manifold(a, b, &contact, (double)NARC_FLAT_ANGLE);
    const double bound = manifold_bounds * separation_bound(a, b);
    if (m->count < 1 || m->count > 2)
        return "number of points";
    if (memcmp(&m->normal_x, &found->normal_x, 2 * sizeof(float)) != 0)
        return "normal";
    /* One of the points is the contact, bit for bit; nothing is deeper. */
    bool exact = false, exact_place = false;
    for (size_t i = 0; i < m->count; i++) {
        const narc_manifold_point *point = &m->point[i];
        const bool same = memcmp(&point->separation, &found->separation, sizeof(float)) == 0;
        exact = exact || same;
        exact_place = exact_place || (same && memcmp(&point->x, &found->point_x, 2 * sizeof(float)) == 0);
        if (point->separation < found->separation)
            return "a point deeper than the contact";
    }
    if (m->count == 2 && m->point[0].feature == m->point[1].feature)
        return "id of two points";
    if (!exact)
        return "the deepest separation";
    if (m->count == 1 && memcmp(&m->radius_a, &found->radius_a, 2 * sizeof(float)) != 0)
        return "radius, of contact and manifold";
    if (!is_reach(a, found->feature & 0xff, contact.normal_x, contact.normal_y, 1, m->reach_a) ||
        !is_reach(b, found->feature >> 8, contact.normal_x, contact.normal_y, -1, m->reach_b))
        return "reach";
    summary->pairs++;
    summary->two += m->count == 2;
    if (right.doubtful) {
        summary->doubtful++;
        return NULL;
    }
    if (m->count != right.count)
        return "number of points";
    summary->stretches += right.stretch;
    if (!exact_place && !right.stretch)
        return "the deepest place";
    /* What is certain but for the radii is which features; of a stretch, not which end is deeper. */
    for (size_t i = 0; i < m->count; i++) {
        struct reference_point point = right.point[i];
        if (right.stretch)
            point.separation = fmax(point.separation, contact.separation);
        const char *wrong = check_manifold_point(&point, &m->point[i], bound, &summary->worst);
        if (wrong && !(right.doubtful_radius && strcmp(wrong, "feature") == 0 && m->count == 1))
            return wrong;
    }
    return right.doubtful_radius || has_radii(&right, m, found) ? NULL : "radius";
}

/* ------------------------------------------------------------------------------------------------ what is told */

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

void print_answer(const struct reference_body *a, const struct reference_body *b, double gap, bool overlap,
                  const narc_contact *contact) {
    print_error("  exact gap %.9g, bound %.3g; answer: overlap %d, separation %.9g, normal (%.9g, %.9g), point (%.9g, "
                "%.9g), arcs %d and %d\n",
                gap, separation_bound(a, b), overlap, (double)contact->separation, (double)contact->normal_x,
                (double)contact->normal_y, (double)contact->point_x, (double)contact->point_y,
                arc_of_a(contact->feature), arc_of_b(contact->feature));
    print_pair(a, b);
}
