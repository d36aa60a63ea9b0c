/* SPDX-License-Identifier: MIT
 *
 * box2d3.c - Box2D 3: manifolds of two polygons or capsules, distance of two polygons, the collision part of a step, rays
 * by b2World_CastRayClosest(), regions by b2DynamicTree_Query(), times of impact by b2TimeOfImpact().
 */
#include <box2d/box2d.h>
#if __has_include(<box2d/constants.h>)
#include <box2d/constants.h>
#endif

#include <stdio.h>

#include "common.h"
#include "peers.h"

/* Box2D 3.2 lets contacts serve again; 3.1 does not, and takes two transforms where 3.2 takes that of B in A. */
#ifdef B2_CONTACT_RECYCLE_DISTANCE
#define RECYCLES            true
#define MANIFOLD            b2LocalManifold
#define COLLIDE(what, a, b) what(a, b, b2InvMulTransforms(at_a, at_b))
#define TREE_ROOM(count)    (int)(count)
#else
#define RECYCLES            false
#define MANIFOLD            b2Manifold
#define COLLIDE(what, a, b) what(a, at_a, b, at_b)
#define TREE_ROOM(count)
#endif

static b2Polygon polygon_of(const struct outline *given) {
    const bool round = given->count > 2 && given->arcs[0].radius > 0;
    const struct outline large = round ? replace_outline(FORM_LARGE, given) : *given, *const outline = &large;
    b2Vec2 points[B2_MAX_POLYGON_VERTICES];
    for (size_t i = 0; i < outline->count; i++)
        points[i] = (b2Vec2){(float)outline->arcs[i].x, (float)outline->arcs[i].y};
    const b2Hull hull = b2ComputeHull(points, (int)outline->count);
    return b2MakePolygon(&hull, 0);
}

static b2Capsule capsule_of(const struct outline *outline) {
    const struct arc *arcs = outline->arcs;
    return (b2Capsule){
        {(float)arcs[0].x, (float)arcs[0].y}, {(float)arcs[1].x, (float)arcs[1].y}, (float)arcs[0].radius};
}

union shape {
    b2Polygon polygon;
    b2Capsule capsule;
};

struct posed {
    union shape *shapes;
    b2Transform *transforms;
    uint32_t *shape; /* of a body */
    bool capsules;
};

static void *create(struct scene *scene) {
    struct posed *posed = allocate(1, sizeof *posed);
    posed->shapes = allocate(scene->shape_count, sizeof *posed->shapes);
    posed->transforms = allocate(scene->body_count, sizeof *posed->transforms);
    posed->shape = allocate(scene->body_count, sizeof *posed->shape);
    posed->capsules = scene->family->form == FORM_CAPSULE;
    for (size_t k = 0; k < scene->shape_count; k++)
        if (posed->capsules)
            posed->shapes[k].capsule = capsule_of(&scene->outlines[k]);
        else
            posed->shapes[k].polygon = polygon_of(&scene->outlines[k]);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *body = &scene->bodies[k];
        posed->transforms[k] = (b2Transform){{body->x, body->y}, {body->cosine, body->sine}};
        posed->shape[k] = body->shape;
    }
    return posed;
}

/* Points that are within b2_speculativeDistance of touching are told as well. */
static bool touches(const MANIFOLD *manifold) {
    return (manifold->pointCount > 0 && manifold->points[0].separation < 0) ||
           (manifold->pointCount > 1 && manifold->points[1].separation < 0);
}

static size_t collide(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        const union shape *shape_a = &posed->shapes[posed->shape[a]], *shape_b = &posed->shapes[posed->shape[b]];
        const b2Transform at_a = posed->transforms[a], at_b = posed->transforms[b];
        const MANIFOLD manifold = posed->capsules ? COLLIDE(b2CollideCapsules, &shape_a->capsule, &shape_b->capsule)
                                                  : COLLIDE(b2CollidePolygons, &shape_a->polygon, &shape_b->polygon);
        colliding[k] = touches(&manifold);
    }
    return 0;
}

