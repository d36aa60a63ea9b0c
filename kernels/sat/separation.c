/* SPDX-License-Identifier: MIT
 *
 * separation.c - the separation kernel: of each pair one float, that of its contact; INFINITY where there is none.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/contact_point.inl"
#include "kernels.h"
#include "sat/answers.inl"
#include "simd/simd.h"

static inline void write_separations(const struct call *call, char *const *place, vi numbers,
                                     const struct answer *answer, const struct sides *sides) {
    float separation[V_WIDTH];
    (void)call, (void)numbers, (void)sides;
    v_store(separation, answer->separation);
    for (int lane = 0; lane < V_WIDTH; lane++)
        memcpy(place[lane], &separation[lane], sizeof separation[lane]);
}

static void write_no_separation(char *place, uint32_t pair, float separation) {
    const float none = INFINITY;
    (void)pair, (void)separation;
    memcpy(place, &none, sizeof none);
}

NARC_QUESTION(separation, float, 0, 0, write_no_separation, write_separations, false, write_separations)

size_t NARC_NAMED(separation)(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                              const narc_rows *out) {
    return NARC_NAMED(rows)(&separation_question, batch, first, count, skipped, out);
}
