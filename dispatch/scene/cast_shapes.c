/* SPDX-License-Identifier: MIT
 *
 * cast_shapes.c - narc_cast_shapes(): boxes that hold the movers all the way, the bodies of an index in them, and casts of
 * these pairs, of which each mover keeps the first impact.
 */
#include <float.h>
#include <math.h>

#include "broad_phase/steps.h"
#include "casts.h"
#include "column.h"
#include "error.h"
#include "index.h"
#include "store.h"

/* Movers of a part. */
enum { PART = 256 };

struct job {
    narc_cast_job casts;
    narc_index *index;
    const narc_bodies *movers;
    const narc_owners *owners;
    narc_float_column targets; /* of movers */
    narc_box_batch boxes;
    size_t pair_count;
};

/* ------------------------------------------------------------------------------------------------ boxes */

/* A float that is not above a number, and finite: what moves out of range is in the way of all that is there. */
static float round_down(double x) {
    const float rounded = (float)x;
    if (x < -(double)FLT_MAX)
        return -FLT_MAX;
    return (double)rounded > x ? nextafterf(rounded, -INFINITY) : rounded;
}

/* What turns lies in the circle about its position that holds its bounding circle, whatever its angle. */
static narc_box turn_box(const struct job *job, size_t k) {
    const narc_shape_header *const header = &job->boxes.shapes->headers[narc_index_at(job->movers->shape, k)];
    const double x = narc_position_at(job->movers->x, k) - job->index->origin.x;
    const double y = narc_position_at(job->movers->y, k) - job->index->origin.y;
    const double bound_x = (double)header->bound_x, bound_y = (double)header->bound_y;
    const double scale = (double)narc_float_or(job->movers->scale, k, 1);
    const double bound = (double)header->bound_radius, tolerance = (double)job->casts.batch.tolerance;
    const double radius =
        scale * (bound + sqrt(bound_x * bound_x + bound_y * bound_y)) +
        (tolerance > 0 ? tolerance : NARC_TURNING_TOLERANCE * scale * bound); /* as far as a hit may be */
    return (narc_box){round_down(x - radius), round_down(y - radius), -round_down(-x - radius),
                      -round_down(-y - radius)};
}

/* The box of a mover all the way, with its target. */
static narc_box sweep_box(const struct job *job, size_t k, narc_box still, float motion_x, float motion_y) {
    const double target = (double)narc_float_or(job->casts.batch.targets, k, job->casts.batch.target),
                 room = target > 0 ? target * (1 + 0x1p-20) : 0, x = (double)motion_x, y = (double)motion_y;
    return (narc_box){round_down((double)still.min_x + (x < 0 ? x : 0) - room),
                      round_down((double)still.min_y + (y < 0 ? y : 0) - room),
                      -round_down(-(double)still.max_x - (x > 0 ? x : 0) - room),
                      -round_down(-(double)still.max_y - (y > 0 ? y : 0) - room)};
}

static void find_boxes(void *argument, size_t part, size_t first, size_t end) {
    const narc_box empty = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    struct job *const job = argument;
    narc_box *const boxes = job->index->sweeps;
    const narc_motions *const motions = job->casts.batch.motions[0];
    size_t skipped = job->casts.batch.kernels->box(&job->boxes, NULL, first, end - first, boxes);
    (void)part;
    for (size_t k = first; k < end; k++) {
        const float x = narc_float_or(motions->x, k, 0), y = narc_float_or(motions->y, k, 0),
                    angle = narc_float_or(motions->angle, k, 0);
        if (!(boxes[k].min_x <= boxes[k].max_x)) /* broken, and counted */
            continue;
        if (!isfinite(x) || !isfinite(y) || !isfinite(angle)) {
            skipped++;
            boxes[k] = empty;
            continue;
        }
        boxes[k] = sweep_box(job, k, angle == 0 ? boxes[k] : turn_box(job, k), x, y);
    }
    atomic_fetch_add_explicit(&job->casts.skipped, skipped, memory_order_relaxed);
}

