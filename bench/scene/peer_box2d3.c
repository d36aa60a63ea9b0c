/* SPDX-License-Identifier: MIT
 *
 * peer_box2d3.c - Box2D 3: rays by b2World_CastRayClosest(), regions by b2DynamicTree_Query(), times of impact by
 * b2TimeOfImpact().
 */
#include "box2d3_bodies.h"
#include "common.h"
#include "peers.h"

static void *create(const struct workload *workload) {
    b2WorldId *world = allocate(1, sizeof *world);
    *world = create_box2d_bodies(workload, b2_staticBody);
    b2World_RebuildStaticTree(*world);
    return world;
}

static void cast(void *scene, const struct peer_ray *rays, size_t count, float *out_fractions) {
    const b2QueryFilter all = b2DefaultQueryFilter();
    for (size_t k = 0; k < count; k++) {
        const b2Vec2 from = {rays[k].x, rays[k].y}, way = {rays[k].end_x - rays[k].x, rays[k].end_y - rays[k].y};
        const b2RayResult result = b2World_CastRayClosest(*(const b2WorldId *)scene, from, way, all);
        out_fractions[k] = result.hit ? result.fraction : 2;
    }
}

const char *box2d_name(void) { return name_box2d(); }

const struct scene_peer box2d_scene = {.name = "Box2D", .create = create, .cast = cast};

/* ------------------------------------------------------------------------------------------------ regions */

static void *create_tree(const struct workload *workload, const narc_box *boxes) {
    b2DynamicTree *tree = allocate(1, sizeof *tree);
    *tree = b2DynamicTree_Create();
    for (size_t k = 0; k < workload->body_count; k++)
        b2DynamicTree_CreateProxy(tree, (b2AABB){{boxes[k].min_x, boxes[k].min_y}, {boxes[k].max_x, boxes[k].max_y}}, 1,
                                  k);
    b2DynamicTree_Rebuild(tree, true);
    return tree;
}

struct found {
    uint64_t query, *out;
    size_t count;
};

static bool note(int proxy, uint64_t body, void *context) {
    struct found *found = context;
    (void)proxy;
    found->out[found->count++] = found->query << 32 | body;
    return true;
}

static size_t find(void *tree, const narc_box *regions, size_t count, uint64_t *out_pairs) {
    struct found found = {.out = out_pairs};
    for (size_t k = 0; k < count; k++) {
        found.query = k;
        b2DynamicTree_Query(tree, (b2AABB){{regions[k].min_x, regions[k].min_y}, {regions[k].max_x, regions[k].max_y}},
                            1, note, &found);
    }
    return found.count;
}

const struct region_peer box2d_regions = {"Box2D", create_tree, find};

/* ------------------------------------------------------------------------------------------------ times of impact */

void box2d_find_impacts(const struct peer_polygon *polygon, const narc_body *bodies, const struct peer_motion *motions,
                        size_t count, float *out_fractions) {
    b2Vec2 points[B2_MAX_POLYGON_VERTICES];
    for (size_t i = 0; i < polygon->count; i++)
        points[i] = (b2Vec2){polygon->x[i], polygon->y[i]};
    const b2ShapeProxy proxy = b2MakeProxy(points, (int)polygon->count, 0);
    for (size_t k = 0; k < count; k++) {
        b2TOIInput input = {.proxyA = proxy, .proxyB = proxy, .maxFraction = 1};
        for (size_t side = 0; side < 2; side++) {
            const narc_body *body = &bodies[2 * k + side];
            const struct peer_motion *motion = &motions[2 * k + side];
            b2Sweep *sweep = side == 0 ? &input.sweepA : &input.sweepB;
            sweep->c1 = (b2Vec2){(float)body->x, (float)body->y};
            sweep->c2 = (b2Vec2){(float)body->x + motion->x, (float)body->y + motion->y};
            sweep->q1 = (b2Rot){body->cosine, body->sine};
            sweep->q2 = b2MulRot(sweep->q1, b2MakeRot(motion->angle));
        }
        const b2TOIOutput output = b2TimeOfImpact(&input);
        const bool hit = output.state == b2_toiStateHit || output.state == b2_toiStateOverlapped;
        out_fractions[k] = hit ? output.fraction : 2;
    }
}
