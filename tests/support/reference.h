/* SPDX-License-Identifier: MIT
 *
 * reference.h - what the kernels must answer, in double precision and straight from the definition.
 *
 * For a unit direction n from A towards B the gap is g(n) = -h_A(n) - h_B(-n), h the support function: how far the
 * shapes are apart as seen along n. The separation is the largest gap of all directions. The search knows nothing of
 * pairs of arcs; reference_solve_gap() goes through them, and is compared with the search.
 */
#ifndef NARC_TEST_REFERENCE_H
#define NARC_TEST_REFERENCE_H

#include "narc_shapes.h"

/* A shape as its maker gave it, in double precision, in a place. The matrix scale * [cosine -sine; sine cosine]
 * counts as it stands: where rounding has left cosine^2 + sine^2 a little off 1, it also scales a little. */
struct reference_body {
    const narc_arc *arcs;
    size_t count;
    double x, y;
    double cosine, sine, scale;
};

struct reference_gap {
    double gap;
    double normal_x, normal_y; /* where g is largest */
};

/* The separation, to about 1e-14 of the sizes, and a direction that has it. */
struct reference_gap reference_find_gap(const struct reference_body *a, const struct reference_body *b);

/* The same in a tenth of the time, for millions of pairs: between neighbouring junctions, those of B turned around, g is
 * |u| cos(angle to u) minus two radii, u from one centre to the other. The test `reference` compares it with the
 * search. */
struct reference_gap reference_solve_gap(const struct reference_body *a, const struct reference_body *b);

/* g in the direction of a vector of any length. */
double reference_gap_along(const struct reference_body *a, const struct reference_body *b, double x, double y);

/* Signed distance from a point, relative to the body's position, to the body's outline. */
double reference_point_distance(const struct reference_body *body, double x, double y);

/* The largest |centre| + radius of a body's arcs, scaled: all of it is that near to its position. */
double reference_extent(const struct reference_body *body);

/* Distance between two positions plus both extents: the length that errors are relative to. */
double reference_reach(const struct reference_body *a, const struct reference_body *b);

#endif
