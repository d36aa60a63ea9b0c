/* SPDX-License-Identifier: MIT
 *
 * adjust.c - from any simple polygon to the junctions of an n-arc near it.
 *
 * An n-arc through n junctions exists exactly if its exterior angles are sums of neighbouring half central angles,
 * e[i] = alpha[i-1] + alpha[i], each above 0 and at most pi / 2 (junctions.c). So the alphas are what is fitted to
 * the polygon's angles: convexity, the full turn (the alphas add up to pi) and the condition for even n come with
 * them. Lines that turn by the new angles are then laid through the midpoints of the polygon's sides, and meet in
 * the junctions.
 */
#include <math.h>
#include <string.h>

#include "elementary.h"
#include "error.h"
#include "outline.h"

/* Two sides are apart, and an area is one, if they exceed the rounding of coordinates of this size, relatively. */
#define TOUCHING 1e-12

/* No alpha is smaller than this part of the mean, pi / n; nor so small that an arc as long as the polygon's side
 * would have a radius above ROOMY_RATIO times the size, which leaves room below NARC_MAX_RADIUS_RATIO. */
#define SMALLEST_PART 0.125
#define ROOMY_RATIO   40.0

/* No side is shorter than this part of what it would be around a circle. */
#define SHORTEST_PART 0.02

/* Sides that have to move towards a circle move towards one no smaller than this part of the polygon's size. */
#define THINNEST 1e-3

/* The fit stops when a step moves no alpha by more than this. */
#define SETTLED 1e-13

enum { FIT_STEPS = 4000 };

typedef struct polygon {
    size_t count;
    narc_point point[NARC_MAX_ARCS]; /* counter-clockwise, the mean at the origin, the furthest at distance 1 */
    double length[NARC_MAX_ARCS];    /* of side i, from point i */
    double turn[NARC_MAX_ARCS];      /* at point i, -pi .. pi */
} polygon;

/* ------------------------------------------------------------------------------------------------ reading */

static double cross(narc_point a, narc_point b, narc_point c) {
    return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x);
}

static double point_to_segment(narc_point p, narc_point a, narc_point b) {
    double x = b.x - a.x, y = b.y - a.y, t = ((p.x - a.x) * x + (p.y - a.y) * y) / (x * x + y * y);
    t = fmin(1, fmax(0, t));
    return narc_hypot(a.x + t * x - p.x, a.y + t * y - p.y);
}

static bool segments_touch(narc_point a, narc_point b, narc_point c, narc_point d) {
    if ((cross(a, b, c) > 0) != (cross(a, b, d) > 0) && (cross(c, d, a) > 0) != (cross(c, d, b) > 0))
        return true;
    return point_to_segment(a, c, d) <= TOUCHING || point_to_segment(b, c, d) <= TOUCHING ||
           point_to_segment(c, a, b) <= TOUCHING || point_to_segment(d, a, b) <= TOUCHING;
}

/* Neighbouring sides share a point; they touch elsewhere if one folds back on the other. */
static bool sides_touch(const polygon *p, size_t i, size_t j) {
    size_t n = p->count, after_i = (i + 1) % n, after_j = (j + 1) % n;
    if (after_i == j)
        return point_to_segment(p->point[i], p->point[j], p->point[after_j]) <= TOUCHING ||
               point_to_segment(p->point[after_j], p->point[i], p->point[j]) <= TOUCHING;
    return segments_touch(p->point[i], p->point[after_i], p->point[j], p->point[after_j]);
}

