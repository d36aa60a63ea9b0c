/* SPDX-License-Identifier: MIT
 *
 * world_chipmunk.c - the collision part of Chipmunk's step: what cpSpaceStep() does between moving the bodies and
 * solving, so the bodies stay where they are.
 */
#include <chipmunk/chipmunk_private.h>

#include <math.h>

#include "common.h"
#include "peers.h"

static void *create(const struct workload *workload) {
    cpSpace *space = cpSpaceNew();
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *place = &workload->bodies[k];
        const struct outline *outline = &workload->outlines[place->shape];
        cpVect points[MAX_EDGES];
        for (size_t i = 0; i < outline->count; i++)
            points[i] = cpv(outline->arcs[i].x, outline->arcs[i].y);
        cpBody *body = cpSpaceAddBody(space, cpBodyNew(1, 1));
        cpBodySetPosition(body, cpv(place->x, place->y));
        cpBodySetAngle(body, atan2(place->sine, place->cosine));
        cpSpaceAddShape(space, cpPolyShapeNewRaw(body, (int)outline->count, points, 0));
    }
    return space;
}

static double step(void *context) {
    cpSpace *space = context;
    space->stamp++;
    space->arbiters->num = 0;
    cpSpaceLock(space);
    cpSpacePushFreshContactBuffer(space);
    cpSpatialIndexEach(space->dynamicShapes, (cpSpatialIndexIteratorFunc)cpShapeUpdateFunc, NULL);
    cpSpatialIndexReindexQuery(space->dynamicShapes, (cpSpatialIndexQueryFunc)cpSpaceCollideShapes, space);
    cpSpaceUnlock(space, cpFalse);
    return 0;
}

static size_t count_touching(void *context) { return (size_t)((cpSpace *)context)->arbiters->num; }

const struct world_peer chipmunk_space = {
    .name = "chipmunk-space", .max_edges = MAX_EDGES, .create = create, .step = step, .count_touching = count_touching};
