// SPDX-License-Identifier: MIT
//
// world_box2d.cc - the collision part of Box2D's step.
//
// A step of no time does nothing else: b2World::Step() finds new contacts and updates the manifolds of all, what
// b2World::GetProfile() calls `collide`, and solves nothing. The bodies stay where they are, and awake.
#include "box2d_bodies.h"
#include "peers.h"

namespace {

void *create(const workload *workload) {
    b2World *world = create_box2d_bodies(workload, b2_dynamicBody);
    world->SetAllowSleeping(false);
    return world;
}

double step(void *world) {
    static_cast<b2World *>(world)->Step(0, 0, 0);
    return 0;
}

size_t count_touching(void *world) {
    size_t count = 0;
    for (const b2Contact *contact = static_cast<b2World *>(world)->GetContactList(); contact;
         contact = contact->GetNext())
        count += contact->IsTouching();
    return count;
}

} // namespace

const char *box2d_name() { return name_box2d(); }

const world_peer box2d_world = {"box2d-world", nullptr, false, b2_maxPolygonVertices, create, step, count_touching};
