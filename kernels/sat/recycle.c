/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that follow their bodies while these have hardly moved against each other: the same features touch, the
 * normal turns with A, and each point lies where the places of both bodies that touched are now. What was kept of a row
 * (narc_kept_row) says where these are.
 */
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/pair_setup.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "sat/kept.inl"
#include "simd/simd.h"

enum { WORDS = sizeof(narc_kept_row) / sizeof(float) };
_Static_assert(sizeof(narc_kept_row) == 64, "what is kept is four times four words");

enum {
    OF_ROTATION = offsetof(narc_kept_row, rotation) / 4,
    OF_NORMAL = offsetof(narc_kept_row, normal) / 4,
    OF_POINT = offsetof(narc_kept_row, point) / 4,
    OF_RADIUS_A = offsetof(narc_kept_row, radius_a) / 4,
    OF_RADIUS_B = offsetof(narc_kept_row, radius_b) / 4,
    OF_APART = offsetof(narc_kept_row, apart) / 4,
    OF_LEVER = offsetof(narc_kept_row, lever) / 4
};

/* From A's place of a point to B's, in A's frame. */
INLINE vec2 find_span(const vf word[WORDS], const struct pose *pose, int point) {
    const vf *const p = word + OF_POINT + 4 * point;
    const vec2 b = v2_add(pose->position, v2_rotate(pose->rotation, (vec2){p[2], p[3]}));
    return v2_sub(b, (vec2){p[0], p[1]});
}

/* Have the bodies moved against each other by less than the tolerance: the first point's places, and, at the far end of the
 * smaller body, what the one has turned against the other? */
INLINE vm has_hardly_moved(const vf word[WORDS], const struct pose *pose, vec2 span, vf tolerance) {
    const vec2 normal = {word[OF_NORMAL], word[OF_NORMAL + 1]};
    const vec2 moved = v2_sub(span, v2_scale(normal, word[OF_APART]));
    const vec2 turned = v2_sub(pose->rotation, (vec2){word[OF_ROTATION], word[OF_ROTATION + 1]});
    return v_lt(v_add(v2_length(moved), v_mul(word[OF_LEVER], v2_length(turned))), tolerance);
}

/* What rows get: the normal, and of each point its place and separation. */
enum { NEW_WORDS = 8 };

INLINE void find_words(const vf word[WORDS], const struct placement *placement, const vec2 span[2],
                       float out[NEW_WORDS][V_WIDTH]) {
    const vec2 n = {word[OF_NORMAL], word[OF_NORMAL + 1]}, normal = v2_rotate(placement->rotation_a, n);
    v_store(out[0], normal.x);
    v_store(out[1], normal.y);
    UNROLL
    for (int i = 0; i < 2; i++) {
        const vf *const p = word + OF_POINT + 4 * i;
        const vf separation = v_sub(v2_dot(span[i], n), v_add(word[OF_RADIUS_A], word[OF_RADIUS_B]));
        const vf out_of_a = v_add(word[OF_RADIUS_A], v_mul(v_set(0.5f), separation));
        const vec2 place = v2_rotate(placement->rotation_a, v2_add((vec2){p[0], p[1]}, v2_scale(n, out_of_a)));
        v_store(out[2 + 3 * i], place.x);
        v_store(out[3 + 3 * i], place.y);
        v_store(out[4 + 3 * i], separation);
    }
}

/* Writes these words of a row that is there. */
INLINE void write_words(float words[NEW_WORDS][V_WIDTH], int lane, char *to, bool manifold) {
    if (manifold) {
        narc_manifold row;
        memcpy(&row, to, sizeof row);
        row.normal_x = words[0][lane];
        row.normal_y = words[1][lane];
        for (uint32_t i = 0; i < row.count; i++) {
            row.point[i].x = words[2 + 3 * i][lane];
            row.point[i].y = words[3 + 3 * i][lane];
            row.point[i].separation = words[4 + 3 * i][lane];
        }
        memcpy(to, &row, sizeof row);
    } else {
        narc_contact row;
        memcpy(&row, to, sizeof row);
        row.normal_x = words[0][lane];
        row.normal_y = words[1][lane];
        row.point_x = words[2][lane];
        row.point_y = words[3][lane];
        row.separation = words[4][lane];
        memcpy(to, &row, sizeof row);
    }
}

/* Lets rows of those of a batch's pairs first .. first + count - 1 follow whose bodies have moved by less than the
 * tolerance; `batch->row_size` says which rows. Lists the numbers of all other pairs in `left`, in their order, and returns
 * how many there are; their rows stay as they were. Number item[i] of what is kept and of the rows is that of the pair at
 * first + i; `item` NULL: its own number. Without rows (`out` NULL) it is only told who may. */
size_t NARC_NAMED(recycle)(const narc_batch *batch, size_t first, size_t count, const uint32_t *item,
                           const narc_kept_row *kept, float tolerance, const narc_rows *out, uint32_t *left) {
    const struct call call = {.batch = batch, .margin = 0};
    const bool manifold = batch->row_size == sizeof(narc_manifold);
    struct sources given = copy_sources(batch);
    const enum pose_layout layout = find_layout(&given);
    given.a.scale.base = given.b.scale.base = NULL; /* what is kept knows them */
    struct pair_indices indices;
    size_t open = 0;
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_bodies_of(&given, first + block, n, &indices);
        for (int k = 0; k < n; k += V_WIDTH) {
            int32_t number[V_WIDTH];
            for (int lane = 0; lane < V_WIDTH; lane++)
                number[lane] =
                    item ? (int32_t)item[block + (size_t)(k + lane < n ? k + lane : n - 1)] : indices.number[k + lane];
            const struct placement placement = place_pairs(&call, &given, &indices, k, layout);
            vf word[WORDS];
            load_items(kept, WORDS, number, false, word);
            const vec2 span[2] = {find_span(word, &placement.pose, 0), find_span(word, &placement.pose, 1)};
            const vm live = vm_front(n - k);
            const vm follows = vm_and(vm_and(live, placement.in_range),
                                      has_hardly_moved(word, &placement.pose, span[0], v_set(tolerance)));
            for (uint32_t lanes = vm_bits(vm_and_not(live, follows)); lanes; lanes &= lanes - 1)
                left[open++] = (uint32_t)indices.number[k + FIND_LOWEST(lanes)];
            if (!out)
                continue;
            float words[NEW_WORDS][V_WIDTH];
            find_words(word, &placement, span, words);
            for (uint32_t lanes = vm_bits(follows); lanes; lanes &= lanes - 1) {
                const int lane = FIND_LOWEST(lanes);
                write_words(words, lane, out->base + (ptrdiff_t)(uint32_t)number[lane] * out->stride, manifold);
            }
        }
    }
    return open;
}
