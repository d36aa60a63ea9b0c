/* SPDX-License-Identifier: MIT
 *
 * rows.inl - rows of answers, in the caller's memory. Stages find answers in any order: each is written to the place of
 * its pair, as if every pair had a row. At the end of a call the gaps are closed.
 */
#ifndef NARC_BASE_ROWS_INL
#define NARC_BASE_ROWS_INL

#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/plane_pairs.inl"
#include "base/question.inl"
#include "base/queue.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "simd/simd.h"

/* The rows of a call. The answers of the first pairs may be known in order: then they are listed at once. All pairs
 * before `done` are answered and have `listed` rows, or wait in a queue of forms (box/box_detour.inl), in their
 * order; -1: no more rows are listed. */
struct rows {
    narc_rows out;
    bool dense;
    int done, listed;
    bool planes_first;                              /* has a pair a half-plane for A? */
    int without;                                    /* rows of pairs without an answer */
    uint8_t known[NARC_ROW_GROUP + 1];              /* 1: a pair from there on that has a row; and one to spare */
    _Alignas(16) char spare[sizeof(narc_manifold)]; /* takes what lanes without an answer write */
};

INLINE void start_rows(struct rows *rows, size_t count, const narc_rows *out, bool dense) {
    rows->out = *out;
    rows->dense = dense;
    rows->done = rows->listed = 0;
    rows->without = 0;
    rows->planes_first = false;
    memset(rows->known, 0, (count + 63) / 64 * 64);
}

static inline struct call begin_rows(const struct question *question, const narc_batch *batch, size_t first,
                                     size_t count, size_t *skipped, const narc_rows *out, struct rows *rows) {
    start_rows(rows, count, out, batch->query->dense != 0);
    return (struct call){.batch = batch,
                         .first = first,
                         .count = count,
                         .skipped = skipped,
                         .margin = batch->query->margin,
                         .margins = batch->query->margins,
                         .kind = question->kind,
                         .question = question,
                         .rows = rows,
                         .planes_first = &rows->planes_first,
                         .pieces = has_pieces(batch),
                         .planes = has_planes(batch)};
}

/* The place of a call's pair. */
INLINE char *find_place(const struct call *call, int32_t pair) {
    const struct rows *rows = call->rows;
    const size_t item = rows->dense ? find_number(call, pair) : (uint32_t)pair;
    return rows->out.base + (ptrdiff_t)item * rows->out.stride;
}

/* Where a list tells which pairs are asked of, dense rows lie at the numbers that it has. */
NOINLINE void find_listed_places(const struct call *call, vi rows, char *place[V_WIDTH]) {
    int32_t row[V_WIDTH];
    vi_store(row, rows);
    for (int lane = 0; lane < V_WIDTH; lane++)
        if (row[lane] < NARC_ROW_GROUP)
            place[lane] = find_place(call, row[lane]);
}

/* Notes that pairs have a row, in the lanes `keep`, and finds their places; elsewhere the spare one: what lanes write in
 * vain stays in one line of the cache. One pair by itself is not asked for without a row. */
INLINE void find_places(const struct call *call, vi pairs, vm keep, char *place[V_WIDTH]) {
    struct rows *rows = call->rows;
    if (BLOCK == 1) {
        rows->known[0] = 1;
        place[0] = rows->out.base;
        return;
    }
    char *const first = rows->out.base + (rows->dense ? (ptrdiff_t)call->first * rows->out.stride : 0);
    const uintptr_t stride = (uintptr_t)rows->out.stride,
                    from[2] = {(uintptr_t)first, (uintptr_t)rows->spare - NARC_ROW_GROUP * stride};
    const vi numbers = vi_select(keep, pairs, vi_set(NARC_ROW_GROUP));
    uint32_t row[V_WIDTH];
    vi_store((int32_t *)row, numbers);
    for (int lane = 0; lane < V_WIDTH; lane++) { /* without a branch: which lanes have an answer can't be foreseen */
        const uintptr_t at = row[lane];
        place[lane] = (char *)(from[at / NARC_ROW_GROUP] + at * stride);
        rows->known[at] = 1;
    }
    if (rows->dense && call->batch->query->selection.base)
        find_listed_places(call, numbers, place);
}

/* The places behind those that are listed, for the lanes `keep`; elsewhere the spare one. */
INLINE void find_next_places(struct rows *rows, vm keep, char *place[V_WIDTH]) {
    const uint32_t kept = vm_bits(keep);
    char *next = rows->out.base + rows->listed * rows->out.stride;
    if (kept == vm_bits(vm_front(V_WIDTH))) { /* mostly so where boxes rest on each other */
        for (int lane = 0; lane < V_WIDTH; lane++)
            place[lane] = next + lane * rows->out.stride;
        rows->listed += V_WIDTH;
        return;
    }
    for (uint32_t lane = 0; lane < V_WIDTH; lane++) {
        place[lane] = choose(kept >> lane & 1, next, rows->spare);
        next += (ptrdiff_t)(kept >> lane & 1) * rows->out.stride;
    }
    rows->listed += COUNT_BITS(kept);
}

