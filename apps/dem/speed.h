/* SPDX-License-Identifier: MIT
 *
 * speed.h - the yardstick: discs stepped by a loop that is written for discs.
 */
#ifndef DEM_SPEED_H
#define DEM_SPEED_H

#include "dem.h"

/* The state of a world of discs, and its lists. Laws, order of operations and lists are those of the world, so that
 * both go on alike. */
typedef struct discs discs;

/* A copy of the world's state; NULL without memory. Only the linear law, grains that are discs, and plates that do not
 * move. */
discs *discs_copy(const dem *d);
void discs_free(discs *state);

/* One step. Lists are the world's: false when they are out of date. */
bool discs_step(discs *state, unsigned threads);

/* The kinetic energy: to see that both worlds go the same way. */
double discs_kinetic(const discs *state);

#endif
