/* SPDX-License-Identifier: MIT
 *
 * recycle.c - rows that follow their bodies while these have hardly moved against each other: the same features touch, the
 * normal turns with A, and each point lies where the places of both bodies that touched are now. What was kept of a row
 * (narc_kept_row) says where these are.
 */
#include <math.h>
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

/* ------------------------------------------------------------------------------------------------ rows */

/* What a row in each lane says of points; of contacts the second one is not there. */
struct rows_of {
    vf head[4], radii[4], point[2][4]; /* as in narc_manifold */
    vm second;
};

INLINE struct rows_of load_rows(const narc_rows *rows, const int32_t *number, bool manifold) {
    struct rows_of out;
    const vf zero = v_set(0);
    if (manifold) {
        v_rows(rows->base, rows->stride, number, out.head);
        v_rows(rows->base + offsetof(narc_manifold, radius_a), rows->stride, number, out.radii);
        for (int i = 0; i < 2; i++)
            v_rows(rows->base + offsetof(narc_manifold, point[i]), rows->stride, number, out.point[i]);
        out.second = vi_lt(vi_set(1), vi_bits(out.head[1]));
        return out;
    }
    vf front[4], rest[4];
    v_rows(rows->base + offsetof(narc_contact, feature), rows->stride, number, front);
    v_rows(rows->base + offsetof(narc_contact, point_x), rows->stride, number, rest);
    return (struct rows_of){.head = {zero, front[0], front[2], front[3]},
                            .radii = {rest[2], rest[3], zero, zero},
                            .point = {{rest[0], rest[1], front[1], zero}, {zero, zero, zero, zero}},
                            .second = vm_front(0)};
}

INLINE void store_rows(const struct rows_of *rows, char *const *place, bool manifold) {
    if (manifold) {
        v_put_rows(place, 0, rows->head);
        for (int i = 0; i < 2; i++)
            v_put_rows(place, (int)offsetof(narc_manifold, point[i]), rows->point[i]);
        return;
    }
    const vf *const p = rows->point[0];
    const vf front[4] = {rows->head[1], p[2], rows->head[2], rows->head[3]};
    const vf rest[4] = {p[0], p[1], rows->radii[0], rows->radii[1]};
    v_put_rows(place, offsetof(narc_contact, feature), front);
    v_put_rows(place, offsetof(narc_contact, point_x), rest);
}

/* The numbers of a block's items, and in `own` if they are not the pairs' own. Behind the last they repeat it. A whole block at
 * once: a vector that is read from what was just written word by word waits for it. */
INLINE const int32_t *find_items(const uint32_t *item, const struct pair_indices *indices, int n, int32_t own[BLOCK]) {
    for (int k = 0; item && k < (n + V_WIDTH - 1) / V_WIDTH * V_WIDTH; k++)
        own[k] = (int32_t)item[k < n ? k : n - 1];
    return item ? own : indices->number;
}

/* ------------------------------------------------------------------------------------------------ rows that follow */

/* From A's place of a point to B's, in A's frame. */
INLINE vec2 find_span(const vf word[WORDS], const struct pose *pose, int point) {
    const vf *const p = word + OF_POINT + 4 * point;
    const vec2 b = v2_add(pose->position, v2_rotate(pose->rotation, (vec2){p[2], p[3]}));
    return v2_sub(b, (vec2){p[0], p[1]});
}

/* Have the bodies moved against each other by less than the tolerance: the first point's places, and, at the end of the
 * lever, what the one has turned against the other? `bare`: there was no row, and they may move by what is kept. */
INLINE vm has_hardly_moved(const vf word[WORDS], const struct pose *pose, vec2 span, vf tolerance, vm bare) {
    const vec2 normal = {word[OF_NORMAL], word[OF_NORMAL + 1]};
    const vec2 moved = v2_sub(span, v2_scale(normal, word[OF_APART]));
    const vec2 turned = v2_sub(pose->rotation, (vec2){word[OF_ROTATION], word[OF_ROTATION + 1]});
    return v_lt(v_add(v2_length(moved), v_mul(v_abs(word[OF_LEVER]), v2_length(turned))),
                v_select(bare, word[OF_APART], tolerance));
}

/* Of a point of a row with this normal, in A's frame. */
INLINE vf find_separation(const vf word[WORDS], vec2 normal, vec2 span) {
    return v_sub(v2_dot(span, normal), v_add(word[OF_RADIUS_A], word[OF_RADIUS_B]));
}