/* ------------------------------------------------------------------------------------------------ writing */

/* Bytes of a contact's members: eight words from there to the end, behind the pair. */
enum { CONTACT_WORDS = offsetof(narc_contact, feature) };
_Static_assert(sizeof(narc_contact) == 36 && CONTACT_WORDS == 4, "two writes of four words follow the pair");

INLINE void write_contacts(char *const *place, vi numbers, const struct answer *answer) {
    const vf front[4] = {v_of_bits(pack_halves(answer->feature, vi_set(1))), answer->separation, answer->normal.x,
                         answer->normal.y};
    const vf rest[4] = {answer->point.x, answer->point.y, answer->radius_a, answer->radius_b};
    int32_t number[V_WIDTH];
    vi_store(number, numbers);
    v_put_rows(place, CONTACT_WORDS, front);
    v_put_rows(place, CONTACT_WORDS + 16, rest);
    for (int lane = 0; lane < V_WIDTH; lane++)
        memcpy(place[lane], &number[lane], sizeof number[lane]);
}

static inline void write_no_contact(char *place, uint32_t pair, float separation) {
    const narc_contact contact = {.pair = pair, .separation = separation};
    memcpy(place, &contact, sizeof contact);
}

static inline void write_no_manifold(char *place, uint32_t pair, float separation) {
    const narc_manifold manifold = {.pair = pair, .point = {{.separation = separation}}};
    memcpy(place, &manifold, sizeof manifold);
}

/* Bytes of a manifold's members. */
enum {
    RADII = offsetof(narc_manifold, radius_a),
    FIRST_POINT = offsetof(narc_manifold, point),
    SECOND_POINT = FIRST_POINT + sizeof(narc_manifold_point)
};
_Static_assert(sizeof(narc_manifold) == 64 && RADII == 16 && FIRST_POINT == 32, "four writes of four words");

/* What manifolds say beside their points. */
INLINE void write_heads(char *const *place, vi numbers, const struct answer *answer, vi count, vf radius_a,
                        vf radius_b) {
    const vf head[4] = {v_of_bits(numbers), v_of_bits(count), answer->normal.x, answer->normal.y};
    const vf radii[4] = {radius_a, radius_b, v_of_bits(answer->reach_a), v_of_bits(answer->reach_b)};
    v_put_rows(place, 0, head);
    v_put_rows(place, RADII, radii);
}

/* Manifolds of one point. */
INLINE void write_only_points(char *const *place, vi numbers, const struct answer *answer) {
    const vf zero = v_set(0), none[4] = {zero, zero, zero, zero};
    const vf point[4] = {answer->point.x, answer->point.y, answer->separation, v_of_bits(answer->feature)};
    write_heads(place, numbers, answer, vi_set(1), answer->radius_a, answer->radius_b);
    v_put_rows(place, FIRST_POINT, point);
    v_put_rows(place, SECOND_POINT, none);
}

INLINE void write_separations(char *const *place, vf separations) {
    float separation[V_WIDTH];
    v_store(separation, separations);
    for (int lane = 0; lane < V_WIDTH; lane++)
        memcpy(place[lane], &separation[lane], sizeof separation[lane]);
}

/* Writes rows of one point, of the kind that the question has: each is compiled into what finds answers, as a call would
 * pass vectors in memory. */
INLINE void write_rows(const struct call *call, char *const *place, vi numbers, const struct answer *answer) {
    const enum row_kind kind = call->kind;
    if (kind == CONTACT_ROWS)
        write_contacts(place, numbers, answer);
    else if (BLOCK == 1 || kind == MANIFOLD_ROWS)
        write_only_points(place, numbers, answer);
    else
        write_separations(place, answer->separation);
}

/* Lists the rows of pairs in the lanes `keep` behind those that are listed, where there is room for all lanes: packed, so
 * that their places follow each other. What is written behind the last one is overwritten. */
INLINE void append_answers(const struct call *call, vi pairs, vm keep, const struct answer *answer) {
    struct rows *rows = call->rows;
    const vp packing = vm_packing(keep);
    const vi numbers = vi_bits(v_pack(packing, v_of_bits(find_numbers(call, pairs))));
    struct answer packed = *answer; /* feature and reach of circles are all the same */
    packed.separation = v_pack(packing, answer->separation);
    packed.normal = (vec2){v_pack(packing, answer->normal.x), v_pack(packing, answer->normal.y)};
    packed.point = (vec2){v_pack(packing, answer->point.x), v_pack(packing, answer->point.y)};
    packed.radius_a = v_pack(packing, answer->radius_a);
    packed.radius_b = v_pack(packing, answer->radius_b);
    char *place[V_WIDTH];
    for (int lane = 0; lane < V_WIDTH; lane++)
        place[lane] = rows->out.base + (rows->listed + lane) * rows->out.stride;
    write_rows(call, place, numbers, &packed);
    rows->listed += COUNT_BITS(vm_bits(keep));
}

