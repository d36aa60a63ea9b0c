/* SPDX-License-Identifier: MIT
 *
 * box2d.c - Box2D 3: manifolds of two shapes, distance of two polygons, the collision part of a step, rays by
 * b2World_CastRayClosest(), regions by b2DynamicTree_Query(), casts by b2ShapeCast() and b2TimeOfImpact(); rays and
 * points of one polygon each, hulls.
 */
#include <box2d/box2d.h>
#include <box2d/constants.h>

#include <stdio.h>
#include <stdlib.h>

#include "common.h"
#include "peers.h"

/* A polygon whose corners all have one radius is Box2D's own; n-arcs have the polygon that is as large. */
static b2Polygon polygon_from(const struct outline *given) {
    const double radius = given->arcs[0].radius;
    const bool n_arc = radius > 0 && given->arcs[1].radius != radius;
    const struct outline large = n_arc ? polygon_of(given, true) : *given, *const outline = &large;
    b2Vec2 points[B2_MAX_POLYGON_VERTICES] = {{0, 0}};
    for (size_t i = 0; i < outline->count; i++)
        points[i] = (b2Vec2){(float)outline->arcs[i].x, (float)outline->arcs[i].y};
    const b2Hull hull = b2ComputeHull(points, (int)outline->count);
    return b2MakePolygon(&hull, n_arc ? 0 : (float)radius);
}

enum type { CIRCLE, CAPSULE, POLYGON };

struct shape {
    enum type type;
    union {
        b2Circle circle;
        b2Capsule capsule;
        b2Polygon polygon;
    } as;
};

static struct shape shape_of(const struct outline *outline) {
    const struct arc *arcs = outline->arcs;
    const b2Vec2 first = {(float)arcs[0].x, (float)arcs[0].y}, second = {(float)arcs[1].x, (float)arcs[1].y};
    const float radius = (float)arcs[0].radius;
    if (outline->count == 1)
        return (struct shape){CIRCLE, {.circle = {first, radius}}};
    if (outline->count == 2)
        return (struct shape){CAPSULE, {.capsule = {first, second, radius}}};
    return (struct shape){POLYGON, {.polygon = polygon_from(outline)}};
}

struct posed {
    struct shape *shapes;
    b2Transform *transforms;
    uint32_t *shape; /* of a body */
};

static void *create(struct scene *scene) {
    struct posed *posed = allocate(1, sizeof *posed);
    posed->shapes = allocate(scene->shape_count, sizeof *posed->shapes);
    posed->transforms = allocate(scene->body_count, sizeof *posed->transforms);
    posed->shape = allocate(scene->body_count, sizeof *posed->shape);
    for (size_t k = 0; k < scene->shape_count; k++)
        posed->shapes[k] = shape_of(&scene->outlines[k]);
    for (size_t k = 0; k < scene->body_count; k++) {
        const struct body *body = &scene->bodies[k];
        posed->transforms[k] = (b2Transform){{body->x, body->y}, {body->cosine, body->sine}};
        posed->shape[k] = body->shape;
    }
    return posed;
}

/* Points that are within b2_speculativeDistance of touching are told as well. */
static bool touches(const b2LocalManifold *manifold) {
    return (manifold->pointCount > 0 && manifold->points[0].separation < 0) ||
           (manifold->pointCount > 1 && manifold->points[1].separation < 0);
}

/* The first one's type is not below the second's, as in its worlds. */
static b2LocalManifold collide_shapes(const struct shape *a, const struct shape *b, b2Transform at_a,
                                      b2Transform at_b) {
    if (a->type < b->type)
        return collide_shapes(b, a, at_b, at_a);
    const b2Transform at = b2InvMulTransforms(at_a, at_b);
    switch (3 * (int)a->type + (int)b->type) {
    case 3 * CIRCLE + CIRCLE:
        return b2CollideCircles(&a->as.circle, &b->as.circle, at);
    case 3 * CAPSULE + CIRCLE:
        return b2CollideCapsuleAndCircle(&a->as.capsule, &b->as.circle, at);
    case 3 * CAPSULE + CAPSULE:
        return b2CollideCapsules(&a->as.capsule, &b->as.capsule, at);
    case 3 * POLYGON + CIRCLE:
        return b2CollidePolygonAndCircle(&a->as.polygon, &b->as.circle, at);
    case 3 * POLYGON + CAPSULE:
        return b2CollidePolygonAndCapsule(&a->as.polygon, &b->as.capsule, at);
    default:
        return b2CollidePolygons(&a->as.polygon, &b->as.polygon, at);
    }
}

static size_t collide(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        const b2LocalManifold manifold =
            collide_shapes(&posed->shapes[posed->shape[a]], &posed->shapes[posed->shape[b]], posed->transforms[a],
                           posed->transforms[b]);
        colliding[k] = touches(&manifold);
    }
    return 0;
}

static b2ShapeProxy proxy_of(const b2Polygon *polygon) { return b2MakeProxy(polygon->vertices, polygon->count, 0); }

