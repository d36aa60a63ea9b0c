/* SPDX-License-Identifier: MIT
 *
 * pair.c - the calls of narc.h for two bodies alone.
 */
#include "dispatch.h"
#include "error.h"

#include <string.h>

/* What counts of a query; there is a row in any case. */
static narc_query find_own_query(const narc_query *given) {
    narc_query query = {.dense = 1};
    if (given) {
        query.margin = given->margin;
        query.second_margin = given->second_margin;
        query.flat_angle = given->flat_angle;
        query.front_only = given->front_only;
        query.out_skipped = given->out_skipped;
        memcpy(query.reserved, given->reserved, sizeof query.reserved);
    }
    return query;
}

/* The two as a batch, which also says what is wrong with them. */
static narc_status ask_batch(const narc_shapes *shapes, const narc_body *a, const narc_body *b, const narc_query *query,
                             bool manifold, void *out_row, narc_error *error) {
    if (!a || !b || !out_row)
        return narc_fail_missing(error, !a ? "a" : !b ? "b" : "out_row");
    const narc_body two[] = {*a, *b};
    const narc_bodies bodies = narc_view_bodies(two, 2);
    const narc_pairs pair = {.count = 1};
    const narc_query own = find_own_query(query);
    size_t count;
    return manifold ? narc_find_manifolds(shapes, &bodies, &pair, &own, out_row, 1, &count, error)
                    : narc_find_contacts(shapes, &bodies, &pair, &own, out_row, 1, &count, error);
}

narc_status narc_find_contact(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                              const narc_query *query, narc_contact *out_row, narc_error *error) {
    return ask_batch(shapes, a, b, query, false, out_row, error);
}

narc_status narc_find_manifold(const narc_shapes *shapes, const narc_body *a, const narc_body *b,
                               const narc_query *query, narc_manifold *out_row, narc_error *error) {
    return ask_batch(shapes, a, b, query, true, out_row, error);
}
