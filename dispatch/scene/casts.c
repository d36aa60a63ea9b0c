/* SPDX-License-Identifier: MIT
 *
 * casts.c - narc_cast_pairs(): argument checks, then pairs part by part (kernels/scene/casts.c); narc_cast_pair(), which is
 * the kernel of one cast.
 */
#include <math.h>
#include <string.h>

#include "broad_phase/steps.h"
#include "casts.h"
#include "column.h"
#include "error.h"
#include "pair.h"

/* Pairs in a part. */
enum { PART = 1024 };

static const narc_motions still;
static const narc_motion at_rest;
static const narc_cast_options defaults;

static narc_status check_number(float number, const char *name, narc_error *error) {
    return isfinite(number)
               ? NARC_OK
               : narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)number, "options.%s is %g", name, (double)number);
}

static narc_status check_options(const narc_cast_options *options, narc_error *error) {
    narc_status status = check_number(options->target, "target", error);
    if (status == NARC_OK)
        status = narc_check_length(options->tolerance, "options", "tolerance", error);
    if (status == NARC_OK)
        status = narc_check_length(options->parting, "options", "parting", error);
    return status == NARC_OK ? narc_check_reserved(options->reserved, 1, "options", error) : status;
}

/* Is a cast the other kernels': does it let go, or is there a piece of a chain? */
INLINE bool is_for_others(const narc_shapes *shapes, const narc_body *a, const narc_body *b, float parting) {
    return parting > 0 || (shapes->piece_count > 0 &&
                           (narc_is_piece(&shapes->headers[a->shape]) || narc_is_piece(&shapes->headers[b->shape])));
}

/* Pair `number` of a batch by itself, or of a call whose pairs bring their `own` bodies: 1 if it has no answer, below 0 if it is
 * the other kernels', or names what does not exist. */
INLINE int cast_alone(const narc_cast_batch *casts, size_t number, bool own) {
    const narc_batch *const batch = casts->batch;
    const narc_shapes *const shapes = batch->shapes;
    narc_one_cast one;
    narc_gathered pair;
    narc_motion motion[2];
    if (!narc_gather_pair(shapes, batch->a, batch->b, batch->pairs, own, number, &pair) ||
        is_for_others(shapes, &pair.a, &pair.b, casts->parting))
        return -1;
    size_t body[2]; /* the caller's numbers */
    UNROLL
    for (int side = 0; side < 2; side++) {
        const narc_motions *const given = casts->motions[side];
        body[side] = own ? 2 * number + (size_t)side : narc_body_at(batch->pairs, side, number);
        motion[side].x = narc_float_or(given->x, body[side], 0);
        motion[side].y = narc_float_or(given->y, body[side], 0);
        motion[side].angle = narc_float_or(given->angle, body[side], 0);
        one.motions[side] = &motion[side];
    }
    const size_t row = casts->nearest ? body[0] : number;
    one.shapes = shapes;
    one.bodies[0] = &pair.a;
    one.bodies[1] = &pair.b;
    one.target = narc_float_or(casts->targets, row, casts->target);
    one.tolerance = casts->tolerance;
    one.pair = (uint32_t)number;
    one.body = (uint32_t)body[1];
    one.nearest = casts->nearest;
    one.out_row = &casts->out[row];
    return casts->kernels->cast(&one);
}

/* A call that has a few pairs, and options that are as most are: false if it is another, or something is wrong, or the kernel
 * of one cast leaves a pair. Then a batch is to be begun. */
static bool cast_few(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                     const narc_pairs *pairs, const narc_motions *other_motions, const narc_cast_options *options,
                     narc_impact *out_rows, size_t capacity) {
    narc_batch batch; /* initialisers would clear all of it */
    narc_cast_batch casts;
    narc_impact rows[NARC_FEW]; /* where the last of them is an error the caller's stay as they are */
    narc_status status = NARC_OK;
    if (!narc_are_few(shapes, bodies, pairs) || !out_rows || capacity < pairs->count || options->targets.base ||
        (other_motions && !pairs->other_bodies) || (options != &defaults && check_options(options, NULL) != NARC_OK))
        return false;
    casts.motions[0] = motions ? motions : &still;
    casts.motions[1] = !pairs->other_bodies ? casts.motions[0] : other_motions ? other_motions : &still;
    casts.kernels = narc_kernels(&status, NULL);
    for (int side = 0; side < 2; side++)
        if (casts.motions[side]->reserved[0] || casts.motions[side]->reserved[1])
            return false;
    if (!casts.kernels)
        return false;
    batch.shapes = shapes;
    batch.a = bodies;
    batch.b = pairs->other_bodies ? pairs->other_bodies : bodies;
    batch.pairs = pairs;
    casts.batch = &batch;
    casts.target = options->target;
    casts.targets.base = casts.depths.base = NULL;
    casts.tolerance = options->tolerance;
    casts.parting = options->parting;
    casts.nearest = false;
    casts.out = pairs->count == 1 ? out_rows : rows;
    size_t skipped = 0;
    for (size_t k = 0; k < pairs->count; k++) {
        const int broken = cast_alone(&casts, k, narc_have_own_bodies(pairs));
        if (broken < 0)
            return false;
        skipped += (size_t)broken;
    }
    if (casts.out == rows)
        memcpy(out_rows, rows, pairs->count * sizeof *rows);
    if (options->out_skipped)
        *options->out_skipped = skipped;
    return true;
}

