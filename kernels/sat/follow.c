/* SPDX-License-Identifier: MIT
 *
 * follow.c - pairs of smooth shapes again, from what was kept of them (narc_entry): no shape is looked at.
 *
 * An entry is a circle of A and one of B, and what tells whether they stand for the bodies at other poses as well. As in
 * search.inl let u lead from the one's centre to the other's, and g = |u| less both radii. With D and E as there,
 * slack = 128 e (D + E_a + E_b); what the extents add to it is in the entry.
 *
 *   only   The circles are those of an arc each, and u lies between the arcs' normals turned inwards by more than 2^-10:
 *          the sine y of the angle from u to the nearest junction is above 2^-10. With the radius t = inner_a + inner_b
 *          certificate 3 (certificates.inl) wants t + g > 256 slack and (t + g) y > slack, and y > 2^-12. So
 *          t + g > 1024 slack is enough; `spare` is t less 1024 times the extents' part of slack.
 *   far    g > margin + slack, and the circles are those of such arcs, or hold the bodies (dispatch/contacts/entries.c).
 *
 * All that is written comes from the same operations as in the search and in contact_point.inl.
 */
#include <math.h>
#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/bodies.inl"
#include "base/call.inl"
#include "base/contact_point.inl"
#include "base/pair_setup.inl"
#include "base/shape.inl"
#include "base/vec2.inl"
#include "kernels.h"
#include "sat/kept.inl"
#include "simd/simd.h"

enum { ENTRY_WORDS = sizeof(narc_entry) / sizeof(float) };
_Static_assert(sizeof(narc_entry) == 64, "an entry is four times four words");

/* Words of an entry. */
enum {
    CENTER_A = offsetof(narc_entry, center_a) / 4,
    CENTER_B = offsetof(narc_entry, center_b) / 4,
    RADIUS_A = offsetof(narc_entry, radius_a) / 4,
    RADIUS_B = offsetof(narc_entry, radius_b) / 4,
    OF_SCALE_B = offsetof(narc_entry, scale_b) / 4,
    SPARE = offsetof(narc_entry, spare) / 4,
    EXTENTS = offsetof(narc_entry, slack) / 4,
    FEATURE = offsetof(narc_entry, feature) / 4,
    NORMALS = offsetof(narc_entry, normal) / 4
};

enum { END_WORDS = sizeof(narc_entry_ends) / sizeof(float) };

/* A normal as it was turned inwards, times some number. The upper half takes the lower one for a fraction. */
INLINE vec2 get_normal(const vf word[ENTRY_WORDS], int normal) {
    const vi both = vi_bits(word[NORMALS + normal]);
    return (vec2){v_of_int(vi_shift_left(both, 16)), v_of_int(both)};
}

/* What two circles tell of a pair in each lane. */
struct followed {
    struct arcs a, b;
    vec2 n; /* in A's frame */
    vf separation;
    vm known, wanted; /* is the answer known, and is it a row? */
};

INLINE struct followed follow_circles(const vf word[ENTRY_WORDS], const struct placement *placement, vm live) {
    const vf zero = v_set(0), margin = placement->margin;
    struct pose pose = placement->pose;
    pose.scale_b = word[OF_SCALE_B];
    struct followed f = {
        .a = {.center = {word[CENTER_A], word[CENTER_A + 1]}, .radius = word[RADIUS_A]},
        .b = {.center = place_center_b((vec2){word[CENTER_B], word[CENTER_B + 1]}, &pose), .radius = word[RADIUS_B]}};
    const vec2 u = v2_sub(f.b.center, f.a.center);
    const vf length = v2_length(u);
    f.separation = v_sub(length, v_add(f.a.radius, f.b.radius));
    f.n = v2_divide(u, length);

    const vec2 u_b = v2_unrotate_opposite(pose.rotation, u);
    const vf from_a = v_min(v2_cross(get_normal(word, 0), u), v2_cross(u, get_normal(word, 1)));
    const vf from_b = v_min(v2_cross(get_normal(word, 2), u_b), v2_cross(u_b, get_normal(word, 3)));
    const vf apart = v_mul(v_set(0x1p-17f), v_add(v_abs(pose.position.x), v_abs(pose.position.y)));
    const vm between = vm_and(live, v_le(zero, v_min(from_a, from_b)));
    const vm only = v_lt(v_mul(v_set(1024), apart), v_add(word[SPARE], f.separation));
    const vm far = v_lt(v_add(margin, v_add(apart, word[EXTENTS])), f.separation);
    const vm known = vi_lt(vi_set(0), vi_bits(word[FEATURE]));
    f.known = vm_and(vm_and(between, known), vm_or(only, far));
    f.wanted = vm_and(vm_and_not(vm_and(f.known, only), far), is_below(f.separation, margin));
    return f;
}

/* ------------------------------------------------------------------------------------------------ rows */

/* How far n may turn on an arc with these ends, start and end. */
INLINE vi find_reach_between(const vf ends[4], const struct placement *placement, vec2 n, bool is_b) {
    struct feature f = {.start = {ends[0], ends[1]}, .end = {ends[2], ends[3]}};
    const vm circle = vm_not(v_lt(v_set(0), v2_dot(f.start, f.start)));
    if (is_b) {
        f.start = v2_rotate_opposite(placement->pose.rotation, f.start);
        f.end = v2_rotate_opposite(placement->pose.rotation, f.end);
    }
    return find_reach(&f, n, vi_select(circle, vi_set(NARC_SHAPE_CIRCLE << 16), vi_set(0)), vm_front(0));
}

