/* SPDX-License-Identifier: MIT
 *
 * chain.h - the unknowns of a fit: a closed chain of arcs and edges, by normals, radii and lengths. Internal.
 *
 * Arc i has radius r_i and covers the normals from d_i to d_{i+1}; an edge of length l_i >= 0 with normal d_i lies
 * before it. With t_i, the direction of that edge (d_i a quarter turn on), the centres are
 *
 *     a_i = a_{i-1} + (r_{i-1} - r_i) d_i + l_i t_i,        and the chain closes if this holds for i = 0 too.
 *
 * For fixed normals everything is linear in a_0, r and l: the support function h(u) = a_i.u + r_i in the sector of arc
 * i, closure and perimeter. If d_k turns by a small angle e_k, the centres from a_k on move by e_k c_k, with c_k =
 * (r_{k-1} - r_k) t_k - l_k d_k. These are the derivatives that the search works with.
 */
#ifndef NARC_FIT_CHAIN_H
#define NARC_FIT_CHAIN_H

#include "narc_fit.h"

enum { MAX_CHAIN = NARC_MAX_FIT_ARCS };

typedef struct narc_chain {
    size_t count;
    narc_point start;        /* a_0 */
    double angle[MAX_CHAIN]; /* of d_i, rising; angle[0] + 2 pi ends the last arc */
    double radius[MAX_CHAIN];
    double edge[MAX_CHAIN];
    /* What follows from these: see narc_place_chain(). */
    narc_point normal[MAX_CHAIN + 1]; /* d_i; the last is the first */
    narc_point center[MAX_CHAIN + 1]; /* a_i; the last is a_0 if the chain closes */
} narc_chain;

/* Where each kind of variable begins in a vector of all variables. Derivatives and the columns of a linear programme
 * have this order. */
typedef struct narc_layout {
    size_t radius, edge, start, angle, distance, count;
} narc_layout;
narc_layout narc_make_layout(size_t count);

/* Computes normals and centres. */
void narc_place_chain(narc_chain *chain);

/* The angle at which arc i ends. */
double narc_end_angle(const narc_chain *chain, size_t i);

/* Makes the chain close by the smallest changes of lengths relative to what they are, and of radii relative to what
 * they have above `least_radius` (so none falls below it unless the gap is large), and places it. False if that can't
 * be done. */
bool narc_close_chain(narc_chain *chain, double least_radius);

/* Moves the outline outward by `distance`, everywhere: the arcs grow, or, if `polygon`, the edges move and meet
 * again. */
void narc_offset_chain(narc_chain *chain, double distance, bool polygon);

/* The chain as a mirror shows it, with x turned round. */
void narc_mirror_chain(narc_chain *chain);

double narc_chain_area(const narc_chain *chain);
double narc_chain_perimeter(const narc_chain *chain);

/* Derivatives by all variables, in the order of narc_make_layout(); `out` has that many items. Area and perimeter are
 * homogeneous in radii, lengths and a_0, of degree 2 and 1. */
void narc_derive_area(const narc_chain *chain, double *out);
void narc_derive_perimeter(const narc_chain *chain, double *out);

/* Derivatives of the gap between the last centre and a_0, which is 0 where the chain closes; rows of zeros are
 * filled. */
void narc_derive_gap(const narc_chain *chain, double *out_x, double *out_y);

/* Adds `factor` times the derivatives of a_i.u (u fixed) by all variables. */
void narc_derive_center(const narc_chain *chain, size_t i, narc_point u, double factor, double *out);

#endif
