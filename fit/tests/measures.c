/* SPDX-License-Identifier: MIT
 *
 * measures.c - measures of fits from their definitions.
 */
#include "measures.h"

#include <math.h>
#include <stdlib.h>

#include "support.h"

typedef narc_point point;

static point minus(point a, point b) { return (point){a.x - b.x, a.y - b.y}; }
static double dot(point a, point b) { return a.x * b.x + a.y * b.y; }
static double cross(point a, point b) { return a.x * b.y - a.y * b.x; }
static double distance(point a, point b) { return hypot(a.x - b.x, a.y - b.y); }
static point unit_at(double angle) { return (point){cos(angle), sin(angle)}; }
static point arc_point(const narc_arc *arc, double angle) {
    return (point){arc->center_x + arc->radius * cos(angle), arc->center_y + arc->radius * sin(angle)};
}

static void *claim(size_t size) {
    void *memory = malloc(size);
    assert_non_null(memory);
    return memory;
}

/* Forwards from `start`, to `angle`, less than a turn. */
static double turn_to(double start, double angle) {
    const double turn = fmod(angle - start, 2 * PI);
    return turn < 0 ? turn + 2 * PI : turn;
}

static double sweep_of(const narc_arc *arc) {
    const double sweep = arc->end - arc->start;
    return sweep > 0 ? sweep : sweep + 2 * PI;
}

/* ---------------------------------------------------------------------------- the hull */

struct reference_hull reference_wrap(const narc_point *points, size_t count, narc_point origin) {
    point *p = claim(count * sizeof *p);
    size_t lowest = 0;
    for (size_t k = 0; k < count; k++) {
        p[k] = minus(points[k], origin);
        const bool lower = p[k].y < p[lowest].y || (p[k].y == p[lowest].y && p[k].x < p[lowest].x);
        lowest = lower ? k : lowest;
    }
    struct reference_hull hull = {.corners = claim(count * sizeof *p)};
    size_t here = lowest;
    do {
        hull.corners[hull.count++] = p[here];
        size_t next = here;
        for (size_t k = 0; k < count; k++) {
            const point a = minus(p[next], p[here]), b = minus(p[k], p[here]);
            const double side = cross(a, b);
            const bool differs = p[k].x != p[here].x || p[k].y != p[here].y;
            if (differs && (next == here || side < 0 || (side == 0 && dot(b, b) > dot(a, a))))
                next = k;
        }
        here = next;
    } while ((p[here].x != p[lowest].x || p[here].y != p[lowest].y) && hull.count < count);
    point mean = {0, 0};
    for (size_t k = 0; k < hull.count; k++) {
        const point a = hull.corners[k], b = hull.corners[(k + 1) % hull.count];
        hull.area += cross(a, b) / 2;
        hull.perimeter += distance(a, b);
        mean = (point){mean.x + a.x / (double)hull.count, mean.y + a.y / (double)hull.count};
    }
    for (size_t k = 0; k < hull.count; k++)
        hull.radius = fmax(hull.radius, distance(hull.corners[k], mean));
    free(p);
    return hull;
}

/* ---------------------------------------------------------------------------- support functions */

double reference_hull_support(const struct reference_hull *hull, double angle) {
    const point u = unit_at(angle);
    double most = -INFINITY;
    for (size_t k = 0; k < hull->count; k++)
        most = fmax(most, dot(hull->corners[k], u));
    return most;
}

double reference_arcs_support(const narc_arc *arcs, size_t count, double angle) {
    const point u = unit_at(angle);
    double most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *arc = &arcs[k];
        most = fmax(most, fmax(dot(arc_point(arc, arc->start), u), dot(arc_point(arc, arc->end), u)));
        if (turn_to(arc->start, angle) <= sweep_of(arc))
            most = fmax(most, arc->center_x * u.x + arc->center_y * u.y + arc->radius);
    }
    return most;
}

struct comparison {
    const narc_arc *arcs;
    size_t count;
    const struct reference_hull *hull;
};

static double difference_at(const struct comparison *c, double angle) {
    return reference_arcs_support(c->arcs, c->count, angle) - reference_hull_support(c->hull, angle);
}

/* The largest of sign times the difference between two directions, near which it is unimodal: golden sections. */
static double refine(const struct comparison *c, double sign, double low, double high) {
    const double golden = 0.6180339887498949;
    double a = high - golden * (high - low), b = low + golden * (high - low);
    double at_a = sign * difference_at(c, a), at_b = sign * difference_at(c, b);
    for (int k = 0; k < 40; k++) {
        if (at_a > at_b) {
            high = b;
            b = a;
            at_b = at_a;
            a = high - golden * (high - low);
            at_a = sign * difference_at(c, a);
        } else {
            low = a;
            a = b;
            at_a = at_b;
            b = low + golden * (high - low);
            at_b = sign * difference_at(c, b);
        }
    }
    return fmax(at_a, at_b);
}

