/* SPDX-License-Identifier: MIT
 *
 * ground_reference.h - where a body touches ground, by search: the signed distance of the ground, from every piece, and
 * its local minima over the body.
 *
 * The ground is a chain as its caller gives it, with the solid on its left. All lengths are in the chain's coordinates.
 * Nothing here knows of pairs of features.
 */
#ifndef NARC_TEST_GROUND_REFERENCE_H
#define NARC_TEST_GROUND_REFERENCE_H

#include "reference.h"
#include "turtle.h"

/* A perpendicular from a point to a piece: how long (negative from the solid's side), to where, the outward normal
 * there, which convex stretch of the chain between concave arcs it is, or GROUND_CONCAVE, the smallest length or radius
 * of the piece and of those beside it, and how thick the solid is behind that stretch. */
struct ground_foot {
    double distance;
    narc_point at;
    double normal_x, normal_y;
    size_t run;
    double grain, thickness;
};

#define GROUND_CONCAVE ((size_t)-1)

/* The point of an arc at a normal. */
narc_point chain_point(const narc_arc *arc, double angle);

struct ground; /* a chain, piece by piece */
struct ground *make_ground(const struct chain *chain);
void destroy_ground(struct ground *ground);
RELEASE_AT(destroy_ground)

/* The nearest of all feet, which is the signed distance of the ground. Where an open end is nearer than all feet there
 * is no such distance: +INFINITY. */
struct ground_foot ground_distance(struct ground *ground, narc_point point);

/* How far a point is from the outline. */
double ground_outline_distance(const struct ground *ground, narc_point point);

/* Where a ray of any length along a vector of length 1 first goes from the air into the ground, INFINITY if nowhere, and the
 * normal there. */
struct ground_crossing {
    double along;
    narc_point normal;
};
struct ground_crossing ground_cross(const struct ground *ground, narc_point from, narc_point along);

/* How far a body is from the ground's outline: in closed form, of each two pieces; 0 if they meet, or if all of the outline
 * is in the body. Is it all in the air? Of an open chain it is not if it comes near the normals at the ends, on the
 * solid's side: nothing is said of what is beyond them. */
struct ground_clearance {
    double distance;
    bool in_air;
};
struct ground_clearance ground_find_clearance(struct ground *ground, const struct reference_body *body);

/* All feet of a point, nearest first, at most `capacity`. */
size_t ground_feet(const struct ground *ground, narc_point point, struct ground_foot *out, size_t capacity);

/* A local minimum of the signed distance over a body.
 *   at, along   the point of the body, and its place on the outline
 *   foot        its nearest foot
 *   depth       how much the distance rises before it falls below this minimum, on the way along the outline on either
 *               side where it rises less; INFINITY if it never does
 *   doubtful    an open end is as near, or, below the ground, another piece: there the distance has no gradient */
struct ground_minimum {
    narc_point at;
    double along;
    struct ground_foot foot;
    double depth;
    bool doubtful;
};

enum { GROUND_MINIMA = 64 };

/* The search of one body: make, ask, destroy. It looks at places that are `step` apart, or that part of the smallest piece
 * that may be next to them. */
struct ground_search;
struct ground_search *search_ground(const struct ground *ground, const struct reference_body *body, double margin,
                                    double step, double part);
void destroy_search(struct ground_search *search);

/* Minima below the margin, in their order along the outline. Fewer than that apart they may be taken for one, and
 * those that the distance rises between by less than `noise` are one: that with the least distance. At most
 * GROUND_MINIMA. */
size_t ground_minima(struct ground_search *search, double noise, struct ground_minimum *out);

/* The point of the outline next to a point: its place there, and how far it is. */
double ground_project(const struct ground_search *search, narc_point point, double *out_distance);

/* How high the distance rises on the way along the outline between two places, the lower of both ways. */
double ground_barrier(struct ground_search *search, double from, double to);

/* The least distance along the outline within `reach` of a place. */
double ground_least(struct ground_search *search, double along, double reach);

#endif
