/* SPDX-License-Identifier: MIT
 *
 * spline.c - where to cut a cubic for arcs.
 *
 * The curve is divided at its cusps. From one cut to the next goes a pair of arcs (see biarc.c), as long as the
 * tolerance lets it be, found by bisection of the parameter at its end.
 *
 * Tangents at the cuts. Where the curvature changes at the rate q along the curve, the offset e of the curve from
 * arcs has e'' = q x - (a step function). Pairs of arcs of length h that keep the curve's tangents at their ends
 * reach 0.0247 q h^3 (the largest value of x (x + 1)^2 / 6). Without that condition the best step function makes e
 * the periodic Bernoulli polynomial q h^3 B3(x / h) / 6, which reaches only sqrt(3) / 216 q h^3 = 0.00802 q h^3:
 * arcs may be 1.455 times as long. It is 0 at every junction, and its slope there is q h^2 / 12. So all cuts stay on
 * the curve, and the arcs' common tangent there is turned clockwise from the curve's by up to q h^2 / 12, its full
 * tilt, with h from 0.00802 q h^3 = tolerance. At the ends of the curve, and at cusps, the tangents are the curve's.
 *
 * With the full tilt no length but that h would do, so several shares of it are tried. For each share the
 * furthest cut is kept that k pairs can reach, from whichever cut that k - 1 pairs reach. Arcs for 300 random curves,
 * control points in a unit square, tolerances 1e-2, 1e-3, 1e-4, 1e-5; what the best step function needs if one
 * forgets about the ends (0.2002 times the integral of cbrt(|q|) over length, divided by cbrt(tolerance)) is
 * 2.1, 4.5, 9.7, 20.9:
 *
 *     halving the parameter range, no tilt    5.8   10.7   22.1   45.9
 *     longest pairs, no tilt                  4.7    8.2   15.8   32.2
 *     shares 0, 0.5, 0.8                      4.6    7.2   12.7   24.6
 *     shares 0, 0.3, 0.5, 0.65, 0.8           4.6    6.9   12.5   24.4
 *     shares 0, 0.2, 0.35 ... 0.8, 0.9 (8)    4.5    6.9   12.4   24.1
 *     the five, and from the other end too    4.5    6.8   12.3   24.3
 *
 * The last is what narc_fit_bezier() does, with less tolerance too (see bezier.c). Where a pair's arcs meet is a
 * choice too: on the curve, if possible. Trying nine places near there makes the arcs 1.3, 0.4, 0.2 and 0.2 per cent
 * fewer, for twice the time.
 */
#include <float.h>
#include <math.h>
#include <stdlib.h>

#include "biarc/biarc.h"
#include "error.h"
#include "outline/path.h"

enum { SHARES = 5 };
static const double SHARE[SHARES] = {0, 0.3, 0.5, 0.65, 0.8};

/* Tilts beyond this are for curves that turn within an arc's length, where the estimate means nothing. */
static const double MOST_TILT = 0.3;

/* How closely the longest pair is sought, and the least step, relative to the parameter range. */
static const double STEP_PRECISION = 1e-3;
static const double LEAST_STEP = 1e-14;

/* A cut, and the pair of arcs that leads to it from the cut before. */
struct node {
    double t;
    narc_post post;
    narc_spline_arc arcs[2];
    size_t arc_count, total; /* of this pair; of all to here */
    size_t previous;
};

struct search {
    const narc_cubic *curve;
    double tolerance, rounding;
    double last;        /* parameter at the end */
    narc_post final;    /* and what is there */
    struct node *nodes; /* the first is the start */
    size_t count, capacity;
    size_t front[SHARES], front_count; /* the furthest that so many pairs reach */
};

/* The angle by which the tangent at a cut is best turned from the curve's. */
static double find_full_tilt(const narc_derivatives *d, double tolerance) {
    const double square = dot(d->first, d->first), bend = cross(d->first, d->second);
    const double slope = cross(d->first, d->third) * square - 3 * bend * dot(d->first, d->second);
    const double rate = slope / (square * square * square);
    const double cube = tolerance / (sqrt(3) / 216 * fabs(rate));
    if (!isfinite(cube))
        return 0;
    const double arc = narc_pow(cube, 1.0 / 3);
    const double tilt = -rate * arc * arc / 12;
    return isnan(tilt) ? 0 : fmax(-MOST_TILT, fmin(MOST_TILT, tilt));
}

static narc_post post_at(const struct search *s, double t, double share) {
    const narc_derivatives d = narc_derive_cubic(s->curve, t);
    const narc_point turn = unit_at(share * find_full_tilt(&d, s->tolerance));
    const double speed = length(d.first);
    const narc_point u = {d.first.x / speed, d.first.y / speed};
    return (narc_post){narc_cut_cubic(s->curve, t, t).c[0], {u.x * turn.x - u.y * turn.y, u.x * turn.y + u.y * turn.x}};
}

/* What rounding does to arcs as centre and radius. */
static double find_arc_rounding(const struct node *n) {
    double rounding = 0;
    for (size_t k = 0; k < n->arc_count; k++) {
        const double curvature = fabs(n->arcs[k].curvature);
        rounding = curvature > 0 ? fmax(rounding, 2 * DBL_EPSILON / curvature) : rounding;
    }
    return rounding;
}

