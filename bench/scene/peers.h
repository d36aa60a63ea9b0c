/* SPDX-License-Identifier: MIT
 *
 * peers.h - what other libraries are asked of the same scene.
 */
#ifndef NARC_BENCH_SCENE_PEERS_H
#define NARC_BENCH_SCENE_PEERS_H

#include "workload.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A ray with its end, and what it hits first: a fraction above 1 if nothing. Bodies that it starts in do not count. */
struct peer_ray {
    float x, y, end_x, end_y;
};

/* A library with still bodies, polygons. */
struct scene_peer {
    const char *name;
    void *(*create)(const struct workload *workload);
    void (*cast)(void *scene, const struct peer_ray *rays, size_t count, float *out_fractions);
    /* Separations of the nearest bodies within a distance; NULL: it has no such question. */
    void (*find_nearest)(void *scene, const float *x, const float *y, size_t count, float distance,
                         float *out_separations);
};

const char *box2d_name(void); /* with its version */
extern const struct scene_peer box2d_scene, chipmunk_scene;

/* GEOS' tree has the polygons: the distances of the nearest ones, 0 within them. */
void *geos_create_polygons(const struct workload *workload);
void geos_find_nearest(void *polygons, const float *x, const float *y, size_t count, float *out_distances);

/* A library that finds the bodies in regions: of a scene or, where it has one, in a tree of boxes. */
struct region_peer {
    const char *name;
    void *(*create)(const struct workload *workload, const narc_box *boxes);
    /* Pairs query << 32 | body of regions and the bodies whose boxes they meet, in any order within a query; returns how
     * many. */
    size_t (*find)(void *tree, const narc_box *regions, size_t count, uint64_t *out_pairs);
};

extern const struct region_peer box2d_regions, chipmunk_regions, geos_regions;

/* A convex polygon of at most eight corners, and how far a body moves and turns. */
struct peer_polygon {
    size_t count;
    float x[8], y[8];
};
struct peer_motion {
    float x, y, angle;
};

/* For pair k, bodies 2k and 2k + 1: when they meet, above 1 if never. */
void box2d_find_impacts(const struct peer_polygon *polygon, const narc_body *bodies, const struct peer_motion *motions,
                        size_t count, float *out_fractions);

#ifdef __cplusplus
}
#endif

#endif
