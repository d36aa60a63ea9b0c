/* SPDX-License-Identifier: MIT
 *
 * boxes.inl - the boxes and centroids of two bodies, in A's frame.
 */
#ifndef NARC_METHODS_BOXES_INL
#define NARC_METHODS_BOXES_INL

#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "simd/simd.h"

struct box {
    vec2 center;
    vf half_x, half_y; /* at world scale */
    vec2 axis;         /* the direction of the side half_x, unit */
    vec2 centroid;
};

/* The box of a shape in its own frame; its record lies behind the arcs (methods/method_kernels.h). */
INLINE struct box load_box(const narc_record *records, struct ring ring, vf scale) {
    vf field[8];
    load_records(records, vi_add(ring.base, ring.count), field);
    return (struct box){v2_scale((vec2){field[0], field[1]}, scale),
                        v_mul(field[2], scale),
                        v_mul(field[3], scale),
                        {field[4], field[5]},
                        v2_scale((vec2){field[6], field[7]}, scale)};
}

struct boxes {
    struct box a, b;
};

INLINE struct boxes load_boxes(const narc_shapes *shapes, const vf item[FIELDS]) {
    const vec2 position = {item[POSITION], item[POSITION + 1]}, rotation = {item[ROTATION], item[ROTATION + 1]};
    const struct ring ring_a = make_ring(vi_bits(item[FIRST_RECORD_A]), vi_bits(item[INFO_A]));
    const struct ring ring_b = make_ring(vi_bits(item[FIRST_RECORD_B]), vi_bits(item[INFO_B]));
    struct boxes both = {load_box(shapes->records, ring_a, item[SCALE_A]),
                         load_box(shapes->records, ring_b, item[SCALE_B])};
    both.b.center = v2_add(v2_rotate(rotation, both.b.center), position);
    both.b.axis = v2_rotate(rotation, both.b.axis);
    both.b.centroid = v2_add(v2_rotate(rotation, both.b.centroid), position);
    return both;
}

#endif
