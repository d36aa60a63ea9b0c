/* SPDX-License-Identifier: MIT
 *
 * manifold_reference.c - manifolds in double precision. Here everything is turned into the frame of the contact: x
 * along the tangent t, y along the normal n. A lies below and B above. Edges and arcs are compared by angles.
 */
#include "manifold_reference.h"

#include <math.h>

#include "narc_shapes.h"

static const double pi = 3.14159265358979323846;

/* Two angles that differ by less may be taken for the same, or not. */
static const double angle_doubt = 1e-5;

/* Is n the normal of a junction (PARALLEL in kernels/base/contact_point.inl, 2^-20)? Yes below, perhaps between. */
static const double parallel_certain = 4e-7, parallel_doubt = 2e-6;

/* Edges above the larger one, relative to the reach, are edges; below the smaller one they are rounding. */
static const double edge_doubt_low = 1e-8, edge_doubt_high = 1e-4;

struct end {
    double t, height, radius;
};

struct side {
    bool offered, parallel, doubtful, doubtful_parallel;
    size_t number; /* of the edge that is offered */
    struct end low, high;
    double touching_radius;
    unsigned touching_feature;
};

/* The frame of a contact: a body's local point to (t, height), seen from A's position. */
struct frame {
    double normal_x, normal_y, from_x, from_y;
};

static struct end place(const struct frame *frame, const struct reference_body *body, double x, double y,
                        double radius) {
    const double world_x = body->x - frame->from_x + body->scale * (body->cosine * x - body->sine * y);
    const double world_y = body->y - frame->from_y + body->scale * (body->sine * x + body->cosine * y);
    return (struct end){frame->normal_x * world_y - frame->normal_y * world_x,
                        frame->normal_x * world_x + frame->normal_y * world_y, body->scale * radius};
}

static struct side look_at(const struct frame *frame, const struct reference_body *body, size_t arc, double sign,
                           double flat_angle, double reach) {
    const size_t count = body->count;
    const double turned = atan2(sign * frame->normal_y, sign * frame->normal_x) - atan2(body->sine, body->cosine);
    struct side side = {.touching_radius = body->scale * body->arcs[arc].radius, .touching_feature = (unsigned)arc};
    double angle[2], length[2];
    struct end start[2], end[2];
    for (size_t k = 0; k < 2; k++) { /* the edge before the arc, and the one after it */
        const size_t number = (arc + k) % count;
        const narc_arc *before = &body->arcs[(number + count - 1) % count], *after = &body->arcs[number];
        const double normal = after->start, c = cos(normal), s = sin(normal);
        angle[k] = fabs(remainder(turned - normal, 2 * pi));
        start[k] = place(frame, body, before->center_x + before->radius * c, before->center_y + before->radius * s,
                         before->radius);
        end[k] =
            place(frame, body, after->center_x + after->radius * c, after->center_y + after->radius * s, after->radius);
        length[k] = hypot(end[k].t - start[k].t, end[k].height - start[k].height);
    }
    bool flat[2];
    for (size_t k = 0; k < 2; k++) {
        const bool is_edge = count > 1 && length[k] > edge_doubt_low * reach;
        flat[k] = is_edge && angle[k] <= flat_angle;
        side.doubtful = side.doubtful || (is_edge && length[k] < edge_doubt_high * reach) ||
                        (is_edge && fabs(angle[k] - flat_angle) < angle_doubt);
        side.doubtful_parallel =
            side.doubtful_parallel || (is_edge && angle[k] > parallel_certain && angle[k] < parallel_doubt);
    }
    side.offered = flat[0] || flat[1];
    side.doubtful = side.doubtful || (flat[0] && flat[1] && fabs(angle[0] - angle[1]) < angle_doubt);
    const size_t chosen = flat[1] && !(flat[0] && angle[0] < angle[1]);
    side.number = (arc + chosen) % count;
    side.low = sign > 0 ? start[chosen] : end[chosen];
    side.high = sign > 0 ? end[chosen] : start[chosen];
    side.parallel = side.offered && angle[chosen] < parallel_doubt;
    for (size_t k = 0; k < 2; k++) {
        if (count > 1 && length[k] > edge_doubt_low * reach && angle[k] < parallel_doubt) {
            side.touching_feature = (unsigned)((arc + k) % count) | NARC_FEATURE_EDGE;
            side.touching_radius = INFINITY;
        }
    }
    return side;
}

