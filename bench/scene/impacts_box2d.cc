// SPDX-License-Identifier: MIT
//
// impacts_box2d.cc - times of impact in Box2D: b2TimeOfImpact().
#include "peers.h"

#include <box2d/b2_time_of_impact.h>
#include <box2d/box2d.h>

#include <cmath>

// Polygons keep their skin: without it b2TimeOfImpact() has no target to stop at.
void box2d_find_impacts(const peer_polygon *polygon, const narc_body *bodies, const peer_motion *motions, size_t count,
                        float *out_fractions) {
    b2Vec2 points[b2_maxPolygonVertices];
    for (size_t i = 0; i < polygon->count; i++)
        points[i].Set(polygon->x[i], polygon->y[i]);
    b2PolygonShape shape;
    shape.Set(points, static_cast<int32>(polygon->count));
    for (size_t k = 0; k < count; k++) {
        b2TOIInput input;
        input.proxyA.Set(&shape, 0);
        input.proxyB.Set(&shape, 0);
        input.tMax = 1;
        for (size_t side = 0; side < 2; side++) {
            const narc_body &body = bodies[2 * k + side];
            const peer_motion &motion = motions[2 * k + side];
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
        out_fractions[k] = hit ? output.t : 2;
    }
}