/* ------------------------------------------------------------------------------------------------ pairs without a row */

/* With an infinite margin every pair has a row. Writes that of pairs without an answer, in the lanes `which`. */
INLINE void put_no_answer(const struct call *call, vi pairs, vm which) {
    int32_t pair[V_WIDTH];
    if (!vm_any(which))
        return;
    vi_store(pair, pairs);
    for (uint32_t lanes = vm_bits(which); lanes; lanes &= lanes - 1) {
        const int32_t k = pair[FIND_LOWEST(lanes)];
        if (!(find_margin(call, k) >= INFINITY))
            continue;
        call->question->none(find_place(call, k), (uint32_t)find_number(call, k), INFINITY);
        call->rows->known[k] = 1;
        call->rows->without++;
    }
}

/* Fills the rows of pairs that have none: dense ones have all places filled. Returns how many contacts there are. */
INLINE size_t fill_gaps(const struct call *call) {
    int count = 0;
    for (int32_t k = 0; k < (int32_t)call->count; k++) {
        count += call->rows->known[k];
        if (!call->rows->known[k])
            call->question->none(find_place(call, k), (uint32_t)find_number(call, k), 0);
    }
    return (size_t)(count - call->rows->without);
}

/* Eight bytes that are 0 or 1 as bits, the first one the lowest: a product that adds each, shifted, to the top byte. */
INLINE uint32_t pack_bytes(const uint8_t *bytes) {
    uint64_t word;
    memcpy(&word, bytes, sizeof word);
#if __BYTE_ORDER__ == __ORDER_BIG_ENDIAN__
    word = SWAP_BYTES_64(word);
#endif
    return (uint32_t)(word * 0x0102040810204080u >> 56);
}

/* Moves the rows of a call together in the order of their pairs, those behind the listed ones. Returns how many there
 * are. */
INLINE size_t close_gaps(const struct call *call, size_t size) {
    const struct rows *rows = call->rows;
    const ptrdiff_t stride = rows->out.stride;
    char *to = rows->out.base + rows->listed * stride;
    size_t count = (size_t)rows->listed;
    if (rows->done >= (int)call->count) /* all rows are listed */
        return count;
    for (size_t k = 0; k < call->count; k += 8)
        for (uint32_t bits = pack_bytes(rows->known + k); bits; bits &= bits - 1, to += stride, count++) {
            const char *from = rows->out.base + (ptrdiff_t)(k + (unsigned)FIND_LOWEST(bits)) * stride;
            if (from != to)
                memcpy(to, from, size);
        }
    return count;
}

/* Moves the points of a call's rows there, `listed` of them, or of `count` dense ones. */
NOINLINE void move_plane_points(const narc_batch *batch, size_t first, size_t count, const narc_rows *out,
                                size_t listed, bool manifold) {
    const bool dense = batch->query->dense != 0;
    for (size_t k = 0; k < (dense ? count : listed); k++) {
        const size_t place = dense ? narc_pair_at(batch, first + k) : k;
        char *const row = out->base + (ptrdiff_t)place * out->stride;
        union {
            uint32_t pair;
            narc_contact contact;
            narc_manifold manifold;
        } of;
        double x, y;
        memcpy(&of, row, manifold ? sizeof of.manifold : sizeof of.contact);
        const size_t points = manifold ? of.manifold.count : of.contact.count;
        if (points == 0 || !find_plane_way(batch, of.pair, &x, &y))
            continue;
        for (size_t i = 0; i < points; i++) {
            move_coordinate(manifold ? &of.manifold.point[i].x : &of.contact.point_x, x);
            move_coordinate(manifold ? &of.manifold.point[i].y : &of.contact.point_y, y);
        }
        memcpy(row, &of, manifold ? sizeof of.manifold : sizeof of.contact);
    }
}

/* Ends a call. The size is a constant, so that a row is copied by a few instructions. */
INLINE size_t end_rows(const struct call *call, size_t size) {
    const size_t count = call->rows->dense ? fill_gaps(call) : close_gaps(call, size);
    if (NARC_PIECES && !LIKELY(!call->rows->planes_first) && call->kind != SEPARATION_ROWS)
        move_plane_points(call->batch, call->first, call->count, &call->rows->out, count, call->kind == MANIFOLD_ROWS);
    return count;
}

#endif