/* Writes rows of pairs: words of zeros but for the pair where there is no contact. */
INLINE void write_followed(const struct followed *f, const vf word[ENTRY_WORDS], const vf *ends,
                           const struct placement *placement, const int32_t *number, char *const *place) {
    const vf zero = v_set(0);
    const vm wanted = f->wanted;
    const struct feature on_a = find_feature(&f->a, &f->a, f->n, vi_set(0), false);
    const struct feature on_b = find_feature(&f->b, &f->b, f->n, vi_set(0), true);
    const vec2 normal = v2_rotate(placement->rotation_a, f->n);
    const vec2 point = v2_rotate(placement->rotation_a, v2_rotate(f->n, find_contact_place(&on_a, &on_b)));
    const vi kept = vi_bits(word[FEATURE]), feature = vi_and(kept, vi_set(0xffff)), one = vi_set(1);
    const vf n_x = v_select(wanted, normal.x, zero), n_y = v_select(wanted, normal.y, zero);
    const vf x = v_select(wanted, point.x, zero), y = v_select(wanted, point.y, zero);
    const vf separation = v_select(wanted, f->separation, zero);
    const vf radius_a = v_select(wanted, f->a.radius, zero), radius_b = v_select(wanted, f->b.radius, zero);
    if (ends) {
        const vi reach_a = find_reach_between(ends, placement, f->n, false);
        const vi reach_b = find_reach_between(ends + 4, placement, f->n, true);
        const vf head[4] = {v_of_bits(vi_load(number)), v_select(wanted, v_of_bits(one), zero), n_x, n_y};
        const vf radii[4] = {radius_a, radius_b, v_select(wanted, v_of_bits(reach_a), zero),
                             v_select(wanted, v_of_bits(reach_b), zero)};
        const vf first[4] = {x, y, separation, v_select(wanted, v_of_bits(feature), zero)};
        const vf second[4] = {zero, zero, zero, zero};
        v_put_rows(place, 0, head);
        v_put_rows(place, offsetof(narc_manifold, radius_a), radii);
        v_put_rows(place, offsetof(narc_manifold, point), first);
        v_put_rows(place, offsetof(narc_manifold, point) + sizeof(narc_manifold_point), second);
        return;
    }
    const vf front[4] = {v_select(wanted, v_of_bits(pack_halves(feature, one)), zero), separation, n_x, n_y};
    const vf rest[4] = {x, y, radius_a, radius_b};
    v_put_rows(place, offsetof(narc_contact, feature), front);
    v_put_rows(place, offsetof(narc_contact, point_x), rest);
    for (int lane = 0; lane < V_WIDTH; lane++)
        memcpy(place[lane], &number[lane], sizeof number[lane]);
}

INLINE size_t follow_pairs(const narc_batch *batch, size_t first, size_t count, const narc_entry *entries,
                           const narc_entry_ends *ends, const narc_rows *out, uint32_t *left, bool manifold) {
    const struct call call = {.batch = batch, .margin = batch->query->margin, .margins = batch->query->margins};
    const narc_rows rows = *out;
    struct sources given = copy_sources(batch);
    const enum pose_layout layout = find_layout(&given);
    given.a.scale.base = given.b.scale.base = NULL; /* entries know them */
    _Alignas(64) char room[sizeof(narc_manifold)], *place[V_WIDTH];
    struct pair_indices indices;
    size_t open = 0;
    for (size_t block = 0; block < count; block += BLOCK) {
        const int n = (int)(count - block < BLOCK ? count - block : BLOCK);
        load_pairs(&given, first + block, n, false, &indices);
        for (int k = 0; k < n; k += V_WIDTH) {
            const int32_t *const number = indices.number + k;
            const bool in_line = are_in_line(number);
            const struct placement placement = place_pairs(&call, &given, &indices, k, layout, false);
            const vm live = vm_front(n - k);
            vf word[ENTRY_WORDS];
            load_items(entries, ENTRY_WORDS, number, in_line, word);
            const struct followed f = follow_circles(word, &placement, vm_and(live, placement.in_range));
            for (uint32_t lanes = vm_bits(vm_and_not(live, f.known)); lanes; lanes &= lanes - 1)
                left[open++] = (uint32_t)number[FIND_LOWEST(lanes)];
            find_places(rows.base, rows.stride, number, vm_bits(f.known), room, place);
            vf end[END_WORDS];
            if (manifold)
                load_items(ends, END_WORDS, number, in_line, end);
            write_followed(&f, word, manifold ? end : NULL, &placement, number, place);
        }
    }
    return open;
}

NOINLINE size_t follow_contacts(const narc_batch *batch, size_t first, size_t count, const narc_entry *entries,
                                const narc_entry_ends *ends, const narc_rows *out, uint32_t *left) {
    return follow_pairs(batch, first, count, entries, ends, out, left, false);
}

NOINLINE size_t follow_manifolds(const narc_batch *batch, size_t first, size_t count, const narc_entry *entries,
                                 const narc_entry_ends *ends, const narc_rows *out, uint32_t *left) {
    return follow_pairs(batch, first, count, entries, ends, out, left, true);
}

/* Writes the rows of those of a batch's pairs first .. first + count - 1 that their entries decide, to the pairs' own
 * places, those without a contact as well; `batch->row_size` says which rows. Lists the numbers of all others in `left`,
 * in their order, and returns how many there are; their places stay as they were. The entry of pair k is entries[k];
 * of manifolds ends[k] belongs to it. Quickest where both columns of pairs are plain arrays. */
size_t NARC_NAMED(follow)(const narc_batch *batch, size_t first, size_t count, const narc_entry *entries,
                          const narc_entry_ends *ends, const narc_rows *out, uint32_t *left) {
    return batch->row_size == sizeof(narc_manifold) ? follow_manifolds(batch, first, count, entries, ends, out, left)
                                                    : follow_contacts(batch, first, count, entries, ends, out, left);
}
