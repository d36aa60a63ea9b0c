// SPDX-License-Identifier: MIT
//
// box2d_bodies.h - the bodies of a workload in a world of Box2D 2.
#ifndef NARC_BENCH_BOX2D_BODIES_H
#define NARC_BENCH_BOX2D_BODIES_H

#include <box2d/box2d.h>

#include <cmath>
#include <cstdio>

#include "workload.h"

inline const char *name_box2d() {
    static char name[32];
    std::snprintf(name, sizeof name, "Box2D %d.%d.%d", b2_version.major, b2_version.minor, b2_version.revision);
    return name;
}

inline b2World *create_box2d_bodies(const workload *workload, b2BodyType type) {
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
        definition.type = type;
        definition.position.Set(place.x, place.y);
        definition.angle = std::atan2(place.sine, place.cosine);
        world->CreateBody(&definition)->CreateFixture(&shape, 1);
    }
    return world;
}

#endif
