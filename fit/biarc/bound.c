/* SPDX-License-Identifier: MIT
 *
 * bound.c - how far a cubic and its arcs are apart at most.
 *
 * Distance to a circle. With P measured from the arc's start, k its curvature and N the normal to the left of its
 * tangent there, g(P) = |P|^2 k / 2 - P.N is 0 on the circle and 1 + 2 k g is the square of k times the distance to the
 * centre. So the signed distance to the circle is d = 2 g / (1 + sqrt(1 + 2 k g)), which grows with g; for k = 0 it is
 * -P.N, that to the line. Along a cubic, g is a polynomial of degree 6, and lies between the least and largest of its
 * coefficients in Bernstein form. Halving the curve makes these bounds as tight as is wanted.
 *
 * Distance to the arc. It is that to the circle while P is in the arc's sector, between the normals at its ends; with
 * less than half a turn that is where P is ahead of the start's normal and behind the end's. The curve is divided where
 * it crosses the normal at the point where the arcs meet, so that each arc has its own part. Places outside the sector
 * (a curve may start out the wrong way) are divided until they are so small that the distance of one of their points
 * and their size make a bound.
 *
 * The other way round. Follow the direction from the arc's centre to a point that runs along the curve's part, from the
 * arc's start to the normal at its end. If it stays in the sector it takes each direction of the arc's points at some
 * time (or the curve passes the centre, and then the bound is at least the radius, the distance of all the arc's points
 * from there); at that time, the arc's point is as far from the curve's as the circle, so within the bound. If
 * it leaves the sector that is still so unless it goes round the far side of the centre, where all points are at least
 * the radius from the arc: it can't if the bound is less than the radius. If the bound is not, half of the arc's
 * chord from either end is: 2 r sin(turn / 4) bounds the distance of any of the arc's points from the nearer
 * end, and the ends are on the curve or, where the arcs meet, as far from it as the curve's part ends.
 */
#include <float.h>

#include "biarc/biarc.h"

enum { MOST_HALVINGS = 48 };

/* The bound may be above what was found by this factor. */
static const double SLACK = 1.004;

struct search {
    const narc_spline_arc *arc;
    double rounding;
    double limit;        /* finite: the answer is yes or no */
    double lower, upper; /* of the distance, for the parts that are done */
    bool leaves_sector;
};

static double circle_distance(const narc_spline_arc *arc, double g) {
    const double square = 1 + 2 * arc->curvature * g;
    return fabs(2 * g / (1 + sqrt(fmax(square, 0))));
}

/* How far ahead of the start's normal and behind the end's. */
static double depth_in_sector(const narc_spline_arc *arc, narc_point p) {
    return fmin(dot(minus(p, arc->start), arc->start_tangent), dot(minus(arc->end, p), arc->end_tangent));
}

/* Distance of a point to the arc; outside the sector the nearer end is nearest. */
static double arc_distance(const struct search *s, narc_point p) {
    const narc_spline_arc *arc = s->arc;
    if (depth_in_sector(arc, p) < -s->rounding)
        return fmin(length(minus(p, arc->start)), length(minus(p, arc->end)));
    const narc_point offset = minus(p, arc->start);
    return circle_distance(arc, arc->curvature / 2 * dot(offset, offset) - dot(offset, turned(arc->start_tangent)));
}

/* A bound of the distance to the circle. */
static double bound_circle_distance(const narc_spline_arc *arc, const narc_cubic *part) {
    double g[7];
    narc_expand_circle(part, arc->start, turned(arc->start_tangent), arc->curvature, g);
    double low = g[0], high = g[0];
    for (int m = 1; m < 7; m++) {
        low = fmin(low, g[m]);
        high = fmax(high, g[m]);
    }
    return fmax(circle_distance(arc, low), circle_distance(arc, high));
}

static double bound_part(struct search *s, const narc_cubic *part, bool *out_inside) {
    double depth = INFINITY, size = 0;
    for (int i = 0; i < 4; i++) {
        depth = fmin(depth, depth_in_sector(s->arc, part->c[i]));
        size = fmax(size, length(minus(part->c[i], part->c[0])));
    }
    *out_inside = depth >= -s->rounding;
    return *out_inside ? bound_circle_distance(s->arc, part) : arc_distance(s, part->c[0]) + size;
}

/* False: beyond the limit. */
static bool search_part(struct search *s, const narc_cubic *part, int halvings) {
    bool inside;
    const double bound = bound_part(s, part, &inside);
    s->lower = fmax(s->lower, fmax(arc_distance(s, part->c[0]), arc_distance(s, part->c[3])));
    if (s->lower > s->limit)
        return false;
    const double enough = isfinite(s->limit) ? s->limit : SLACK * s->lower;
    if (bound <= fmax(enough, s->rounding) || halvings == 0) {
        s->upper = fmax(s->upper, bound);
        s->leaves_sector = s->leaves_sector || !inside;
        return s->upper <= s->limit;
    }
    const narc_cubic first = narc_cut_cubic(part, 0, 0.5), second = narc_cut_cubic(part, 0.5, 1);
    return search_part(s, &first, halvings - 1) && search_part(s, &second, halvings - 1);
}

/* Where the curve crosses the normal at the end of the first arc; outside 0 .. 1 if its ends are not on both sides. */
static double find_crossing(const narc_cubic *curve, const narc_spline_arc *arc) {
    double value[4], low = 0, high = 1;
    for (int i = 0; i < 4; i++)
        value[i] = dot(minus(curve->c[i], arc->end), arc->end_tangent);
    if (!(value[0] < 0 && value[3] > 0))
        return -1;
    /* Newton's method, and halving where it leaves the bracket. */
    double t = 0.5;
    for (int k = 0; k < 60 && high - low > DBL_EPSILON; k++) {
        const double s = 1 - t;
        const double a = s * value[0] + t * value[1], b = s * value[1] + t * value[2], c = s * value[2] + t * value[3];
        const double d = s * a + t * b, e = s * b + t * c, there = s * d + t * e;
        *(there < 0 ? &low : &high) = t;
        const double next = t - there / (3 * (e - d));
        if (fabs(next - t) < DBL_EPSILON)
            break;
        t = next > low && next < high ? next : (low + high) / 2;
    }
    return t;
}

/* Bound for one arc and its part, `off` being how far the ends of both are apart. */
static double bound_arc(const narc_cubic *part, const narc_spline_arc *arc, double off, double rounding, double limit) {
    struct search s = {.arc = arc, .rounding = rounding, .limit = limit};
    if (!search_part(&s, part, MOST_HALVINGS))
        return INFINITY;
    double bound = s.upper;
    if (s.leaves_sector && bound * fabs(arc->curvature) >= 1)
        bound = fmax(bound, 2 * narc_sin(fabs(arc->turn) / 4) / fabs(arc->curvature) + off);
    return bound <= limit ? bound : INFINITY;
}

double narc_bound_distance(const narc_cubic *curve, const narc_spline_arc *arcs, size_t count, double rounding,
                           double limit) {
    if (count == 1)
        return bound_arc(curve, arcs, 0, rounding, limit);
    const double t = find_crossing(curve, arcs);
    if (!(t > 0 && t < 1))
        return INFINITY;
    const narc_cubic first = narc_cut_cubic(curve, 0, t), second = narc_cut_cubic(curve, t, 1);
    const double off = length(minus(first.c[3], arcs[0].end));
    const double bound = bound_arc(&first, &arcs[0], off, rounding, limit);
    return bound <= limit ? fmax(bound, bound_arc(&second, &arcs[1], off, rounding, limit)) : INFINITY;
}
