/* SPDX-License-Identifier: MIT
 *
 * planes.inl - pairs with a half-plane (store.h): a box in its place.
 *
 * A half-plane stays what it is if it is moved along its boundary, or scaled about a place of that. So the boundary's
 * foot of the other body's position becomes the half-plane's, and the box that is stored gets a scale with which its other
 * sides say nothing. Let R be how far the other body reaches from its position, h the height of that above the
 * boundary. Along the boundary's normal the gap is h - R or more; along the other sides' normals, and all between them, it
 * is R - s or less beside a box of half the width s, and R - h - s below one of the height s. With s = 4 (R + |h|) neither
 * is ever the largest, no corner is where they are nearest, and what the other body touches is an edge.
 *   All else takes the pair for one with a box as large as the other body. The height is found in double precision, so
 * that nothing is lost however far away along the boundary the half-plane's position is.
 */
#ifndef NARC_BASE_PLANES_INL
#define NARC_BASE_PLANES_INL

#include <stdint.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/plane_pairs.inl"
#include "base/queue.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "broken.h"
#include "kernels.h"
#include "simd/doubles.h"
#include "simd/simd.h"
#include "store.h"

/* Deeper than that nothing has an answer: the box would be larger than what numbers are kept in range for. */
#define PLANE_DEPTH 1e12

/* How high the other body's position is above the boundary: in lanes `of_a` A is the half-plane, in others B. */
INLINE vf find_heights(const struct call *call, const struct pair_indices *in, int k, vm of_a) {
    const narc_bodies *const a = call->batch->a, *const b = call->batch->b;
    const narc_pairs *const pairs = call->batch->pairs;
    double x[V_WIDTH], y[V_WIDTH];
    float cosine[V_WIDTH], sine[V_WIDTH], height[V_WIDTH];
    load_ways(a, b, pairs, in, k, x, y);
    vec2 rotation = {load_column(b->cosine, in->b + k), load_column(b->sine, in->b + k)};
    if (vm_any(of_a)) {
        const vec2 of = {load_column(a->cosine, in->a + k), load_column(a->sine, in->a + k)};
        rotation = v2_select(of_a, of, rotation);
        if (call->planes_first)
            *call->planes_first = true;
    }
    v_store(cosine, rotation.x);
    v_store(sine, rotation.y);
    for (int l = 0; l < V_WIDTH; l += D_WIDTH) {
        const vd c = d_of_floats(cosine + l), s = d_of_floats(sine + l), error = c * c + s * s - 1.0;
        const vd factor = NARC_INVERSE_LENGTH(error);
        d_put_floats(height + l, c * factor * d_load(y + l) - s * factor * d_load(x + l));
    }
    const vf above = v_load(height);
    return v_select(of_a, above, v_neg(above));
}

/* A half-plane that is laid to the other body: B's position in A's frame, how high the other body's is above the boundary, and
 * the box's scale. */
struct laid_plane {
    vec2 position;
    vf height, size;
    vm known; /* it is not too deep */
};

/* `rotation`: of B. The circle is that around the other body, with its scale. */
INLINE struct laid_plane lay_plane(const struct call *call, const struct pair_indices *in, int k, vm of_a,
                                   vec2 rotation, vec2 center, vf radius, vf scale) {
    const vf zero = v_set(0), most = v_set((float)PLANE_DEPTH), h = find_heights(call, in, k, of_a);
    const vf reach = v_mul(v_add(v_add(v_abs(center.x), v_abs(center.y)), radius), scale);
    const vec2 seen = v2_scale((vec2){rotation.y, v_neg(rotation.x)}, h); /* B's normal, to the other side */
    return (struct laid_plane){v2_select(of_a, (vec2){zero, h}, seen), h,
                               v_mul(v_set(4), v_add(reach, v_min(v_abs(h), most))),
                               vm_not(v_lt(most, v_max(v_neg(h), zero)))};
}

/* Lays the half-planes of the pairs k ... of a block to the bodies. The item has the pose, and gets the infos. Returns
 * which pairs have none, or an answer; of others the pose, and the infos, are then those of the boxes. */
NOINLINE vm lay_planes(const struct call *call, const struct pair_indices *in, int k, vf item[FIELDS], vm *out_ground) {
    const narc_batch *const batch = call->batch;
    const struct headers a = load_headers(batch->shapes->headers, in->shape_a + k),
                         b = load_headers(batch->shapes->headers, in->shape_b + k);
    const vm of_a = is_plane(a.info), of_b = is_plane(b.info), any = vm_or(of_a, of_b);
    *out_ground = vm_and(any, vm_and(vi_lt(vi_set(0), get_marks(a.info)), vi_lt(vi_set(0), get_marks(b.info))));
    item[INFO_A] = v_of_bits(a.info);
    item[INFO_B] = v_of_bits(b.info);
    if (!vm_any(any))
        return vm_not(any);
    const vec2 rotation = {item[ROTATION], item[ROTATION + 1]};
    const struct laid_plane laid =
        lay_plane(call, in, k, of_a, rotation, v2_select(of_a, b.bound_center, a.bound_center),
                  v_select(of_a, b.bound_radius, a.bound_radius), v_select(of_a, item[SCALE_B], item[SCALE_A]));
    const vec2 position = {item[POSITION], item[POSITION + 1]};
    const vi plain = vi_set((int32_t) ~(NARC_PIECE_MARKS << 8));
    set_vec2(item, POSITION, v2_select(any, laid.position, position));
    item[SCALE_A] = v_select(of_a, laid.size, item[SCALE_A]);
    item[SCALE_B] = v_select(of_b, laid.size, item[SCALE_B]);
    item[INFO_A] = v_of_bits(vi_select(of_a, vi_and(a.info, plain), a.info));
    item[INFO_B] = v_of_bits(vi_select(of_b, vi_and(b.info, plain), b.info));
    return vm_or(laid.known, vm_not(any));
}

#endif
