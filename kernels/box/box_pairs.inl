/* SPDX-License-Identifier: MIT
 *
 * box_pairs.inl - pairs of two boxes, sharp or rounded (store.h, narc_box_form): set-up, and the queue in which those
 * that are not apart wait for box_contact.inl. Of a shape 16 bytes are read, no header and no arc.
 *
 * Corner i of a box is the arc in its record i, with the normals from that of edge i, where it starts, to that of edge
 * i + 1: edge 0 lies at +x, edge 1 at +y, edge 2 at -x, edge 3 at -y.
 *
 * Equal radii only take their sum from the gap g of the sharp boxes (normal_fan.inl). Its junctions are the normals of
 * four edges of A and the negated ones of four edges of B, and there g is a sum of half sizes, which needs no corner.
 * The largest of the eight values and the junction of the other box nearest to it, at most half a right angle away,
 * name an edge of A and one of B that face each other. These two junctions follow each other in the walk around the
 * fan, and box_contact.inl looks at nothing but them and the three intervals beside them.
 *
 * Is the formula's answer there, for certain? Yes if `best`, the largest value, exceeds two slacks, or exceeds those of
 * the six other junctions by two slacks; and if every half size exceeds two slacks, so that at each junction the slope
 * of g drops by four or more. docs/algorithm.md, section 9, proves it. Other pairs are walked around all of the fan
 * (box_walk.c), and boxes with a side that short are left to the other stages, as are those whose size may be out of
 * range. Apart: if best exceeds the radii, the margin and one slack (certificates.inl, 1). Colliding: if best is below
 * minus a slack, as a corner faces a corner only where sharp boxes are apart.
 */
#ifndef NARC_BOX_BOX_PAIRS_INL
#define NARC_BOX_BOX_PAIRS_INL

#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/question.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* The fields of a pair of boxes. */
enum {
    BOX_POSITION, /* B's pose in A's frame */
    BOX_ROTATION = 2,
    BOX_ROTATION_A = 4, /* A's rotation in the world */
    BOX_HALF_A = 6,     /* the half sizes of A, scaled */
    BOX_SCALE_B = 8,
    BOX_RADIUS_A, /* scaled */
    BOX_RADIUS_B,
    BOX_CODE,      /* bits: edge of A 0-1, edge of B 2-3, first arcs 4-5 and 6-7, BOX_TIE 8 */
    BOX_PAIR,      /* counted from the first of the call */
    CIRCLE_FIELDS, /* what pairs with a circle have (circles.inl) */
    BOX_SLACK = CIRCLE_FIELDS,
    BOX_HALF_B, /* those of B, not scaled: its corners are turned first */
    BOX_FIELDS = BOX_HALF_B + 2
};

enum { BOX_TIE = 1 << 8 };

/* They wait until there are so many; take_boxes() writes up to a vector behind the last one. */
#ifdef NARC_ONE_PAIR
enum { BOX_FLUSH = 1 };
#else
enum { BOX_FLUSH = 32 };
#endif
enum { BOX_CAPACITY = BLOCK == 1 ? 1 : BOX_FLUSH + V_WIDTH };

struct box_queue {
    _Alignas(64) float item[BOX_FIELDS][BOX_CAPACITY];
    int count;
    box_stage *answer;
};

/* Appends the lanes `keep` of `item`. */
INLINE void push_boxes(struct box_queue *queue, vm keep, const vf *item, int fields) {
    const vp packing = vm_packing(keep);
    UNROLL
    for (int f = 0; f < fields; f++)
        v_store(queue->item[f] + queue->count, v_pack(packing, item[f]));
    queue->count += COUNT_BITS(vm_bits(keep));
}

/* Takes as many whole vectors as there are, from the front so that the order stays; at the `end` all. */
INLINE void run_boxes(const struct call *call, struct box_queue *queue, bool end) {
    int k = 0;
    for (int f = 0; f < BOX_FIELDS && end; f++)
        v_store(queue->item[f] + queue->count, v_set(0));
    for (; end ? k < queue->count : k + V_WIDTH <= queue->count; k += V_WIDTH)
        queue->answer(call, queue, k, queue->count - k < V_WIDTH ? queue->count - k : V_WIDTH);
    for (int f = 0; f < BOX_FIELDS && k < queue->count; f++)
        v_store(queue->item[f], v_load(queue->item[f] + k));
    queue->count = k < queue->count ? queue->count - k : 0;
}

/* Is a box of about this size in range, for certain? The bounding radius is between 0.7 and 1.001 times the sum. */
INLINE vm is_box_in_range(vf size) {
    return vm_and(v_le(v_set(2 * (float)NARC_MIN_SIZE), size), v_le(size, v_set(0.5f * (float)NARC_MAX_SIZE)));
}

/* The number of an edge: on the x axis or on the y axis, at its negative end or not. */
INLINE vi find_edge_number(vm on_x, vm negative) {
    return vi_add(vi_select(on_x, vi_set(0), vi_set(1)), vi_select(negative, vi_set(2), vi_set(0)));
}

/* The first arcs, as BOX_CODE has them. */
INLINE vi find_first_arcs(const struct box_form *a, const struct box_form *b) {
    return vi_add(vi_shift_left(vi_and(a->info, vi_set(3)), 4), vi_shift_left(vi_and(b->info, vi_set(3)), 6));
}

/* Are both shapes of that kind? */
INLINE vm are_forms(const struct box_form *a, const struct box_form *b, uint32_t kind) {
    return vi_lt(vi_set(0), vi_and(vi_and(a->info, b->info), vi_set((int32_t)kind)));
}

/* Takes pairs of two boxes, in the lanes `which`: puts those that may have a contact into the queue. Returns the lanes
 * that it took. */
