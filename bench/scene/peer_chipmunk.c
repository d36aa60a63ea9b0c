/* SPDX-License-Identifier: MIT
 *
 * peer_chipmunk.c - rays, points and regions in Chipmunk: cpSpaceSegmentQueryFirst(), cpSpacePointQueryNearest(),
 * cpSpaceBBQuery().
 */
#include "peers.h"

#include <chipmunk/chipmunk.h>
#include <math.h>

static void *create(const struct workload *workload) {
    cpSpace *const space = cpSpaceNew();
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *const place = &workload->bodies[k];
        const struct outline *const outline = &workload->outlines[place->shape];
        cpVect points[16];
        for (size_t i = 0; i < outline->count && i < 16; i++)
            points[i] = cpv(outline->arcs[i].x, outline->arcs[i].y);
        cpBody *const body = cpBodyNewStatic();
        cpBodySetPosition(body, cpv((cpFloat)place->x, (cpFloat)place->y));
        cpBodySetAngle(body, atan2((double)place->sine, (double)place->cosine));
        cpShape *const shape = cpPolyShapeNewRaw(body, (int)outline->count, points, 0);
        cpShapeSetUserData(shape, (cpDataPointer)(uintptr_t)k);
        cpSpaceAddShape(space, shape);
    }
    return space;
}

static void cast(void *scene, const struct peer_ray *rays, size_t count, float *out_fractions) {
    for (size_t k = 0; k < count; k++) {
        cpSegmentQueryInfo info;
        const cpVect from = cpv((cpFloat)rays[k].x, (cpFloat)rays[k].y);
        const cpVect to = cpv((cpFloat)rays[k].end_x, (cpFloat)rays[k].end_y);
        const cpShape *const hit = cpSpaceSegmentQueryFirst(scene, from, to, 0, CP_SHAPE_FILTER_ALL, &info);
        out_fractions[k] = hit ? (float)info.alpha : 2;
    }
}

static void find_nearest(void *scene, const float *x, const float *y, size_t count, float distance,
                         float *out_separations) {
    for (size_t k = 0; k < count; k++) {
        cpPointQueryInfo info;
        cpSpacePointQueryNearest(scene, cpv((cpFloat)x[k], (cpFloat)y[k]), (cpFloat)distance, CP_SHAPE_FILTER_ALL,
                                 &info);
        out_separations[k] = (float)info.distance;
    }
}

const struct scene_peer chipmunk_scene = {"Chipmunk", create, cast, find_nearest};

/* The pairs of the region that is asked for. */
struct pairs {
    uint64_t query, *out;
    size_t count;
};

static void add_pair(cpShape *shape, void *data) {
    struct pairs *const pairs = data;
    pairs->out[pairs->count++] = pairs->query << 32 | (uintptr_t)cpShapeGetUserData(shape);
}

static size_t find_regions(void *scene, const narc_box *regions, size_t count, uint64_t *out_pairs) {
    struct pairs pairs = {.out = out_pairs};
    for (size_t k = 0; k < count; k++) {
        const narc_box *const r = &regions[k];
        const cpBB box = cpBBNew((cpFloat)r->min_x, (cpFloat)r->min_y, (cpFloat)r->max_x, (cpFloat)r->max_y);
        pairs.query = k;
        cpSpaceBBQuery(scene, box, CP_SHAPE_FILTER_ALL, add_pair, &pairs);
    }
    return pairs.count;
}

static void *create_for_regions(const struct workload *workload, const narc_box *boxes) {
    (void)boxes;
    return create(workload);
}

const struct region_peer chipmunk_regions = {"Chipmunk", create_for_regions, find_regions};
