/* SPDX-License-Identifier: MIT
 *
 * peer_box2d3.c - Box2D 3: its manifolds of two polygons or capsules, and its distance of two polygons.
 */
#include "box2d3_bodies.h"
#include "common.h"
#include "peers.h"

union shape {
    b2Polygon polygon;
    b2Capsule capsule;
};

struct context {
    union shape *shapes;
    b2Transform *transforms;
    uint32_t *shape; /* of a body */
    bool capsules;
};

static void *create(const struct workload *workload) {
    struct context *context = allocate(1, sizeof *context);
    context->shapes = allocate(workload->shape_count, sizeof *context->shapes);
    context->transforms = allocate(workload->body_count, sizeof *context->transforms);
    context->shape = allocate(workload->body_count, sizeof *context->shape);
    context->capsules = workload->key.family == FAMILY_CAPSULES;
    for (size_t k = 0; k < workload->shape_count; k++) {
        const struct arc *arcs = workload->outlines[k].arcs;
        if (context->capsules)
            context->shapes[k].capsule = (b2Capsule){
                {(float)arcs[0].x, (float)arcs[0].y}, {(float)arcs[1].x, (float)arcs[1].y}, (float)arcs[0].radius};
        else
            context->shapes[k].polygon = make_box2d_polygon(&workload->outlines[k]);
    }
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *body = &workload->bodies[k];
        context->transforms[k] = (b2Transform){{body->x, body->y}, {body->cosine, body->sine}};
        context->shape[k] = body->shape;
    }
    return context;
}

/* Points that are within b2_speculativeDistance of touching are told as well. */
static bool touches(const b2Manifold *manifold) {
    return (manifold->pointCount > 0 && manifold->points[0].separation < 0) ||
           (manifold->pointCount > 1 && manifold->points[1].separation < 0);
}

static void collide(void *argument, const struct pair *pairs, size_t count, uint8_t *out_colliding) {
    const struct context *context = argument;
    for (size_t k = 0; k < count; k++) {
        const uint32_t a = pairs[k].a, b = pairs[k].b;
        const union shape *shape_a = &context->shapes[context->shape[a]],
                          *shape_b = &context->shapes[context->shape[b]];
        const b2Transform at_a = context->transforms[a], at_b = context->transforms[b];
        const b2Manifold manifold = context->capsules
                                        ? b2CollideCapsules(&shape_a->capsule, at_a, &shape_b->capsule, at_b)
                                        : b2CollidePolygons(&shape_a->polygon, at_a, &shape_b->polygon, at_b);
        out_colliding[k] = touches(&manifold);
    }
}

static b2ShapeProxy proxy_of(const union shape *shape) {
    return b2MakeProxy(shape->polygon.vertices, shape->polygon.count, 0);
}

static void overlap(void *argument, const struct pair *pairs, size_t count, uint8_t *out_colliding) {
    const struct context *context = argument;
    for (size_t k = 0; k < count; k++) {
        const uint32_t a = pairs[k].a, b = pairs[k].b;
        const b2DistanceInput input = {.proxyA = proxy_of(&context->shapes[context->shape[a]]),
                                       .proxyB = proxy_of(&context->shapes[context->shape[b]]),
                                       .transformA = context->transforms[a],
                                       .transformB = context->transforms[b]};
        b2SimplexCache cache = {0};
        out_colliding[k] = b2ShapeDistance(&input, &cache, NULL, 0).distance == 0;
    }
}

const struct peer box2d_collide = {.name = "box2d-collide",
                                   .query = "contact",
                                   .polygons = true,
                                   .capsules = true,
                                   .max_edges = B2_MAX_POLYGON_VERTICES,
                                   .create = create,
                                   .run = collide};
const struct peer box2d_overlap = {.name = "box2d-overlap",
                                   .query = "overlap",
                                   .polygons = true,
                                   .max_edges = B2_MAX_POLYGON_VERTICES,
                                   .create = create,
                                   .run = overlap};

/* ------------------------------------------------------------------------------------------------ world */

/* A step of no time is none at all, so bodies get one in which they hardly move. Box2D's own clock tells what part of it
 * found pairs and updated manifolds: that part of the processor's time counts, since its clock is that on the wall. */
static void *create_world(const struct workload *workload) {
    b2WorldId *world = allocate(1, sizeof *world);
    *world = create_box2d_bodies(workload, b2_dynamicBody);
    return world;
}

static double step(void *world) {
    const double start = now();
    b2World_Step(*(const b2WorldId *)world, 1e-9f, 1);
    const double spent = now() - start;
    const b2Profile profile = b2World_GetProfile(*(const b2WorldId *)world);
    return 1e-9 * spent * ((double)profile.pairs + (double)profile.collide) / (double)profile.step;
}

static size_t count_touching(void *world) {
    const b2Counters counters = b2World_GetCounters(*(const b2WorldId *)world); /* touching contacts have colours */
    size_t count = 0;
    for (size_t k = 0; k < sizeof counters.colorCounts / sizeof counters.colorCounts[0]; k++)
        count += (size_t)counters.colorCounts[k];
    return count;
}

const struct world_peer box2d_world = {.name = "box2d-world",
                                       .own_clock = true,
                                       .max_edges = B2_MAX_POLYGON_VERTICES,
                                       .create = create_world,
                                       .step = step,
                                       .count_touching = count_touching};

const char *box2d_name(void) { return name_box2d(); }
