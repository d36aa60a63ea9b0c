/* SPDX-License-Identifier: MIT
 *
 * cast_shapes.c - narc_cast_shapes(): boxes that hold the movers all the way, the bodies of an index in them, and casts of
 * these pairs, of which each mover keeps the first impact.
 */
#include <math.h>

#include "casts.h"
#include "column.h"
#include "error.h"
#include "index.h"

/* Movers of a part. */
enum { PART = 256 };

struct job {
    narc_cast_job casts;
    const narc_index *index;
    const narc_bodies *movers;
    narc_box_batch boxes;
    size_t pair_count;
};

/* ------------------------------------------------------------------------------------------------ boxes */

/* A float that is not above a number. */
static float round_down(double x) {
    const float rounded = (float)x;
    return (double)rounded > x ? nextafterf(rounded, -INFINITY) : rounded;
}

static double at_or_0(narc_float_column column, size_t item) {
    return column.base ? (double)narc_float_at(column, item) : 0;
}

/* From the least to the largest coordinate on a way, with so much room. */
static void sweep(double from, double motion, double room, float *out_min, float *out_max) {
    *out_min = round_down((motion < 0 ? from + motion : from) - room);
    *out_max = -round_down(-((motion > 0 ? from + motion : from) + room));
}

/* What turns lies in the circle about its position that holds its bounding circle, whatever its angle. */
static narc_box sweep_circle(const struct job *job, size_t k) {
    const narc_motions *const motions = &job->casts.motions[0];
    const narc_shape_header *const header = &job->boxes.shapes->headers[narc_index_at(job->movers->shape, k)];
    const double x = (double)header->bound_x, y = (double)header->bound_y;
    const double scale = job->movers->scale.base ? (double)narc_float_at(job->movers->scale, k) : 1;
    const double radius = (double)header->bound_radius, tolerance = (double)job->casts.tolerance;
    const double room =
        scale * (radius + sqrt(x * x + y * y)) + (double)job->boxes.margin +
        (tolerance > 0 ? tolerance : NARC_TURNING_TOLERANCE * scale * radius); /* as far as a hit may be */
    narc_box box;
    sweep(narc_position_at(job->movers->x, k), at_or_0(motions->x, k), room, &box.min_x, &box.max_x);
    sweep(narc_position_at(job->movers->y, k), at_or_0(motions->y, k), room, &box.min_y, &box.max_y);
    return box;
}

static void find_boxes(void *argument, size_t part, size_t first, size_t end) {
    const narc_box empty = {INFINITY, INFINITY, -INFINITY, -INFINITY};
    struct job *const job = argument;
    narc_box *const boxes = job->index->sweeps;
    const narc_float_column angle = job->casts.motions[0].angle;
    size_t skipped = job->casts.kernels->box(&job->boxes, NULL, first, end - first, boxes);
    (void)part;
    for (size_t k = first; angle.base && k < end; k++) {
        const float turn = narc_float_at(angle, k);
        if (turn == 0 || !(boxes[k].min_x <= boxes[k].max_x)) /* broken, and counted */
            continue;
        skipped += isfinite(turn) ? 0 : 1;
        boxes[k] = isfinite(turn) ? sweep_circle(job, k) : empty;
    }
    atomic_fetch_add_explicit(&job->casts.skipped, skipped, memory_order_relaxed);
}

/* ------------------------------------------------------------------------------------------------ the call */

static void cast_movers(void *argument, size_t part, size_t first, size_t end) {
    struct job *const job = argument;
    (void)part;
    for (size_t k = first; k < end; k++)
        job->casts.rows[k] = (narc_impact){.pair = (uint32_t)k};
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
    narc_status status = narc_check_reserved(search->reserved, 4, "search", error);
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
    if (status == NARC_OK && !(job.casts.kernels = narc_kernels(&status, error)))
        return status;
    if (status == NARC_OK && narc_reserve_sweeps(index, movers->count) != NARC_OK)
        return narc_fail(error, NARC_ERROR_MEMORY, 0, (double)movers->count, "no memory for %zu movers", movers->count);
    if (status != NARC_OK)
        return status;
    job.index = index;
    job.movers = movers;
    job.boxes =
        (narc_box_batch){shapes, movers, o->target > 0 ? o->target : 0, job.casts.motions[0].x, job.casts.motions[0].y};
    narc_run_ranges(q->workers, movers->count, PART, find_boxes, &job);
    status = narc_query_index(index, index->sweeps, movers->count, q, &pairs, error);
    pairs.other_bodies = bodies;
    if (status == NARC_OK)
        status = narc_begin_batch(shapes, movers, &pairs, &query, &batch, error);
    if (status != NARC_OK)
        return status;
    job.pair_count = pairs.count;
    job.casts.batch = &batch;
    job.casts.rows = out_rows;
    job.casts.nearest = true;
    narc_run_ranges(q->workers, movers->count, PART, cast_movers, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.casts.skipped, memory_order_relaxed);
    return NARC_OK;
}
