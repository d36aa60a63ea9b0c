/* SPDX-License-Identifier: MIT
 *
 * box2d3_bodies.h - the shapes and bodies of a workload in Box2D 3.
 */
#ifndef NARC_BENCH_BOX2D3_BODIES_H
#define NARC_BENCH_BOX2D3_BODIES_H

#include <box2d/box2d.h>

#include <stdio.h>

#include "workload.h"

static inline const char *name_box2d(void) {
    static char name[32];
    const b2Version version = b2GetVersion();
    snprintf(name, sizeof name, "Box2D %d.%d.%d", version.major, version.minor, version.revision);
    return name;
}

static inline b2Polygon make_box2d_polygon(const struct outline *outline) {
    b2Vec2 points[B2_MAX_POLYGON_VERTICES];
    for (size_t i = 0; i < outline->count; i++)
        points[i] = (b2Vec2){(float)outline->arcs[i].x, (float)outline->arcs[i].y};
    const b2Hull hull = b2ComputeHull(points, (int)outline->count);
    return b2MakePolygon(&hull, 0);
}

static inline b2WorldId create_box2d_bodies(const struct workload *workload, b2BodyType type) {
    b2WorldDef room = b2DefaultWorldDef();
    room.gravity = b2Vec2_zero;
    room.enableSleep = false;
    const b2WorldId world = b2CreateWorld(&room);
    const b2ShapeDef matter = b2DefaultShapeDef();
    for (size_t k = 0; k < workload->body_count; k++) {
        const struct body *place = &workload->bodies[k];
        const b2Polygon polygon = make_box2d_polygon(&workload->outlines[place->shape]);
        b2BodyDef body = b2DefaultBodyDef();
        body.type = type;
        body.position = (b2Vec2){place->x, place->y};
        body.rotation = (b2Rot){place->cosine, place->sine};
        b2CreatePolygonShape(b2CreateBody(world, &body), &matter, &polygon);
    }
    return world;
}

#endif
