/* SPDX-License-Identifier: MIT
 *
 * chipmunk.c - Chipmunk: contacts of two polygons or segments with a radius, rays, regions, the nearest body.
 */
#include <chipmunk/chipmunk_private.h>

#include <math.h>

#include "common.h"
#include "peers.h"

static cpShape *make_shape(cpBody *body, const struct outline *outline) {
    cpVect points[MAX_EDGES];
    for (size_t k = 0; k < outline->count; k++)
        points[k] = cpv(outline->arcs[k].x, outline->arcs[k].y);
    return outline->count == 2 ? cpSegmentShapeNew(body, points[0], points[1], outline->arcs[0].radius)
                               : cpPolyShapeNewRaw(body, (int)outline->count, points, 0);
}

/* ------------------------------------------------------------------------------------------------ pairs */

/* It keeps each body's vertices in world axes and renews them once per step, not once per pair: that is outside the
 * time. */
static void *create(struct scene *scene) {
    cpShape **shapes = allocate(scene->body_count, sizeof *shapes);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *body = &scene->bodies[k];
        shapes[k] = make_shape(cpBodyNewKinematic(), &scene->outlines[body->shape]);
        cpShapeUpdate(shapes[k],
                      cpTransformNewTranspose(body->cosine, -body->sine, body->x, body->sine, body->cosine, body->y));
    }
    return shapes;
}

static size_t collide(void *context, const struct asked *asked, void *out) {
    cpShape *const *shapes = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++)
        colliding[k] = cpShapesCollide(shapes[asked->pairs[k].a], shapes[asked->pairs[k].b]).count > 0;
    return 0;
}

const struct peer chipmunk_collide = {.question = "contact",
                                      .name = "chipmunk",
                                      .capsules = true,
                                      .max_edges = MAX_EDGES,
                                      .create = create,
                                      .ask = collide};

/* ------------------------------------------------------------------------------------------------ questions */

static void *create_still(struct scene *scene) {
    cpSpace *space = cpSpaceNew();
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *at = &scene->bodies[k];
        cpBody *body = cpBodyNewStatic();
        cpBodySetPosition(body, cpv((cpFloat)at->x, (cpFloat)at->y));
        cpBodySetAngle(body, atan2((double)at->sine, (double)at->cosine));
        cpShape *shape = make_shape(body, &scene->outlines[at->shape]);
        cpShapeSetUserData(shape, (cpDataPointer)(uintptr_t)k);
        cpSpaceAddShape(space, shape);
    }
    return space;
}

static size_t cast(void *space, const struct asked *asked, void *out) {
    float *fractions = out;
    for (size_t k = 0; k < asked->count; k++) {
        const struct ray *ray = &asked->rays[k];
        const cpVect from = cpv((cpFloat)ray->x, (cpFloat)ray->y);
        const cpVect to = cpv((cpFloat)(ray->x + ray->motion_x), (cpFloat)(ray->y + ray->motion_y));
        cpSegmentQueryInfo info;
        const cpShape *hit = cpSpaceSegmentQueryFirst(space, from, to, 0, CP_SHAPE_FILTER_ALL, &info);
        fractions[k] = hit ? (float)info.alpha : 2;
    }
    return 0;
}

static size_t find_nearest(void *space, const struct asked *asked, void *out) {
    float *separations = out;
    for (size_t k = 0; k < asked->count; k++) {
        cpPointQueryInfo info;
        cpSpacePointQueryNearest(space, cpv((cpFloat)asked->x[k], (cpFloat)asked->y[k]), (cpFloat)asked->within,
                                 CP_SHAPE_FILTER_ALL, &info);
        separations[k] = (float)info.distance;
    }
    return 0;
}

/* The pairs of the region that is asked for. */
struct found {
    uint64_t region, *out;
    size_t count;
};

static void add_pair(cpShape *shape, void *data) {
    struct found *found = data;
    found->out[found->count++] = found->region << 32 | (uintptr_t)cpShapeGetUserData(shape);
}

static size_t find_regions(void *space, const struct asked *asked, void *out) {
    struct found found = {.out = out};
    for (; found.region < asked->count; found.region++) {
        const narc_box *r = &asked->regions[found.region];
        const cpBB box = cpBBNew((cpFloat)r->min_x, (cpFloat)r->min_y, (cpFloat)r->max_x, (cpFloat)r->max_y);
        cpSpaceBBQuery(space, box, CP_SHAPE_FILTER_ALL, add_pair, &found);
    }
    return found.count;
}

const struct peer chipmunk_rays = {
    .question = "ray", .name = "chipmunk", .max_edges = MAX_EDGES, .create = create_still, .ask = cast};
const struct peer chipmunk_regions = {
    .question = "region", .name = "chipmunk", .max_edges = MAX_EDGES, .create = create_still, .ask = find_regions};
const struct peer chipmunk_nearest = {
    .question = "nearest", .name = "chipmunk", .max_edges = MAX_EDGES, .create = create_still, .ask = find_nearest};
