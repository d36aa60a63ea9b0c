/* SPDX-License-Identifier: MIT
 *
 * measures.c - measures of fits from their definitions.
 */
#include "measures.h"

#include <math.h>
#include <stdlib.h>

#include "support.h"

typedef real_point point;

#define LONG_PI 3.14159265358979323846264338327950288L

static point minus(point a, point b) { return (point){a.x - b.x, a.y - b.y}; }
static real dot(point a, point b) { return a.x * b.x + a.y * b.y; }
static real cross(point a, point b) { return a.x * b.y - a.y * b.x; }
static real distance(point a, point b) { return hypotl(a.x - b.x, a.y - b.y); }
static point unit_at(real angle) { return (point){cosl(angle), sinl(angle)}; }
static point arc_point(const narc_arc *arc, real angle) {
    return (point){(real)arc->center_x + (real)arc->radius * cosl(angle),
                   (real)arc->center_y + (real)arc->radius * sinl(angle)};
}
static point arc_start(const narc_arc *arc) { return arc_point(arc, (real)arc->start); }
static point arc_end(const narc_arc *arc) { return arc_point(arc, (real)arc->end); }

static void *claim(size_t size) {
    void *memory = malloc(size);
    assert_non_null(memory);
    return memory;
}

/* Forwards from `start`, to `angle`, less than a turn. */
static real turn_to(real start, real angle) {
    const real turn = fmodl(angle - start, 2 * LONG_PI);
    return turn < 0 ? turn + 2 * LONG_PI : turn;
}

static real sweep_of(const narc_arc *arc) {
    const real sweep = (real)arc->end - (real)arc->start;
    return sweep > 0 ? sweep : sweep + 2 * LONG_PI;
}

/* ---------------------------------------------------------------------------- the hull */

static int compare_points(const void *left, const void *right) {
    const point *a = left, *b = right;
    return a->x != b->x ? (a->x > b->x) - (a->x < b->x) : (a->y > b->y) - (a->y < b->y);
}

static point mean_of(const struct reference_hull *hull) {
    point mean = {0, 0};
    for (size_t k = 0; k < hull->count; k++)
        mean =
            (point){mean.x + hull->corners[k].x / (real)hull->count, mean.y + hull->corners[k].y / (real)hull->count};
    return mean;
}

/* From left to right and back: what does not turn left is no corner. */
struct reference_hull reference_wrap(const narc_point *points, size_t count, narc_point origin) {
    AUTO(free_at) point *p = claim(count * sizeof *p);
    for (size_t k = 0; k < count; k++)
        p[k] = (point){(real)points[k].x - (real)origin.x, (real)points[k].y - (real)origin.y};
    qsort(p, count, sizeof *p, compare_points);
    struct reference_hull hull = {.corners = claim((2 * count + 1) * sizeof *p)};
    size_t least = 1;
    for (size_t k = 0; k < 2 * count - 1; k++) {
        const point next = p[k < count ? k : 2 * count - 2 - k];
        least = k == count ? hull.count : least;
        while (hull.count > least && cross(minus(hull.corners[hull.count - 1], hull.corners[hull.count - 2]),
                                           minus(next, hull.corners[hull.count - 1])) <= 0)
            hull.count--;
        hull.corners[hull.count++] = next;
    }
    hull.count -= hull.count > 1; /* the first, again */
    const point mean = mean_of(&hull);
    for (size_t k = 0; k < hull.count; k++) {
        const point a = hull.corners[k], b = hull.corners[(k + 1) % hull.count];
        hull.area += cross(minus(a, mean), minus(b, mean)) / 2;
        hull.perimeter += distance(a, b);
        hull.radius = fmaxl(hull.radius, distance(a, mean));
    }
    return hull;
}

/* ---------------------------------------------------------------------------- support functions */

real reference_hull_support(const struct reference_hull *hull, real angle) {
    const point u = unit_at(angle);
    real most = -INFINITY;
    for (size_t k = 0; k < hull->count; k++) {
        const real here = dot(hull->corners[k], u);
        most = here > most ? here : most; /* fmaxl() is a call, twice as long as the rest */
    }
    return most;
}

/* An arc with what is computed of it once. */
struct seen {
    point center, start, end;
    real radius, from, sweep;
};

static struct seen *see_arcs(const narc_arc *arcs, size_t count) {
    struct seen *seen = claim(count * sizeof *seen);
    for (size_t k = 0; k < count; k++)
        seen[k] = (struct seen){.center = {arcs[k].center_x, arcs[k].center_y},
                                .start = arc_start(&arcs[k]),
                                .end = arc_end(&arcs[k]),
                                .radius = arcs[k].radius,
                                .from = arcs[k].start,
                                .sweep = sweep_of(&arcs[k])};
    return seen;
}

