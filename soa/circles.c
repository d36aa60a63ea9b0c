/* SPDX-License-Identifier: MIT
 *
 * circles.c - the smallest circle around an outline and a largest one inside it, by cutting planes.
 *
 * Both are convex problems with infinitely many constraints, one for each point or each normal of the outline. Each
 * is solved for two or three constraints at a time, exactly; the outline's closed forms then give the constraint
 * that this solution violates most, which joins. What the few constraints give is a bound from one side and what the
 * outline gives is one from the other: the search ends when the two agree, and every result is a true bound even if
 * it has to end sooner.
 */
#include "outline.h"

#include <math.h>

/* When the two bounds agree, relative to the radius: well below the promised 1e-9, and mostly above the roundings that
 * large radii and nearly equal constraints bring with them. */
#define CLOSE_ENOUGH 1e-11

/* Far more than it takes; most shapes need 10 to 20. */
enum { MAX_STEPS = 100 };

/* ------------------------------------------------------------------------------------------------ around */

double narc_find_farthest(const narc_outline *o, double x, double y, narc_point *out_point) {
    double best = -1;
    *out_point = narc_find_start(o, 0);
    for (size_t i = 0; i < o->count; i++) {
        double dx = o->center_x[i] - x, dy = o->center_y[i] - y, radius = o->radius[i];
        narc_point ends[2] = {narc_find_start(o, i), narc_find_end(o, i)};
        for (int k = 0; k < (radius > 0 ? 2 : 1); k++) {
            double ex = ends[k].x - x, ey = ends[k].y - y, square = ex * ex + ey * ey;
            if (square > best) {
                best = square;
                *out_point = ends[k];
            }
        }
        if (radius > 0 && narc_in_sector(o, i, dx, dy)) {
            double distance = sqrt(dx * dx + dy * dy), extent = distance + radius;
            if (distance > 0 && extent * extent > best) {
                best = extent * extent;
                *out_point =
                    (narc_point){o->center_x[i] + dx / distance * radius, o->center_y[i] + dy / distance * radius};
            }
        }
    }
    return sqrt(best);
}

static double squared_distance(narc_point a, narc_point b) {
    return (a.x - b.x) * (a.x - b.x) + (a.y - b.y) * (a.y - b.y);
}

/* The centre of the circle through three points; false if they lie on a line. */
static bool find_circumcenter(narc_point a, narc_point b, narc_point c, narc_point *out_center) {
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, cross = bx * cy - by * cx;
    if (cross == 0)
        return false;
    double bb = bx * bx + by * by, cc = cx * cx + cy * cy;
    *out_center = (narc_point){a.x + (bb * cy - cc * by) / (2 * cross), a.y + (cc * bx - bb * cx) / (2 * cross)};
    return isfinite(out_center->x) && isfinite(out_center->y);
}

typedef struct hull_circle {
    narc_point point[4]; /* those that hold the circle, at most 3, and room for a new one */
    size_t count;
    narc_point center;
    double square; /* of the radius */
} hull_circle;

/* Takes the circle on `keep` of the points if it is the smallest so far that reaches all of them. */
static void try_circle(const hull_circle *old, narc_point center, const size_t *keep, size_t count, hull_circle *best) {
    double square = 0;
    for (size_t i = 0; i < old->count; i++)
        square = fmax(square, squared_distance(center, old->point[i]));
    if (square >= best->square)
        return;
    best->square = square;
    best->center = center;
    best->count = count;
    for (size_t i = 0; i < count; i++)
        best->point[i] = old->point[keep[i]];
}

/* The smallest circle around the old points and a new one outside their circle, which must therefore be one of the
 * two or three points on it. */
static void add_point(hull_circle *circle, narc_point point) {
    size_t last = circle->count;
    hull_circle best = {.square = INFINITY};
    circle->point[circle->count++] = point;
    for (size_t i = 0; i < last; i++) {
        narc_point a = circle->point[i];
        narc_point middle = {(a.x + point.x) / 2, (a.y + point.y) / 2}, center;
        try_circle(circle, middle, (size_t[]){i, last}, 2, &best);
        for (size_t j = 0; j < i; j++)
            if (find_circumcenter(a, circle->point[j], point, &center))
                try_circle(circle, center, (size_t[]){i, j, last}, 3, &best);
    }
    *circle = best;
}

