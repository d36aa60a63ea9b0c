/* SPDX-License-Identifier: MIT
 *
 * least_distance.h - how close fits come at best, known without a search. Internal.
 */
#ifndef NARC_FIT_LEAST_DISTANCE_H
#define NARC_FIT_LEAST_DISTANCE_H

#include "outline/hull.h"

/* No n-arc, as the store has it, is closer than this to a hull with its corners within 1 of the origin. */
double narc_least_distance(const narc_hull *hull, bool bound);

#endif
