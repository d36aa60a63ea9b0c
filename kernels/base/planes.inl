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
#include "kernels.h"
#include "simd/simd.h"
#include "store.h"

/* Deeper than that nothing has an answer: the box would be larger than what numbers are kept in range for. */
#define PLANE_DEPTH 1e12

/* Lays the half-planes of the pairs k ... of a block to the bodies. The item has the pose, and gets the infos. Returns
 * which pairs have none, or an answer; of others the pose, and the infos, are then those of the boxes. */
NOINLINE vm lay_planes(const struct call *call, const struct pair_indices *in, int k, vf item[FIELDS], vm *out_ground) {
    const narc_batch *const batch = call->batch;
    const struct headers a = load_headers(batch->shapes->headers, in->shape_a + k),
                         b = load_headers(batch->shapes->headers, in->shape_b + k);
    const vm of_a = is_plane(a.info), of_b = is_plane(b.info), any = vm_or(of_a, of_b);
    const vm none = vm_front(0);
    float height[V_WIDTH];
    *out_ground = vm_and(any, vm_and(vi_lt(vi_set(0), get_marks(a.info)), vi_lt(vi_set(0), get_marks(b.info))));
    item[INFO_A] = v_of_bits(a.info);
    item[INFO_B] = v_of_bits(b.info);
    if (!vm_any(any))
        return vm_not(none);
    const uint32_t plane_is_a = vm_bits(of_a);
    v_store(height, v_set(0));
    for (uint32_t lanes = vm_bits(any); lanes; lanes &= lanes - 1) {
        const int l = FIND_LOWEST(lanes), side = plane_is_a >> l & 1 ? 0 : 1;
        struct plane_pair pair;
        load_plane_pair(batch->a, batch->b, batch->pairs, (uint32_t)in->number[k + l], (uint32_t)in->a[k + l],
                        (uint32_t)in->b[k + l], &pair);
        const double above = pair.cosine[side] * pair.y - pair.sine[side] * pair.x;
        height[l] = (float)(side == 0 ? above : -above);
    }
    const vf zero = v_set(0), h = v_load(height), depth = v_max(v_neg(h), zero);
    const vec2 of_other = v2_select(of_a, b.bound_center, a.bound_center);
    const vf own = v_add(v_add(v_abs(of_other.x), v_abs(of_other.y)), v_select(of_a, b.bound_radius, a.bound_radius));
    const vf reach = v_mul(own, v_select(of_a, item[SCALE_B], item[SCALE_A]));
    const vf size = v_mul(v_set(4), v_add(reach, v_min(v_abs(h), v_set((float)PLANE_DEPTH))));
    const vec2 position = {item[POSITION], item[POSITION + 1]};
    const vec2 seen =
        v2_scale((vec2){item[ROTATION + 1], v_neg(item[ROTATION])}, h); /* B's normal, to the other side */
    set_vec2(item, POSITION, v2_select(of_a, (vec2){zero, h}, v2_select(of_b, seen, position)));
    item[SCALE_A] = v_select(of_a, size, item[SCALE_A]);
    item[SCALE_B] = v_select(of_b, size, item[SCALE_B]);
    const vi plain = vi_set((int32_t) ~(NARC_PIECE_MARKS << 8));
    item[INFO_A] = v_of_bits(vi_select(of_a, vi_and(a.info, plain), a.info));
    item[INFO_B] = v_of_bits(vi_select(of_b, vi_and(b.info, plain), b.info));
    return vm_not(vm_and(any, v_lt(v_set((float)PLANE_DEPTH), depth)));
}

#endif
