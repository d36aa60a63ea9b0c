/* SPDX-License-Identifier: MIT
 *
 * body_frame.inl - one body for one ray or point: its frame in double precision, and the arcs of its shape in lanes.
 *
 * What is asked of a body is brought into its shape's own coordinates in double precision and rounded there once. So it
 * has no error but that, in proportion to the body, however far the world's origin or the ray's start is, and arcs are
 * used as they are stored: nothing is turned or scaled but the question and the answer. The plain doubles below are
 * rounded correctly everywhere, as the lanes' floats are.
 */
#ifndef NARC_SCENE_BODY_FRAME_INL
#define NARC_SCENE_BODY_FRAME_INL

#include <math.h>
#include <stdbool.h>
#include <string.h>

#include "base/shape.inl"
#include "base/vec2.inl"
#include "broken.h"
#include "column.h"
#include "kernels.h"
#include "simd/simd.h"

/* A vector or a point in double precision. */
typedef struct {
    double x, y;
} place;

INLINE double find_least(double a, double b) { return a < b ? a : b; }
INLINE double find_most(double a, double b) { return a > b ? a : b; }
INLINE double find_dot(place a, place b) { return a.x * b.x + a.y * b.y; }
INLINE double find_cross(place a, place b) { return a.x * b.y - a.y * b.x; }
INLINE double find_length(place a) { return sqrt(find_dot(a, a)); }
INLINE place find_back(place a) { return (place){-a.x, -a.y}; }
INLINE place subtract(place a, place b) { return (place){a.x - b.x, a.y - b.y}; }
INLINE place add_scaled(place a, double factor, place b) { return (place){a.x + factor * b.x, a.y + factor * b.y}; }
INLINE place divide(place a, double by) { return (place){a.x / by, a.y / by}; }

/* A point p of the shape stands at position + scale * (rotation p). */
struct body_frame {
    place position, rotation; /* the rotation is a unit vector */
    double scale, inverse_scale;
    const narc_shape_header *header;
    const narc_record *arcs; /* header->count of them */
};

INLINE place find_rotation(float cosine, float sine) {
    const place given = {(double)cosine, (double)sine};
    const double error = find_dot(given, given) - 1, factor = NARC_INVERSE_LENGTH(error);
    return (place){given.x * factor, given.y * factor};
}

/* False for a body that nothing meets: one with broken numbers, or whose shape does not exist. */
INLINE bool load_body_frame(const narc_shapes *shapes, const narc_bodies *bodies, size_t body, struct body_frame *out) {
    const uint32_t shape = narc_index_at(bodies->shape, body);
    if (shape >= shapes->count)
        return false;
    const float cosine = narc_float_at(bodies->cosine, body), sine = narc_float_at(bodies->sine, body);
    const float scale = bodies->scale.base ? narc_float_at(bodies->scale, body) : 1;
    const narc_shape_header *const header = &shapes->headers[shape];
    out->position = (place){narc_position_at(bodies->x, body), narc_position_at(bodies->y, body)};
    out->rotation = find_rotation(cosine, sine);
    out->scale = (double)scale;
    out->inverse_scale = 1 / out->scale;
    out->header = header;
    out->arcs = narc_arcs_of(shapes, header);
    return narc_is_rotation(cosine, sine) && narc_is_size(scale * header->bound_radius);
}

/* Is the shape a piece of a chain, or a half-plane, with this mark (store.h)? */
INLINE bool has_mark_of(const struct body_frame *frame, unsigned mark) {
    return NARC_PIECES && (frame->header->first_arc & NARC_PIECE_MARKS) == mark;
}

/* Of a half-plane the arc, as stored, that its boundary lies before. */
enum { PLANE_ARC = 1 };

/* A direction of the world in the shape's axes, and back. */
INLINE place turn_to_shape(const struct body_frame *frame, place a) {
    return (place){find_dot(frame->rotation, a), find_cross(frame->rotation, a)};
}
INLINE place turn_to_world(const struct body_frame *frame, place a) {
    return (place){frame->rotation.x * a.x - frame->rotation.y * a.y,
                   frame->rotation.y * a.x + frame->rotation.x * a.y};
}

/* A stored arc's centre, and the normals at its ends. */
INLINE place get_center(const narc_stored_arc *arc) { return (place){(double)arc->center_x, (double)arc->center_y}; }
INLINE place get_start(const narc_stored_arc *arc) { return (place){(double)arc->start_x, (double)arc->start_y}; }
INLINE place get_end(const narc_stored_arc *arc) { return (place){(double)arc->end_x, (double)arc->end_y}; }

/* ------------------------------------------------------------------------------------------------ arcs */

/* Arcs of one shape, each in a lane, in its own coordinates. */
struct own_arcs {
    vec2 center;
    vf radius;
    vec2 start, end;
};

/* Arcs that follow each other; lanes behind the last one of a shape have anything (soa/store.c). */
INLINE struct own_arcs load_own_arcs(const narc_record *arcs) {
    _Static_assert(V_WIDTH <= 16, "soa/store.c has room for 16");
    static const int32_t lane[16] = {0, 1, 2, 3, 4, 5, 6, 7, 8, 9, 10, 11, 12, 13, 14, 15};
    vf field[8];
    v_rows(arcs, sizeof *arcs, lane, field);
    v_rows(&arcs->arc.start_x, sizeof *arcs, lane, field + 4);
    return (struct own_arcs){{field[0], field[1]}, field[2], {field[4], field[5]}, {field[6], field[7]}};
}

/* ------------------------------------------------------------------------------------------------ features */

/* The number of a stored arc, or of the edge before it, as a row has it (narc_contact.feature). */
INLINE unsigned find_feature_number(const narc_shape_header *header, int arc, bool is_edge) {
    const unsigned number = (unsigned)arc + (header->first_arc & NARC_FIRST_ARC);
    if (header->flags & NARC_SHAPE_CIRCLE)
        return 0;
    return (number < header->count ? number : number - header->count) + (is_edge ? NARC_FEATURE_EDGE : 0);
}

/* Does what lies between an arc and the one before count as an edge? As in base/contact_point.inl. */
INLINE bool is_edge_before(const struct body_frame *frame, int arc) {
    const narc_shape_header *const header = frame->header;
    const narc_stored_arc *const after = &frame->arcs[arc].arc;
    const narc_stored_arc *const before = &frame->arcs[arc > 0 ? arc - 1 : (int)header->count - 1].arc;
    const float length =
        after->start_x * (after->center_y - before->center_y) - after->start_y * (after->center_x - before->center_x);
    const uint32_t least_bits = (5u * (header->flags >> NARC_SIZE_CLASS_SHIFT) + 127 - 47) << 23; /* store.h */
    float least;
    memcpy(&least, &least_bits, sizeof least);
    const float magnitude =
        0.125f * (fabsf(before->center_x) + fabsf(before->center_y) + fabsf(after->center_x) + fabsf(after->center_y)) +
        before->radius + after->radius;
    return !(header->flags & NARC_SHAPE_SMOOTH) && length > least && length > 0x1p-18f * magnitude;
}

#endif
