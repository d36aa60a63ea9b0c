/* SPDX-License-Identifier: MIT
 *
 * draw_fit.h - an outline and the shape fitted to it, on a page.
 */
#ifndef NARC_TOOL_DRAW_FIT_H
#define NARC_TOOL_DRAW_FIT_H

#include "canvas.h"
#include "narc_fit.h"

/* Arcs have the first two colours by turns. Of an odd number of arcs the last has the third, so that no neighbours look
 * alike. */
extern const color ARC_TONES[3], EDGE_TONE;

/* On the page. */
typedef struct fit_look {
    double line, dot; /* a line's width, the radius of a dot at a junction */
    double shortest;  /* edges that are not longer are not drawn, arcs are corners */
} fit_look;

/* The smallest box around both. Around nothing yet: */
extern const narc_aabb EMPTY_BOX;
narc_aabb join_boxes(narc_aabb a, narc_aabb b);
double box_size(narc_aabb box); /* its larger side; of an empty one below 0 */

/* The box of a fitted shape, and of points, in the outline's coordinates. */
narc_aabb bound_fit(const narc_fit_result *fit);
narc_aabb bound_points(const narc_point *points, size_t count);

/* The place of a box in the middle of a rectangle on the page, as large as fits. */
placement place_box(narc_aabb box, double left, double top, double width, double height);

/* Adds a closed polygon, or all contours of an outline, to the path. */
void trace_points(canvas *page, const placement *where, const narc_point *points, size_t count);
void trace_contours(canvas *page, const placement *where, const narc_contours *contours);

/* Where pieces meet with a common tangent: a ring. A corner, an arc of no length to be seen: a dot. */
void draw_junction(canvas *page, narc_point center, double radius);
void draw_corner(canvas *page, narc_point center, double radius);

bool is_corner(const placement *where, const narc_arc *arc, const fit_look *look);

/* Fills the shape over its outline, whose coordinates are placed. */
void fill_fit(canvas *page, const placement *outline, const narc_fit_result *fit, color fill);

/* The shape over its outline, whose coordinates are placed: arcs and edges in their colours, then their junctions and
 * corners. */
void draw_fit(canvas *page, const placement *outline, const narc_fit_result *fit, const fit_look *look);

/* The same for chains of arcs and lines. */
void draw_chains(canvas *page, const placement *outline, const narc_arc_chains *chains, const fit_look *look);

#endif
