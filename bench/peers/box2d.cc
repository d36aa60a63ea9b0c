// SPDX-License-Identifier: MIT
//
// box2d.cc - Box2D 2.4: contacts and overlaps of two polygons, the collision part of a step, rays, regions, times of
// impact.
#include "peers.h"

#include <box2d/b2_time_of_impact.h>
#include <box2d/box2d.h>

#include <cmath>
#include <cstdio>
#include <vector>

namespace {

b2PolygonShape polygon_of(const outline &given) {
    const bool round = given.count > 2 && given.arcs[0].radius > 0;
    const outline outline = round ? replace_outline(FORM_LARGE, &given) : given;
    b2Vec2 points[b2_maxPolygonVertices];
    for (size_t i = 0; i < outline.count; i++)
        points[i].Set(static_cast<float>(outline.arcs[i].x), static_cast<float>(outline.arcs[i].y));
    b2PolygonShape shape;
    shape.Set(points, static_cast<int32>(outline.count));
    return shape;
}

struct Posed {
    std::vector<b2PolygonShape> shapes;
    std::vector<b2Transform> transforms;
    std::vector<uint32_t> shape; // of a body
};

// Polygons without Box2D's skin of 0.01 around them, so that the answer is the polygon's own.
void *create(scene *scene) {
    auto *posed = new Posed;
    for (size_t k = 0; k < scene->shape_count; k++) {
        posed->shapes.push_back(polygon_of(scene->outlines[k]));
        posed->shapes.back().m_radius = 0;
    }
    for (size_t k = 0; k < scene->body_count; k++) {
        const body &body = scene->bodies[k];
        b2Transform transform;
        transform.p.Set(body.x, body.y);
        transform.q.c = body.cosine;
        transform.q.s = body.sine;
        posed->transforms.push_back(transform);
        posed->shape.push_back(body.shape);
    }
    return posed;
}

size_t collide(void *context, const asked *asked, void *out) {
    const auto &posed = *static_cast<const Posed *>(context);
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        b2Manifold manifold;
        b2CollidePolygons(&manifold, &posed.shapes[posed.shape[a]], posed.transforms[a], &posed.shapes[posed.shape[b]],
                          posed.transforms[b]);
        static_cast<uint8_t *>(out)[k] = manifold.pointCount > 0;
    }
    return 0;
}

size_t overlap(void *context, const asked *asked, void *out) {
    const auto &posed = *static_cast<const Posed *>(context);
    for (size_t k = 0; k < asked->count; k++) {
        const uint32_t a = asked->pairs[k].a, b = asked->pairs[k].b;
        static_cast<uint8_t *>(out)[k] = b2TestOverlap(&posed.shapes[posed.shape[a]], 0, &posed.shapes[posed.shape[b]],
                                                       0, posed.transforms[a], posed.transforms[b]);
    }
    return 0;
}

// ------------------------------------------------------------------------------------------------ worlds

b2World *create_bodies(const scene *scene, b2BodyType type, std::vector<b2Body *> *out = nullptr) {
    auto *world = new b2World(b2Vec2(0, 0));
    for (size_t k = 0; k < scene->body_count; k++) {
        const body &at = scene->bodies[k];
        const outline &outline = scene->outlines[at.shape];
        b2PolygonShape polygon;
        b2CircleShape circle;
        if (outline.count == 1)
            circle.m_radius = static_cast<float>(outline.arcs[0].radius);
        else
            polygon = polygon_of(outline);
        b2BodyDef definition;
        definition.type = type;
        definition.position.Set(at.x, at.y);
        definition.angle = std::atan2(at.sine, at.cosine);
        b2Body *body = world->CreateBody(&definition);
        body->CreateFixture(outline.count == 1 ? static_cast<const b2Shape *>(&circle) : &polygon, 1);
        if (out)
            out->push_back(body);
    }
    return world;
}

// A step of no time does nothing but find new contacts and update the manifolds of all, what b2World::GetProfile() calls
// `collide`. The bodies stay awake.
struct Moving {
    b2World *world;
    std::vector<b2Body *> bodies;
};

void *create_moving(scene *scene) {
    auto *moving = new Moving;
    moving->world = create_bodies(scene, b2_dynamicBody, &moving->bodies);
    moving->world->SetAllowSleeping(false);
    return moving;
}

double step(void *context, const body *bodies, const uint32_t *moved, size_t count, float) {
    const auto &moving = *static_cast<const Moving *>(context);
    for (size_t k = 0; k < count; k++) {
        const body &at = bodies[moved[k]];
        moving.bodies[moved[k]]->SetTransform(b2Vec2(at.x, at.y), std::atan2(at.sine, at.cosine));
    }
    moving.world->Step(0, 0, 0);
    return 0;
}

size_t count_touching(void *context) {
    size_t count = 0;
    for (const b2Contact *contact = static_cast<const Moving *>(context)->world->GetContactList(); contact;
         contact = contact->GetNext())
        count += contact->IsTouching();
    return count;
}

