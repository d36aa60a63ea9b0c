/* SPDX-License-Identifier: MIT
 *
 * oracle.c - properties of arcs by sampling and searching.
 */
#include "oracle.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "ray_reference.h"
#include "support.h"

static double sweep_of(const narc_arc *arc) {
    double sweep = arc->end - arc->start;
    return sweep < 0 ? sweep + 2 * PI : sweep;
}

static narc_point point_on(const narc_arc *arc, double angle) {
    return (narc_point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

static narc_point start_of(const narc_arc *arc) { return point_on(arc, arc->start); }
static narc_point end_of(const narc_arc *arc) { return point_on(arc, arc->start + sweep_of(arc)); }

static double distance_of(narc_point a, narc_point b) { return hypot(a.x - b.x, a.y - b.y); }

static double cross(narc_point a, narc_point b, narc_point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

/* Two arcs that are closer than this meet: what is between them is rounding, and has no direction. */
static const double shortest_edge = 1e-6;

/* Between two samples that are a step t apart, an arc of radius r rises r (1 - cos(t / 2)) < r t^2 / 8 above its chord,
 * is longer by r (t - 2 sin(t / 2)) <= r t^3 / 24 and has r^2 (t - sin t) / 2 <= r^2 t^3 / 12 of area outside it. */
struct samples oracle_sample(const narc_arc *arcs, size_t count, size_t per_arc) {
    struct samples samples = {.point = malloc(count * (per_arc + 1) * sizeof *samples.point)};
    for (size_t i = 0; i < count; i++) {
        double step = sweep_of(&arcs[i]) / (double)per_arc, radius = arcs[i].radius;
        for (size_t k = 0; k <= per_arc; k++)
            samples.point[samples.count++] = point_on(&arcs[i], arcs[i].start + step * (double)k);
        narc_point end = end_of(&arcs[i]), next = start_of(&arcs[(i + 1) % count]);
        double x = next.x - end.x, y = next.y - end.y, angle = arcs[(i + 1) % count].start;
        double gap = hypot(x, y) <= shortest_edge ? hypot(x, y) : fabs(x * cos(angle) + y * sin(angle));
        samples.defect = fmax(samples.defect, gap);
        samples.height_error = fmax(samples.height_error, radius * step * step / 8);
        samples.length_error += (double)per_arc * radius * step * step * step / 24;
        samples.area_error += (double)per_arc * radius * radius * step * step * step / 12;
    }
    return samples;
}

void oracle_free(struct samples *samples) { free(samples->point); }

narc_mass oracle_mass(const struct samples *samples) {
    narc_mass mass = {0};
    narc_point first = samples->point[0];
    double x = 0, y = 0, square = 0;
    for (size_t k = 1; k + 1 < samples->count; k++) {
        narc_point b = samples->point[k], c = samples->point[k + 1];
        double area = cross(first, b, c) / 2;
        b.x -= first.x, b.y -= first.y, c.x -= first.x, c.y -= first.y;
        mass.area += area;
        x += area * (b.x + c.x) / 3;
        y += area * (b.y + c.y) / 3;
        /* A quadratic's integral over a triangle is its area times the mean of the values at the sides' middles. */
        double mx = (b.x + c.x) / 2, my = (b.y + c.y) / 2;
        square += area / 3 * ((b.x * b.x + b.y * b.y + c.x * c.x + c.y * c.y) / 4 + mx * mx + my * my);
    }
    x /= mass.area;
    y /= mass.area;
    mass.centroid_x = first.x + x;
    mass.centroid_y = first.y + y;
    mass.second_moment = square - mass.area * (x * x + y * y);
    return mass;
}

double oracle_perimeter(const struct samples *samples) {
    double sum = 0;
    for (size_t k = 0; k < samples->count; k++)
        sum += distance_of(samples->point[k], samples->point[(k + 1) % samples->count]);
    return sum;
}

double oracle_height(const struct samples *samples, double x, double y) {
    double best = -INFINITY;
    for (size_t k = 0; k < samples->count; k++)
        best = fmax(best, x * samples->point[k].x + y * samples->point[k].y);
    return best;
}

/* Does the arc have this angle? */
static bool has_angle(const narc_arc *arc, double angle) {
    double after = fmod(angle - arc->start, 2 * PI);
    return (after < 0 ? after + 2 * PI : after) <= sweep_of(arc);
}

double oracle_distance(const narc_arc *arcs, size_t count, narc_point point) {
    struct shape shape = {.count = count};
    memcpy(shape.arcs, arcs, count * sizeof *arcs);
    const struct outline_reference outline = make_outline_reference(&shape);
    return (double)find_signed_distance(&outline, (long double)point.x, (long double)point.y);
}

double oracle_reach(const narc_arc *arcs, size_t count, narc_point point) {
    double best = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i];
        double x = arc->center_x - point.x, y = arc->center_y - point.y;
        if (has_angle(arc, atan2(y, x)))
            best = fmax(best, hypot(x, y) + arc->radius);
        best = fmax(best, fmax(distance_of(point, start_of(arc)), distance_of(point, end_of(arc))));
    }
    return best;
}

/* ------------------------------------------------------------------------------------------------ searches */

typedef double function(const narc_arc *arcs, size_t count, narc_point point);

struct search {
    function *f;
    const narc_arc *arcs;
    size_t count;
    narc_point low, high;
};

/* Each step leaves 0.62 of the range: 52 leave 2e-11, and what is searched is as steep as a distance. */
enum { SEARCH_STEPS = 52 };

static double search_y(const struct search *search, double x) {
    double low = search->low.y, high = search->high.y, best = INFINITY;
    for (int k = 0; k < SEARCH_STEPS; k++) {
        double a = low + 0.38 * (high - low), b = low + 0.62 * (high - low);
        double at_a = search->f(search->arcs, search->count, (narc_point){x, a});
        double at_b = search->f(search->arcs, search->count, (narc_point){x, b});
        *(at_a < at_b ? &high : &low) = at_a < at_b ? b : a;
        best = fmin(best, fmin(at_a, at_b));
    }
    return best;
}

/* The least value of a convex function of the point, which lies among the arcs' ends. */
static double search_plane(function *f, const narc_arc *arcs, size_t count) {
    narc_point first = start_of(&arcs[0]);
    double reach = oracle_reach(arcs, count, first), best = INFINITY;
    struct search search = {f, arcs, count, {first.x - reach, first.y - reach}, {first.x + reach, first.y + reach}};
    double low = search.low.x, high = search.high.x;
    for (int k = 0; k < SEARCH_STEPS; k++) {
        double a = low + 0.38 * (high - low), b = low + 0.62 * (high - low);
        double at_a = search_y(&search, a), at_b = search_y(&search, b);
        *(at_a < at_b ? &high : &low) = at_a < at_b ? b : a;
        best = fmin(best, fmin(at_a, at_b));
    }
    return best;
}

double oracle_bounding_radius(const narc_arc *arcs, size_t count) { return search_plane(oracle_reach, arcs, count); }

double oracle_inscribed_radius(const narc_arc *arcs, size_t count) {
    return -search_plane(oracle_distance, arcs, count);
}
