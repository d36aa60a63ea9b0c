/* SPDX-License-Identifier: MIT
 *
 * concave.inl - the concave arc of a chain (store.h) for one ray, point or moving body, in double precision.
 */
#ifndef NARC_SCENE_CONCAVE_INL
#define NARC_SCENE_CONCAVE_INL

#include <math.h>
#include <stdbool.h>

#include "scene/body_frame.inl"

/* From its body's position, in world axes: the centre, and the outward normals at the ends, which point to it. */
struct concave_arc {
    place center, start, end;
    double radius; /* at least 0 */
};

INLINE struct concave_arc place_concave(const struct body_frame *frame) {
    const narc_stored_arc *const arc = &frame->arcs[0].arc;
    const place center = {frame->scale * (double)arc->center_x, frame->scale * (double)arc->center_y};
    return (struct concave_arc){turn_to_world(frame, center), turn_to_world(frame, get_start(arc)),
                                turn_to_world(frame, get_end(arc)), -(frame->scale * (double)arc->radius)};
}

/* Its ends count as its own. */
INLINE bool holds_normal(const struct concave_arc *arc, place normal) {
    return find_cross(arc->start, normal) >= 0 && find_cross(normal, arc->end) >= 0;
}

INLINE place find_middle_normal(const struct concave_arc *arc) {
    const place sum = {arc->start.x + arc->end.x, arc->start.y + arc->end.y};
    return divide(sum, find_length(sum));
}

#endif
