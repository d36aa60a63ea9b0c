// SPDX-License-Identifier: MIT
//
// peer_box2d.cc - Box2D 2: its two tests for a pair of polygons.
#include "peers.h"

#include <box2d/box2d.h>

#include <vector>

namespace {

struct Context {
    std::vector<b2PolygonShape> shapes;
    std::vector<b2Transform> transforms;
    std::vector<uint32_t> shape; // of a body
};

// Polygons without Box2D's skin of 0.01 around them, so that the answer is the polygon's own.
void *create(const workload *workload) {
    auto *context = new Context;
    for (size_t k = 0; k < workload->shape_count; k++) {
        const outline &outline = workload->outlines[k];
        b2Vec2 points[b2_maxPolygonVertices];
        for (size_t i = 0; i < outline.count; i++)
            points[i].Set(static_cast<float>(outline.arcs[i].x), static_cast<float>(outline.arcs[i].y));
        b2PolygonShape shape;
        shape.Set(points, static_cast<int32>(outline.count));
        shape.m_radius = 0;
        context->shapes.push_back(shape);
    }
    for (size_t k = 0; k < workload->body_count; k++) {
        const body &body = workload->bodies[k];
        b2Transform transform;
        transform.p.Set(body.x, body.y);
        transform.q.c = body.cosine;
        transform.q.s = body.sine;
        context->transforms.push_back(transform);
        context->shape.push_back(body.shape);
    }
    return context;
}

void collide(void *argument, const pair *pairs, size_t count, uint8_t *out_colliding) {
    const auto &context = *static_cast<const Context *>(argument);
    for (size_t k = 0; k < count; k++) {
        const uint32_t a = pairs[k].a, b = pairs[k].b;
        b2Manifold manifold;
        b2CollidePolygons(&manifold, &context.shapes[context.shape[a]], context.transforms[a],
                          &context.shapes[context.shape[b]], context.transforms[b]);
        out_colliding[k] = manifold.pointCount > 0;
    }
}

void overlap(void *argument, const pair *pairs, size_t count, uint8_t *out_colliding) {
    const auto &context = *static_cast<const Context *>(argument);
    for (size_t k = 0; k < count; k++) {
        const uint32_t a = pairs[k].a, b = pairs[k].b;
        out_colliding[k] = b2TestOverlap(&context.shapes[context.shape[a]], 0, &context.shapes[context.shape[b]], 0,
                                         context.transforms[a], context.transforms[b]);
    }
}

} // namespace

const peer box2d_collide = {"box2d-collide", "contact", nullptr, true, false, b2_maxPolygonVertices, create, collide};
const peer box2d_overlap = {"box2d-overlap", "overlap", nullptr, true, false, b2_maxPolygonVertices, create, overlap};
