/* SPDX-License-Identifier: MIT
 *
 * manifold_reference.c - manifolds in double precision. Here everything is turned into the frame of the contact: x
 * along the tangent t, y along the normal n. A lies below and B above. Edges and arcs are compared by angles.
 */
#include "manifold_reference.h"

#include <math.h>

#include "narc_pairs.h"
#include "support.h"

/* Two angles that differ by less may be taken for the same, or not. */
static const double angle_doubt = 1e-5;

/* Is n the normal of a junction (PARALLEL in kernels/base/contact_point.inl, 2^-20)? Yes below, perhaps between. */
static const double parallel_certain = 4e-7, parallel_doubt = 2e-6;

/* Edges above the larger one, relative to the pair's reach, are edges; below the smaller one, relative to the body's own
 * extent, they are rounding. */
static const double edge_doubt_low = 1e-8, edge_doubt_high = 1e-4;

struct end {
    double t, height, radius;
};

/* A point this part of an edge from its end lies at the end's arc. */
static const double end_part = 1.0 / 32;

struct side {
    bool has_edge, offered, parallel, doubtful, doubtful_parallel;
    size_t number; /* of the edge next to the touching arc that is closest to n */
    struct end low, high;
    unsigned low_arc, high_arc; /* at its ends */
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
    const double least_edge = edge_doubt_low * reference_extent(body);
    double angle[2], length[2];
    struct end start[2], end[2];
    for (size_t k = 0; k < 2; k++) { /* the edge before the arc, and the one after it */
        const size_t number = (arc + k) % count;
        const narc_arc *before = &body->arcs[(number + count - 1) % count], *after = &body->arcs[number];
        const double normal = after->start, c = cos(normal), s = sin(normal);
        angle[k] = fabs(remainder(turned - normal, 2 * PI));
        start[k] = place(frame, body, before->center_x + before->radius * c, before->center_y + before->radius * s,
                         before->radius);
        end[k] =
            place(frame, body, after->center_x + after->radius * c, after->center_y + after->radius * s, after->radius);
        length[k] = hypot(end[k].t - start[k].t, end[k].height - start[k].height);
    }
    bool is_edge[2];
    for (size_t k = 0; k < 2; k++) {
        is_edge[k] = count > 1 && length[k] > least_edge;
        side.doubtful = side.doubtful || (is_edge[k] && length[k] < edge_doubt_high * reach) ||
                        (is_edge[k] && fabs(angle[k] - flat_angle) < angle_doubt);
        side.doubtful_parallel =
            side.doubtful_parallel || (is_edge[k] && angle[k] > parallel_certain && angle[k] < parallel_doubt);
    }
    const size_t chosen = is_edge[1] && !(is_edge[0] && angle[0] < angle[1]);
    side.has_edge = is_edge[chosen] && angle[chosen] < PI / 2;
    side.offered = is_edge[chosen] && angle[chosen] <= flat_angle;
    side.doubtful = side.doubtful || (is_edge[chosen] && fabs(angle[chosen] - PI / 2) < angle_doubt) ||
                    (is_edge[0] && is_edge[1] && fabs(angle[0] - angle[1]) < angle_doubt);
    side.number = (arc + chosen) % count;
    side.low = sign > 0 ? start[chosen] : end[chosen];
    side.high = sign > 0 ? end[chosen] : start[chosen];
    side.low_arc = (unsigned)(sign > 0 ? (side.number + count - 1) % count : side.number);
    side.high_arc = (unsigned)(sign > 0 ? side.number : (side.number + count - 1) % count);
    side.parallel = side.has_edge && angle[chosen] < parallel_doubt;
    for (size_t k = 0; k < 2; k++) {
        if (is_edge[k] && angle[k] < parallel_doubt) {
            side.touching_feature = (unsigned)((arc + k) % count) | NARC_FEATURE_EDGE;
            side.touching_radius = INFINITY;
        }
    }
    return side;
}

/* The longest edge of a body, as a part of its extent. */
static double longest_edge(const struct reference_body *body) {
    const double extent = reference_extent(body) / body->scale;
    double length = 0;
    for (size_t k = 0; k < body->count; k++) {
        const narc_arc *before = &body->arcs[(k + body->count - 1) % body->count], *after = &body->arcs[k];
        const double c = cos(after->start), s = sin(after->start), radii = after->radius - before->radius;
        length = fmax(length, hypot(after->center_x - before->center_x + radii * c,
                                    after->center_y - before->center_y + radii * s));
    }
    return body->count == 1 ? 0 : length / extent;
}

