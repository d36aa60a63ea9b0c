/* SPDX-License-Identifier: MIT
 *
 * api.c - the batch calls of narc.h: argument checks, then one call down.
 */
#include "dispatch.h"
#include "error.h"

#ifdef _OPENMP
#include <omp.h>
#endif

#define TEXT_(a) #a
#define TEXT(a)  TEXT_(a)

const char *narc_version(void) {
    return TEXT(NARC_VERSION_MAJOR) "." TEXT(NARC_VERSION_MINOR) "." TEXT(NARC_VERSION_PATCH);
}

unsigned narc_default_threads(void) {
#ifdef _OPENMP
    return (unsigned)omp_get_max_threads();
#else
    return 1;
#endif
}

narc_status narc_check_batch(const narc_batch *batch, size_t first, size_t count, unsigned threads,
                             const narc_kernel_table **out_kernels, narc_error *error) {
    narc_status status = narc_check_pairs(batch, first, count, threads, error);
    if (status == NARC_OK)
        *out_kernels = narc_kernels(&status, error);
    return status;
}

narc_status narc_find_overlaps(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                               unsigned threads, uint64_t *out_bits, narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    const narc_kernel_table *kernels = NULL;
    const narc_status status = narc_check_batch(&batch, 0, pairs ? pairs->count : 0, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (pairs->count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    narc_run_overlaps(kernels->overlap, &batch, threads, out_bits);
    return NARC_OK;
}

narc_status narc_find_overlaps_range(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                     size_t first, size_t count, uint64_t *out_bits, narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    const narc_kernel_table *kernels = NULL;
    const narc_status status = narc_check_batch(&batch, first, count, 1, &kernels, error);
    if (status != NARC_OK)
        return status;
    if (first % 64 != 0 || (count % 64 != 0 && first + count != pairs->count))
        return narc_fail(error, NARC_ERROR_ARGUMENT, first, (double)count,
                         "pairs %zu and the %zu from there on do not begin and end at multiples of 64", first, count);
    if (count > 0 && !out_bits)
        return narc_fail_missing(error, "out_bits");
    if (count > 0)
        kernels->overlap(&batch, first, count, out_bits + first / 64);
    return NARC_OK;
}

static narc_status find_contacts(const narc_batch *batch, size_t first, size_t count, float margin, unsigned threads,
                                 const narc_contacts *out_contacts, size_t *out_count, narc_error *error) {
    const narc_kernel_table *kernels = NULL;
    const narc_status status = narc_check_batch(batch, first, count, threads, &kernels, error);
    if (status != NARC_OK)
        return status;
    return narc_list_contacts(kernels->contact, batch, first, count, margin, threads, out_contacts, out_count, error);
}

narc_status narc_find_contacts(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                               float margin, unsigned threads, const narc_contacts *out_contacts, size_t *out_count,
                               narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    return find_contacts(&batch, 0, pairs ? pairs->count : 0, margin, threads, out_contacts, out_count, error);
}

narc_status narc_find_contacts_hinted(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                      float margin, unsigned threads, uint32_t *hints,
                                      const narc_contacts *out_contacts, size_t *out_count, narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs, .hints = hints};
    if (!hints && pairs && pairs->count > 0)
        return narc_fail_missing(error, "hints");
    return find_contacts(&batch, 0, pairs ? pairs->count : 0, margin, threads, out_contacts, out_count, error);
}

narc_status narc_find_contacts_range(const narc_shapes *shapes, const narc_bodies *bodies, const narc_pairs *pairs,
                                     size_t first, size_t count, float margin, const narc_contacts *out_contacts,
                                     size_t *out_count, narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs};
    return find_contacts(&batch, first, count, margin, 1, out_contacts, out_count, error);
}

narc_status narc_find_contacts_hinted_range(const narc_shapes *shapes, const narc_bodies *bodies,
                                            const narc_pairs *pairs, size_t first, size_t count, float margin,
                                            uint32_t *hints, const narc_contacts *out_contacts, size_t *out_count,
                                            narc_error *error) {
    const narc_batch batch = {.shapes = shapes, .bodies = bodies, .pairs = pairs, .hints = hints};
    if (!hints && count > 0)
        return narc_fail_missing(error, "hints");
    return find_contacts(&batch, first, count, margin, 1, out_contacts, out_count, error);
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
