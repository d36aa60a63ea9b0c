// SPDX-License-Identifier: MIT
//
// world_box2d.cc - the collision part of Box2D's step.
//
// A step of no time does nothing else: b2World::Step() finds new contacts and updates the manifolds of all, what
// b2World::GetProfile() calls `collide`, and solves nothing. The bodies stay where they are, and awake.
#include "peers.h"

#include <box2d/box2d.h>

#include <cmath>

namespace {

void *create(const workload *workload) {
    auto *world = new b2World(b2Vec2(0, 0));
    world->SetAllowSleeping(false);
    for (size_t k = 0; k < workload->body_count; k++) {
        const body &place = workload->bodies[k];
        const outline &outline = workload->outlines[place.shape];
        b2Vec2 points[b2_maxPolygonVertices];
        for (size_t i = 0; i < outline.count; i++)
            points[i].Set(static_cast<float>(outline.arcs[i].x), static_cast<float>(outline.arcs[i].y));
        b2PolygonShape shape;
        shape.Set(points, static_cast<int32>(outline.count));
        b2BodyDef definition;
        definition.type = b2_dynamicBody;
        definition.position.Set(place.x, place.y);
        definition.angle = std::atan2(place.sine, place.cosine);
        world->CreateBody(&definition)->CreateFixture(&shape, 1);
    }
    return world;
}

void step(void *world) { static_cast<b2World *>(world)->Step(0, 0, 0); }

size_t count_touching(void *world) {
    size_t count = 0;
    for (const b2Contact *contact = static_cast<b2World *>(world)->GetContactList(); contact;
         contact = contact->GetNext())
        count += contact->IsTouching();
    return count;
}

} // namespace

const world_peer box2d_world = {"box2d-world", nullptr, b2_maxPolygonVertices, create, step, count_touching};
