/* SPDX-License-Identifier: MIT
 *
 * svg_pen.h - draws in the coordinates of an SVG element, elliptical arcs too, and the grammar of path data. Internal.
 */
#ifndef NARC_SVG_PEN_H
#define NARC_SVG_PEN_H

#include "path.h"
#include "svg_transform.h"

typedef struct narc_svg_pen {
    narc_path *path;
    narc_affine map;      /* from the element's coordinates to the path's */
    narc_point start, at; /* where the contour starts and the pen is, in the element's coordinates */
    bool down;            /* has the path begun this contour? A move that nothing follows is not drawn */
    bool lines, dots;     /* are contours seen that have no area, or not even a length? */
    narc_path_mark mark;  /* the path before this contour */
    size_t budget;        /* lines and curves it may yet draw: what is used again and again comes to an end */
} narc_svg_pen;

/* A move, or the end of a contour, takes back the contour before it if that is not seen: on one line or at one point,
 * and not stroked. Drawing programs leave such specks behind, often far from everything else. Errors:
 * NARC_ERROR_NOT_FINITE, NARC_ERROR_SIZE (coordinates, or the budget), NARC_ERROR_MEMORY. A fault has no `at`. */
void narc_pen_move(narc_svg_pen *pen, narc_point to);
void narc_pen_close(narc_svg_pen *pen);
narc_status narc_pen_line(narc_svg_pen *pen, narc_point to, narc_svg_fault *fault);
narc_status narc_pen_quadratic(narc_svg_pen *pen, narc_point control, narc_point to, narc_svg_fault *fault);
narc_status narc_pen_cubic(narc_svg_pen *pen, const narc_point controls[2], narc_point to, narc_svg_fault *fault);

/* An ellipse without its place: its half axes, the first turned by `tilt` from the x axis towards the y axis. */
typedef struct narc_ellipse {
    double radius_x, radius_y;
    double tilt; /* radians */
} narc_ellipse;

/* From where the pen is, which is the ellipse's point at angle `from`, by the angle `turn` (in the frame where the
 * ellipse is the unit circle), to the point `to`. In pieces of at most 30 degrees: cubics that share the circle's ends
 * and tangents and touch it in the middle. Between, they are outside the circle by at most 2/27 sin(a/4)^6 / cos(a/4)^2
 * of the radius for a piece of angle a, which is 3.8e-7; any affine map makes that at most 3.8e-7 of the longer half
 * axis of the ellipse it becomes. */
narc_status narc_pen_turn(narc_svg_pen *pen, const narc_ellipse *ellipse, double from, double turn, narc_point to,
                          narc_svg_fault *fault);

/* The arc command of path data: to a point, on an ellipse of these radii (`tilt` in degrees), over the large or small
 * arc, with growing or falling angle. A radius of 0: a line. Radii too small to reach: enlarged until they do. */
typedef struct narc_svg_arc {
    double radius_x, radius_y, tilt;
    bool large, sweep;
} narc_svg_arc;
narc_status narc_pen_arc(narc_svg_pen *pen, const narc_svg_arc *arc, narc_point to, narc_svg_fault *fault);

/* Draws path data, the value of the attribute `d`. */
narc_status narc_draw_svg_path(const char *text, narc_svg_pen *pen, narc_svg_fault *fault);

#endif
