/* SPDX-License-Identifier: MIT
 *
 * workload.h - what the rows run on: shapes, bodies and pairs, with the exact separation of every pair.
 */
#ifndef NARC_BENCH_WORKLOAD_H
#define NARC_BENCH_WORKLOAD_H

#include <stdbool.h>

#include "exact.h"
#include "narc.h"

#ifdef __cplusplus
extern "C" {
#endif

/* A pair whose exact separation is closer to 0 than this may have either answer. */
#define TOUCHING 1e-5

/* The shapes of a workload. */
enum family {
    FAMILY_N_ARCS,
    FAMILY_KINDS,   /* circles, boxes, polygons and n-arcs, equally many, in all combinations */
    FAMILY_GENERAL, /* a polygon against an n-arc, in every pair */
    FAMILY_ROUNDED, /* the polygons of the junctions with arcs in the place of vertices */
    FAMILY_BOXES,
    FAMILY_DISCS,
    FAMILY_CAPSULES,
    FAMILY_POLYGONS, /* the polygons of FAMILY_N_ARCS, in the same places; in settled piles as large as the n-arcs */
    FAMILY_BOUNDS,   /* the bounding circles of FAMILY_N_ARCS, in the same places */
    FAMILY_CAPSULE_BOXES /* boxes as large as FAMILY_CAPSULES, in the same places */
};

/* Where the second body of a pair is: at a multiple of the distance at which the two touch (in a random direction), or
 * anywhere where the axis-aligned boxes overlap, half of the pairs colliding. SCENE_PACKING is not made of pairs but of
 * bodies: 1 to 10 pairs, all in one square. So are the settled piles, of `body_count` bodies: see settled.h; and stacks
 * of equal squares: a pyramid at rest, each with a gap to the next in its row, and a lattice without gaps, where normals
 * tie at every corner. */
enum scene {
    SCENE_DISJOINT,
    SCENE_COLLIDING,
    SCENE_MIXED,
    SCENE_PACKING,
    SCENE_PYRAMID,
    SCENE_LATTICE,
    SCENE_SETTLED_SMALL,
    SCENE_SETTLED,
    SCENE_SETTLED_LARGE
};

/* How many distinct shapes. */
enum variety { UNIQUE /* 4,096 */, TEMPLATES /* 16 */, FEW /* 64 */, VARIETIES };

/* What a workload is made from. */
struct workload_key {
    unsigned edges; /* arcs of an n-arc, vertices of a polygon */
    enum family family;
    enum scene scene;
    enum variety variety;
    bool sorted; /* pairs by their first body, as from a broad phase, instead of in random order */
    bool moved;  /* the next frame: every body moved by up to 1 % of its size, and turned by up to 0.01; in settled
                  * piles a tenth of that, in stacks nothing */
    size_t pair_count;
    size_t body_count; /* of a settled pile, whose pairs are those that are close; else 0 */
};

struct pair {
    uint32_t a, b;
};

struct workload {
    struct workload_key key;
    size_t shape_count, body_count, pair_count;
    struct outline *outlines;
    narc_shapes *shapes; /* the same */
    struct body *bodies;
    struct pair *pairs;
    double *gaps; /* exact, one per pair */
};

bool is_settled(const struct workload_key *key);

/* Makes a workload, or finds the one made before. The same key always gives the same one. */
const struct workload *get_workload(const struct workload_key *key);

/* Such as "n8/mixed/unique/random". */
void name_workload(const struct workload_key *key, char *out, size_t size);

#ifdef __cplusplus
}
#endif

#endif
