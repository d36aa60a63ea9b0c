/* SPDX-License-Identifier: MIT
 *
 * polyline.c - chains of lines as arcs: cut at corners, and from there pairs of arcs as long as the tolerance lets them
 * be.
 *
 * The chain is looked at through a window of some tolerances: where it turns much within it there is a corner, which
 * stays, and elsewhere the chord of the window is the tangent. A pair of arcs is compared with its part of the chain by
 * the radial projection on the arcs. That goes from the pair's start to its end without a jump, so each point of the
 * arcs is the image of some point of the chain, and the largest distance that the projection moves a point bounds how
 * far either is from the other. On a line that distance is largest at an end, at the foot of the perpendicular from the
 * centre, or where the line passes from one arc to the other.
 */
#include "biarc/biarc.h"

#include <stdlib.h>

#include "error.h"
#include "outline/path.h"

/* The window reaches so many tolerances to either side, and so many times the slack: the stairs of a traced outline are
 * then flat enough. */
static const double WINDOW_TOLERANCES = 4, WINDOW_SLACKS = 8;

/* A chain that turns more than this within the window has a corner there. */
static const double CORNER = 0.5;

/* A window that ends at a corner has at least this part of its width to either side. */
static const double LEAST_WINDOW = 0.25;

/* Where the chain keeps within this part of the tolerance to its chord, at so many places, the window is wider. */
static const double FLATNESS = 0.25;
enum { FLATNESS_SAMPLES = 16 };

struct chain {
    const narc_polyline *line;
    double *along; /* length up to each point */
    bool *corner;
    double window, tolerance;
};

/* ---------------------------------------------------------------------------- places and tangents */

static size_t last_of(const struct chain *chain) { return chain->line->count - 1; }

/* The point at a length between those of points `low` and `high`. */
static narc_point find_point(const struct chain *chain, size_t low, size_t high, double length_along) {
    while (high - low > 1) {
        const size_t middle = (low + high) / 2;
        *(chain->along[middle] <= length_along ? &low : &high) = middle;
    }
    const narc_point p = chain->line->points[low], q = chain->line->points[high];
    return along(p, (length_along - chain->along[low]) / (chain->along[high] - chain->along[low]), minus(q, p));
}

/* The point `distance` along the chain from point k, or its end; closed chains go round. */
static narc_point look(const struct chain *chain, size_t k, double distance) {
    const double whole = chain->along[last_of(chain)];
    double target = chain->along[k] + distance;
    if (chain->line->closed)
        target -= whole * floor(target / whole);
    return find_point(chain, 0, last_of(chain), fmin(fmax(target, 0), whole));
}

static double turn_at(const struct chain *chain, size_t k, double window) {
    const narc_point p = chain->line->points[k];
    const narc_point in = minus(p, look(chain, k, -window)), out = minus(look(chain, k, window), p);
    return fabs(narc_atan2(cross(in, out), dot(in, out)));
}

/* Is the chain between two lengths near its chord? */
static bool is_flat(const struct chain *chain, size_t k, double from, double to) {
    const narc_point p = look(chain, k, from), q = look(chain, k, to), chord = minus(q, p);
    const double most = FLATNESS * chain->tolerance * length(chord);
    for (unsigned s = 1; s < FLATNESS_SAMPLES; s++) {
        const narc_point x = look(chain, k, from + (to - from) * s / FLATNESS_SAMPLES);
        if (fabs(cross(chord, minus(x, p))) > most)
            return false;
    }
    return true;
}

/* The window's width at point k, at most `limit`: wider than usual where the chain is nearly straight. `both`: to both
 * sides, or else to one, of the direction `sign`. */
static double widen(const struct chain *chain, size_t k, double limit, bool both, double sign) {
    double width = fmin(chain->window, limit);
    while (width < limit) {
        const double next = fmin(2 * width, limit);
        if (!is_flat(chain, k, both ? -next : 0, sign * next))
            break;
        width = next;
    }
    return width;
}

/* At point k within the section from `first` to `last`; near its ends, where the chain is looked at to one side alone,
 * by a parabola. */
static narc_post find_post(const struct chain *chain, size_t first, size_t last, size_t k) {
    const double *at = chain->along, whole = at[last] - at[first];
    const narc_point p = chain->line->points[k];
    const bool ring = first == 0 && last == last_of(chain) && chain->line->closed && !chain->corner[0];
    const double before = ring ? 0.25 * whole : at[k] - at[first], after = ring ? 0.25 * whole : at[last] - at[k];
    if (fmin(before, after) >= LEAST_WINDOW * fmin(chain->window, 0.5 * whole)) {
        const double width = widen(chain, k, fmin(before, after), true, 1);
        return (narc_post){p, unit(minus(look(chain, k, width), look(chain, k, -width)))};
    }
    const double sign = after > before ? 1 : -1, side = sign * widen(chain, k, fmax(before, after), false, sign);
    const narc_point near = minus(look(chain, k, 0.5 * side), p), far = minus(look(chain, k, side), p);
    const narc_point tangent = unit(minus((narc_point){4 * near.x, 4 * near.y}, far));
    return (narc_post){p, side > 0 ? tangent : (narc_point){-tangent.x, -tangent.y}};
}