/* Copies, moves and scales the points, and finds the size that they had and where their mean was. */
static narc_status normalise(const narc_point *points, size_t count, polygon *out, narc_circle *out_frame,
                             narc_error *error) {
    double x = 0, y = 0, size = 0;
    for (size_t i = 0; i < count; i++) {
        if (!isfinite(points[i].x) || !isfinite(points[i].y))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, i, isfinite(points[i].x) ? points[i].y : points[i].x,
                             "point %zu: a coordinate is not finite", i);
        x += points[i].x / (double)count;
        y += points[i].y / (double)count;
    }
    for (size_t i = 0; i < count; i++)
        size = fmax(size, narc_hypot(points[i].x - x, points[i].y - y));
    if (size == 0)
        return narc_fail(error, NARC_ERROR_NOT_SIMPLE, 0, 0, "all points are one");
    if (!(size >= NARC_MIN_SIZE && size <= 2 * NARC_MAX_SIZE)) /* the mean may be off the middle */
        return narc_fail(error, NARC_ERROR_SIZE, 0, size, "the polygon's size is %g, not in %g .. %g", size,
                         NARC_MIN_SIZE, NARC_MAX_SIZE);
    out->count = count;
    for (size_t i = 0; i < count; i++)
        out->point[i] = (narc_point){(points[i].x - x) / size, (points[i].y - y) / size};
    *out_frame = (narc_circle){x, y, size};
    return NARC_OK;
}

static narc_status read_polygon(const narc_point *points, size_t count, polygon *out, narc_circle *out_frame,
                                narc_error *error) {
    narc_status status = normalise(points, count, out, out_frame, error);
    if (status != NARC_OK)
        return status;
    for (size_t i = 0; i < count; i++) {
        narc_point from = out->point[i], to = out->point[(i + 1) % count];
        out->length[i] = narc_hypot(to.x - from.x, to.y - from.y);
        if (out->length[i] <= TOUCHING)
            return narc_fail(error, NARC_ERROR_NOT_SIMPLE, i, 0, "point %zu: the next point is the same", i);
    }
    for (size_t i = 0; i < count; i++)
        for (size_t j = i + 1; j < count; j++)
            if (i == 0 && j + 1 == count ? sides_touch(out, j, i) : sides_touch(out, i, j))
                return narc_fail(error, NARC_ERROR_NOT_SIMPLE, i, 0, "sides %zu and %zu cross or touch", i, j);
    double twice_area = 0;
    for (size_t i = 0; i < count; i++)
        twice_area += cross((narc_point){0, 0}, out->point[i], out->point[(i + 1) % count]);
    if (fabs(twice_area) <= TOUCHING)
        return narc_fail(error, NARC_ERROR_NOT_SIMPLE, 0, twice_area / 2, "the polygon encloses no area");
    if (twice_area < 0) { /* clockwise: the same points backwards, point 0 first */
        polygon turned = *out;
        for (size_t i = 0; i < count; i++) {
            out->point[i] = turned.point[(count - i) % count];
            out->length[i] = turned.length[count - 1 - i];
        }
    }
    for (size_t i = 0; i < count; i++) {
        narc_point a = out->point[(i + count - 1) % count], b = out->point[i], c = out->point[(i + 1) % count];
        out->turn[i] = narc_atan2(cross(a, b, c), (b.x - a.x) * (c.x - b.x) + (b.y - a.y) * (c.y - b.y));
    }
    return NARC_OK;
}

/* ------------------------------------------------------------------------------------------------ angles */

/* The nearest alphas within their limits that add up to pi: all move by the same amount, then stop at the limits. The
 * amount is found by halving. */
static void project(const double *wanted, const double *floor, size_t count, double *out_alpha) {
    double low = -4 * NARC_PI, high = 4 * NARC_PI;
    for (size_t i = 0; i < count; i++) {
        low = fmin(low, wanted[i] - NARC_PI);
        high = fmax(high, wanted[i]);
    }
    for (int k = 0; k < 64; k++) {
        double move = (low + high) / 2, sum = 0;
        for (size_t i = 0; i < count; i++) {
            out_alpha[i] = fmin(NARC_PI / 2, fmax(floor[i], wanted[i] - move));
            sum += out_alpha[i];
        }
        if (sum > NARC_PI)
            low = move;
        else
            high = move;
    }
}

/* Minimises the sum of (turn[i] - alpha[i-1] - alpha[i])^2 by projected gradients with momentum. 4 is the largest
 * eigenvalue of the matrix behind it, so 1/4 is a safe step; where it is singular (even n) the start decides, which
 * is even. */
