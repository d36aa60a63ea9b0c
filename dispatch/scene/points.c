/* SPDX-License-Identifier: MIT
 *
 * points.c - narc_find_distances(), narc_find_inside() and narc_find_nearest(): argument checks, then points part by part to the kernels.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "index.h"
#include "pair.h"

#include <math.h>

/* Points in a part: some 20 microseconds of work; a multiple of 64. */
enum { PART = 512, NEAREST_PART = 128 };

typedef struct point_job {
    narc_point_batch batch;
    void (*kernel)(const narc_point_batch *batch, size_t first, size_t end);
    const narc_kernel_table *kernels;
    uint64_t *out_bits; /* of points that may be within bodies */
} point_job;

static void answer_part(void *argument, size_t part, size_t first, size_t end) {
    const point_job *job = argument;
    (void)part;
    job->kernel(&job->batch, first, end);
}

/* What all calls begin with. Shapes are looked at where bodies are named. */
static narc_status check_points(const narc_shapes *shapes, const narc_bodies *bodies, const narc_points *points,
                                narc_error *error) {
    if (!shapes || !bodies || !points)
        return narc_fail_missing(error, !shapes ? "shapes" : !bodies ? "bodies" : "points");
    narc_status status = narc_check_count(points->count, UINT32_MAX, "points", error);
    if (status == NARC_OK)
        status = narc_check_reserved(points->reserved, 2, "points", error);
    return status == NARC_OK && points->count > 0 ? narc_check_positions("points", points->x, points->y, error)
                                                  : status;
}

/* A batch of one point, if nothing is wrong. */
static bool begin_one(const narc_shapes *shapes, const narc_bodies *bodies, const narc_points *points,
                      const narc_index_column *body, narc_point_batch *out) {
    if (!shapes || !bodies || !points || !narc_is_one(shapes, bodies, points->count, body) ||
        !narc_has_positions(&points->x, &points->y) || points->reserved[0] || points->reserved[1])
        return false;
    out->shapes = shapes;
    out->bodies = bodies;
    out->points = points;
    out->body = body ? *body : (narc_index_column){NULL, 0};
    return true;
}

/* The kernels for so many points. */
static const narc_kernel_table *find_kernels(size_t count, narc_status *out_status, narc_error *error) {
    const narc_kernel_table *const kernels = narc_kernels(out_status, error);
    return kernels ? NARC_KERNELS_FOR(count, kernels) : NULL;
}

/* ------------------------------------------------------------------------------------------------ distances */

narc_status narc_find_distances(const narc_shapes *shapes, const narc_bodies *bodies, const narc_points *points,
                                const narc_index_column *body, const narc_workers *workers, narc_distance *out_rows,
                                narc_error *error) {
    narc_status status = NARC_OK;
    narc_point_batch one; /* an initialiser would clear all of it */
    if (out_rows && begin_one(shapes, bodies, points, body, &one)) {
        const narc_kernel_table *const kernels = find_kernels(1, &status, error);
        if (!kernels)
            return status;
        one.out = out_rows;
        kernels->distance(&one, 0, 1);
        return NARC_OK;
    }
    status = check_points(shapes, bodies, points, error);
    if (status == NARC_OK)
        status = narc_check_set(bodies, error);
    if (status != NARC_OK || points->count == 0)
        return status;
    if (!out_rows)
        return narc_fail_missing(error, "out_rows");
    const narc_kernel_table *const kernels = find_kernels(points->count, &status, error);
    if (!kernels)
        return status;
    point_job job = {.batch = {.shapes = shapes, .bodies = bodies, .points = points, .out = out_rows},
                     .kernel = kernels->distance};
    if (body)
        job.batch.body = *body;
    status = narc_check_named(shapes, bodies, job.batch.body, points->count, "point", workers, error);
    if (status == NARC_OK)
        narc_run_ranges(workers, points->count, PART, answer_part, &job);
    return status;
}

/* ------------------------------------------------------------------------------------------------ within */

static void answer_bits(void *argument, size_t part, size_t first, size_t end) {
    const point_job *job = argument;
    (void)part;
    job->kernels->inside(&job->batch, first, end, job->out_bits);
}

narc_status narc_find_inside(const narc_shapes *shapes, const narc_bodies *bodies, const narc_points *points,
                             const narc_index_column *body, const narc_workers *workers, uint64_t *out_bits,
                             narc_error *error) {
    narc_status status = NARC_OK;
    narc_point_batch one;
    if (out_bits && begin_one(shapes, bodies, points, body, &one)) {
        const narc_kernel_table *const kernels = narc_kernels(&status, error);
        if (!kernels)
            return status;
        kernels->inside(&one, 0, 1, out_bits);
        return NARC_OK;
    }
    status = check_points(shapes, bodies, points, error);
    if (status == NARC_OK)
        status = narc_check_set(bodies, error);
    if (status != NARC_OK || points->count == 0)
        return status;
    if (!out_bits)
        return narc_fail_missing(error, "out_bits");
    point_job job = {.batch = {.shapes = shapes, .bodies = bodies, .points = points},
                     .kernels = find_kernels(points->count, &status, error),
                     .out_bits = out_bits};
    if (!job.kernels)
        return status;
    if (body)
        job.batch.body = *body;
    status = narc_check_named(shapes, bodies, job.batch.body, points->count, "point", workers, error);
    if (status == NARC_OK)
        narc_run_ranges(workers, points->count, PART, answer_bits, &job);
    return status;
}

/* ------------------------------------------------------------------------------------------------ nearest */

static narc_status check_options(const narc_index *index, const narc_nearest_options *options, narc_error *error) {
    if (isnan(options->distance))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)options->distance,
                         "options.distance is not a number");
    const narc_status status = narc_check_reserved(options->reserved, 4, "options", error);
    return status == NARC_OK ? narc_check_search(index, &options->search, "options.search", error) : status;
}

narc_status narc_find_nearest(const narc_index *index, const narc_shapes *shapes, const narc_bodies *bodies,
                              const narc_points *points, const narc_nearest_options *options, narc_distance *out_rows,
                              size_t capacity, narc_error *error) {
    static const narc_nearest_options defaults = {0};
    const narc_nearest_options *const o = options ? options : &defaults;
    if (!index)
        return narc_fail_missing(error, "index");
    narc_status status = check_points(shapes, bodies, points, error);
    if (status == NARC_OK)
        status = check_options(index, o, error);
    if (status == NARC_OK)
        status = narc_check_indexed(index, bodies, error);
    if (status != NARC_OK)
        return status;
    const size_t most = o->most > 0 ? o->most : 1;
    const float distance = o->distance == 0 ? INFINITY : o->distance;
    if (points->count == 0)
        return NARC_OK;
    if (capacity / most < points->count)
        return narc_fail(error, NARC_ERROR_CAPACITY, 0, (double)points->count * (double)most,
                         "%zu points with %zu rows each, but room for %zu rows", points->count, most, capacity);
    if (!out_rows)
        return narc_fail_missing(error, "out_rows");
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    point_job job = {.batch = {.shapes = shapes,
                               .bodies = bodies,
                               .points = points,
                               .index = index,
                               .search = &o->search,
                               .distance = o->inside && distance > 0 ? 0 : distance,
                               .most = most,
                               .out = out_rows},
                     .kernel = kernels->nearest};
    narc_run_ranges(o->search.workers, points->count, NEAREST_PART, answer_part, &job);
    return NARC_OK;
}
