/* SPDX-License-Identifier: MIT
 *
 * touch.c - where and how deep two grains overlap, in double precision.
 */
#include "touch.h"

#include <math.h>

#include "vec.h"

/* An edge that is shorter than this share of the outline is none that another can lie on. */
static const double LEAST_EDGE = 1e-4;

/* The edge between two circles has its normal n with n.u = r - r', where u goes from one centre to the other. */
void make_touch_sides(const narc_arc *arcs, size_t count, touch_side *out_sides) {
    double size = 0;
    for (size_t i = 0; i < count; i++)
        size = fmax(size, hypot(arcs[i].center_x, arcs[i].center_y) + arcs[i].radius);
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *before = &arcs[(i + count - 1) % count];
        const vec u = {arc->center_x - before->center_x, arc->center_y - before->center_y};
        vec n = {cos(arc->start), sin(arc->start)};
        double length = u.y * n.x - u.x * n.y;
        if (count > 1 && length > LEAST_EDGE * size) {
            const double rise = before->radius - arc->radius, square = dot(u, u);
            length = sqrt(fmax(square - rise * rise, 0));
            n = plus(times(rise / square, u), times(length / square, (vec){u.y, -u.x}));
        } else {
            length = 0;
        }
        out_sides[i] = (touch_side){arc->center_x, arc->center_y, arc->radius, n.x, n.y, length, false};
    }
    for (size_t i = 0; i < count; i++)
        out_sides[i].has_edge = out_sides[i].length > 0 || out_sides[(i + 1) % count].length > 0;
}

/* At the point that is furthest from the origin the normal points away from the origin, so the arc's centre is on the
 * same line: the point is the support in that direction, or in the opposite one if the arc is flatter. */
double find_outline_reach(const narc_arc *arcs, size_t count) {
    double reach = 0;
    for (size_t i = 0; i < 2 * count; i++) {
        const narc_arc *arc = &arcs[i / 2];
        const double sign = i % 2 ? -1 : 1;
        const bool central = arc->center_x == 0 && arc->center_y == 0;
        narc_point p = {0, 0};
        narc_find_support(arcs, count, central ? 1 : sign * arc->center_x, sign * arc->center_y, &p, NULL);
        reach = fmax(reach, hypot(p.x, p.y));
    }
    return reach;
}

/* ---------------------------------------------------------------------------------------- as they lie */

/* An arc, an edge of a grain in the plane, from the centre of A. */
typedef struct circle {
    vec at;
    double radius;
} circle;

typedef struct edge {
    circle first, last; /* the arcs before and behind it */
    vec normal;
    double height, length; /* its line is where normal.p = height */
} edge;

static vec turn(const touch_grain *g, double x, double y) { return rotate((vec){g->cosine, g->sine}, (vec){x, y}); }

static circle place_circle(const touch_grain *g, vec centre, size_t i) {
    const touch_side *s = &g->sides[i];
    return (circle){plus(centre, times(g->scale, turn(g, s->x, s->y))), g->scale * s->radius};
}

static edge place_edge(const touch_grain *g, vec centre, size_t i) {
    const touch_side *s = &g->sides[i];
    edge e = {.first = place_circle(g, centre, i > 0 ? i - 1 : g->count - 1), .last = place_circle(g, centre, i)};
    e.normal = turn(g, s->normal_x, s->normal_y);
    e.height = dot(e.normal, e.last.at) + e.last.radius;
    e.length = g->scale * s->length;
    return e;
}

/* ---------------------------------------------------------------------------------------- one point */

/* An arc over the edge of the other one: of A if `is_b` is not set. */
static touch_end meet_edge(circle c, edge e, bool is_b) {
    const double depth = e.height + c.radius - dot(e.normal, c.at), sign = is_b ? 1 : -1;
    const vec p = plus(c.at, times(0.5 * depth - c.radius, e.normal));
    return (touch_end){p.x, p.y, sign * e.normal.x, sign * e.normal.y, depth, 1};
}

/* ---------------------------------------------------------------------------------------- two points */

/* The weight of the other end: s^2 (3 - 2 s) of the stretch's length, relative to a quarter of the shorter edge. */
static double find_weight(double length, double edge_length, double *out_slope) {
    const double whole = 0.25 * edge_length, s = fmin(fmax(length / whole, 0), 1);
    *out_slope = 6 * s * (1 - s) / whole;
    return s * s * (3 - 2 * s);
}

/* Where an edge meets one of its arcs. */
static vec find_junction(circle c, edge e) { return plus(c.at, times(c.radius, e.normal)); }

/* Edges of A and B that face each other, and the end of their common stretch that is deepest: `first`. It is the low
 * one where A's edge begins and B's ends. */