void narc_bound_outline(const narc_outline *outline, narc_circle *out_circle) {
    hull_circle circle = {.count = 1};
    circle.point[0] = circle.center = narc_find_start(outline, 0);
    *out_circle = (narc_circle){0, 0, INFINITY};
    double bound = 0;
    for (int step = 0; step < MAX_STEPS; step++) {
        narc_point farthest;
        double extent = narc_find_farthest(outline, circle.center.x, circle.center.y, &farthest);
        if (extent < out_circle->radius)
            *out_circle = (narc_circle){circle.center.x, circle.center.y, extent};
        /* The bound from below cannot shrink, unless points are so nearly equal that it is rounding that decides. */
        double radius = sqrt(circle.square);
        if (extent <= radius * (1 + CLOSE_ENOUGH) || radius < bound * (1 - CLOSE_ENOUGH))
            return;
        bound = fmax(bound, radius);
        add_point(&circle, farthest);
    }
}

/* ------------------------------------------------------------------------------------------------ inside */

/* A half-plane normal.p <= height. */
typedef struct half_plane {
    double x, y, height;
} half_plane;

/* The largest circle in three half-planes: false if their normals leave it unbounded. */
static bool fit_circle(const half_plane plane[3], narc_circle *out_circle) {
    half_plane a = plane[0], b = plane[1], c = plane[2];
    /* The normals, each times its weight, add up to zero. */
    double wa = b.x * c.y - b.y * c.x, wb = c.x * a.y - c.y * a.x, wc = a.x * b.y - a.y * b.x, sum = wa + wb + wc;
    if (sum == 0 || wa / sum < 0 || wb / sum < 0 || wc / sum < 0)
        return false;
    double hb = b.height - a.height, hc = c.height - a.height;
    double bx = b.x - a.x, by = b.y - a.y, cx = c.x - a.x, cy = c.y - a.y, cross = bx * cy - by * cx;
    if (cross == 0)
        return false;
    double x = (hb * cy - hc * by) / cross, y = (hc * bx - hb * cx) / cross;
    *out_circle = (narc_circle){x, y, (wa * a.height + wb * b.height + wc * c.height) / sum};
    return isfinite(x) && isfinite(y);
}

void narc_inscribe_outline(const narc_outline *outline, narc_circle *out_circle) {
    half_plane plane[3] = {{1, 0, 0}, {-0.5, sqrt(0.75), 0}, {-0.5, -sqrt(0.75), 0}};
    narc_circle circle;
    for (int k = 0; k < 3; k++)
        plane[k].height = narc_find_height(outline, plane[k].x, plane[k].y);
    *out_circle = (narc_circle){0, 0, 0};
    if (narc_is_segment(outline)) { /* nothing but rounding fits into it */
        out_circle->x = (outline->center_x[0] + outline->center_x[1]) / 2;
        out_circle->y = (outline->center_y[0] + outline->center_y[1]) / 2;
        return;
    }
    if (!fit_circle(plane, &circle))
        return;
    double bound = circle.radius;
    for (int step = 0; step < MAX_STEPS; step++) {
        narc_point normal;
        double room = -narc_find_point_separation(outline, circle.x, circle.y, &normal);
        if (room > out_circle->radius)
            *out_circle = (narc_circle){circle.x, circle.y, room};
        /* The bound from above cannot grow, unless constraints are so nearly equal that it is rounding that decides. */
        if (room >= circle.radius * (1 - CLOSE_ENOUGH) || circle.radius > bound * (1 + CLOSE_ENOUGH))
            return;
        bound = fmin(bound, circle.radius);
        /* The new half-plane replaces one of the three: the one that leaves the smallest circle. */
        half_plane cut = {normal.x, normal.y, circle.x * normal.x + circle.y * normal.y + room};
        int leaving = -1;
        for (int k = 0; k < 3; k++) {
            half_plane trial[3] = {plane[0], plane[1], plane[2]};
            narc_circle fit;
            trial[k] = cut;
            if (fit_circle(trial, &fit) && (leaving < 0 || fit.radius < circle.radius)) {
                circle = fit;
                leaving = k;
            }
        }
        if (leaving < 0)
            return;
        plane[leaving] = cut;
    }
}

/* ------------------------------------------------------------------------------------------------ public */

static bool find_circle(const narc_arc *arcs, size_t count, void (*find)(const narc_outline *, narc_circle *),
                        narc_circle *out_circle) {
    narc_outline outline;
    if (!arcs || !out_circle || count == 0 || count > NARC_MAX_ARCS)
        return false;
    narc_read_outline(arcs, count, &outline);
    find(&outline, out_circle);
    out_circle->x += outline.origin_x;
    out_circle->y += outline.origin_y;
    return true;
}

bool narc_compute_bounding_circle(const narc_arc *arcs, size_t count, narc_circle *out_circle) {
    return find_circle(arcs, count, narc_bound_outline, out_circle);
}

bool narc_compute_inscribed_circle(const narc_arc *arcs, size_t count, narc_circle *out_circle) {
    return find_circle(arcs, count, narc_inscribe_outline, out_circle);
}