static void fit_alphas(const polygon *p, double *out_alpha) {
    size_t n = p->count;
    double floor[NARC_MAX_ARCS], ahead[NARC_MAX_ARCS], wanted[NARC_MAX_ARCS], before[NARC_MAX_ARCS],
        error[NARC_MAX_ARCS];
    for (size_t i = 0; i < n; i++) {
        floor[i] = fmax(SMALLEST_PART * NARC_PI / (double)n, p->length[i] / (2 * ROOMY_RATIO));
        ahead[i] = before[i] = NARC_PI / (double)n;
    }
    double momentum = 1, moved = INFINITY;
    for (int step = 0; step < FIT_STEPS && moved > SETTLED; step++) {
        for (size_t i = 0; i < n; i++)
            error[i] = p->turn[i] - ahead[(i + n - 1) % n] - ahead[i];
        for (size_t i = 0; i < n; i++)
            wanted[i] = ahead[i] + (error[i] + error[(i + 1) % n]) / 4;
        project(wanted, floor, n, out_alpha);
        double uphill = 0;
        moved = 0;
        for (size_t i = 0; i < n; i++) {
            uphill += (ahead[i] - out_alpha[i]) * (out_alpha[i] - before[i]);
            moved = fmax(moved, fabs(out_alpha[i] - before[i]));
        }
        if (uphill > 0) /* it overshot */
            momentum = 1;
        double next = (1 + sqrt(1 + 4 * momentum * momentum)) / 2;
        for (size_t i = 0; i < n; i++) {
            ahead[i] = out_alpha[i] + (momentum - 1) / next * (out_alpha[i] - before[i]);
            before[i] = out_alpha[i];
        }
        momentum = next;
    }
}

/* ------------------------------------------------------------------------------------------------ lines */

/* The line of each side: its outward normal and its distance from the middle of the outline. */
typedef struct lines {
    double turn[NARC_MAX_ARCS]; /* at the start of side i */
    double normal_x[NARC_MAX_ARCS], normal_y[NARC_MAX_ARCS];
    double distance[NARC_MAX_ARCS], mean_distance;
    narc_point middle;
} lines;

/* The directions follow the angles; the first one makes the mean difference from the polygon's, weighted with the
 * sides' lengths, zero. */
static void lay_lines(const polygon *p, const double *alpha, lines *out) {
    size_t n = p->count;
    double old = 0, new = 0, difference = 0, perimeter = 0;
    out->middle = (narc_point){0, 0};
    for (size_t i = 0; i < n; i++) {
        narc_point a = p->point[i], b = p->point[(i + 1) % n];
        out->turn[i] = alpha[(i + n - 1) % n] + alpha[i];
        if (i) {
            old += p->turn[i];
            new += out->turn[i];
        }
        difference += p->length[i] * (old - new);
        perimeter += p->length[i];
        out->middle.x += p->length[i] * (a.x + b.x) / 2;
        out->middle.y += p->length[i] * (a.y + b.y) / 2;
    }
    out->middle.x /= perimeter;
    out->middle.y /= perimeter;
    double angle = narc_atan2(p->point[0].x - p->point[1].x, p->point[1].y - p->point[0].y) + difference / perimeter;
    double amount = 0;
    out->mean_distance = 0;
    for (size_t i = 0; i < n; i++) {
        narc_point a = p->point[i], b = p->point[(i + 1) % n];
        angle += i ? out->turn[i] : 0;
        narc_find_normal(angle, &out->normal_x[i], &out->normal_y[i]);
        out->distance[i] =
            out->normal_x[i] * ((a.x + b.x) / 2 - out->middle.x) + out->normal_y[i] * ((a.y + b.y) / 2 - out->middle.y);
        out->mean_distance += p->length[i] / perimeter * out->distance[i];
        amount += p->length[i] / perimeter * fabs(out->distance[i]);
    }
    /* The lines of a very crooked polygon may lie, on average, on the wrong side of its middle. */
    out->mean_distance = fmax(out->mean_distance, fmax(amount / 2, THINNEST));
}

