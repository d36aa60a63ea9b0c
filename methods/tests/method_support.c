/* SPDX-License-Identifier: MIT
 *
 * method_support.c - calls on scenes, and what a method's contact must be.
 */
#include "method_support.h"

#include <math.h>
#include <string.h>

#include "check.h"
#include "expect.h"

narc_methods *create_methods(const narc_shapes *shapes) {
    narc_methods *methods = NULL;
    narc_error error;
    expect_ok(narc_create_methods(shapes, NULL, &methods, &error), &error);
    return methods;
}

uint64_t *query_overlaps(const struct scene *scene, const narc_method_options *options, const narc_query *query) {
    uint64_t *bits = make_junk(NARC_BIT_WORDS(scene->pair_count) * sizeof *bits);
    AUTO(narc_destroy_methods_at) narc_methods *methods = create_methods(scene->store);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    expect_ok(narc_find_overlaps_by(methods, &bodies, &pairs, options, query, bits, &error), &error);
    return bits;
}

struct contacts query_contacts(const struct scene *scene, const narc_method_options *options, const narc_query *query) {
    struct contacts found = {make_junk(scene->pair_count * sizeof *found.rows), 0};
    AUTO(narc_destroy_methods_at) narc_methods *methods = create_methods(scene->store);
    const narc_bodies bodies = scene_bodies(scene);
    const narc_pairs pairs = scene_pairs(scene);
    narc_error error;
    expect_ok(
        narc_find_contacts_by(methods, &bodies, &pairs, options, query, found.rows, pairs.count, &found.count, &error),
        &error);
    return found;
}

void show_wrong_pair(const struct corpus *corpus, size_t k, const char *name, const char *wrong,
                     const narc_contact *told, unsigned outcome, size_t *count) {
    enum { SHOWN = 3 };
    if ((*count)++ >= SHOWN)
        return;
    const struct exact_pair *pair = &corpus->pairs[k];
    print_error("wrong, %s: %s\n", name, wrong);
    print_error("  pair %zu: %s - %s, %s; exact gap %.9g, normal (%.9g, %.9g), bound %.3g, size %.6g, reach %.6g\n", k,
                any_family_name(pair->kind_a), any_family_name(pair->kind_b), pair->place, pair->gap, pair->normal_x,
                pair->normal_y, pair->bound, pair->size, pair->reach);
    print_pair(&pair->a, &pair->b);
    if (told)
        print_error("  answer: outcome %u, separation %.9g, normal (%.9g, %.9g), point (%.9g, %.9g), arcs %d and %d, "
                    "point off %.3g\n",
                    outcome, (double)told->separation, (double)told->normal_x, (double)told->normal_y,
                    (double)told->point_x, (double)told->point_y, arc_of_a(told->feature), arc_of_b(told->feature),
                    distance_from_outlines(pair, told));
}

void check_contacts_below(const struct contacts *found, const struct contacts *all, float margin, const char *what) {
    size_t next = 0;
    for (size_t k = 0; k < all->count; k++) {
        if (margin == INFINITY || all->rows[k].separation < margin) {
            if (next >= found->count || memcmp(&found->rows[next], &all->rows[k], sizeof *found->rows) != 0) {
                fail_msg("%s, margin %g: pair %zu, with separation %.9g, is not reported as it is", what,
                         (double)margin, k, (double)all->rows[k].separation);
            }
            next++;
        }
    }
    assert_int_equal(next, found->count);
}

/* ------------------------------------------------------------------------------------------------ one contact */

narc_point turn_point(const struct reference_body *body, double x, double y) {
    return (narc_point){body->scale * (body->cosine * x - body->sine * y),
                        body->scale * (body->sine * x + body->cosine * y)};
}

double reference_height(const struct reference_body *body, double x, double y) {
    /* A point at the position: what lies between the two along (x, y) is the height, negative. */
    static const narc_arc point = {0, 0, 0, -PI, PI};
    const struct reference_body at_position = {&point, 1, body->x, body->y, 1, 0, 1};
    return -reference_gap_along(body, &at_position, x, y);
}

/* The point is the mean of two surface points and so off by as much as a separation at most; the separation, half of
 * which says where it must be, adds half of that, and turning it into the world 4 roundings of its length. */
const double point_bounds = 1.5 + 4.0 / 32;

/* A normal this close to an edge's, in radians, is taken for it: kernels/base/contact_point.inl. */
static const double parallel = 0x1p-20;

/* The extent along (-y, x) of a body's support points for all normals within an angle of (x, y) times `sign`. They move
 * along the outline with the normal: those of both ends, and of the middle, say it all. */