static real find_support(const struct seen *arcs, size_t count, real angle) {
    const point u = unit_at(angle);
    real most = -INFINITY;
    for (size_t k = 0; k < count; k++) {
        most = fmaxl(most, fmaxl(dot(arcs[k].start, u), dot(arcs[k].end, u)));
        if (turn_to(arcs[k].from, angle) <= arcs[k].sweep)
            most = fmaxl(most, dot(arcs[k].center, u) + arcs[k].radius);
    }
    return most;
}

real reference_arcs_support(const narc_arc *arcs, size_t count, real angle) {
    AUTO(free_at) struct seen *seen = see_arcs(arcs, count);
    return find_support(seen, count, angle);
}

struct comparison {
    const struct seen *arcs;
    size_t count;
    const struct reference_hull *hull;
};

static real difference_at(const struct comparison *c, real angle) {
    return find_support(c->arcs, c->count, angle) - reference_hull_support(c->hull, angle);
}

/* The largest of sign times the difference between two directions, near which it is unimodal: golden sections. */
static real refine(const struct comparison *c, real sign, real low, real high) {
    const real golden = 0.618033988749894848L;
    real a = high - golden * (high - low), b = low + golden * (high - low);
    real at_a = sign * difference_at(c, a), at_b = sign * difference_at(c, b);
    for (int k = 0; k < 50; k++) {
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
    return fmaxl(at_a, at_b);
}

static int compare_angles(const void *a, const void *b) {
    const real x = *(const real *)a, y = *(const real *)b;
    return (x > y) - (x < y);
}

struct reference_range reference_compare(const narc_arc *arcs, size_t count, const struct reference_hull *hull) {
    enum { EVEN = 128 };
    AUTO(free_at) struct seen *seen = see_arcs(arcs, count);
    const struct comparison c = {seen, count, hull};
    const size_t total = EVEN + count + hull->count;
    AUTO(free_at) real *angles = claim((total + 1) * sizeof *angles), *values = claim((total + 1) * sizeof *values);
    for (size_t k = 0; k < EVEN; k++)
        angles[k] = 2 * LONG_PI * (real)k / EVEN;
    for (size_t k = 0; k < count; k++)
        angles[EVEN + k] = turn_to(0, arcs[k].start);
    for (size_t k = 0; k < hull->count; k++) {
        const point side = minus(hull->corners[(k + 1) % hull->count], hull->corners[k]);
        angles[EVEN + count + k] = turn_to(0, atan2l(-side.x, side.y));
    }
    qsort(angles, total, sizeof *angles, compare_angles);
    angles[total] = angles[0] + 2 * LONG_PI;
    struct reference_range range = {INFINITY, -INFINITY};
    for (size_t k = 0; k <= total; k++) {
        values[k] = difference_at(&c, angles[k]);
        range.least = fminl(range.least, values[k]);
        range.largest = fmaxl(range.largest, values[k]);
    }
    /* Between two of these directions one arc and one corner count, whose difference changes its slope by no more than
     * (distance of corner and centre) times the step; that is less than `room` for the values between. */
    real reach = hull->radius;
    for (size_t i = 0; i < count; i++)
        reach = fmaxl(reach, 2 * hull->radius + hypotl(arcs[i].center_x, arcs[i].center_y));
    for (size_t k = 0; k < total; k++) {
        const real step = angles[k + 1] - angles[k], room = reach * step * step / 8;
        if (fminl(values[k], values[k + 1]) - room < range.least)
            range.least = fminl(range.least, -refine(&c, -1, angles[k], angles[k + 1]));
        if (fmaxl(values[k], values[k + 1]) + room > range.largest)
            range.largest = fmaxl(range.largest, refine(&c, 1, angles[k], angles[k + 1]));
    }
    return range;
}

/* ---------------------------------------------------------------------------- area and perimeter */

/* Green's theorem: arcs, and the lines between them. */
real reference_area(const narc_arc *arcs, size_t count) {
    real twice = 0;
    for (size_t k = 0; k < count; k++) {
        const narc_arc *arc = &arcs[k];
        const point center = {arc->center_x, arc->center_y}, end = arc_end(arc);
        const real r = arc->radius;
        twice += r * r * sweep_of(arc) + cross(center, minus(end, arc_start(arc)));
        twice += cross(end, arc_start(&arcs[(k + 1) % count]));
    }
    return twice / 2;
}

real reference_perimeter(const narc_arc *arcs, size_t count) {
    real sum = 0;
    for (size_t k = 0; k < count; k++)
        sum +=
            (real)arcs[k].radius * sweep_of(&arcs[k]) + distance(arc_end(&arcs[k]), arc_start(&arcs[(k + 1) % count]));
    return sum;
}

/* ---------------------------------------------------------------------------- distances between outlines */

static real segment_distance(point p, point a, point b) {
    const point ab = minus(b, a), ap = minus(p, a);
    const real t = fmaxl(0, fminl(1, dot(ap, ab) / dot(ab, ab)));
    return hypotl(ap.x - t * ab.x, ap.y - t * ab.y);
}

static real outline_distance(const struct reference_hull *hull, point p) {
    real least = INFINITY;
    for (size_t k = 0; k < hull->count; k++)
        least = fminl(least, segment_distance(p, hull->corners[k], hull->corners[(k + 1) % hull->count]));
    return least;
}

real reference_mean_distance(const narc_arc *arcs, size_t count, const struct reference_hull *hull) {
    enum { PIECES = 10000 };
    const real perimeter = reference_perimeter(arcs, count);
    real sum = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *next = &arcs[(i + 1) % count];
        const real length = arc->radius * sweep_of(arc);
        const size_t pieces = (size_t)(PIECES * length / perimeter) + 1;
        for (size_t k = 0; k < pieces; k++) {
            const real angle = arc->start + sweep_of(arc) * ((real)k + 0.5) / (real)pieces;
            sum += length / (real)pieces * outline_distance(hull, arc_point(arc, angle));
        }
        const point a = arc_end(arc), b = arc_start(next);
        const size_t parts = (size_t)(PIECES * distance(a, b) / perimeter) + 1;
        for (size_t k = 0; k < parts; k++) {
            const real t = ((real)k + 0.5) / (real)parts;
            const point p = {a.x + t * (b.x - a.x), a.y + t * (b.y - a.y)};
            sum += distance(a, b) / (real)parts * outline_distance(hull, p);
        }
    }
    return sum / perimeter;
}

