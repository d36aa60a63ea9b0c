/* SPDX-License-Identifier: MIT
 *
 * boxes.c - narc_compute_boxes(): argument checks, then bodies chunk by chunk to the kernel.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"

#include <math.h>

/* Bodies in a chunk: some 20 microseconds of work. */
enum { CHUNK = 1024 };

static narc_status check_options(const narc_box_options *options, narc_error *error) {
    const float margin = options->margin;
    if (!isfinite(margin))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)margin, "options.margin is %g", (double)margin);
    if (margin < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)margin, "options.margin is %g, less than 0",
                         (double)margin);
    return NARC_OK;
}

static narc_status check_bodies(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t count,
                                unsigned threads, narc_error *error) {
    if (bodies->count > UINT32_MAX)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)bodies->count, "%zu bodies, at most %lu", bodies->count,
                         (unsigned long)UINT32_MAX);
    if (first > bodies->count || count > bodies->count - first)
        return narc_fail(error, NARC_ERROR_ARGUMENT, first, (double)count,
                         "bodies %zu and the %zu from there on, but there are %zu", first, count, bodies->count);
    const narc_status status = count > 0 ? narc_check_columns(bodies, error) : NARC_OK;
    if (status != NARC_OK)
        return status;
    const size_t bad = narc_find_bad_body(shapes, bodies, first, count, threads);
    if (bad == first + count)
        return NARC_OK;
    const uint32_t shape = narc_index_at(bodies->shape, bad);
    return narc_fail(error, NARC_ERROR_INDEX, bad, shape, "body %zu: shape is %lu, but there are %zu shapes", bad,
                     (unsigned long)shape, shapes->count);
}

/* The boxes of one chunk; returns how many bodies have none. */
static size_t compute_chunk(const narc_kernel_table *kernels, const narc_box_batch *batch, size_t first, size_t count,
                            size_t chunk, narc_box *out_boxes) {
    const size_t done = chunk * CHUNK, left = count - done, start = first + done;
    return kernels->box(batch, start, left < CHUNK ? left : CHUNK, out_boxes + start);
}

/* The same for all chunks. Without threads OpenMP is left alone: it takes most of a microsecond even for a team of
 * one. */
static size_t compute_chunks(const narc_kernel_table *kernels, const narc_box_batch *batch, size_t first, size_t count,
                             unsigned threads, narc_box *out_boxes) {
    const size_t chunks = count / CHUNK + (count % CHUNK != 0);
    const int team = narc_team_size(threads, chunks);
    size_t skipped = 0;
    if (team <= 1) {
        for (size_t chunk = 0; chunk < chunks; chunk++)
            skipped += compute_chunk(kernels, batch, first, count, chunk, out_boxes);
        return skipped;
    }
#ifdef _OPENMP
#pragma omp parallel for schedule(static) num_threads(team) reduction(+ : skipped)
#endif
    for (size_t chunk = 0; chunk < chunks; chunk++)
        skipped += compute_chunk(kernels, batch, first, count, chunk, out_boxes);
    return skipped;
}

static narc_status compute(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t count,
                           const narc_box_options *options, unsigned threads, narc_box *out_boxes, narc_error *error) {
    static const narc_box_options defaults = {0};
    const narc_box_options *const o = options ? options : &defaults;
    narc_status status = check_options(o, error);
    if (status == NARC_OK)
        status = check_bodies(shapes, bodies, first, count, threads, error);
    if (status != NARC_OK)
        return status;
    if (count > 0 && !out_boxes)
        return narc_fail_missing(error, "out_boxes");
    const narc_kernel_table *const kernels = narc_kernels(&status, error);
    if (!kernels)
        return status;
    const narc_box_batch batch = {shapes, bodies, o->margin, o->motion_x, o->motion_y};
    const size_t skipped = compute_chunks(kernels, &batch, first, count, threads, out_boxes);
    if (o->out_skipped)
        *o->out_skipped = skipped;
    return NARC_OK;
}

narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                               unsigned threads, narc_box *out_boxes, narc_error *error) {
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    return compute(shapes, bodies, 0, bodies->count, options, threads, out_boxes, error);
}

narc_status narc_compute_boxes_range(const narc_shapes *shapes, const narc_bodies *bodies, size_t first, size_t count,
                                     const narc_box_options *options, narc_box *out_boxes, narc_error *error) {
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    return compute(shapes, bodies, first, count, options, 1, out_boxes, error);
}
