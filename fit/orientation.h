/* SPDX-License-Identifier: MIT
 *
 * orientation.h - on which side of a line is a point? Internal.
 */
#ifndef NARC_ORIENTATION_H
#define NARC_ORIENTATION_H

#include "narc_fit.h"

/* The sign of (b - a) x (c - a): 1 where a, b, c turn left, -1 where they turn right, 0 where they are on a line.
 * Exact, unless a product of two coordinates is below 1e-290 without being 0. */
int narc_find_orientation(narc_point a, narc_point b, narc_point c);

#endif
