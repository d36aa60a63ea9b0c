/* SPDX-License-Identifier: MIT
 *
 * peers.c - the table of peers, those that are not in this build as well.
 */
#include "peers.h"

#include <string.h>

#ifndef BENCH_BOX2D
#define MISSING(query)                                                                                                 \
    { .question = query, .name = "box2d", .missing = "built without Box2D" }
const struct peer box2d_collide = MISSING("contact"), box2d_overlap = MISSING("overlap"), box2d_world = MISSING("stay"),
                  box2d_ground = MISSING("ground"), box2d_rays = MISSING("ray"), box2d_regions = MISSING("region"),
                  box2d_impacts = MISSING("impact");
const char *box2d_name(void) { return "no Box2D"; }
#endif

static const struct peer *const peers[] = {&box2d_collide, &box2d_overlap, &box2d_world,   &box2d_ground,
                                           &box2d_rays,    &box2d_regions, &box2d_impacts, &disc_loop};

const struct peer *find_peer(const char *query, const char *name) {
    for (size_t k = 0; k < sizeof peers / sizeof peers[0]; k++)
        if (strncmp(query, peers[k]->question, strcspn(query, "-")) == 0 && strcmp(peers[k]->name, name) == 0)
            return peers[k];
    return NULL;
}
