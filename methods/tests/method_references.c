/* SPDX-License-Identifier: MIT
 *
 * method_references.c - the published tests and the filters in double precision.
 */
#include "method_references.h"

#include <math.h>

static double cross(double a_x, double a_y, double b_x, double b_y) { return a_x * b_y - a_y * b_x; }

static double dot(double a_x, double a_y, double b_x, double b_y) { return a_x * b_x + a_y * b_y; }

/* ----------------------------------------------------------------------------------------------- first pair of arcs */

struct first_body make_first_body(const struct reference_body *body, const struct reference_body *origin) {
    const double x = body->x - origin->x, y = body->y - origin->y, angle = atan2(body->sine, body->cosine);
    struct first_body out = {.count = body->count == 1 ? 2 : body->count, .circle = body->count == 1};
    narc_mass mass;
    assert_true(narc_compute_mass(body->arcs, body->count, &mass));
    const narc_point centroid = turn_point(body, mass.centroid_x, mass.centroid_y);
    out.centroid_x = x + centroid.x;
    out.centroid_y = y + centroid.y;
    for (size_t i = 0; i <= out.count; i++) {
        const size_t k = out.circle ? 0 : i % out.count;
        const narc_arc *arc = &body->arcs[k];
        const double start = arc->start + angle + (out.circle ? PI * (double)i : 0);
        out.start_x[i] = cos(start);
        out.start_y[i] = sin(start);
        if (i < out.count) {
            const narc_point center = turn_point(body, arc->center_x, arc->center_y);
            out.x[i] = x + center.x;
            out.y[i] = y + center.y;
            out.radius[i] = body->scale * arc->radius;
        }
    }
    return out;
}

static enum sureness above(double value, double band) {
    return value > band ? PASSES : value < -band ? FAILS : IN_DOUBT;
}

/* Of the steps that kernels/sat/normal_fan.inl lists, those that lead to the vector between two centres leave it off by
 * (10 D + 4 E_a + 19 E_b) e in any direction, by 27 e reach in all with both components off; so do the same steps the
 * vector between the centroids. A normal is off by 6 e, a cross or dot product rounds by 3 e more, of the length of u:
 * 36 e reach for the cones, and for the dot product 30 e reach times both lengths. 48 e reach covers either. */
static const double sign_band = 48.0 / 16777216.0;

enum sureness test_arcs(const struct first_body *a, const struct first_body *b, double reach, size_t i, size_t j) {
    const double u_x = b->x[j] - a->x[i], u_y = b->y[j] - a->y[i];
    const double c_x = b->centroid_x - a->centroid_x, c_y = b->centroid_y - a->centroid_y;
    const double band = sign_band * reach;
    const enum sureness sign[5] = {
        above(cross(a->start_x[i], a->start_y[i], u_x, u_y), band),
        above(cross(u_x, u_y, a->start_x[i + 1], a->start_y[i + 1]), band),
        above(cross(b->start_x[j], b->start_y[j], -u_x, -u_y), band),
        above(cross(-u_x, -u_y, b->start_x[j + 1], b->start_y[j + 1]), band),
        above(dot(u_x, u_y, c_x, c_y), band * (hypot(u_x, u_y) + hypot(c_x, c_y))),
    };
    enum sureness least = PASSES;
    for (int k = 0; k < 5; k++)
        least = sign[k] < least ? sign[k] : least;
    return least;
}

/* ------------------------------------------------------------------------------------------------ polygons */

/* A junction's normal is that of the edge before it. */
double polygon_gap(const struct reference_body *a, const struct reference_body *b) {
    double best = -INFINITY;
    for (int side = 0; side < 2; side++) {
        const struct reference_body *body = side ? b : a;
        for (size_t i = 0; i < body->count; i++) {
            const double angle = body->arcs[i].start + atan2(body->sine, body->cosine) + side * PI;
            best = fmax(best, reference_gap_along(a, b, cos(angle), sin(angle)));
        }
    }
    return best;
}

/* ------------------------------------------------------------------------------------------------ boxes */

/* Boxes whose areas differ by less than this are the same choice: far above what double precision leaves of an area
 * that is the product of two differences, each good to about 1e-13 of the coordinates; far below what matters. */
static const double same_area = 1e-9;

struct smallest_boxes find_boxes(const struct shape *shape) {
    const struct reference_body body = {shape->arcs, shape->count, 0, 0, 1, 0, 1};
    struct smallest_boxes all = {.count = shape->count}, smallest = {0};
    double least = INFINITY;
    for (size_t i = 0; i < shape->count; i++) {
        const double x = cos(shape->arcs[i].start), y = sin(shape->arcs[i].start);
        const double front = reference_height(&body, x, y), back = reference_height(&body, -x, -y);
        const double left = reference_height(&body, -y, x), right = reference_height(&body, y, -x);
        const double along = (front - back) / 2, across = (left - right) / 2;
        all.box[i] = (struct plain_box){
            along * x - across * y, along * y + across * x, (front + back) / 2, (left + right) / 2, x, y};
        least = fmin(least, all.box[i].half_x * all.box[i].half_y);
    }
    for (size_t i = 0; i < all.count; i++)
        /* A segment's is nothing but rounding. */
        if (all.box[i].half_x * all.box[i].half_y <= least * (1 + same_area) + 1e-15)
            smallest.box[smallest.count++] = all.box[i];
    return smallest;
}

struct plain_box place_box(const struct plain_box *box, const struct reference_body *body,
                           const struct reference_body *origin) {
    const narc_point middle = turn_point(body, box->x, box->y);
    return (struct plain_box){middle.x + body->x - origin->x,
                              middle.y + body->y - origin->y,
                              box->half_x * body->scale,
                              box->half_y * body->scale,
                              body->cosine * box->axis_x - body->sine * box->axis_y,
                              body->sine * box->axis_x + body->cosine * box->axis_y};
}

static double reach_along(const struct plain_box *box, double x, double y) {
    return box->half_x * fabs(dot(box->axis_x, box->axis_y, x, y)) +
           box->half_y * fabs(cross(box->axis_x, box->axis_y, x, y));
}

static double gap_along(const struct plain_box *a, const struct plain_box *b, double x, double y) {
    return fabs(dot(b->x - a->x, b->y - a->y, x, y)) - reach_along(a, x, y) - reach_along(b, x, y);
}

double box_gap(const struct plain_box *a, const struct plain_box *b) {
    return fmax(fmax(gap_along(a, b, a->axis_x, a->axis_y), gap_along(a, b, -a->axis_y, a->axis_x)),
                fmax(gap_along(a, b, b->axis_x, b->axis_y), gap_along(a, b, -b->axis_y, b->axis_x)));
}

double axis_gap(const struct plain_box *a, const struct plain_box *b) {
    return fmax(gap_along(a, b, 1, 0), gap_along(a, b, 0, 1));
}

double circle_gap(const struct reference_body *a, const struct reference_body *b) {
    narc_circle of_a, of_b;
    assert_true(narc_compute_bounding_circle(a->arcs, a->count, &of_a));
    assert_true(narc_compute_bounding_circle(b->arcs, b->count, &of_b));
    const narc_point from = turn_point(a, of_a.x, of_a.y), to = turn_point(b, of_b.x, of_b.y);
    return hypot(b->x - a->x + to.x - from.x, b->y - a->y + to.y - from.y) - a->scale * of_a.radius -
           b->scale * of_b.radius;
}
