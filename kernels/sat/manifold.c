/* SPDX-License-Identifier: MIT
 *
 * manifold.c - the manifold kernel: contacts with a second point where edges face each other (manifold_edges.inl), with
 * ids of the points, and how far the touching arcs go on.
 */
#include <stddef.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "kernels.h"
#include "sat/answers.inl"
#include "sat/manifold_edges.inl"
#include "simd/simd.h"

/* Bytes of a row's members. */
enum {
    RADII = offsetof(narc_manifold, radius_a),
    FIRST_POINT = offsetof(narc_manifold, point),
    SECOND_POINT = FIRST_POINT + sizeof(narc_manifold_point)
};
_Static_assert(sizeof(narc_manifold) == 64 && RADII == 16 && FIRST_POINT == 32, "four writes of four words");

INLINE void write_manifolds(const struct call *call, char *const *place, vi numbers, const struct answer *answer,
                            const struct sides *sides) {
    const vf zero = v_set(0);
    struct manifold_points m = {
        .count = vi_set(1),
        .radius_a = answer->radius_a,
        .radius_b = answer->radius_b,
        .first = {answer->point.x, answer->point.y, answer->separation, v_of_bits(answer->feature)},
        .second = {zero, zero, zero, zero}};
    if (sides)
        m = find_manifold_points(call, answer, sides);
    const vf head[4] = {v_of_bits(numbers), v_of_bits(m.count), answer->normal.x, answer->normal.y};
    const vf radii[4] = {m.radius_a, m.radius_b, v_of_bits(answer->reach_a), v_of_bits(answer->reach_b)};
    v_put_rows(place, 0, head);
    v_put_rows(place, RADII, radii);
    v_put_rows(place, FIRST_POINT, m.first);
    v_put_rows(place, SECOND_POINT, m.second);
}

static void write_no_manifold(char *place, uint32_t pair, float separation) {
    const narc_manifold manifold = {.pair = pair, .point = {{.separation = separation}}};
    memcpy(place, &manifold, sizeof manifold);
}

NARC_QUESTION(manifold, narc_manifold, offsetof(narc_manifold, normal_x), NARC_MORE_ROW, write_no_manifold,
              write_manifolds, true, NULL)
NARC_ROWS(manifolds, narc_manifold, write_manifolds, STAGES)

size_t NARC_NAMED(manifold)(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                            const narc_rows *out) {
    return answer_manifolds(&manifold_question, batch, first, count, skipped, out);
}
