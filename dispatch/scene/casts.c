/* SPDX-License-Identifier: MIT
 *
 * casts.c - narc_cast_pairs(): argument checks, then pairs part by part (kernels/scene/casts.c).
 */
#include <math.h>

#include "broad_phase/steps.h"
#include "casts.h"
#include "column.h"
#include "error.h"

/* Pairs in a part. */
enum { PART = 1024 };

#if !NARC_SMALL
/* A cast by itself. Returns 1 if it has no answer. */
static size_t cast_alone(const narc_cast_batch *casts, size_t place) {
    const narc_batch *const batch = casts->batch;
    const size_t number = narc_pair_at(batch, place);
    narc_one_cast one;
    narc_gather_pair(batch, number, &one.bodies[0], &one.bodies[1]);
    const narc_shape_header *const headers = batch->shapes->headers;
    for (int side = 0; side < 2; side++) {
        const narc_motions *const given = &casts->motions[side];
        const size_t body = narc_body_at(batch->pairs, side, number);
        one.motions[side][0] = narc_float_or(given->x, body, 0);
        one.motions[side][1] = narc_float_or(given->y, body, 0);
        one.motions[side][2] = narc_float_or(given->angle, body, 0);
        one.body = (uint32_t)body;
    }
    const size_t row = casts->nearest ? narc_body_at(batch->pairs, 0, number) : number;
    one.shapes = batch->shapes;
    one.target = narc_float_or(casts->targets, row, casts->target);
    one.tolerance = casts->tolerance;
    one.pair = (uint32_t)number;
    one.nearest = casts->nearest;
    one.out_row = &casts->out[row];
    const bool pieces = batch->shapes->piece_count > 0 &&
                        (narc_is_piece(&headers[one.bodies[0].shape]) || narc_is_piece(&headers[one.bodies[1].shape]));
    const int skipped = pieces || casts->parting > 0 ? -1 : casts->kernels->cast(&one);
    return skipped < 0 ? NARC_KERNELS_FOR(1, casts->kernels)->casts(casts, place, place + 1) : (size_t)skipped;
}
#endif

void narc_cast_range(narc_cast_job *job, size_t first, size_t end) {
    size_t skipped = 0;
#if !NARC_SMALL
    if (end - first <= NARC_FEW)
        while (first < end)
            skipped += cast_alone(&job->batch, first++);
    else
#endif
        skipped = job->batch.kernels->casts(&job->batch, first, end);
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

static narc_status check_number(float number, const char *name, narc_error *error) {
    return isfinite(number)
               ? NARC_OK
               : narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)number, "options.%s is %g", name, (double)number);
}

narc_status narc_check_targets(const narc_cast_job *job, size_t count, narc_error *error) {
    for (size_t k = 0; job->batch.targets.base && k < count; k++) {
        const double target = (double)narc_float_at(job->batch.targets, k);
        if (!isfinite(target))
            return narc_fail(error, NARC_ERROR_NOT_FINITE, k, target, "options.targets[%zu] is %g", k, target);
    }
    return NARC_OK;
}

narc_status narc_check_casts(const narc_motions *motions, const narc_motions *other_motions,
                             const narc_cast_options *options, narc_cast_job *out_job, narc_error *error) {
    static const narc_motions none = {.x = {0}};
    const narc_motions *const both[2] = {motions ? motions : &none, other_motions ? other_motions : &none};
    narc_status status = check_number(options->target, "target", error);
    if (status == NARC_OK)
        status = narc_check_length(options->tolerance, "options", "tolerance", error);
    if (status == NARC_OK)
        status = narc_check_length(options->parting, "options", "parting", error);
    if (status == NARC_OK)
        status = narc_check_reserved(options->reserved, 1, "options", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[0]->reserved, 2, "motions", error);
    if (status == NARC_OK)
        status = narc_check_reserved(both[1]->reserved, 2, "other_motions", error);
    out_job->batch.motions[0] = *both[0];
    out_job->batch.motions[1] = *both[1];
    out_job->batch.target = options->target;
    out_job->batch.tolerance = options->tolerance;
    out_job->batch.parting = options->parting;
    out_job->batch.targets = options->targets;
    out_job->batch.nearest = false;
    out_job->batch.front_only = options->front_only != 0;
    atomic_init(&out_job->skipped, 0);
    return status;
}

static void cast_part(void *argument, size_t part, size_t first, size_t end) {
    (void)part;
    narc_cast_range(argument, first, end);
}

narc_status narc_cast_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                            const narc_pairs *pairs, const narc_motions *other_motions,
                            const narc_cast_options *options, narc_impact *out_rows, size_t capacity,
                            narc_error *error) {
    static const narc_cast_options defaults = {0};
    const narc_cast_options *const o = options ? options : &defaults;
    narc_query query;
    narc_batch batch;
    narc_cast_job job;
    narc_status status = narc_check_casts(motions, other_motions, o, &job, error);
    if (o->workers)
        query = (narc_query){.workers = o->workers};
    if (status == NARC_OK)
        status = narc_begin_batch(shapes, bodies, pairs, o->workers ? &query : NULL, &batch, error);
    if (status != NARC_OK)
        return status;
    if (!pairs->other_bodies && other_motions)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, 0, "other_motions is not NULL, but there are no other bodies");
    if (pairs->count > 0 && !out_rows)
        return narc_fail_missing(error, "out_rows");
    if (capacity < pairs->count)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)pairs->count, "%zu rows, but there is room for %zu",
                         pairs->count, capacity);
    status = narc_check_targets(&job, pairs->count, error);
    if (status != NARC_OK)
        return status;
    if (!pairs->other_bodies)
        job.batch.motions[1] = job.batch.motions[0];
    job.batch.batch = &batch;
    job.batch.out = out_rows;
    job.batch.kernels = narc_kernels(&status, error);
    if (!job.batch.kernels)
        return status;
    narc_run_ranges(o->workers, pairs->count, PART, cast_part, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return NARC_OK;
}
