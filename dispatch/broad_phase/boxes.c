/* SPDX-License-Identifier: MIT
 *
 * boxes.c - narc_compute_boxes(): argument checks, then bodies part by part to the kernel.
 */
#include "column.h"
#include "dispatch.h"
#include "error.h"
#include "narc_broad_phase.h"
#include "steps.h"

#include <math.h>

/* Bodies in a part: some 20 microseconds of work. */
enum { PART = 1024 };

narc_status narc_check_length(float length, const char *name, narc_error *error) {
    if (!isfinite(length))
        return narc_fail(error, NARC_ERROR_NOT_FINITE, 0, (double)length, "options.%s is %g", name, (double)length);
    if (length < 0)
        return narc_fail(error, NARC_ERROR_ARGUMENT, 0, (double)length, "options.%s is %g, less than 0", name,
                         (double)length);
    return NARC_OK;
}

typedef struct box_job {
    narc_box_batch batch;
    const narc_kernel_table *kernels;
    size_t first;
    narc_box *out_boxes;
    atomic_size_t skipped;
} box_job;

static void compute_part(void *argument, size_t part, size_t start, size_t end) {
    box_job *job = argument;
    const size_t first = job->first + start;
    const size_t skipped = job->kernels->box(&job->batch, first, end - start, job->out_boxes + first);
    (void)part;
    if (skipped > 0)
        atomic_fetch_add_explicit(&job->skipped, skipped, memory_order_relaxed);
}

narc_status narc_compute_boxes(const narc_shapes *shapes, const narc_bodies *bodies, const narc_box_options *options,
                               narc_box *out_boxes, narc_error *error) {
    static const narc_box_options defaults = {0};
    const narc_box_options *const o = options ? options : &defaults;
    if (!shapes || !bodies)
        return narc_fail_missing(error, shapes ? "bodies" : "shapes");
    size_t count = o->count;
    narc_status status = narc_check_length(o->margin, "margin", error);
    if (status == NARC_OK)
        status = narc_check_reserved(o->reserved, 4, "options", error);
    if (status == NARC_OK)
        status = narc_check_bodies(shapes, bodies, o->first, &count, o->workers, error);
    if (status != NARC_OK)
        return status;
    if (count > 0 && !out_boxes)
        return narc_fail_missing(error, "out_boxes");
    box_job job = {{shapes, bodies, o->margin, o->motion_x, o->motion_y},
                   narc_kernels(&status, error),
                   .first = o->first,
                   .out_boxes = out_boxes};
    if (!job.kernels)
        return status;
    narc_run_ranges(o->workers, count, PART, compute_part, &job);
    if (o->out_skipped)
        *o->out_skipped = atomic_load_explicit(&job.skipped, memory_order_relaxed);
    return NARC_OK;
}
