/* SPDX-License-Identifier: MIT
 *
 * peers.c - the table of peers, those that are not in this build as well.
 */
#include "peers.h"

#include <string.h>

#define MISSING(id, query, who, library)                                                                               \
    const struct peer id = {.question = query, .name = who, .missing = "built without " library}
#ifndef BENCH_BOX2D
const char *box2d_name(void) { return "no Box2D"; }
MISSING(box2d_collide, "contact", "box2d", "Box2D");
MISSING(box2d_overlap, "overlap", "box2d", "Box2D");
MISSING(box2d_world, "stay", "box2d", "Box2D");
MISSING(box2d_ground, "ground", "box2d", "Box2D");
MISSING(box2d_rays, "ray", "box2d", "Box2D");
MISSING(box2d_regions, "region", "box2d", "Box2D");
MISSING(box2d_moves, "move", "box2d", "Box2D");
MISSING(box2d_impacts, "impact", "box2d", "Box2D");
MISSING(box2d_named, "named", "box2d", "Box2D");
MISSING(box2d_distances, "distance", "box2d", "Box2D");
MISSING(box2d_inside, "inside", "box2d", "Box2D");
MISSING(box2d_hulls, "hull", "box2d", "Box2D");
#endif
#ifndef BENCH_CCD
MISSING(ccd_gjk, "overlap", "ccd-gjk", "libccd");
MISSING(ccd_mpr, "overlap", "ccd-mpr", "libccd");
#endif
#ifndef BENCH_GEOS
MISSING(geos_regions, "region", "geos", "GEOS");
#endif

static const struct peer *const peers[] = {&box2d_collide, &box2d_overlap,   &box2d_world,   &box2d_rays,
                                           &box2d_ground,  &box2d_regions,   &box2d_impacts, &box2d_moves,
                                           &box2d_named,   &box2d_distances, &box2d_inside,  &box2d_hulls,
                                           &ccd_gjk,       &ccd_mpr,         &geos_regions,  &disc_loop};

const struct peer *find_peer(const char *query, const char *name) {
    for (size_t k = 0; k < sizeof peers / sizeof peers[0]; k++)
        if (strncmp(query, peers[k]->question, strcspn(query, "-")) == 0 && strcmp(peers[k]->name, name) == 0)
            return peers[k];
    return NULL;
}
