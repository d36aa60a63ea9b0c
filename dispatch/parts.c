/* SPDX-License-Identifier: MIT
 *
 * parts.c - narc_place_parts(): argument checks, then parts range by range to the kernel.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"

/* Parts in a range: some 20 microseconds of work. */
enum { PART = 4096 };

typedef struct part_job {
    narc_part_batch batch;
    const narc_kernel_table *kernels;
} part_job;

static void place_range(void *argument, size_t part, size_t first, size_t end) {
    const part_job *const job = argument;
    (void)part;
    job->kernels->parts(&job->batch, first, end);
}

static narc_status check_columns(const narc_bodies *owners, const narc_bodies *parts, narc_error *error) {
    narc_status status = narc_check_positions("owners", owners->x, owners->y, error);
    if (status == NARC_OK && !(owners->cosine.base && owners->sine.base))
        return narc_fail_missing(error, owners->cosine.base ? "owners.sine" : "owners.cosine");
    if (status == NARC_OK)
        status = narc_check_positions("parts", parts->x, parts->y, error);
    if (status == NARC_OK && !parts->cosine.base != !parts->sine.base)
        return narc_fail_missing(error, parts->cosine.base ? "parts.sine" : "parts.cosine");
    return status == NARC_OK && !parts->shape.base ? narc_fail_missing(error, "parts.shape") : status;
}

static narc_status check_sets(const narc_bodies *owners, const narc_bodies *parts, narc_error *error) {
    if (!owners || !parts)
        return narc_fail_missing(error, owners ? "parts" : "owners");
    narc_status status = narc_check_count(owners->count, UINT32_MAX, "owners", error);
    if (status == NARC_OK)
        status = narc_check_count(parts->count, UINT32_MAX, "parts", error);
    if (status == NARC_OK)
        status = narc_check_reserved(owners->reserved, 2, "owners", error);
    return status == NARC_OK ? narc_check_reserved(parts->reserved, 2, "parts", error) : status;
}

narc_status narc_place_parts(const narc_bodies *owners, const narc_bodies *parts, const narc_index_column *owner,
                             const narc_workers *workers, narc_body *out_bodies, narc_error *error) {
    narc_status status = check_sets(owners, parts, error);
    if (status != NARC_OK || parts->count == 0)
        return status;
    status = check_columns(owners, parts, error);
    if (status != NARC_OK)
        return status;
    if (!owner || !owner->base || !out_bodies)
        return narc_fail_missing(error, owner && owner->base ? "out_bodies" : "owner");
    const size_t bad = narc_find_bad_index(*owner, 0, parts->count, owners->count, workers);
    if (bad < parts->count)
        return narc_fail(error, NARC_ERROR_INDEX, bad, narc_index_at(*owner, bad),
                         "part %zu: the owner is %lu, but there are %zu owners", bad,
                         (unsigned long)narc_index_at(*owner, bad), owners->count);
    part_job job = {{*owners, *parts, *owner, out_bodies}, narc_kernels(&status, error)};
    if (job.kernels)
        narc_run_ranges(workers, parts->count, PART, place_range, &job);
    return status;
}