static size_t overlap(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        const b2DistanceInput input = {.proxyA = proxy_of(&posed->shapes[posed->shape[a]].as.polygon),
                                       .proxyB = proxy_of(&posed->shapes[posed->shape[b]].as.polygon),
                                       .transform = b2InvMulTransforms(posed->transforms[a], posed->transforms[b])};
        b2SimplexCache cache = {0};
        colliding[k] = b2ShapeDistance(&input, &cache, NULL, 0).distance == 0;
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ worlds */

struct world {
    b2WorldId id;
    b2BodyId *bodies;
    b2ChainSegment *segments; /* of the ground */
    struct shape shape;       /* of all on it */
    const struct body *at;
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
        const struct shape shape = shape_of(&scene->outlines[at->shape]);
        b2BodyDef body = b2DefaultBodyDef();
        body.type = type;
        body.position = (b2Vec2){at->x, at->y};
        body.rotation = (b2Rot){at->cosine, at->sine};
        world->bodies[k] = b2CreateBody(world->id, &body);
        if (shape.type == CIRCLE)
            b2CreateCircleShape(world->bodies[k], &matter, &shape.as.circle);
        else if (shape.type == CAPSULE)
            b2CreateCapsuleShape(world->bodies[k], &matter, &shape.as.capsule);
        else
            b2CreatePolygonShape(world->bodies[k], &matter, &shape.as.polygon);
    }
    if (scene->ground_count > 0) {
        b2Vec2 *points = allocate(scene->ground_count, sizeof *points);
        for (size_t k = 0; k < scene->ground_count; k++)
            points[k] = (b2Vec2){(float)scene->ground[k].x, (float)scene->ground[k].y};
        world->segments = allocate(scene->ground_count, sizeof *world->segments);
        for (size_t k = 1; k + 2 < scene->ground_count; k++)
            world->segments[k] = (b2ChainSegment){
                .ghost1 = points[k - 1], .segment = {points[k], points[k + 1]}, .ghost2 = points[k + 2]};
        world->shape = shape_of(scene->outlines);
        world->at = scene->bodies;
        const b2BodyDef still = b2DefaultBodyDef();
        b2ChainDef chain = b2DefaultChainDef();
        chain.points = points;
        chain.count = (int)scene->ground_count;
        b2CreateChain(b2CreateBody(world->id, &still), &chain);
        free(points);
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
    b2World_SetContactRecycleDistance(world->id, recycling);
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

static size_t collide_ground(void *context, const struct asked *asked, void *out) {
    const struct world *world = context;
    uint8_t *colliding = out;
    for (size_t k = 0; k < asked->count; k++) {
        const b2ChainSegment *segment = &world->segments[asked->pairs[k].a];
        const struct body *body = &world->at[asked->pairs[k].b];
        const b2Transform at = {{body->x, body->y}, {body->cosine, body->sine}};
        b2SimplexCache cache = {0};
        const b2LocalManifold manifold =
            world->shape.type == CIRCLE
                ? b2CollideChainSegmentAndCircle(segment, &world->shape.as.circle, at)
                : b2CollideChainSegmentAndPolygon(segment, &world->shape.as.polygon, at, &cache);
        colliding[k] = manifold.pointCount > 0;
    }
    return 0;
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

struct tree {
    b2DynamicTree tree;
    int *proxies; /* of bodies */
};

static void *create_tree(struct scene *scene) {
    struct tree *t = allocate(1, sizeof *t);
    t->tree = b2DynamicTree_Create((int)scene->body_count);
    t->proxies = allocate(scene->body_count, sizeof *t->proxies);
    index_scene(scene);
    for (size_t k = 0; k < scene->body_count; k++)
        t->proxies[k] = b2DynamicTree_CreateProxy(&t->tree, box_from(&scene->boxes[k]), 1, k);
    b2DynamicTree_Rebuild(&t->tree, true);
    return t;
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
        b2DynamicTree_Query(&((struct tree *)tree)->tree, box_from(&asked->regions[found.region]), 1, add_pair, &found);
    return found.count;
}

static size_t move_proxies(void *context, const struct asked *asked, void *out) {
    struct tree *t = context;
    (void)out;
    for (size_t k = 0; k < asked->count; k++)
        b2DynamicTree_MoveProxy(&t->tree, t->proxies[asked->moved[k]], box_from(&asked->regions[asked->moved[k]]));
    return 0;
}

/* ------------------------------------------------------------------------------------------------ of one body each */

static size_t cast_at_named(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    float *fractions = out;
    for (size_t k = 0; k < asked->count; k++) {
        const struct ray *ray = &asked->rays[k];
        const b2Transform at = posed->transforms[asked->named[k]];
        const b2RayCastInput input = {b2InvTransformPoint(at, (b2Vec2){ray->x, ray->y}),
                                      b2InvRotateVector(at.q, (b2Vec2){ray->motion_x, ray->motion_y}), 1};
        const b2CastOutput hit = b2RayCastPolygon(&posed->shapes[posed->shape[asked->named[k]]].as.polygon, &input);
        fractions[k] = hit.hit ? hit.fraction : 2;
    }
    return 0;
}

static size_t find_distances(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    float *distances = out;
    for (size_t k = 0; k < asked->count; k++) {
        const b2Transform at = posed->transforms[asked->named[k]];
        const b2Vec2 point = {asked->rays[k].x, asked->rays[k].y};
        const b2DistanceInput input = {.proxyA = proxy_of(&posed->shapes[posed->shape[asked->named[k]]].as.polygon),
                                       .proxyB = b2MakeProxy(&(b2Vec2){0, 0}, 1, 0),
                                       .transform = {b2InvTransformPoint(at, point), b2Rot_identity}};
        b2SimplexCache cache = {0};
        distances[k] = b2ShapeDistance(&input, &cache, NULL, 0).distance;
    }
    return 0;
}

static size_t find_inside(void *context, const struct asked *asked, void *out) {
    const struct posed *posed = context;
    float *inside = out;
    for (size_t k = 0; k < asked->count; k++) {
        const b2Transform at = posed->transforms[asked->named[k]];
        const b2Vec2 point = b2InvTransformPoint(at, (b2Vec2){asked->rays[k].x, asked->rays[k].y});
        inside[k] = b2PointInPolygon(&posed->shapes[posed->shape[asked->named[k]]].as.polygon, point);
    }
    return 0;
}

/* ------------------------------------------------------------------------------------------------ times of impact */

static void *create_nothing(struct scene *scene) {
    (void)scene;
    return NULL;
}

static size_t find_impacts(void *context, const struct asked *asked, void *out) {
    const b2Polygon polygon = polygon_from(asked->polygon);
    const b2ShapeProxy proxy = proxy_of(&polygon);
    float *fractions = out;
    (void)context;
    for (size_t k = 0; k < asked->count; k++) {
        if (asked->straight) {
            const narc_body *a = &asked->bodies[2 * k], *b = a + 1;
            const narc_motion *of_a = &asked->motions[2 * k], *of_b = of_a + 1;
            const b2Transform at_a = {{(float)a->x, (float)a->y}, {a->cosine, a->sine}};
            const b2Transform at_b = {{(float)b->x, (float)b->y}, {b->cosine, b->sine}};
            const b2ShapeCastPairInput input = {
                .proxyA = proxy,
                .proxyB = proxy,
                .transform = b2InvMulTransforms(at_a, at_b),
                .translationB = b2InvRotateVector(at_a.q, (b2Vec2){of_b->x - of_a->x, of_b->y - of_a->y}),
                .maxFraction = 1};
            const b2CastOutput output = b2ShapeCast(&input);
            fractions[k] = output.hit ? output.fraction : 2;
            continue;
        }
        b2TOIInput input = {.proxyA = proxy, .proxyB = proxy, .maxFraction = 1};
        for (size_t side = 0; side < 2; side++) {
            const narc_body *body = &asked->bodies[2 * k + side];
            const narc_motion *motion = &asked->motions[2 * k + side];
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

static size_t find_hulls(void *context, const struct asked *asked, void *out) {
    uint8_t *corners = out;
    (void)context;
    for (size_t k = 0; k < asked->count; k++) {
        b2Vec2 points[B2_MAX_POLYGON_VERTICES];
        for (size_t i = 0; i < asked->cloud_size; i++)
            points[i] =
                (b2Vec2){asked->cloud[k * asked->cloud_size + i][0], asked->cloud[k * asked->cloud_size + i][1]};
        corners[k] = (uint8_t)b2ComputeHull(points, (int)asked->cloud_size).count;
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
const struct peer box2d_collide = BOX2D("contact", .create = create, .ask = collide);
const struct peer box2d_overlap = BOX2D("overlap", .create = create, .ask = overlap);
const struct peer box2d_world =
    BOX2D("stay", .own_clock = true, .create = create_moving, .step = step, .count_touching = count_touching);
const struct peer box2d_ground = BOX2D("ground", .own_clock = true, .create = create_moving, .ask = collide_ground,
                                       .step = step, .count_touching = count_touching);
const struct peer box2d_rays = BOX2D("ray", .create = create_still, .ask = cast);
const struct peer box2d_regions = BOX2D("region", .create = create_tree, .ask = find_regions);
const struct peer box2d_moves = BOX2D("move", .create = create_tree, .ask = move_proxies);
const struct peer box2d_impacts = BOX2D("impact", .create = create_nothing, .ask = find_impacts);
const struct peer box2d_named = BOX2D("named", .create = create, .ask = cast_at_named);
const struct peer box2d_distances = BOX2D("distance", .create = create, .ask = find_distances);
const struct peer box2d_inside = BOX2D("inside", .create = create, .ask = find_inside);
const struct peer box2d_hulls = BOX2D("hull", .create = create_nothing, .ask = find_hulls);