/* Moves normals and points with their bodies. */
INLINE void move_rows(const vf word[WORDS], const struct placement *placement, const vec2 span[2],
                      struct rows_of *rows) {
    const vec2 n = {word[OF_NORMAL], word[OF_NORMAL + 1]}, normal = v2_rotate(placement->rotation_a, n);
    rows->head[2] = normal.x;
    rows->head[3] = normal.y;
    UNROLL
    for (int i = 0; i < 2; i++) {
        const vf *const p = word + OF_POINT + 4 * i;
        const vf separation = find_separation(word, n, span[i]);
        const vf out_of_a = v_add(word[OF_RADIUS_A], v_mul(v_set(0.5f), separation));
        const vec2 place = v2_rotate(placement->rotation_a, v2_add((vec2){p[0], p[1]}, v2_scale(n, out_of_a)));
        const vf moved[3] = {place.x, place.y, separation};
        for (int w = 0; w < 3; w++)
            rows->point[i][w] = i == 0 ? moved[w] : v_select(rows->second, moved[w], rows->point[i][w]);
    }
}

/* Asks the cache for what the block from `first` on reads: of pairs that are far apart in memory, where rows are kept of
 * ground. */
NOINLINE void fetch_kept(const narc_batch *batch, const struct sources *given, size_t first, size_t count,
                         const uint32_t *item, const narc_kept_row *kept) {
    HAS_EFFECT;
    for (size_t k = 0; k < count && k < BLOCK; k++) {
        const size_t number = narc_pair_at(batch, first + k);
        const char *const row = (const char *)(kept + (item ? item[k] : number));
        FETCH(row);
        FETCH(row + sizeof *kept - 1);
        FETCH(narc_at(given->b.x.base, given->b.x.stride, narc_index_at(given->pairs.b, number)));
    }
}

/* Lets rows of those of a batch's pairs first .. first + count - 1 follow whose bodies have moved by less than the
 * tolerance, and whose first point still is within the margin, and pairs without a row stay so; `batch->row_size` says which
 * rows. Lists the numbers of all other pairs in `left`, in their order, and returns how many there are; their rows stay as
 * they were. Number item[i] of what is kept and of the rows is that of the pair at
 * first + i; `item` NULL: its own number. Without rows (`out` NULL) it is only told who may. */
size_t NARC_NAMED(recycle)(const narc_batch *batch, size_t first, size_t count, const uint32_t *item,
                           const narc_kept_row *kept, float tolerance, const narc_rows *out, uint32_t *left) {
    const struct call call = {.batch = batch, .margin = batch->query->margin, .margins = batch->query->margins};
    const bool manifold = batch->row_size == sizeof(narc_manifold);
    struct sources given = copy_sources(batch);
    const enum pose_layout layout = find_layout(&given);
    given.a.scale.base = given.b.scale.base = NULL; /* what is kept knows them */
    _Alignas(64) char room[sizeof(narc_manifold)], *place[V_WIDTH];
    int32_t own[BLOCK];
    struct pair_indices indices;
    size_t open = 0;
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_pairs(&given, first + block, n, false, &indices);
        if (FETCHES && item && given.pairs.b.base && block + BLOCK < count)
            fetch_kept(batch, &given, first + block + BLOCK, count - block - BLOCK, item + block + BLOCK, kept);
        const int32_t *const items = find_items(item ? item + block : NULL, &indices, n, own);
        for (int k = 0; k < n; k += V_WIDTH) {
            const int32_t *const number = items + k;
            const bool in_line = are_in_line(number);
            const struct placement placement = place_pairs(&call, &given, &indices, k, layout, false);
            vf word[WORDS];
            load_items(kept, WORDS, number, in_line, word);
            const vec2 span[2] = {find_span(word, &placement.pose, 0), find_span(word, &placement.pose, 1)};
            const vec2 normal = {word[OF_NORMAL], word[OF_NORMAL + 1]};
            const vm live = vm_front(n - k), bare = v_lt(word[OF_LEVER], v_set(0));
            const vm near = vm_or(bare, v_lt(find_separation(word, normal, span[0]), placement.margin));
            const vm rests = has_hardly_moved(word, &placement.pose, span[0], v_set(tolerance), bare);
            const vm follows = vm_and(vm_and(live, placement.in_range), vm_and(near, rests));
            for (uint32_t lanes = vm_bits(vm_and_not(live, follows)); lanes; lanes &= lanes - 1)
                left[open++] = (uint32_t)indices.number[k + FIND_LOWEST(lanes)];
            const uint32_t lanes = vm_bits(vm_and_not(follows, bare));
            if (!out || !lanes)
                continue;
            struct rows_of rows = load_rows(out, number, manifold);
            move_rows(word, &placement, span, &rows);
            find_places(out->base, out->stride, number, lanes, room, place);
            store_rows(&rows, place, manifold);
        }
    }
    return open;
}

