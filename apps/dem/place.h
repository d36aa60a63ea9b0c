/* SPDX-License-Identifier: MIT
 *
 * place.h - where grains start: at random places without overlap, or on a lattice.
 */
#ifndef DEM_PLACE_H
#define DEM_PLACE_H

#include "dem.h"

enum { DEM_MAX_CHOICES = 64 };

/* A size is the diameter of the disc of equal area. */
typedef enum dem_distribution { DEM_FIXED, DEM_UNIFORM, DEM_NORMAL, DEM_LOGNORMAL } dem_distribution;

typedef struct dem_sizes {
    dem_distribution kind;
    double mean, deviation; /* of the lognormal distribution: the median, and the deviation of the logarithm */
    double low, high;       /* sizes outside are drawn again */
} dem_sizes;

typedef struct dem_filling {
    uint64_t count; /* of a lattice: at most, 0: as many as it has places */
    dem_region region;
    uint32_t shapes[DEM_MAX_CHOICES]; /* one of them, all alike in chance */
    size_t shape_count;
    uint8_t material;
    dem_sizes sizes;
    double gap;      /* grains start at least this far apart, and from walls */
    double speed;    /* each component of the velocity is drawn up to this */
    double spin;     /* as well */
    dem_vec spacing; /* of a lattice */
    double jitter;   /* of a lattice: up to this share of half the spacing, in both directions */
    bool upright;    /* angle 0, else a random one */
    uint64_t tries;  /* for one grain, before a random filling gives up */
} dem_filling;

/* `random` is the state of a generator. */
double dem_draw_size(const dem_sizes *sizes, uint64_t *random);

/* Walls must have been added before. */
bool dem_fill_randomly(dem *d, const dem_filling *filling, uint64_t *random);
bool dem_fill_lattice(dem *d, const dem_filling *filling, uint64_t *random);

#endif
