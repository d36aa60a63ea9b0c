/* SPDX-License-Identifier: MIT
 *
 * difference.h - the area of the symmetric difference of a chain and a hull. Internal.
 */
#ifndef NARC_FIT_DIFFERENCE_H
#define NARC_FIT_DIFFERENCE_H

#include "chain.h"
#include "hull.h"

/* The area in one of both but not in the other, of a placed chain and the hull without its inflation, seen from a point
 * inside both; infinite if `middle` is not. It is a quadrature, good to some 1e-4 of its value. Unless NULL,
 * `derivatives` gets those by all variables, in the order of narc_layout_of(). */
double narc_difference_area(const chain *of, const hull *around, narc_point middle, double *derivatives);

#endif