static int compare_angles(const void *a, const void *b) {
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

struct reference_range reference_compare(const narc_arc *arcs, size_t count, const struct reference_hull *hull) {
    enum { EVEN = 1024 };
    const struct comparison c = {arcs, count, hull};
    const size_t total = EVEN + count + hull->count;
    double *angles = claim((total + 1) * sizeof *angles), *values = claim((total + 1) * sizeof *values);
    for (size_t k = 0; k < EVEN; k++)
        angles[k] = 2 * PI * (double)k / EVEN;
    for (size_t k = 0; k < count; k++)
        angles[EVEN + k] = turn_to(0, arcs[k].start);
    for (size_t k = 0; k < hull->count; k++) {
        const point side = minus(hull->corners[(k + 1) % hull->count], hull->corners[k]);
        angles[EVEN + count + k] = turn_to(0, atan2(-side.x, side.y));
    }
    qsort(angles, total, sizeof *angles, compare_angles);
    angles[total] = angles[0] + 2 * PI;
    struct reference_range range = {INFINITY, -INFINITY};
    for (size_t k = 0; k <= total; k++) {
        values[k] = difference_at(&c, angles[k]);
        range.least = fmin(range.least, values[k]);
        range.largest = fmax(range.largest, values[k]);
    }
    /* Between two of these directions one arc and one corner count, whose difference changes its slope by no more than
     * (distance of corner and centre) times the step; that is less than `room` for the values between. */
    for (size_t k = 0; k < total; k++) {
        const double step = angles[k + 1] - angles[k];
        double reach = hull->radius;
        for (size_t i = 0; i < count; i++)
            reach = fmax(reach, 2 * hull->radius + hypot(arcs[i].center_x, arcs[i].center_y));
        const double room = reach * step * step / 8;
        if (fmin(values[k], values[k + 1]) - room < range.least)
            range.least = fmin(range.least, -refine(&c, -1, angles[k], angles[k + 1]));
        if (fmax(values[k], values[k + 1]) + room > range.largest)
            range.largest = fmax(range.largest, refine(&c, 1, angles[k], angles[k + 1]));
    }
    free(angles);
    free(values);
    return range;
}

/* ---------------------------------------------------------------------------- area and perimeter */

struct polygon_measure {
    double area, perimeter;
};

static struct polygon_measure measure_polygon(const narc_arc *arcs, size_t count, size_t per_arc) {
    struct polygon_measure sum = {0, 0};
    point before = arc_point(&arcs[count - 1], arcs[count - 1].end);
    for (size_t i = 0; i < count; i++) {
        for (size_t k = 0; k <= per_arc; k++) {
            const double angle = arcs[i].start + sweep_of(&arcs[i]) * (double)k / (double)per_arc;
            const point here = arc_point(&arcs[i], angle);
            sum.area += cross(before, here) / 2;
            sum.perimeter += distance(before, here);
            before = here;
        }
    }
    return sum;
}

/* Chords of 1 / m of an arc lose a share of 1 / m^2 of area and length, and of 1 / m^4 after extrapolation: with m =
 * 256 and half a turn, (pi / 256)^4 / 100 = 2e-10. */
enum { CHORDS = 256 };

double reference_area(const narc_arc *arcs, size_t count) {
    return (4 * measure_polygon(arcs, count, 2 * CHORDS).area - measure_polygon(arcs, count, CHORDS).area) / 3;
}

double reference_perimeter(const narc_arc *arcs, size_t count) {
    return (4 * measure_polygon(arcs, count, 2 * CHORDS).perimeter - measure_polygon(arcs, count, CHORDS).perimeter) /
           3;
}

/* ---------------------------------------------------------------------------- distances between outlines */

static double segment_distance(point p, point a, point b) {
    const point ab = minus(b, a), ap = minus(p, a);
    const double t = fmax(0, fmin(1, dot(ap, ab) / dot(ab, ab)));
    return hypot(ap.x - t * ab.x, ap.y - t * ab.y);
}

static double outline_distance(const struct reference_hull *hull, point p) {
    double least = INFINITY;
    for (size_t k = 0; k < hull->count; k++)
        least = fmin(least, segment_distance(p, hull->corners[k], hull->corners[(k + 1) % hull->count]));
    return least;
}

double reference_mean_distance(const narc_arc *arcs, size_t count, const struct reference_hull *hull) {
    enum { PIECES = 10000 };
    const double perimeter = reference_perimeter(arcs, count);
    double sum = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *next = &arcs[(i + 1) % count];
        const double length = arc->radius * sweep_of(arc);
        const size_t pieces = (size_t)(PIECES * length / perimeter) + 1;
        for (size_t k = 0; k < pieces; k++) {
            const double angle = arc->start + sweep_of(arc) * ((double)k + 0.5) / (double)pieces;
            sum += length / (double)pieces * outline_distance(hull, arc_point(arc, angle));
        }
        const point a = arc_point(arc, arc->end), b = arc_point(next, next->start);
        const size_t parts = (size_t)(PIECES * distance(a, b) / perimeter) + 1;
        for (size_t k = 0; k < parts; k++) {
            const double t = ((double)k + 0.5) / (double)parts;
            const point p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            sum += distance(a, b) / (double)parts * outline_distance(hull, p);
        }
    }
    return sum / perimeter;
}

