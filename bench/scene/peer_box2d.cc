// SPDX-License-Identifier: MIT
//
// peer_box2d.cc - rays in Box2D: b2World::RayCast(), which looks for the nearest hit as its callback says.
#include "peers.h"

#include "box2d_bodies.h"

namespace {

void *create(const workload *workload) { return create_box2d_bodies(workload, b2_staticBody); }

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

const char *box2d_name() { return name_box2d(); }

const scene_peer box2d_scene = {"Box2D", create, cast, nullptr};