/* ------------------------------------------------------------------------------------------------ things */

/* How far apart pairs first .. end - 1 are at the start; infinite where that says nothing, as of pieces of chains. */
static void find_separations(const struct job *job, size_t first, size_t end) {
    const narc_batch *const all = job->casts.batch.batch;
    narc_start *const starts = job->index->starts;
    const narc_query query = {.margin = INFINITY, .dense = 1};
    const narc_rows rows = {.base = (char *)&starts->separation, .stride = sizeof *starts};
    narc_batch batch = *all;
    size_t skipped = 0;
    batch.query = &query;
    for (size_t k = first, count; k < end; k += count) {
        count = end - k < NARC_ROW_GROUP ? end - k : NARC_ROW_GROUP;
        job->casts.batch.kernels->separation(&batch, k, count, &skipped, &rows);
    }
    for (size_t k = first; k < end && all->shapes->piece_count > all->shapes->plane_count; k++)
        for (int side = 0; side < 2; side++)
            if (narc_is_of_chain(&all->shapes->headers[narc_find_side(all, k, side).shape]))
                starts[k].separation = INFINITY;
}

static uint32_t find_owner(const struct job *job, size_t pair) {
    return narc_index_at(job->owners->owner, narc_index_at(job->casts.batch.batch->pairs->b, pair));
}

/* By owner, the deepest first. */
static bool comes_before(const void *context, uint32_t one, uint32_t other) {
    const struct job *const job = context;
    const uint32_t owner = find_owner(job, one), other_owner = find_owner(job, other);
    return owner != other_owner ? owner < other_owner
                                : job->index->starts[one].separation < job->index->starts[other].separation;
}

/* Of pairs in that order the first one of an owner, or `count`. */
static size_t find_deepest(const struct job *job, const uint32_t *order, size_t count, uint32_t owner) {
    size_t low = 0, high = count;
    while (low < high) {
        const size_t middle = low + (high - low) / 2;
        if (find_owner(job, order[middle]) < owner)
            low = middle + 1;
        else
            high = middle;
    }
    return low < count && find_owner(job, order[low]) == owner ? low : count;
}

/* Targets and depths of a mover's pairs, first .. end - 1. One that is at its target from a part of a thing counts as that
 * deep in all others. */
static void find_depths(const struct job *job, size_t mover, size_t first, size_t end) {
    const narc_cast_batch *const casts = &job->casts.batch;
    const float target = narc_float_or(job->targets, mover, casts->target);
    narc_start *const starts = job->index->starts;
    uint32_t *const order = job->index->found + first; /* which the pairs were made from: there is room for each */
    size_t count = 0;
    for (size_t k = first; k < end; k++) {
        starts[k].target = target;
        starts[k].depth = INFINITY;
        if (starts[k].separation <= target && find_owner(job, k) != UINT32_MAX)
            order[count++] = (uint32_t)k;
    }
    narc_sort_indices(order, count, comes_before, job);
    for (size_t k = first; k < end && count > 0; k++) {
        const size_t deepest = find_deepest(job, order, count, find_owner(job, k));
        if (deepest == count)
            continue;
        if (starts[k].separation <= target)
            starts[k].depth = starts[order[deepest]].separation;
        else
            starts[k].target = fminf(target, starts[order[deepest]].separation - casts->parting);
    }
}

static void measure_starts(void *argument, size_t part, size_t first, size_t end) {
    const struct job *const job = argument;
    const narc_region *const regions = job->index->regions;
    (void)part;
    find_separations(job, regions[first].row, regions[end - 1].row + regions[end - 1].count);
    for (size_t k = first; k < end; k++)
        find_depths(job, k, regions[k].row, regions[k].row + regions[k].count);
}

/* ------------------------------------------------------------------------------------------------ the call */