static void widen(const struct exact_pair *pair, const struct reference_body *body, double sign, double x, double y,
                  double angle, double *least, double *most) {
    const double c = body->cosine, s = body->sine;
    for (int k = -1; k <= 1; k++) {
        const double m_x = sign * (x - k * angle * y), m_y = sign * (y + k * angle * x);
        narc_point p;
        assert_true(narc_find_support(body->arcs, body->count, c * m_x + s * m_y, c * m_y - s * m_x, &p, NULL));
        const narc_point place = turn_point(body, p.x, p.y);
        const double along = x * (place.y + body->y - pair->a.y) - y * (place.x + body->x - pair->a.x);
        *least = fmin(*least, along);
        *most = fmax(*most, along);
    }
}

/* Does the point lie no further along the support lines than the bodies' points on them? Edges that are parallel to
 * them but for `parallel`, and as much again for the rounding of normals, are theirs. */
static bool is_between_touches(const struct exact_pair *pair, double x, double y, double p_x, double p_y) {
    double least = INFINITY, most = -INFINITY;
    widen(pair, &pair->a, 1, x, y, 2 * parallel, &least, &most);
    widen(pair, &pair->b, -1, x, y, 2 * parallel, &least, &most);
    const double along = x * p_y - y * p_x, band = point_bounds * pair->bound;
    return least - band <= along && along <= most + band;
}

/* A dozen roundings of a float for square root, division and two rotations. */
static const double unit_tolerance = 1e-6;

/* The gap along the normal of the arcs that are told: that of the bodies. Of an edge the arc at its counter-clockwise
 * end is told, the height of which is another by `parallel` times the edge's length, less than the body's diameter. */
static bool are_touching_arcs(const struct exact_pair *pair, const narc_contact *contact, double x, double y,
                              double of_bodies) {
    const size_t i = arc_of_a(contact->feature), j = arc_of_b(contact->feature);
    if (i >= pair->a.count || j >= pair->b.count)
        return false;
    const narc_arc *a = &pair->a.arcs[i], *b = &pair->b.arcs[j];
    const narc_point from = turn_point(&pair->a, a->center_x, a->center_y),
                     to = turn_point(&pair->b, b->center_x, b->center_y);
    const double u_x = pair->b.x - pair->a.x + to.x - from.x, u_y = pair->b.y - pair->a.y + to.y - from.y;
    const double gap = u_x * x + u_y * y - pair->a.scale * a->radius - pair->b.scale * b->radius;
    return fabs(gap - of_bodies) <= pair->bound + 2 * parallel * pair->size;
}

const char *check_along_normal(const struct exact_pair *pair, const narc_contact *contact, bool unknown) {
    const double separation = (double)contact->separation;
    double x = (double)contact->normal_x, y = (double)contact->normal_y;
    const double length = hypot(x, y), p_x = (double)contact->point_x, p_y = (double)contact->point_y;
    if (!isfinite(separation) || !isfinite(length) || !isfinite(p_x) || !isfinite(p_y))
        return "not finite";
    if (fabs(length - 1) > unit_tolerance)
        return "normal not of length 1";
    x /= length;
    y /= length;
    const double gap = reference_gap_along(&pair->a, &pair->b, x, y);
    if (unknown ? gap > pair->bound || separation != 0 : fabs(gap - separation) > pair->bound)
        return "the gap along the normal is another";
    const double across = reference_height(&pair->a, x, y) + gap / 2;
    if (fabs(p_x * x + p_y * y - across) > point_bounds * pair->bound)
        return "the point does not lie between the support lines";
    return are_touching_arcs(pair, contact, x, y, gap) ? NULL : "the arcs have another gap along the normal";
}

const char *check_between_touches(const struct exact_pair *pair, const narc_contact *contact) {
    const bool fine = is_between_touches(pair, (double)contact->normal_x, (double)contact->normal_y,
                                         (double)contact->point_x, (double)contact->point_y);
    return fine ? NULL : "the point does not lie between the support points";
}

double distance_from_outlines(const struct exact_pair *pair, const narc_contact *contact) {
    const double half = (double)contact->separation / 2;
    const double half_x = half * (double)contact->normal_x, half_y = half * (double)contact->normal_y;
    const double x = (double)contact->point_x, y = (double)contact->point_y;
    return fmax(fabs(distance_to(&pair->a, &pair->a, x - half_x, y - half_y)),
                fabs(distance_to(&pair->a, &pair->b, x + half_x, y + half_y)));
}
