/* SPDX-License-Identifier: MIT
 *
 * check.c - the checks of a batch.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"

narc_status narc_fail_missing(narc_error *error, const char *name) {
    return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "%s is NULL", name);
}

/* Says which of pair number `pair`'s indices is out of range. */
static narc_status describe_bad_pair(const narc_batch *batch, size_t pair, narc_error *error) {
    const narc_index_column columns[2] = {batch->pairs->a, batch->pairs->b};
    for (int k = 0; k < 2; k++) {
        const uint32_t body = narc_index_at(columns[k], pair);
        if (body >= batch->bodies->count)
            return narc_fail(error, NARC_ERROR_INDEX, pair, body, "pair %zu: body %c is %lu, but there are %zu bodies",
                             pair, "ab"[k], (unsigned long)body, batch -> bodies -> count);
        const uint32_t shape = narc_index_at(batch->bodies->shape, body);
        if (shape >= batch->shapes->count)
            return narc_fail(error, NARC_ERROR_INDEX, pair, shape,
                             "pair %zu: body %lu has shape %lu, but there are %zu shapes", pair, (unsigned long)body,
                             (unsigned long)shape, batch->shapes->count);
    }
    return NARC_OK;
}

narc_status narc_check_pairs(const narc_batch *batch, size_t first, size_t count, unsigned threads, narc_error *error) {
    const narc_pairs *pairs = batch->pairs;
    const narc_bodies *bodies = batch->bodies;
    if (!batch->shapes || !bodies || !pairs)
        return narc_fail_missing(error, !batch->shapes ? "shapes" : !bodies ? "bodies" : "pairs");
    if (pairs->count > UINT32_MAX)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)pairs->count, "%zu pairs in one batch, at most %lu",
                         pairs->count, (unsigned long)UINT32_MAX);
    if (first > pairs->count || count > pairs->count - first)
        return narc_fail(error, NARC_ERROR_ARGUMENT, first, (double)count,
                         "pairs %zu and the %zu from there on, but there are %zu", first, count, pairs->count);
    if (count > 0) {
        if (!pairs->a.base || !pairs->b.base)
            return narc_fail_missing(error, !pairs->a.base ? "pairs.a" : "pairs.b");
        const narc_status columns = bodies->count > 0 ? narc_check_columns(bodies, error) : NARC_OK;
        if (columns != NARC_OK)
            return columns;
        const size_t bad = narc_find_bad_pair(batch, first, count, threads);
        if (bad < first + count)
            return describe_bad_pair(batch, bad, error);
    }
    return NARC_OK;
}