static void cast_movers(void *argument, size_t part, size_t first, size_t end) {
    struct job *const job = argument;
    (void)part;
    for (size_t k = first; k < end; k++)
        job->casts.batch.out[k] = (narc_impact){.pair = (uint32_t)k};
    if (job->pair_count == 0)
        return;
    const narc_region *const regions = job->index->regions, last = regions[end - 1];
    narc_cast_range(&job->casts, regions[first].row, last.row + last.count);
}

static narc_status check_arguments(const narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                                   const narc_bodies *movers, const narc_index_query *search,
                                   const narc_impact *out_rows, size_t capacity, narc_error *error) {
    size_t all_movers = 0;
    if (!index || !shapes || !bodies || !movers)
        return narc_fail_missing(error, !index ? "index" : !shapes ? "shapes" : !bodies ? "bodies" : "movers");
    narc_status status = narc_check_search(index, search, "search", error);
    if (status == NARC_OK)
        status = narc_check_indexed(index, bodies, error);
    if (status == NARC_OK)
        status = narc_check_bodies(shapes, movers, 0, &all_movers, search->workers, error);
    if (status == NARC_OK && movers->count > 0 && !out_rows)
        status = narc_fail_missing(error, "out_rows");
    if (status == NARC_OK && capacity < movers->count)
        status = narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)movers->count, "%zu rows, but there is room for %zu",
                           movers->count, capacity);
    return status;
}

narc_status narc_cast_shapes(narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                             const narc_bodies *movers, const narc_motions *motions, const narc_index_query *search,
                             const narc_cast_options *options, narc_impact *out_rows, size_t capacity,
                             narc_error *error) {
    static const narc_cast_options no_options = {0};
    static const narc_index_query no_search = {.workers = NULL};
    const narc_cast_options *const o = options ? options : &no_options;
    const narc_index_query *const q = search ? search : &no_search;
    const narc_query query = {.workers = q->workers};
    struct job job;
    narc_batch batch;
    narc_pairs pairs;
    narc_status status = narc_check_casts(motions, NULL, o, &job.casts, error);
    if (status == NARC_OK)
        status = check_arguments(index, shapes, bodies, movers, q, out_rows, capacity, error);
    if (status == NARC_OK)
        status = narc_check_targets(&job.casts, movers->count, error);
    if (status == NARC_OK && !(job.casts.batch.kernels = narc_kernels(&status, error)))
        return status;
    if (status == NARC_OK && narc_reserve_sweeps(index, movers->count) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)movers->count, "no memory for %zu movers", movers->count);
    if (status != NARC_OK)
        return status;
    job.index = index;
    job.movers = movers;
    job.boxes = (narc_box_batch){.shapes = shapes, .bodies = movers, .origin = &index->origin};
    narc_run_ranges(q->workers, movers->count, PART, find_boxes, &job);
    status = narc_query_index(index, index->sweeps, movers->count, q, &pairs, error);
    pairs.other_bodies = bodies;
    if (status == NARC_OK)
        status = narc_begin_batch(shapes, movers, &pairs, &query, &batch, error);
    if (status != NARC_OK)
        return status;
    job.pair_count = pairs.count;
    job.casts.batch.batch = &batch;
    job.casts.batch.out = out_rows;
    job.casts.batch.nearest = true;
    if (q->owners && o->parting > 0 && pairs.count > 0) {
        if (narc_reserve_starts(index, pairs.count) != NARC_OK)
            return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)pairs.count, "no memory for %zu pairs", pairs.count);
        job.owners = q->owners;
        job.targets = job.casts.batch.targets;
        narc_run_ranges(q->workers, movers->count, PART, measure_starts, &job);
        job.casts.batch.targets = NARC_COLUMN(index->starts, target);
        job.casts.batch.depths = NARC_COLUMN(index->starts, depth);
    }
    narc_run_ranges(q->workers, movers->count, PART, cast_movers, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.casts.skipped, memory_order_relaxed);
    return NARC_OK;
}