void *create_still(scene *scene) { return create_bodies(scene, b2_staticBody); }

class Nearest : public b2RayCastCallback {
  public:
    float found = 2;
    float ReportFixture(b2Fixture *, const b2Vec2 &, const b2Vec2 &, float fraction) override {
        found = fraction;
        return fraction;
    }
};

size_t cast(void *world, const asked *asked, void *out) {
    for (size_t k = 0; k < asked->count; k++) {
        const ray &ray = asked->rays[k];
        const b2Vec2 from(ray.x, ray.y);
        Nearest nearest;
        static_cast<const b2World *>(world)->RayCast(&nearest, from, from + b2Vec2(ray.motion_x, ray.motion_y));
        static_cast<float *>(out)[k] = nearest.found;
    }
    return 0;
}

// ------------------------------------------------------------------------------------------------ regions

// Writes down the bodies of a region.
struct Found {
    const b2DynamicTree *tree;
    uint64_t region, *out;
    size_t count;
    bool QueryCallback(int32 proxy) {
        out[count++] = region << 32 | reinterpret_cast<uintptr_t>(tree->GetUserData(proxy));
        return true;
    }
};

// The tree makes boxes fatter by b2_aabbExtension, which is taken off before.
void *create_tree(scene *scene) {
    auto *tree = new b2DynamicTree;
    const b2Vec2 fat(b2_aabbExtension, b2_aabbExtension);
    index_scene(scene);
    for (uintptr_t k = 0; k < scene->body_count; k++) {
        b2AABB box;
        box.lowerBound = b2Vec2(scene->boxes[k].min_x, scene->boxes[k].min_y) + fat;
        box.upperBound = b2Vec2(scene->boxes[k].max_x, scene->boxes[k].max_y) - fat;
        tree->CreateProxy(box, reinterpret_cast<void *>(k));
    }
    return tree;
}

size_t find_regions(void *tree, const asked *asked, void *out) {
    Found found = {static_cast<const b2DynamicTree *>(tree), 0, static_cast<uint64_t *>(out), 0};
    for (; found.region < asked->count; found.region++) {
        const narc_box &region = asked->regions[found.region];
        b2AABB box;
        box.lowerBound.Set(region.min_x, region.min_y);
        box.upperBound.Set(region.max_x, region.max_y);
        found.tree->Query(&found, box);
    }
    return found.count;
}

// ------------------------------------------------------------------------------------------------ times of impact

void *create_nothing(scene *) { return nullptr; }

// Polygons keep their skin: without it b2TimeOfImpact() has no target to stop at.
size_t find_impacts(void *, const asked *asked, void *out) {
    const b2PolygonShape shape = polygon_of(*asked->polygon);
    for (size_t k = 0; k < asked->count; k++) {
        b2TOIInput input;
        input.proxyA.Set(&shape, 0);
        input.proxyB.Set(&shape, 0);
        input.tMax = 1;
        for (size_t side = 0; side < 2; side++) {
            const narc_body &body = asked->bodies[2 * k + side];
            const motion &motion = asked->motions[2 * k + side];
            b2Sweep &sweep = side == 0 ? input.sweepA : input.sweepB;
            sweep.localCenter.SetZero();
            sweep.c0.Set(static_cast<float>(body.x), static_cast<float>(body.y));
            sweep.c = sweep.c0 + b2Vec2(motion.x, motion.y);
            sweep.a0 = std::atan2(body.sine, body.cosine);
            sweep.a = sweep.a0 + motion.angle;
            sweep.alpha0 = 0;
        }
        b2TOIOutput output;
        b2TimeOfImpact(&output, &input);
        const bool hit = output.state == b2TOIOutput::e_touching || output.state == b2TOIOutput::e_overlapped;
        static_cast<float *>(out)[k] = hit ? output.t : 2;
    }
    return 0;
}

peer make_peer(const char *question, void *(*create)(scene *), size_t (*ask)(void *, const asked *, void *)) {
    peer peer = {};
    peer.question = question;
    peer.name = "box2d";
    peer.max_edges = b2_maxPolygonVertices;
    peer.create = create;
    peer.ask = ask;
    return peer;
}

peer make_world() {
    peer peer = make_peer("stay", create_moving, nullptr);
    peer.step = step;
    peer.count_touching = count_touching;
    return peer;
}

} // namespace

const char *box2d_name() {
    static char name[32];
    std::snprintf(name, sizeof name, "Box2D %d.%d.%d", b2_version.major, b2_version.minor, b2_version.revision);
    return name;
}

const peer box2d_collide = make_peer("contact", create, collide);
const peer box2d_overlap = make_peer("overlap", create, overlap);
const peer box2d_world = make_world();
const peer box2d_rays = make_peer("ray", create_still, cast);
const peer box2d_regions = make_peer("region", create_tree, find_regions);
const peer box2d_impacts = make_peer("impact", create_nothing, find_impacts);
