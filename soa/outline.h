/* SPDX-License-Identifier: MIT
 *
 * outline.h - a list of arcs made ready for geometry in double precision: normals instead of angles. Internal.
 */
#ifndef NARC_OUTLINE_H
#define NARC_OUTLINE_H

#include "narc_shapes.h"

#define NARC_PI 3.14159265358979323846

/* Arc i covers the normals i to i + 1. A full circle is read as two half circles, so no sweep is above pi.
 * Coordinates are relative to a point on the outline, so that a shape far from its origin loses nothing to rounding. */
typedef struct narc_outline {
    size_t count;              /* 2 .. NARC_MAX_ARCS */
    double origin_x, origin_y; /* what was subtracted from the centres */
    double center_x[NARC_MAX_ARCS], center_y[NARC_MAX_ARCS];
    double radius[NARC_MAX_ARCS];
    double sweep[NARC_MAX_ARCS];
    double normal_x[NARC_MAX_ARCS + 1], normal_y[NARC_MAX_ARCS + 1]; /* the last is the first again */
} narc_outline;

/* Cosine and sine of an angle; a multiple of pi/2, as exactly as a double can be one, gives exact zeros and ones. */
void narc_find_normal(double angle, double *out_x, double *out_y);

/* An angle less whole turns, in -pi .. pi. */
double narc_wrap_angle(double angle);

/* What an arc turns by, as its angles say; `end` below `start` means through +-pi. */
double narc_find_sweep(const narc_arc *arc);

/* Reads arcs whose count, angles and joins were checked. Where two normals that should be one differ, their mean serves
 * both arcs; an arc of half a turn gets two exactly opposite normals. */
void narc_read_outline(const narc_arc *arcs, size_t count, narc_outline *out_outline);

/* Are all coordinates finite? */
narc_status narc_check_points(const narc_point *points, size_t count, narc_error *error);

/* Is an outline convex, of whose points these are the turns, once round and counter-clockwise? */
narc_status narc_check_turns(const double *turns, size_t count, narc_error *error);

/* narc_validate_arcs() for those who need the outline and the bounding circle (absolute coordinates) next. */
narc_status narc_check_arcs(const narc_arc *arcs, size_t count, narc_outline *out_outline, narc_circle *out_bound,
                            narc_error *error);

/* Do edges run forwards and have their normals, but for this distance? */
narc_status narc_check_edges(const narc_outline *outline, double tolerance, narc_error *error);

/* Where arc i starts (at normal i) and ends (at normal i + 1). */
narc_point narc_find_start(const narc_outline *outline, size_t arc);
narc_point narc_find_end(const narc_outline *outline, size_t arc);

/* Does the vector point into the closed sector of arc i? */
bool narc_in_sector(const narc_outline *outline, size_t arc, double x, double y);

/* The support function for a unit vector. */
double narc_find_height(const narc_outline *outline, double x, double y);

/* The largest of p.n - h(n) over all unit n: the signed distance of the point p to the outline. `out_normal` may be
 * NULL. */
double narc_find_point_separation(const narc_outline *outline, double x, double y, narc_point *out_normal);

/* Two points and what lies between them. */
static inline bool narc_is_segment(const narc_outline *outline) {
    return outline->count == 2 && outline->radius[0] == 0 && outline->radius[1] == 0;
}

/* The point of the outline furthest from (x, y), and its distance. */
double narc_find_farthest(const narc_outline *outline, double x, double y, narc_point *out_point);

/* Integrals over a region: 1, x, y and x^2 + y^2. */
typedef struct narc_moments {
    double area, x, y, square;
} narc_moments;

/* Adds those of the triangle from the origin to a and b, negative if it is clockwise. */
void narc_add_triangle(narc_moments *sum, narc_point a, narc_point b);

/* Adds those of the region between an arc and its chord: centre (ax, ay), radius r, from the normal (x, y) on. */
void narc_add_segment(narc_moments *sum, double ax, double ay, double r, double x, double y, double sweep);

/* The circles of narc_shapes.h, for an outline, in the outline's coordinates. */
void narc_bound_outline(const narc_outline *outline, narc_circle *out_circle);
void narc_inscribe_outline(const narc_outline *outline, narc_circle *out_circle);

#endif