/* The length of side i is linear in the distances of its line and its two neighbours'. */
static double find_length(const lines *l, size_t count, size_t i, const double *distance) {
    size_t before = (i + count - 1) % count, after = (i + 1) % count;
    double c, s, next_c, next_s;
    narc_find_cosine(l->turn[i], &c, &s);
    narc_find_cosine(l->turn[after], &next_c, &next_s);
    return (distance[before] - distance[i] * c) / s + (distance[after] - distance[i] * next_c) / next_s;
}

/* Moves the lines towards tangents of a circle, all at the mean distance, by at least the part `least` of the way
 * and as far as it takes to make every side long enough. */
static void lengthen_sides(lines *l, size_t count, double least) {
    double circle[NARC_MAX_ARCS], part = least;
    for (size_t i = 0; i < count; i++)
        circle[i] = l->mean_distance;
    for (size_t i = 0; i < count; i++) {
        double now = find_length(l, count, i, l->distance), round = find_length(l, count, i, circle);
        if (now < SHORTEST_PART * round)
            part = fmax(part, (SHORTEST_PART * round - now) / (round - now));
    }
    for (size_t i = 0; i < count; i++)
        l->distance[i] += part * (l->mean_distance - l->distance[i]);
}

static void intersect(const lines *l, size_t count, narc_circle frame, narc_point *out_points) {
    for (size_t i = 0; i < count; i++) {
        size_t before = (i + count - 1) % count;
        double a = l->distance[before], b = l->distance[i], s = narc_sin(l->turn[i]);
        double x = (a * l->normal_y[i] - b * l->normal_y[before]) / s;
        double y = (b * l->normal_x[before] - a * l->normal_x[i]) / s;
        out_points[i] =
            (narc_point){frame.x + frame.radius * (l->middle.x + x), frame.y + frame.radius * (l->middle.y + y)};
    }
}

/* ------------------------------------------------------------------------------------------------ public */

narc_status narc_adjust_polygon(const narc_point *points, size_t count, narc_point *out_points, narc_error *error) {
    polygon p;
    narc_circle frame = {0, 0, 1};
    double fitted[NARC_MAX_ARCS], alpha[NARC_MAX_ARCS];
    if (!points || !out_points)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", points ? "out_points" : "polygon");
    if (count < 3 || count > NARC_MAX_ARCS)
        return narc_fail(error, NARC_ERROR_COUNT, 0, (double)count, "there are %zu points, not 3 to %d", count,
                         NARC_MAX_ARCS);
    narc_status status = read_polygon(points, count, &p, &frame, error);
    if (status != NARC_OK)
        return status;
    fit_alphas(&p, fitted);
    /* Almost always the first attempt serves. Where its radii are too unequal, others are closer and closer to the
     * regular polygon, which the last one is. */
    static const double parts[] = {0, 0.0625, 0.125, 0.25, 0.5, 1};
    enum { ATTEMPTS = sizeof parts / sizeof parts[0] };
    for (size_t k = 0; k < ATTEMPTS; k++) {
        narc_arc arcs[NARC_MAX_ARCS];
        narc_point junctions[NARC_MAX_ARCS];
        size_t arc_count;
        lines l;
        for (size_t i = 0; i < count; i++)
            alpha[i] = fitted[i] + parts[k] * (NARC_PI / (double)count - fitted[i]);
        lay_lines(&p, alpha, &l);
        lengthen_sides(&l, count, parts[k]);
        intersect(&l, count, frame, junctions);
        status = narc_build_points(junctions, count, 0, arcs, &arc_count, k + 1 == ATTEMPTS ? error : NULL);
        if (status == NARC_OK) {
            memcpy(out_points, junctions, count * sizeof *junctions);
            return NARC_OK;
        }
    }
    return status;
}

narc_status narc_build_ring(const narc_point *points, size_t count, narc_arc *out_arcs, size_t *out_count,
                            narc_error *error) {
    narc_point junctions[NARC_MAX_ARCS];
    if (!out_arcs || !out_count)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "an output is NULL");
    const narc_status status = narc_adjust_polygon(points, count, junctions, error);
    return status == NARC_OK ? narc_build_points(junctions, count, 0, out_arcs, out_count, error) : status;
}