size_t reference_count_edges(const narc_arc *arcs, size_t count, double length) {
    size_t edges = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *next = &arcs[(i + 1) % count];
        edges += distance(arc_point(&arcs[i], arcs[i].end), arc_point(next, next->start)) > length;
    }
    return edges;
}

/* ---------------------------------------------------------------------------- symmetric difference */

/* Where a ray from p leaves a segment's line; -1 if it does not cross the segment. */
static double cross_segment(point p, point u, point a, point b) {
    const point ab = minus(b, a), pa = minus(a, p);
    const double across = cross(u, ab);
    const double s = cross(pa, u) / across, t = cross(pa, ab) / across;
    return s >= -1e-9 && s <= 1 + 1e-9 && t > 0 ? t : -1;
}

static double cross_hull(const struct reference_hull *hull, point p, point u) {
    double furthest = 0;
    for (size_t k = 0; k < hull->count; k++)
        furthest = fmax(furthest, cross_segment(p, u, hull->corners[k], hull->corners[(k + 1) % hull->count]));
    return furthest;
}

static double cross_arcs(const narc_arc *arcs, size_t count, point p, point u) {
    double furthest = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *next = &arcs[(i + 1) % count];
        const point a = arc_point(arc, arc->end), b = arc_point(next, next->start);
        if (distance(a, b) > 0)
            furthest = fmax(furthest, cross_segment(p, u, a, b));
        const point center = {arc->center_x - p.x, arc->center_y - p.y};
        const double off = cross(u, center), square = arc->radius * arc->radius - off * off;
        if (square >= 0) {
            const double t = dot(u, center) + sqrt(square);
            const double angle = atan2(t * u.y - center.y, t * u.x - center.x);
            furthest = turn_to(arc->start - 1e-9, angle) <= sweep_of(arc) + 2e-9 ? fmax(furthest, t) : furthest;
        }
    }
    return furthest;
}

double reference_difference(const narc_arc *arcs, size_t count, const struct reference_hull *hull, size_t rays) {
    point mean = {0, 0};
    for (size_t k = 0; k < hull->count; k++) {
        mean.x += hull->corners[k].x / (double)hull->count;
        mean.y += hull->corners[k].y / (double)hull->count;
    }
    double sum = 0;
    for (size_t k = 0; k < rays; k++) {
        const point u = unit_at(2 * PI * ((double)k + 0.5) / (double)rays);
        const double a = cross_arcs(arcs, count, mean, u), b = cross_hull(hull, mean, u);
        sum += fabs(a * a - b * b) / 2 * 2 * PI / (double)rays;
    }
    return sum;
}

/* ---------------------------------------------------------------------------- smallest circle */

static double radius_around(point center, const struct reference_hull *hull) {
    double radius = 0;
    for (size_t k = 0; k < hull->count; k++)
        radius = fmax(radius, distance(center, hull->corners[k]));
    return radius;
}

double reference_smallest_circle(const narc_point *points, size_t count) {
    struct reference_hull hull = reference_wrap(points, count, (point){0, 0});
    double best = INFINITY;
    for (size_t i = 0; i < hull.count; i++) {
        for (size_t j = 0; j < i; j++) {
            const point a = hull.corners[i], b = minus(hull.corners[j], a);
            best = fmin(best, radius_around((point){a.x + b.x / 2, a.y + b.y / 2}, &hull));
            for (size_t k = 0; k < j; k++) {
                const point c = minus(hull.corners[k], a);
                const double twice = 2 * cross(b, c);
                const point center = {(c.y * dot(b, b) - b.y * dot(c, c)) / twice,
                                      (b.x * dot(c, c) - c.x * dot(b, b)) / twice};
                best = fmin(best, radius_around((point){a.x + center.x, a.y + center.y}, &hull));
            }
        }
    }
    free(hull.corners);
    return best;
}
