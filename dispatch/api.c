/* SPDX-License-Identifier: MIT
 *
 * api.c - the calls of narc.h: argument checks, then one call down.
 */
#include "dispatch.h"
#include "error.h"

#define TEXT_(a) #a
#define TEXT(a)  TEXT_(a)

const char *narc_version(void) {
    return TEXT(NARC_VERSION_MAJOR) "." TEXT(NARC_VERSION_MINOR) "." TEXT(NARC_VERSION_PATCH);
}

/* What all calls begin with; also finds the table. */
static narc_status begin(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                         const narc_query *query, narc_batch *out_batch, const narc_kernel_table **out_kernels,
                         narc_error *error) {
    narc_status status = narc_begin_batch(shapes, bodies, pairs, query, out_batch, error);
    if (status == NARC_OK)
        *out_kernels = narc_kernels(&status, error);
    if (status == NARC_OK)
        *out_kernels = NARC_KERNELS_FOR(out_batch->count, *out_kernels);
    return status;
}

/* The kernel for so many pairs. */
#define KERNEL_FOR(count, few, kernel) ((count) <= NARC_FEW ? (few) : (kernel))

narc_status narc_find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                               const narc_query *query, uint64_t *out_bits, narc_error *error) {
    if (narc_overlap_few(shapes, bodies, pairs, query, out_bits))
        return NARC_OK;
    narc_batch batch;
    const narc_kernel_table *kernels = NULL;
    const narc_status status = begin(shapes, bodies, pairs, query, &batch, &kernels, error);
    return status == NARC_OK ? narc_answer_overlaps(kernels->overlap, &batch, out_bits, error) : status;
}

narc_status narc_find_separations(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                  const narc_query *query, float *out_separations, narc_error *error) {
    narc_batch batch;
    const narc_kernel_table *kernels = NULL;
    const narc_status status = begin(shapes, bodies, pairs, query, &batch, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (!out_separations && batch.count > 0)
        return narc_fail_missing(error, "out_separations");
    narc_query dense = *batch.query;
    size_t found;
    dense.dense = 1;
    batch.query = &dense;
    batch.row_size = sizeof *out_separations;
    return narc_answer_rows(KERNEL_FOR(batch.count, narc_find_few_separations, kernels->separation), &batch,
                            out_separations, out_separations ? SIZE_MAX : 0, &found, error);
}

narc_status narc_answer_contacts(narc_batch *batch, narc_contact *out_rows, size_t capacity, size_t *out_count,
                                 narc_error *error) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (status != NARC_OK)
        return status;
    batch->row_size = sizeof *out_rows;
    batch->more_at = NARC_MORE_AT(narc_contact, count);
    return narc_answer_rows(KERNEL_FOR(batch->count, narc_find_few_contacts, kernels->contact), batch, out_rows,
                            capacity, out_count, error);
}

narc_status narc_find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                               const narc_query *query, narc_contact *out_rows, size_t capacity, size_t *out_count,
                               narc_error *error) {
    if (narc_answer_few(shapes, bodies, pairs, query, false, out_rows, capacity, out_count))
        return NARC_OK;
    narc_batch batch;
    const narc_status status = narc_begin_batch(shapes, bodies, pairs, query, &batch, error);
    return status == NARC_OK ? narc_answer_contacts(&batch, out_rows, capacity, out_count, error) : status;
}

narc_status narc_answer_manifolds(narc_batch *batch, narc_manifold *out_rows, size_t capacity, size_t *out_count,
                                  narc_error *error) {
    narc_status status = NARC_OK;
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (status != NARC_OK)
        return status;
    batch->row_size = sizeof *out_rows;
    batch->more_at = NARC_MORE_AT(narc_manifold, count);
    batch->flat_sine = narc_find_flat_sine(batch->query->flat_angle);
    return narc_answer_rows(KERNEL_FOR(batch->count, narc_find_few_manifolds, kernels->manifold), batch, out_rows,
                            capacity, out_count, error);
}

narc_status narc_find_manifolds(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                const narc_query *query, narc_manifold *out_rows, size_t capacity, size_t *out_count,
                                narc_error *error) {
    if (narc_answer_few(shapes, bodies, pairs, query, true, out_rows, capacity, out_count))
        return NARC_OK;
    narc_batch batch;
    const narc_status status = narc_begin_batch(shapes, bodies, pairs, query, &batch, error);
    return status == NARC_OK ? narc_answer_manifolds(&batch, out_rows, capacity, out_count, error) : status;
}

narc_status narc_compute_poses(const float *angles, size_t count, float *out_cosines, float *out_sines,
                               narc_error *error) {
    narc_status status = NARC_OK;
    const narc_kernel_table *kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    if (count > 0 && (!angles || !out_cosines || !out_sines))
        return narc_fail_missing(error, !angles ? "angles" : !out_cosines ? "out_cosines" : "out_sines");
    kernels->pose(angles, count, out_cosines, out_sines);
    return NARC_OK;
}
