/* SPDX-License-Identifier: MIT
 *
 * peer_chipmunk.c - Chipmunk's contacts of two polygons, or of two segments with a radius.
 *
 * Chipmunk keeps each body's vertices in world axes and renews them once per step, not once per pair: that is outside
 * the time.
 */
#include <chipmunk/chipmunk.h>

#include "common.h"
#include "peers.h"

static cpShape *place_shape(const struct outline *outline, const struct body *place) {
    cpVect points[MAX_EDGES];
    for (size_t k = 0; k < outline->count; k++)
        points[k] = cpv(outline->arcs[k].x, outline->arcs[k].y);
    cpBody *body = cpBodyNewKinematic();
    cpShape *shape = outline->count == 2 ? cpSegmentShapeNew(body, points[0], points[1], outline->arcs[0].radius)
                                         : cpPolyShapeNewRaw(body, (int)outline->count, points, 0);
    cpShapeUpdate(shape,
                  cpTransformNewTranspose(place->cosine, -place->sine, place->x, place->sine, place->cosine, place->y));
    return shape;
}

static void *create(const struct workload *workload) {
    cpShape **shapes = allocate(workload->body_count, sizeof *shapes);
    for (size_t k = 0; k < workload->body_count; k++)
        shapes[k] = place_shape(&workload->outlines[workload->bodies[k].shape], &workload->bodies[k]);
    return shapes;
}

static void run(void *context, const struct pair *pairs, size_t count, uint8_t *out_colliding) {
    cpShape *const *shapes = context;
    for (size_t k = 0; k < count; k++)
        out_colliding[k] = cpShapesCollide(shapes[pairs[k].a], shapes[pairs[k].b]).count > 0;
}

const struct peer chipmunk_collide = {.name = "chipmunk",
                                      .query = "contact",
                                      .polygons = true,
                                      .capsules = true,
                                      .max_edges = MAX_EDGES,
                                      .create = create,
                                      .run = run};