static void meet_sides(edge a, edge b, bool low, touch_end first, touch *out) {
    const vec near_a = find_junction(low ? a.first : a.last, a), near_b = find_junction(low ? b.last : b.first, b);
    const vec far_a = find_junction(low ? a.last : a.first, a), far_b = find_junction(low ? b.first : b.last, b);
    const vec along_a = times(low ? 1 : -1, (vec){-a.normal.y, a.normal.x});
    const vec along_b = times(low ? -1 : 1, (vec){-b.normal.y, b.normal.x});
    /* The straight stretch goes from the near junction that is further inwards to the nearer one of the far ones. */
    const bool begin_is_b = dot(minus(near_b, near_a), along_a) > 0;
    const bool end_is_b = dot(minus(far_b, far_a), along_a) < 0;
    const vec begin = begin_is_b ? near_b : near_a, along = end_is_b ? along_b : along_a;
    touch_end second = end_is_b ? meet_edge((circle){far_b, 0}, a, true) : meet_edge((circle){far_a, 0}, b, false);
    double weight = 1, slope = 0;
    if (begin_is_b != end_is_b) /* else it is an edge, whose length never changes */
        weight = find_weight(dot(minus(end_is_b ? far_b : far_a, begin), along), fmin(a.length, b.length), &slope);
    if (!(first.depth > 0 && second.depth > 0 && weight > 0)) {
        put_point(first, out);
        return;
    }
    out->count = 2;
    out->depth = sqrt(first.depth * first.depth + weight * second.depth * second.depth);
    first.share = first.depth / out->depth;
    second.share = weight * second.depth / out->depth;
    out->end[0] = first;
    out->end[1] = second;
    /* -dh/dL grad L, on B: a stretch that gets shorter eases the contact. */
    const double ease = 0.5 * slope * second.depth * second.depth / out->depth * (begin_is_b ? 1 : -1);
    out->slide_x = ease * along.x;
    out->slide_y = ease * along.y;
    out->corner_x = begin.x;
    out->corner_y = begin.y;
}

/* Two edges that the library names: the deeper end of their stretch is an arc of one of them. */
static void meet_edges(edge a, edge b, touch *out) {
    const vec t = {-a.normal.y, a.normal.x};
    const touch_end low =
        dot(minus(b.last.at, a.first.at), t) > 0 ? meet_edge(b.last, a, true) : meet_edge(a.first, b, false);
    const touch_end high =
        dot(minus(b.first.at, a.last.at), t) < 0 ? meet_edge(b.first, a, true) : meet_edge(a.last, b, false);
    if (low.depth >= high.depth)
        meet_sides(a, b, true, low, out);
    else
        meet_sides(a, b, false, high, out);
}

/* Edges are taken for sides that lie on each other if both normals are within a third of a right angle or so of that of
 * the contact. At larger angles the second end would have to be nearer than the contact is deep. */
static const double LEAST_FACING = 0.85;

/* How much two edges face each other across the contact: 1, if they are parallel. */
static double find_facing(const touch_grain *a, const touch_grain *b, size_t i, size_t j, vec normal) {
    const touch_side *s = &a->sides[i], *r = &b->sides[j];
    if (!(s->length > 0 && r->length > 0))
        return -1;
    return fmin(dot(turn(a, s->normal_x, s->normal_y), normal), -dot(turn(b, r->normal_x, r->normal_y), normal));
}

void find_any_touch(const touch_grain *a, const touch_grain *b, double x, double y, unsigned feature, touch *out) {
    const bool edge_a = feature & NARC_FEATURE_EDGE, edge_b = feature >> 8 & NARC_FEATURE_EDGE;
    const size_t i = feature & 0x3f, j = feature >> 8 & 0x3f;
    const vec centre_a = {0, 0}, centre_b = {x, y};
    if (edge_a && edge_b) {
        meet_edges(place_edge(a, centre_a, i), place_edge(b, centre_b, j), out);
        return;
    }
    const touch_end first = edge_a   ? meet_edge(place_circle(b, centre_b, j), place_edge(a, centre_a, i), true)
                            : edge_b ? meet_edge(place_circle(a, centre_a, i), place_edge(b, centre_b, j), false)
                                     : meet_arcs(a, b, x, y, &a->sides[i], &b->sides[j]);
    /* Beside an arc of A are the edges i and i + 1, at whose high and low end it is; of B the other way round. */
    const size_t low_i = edge_a ? i : i + 1 < a->count ? i + 1 : 0, high_j = edge_b ? j : j + 1 < b->count ? j + 1 : 0;
    const vec n = {first.normal_x, first.normal_y};
    const double low = find_facing(a, b, low_i, j, n), high = find_facing(a, b, i, high_j, n);
    if (!(fmax(low, high) > LEAST_FACING))
        put_point(first, out);
    else if (low > high)
        meet_sides(place_edge(a, centre_a, low_i), place_edge(b, centre_b, j), true, first, out);
    else
        meet_sides(place_edge(a, centre_a, i), place_edge(b, centre_b, high_j), false, first, out);
}