/* Of two corners nearer to each other than the window, the one where the chain turns more stays. */
static size_t keep_sharper(struct chain *chain, size_t a, size_t b, double window) {
    const bool keep_a = turn_at(chain, a, window) >= turn_at(chain, b, window);
    chain->corner[keep_a ? b : a] = false;
    return keep_a ? a : b;
}

/* A corner is where the chain turns most within the window. */
static void mark_corners(struct chain *chain) {
    const size_t last = last_of(chain), none = chain->line->count;
    const double window = fmin(chain->window, 0.25 * chain->along[last]);
    size_t first = none, recent = none;
    for (size_t k = 0; k <= last; k++)
        chain->corner[k] = false;
    for (size_t k = chain->line->closed ? 0 : 1; k < last; k++) {
        if (turn_at(chain, k, window) <= CORNER)
            continue;
        chain->corner[k] = true;
        const bool near = recent < none && chain->along[k] - chain->along[recent] < window;
        const bool alone = recent == first;
        recent = near ? keep_sharper(chain, recent, k, window) : k;
        first = first == none || (near && alone) ? recent : first;
    }
    if (!chain->line->closed)
        chain->corner[0] = chain->corner[last] = true;
    else if (first < recent && recent < none &&
             chain->along[first] + chain->along[last] - chain->along[recent] < window)
        keep_sharper(chain, first, recent, window);
    chain->corner[last] = chain->corner[last] || chain->corner[0];
}

/* ---------------------------------------------------------------------------- distances */

/* How far a point is from an arc, by radial projection. */
static double measure_point(const narc_spline_arc *arc, narc_point p) {
    const narc_point from_start = minus(p, arc->start), from_end = minus(p, arc->end);
    if (dot(from_start, arc->start_tangent) < 0)
        return length(from_start);
    if (dot(from_end, arc->end_tangent) > 0)
        return length(from_end);
    const double k = arc->curvature;
    const double f = 0.5 * k * dot(from_start, from_start) - dot(from_start, turned(arc->start_tangent));
    return fabs(2 * f / (1 + sqrt(fmax(0, 1 + 2 * k * f))));
}

/* The largest distance of the points of a line. */
static double measure_line(const narc_spline_arc *arc, narc_point p, narc_point q) {
    const narc_point e = minus(q, p), from_start = minus(p, arc->start);
    double largest = fmax(measure_point(arc, p), measure_point(arc, q));
    const double slope = dot(e, turned(arc->start_tangent)) - arc->curvature * dot(from_start, e);
    const double foot = slope / (arc->curvature * dot(e, e));
    if (foot > 0 && foot < 1)
        largest = fmax(largest, measure_point(arc, along(p, foot, e)));
    return largest;
}

/* Projection jumps at a centre: what is kept is less than half the radius away. */
static bool is_near(const struct chain *chain, const narc_spline_arc *arc, narc_point p, narc_point q,
                    double *largest) {
    const double distance = measure_line(arc, p, q);
    *largest = fmax(*largest, distance);
    return distance <= chain->tolerance && distance * fabs(arc->curvature) < 0.5;
}

/* Do the arcs keep the tolerance to the chain's points from i to j? */
static bool keeps(const struct chain *chain, size_t i, size_t j, const narc_spline_arc *arcs, size_t count,
                  double *out_distance) {
    const narc_spline_arc *last = &arcs[count - 1];
    *out_distance = 0;
    for (size_t k = i; k < j; k++) {
        const narc_point p = chain->line->points[k], q = chain->line->points[k + 1];
        const double a = dot(minus(p, last->start), last->start_tangent);
        const double b = dot(minus(q, last->start), last->start_tangent);
        const bool first_p = count > 1 && a<0, first_q = count> 1 && b < 0;
        const narc_point middle = first_p != first_q ? along(p, a / (a - b), minus(q, p)) : q;
        if (!is_near(chain, first_p ? arcs : last, p, middle, out_distance) ||
            (first_p != first_q && !is_near(chain, first_q ? arcs : last, middle, q, out_distance)))
            return false;
    }
    return true;
}

/* ---------------------------------------------------------------------------- arcs */

