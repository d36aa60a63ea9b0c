/* SPDX-License-Identifier: MIT
 *
 * frames.h - what files for ParaView and tables have in common: each grain's share of the contacts, the place
 * of walls, the box around all.
 */
#ifndef DEM_FRAMES_H
#define DEM_FRAMES_H

#include "dem.h"

/* A body's contacts of the last step. Its stress is the sum of force times arm over its contacts, by its volume:
 * compression is positive. Walls have contacts, and no stress.
 *
 * Grains with too few contacts to be held are rattlers, and so are those that are held by them: a grain is held by two
 * contacts that press, or, where no pair of materials has friction, three. */
typedef struct dem_load {
    uint32_t contacts;
    uint32_t bearing; /* contacts that press, with walls and grains that are no rattlers; of a rattler 0 */
    uint32_t count;   /* while they are counted */
    double stress_xx, stress_xy, stress_yx, stress_yy;
} dem_load;

/* Of all bodies, in memory that the caller frees; NULL, with an error (512 bytes), if there is none left. */
dem_load *dem_find_loads(const dem *d, char *error);

/* How hard the bodies of contact k press each other, and how much they rub. */
double dem_normal_force(const dem *d, size_t k);
double dem_tangential_force(const dem *d, size_t k);

/* Around all grains and walls that are no plates. */
dem_region dem_bound_all(const dem *d);

/* The part of a plate that lies along a region, as a strip as thick as a grain: corners counter-clockwise. */
void dem_outline_plate(const dem *d, size_t wall, const dem_region *along, dem_vec out_corners[4]);

#endif
