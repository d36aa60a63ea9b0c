/* SPDX-License-Identifier: MIT
 *
 * difference.h - the area of the symmetric difference of a chain and a hull. Internal.
 */
#ifndef NARC_FIT_DIFFERENCE_H
#define NARC_FIT_DIFFERENCE_H

#include "model/chain.h"
#include "outline/hull.h"

/* The area in one of both but not in the other, of a placed chain and the hull without its inflation, seen from a point
 * inside both; infinite if `middle` is not. It is a quadrature, good to some 1e-4 of its value. Unless NULL,
 * `derivatives` gets those by all variables, in the order of narc_make_layout(). */
double narc_difference_area(const narc_chain *chain, const narc_hull *hull, narc_point middle, double *derivatives);

#endif
