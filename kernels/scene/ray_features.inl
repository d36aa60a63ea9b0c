/* SPDX-License-Identifier: MIT
 *
 * ray_features.inl - a ray, the feature of a shape that it meets, and what rows say of that.
 */
#ifndef NARC_SCENE_RAY_FEATURES_INL
#define NARC_SCENE_RAY_FEATURES_INL

#include <math.h>
#include <stdbool.h>
#include <stdint.h>

#include "kernels.h"
#include "scene/body_frame.inl"

/* A ray in the world. */
struct ray {
    place origin, direction; /* the latter a unit vector */
    double length;           /* of its motion */
    double inverse_length;
};

/* How near counts as met, relative to what the extent is at most, which is less than twice the extent. With what s is off
 * by, some 6 e of the extent, it stays below NARC_ERROR_BOUND. */
#define TOUCH (12.0 / 16777216.0)

/* Of pieces nothing: they overlap, and what closes a run behind may be nearer to the middle than its front. An extent
 * that is not known counts as the radius. */
INLINE double find_touch(const narc_shape_header *header) {
    const double ratio = header->extent_ratio < UINT8_MAX ? (double)header->extent_ratio : 1;
    return narc_is_piece(header) ? 0 : TOUCH * ratio * (double)header->bound_radius;
}

/* The place on a ray's line, behind the foot, where it enters. */
struct entry {
    double along;
    place normal; /* of the outline, unit */
    int arc;      /* the feature: this arc or, `on_edge`, what lies between the one before and it */
    bool on_edge;
};

/* What a row says of the feature. */
INLINE void put_feature(const struct body_frame *frame, const struct entry *entry, narc_ray_hit *out) {
    const bool is_edge = entry->on_edge && is_edge_before(frame, entry->arc);
    out->feature = (uint16_t)find_feature_number(frame->header, entry->arc, is_edge);
    out->radius = is_edge ? INFINITY : (float)((double)frame->arcs[entry->arc].arc.radius * frame->scale);
}

#endif
