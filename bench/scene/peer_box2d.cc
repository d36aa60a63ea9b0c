// SPDX-License-Identifier: MIT
//
// peer_box2d.cc - rays in Box2D: b2World::RayCast(), which looks for the nearest hit as its callback says.
#include "peers.h"

#include <box2d/box2d.h>

#include <cmath>

namespace {

void *create(const workload *workload) {
    auto *world = new b2World(b2Vec2(0, 0));
    for (size_t k = 0; k < workload->body_count; k++) {
        const body &place = workload->bodies[k];
        const outline &outline = workload->outlines[place.shape];
        b2Vec2 points[b2_maxPolygonVertices];
        for (size_t i = 0; i < outline.count; i++)
            points[i].Set(static_cast<float>(outline.arcs[i].x), static_cast<float>(outline.arcs[i].y));
        b2PolygonShape shape;
        shape.Set(points, static_cast<int32>(outline.count));
        b2BodyDef definition;
        definition.position.Set(place.x, place.y);
        definition.angle = std::atan2(place.sine, place.cosine);
        world->CreateBody(&definition)->CreateFixture(&shape, 0);
    }
    return world;
}

class Nearest : public b2RayCastCallback {
  public:
    float found = 2;
    float ReportFixture(b2Fixture *, const b2Vec2 &, const b2Vec2 &, float fraction) override {
        found = fraction;
        return fraction;
    }
};

void cast(void *scene, const peer_ray *rays, size_t count, float *out_fractions) {
    const auto *world = static_cast<const b2World *>(scene);
    for (size_t k = 0; k < count; k++) {
        Nearest nearest;
        world->RayCast(&nearest, b2Vec2(rays[k].x, rays[k].y), b2Vec2(rays[k].end_x, rays[k].end_y));
        out_fractions[k] = nearest.found;
    }
}

} // namespace

const scene_peer box2d_scene = {"Box2D", create, cast, nullptr};