INLINE vm take_boxes(const struct call *call, const struct box_form *a, const struct box_form *b,
                     const struct placement *placement, vm which, int32_t number, struct box_queue *queue) {
    const struct pose *pose = &placement->pose;
    const vec2 t = pose->position, q = pose->rotation;
    const vf zero = v_set(0);
    const vec2 half_a = v2_scale(a->half, pose->scale_a), half_b = v2_scale(b->half, pose->scale_b);
    const vf radius_a = v_mul(a->radius, pose->scale_a), radius_b = v_mul(b->radius, pose->scale_b);
    const vf radii = v_add(radius_a, radius_b);
    const vf size_a = v_add(v_add(half_a.x, half_a.y), radius_a), size_b = v_add(v_add(half_b.x, half_b.y), radius_b);

    /* g along the axes of A, on the side of B's centre, and along those of B that are nearer to A's x or y axis. */
    const vf c = v_abs(q.x), s = v_abs(q.y), x = v_abs(t.x), y = v_abs(t.y);
    const vec2 t_b = v2_unrotate(q, t);
    const vf a_x = v_sub(v_sub(x, half_a.x), v_add(v_mul(c, half_b.x), v_mul(s, half_b.y)));
    const vf a_y = v_sub(v_sub(y, half_a.y), v_add(v_mul(s, half_b.x), v_mul(c, half_b.y)));
    const vf b_x = v_sub(v_sub(v_abs(t_b.x), half_b.x), v_add(v_mul(c, half_a.x), v_mul(s, half_a.y)));
    const vf b_y = v_sub(v_sub(v_abs(t_b.y), half_b.y), v_add(v_mul(s, half_a.x), v_mul(c, half_a.y)));
    const vm crossed = v_lt(c, s);
    const vf near_x = v_select(crossed, b_y, b_x), near_y = v_select(crossed, b_x, b_y);
    const vf along_x = v_max(a_x, near_x), along_y = v_max(a_y, near_y), best = v_max(along_x, along_y);

    const vf slack = v_mul(v_set(0x1p-17f), v_add(v_add(x, y), v_add(size_a, size_b))), two = v_add(slack, slack);
    const vf least = v_min(v_min(half_a.x, half_a.y), v_min(half_b.x, half_b.y));
    const vm sizes = vm_and(is_box_in_range(size_a), is_box_in_range(size_b));
    const vm taken = vm_and(which, vm_and(sizes, v_lt(two, least)));
    vm near = vm_and_not(taken, v_lt(v_add(placement->margin, slack), v_sub(best, radii)));
    if (call->bits) { /* nothing but overlaps is asked for */
        const vm deep = vm_and(near, v_lt(best, v_neg(slack)));
        call->bits[(uint32_t)number / 64] |= (uint64_t)vm_bits(deep) << (uint32_t)number % 64;
        near = vm_and_not(near, deep);
    }
    if (vm_any(near)) {
        /* The edges, and on which side: as the better of the two values has it. */
        const vm a_on_x = v_le(along_y, along_x), b_on_x = vm_xor(a_on_x, crossed);
        const vf value_a = v_select(a_on_x, a_x, a_y), value_b = v_select(a_on_x, near_x, near_y);
        const vf across_a = v_select(a_on_x, t.x, t.y), across_b = v_select(b_on_x, t_b.x, t_b.y);
        const vf cosine = v_select(crossed, v_select(a_on_x, v_neg(q.y), q.y), q.x);
        const vm opposite = v_lt(cosine, zero), by_b = v_lt(value_a, value_b);
        const vm side_a = v_lt(across_a, zero), side_b = v_lt(across_b, zero); /* are B's centre and A's behind? */
        const vm negative_a = vm_or(vm_and_not(side_a, by_b), vm_and(by_b, vm_xor(side_b, opposite)));
        const vm back_b = vm_xor(negative_a, opposite); /* does B's axis point to A? */
        /* The other six values. */
        const vf far_a = v_sub(v_sub(value_a, v_abs(across_a)), v_select(negative_a, v_neg(across_a), across_a));
        const vf far_b = v_sub(v_sub(value_b, v_abs(across_b)), v_select(back_b, v_neg(across_b), across_b));
        const vf others = v_max(v_min(along_x, along_y), v_max(far_a, far_b));
        const vm nearer = vm_or(crossed, v_lt(s, c)); /* or else two edges of B are equally near */
        const vm certain = vm_and(nearer, vm_or(v_lt(two, best), v_lt(two, v_sub(best, others))));

        const vi pairs = vi_add(vi_lanes(), vi_set(number));
        const vi edges =
            vi_add(find_edge_number(a_on_x, negative_a), vi_shift_left(find_edge_number(b_on_x, vm_not(back_b)), 2));
        const vi tie = vi_select(certain, vi_set(0), vi_set(BOX_TIE));
        vf item[BOX_FIELDS];
        set_vec2(item, BOX_POSITION, t);
        set_vec2(item, BOX_ROTATION, q);
        set_vec2(item, BOX_ROTATION_A, placement->rotation_a);
        set_vec2(item, BOX_HALF_A, half_a);
        set_vec2(item, BOX_HALF_B, b->half);
        item[BOX_SCALE_B] = pose->scale_b;
        item[BOX_RADIUS_A] = radius_a;
        item[BOX_RADIUS_B] = radius_b;
        item[BOX_SLACK] = slack;
        item[BOX_CODE] = v_of_bits(vi_add(vi_add(edges, find_first_arcs(a, b)), tie));
        item[BOX_PAIR] = v_of_bits(pairs);
        push_boxes(queue, near, item, BOX_FIELDS);
    }
    return taken;
}

#endif
