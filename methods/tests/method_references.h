/* SPDX-License-Identifier: MIT
 *
 * method_references.h - the published tests and the filters, again, in double precision and the plainest way.
 */
#ifndef NARC_TEST_METHOD_REFERENCES_H
#define NARC_TEST_METHOD_REFERENCES_H

#include "method_support.h"

/* ----------------------------------------------------------------------------------------------- first pair of arcs */

/* A body as the paper's Algorithm 2 wants it, in world axes, relative to A's position. A circle is two half circles. */
struct first_body {
    size_t count;
    double x[NARC_MAX_ARCS], y[NARC_MAX_ARCS], radius[NARC_MAX_ARCS];
    double start_x[NARC_MAX_ARCS + 1], start_y[NARC_MAX_ARCS + 1]; /* arc i ends where i + 1 starts */
    double centroid_x, centroid_y;
    bool circle;
};

struct first_body make_first_body(const struct reference_body *body, const struct reference_body *origin);

/* What the signs of the test for one pair of arcs say, each of which is sure only outside its rounding. */
enum sureness { FAILS, IN_DOUBT, PASSES };
enum sureness test_arcs(const struct first_body *a, const struct first_body *b, double reach, size_t i, size_t j);

/* ------------------------------------------------------------------------------------------------ polygons */

/* The largest gap along the normals of the edges of both. Of polygons only. */
double polygon_gap(const struct reference_body *a, const struct reference_body *b);

/* ------------------------------------------------------------------------------------------------ boxes */

/* A box in a shape's axes: its middle, half sides, and the direction of the first one. */
struct plain_box {
    double x, y, half_x, half_y, axis_x, axis_y;
};

/* The smallest boxes along a junction's normal: all whose area is that of the smallest but for rounding in double
 * precision, NARC_MAX_ARCS at most. */
struct smallest_boxes {
    struct plain_box box[NARC_MAX_ARCS];
    size_t count;
};

struct smallest_boxes find_boxes(const struct shape *shape);

/* The same box as a body lies, relative to another body's position. */
struct plain_box place_box(const struct plain_box *box, const struct reference_body *body,
                           const struct reference_body *origin);

/* How far two boxes are apart along the sides of both, or along the world's axes: the largest of these gaps. */
double box_gap(const struct plain_box *a, const struct plain_box *b);
double axis_gap(const struct plain_box *a, const struct plain_box *b);

/* How far the smallest circles around two bodies are apart. */
double circle_gap(const struct reference_body *a, const struct reference_body *b);

#endif
