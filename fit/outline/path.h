/* SPDX-License-Identifier: MIT
 *
 * path.h - what a path is inside. Internal.
 */
#ifndef NARC_PATH_H
#define NARC_PATH_H

#include "narc_fit.h"

/* The moves of the pen in their order. Move k has degree 0 (a contour begins), 1 (line), 2 or 3 (Bezier curves), and
 * max(1, degree) points: the control points, then where the pen is afterwards. A curve's first control point thus
 * stands right before its own: the last point of the move before. The first move is of degree 0. An arc of a circle is
 * coded as NARC_ARC_MOVE + 2, and its middle point is one of the arc.
 *
 * A contour that has only its first move is not drawn: nothing comes of it.
 *
 * Contours that were traced in an image may be up to `slack` from what they stand for, and it from them. */
#define NARC_ARC_MOVE 16u

struct narc_path {
    narc_point *points;
    unsigned char *degrees;
    size_t point_count, point_capacity;
    size_t move_count, move_capacity;
    double slack;
};

/* The points that a move of this degree has. */
static inline size_t narc_count_move_points(unsigned degree) { return degree ? degree : 1; }

/* A drawn move: degree 1 to 3, controls[0 .. degree]. Of an arc controls[1] is a point of it. */
typedef struct narc_drawn_move {
    const narc_point *controls;
    unsigned degree;
    size_t move, point; /* what comes next */
    size_t contour;     /* number of drawn contours before this one's */
    bool begins;        /* the first of its contour */
    bool is_arc;
} narc_drawn_move;

/* The next drawn move; `move` is all 0 before the first. False at the end. */
bool narc_next_drawn(const narc_path *path, narc_drawn_move *move);

/* An arc: its piece, a line if its points are on one; and the point at 0 <= t <= 1 of an arc or line. */
narc_curve_arc narc_find_arc(const narc_drawn_move *move);
narc_point narc_find_arc_point(const narc_curve_arc *arc, double t);

/* A length of a path to return to: a reader marks the path first, and rewinds it on an error. */
typedef struct narc_path_mark {
    size_t point_count, move_count;
} narc_path_mark;

narc_path_mark narc_mark_path(const narc_path *path);
void narc_rewind_path(narc_path *path, narc_path_mark mark);

/* Of a flattened path: the number of the line or curve in its contour, from 0, whose chord begins `chord` points behind
 * the contour's first one. `contour` is that of the flattened ones. */
size_t narc_find_drawn_line(const narc_path *path, const narc_contours *contours, size_t contour, size_t chord);

/* Is anything drawn since the mark: a line or curve? */
bool narc_is_drawn_since(const narc_path *path, narc_path_mark mark);

/* Room for `count` items of `size` bytes: `items`, moved if need be, or NULL (then `items` is as before). It grows by
 * half, so that adding items one by one takes time in proportion to their number. */
void *narc_grow(void *items, size_t *capacity, size_t count, size_t size);

#endif
