/* SPDX-License-Identifier: MIT
 *
 * separation.c - the separation kernel: of each pair one float, that of its contact; INFINITY where there is none.
 */
#include <math.h>
#include <stdint.h>
#include <string.h>

#include "base/call.inl"
#include "base/question.inl"
#include "base/rows.inl"
#include "kernels.h"

static void write_no_separation(char *place, uint32_t pair, float separation) {
    const float none = INFINITY;
    (void)pair, (void)separation;
    memcpy(place, &none, sizeof none);
}

size_t NARC_NAMED(separation)(const narc_batch *batch, size_t first, size_t count, size_t *skipped,
                              const narc_rows *out) {
    static const struct question separations = {.kind = SEPARATION_ROWS, .none = write_no_separation};
    struct rows rows;
    const struct call call = begin_rows(&separations, batch, first, count, skipped, out, &rows);
    NARC_NAMED(find_rows)(&call);
    return end_rows(&call, sizeof(float));
}
