/* SPDX-License-Identifier: MIT
 *
 * peers.h - what this library is compared with, behind one C interface.
 */
#ifndef NARC_BENCH_PEERS_H
#define NARC_BENCH_PEERS_H

#include "scene.h"

struct ray {
    float x, y, motion_x, motion_y;
};

/* What a run asks; a peer looks at its part. */
struct asked {
    size_t count;
    bool checks;              /* outside the time: answers that a peer does not keep are wanted */
    const struct pair *pairs; /* "contact", "overlap": uint8_t, do they collide? */
    const struct ray
        *rays; /* "ray", "named": float, the fraction of the first hit, above 1 if there is none. Bodies that
                                 * it starts in do not count. "distance", "inside": float, 1 within, of where it starts */
    const uint32_t *named; /* "named", "distance", "inside": of these bodies */
    const narc_box
        *regions;          /* "region": uint64_t, pairs region << 32 | body; returns how many. "move": of all bodies, */
    const uint32_t *moved; /* of which these have moved */
    const struct outline *polygon; /* "impact" of bodies 2 k and 2 k + 1: float, when they meet, above 1 if never */
    const narc_body *bodies;
    const narc_motion *motions;
    bool straight;           /* none turns */
    const float (*cloud)[2]; /* "hull": of so many points after so many; uint8_t, corners. */
    size_t cloud_size;
};

/* A library's answer to one question. */
struct peer {
    const char *question, *name; /* of its rows; a query's name up to the first "-" */
    const char *missing;         /* NULL, or why it can't run */
    bool arcs;                   /* it has them; else polygons of the junctions stand for n-arcs */
    unsigned max_edges;
    void *(*create)(struct scene *scene); /* shapes and poses in the form it wants them */
    size_t (*ask)(void *context, const struct asked *asked, void *out);

    /* "stay" in the place of `ask`: puts bodies that have moved where they are, and finds boxes, pairs and contacts. With a
     * clock of its own it does more, and returns the seconds of these alone. */
    bool own_clock; /* contacts serve again while their bodies have moved less than `recycling` */
    double (*step)(void *context, const struct body *bodies, const uint32_t *moved, size_t count, float recycling);
    size_t (*count_touching)(void *context);
};

/* By the words of a row; NULL if there is none. */
const struct peer *find_peer(const char *query, const char *name);

const char *box2d_name(void); /* with its version */

extern const struct peer box2d_collide, box2d_overlap, box2d_world, box2d_ground, box2d_rays, box2d_regions,
    box2d_moves, box2d_impacts, box2d_named, box2d_distances, box2d_inside, box2d_hulls;
extern const struct peer ccd_gjk, ccd_mpr;
extern const struct peer geos_regions;
extern const struct peer disc_loop;

#endif