/* Arcs from a node to a post; false if there are none within the tolerance. */
static bool try_pair(const struct search *s, size_t before, double t, narc_post post, struct node *out) {
    const struct node *start = &s->nodes[before];
    if (!(t > start->t))
        return false;
    const narc_cubic part = narc_cut_cubic(s->curve, start->t, t);
    struct node n = {.t = t, .post = post, .previous = before};
    n.arc_count = narc_join_posts(start->post, post, narc_find_share(&part, start->post, post), n.arcs);
    n.total = start->total + n.arc_count;
    const double limit = s->tolerance - find_arc_rounding(&n);
    if (n.arc_count == 0 || !(narc_bound_distance(&part, n.arcs, n.arc_count, s->rounding, limit) <= limit))
        return false;
    *out = n;
    return true;
}

/* Moves `best`, a cut with this share of tilt, further along the curve if it can be done from node `before`. */
static void reach(const struct search *s, size_t before, double share, struct node *best) {
    const struct node *start = &s->nodes[before];
    const double most = (s->last - start->t) * (1 - STEP_PRECISION);
    double good = fmax(0, best->t - start->t), bad = INFINITY, step = most;
    struct node n;
    if (good > 0) {
        if (!try_pair(s, before, best->t, post_at(s, best->t, share), &n))
            return;
        step = 1.1 * good;
    } else if (before > 0) {
        step = start->t - s->nodes[start->previous].t;
    }
    while (fmin(bad, most) - good > STEP_PRECISION * good) {
        step = fmin(step, most);
        if (try_pair(s, before, start->t + step, post_at(s, start->t + step, share), &n)) {
            good = step;
            *best = n;
        } else {
            bad = step;
        }
        if (bad < LEAST_STEP)
            return;
        step = isinf(bad) ? 1.3 * good : good > 0 ? (good + bad) / 2 : 0.6 * bad;
    }
}

static bool add_node(struct search *s, const struct node *n) {
    struct node *nodes = narc_grow(s->nodes, &s->capacity, s->count + 1, sizeof *nodes);
    if (!nodes)
        return false;
    s->nodes = nodes;
    s->nodes[s->count++] = *n;
    return true;
}

/* The last pair, if the end is in reach, with the fewest arcs in all. */
static bool finish(const struct search *s, struct node *best) {
    bool found = false;
    for (size_t i = 0; i < s->front_count; i++) {
        struct node n;
        if (try_pair(s, s->front[i], s->last, s->final, &n) && (!found || n.total < best->total)) {
            *best = n;
            found = true;
        }
    }
    return found;
}

/* From the cuts that so many pairs reach to those of one more. */
static narc_status advance(struct search *s, narc_error *error) {
    size_t front[SHARES], count = 0;
    for (int k = 0; k < SHARES; k++) {
        struct node best = {.t = -1};
        for (size_t i = 0; i < s->front_count; i++)
            reach(s, s->front[i], SHARE[k], &best);
        if (best.t < 0)
            continue;
        front[count++] = s->count;
        if (!add_node(s, &best))
            return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
    }
    if (count == 0) {
        const double t = s->nodes[s->front[0]].t;
        return narc_fail(error, NARC_ERROR_NO_SOLUTION, 0, t, "no arcs go on from parameter %g of the curve", t);
    }
    for (size_t i = 0; i < count; i++)
        s->front[i] = front[i];
    s->front_count = count;
    return NARC_OK;
}

/* Adds the arcs that lead to a node, and makes their distance a close one. */
static bool take_arcs(struct search *s, const struct node *last, narc_arc_list *list) {
    const size_t count = list->count + last->total;
    narc_curve_arc *arcs = narc_grow(list->arcs, &list->capacity, count, sizeof *arcs);
    if (!arcs)
        return false;
    list->arcs = arcs;
    list->count = count;
    size_t end = count;
    for (const struct node *n = last; n->arc_count; n = &s->nodes[n->previous]) {
        end -= n->arc_count;
        for (size_t k = 0; k < n->arc_count; k++)
            arcs[end + k] = narc_describe_arc(&n->arcs[k]);
        const narc_cubic part = narc_cut_cubic(s->curve, s->nodes[n->previous].t, n->t);
        const double bound = narc_bound_distance(&part, n->arcs, n->arc_count, s->rounding, INFINITY);
        /* It was found to be within the tolerance, which a bound that is close only to some per mille may not be. */
        list->distance = fmax(list->distance, fmin(bound + find_arc_rounding(n), s->tolerance));
    }
    return true;
}

static narc_status fit_smooth_part(struct search *s, narc_arc_list *list, narc_error *error) {
    struct node end;
    s->front[0] = 0;
    s->front_count = 1;
    while (!finish(s, &end)) {
        const narc_status status = advance(s, error);
        if (status != NARC_OK)
            return status;
    }
    return take_arcs(s, &end, list) ? NARC_OK : narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
}

narc_status narc_fit_spline(const narc_cubic *curve, double tolerance, double rounding, narc_arc_list *list,
                            narc_error *error) {
    narc_cusp cusps[3];
    narc_point ends[2];
    const size_t cusp_count = narc_find_cusps(curve, rounding, cusps, ends);
    struct search s = {.curve = curve, .tolerance = tolerance, .rounding = rounding};
    struct node start = {.post = {curve->c[0], ends[0]}};
    narc_status status = NARC_OK;
    for (size_t k = 0; k <= cusp_count && status == NARC_OK; k++) {
        const bool at_end = k == cusp_count;
        s.last = at_end ? 1 : cusps[k].t;
        s.final = (narc_post){narc_cut_cubic(curve, s.last, s.last).c[0], at_end ? ends[1] : cusps[k].arriving};
        s.count = 0;
        if (!add_node(&s, &start)) {
            status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
            break;
        }
        status = fit_smooth_part(&s, list, error);
        start.t = s.last;
        start.post = (narc_post){s.final.point, at_end ? ends[1] : cusps[k].leaving};
    }
    free(s.nodes);
    return status;
}