/* Arcs between two points of a section that keep the tolerance, their number or 0. One line will do between corners. */
static size_t join(const struct chain *chain, size_t first, size_t last, size_t i, size_t j,
                   narc_spline_arc out_arcs[2], double *out_distance) {
    const narc_post start = find_post(chain, first, last, i), end = find_post(chain, first, last, j);
    const narc_point chord = minus(end.point, start.point);
    if (length(chord) > 0 && (j == i + 1 || (chain->corner[i] && chain->corner[j]))) {
        const narc_point tangent = unit(chord);
        out_arcs[0] = (narc_spline_arc){start.point, end.point, tangent, tangent, 0, 0};
        if (keeps(chain, i, j, out_arcs, 1, out_distance))
            return 1;
    }
    const size_t count = narc_join_posts(start, end, 0.5, out_arcs);
    return count && keeps(chain, i, j, out_arcs, count, out_distance) ? count : 0;
}

/* The furthest point, at most `last`, to which arcs lead from point i: that one, or else by steps that double and then
 * halve. */
static size_t reach(const struct chain *chain, size_t first, size_t last, size_t i, narc_spline_arc out_arcs[2],
                    double *out_distance, size_t *out_count) {
    size_t good = i + 1, step = 1;
    *out_count = join(chain, first, last, i, last, out_arcs, out_distance);
    if (*out_count)
        return last;
    *out_count = join(chain, first, last, i, good, out_arcs, out_distance);
    for (bool growing = true; step > 0; step = growing ? 2 * step : step / 2) {
        narc_spline_arc arcs[2];
        double distance;
        const size_t next = last - good < step ? last : good + step;
        const size_t count = next > good ? join(chain, first, last, i, next, arcs, &distance) : 0;
        growing = growing && count && next < last;
        if (count == 0)
            continue;
        good = next;
        *out_count = count;
        *out_distance = distance;
        for (size_t k = 0; k < count; k++)
            out_arcs[k] = arcs[k];
    }
    return good;
}

static narc_status fit_section(const struct chain *chain, size_t first, size_t last, narc_arc_list *to,
                               narc_error *error) {
    for (size_t i = first; i < last;) {
        narc_spline_arc arcs[2];
        double distance = 0;
        size_t count;
        i = reach(chain, first, last, i, arcs, &distance, &count);
        narc_curve_arc *all = narc_grow(to->arcs, &to->capacity, to->count + count, sizeof *all);
        if (!all)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for arcs");
        to->arcs = all;
        for (size_t k = 0; k < count; k++)
            all[to->count++] = narc_describe_arc(&arcs[k]);
        to->distance = fmax(to->distance, distance);
    }
    return NARC_OK;
}

static narc_status fit_sections(const struct chain *chain, narc_arc_list *to, narc_error *error) {
    narc_status status = NARC_OK;
    for (size_t first = 0, k = 1; k < chain->line->count && !status; k++) {
        if (k + 1 < chain->line->count && !chain->corner[k])
            continue;
        status = fit_section(chain, first, k, to, error);
        first = k;
    }
    return status;
}

/* A ring that begins at its first corner, in `out_points`. False if it begins there or has no corner. */
static bool turn_ring(const struct chain *chain, narc_point *out_points) {
    const size_t last = last_of(chain);
    size_t first = 0;
    while (first < last && !chain->corner[first])
        first++;
    if (!chain->line->closed || first == 0 || first == last)
        return false;
    for (size_t k = 0; k <= last; k++)
        out_points[k] = chain->line->points[(first + k) % last];
    return true;
}

static void measure_chain(struct chain *chain) {
    chain->along[0] = 0;
    for (size_t k = 1; k < chain->line->count; k++)
        chain->along[k] = chain->along[k - 1] + length(minus(chain->line->points[k], chain->line->points[k - 1]));
    mark_corners(chain);
}

narc_status narc_add_polyline(const narc_polyline *line, double tolerance, narc_arc_list *to, narc_error *error) {
    const size_t before = to->count;
    narc_polyline ring = *line;
    narc_point *points = malloc(line->count * sizeof *points);
    struct chain chain = {.line = line,
                          .along = malloc(line->count * sizeof(double)),
                          .corner = calloc(line->count, sizeof(bool)),
                          .window = fmax(WINDOW_TOLERANCES * tolerance, WINDOW_SLACKS * line->slack),
                          .tolerance = tolerance};
    narc_status status = NARC_OK;
    for (size_t k = 0; k + 1 < line->count && !status; k++)
        status = narc_check_curve(line->points + k, 1, tolerance, error);
    if (!status && points && chain.along && chain.corner) {
        measure_chain(&chain);
        if (turn_ring(&chain, points)) {
            ring.points = points;
            chain.line = &ring;
            measure_chain(&chain);
        }
        status = fit_sections(&chain, to, error);
    } else if (!status) {
        status = narc_fail(error, NARC_ERROR_MEMORY, 0, 0, "no memory for a chain of %zu lines", line->count);
    }
    to->count = status ? before : to->count;
    free(points);
    free(chain.along);
    free(chain.corner);
    return status;
}
