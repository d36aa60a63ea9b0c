/* SPDX-License-Identifier: MIT
 *
 * biarc.h - cubics and the arcs that follow them. Internal.
 *
 * All lengths here are those of a frame in which the curve is about 1 large and near the origin. Curvature and turn are
 * positive counter-clockwise. A straight line is an arc of curvature 0: every formula holds for it as it stands.
 */
#ifndef NARC_BIARC_H
#define NARC_BIARC_H

#include <stdbool.h>
#include <stddef.h>

#include "narc_fit.h"
#include "outline/vector.h"

/* A cubic's control points. */
typedef struct narc_cubic {
    narc_point c[4];
} narc_cubic;

/* The curve's part from parameter t0 to t1; its end points are the same bits as those of its neighbours. */
narc_cubic narc_cut_cubic(const narc_cubic *curve, double t0, double t1);

/* The curve the other way round. */
narc_cubic narc_reverse_cubic(const narc_cubic *curve);

/* First, second and third derivative. */
typedef struct narc_derivatives {
    narc_point first, second, third;
} narc_derivatives;
narc_derivatives narc_derive_cubic(const narc_cubic *curve, double t);

/* For the circle through `origin` with the left normal `normal` (a unit vector) and curvature k there, and P
 * measured from `origin`, the polynomial |P|^2 k / 2 - P.normal along the curve, in Bernstein form of degree 6: it
 * is 0 on the circle. */
void narc_expand_circle(const narc_cubic *curve, narc_point origin, narc_point normal, double curvature,
                        double out_coefficients[7]);

/* A place inside the curve where it reverses on the spot, or very nearly, or stands still, and the tangents with which
 * it arrives and leaves. */
typedef struct narc_cusp {
    double t;
    narc_point arriving, leaving;
} narc_cusp;

/* The cusps of a curve in order; their number, at most 3, is returned. `out_ends` are the tangents at its ends. A cusp
 * within `rounding` of an end is left out, and the end gets its tangent; otherwise the tangent points to the nearest
 * control point that is further away than that. Cusps as near as that to each other are one. */
size_t narc_find_cusps(const narc_cubic *curve, double rounding, narc_cusp out_cusps[3], narc_point out_ends[2]);

/* One arc. */
typedef struct narc_spline_arc {
    narc_point start, end;
    narc_point start_tangent, end_tangent; /* unit vectors */
    double curvature, turn;
} narc_spline_arc;

/* A point with a tangent. */
typedef struct narc_post {
    narc_point point, tangent;
} narc_post;

/* The two arcs from one post to another that meet with a common tangent, or the one arc if it does for both. The family
 * of such pairs has one parameter: `share`, between 0 and 1, is near the first arc's share of the length. Returns the
 * number of arcs: 0 if no pair of arcs of less than half a turn each joins the posts. */
size_t narc_join_posts(narc_post start, narc_post end, double share, narc_spline_arc out_arcs[2]);

/* The `share` for which the arcs meet on the curve, whose ends are the posts' points; 0.5 if there is none. */
double narc_find_share(const narc_cubic *curve, narc_post start, narc_post end);

/* An upper bound of the distance between a curve and one or two arcs from its start to its end, both ways, each point
 * of one from the other: right to about half a per cent, or to `rounding` if that is more. It is infinity if it is
 * above `limit`; below a finite `limit` it may be anything up to that. */
double narc_bound_distance(const narc_cubic *curve, const narc_spline_arc *arcs, size_t count, double rounding,
                           double limit);

/* What comes of curves and chains of lines: arcs one after the other in the form of the interface, from malloc(), and a
 * bound of their distance. */
typedef struct narc_arc_list {
    narc_curve_arc *arcs;
    size_t count, capacity;
    double distance;
} narc_arc_list;

narc_curve_arc narc_describe_arc(const narc_spline_arc *arc);

/* The same arcs the other way round. */
void narc_reverse_arcs(narc_curve_arc *arcs, size_t count);

/* Adds the arcs for a curve. `rounding` bounds what rounding does to points of the curve; the arcs' own is not in it.
 * NARC_ERROR_MEMORY, NARC_ERROR_NO_SOLUTION. On error the list may have some of the arcs. */
narc_status narc_fit_spline(const narc_cubic *curve, double tolerance, double rounding, narc_arc_list *list,
                            narc_error *error);

/* Lines from each of `points[0 .. count-1]` to the next; if `closed` the last is the first. No two successive ones are
 * the same. `slack` is how far the points may be from what they were traced in. */
typedef struct narc_polyline {
    const narc_point *points;
    size_t count;
    bool closed;
    double slack;
    const bool *joints; /* NULL, or which points are ends of what was drawn */
} narc_polyline;

/* Each adds the arcs for a curve, or for lines: arcs and lines from the first point to the last, which join with a common
 * tangent but at corners, and no point of either further than `tolerance` from the other. Errors are those of
 * narc_fit_bezier(); on error the list is as before. The check is of all but memory and solutions. */
narc_status narc_check_curve(const narc_point *controls, size_t degree, double tolerance, narc_error *error);
narc_status narc_add_curve(const narc_point *controls, size_t degree, double tolerance, narc_arc_list *to,
                           narc_error *error);
narc_status narc_add_polyline(const narc_polyline *line, double tolerance, narc_arc_list *to, narc_error *error);

/* Adds the fewest arcs and lines that are found for lines, none further than `tolerance` from the other; where they meet the
 * tangent may turn. NARC_ERROR_MEMORY, NARC_ERROR_NO_SOLUTION. */
narc_status narc_add_fewest(const narc_polyline *line, double tolerance, narc_arc_list *to, narc_error *error);

#endif