void narc_cast_range(narc_cast_job *job, size_t first, size_t end) {
    const narc_cast_batch *const casts = &job->batch;
    const narc_kernel_table *const kernels = NARC_KERNELS_FOR(end - first, casts->kernels);
    const bool few = end - first <= NARC_FEW;
    size_t skipped = 0;
    for (size_t place = first; few && place < end; place++) {
        const int broken = cast_alone(casts, narc_pair_at(casts->batch, place), false);
        skipped += broken < 0 ? kernels->casts(casts, place, place + 1) : (size_t)broken;
    }
    if (!few)
        skipped = kernels->casts(casts, first, end);
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
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
    narc_status status = check_options(options, error);
    out_job->batch.motions[0] = motions ? motions : &still;
    out_job->batch.motions[1] = other_motions ? other_motions : &still;
    if (status == NARC_OK)
        status = narc_check_reserved(out_job->batch.motions[0]->reserved, 2, "motions", error);
    if (status == NARC_OK)
        status = narc_check_reserved(out_job->batch.motions[1]->reserved, 2, "other_motions", error);
    out_job->batch.target = options->target;
    out_job->batch.tolerance = options->tolerance;
    out_job->batch.parting = options->parting;
    out_job->batch.targets = options->targets;
    out_job->batch.depths = (narc_float_column){NULL, 0};
    out_job->batch.nearest = false;
    out_job->batch.front_only = options->front_only != 0;
    atomic_init(&out_job->skipped, 0);
    return status;
}

static void cast_part(void *argument, size_t part, size_t first, size_t end) {
    (void)part;
    narc_cast_range(argument, first, end);
}

/* Apart, so that what few casts need is not on the stack beneath a batch of them. */
NOINLINE narc_status cast_batch(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                                const narc_pairs *pairs, const narc_motions *other_motions, const narc_cast_options *o,
                                narc_impact *out_rows, size_t capacity, narc_error *error) {
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

narc_status narc_cast_pairs(const narc_shapes *shapes, const narc_bodies *bodies, const narc_motions *motions,
                            const narc_pairs *pairs, const narc_motions *other_motions,
                            const narc_cast_options *options, narc_impact *out_rows, size_t capacity,
                            narc_error *error) {
    const narc_cast_options *const o = options ? options : &defaults;
    return cast_few(shapes, bodies, motions, pairs, other_motions, o, out_rows, capacity)
               ? NARC_OK
               : cast_batch(shapes, bodies, motions, pairs, other_motions, o, out_rows, capacity, error);
}

/* Two bodies through a batch, which says what is wrong, and asks the other kernels. */
NOINLINE narc_status cast_two(const narc_one_cast *asked, const narc_cast_options *options, narc_error *error) {
    if (!asked->bodies[0] || !asked->bodies[1] || !asked->out_row)
        return narc_fail_missing(error, !asked->bodies[0] ? "a" : !asked->bodies[1] ? "b" : "out_row");
    const narc_body two[] = {*asked->bodies[0], *asked->bodies[1]};
    const narc_motion ways[] = {*asked->motions[0], *asked->motions[1]};
    const narc_motions motions = {NARC_COLUMN(ways, x), NARC_COLUMN(ways, y), NARC_COLUMN(ways, angle), {NULL}};
    narc_cast_options own = *options;
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    own.targets = (narc_float_column){NULL, 0};
    own.workers = NULL;
    return cast_batch(asked->shapes, &bodies, &motions, &(narc_pairs){.count = 1}, NULL, &own, asked->out_row, 1,
                      error);
}

narc_status narc_cast_pair(const narc_shapes *shapes, const narc_body *a, const narc_motion *motion_a,
                           const narc_body *b, const narc_motion *motion_b, const narc_cast_options *options,
                           narc_impact *out_row, narc_error *error) {
    const narc_cast_options *const o = options ? options : &defaults;
    const narc_one_cast one = {.shapes = shapes,
                               .bodies = {a, b},
                               .motions = {motion_a ? motion_a : &at_rest, motion_b ? motion_b : &at_rest},
                               .target = o->target,
                               .tolerance = o->tolerance,
                               .body = 1,
                               .out_row = out_row};
    const narc_kernel_table *kernels = NULL;
    narc_status status = NARC_OK;
    if (shapes && a && b && out_row && a->shape < shapes->count && b->shape < shapes->count &&
        !is_for_others(shapes, a, b, o->parting) && (!options || check_options(options, NULL) == NARC_OK))
        kernels = narc_kernels(&status, NULL);
    const int skipped = kernels ? kernels->cast(&one) : -1;
    if (skipped < 0)
        return cast_two(&one, o, error);
    if (o->out_skipped)
        *o->out_skipped = (size_t)skipped;
    return NARC_OK;
}
