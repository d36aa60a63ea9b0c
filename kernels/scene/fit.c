/* SPDX-License-Identifier: MIT
 *
 * fit.c - the kernels that fit an index to boxes: the slots of leaves, then those of the nodes above them.
 *
 * Lanes are slots: of a leaf its bodies, of another node its children, whose own slots are looked at one after the
 * other.
 */
#include <float.h>
#include <math.h>
#include <stdint.h>

#include "kernels.h"
#include "simd/simd.h"

/* A column of a node's slots, from `slot` on. Wider vectors have lanes behind the node, which stay as they are. */
INLINE void put_slots(float *to, vf lanes) {
    if (V_WIDTH <= NARC_NODE_SLOTS) {
        v_store(to, lanes);
    } else {
        float all[V_WIDTH];
        v_store(all, lanes);
        memcpy(to, all, NARC_NODE_SLOTS * sizeof *to);
    }
}

INLINE void put_boxes(narc_index_node *node, int slot, vm full, const vf box[4]) {
    const vf none = v_set(INFINITY);
    put_slots(node->min_x + slot, v_select(full, box[0], none));
    put_slots(node->min_y + slot, v_select(full, box[1], none));
    put_slots(node->max_x + slot, v_select(full, box[2], v_neg(none)));
    put_slots(node->max_y + slot, v_select(full, box[3], v_neg(none)));
}

/* Leaves first .. end - 1: the boxes of their bodies. */
void NARC_NAMED(leaves)(const narc_index *index, const narc_box *boxes, size_t first, size_t end) {
    const vf least = v_set(-FLT_MAX), most = v_set(FLT_MAX);
    for (size_t k = first; k < end; k++)
        for (int slot = 0; slot < NARC_NODE_SLOTS; slot += V_WIDTH) {
            const vi body = vi_load((const int32_t *)(const void *)(index->body + k * NARC_NODE_SLOTS + (size_t)slot));
            const vm none = vi_lt(body, vi_set(0));
            int32_t row[V_WIDTH];
            vf box[4];
            vi_store(row, vi_select(none, vi_set(0), body));
            v_rows(boxes, sizeof *boxes, row, box);
            const vm finite = vm_and(vm_and(v_le(least, box[0]), v_le(least, box[1])),
                                     vm_and(v_le(box[2], most), v_le(box[3], most)));
            const vm fine = vm_and(finite, vm_and(v_le(box[0], box[2]), v_le(box[1], box[3])));
            put_boxes(&index->nodes[k], slot, vm_and_not(fine, none), box);
        }
}

/* One column of some nodes: out[i] has slot i of each of them. */
INLINE void load_slots(const float *column, const int32_t *node, vf out[NARC_NODE_SLOTS]) {
    v_rows(column, sizeof(narc_index_node), node, out);
    v_rows(column + 4, sizeof(narc_index_node), node, out + 4);
}

INLINE vf find_least(const vf slot[NARC_NODE_SLOTS]) {
    return v_min(v_min(v_min(slot[0], slot[1]), v_min(slot[2], slot[3])),
                 v_min(v_min(slot[4], slot[5]), v_min(slot[6], slot[7])));
}

INLINE vf find_most(const vf slot[NARC_NODE_SLOTS]) {
    return v_max(v_max(v_max(slot[0], slot[1]), v_max(slot[2], slot[3])),
                 v_max(v_max(slot[4], slot[5]), v_max(slot[6], slot[7])));
}

/* For each bit of a slot's number, how much further along an axis the slots lie that have it, in all, than those that
 * do not. A slot without anything counts as that which has its highest bit less, since slots are filled in their order. */
INLINE void find_distances(const vf min[NARC_NODE_SLOTS], const vf max[NARC_NODE_SLOTS], vf out[3]) {
    vf c[NARC_NODE_SLOTS];
    UNROLL
    for (int k = 0; k < NARC_NODE_SLOTS; k++) {
        const vf other = k == 0 ? v_set(0) : c[k & (k >= 4 ? 3 : k >= 2 ? 1 : 0)];
        c[k] = v_select(v_le(min[k], max[k]), v_add(min[k], max[k]), other);
    }
    const vf s01 = v_add(c[0], c[1]), s23 = v_add(c[2], c[3]), s45 = v_add(c[4], c[5]), s67 = v_add(c[6], c[7]);
    const vf odd = v_add(v_add(c[1], c[3]), v_add(c[5], c[7])), even = v_add(v_add(c[0], c[2]), v_add(c[4], c[6]));
    out[0] = v_sub(odd, even);
    out[1] = v_sub(v_add(s23, s67), v_add(s01, s45));
    out[2] = v_sub(v_add(s45, s67), v_add(s01, s23));
}

/* The nodes from `below` on, `count` of them, are the children of `node`: their boxes, and their `order`. */
INLINE void fit_node(const narc_index *index, size_t below, size_t count, narc_index_node *node) {
    for (int slot = 0; slot < NARC_NODE_SLOTS; slot += V_WIDTH) {
        const narc_index_node *const children = index->nodes + below;
        int32_t child[V_WIDTH], order[V_WIDTH];
        for (int l = 0; l < V_WIDTH; l++)
            child[l] = slot + l < (int)count ? slot + l : 0;
        const vm full = vi_lt(vi_add(vi_set(slot), vi_lanes()), vi_set((int32_t)count));
        vf min[NARC_NODE_SLOTS], max[NARC_NODE_SLOTS], box[4], along_x[3], along_y[3];
        load_slots(children->min_x, child, min);
        load_slots(children->max_x, child, max);
        box[0] = find_least(min);
        box[2] = find_most(max);
        find_distances(min, max, along_x);
        load_slots(children->min_y, child, min);
        load_slots(children->max_y, child, max);
        box[1] = find_least(min);
        box[3] = find_most(max);
        find_distances(min, max, along_y);
        put_boxes(node, slot, full, box);
        vi orders = vi_set(0);
        for (int b = 0; b < 3; b++) {
            const vm higher = v_lt(v_abs(along_x[b]), v_abs(along_y[b]));
            const vm downward = v_lt(v_select(higher, along_y[b], along_x[b]), v_set(0));
            orders = vi_add(orders, vi_select(higher, vi_set((int32_t)NARC_ORDER_ALONG_Y(b)), vi_set(0)));
            orders = vi_add(orders, vi_select(downward, vi_set((int32_t)NARC_ORDER_DOWNWARD(b)), vi_set(0)));
        }
        vi_store(order, orders);
        for (int l = 0; l < V_WIDTH && slot + l < (int)count; l++)
            (index->order + below)[slot + l] = (uint8_t)order[l];
    }
}

/* Nodes first .. end - 1 of a level above the leaves, and the order of their children; or the box of the root, as the
 * first slot of `above`, and its order, if `level` is one too high. */
void NARC_NAMED(nodes)(const narc_index *index, unsigned level, size_t first, size_t end, narc_index_node *above) {
    for (size_t k = first; k < end; k++) {
        const size_t below = k * NARC_NODE_SLOTS, left = index->node_count[level - 1] - below;
        fit_node(index, index->first_node[level - 1] + below, left < NARC_NODE_SLOTS ? left : NARC_NODE_SLOTS,
                 level < index->level_count ? &index->nodes[index->first_node[level] + k] : above);
    }
}