static b2ShapeProxy proxy_of(const union shape *shape) {
    return b2MakeProxy(shape->polygon.vertices, shape->polygon.count, 0);
}

static size_t overlap(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        const b2Transform at_a = posed->transforms[a], at_b = posed->transforms[b];
        b2DistanceInput input = {.proxyA = proxy_of(&posed->shapes[posed->shape[a]]),
                                 .proxyB = proxy_of(&posed->shapes[posed->shape[b]])};
#if RECYCLES
        input.transform = b2InvMulTransforms(at_a, at_b);
#else
        input.transformA = at_a;
        input.transformB = at_b;
#endif
        b2SimplexCache cache = {0};
        colliding[k] = b2ShapeDistance(&input, &cache, NULL, 0).distance == 0;
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ worlds */

struct world {
    b2WorldId id;
    b2BodyId *bodies;
};

static struct world *create_bodies(const struct scene *scene, b2BodyType type) {
    struct world *world = allocate(1, sizeof *world);
    b2WorldDef room = b2DefaultWorldDef();
    room.gravity = b2Vec2_zero;
    room.enableSleep = false;
    world->id = b2CreateWorld(&room);
    world->bodies = allocate(scene->body_count, sizeof *world->bodies);
    const b2ShapeDef matter = b2DefaultShapeDef();
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *at = &scene->bodies[k];
        const struct outline *outline = &scene->outlines[at->shape];
        b2BodyDef body = b2DefaultBodyDef();
        body.type = type;
        body.position = (b2Vec2){at->x, at->y};
        body.rotation = (b2Rot){at->cosine, at->sine};
        world->bodies[k] = b2CreateBody(world->id, &body);
        if (outline->count == 1) {
            const b2Circle circle = {b2Vec2_zero, (float)outline->arcs[0].radius};
            b2CreateCircleShape(world->bodies[k], &matter, &circle);
        } else if (outline->count == 2) {
            const b2Capsule capsule = capsule_of(outline);
            b2CreateCapsuleShape(world->bodies[k], &matter, &capsule);
        } else {
            const b2Polygon polygon = polygon_of(outline);
            b2CreatePolygonShape(world->bodies[k], &matter, &polygon);
        }
    }
    return world;
}

/* A step of no time is none at all, so bodies get one in which they hardly move. Box2D's own clock tells what part of it
 * found pairs and updated manifolds: that part of the processor's time counts, since its clock is that on the wall. */
static void *create_moving(struct scene *scene) { return create_bodies(scene, b2_dynamicBody); }

static double step(void *context, const struct body *bodies, const uint32_t *moved, size_t count, float recycling) {
    const struct world *world = context;
    const double start = now();
    for (size_t k = 0; k < count; k++) {
        const struct body *at = &bodies[moved[k]];
        b2Body_SetTransform(world->bodies[moved[k]], (b2Vec2){at->x, at->y}, (b2Rot){at->cosine, at->sine});
    }
    const double placed = now();
#if RECYCLES
    b2World_SetContactRecycleDistance(world->id, recycling);
#else
    (void)recycling;
#endif
    b2World_Step(world->id, 1e-9f, 1);
    const double spent = now() - placed;
    const b2Profile profile = b2World_GetProfile(world->id);
    return 1e-9 * (placed - start + spent * ((double)profile.pairs + (double)profile.collide) / (double)profile.step);
}

static size_t count_touching(void *world) {
    const b2Counters counters =
        b2World_GetCounters(((const struct world *)world)->id); /* touching contacts have colours */
    size_t count = 0;
    for (size_t k = 0; k < sizeof counters.colorCounts / sizeof counters.colorCounts[0]; k++)
        count += (size_t)counters.colorCounts[k];
    return count;
}

static void *create_still(struct scene *scene) {
    struct world *world = create_bodies(scene, b2_staticBody);
    b2World_RebuildStaticTree(world->id);
    return world;
}