/* ------------------------------------------------------------------------------------------------ rows that are kept */

/* Of length 1, but for the square of what it lacks. */
INLINE vec2 find_unit(vec2 q) { return v2_scale(q, v_sub(v_set(1.5f), v_mul(v_set(0.5f), v2_dot(q, q)))); }

INLINE vm is_finite(vf x) { return v_lt(v_abs(x), v_set(INFINITY)); }

/* Keeps rows, with a point at least, of a batch's pairs first .. first + count - 1; numbers are those of `recycle`. */
void NARC_NAMED(keep)(const narc_batch *batch, size_t first, size_t count, const uint32_t *item, const narc_rows *rows,
                      narc_kept_row *out) {
    const bool manifold = batch->row_size == sizeof(narc_manifold);
    const struct sources given = copy_sources(batch);
    const enum pose_layout layout = find_layout(&given);
    _Alignas(64) char room[sizeof(narc_kept_row)], *place[V_WIDTH];
    int32_t own[BLOCK];
    struct pair_indices indices;
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_pairs(&given, first + block, n, true, &indices);
        const int32_t *const items = find_items(item ? item + block : NULL, &indices, n, own);
        for (int k = 0; k < n; k += V_WIDTH) {
            const int32_t *const number = items + k;
            const struct rows_of row = load_rows(rows, number, manifold);
            const struct body_pair bodies = load_bodies(&given, layout, indices.a + k, indices.b + k, NULL, NULL);
            const struct headers a = load_headers(batch->shapes->headers, indices.shape_a + k);
            const struct headers b = load_headers(batch->shapes->headers, indices.shape_b + k);
            const vec2 q_a = find_unit(bodies.rotation_a), q_b = find_unit(bodies.rotation_b);
            const vec2 normal = {row.head[2], row.head[3]}, in_a = v2_unrotate(q_a, normal),
                       relative = v2_unrotate(q_a, q_b);
            const vm finite_a = is_finite(row.radii[0]), finite_b = is_finite(row.radii[1]);
            /* of one point with an arc: it rolls */
            const vf radius_a = v_select(vm_and_not(finite_a, row.second), row.radii[0], v_set(0));
            const vf radius_b = v_select(vm_and_not(finite_b, row.second), row.radii[1], v_set(0));
            const vf diameter_a = v_mul(v_mul(v_set(2), a.bound_radius), bodies.scale_a);
            const vf diameter_b = v_mul(v_mul(v_set(2), b.bound_radius), bodies.scale_b);
            /* Half-planes may be far away, where what is kept in single precision says little: no row follows them. */
            const vm planes = vm_or(is_plane(a.info), is_plane(b.info));
            const vf head[4] = {relative.x, relative.y, in_a.x, in_a.y};
            const vf rest[4] = {radius_a, radius_b, v_add(v_add(row.point[0][2], radius_a), radius_b),
                                v_select(planes, v_set(INFINITY), v_min(diameter_a, diameter_b))};
            find_places((char *)out, sizeof *out, number, vm_bits(vm_front(n - k)), room, place);
            v_put_rows(place, 0, head);
            UNROLL
            for (int i = 0; i < 2; i++) {
                const vf *const p = row.point[i], half = v_mul(v_set(0.5f), p[2]);
                const vec2 point = {p[0], p[1]}, from_b = v2_add(point, v2_scale(bodies.difference, v_set(-1)));
                const vec2 of_a = v2_unrotate(q_a, v2_add(point, v2_scale(normal, v_sub(v_neg(half), radius_a))));
                const vec2 of_b = v2_unrotate(q_b, v2_add(from_b, v2_scale(normal, v_add(half, radius_b))));
                vf both[4] = {of_a.x, of_a.y, of_b.x, of_b.y};
                for (int w = 0; w < 4 && i == 1; w++)
                    both[w] = v_select(row.second, both[w], v_set(0));
                v_put_rows(place, (int)offsetof(narc_kept_row, point[i]), both);
            }
            v_put_rows(place, offsetof(narc_kept_row, radius_a), rest);
        }
    }
}
