/* SPDX-License-Identifier: MIT
 *
 * query.c - the batch calls that take a query: hints, and how many pairs have no answer.
 */
#include "dispatch.h"

narc_status narc_query_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query, unsigned threads, uint64_t *out_bits, narc_error *error) {
    narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    const narc_kernel_table *kernels = NULL;
    if (!query)
        return narc_fail_missing(error, "query");
    const narc_status status = narc_check_batch(&batch, 0, pairs ? pairs->count : 0, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (pairs->count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    if (query->out_skipped)
        *query->out_skipped = 0;
    batch.skipped = query->out_skipped;
    narc_run_overlaps(kernels->overlap, &batch, threads, out_bits);
    return NARC_OK;
}

narc_status narc_query_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query, float margin, unsigned threads,
                                const narc_contacts *out_contacts, size_t *out_count, narc_error *error) {
    if (!query)
        return narc_fail_missing(error, "query");
    size_t skipped = 0;
    const narc_batch batch = {.shapes = shapes,
                              .bodies = bodies,
                              .pairs = pairs,
                              .hints = query->hints,
                              .skipped = query->out_skipped ? &skipped : NULL};
    const narc_kernel_table *kernels = NULL;
    narc_status status = narc_check_batch(&batch, 0, pairs ? pairs->count : 0, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    status =
        narc_list_contacts(kernels->contact, &batch, 0, pairs->count, margin, threads, out_contacts, out_count, error);
    if (query->out_skipped && (status == NARC_OK || status == NARC_ERROR_CAPACITY))
        *query->out_skipped = skipped;
    return status;
}