static bool is_edge_doubtful(double length) { return length > edge_doubt_low && length < edge_doubt_high; }

/* What of a body lies at t, at the low or the high end of its edge. */
static unsigned feature_at(const struct side *side, double t, bool low, double doubt, bool *doubtful) {
    const double inside = (low ? t - side->low.t : side->high.t - t) - end_part * (side->high.t - side->low.t);
    *doubtful = *doubtful || fabs(inside) < doubt;
    if (inside > 0)
        return (unsigned)side->number | NARC_FEATURE_EDGE;
    return low ? side->low_arc : side->high_arc;
}

/* What of a body lies at the only point of two: an edge that touches does so at the end where the other one's corner
 * has its own edge beside it. */
static unsigned feature_of_one(const struct side *side, const struct side *other, double t, double doubt,
                               bool *doubtful) {
    if (!side->parallel)
        return side->touching_feature;
    const struct side *corner = other->has_edge && !other->parallel ? other : side;
    const double nearer = fabs(corner->high.t - t) - fabs(t - corner->low.t);
    *doubtful = *doubtful || fabs(nearer) < doubt;
    return feature_at(side, t, nearer >= 0, doubt, doubtful);
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
                                        bool high, struct reference_manifold *m, double doubt) {
    const double height_a = height_at(a, t), height_b = height_at(b, t);
    const struct end *end_a = high ? &a->high : &a->low, *end_b = high ? &b->high : &b->low;
    struct reference_point point = point_at(frame, t, (height_a + height_b) / 2);
    point.separation = height_b - height_a;
    point.radius_a = end_a->t == t ? end_a->radius : INFINITY;
    point.radius_b = end_b->t == t ? end_b->radius : INFINITY;
    m->doubtful_radius = m->doubtful_radius || fabs(end_a->t - end_b->t) < doubt;
    point.feature = feature_at(a, t, !high, doubt, &m->doubtful) | feature_at(b, t, !high, doubt, &m->doubtful) << 8;
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
    const double deepest = frame.normal_x * contact->point_y - frame.normal_y * contact->point_x;
    unsigned touching_a = side_a.touching_feature, touching_b = side_b.touching_feature;
    bool doubtful_if_one = false;
    const double edge_a = longest_edge(a), edge_b = longest_edge(b);
    m.doubtful = m.doubtful || is_edge_doubtful(edge_a) || is_edge_doubtful(edge_b); /* has it any edges? */
    if (edge_a >= edge_doubt_high && edge_b >= edge_doubt_high) {
        touching_a = feature_of_one(&side_a, &side_b, deepest, doubt, &doubtful_if_one);
        touching_b = feature_of_one(&side_b, &side_a, deepest, doubt, &doubtful_if_one);
    }
    const struct reference_point exact = {contact->separation,          contact->point_x,       contact->point_y,
                                          touching_a | touching_b << 8, side_a.touching_radius, side_b.touching_radius};
    m.point[0] = exact;
    const double low = fmax(side_a.low.t, side_b.low.t), high = fmin(side_a.high.t, side_b.high.t);
    const bool two = side_a.offered && side_b.offered && high > low;
    m.doubtful =
        m.doubtful || (side_a.offered && side_b.offered && fabs(high - low) < doubt) || (!two && doubtful_if_one);
    if (!two)
        return m;
    m.count = 2;
    m.stretch = side_a.parallel && side_b.parallel;
    m.point[0] = end_point(&frame, &side_a, &side_b, low, false, &m, doubt);
    m.point[1] = end_point(&frame, &side_a, &side_b, high, true, &m, doubt);
    if (m.stretch) {
        m.deepest = m.point[1].separation < m.point[0].separation;
        m.point[m.deepest].separation = contact->separation;
        return m;
    }
    m.deepest = fabs(deepest - low) > fabs(high - deepest);
    m.doubtful = m.doubtful || fabs(fabs(deepest - low) - fabs(high - deepest)) < doubt;
    m.point[m.deepest] = exact;
    m.point[m.deepest].feature = feature_at(&side_a, deepest, m.deepest == 0, doubt, &m.doubtful) |
                                 feature_at(&side_b, deepest, m.deepest == 0, doubt, &m.doubtful) << 8;
    return m;
}