size_t reference_count_edges(const narc_arc *arcs, size_t count, double length) {
    size_t edges = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *next = &arcs[(i + 1) % count];
        edges += distance(arc_end(&arcs[i]), arc_start(next)) > length;
    }
    return edges;
}

/* ---------------------------------------------------------------------------- symmetric difference */

/* Where a ray from p leaves a segment's line; -1 if it does not cross the segment. */
static real cross_segment(point p, point u, point a, point b) {
    const point ab = minus(b, a), pa = minus(a, p);
    const real across = cross(u, ab);
    const real s = cross(pa, u) / across, t = cross(pa, ab) / across;
    return s >= -1e-9 && s <= 1 + 1e-9 && t > 0 ? t : -1;
}

static real cross_hull(const struct reference_hull *hull, point p, point u) {
    real furthest = 0;
    for (size_t k = 0; k < hull->count; k++)
        furthest = fmaxl(furthest, cross_segment(p, u, hull->corners[k], hull->corners[(k + 1) % hull->count]));
    return furthest;
}

static real cross_arcs(const narc_arc *arcs, size_t count, point p, point u) {
    real furthest = 0;
    for (size_t i = 0; i < count; i++) {
        const narc_arc *arc = &arcs[i], *next = &arcs[(i + 1) % count];
        const point a = arc_end(arc), b = arc_start(next);
        if (distance(a, b) > 0)
            furthest = fmaxl(furthest, cross_segment(p, u, a, b));
        const point center = {arc->center_x - p.x, arc->center_y - p.y};
        const real off = cross(u, center), square = arc->radius * arc->radius - off * off;
        if (square >= 0) {
            const real t = dot(u, center) + sqrtl(square);
            const real angle = atan2l(t * u.y - center.y, t * u.x - center.x);
            furthest = turn_to(arc->start - 1e-9, angle) <= sweep_of(arc) + 2e-9 ? fmaxl(furthest, t) : furthest;
        }
    }
    return furthest;
}

real reference_difference(const narc_arc *arcs, size_t count, const struct reference_hull *hull, size_t rays) {
    const point mean = mean_of(hull);
    real sum = 0;
    for (size_t k = 0; k < rays; k++) {
        const point u = unit_at(2 * LONG_PI * ((real)k + 0.5) / (real)rays);
        const real a = cross_arcs(arcs, count, mean, u), b = cross_hull(hull, mean, u);
        sum += fabsl(a * a - b * b) / 2 * 2 * LONG_PI / (real)rays;
    }
    return sum;
}

/* ---------------------------------------------------------------------------- smallest circle */

static real radius_around(point center, const struct reference_hull *hull) {
    real radius = 0;
    for (size_t k = 0; k < hull->count; k++)
        radius = fmaxl(radius, distance(center, hull->corners[k]));
    return radius;
}

double reference_smallest_circle(const narc_point *points, size_t count) {
    AUTO(free_at) struct reference_hull hull = reference_wrap(points, count, (narc_point){0, 0});
    real best = INFINITY;
    for (size_t i = 0; i < hull.count; i++) {
        for (size_t j = 0; j < i; j++) {
            const point a = hull.corners[i], b = minus(hull.corners[j], a);
            best = fminl(best, radius_around((point){a.x + b.x / 2, a.y + b.y / 2}, &hull));
            for (size_t k = 0; k < j; k++) {
                const point c = minus(hull.corners[k], a);
                const real twice = 2 * cross(b, c);
                const point center = {(c.y * dot(b, b) - b.y * dot(c, c)) / twice,
                                      (b.x * dot(c, c) - c.x * dot(b, b)) / twice};
                best = fminl(best, radius_around((point){a.x + center.x, a.y + center.y}, &hull));
            }
        }
    }
    return (double)best;
}