static size_t cast(void *world, const struct asked *asked, void *out) {
    const b2QueryFilter all = b2DefaultQueryFilter();
    float *fractions = out;
    for (size_t k = 0; k < asked->count; k++) {
        const struct ray *ray = &asked->rays[k];
        const b2RayResult result = b2World_CastRayClosest(((const struct world *)world)->id, (b2Vec2){ray->x, ray->y},
                                                          (b2Vec2){ray->motion_x, ray->motion_y}, all);
        fractions[k] = result.hit ? result.fraction : 2;
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ regions */

static b2AABB box_from(const narc_box *box) { return (b2AABB){{box->min_x, box->min_y}, {box->max_x, box->max_y}}; }

static void *create_tree(struct scene *scene) {
    b2DynamicTree *tree = allocate(1, sizeof *tree);
    *tree = b2DynamicTree_Create(TREE_ROOM(scene->body_count));
    index_scene(scene);
    for (size_t k = 0; k < scene->body_count; k++)
        b2DynamicTree_CreateProxy(tree, box_from(&scene->boxes[k]), 1, k);
    b2DynamicTree_Rebuild(tree, true);
    return tree;
}

struct found {
    uint64_t region, *out;
    size_t count;
};

static bool add_pair(int proxy, uint64_t body, void *context) {
    struct found *found = context;
    (void)proxy;
    found->out[found->count++] = found->region << 32 | body;
    return true;
}

static size_t find_regions(void *tree, const struct asked *asked, void *out) {
    struct found found = {.out = out};
    for (; found.region < asked->count; found.region++)
        b2DynamicTree_Query(tree, box_from(&asked->regions[found.region]), 1, add_pair, &found);
    return found.count;
}

/* ------------------------------------------------------------------------------------------------ times of impact */

static void *create_nothing(struct scene *scene) {
    (void)scene;
    return NULL;
}

static size_t find_impacts(void *context, const struct asked *asked, void *out) {
    const b2Polygon polygon = polygon_of(asked->polygon);
    const b2ShapeProxy proxy = b2MakeProxy(polygon.vertices, polygon.count, 0);
    float *fractions = out;
    (void)context;
    for (size_t k = 0; k < asked->count; k++) {
        b2TOIInput input = {.proxyA = proxy, .proxyB = proxy, .maxFraction = 1};
        for (size_t side = 0; side < 2; side++) {
            const narc_body *body = &asked->bodies[2 * k + side];
            const struct motion *motion = &asked->motions[2 * k + side];
            b2Sweep *sweep = side == 0 ? &input.sweepA : &input.sweepB;
            sweep->c1 = (b2Vec2){(float)body->x, (float)body->y};
            sweep->c2 = (b2Vec2){(float)body->x + motion->x, (float)body->y + motion->y};
            sweep->q1 = (b2Rot){body->cosine, body->sine};
            sweep->q2 = b2MulRot(sweep->q1, b2MakeRot(motion->angle));
        }
        const b2TOIOutput output = b2TimeOfImpact(&input);
        const bool hit = output.state == b2_toiStateHit || output.state == b2_toiStateOverlapped;
        fractions[k] = hit ? output.fraction : 2;
    }
    return 0;
}

const char *box2d_name(void) {
    static char name[32];
    const b2Version version = b2GetVersion();
    snprintf(name, sizeof name, "Box2D %d.%d.%d", version.major, version.minor, version.revision);
    return name;
}

#define BOX2D(query, ...)                                                                                              \
    { .question = query, .name = "box2d", .max_edges = B2_MAX_POLYGON_VERTICES, __VA_ARGS__ }
const struct peer box2d_collide = BOX2D("contact", .capsules = true, .create = create, .ask = collide);
const struct peer box2d_overlap = BOX2D("overlap", .create = create, .ask = overlap);
const struct peer box2d_world = BOX2D("stay", .capsules = true, .own_clock = true, .recycles = RECYCLES,
                                      .create = create_moving, .step = step, .count_touching = count_touching);
const struct peer box2d_rays = BOX2D("ray", .create = create_still, .ask = cast);
const struct peer box2d_regions = BOX2D("region", .create = create_tree, .ask = find_regions);
const struct peer box2d_impacts = BOX2D("impact", .create = create_nothing, .ask = find_impacts);