static double height_at(const struct side *side, double t) {
    return side->low.height + (t - side->low.t) / (side->high.t - side->low.t) * (side->high.height - side->low.height);
}

static struct reference_point point_at(const struct frame *frame, double t, double height) {
    return (struct reference_point){.x = frame->normal_x * height - frame->normal_y * t,
                                    .y = frame->normal_y * height + frame->normal_x * t};
}

/* One end of the common stretch. */
static struct reference_point end_point(const struct frame *frame, const struct side *a, const struct side *b, double t,
                                        bool high, bool *doubtful_radius, double doubt) {
    const double height_a = height_at(a, t), height_b = height_at(b, t);
    const struct end *end_a = high ? &a->high : &a->low, *end_b = high ? &b->high : &b->low;
    struct reference_point point = point_at(frame, t, (height_a + height_b) / 2);
    point.separation = height_b - height_a;
    point.radius_a = end_a->t == t ? end_a->radius : INFINITY;
    point.radius_b = end_b->t == t ? end_b->radius : INFINITY;
    *doubtful_radius = *doubtful_radius || fabs(end_a->t - end_b->t) < doubt;
    point.feature = (unsigned)(a->number | b->number << 8) | NARC_FEATURE_EDGE | NARC_FEATURE_EDGE << 8 |
                    (high ? NARC_FEATURE_END : NARC_FEATURE_END << 8);
    return point;
}

struct reference_manifold reference_find_manifold(const struct reference_body *a, const struct reference_body *b,
                                                  const struct exact_contact *contact, double flat_angle) {
    const double length = hypot(contact->normal_x, contact->normal_y), reach = reference_reach(a, b);
    const struct frame frame = {contact->normal_x / length, contact->normal_y / length, a->x, a->y};
    const struct side side_a = look_at(&frame, a, contact->arc_a, 1, flat_angle, reach);
    const struct side side_b = look_at(&frame, b, contact->arc_b, -1, flat_angle, reach);
    const double doubt = 1e-5 * reach;
    struct reference_manifold m = {.count = 1,
                                   .doubtful = side_a.doubtful || side_b.doubtful,
                                   .doubtful_radius = side_a.doubtful_parallel || side_b.doubtful_parallel};
    const struct reference_point exact = {
        contact->separation,    contact->point_x,
        contact->point_y,       side_a.touching_feature | side_b.touching_feature << 8,
        side_a.touching_radius, side_b.touching_radius};
    m.point[0] = exact;
    const double low = fmax(side_a.low.t, side_b.low.t), high = fmin(side_a.high.t, side_b.high.t);
    if (!side_a.offered || !side_b.offered)
        return m;
    m.doubtful = m.doubtful || fabs(high - low) < doubt;
    if (high <= low)
        return m;
    m.count = 2;
    m.stretch = side_a.parallel && side_b.parallel;
    m.point[0] = end_point(&frame, &side_a, &side_b, low, false, &m.doubtful_radius, doubt);
    m.point[1] = end_point(&frame, &side_a, &side_b, high, true, &m.doubtful_radius, doubt);
    if (m.stretch) {
        m.deepest = m.point[1].separation < m.point[0].separation;
        m.point[m.deepest].separation = contact->separation;
        return m;
    }
    const double t = frame.normal_x * contact->point_y - frame.normal_y * contact->point_x;
    m.deepest = fabs(t - low) > fabs(high - t);
    m.doubtful = m.doubtful || fabs(fabs(t - low) - fabs(high - t)) < doubt;
    const unsigned feature = m.point[m.deepest].feature;
    m.point[m.deepest] = exact;
    m.point[m.deepest].feature = feature;
    return m;
}
