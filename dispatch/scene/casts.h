/* SPDX-License-Identifier: MIT
 *
 * casts.h - what the files of casts know of each other: all pairs of a call (casts.c). Internal.
 */
#ifndef NARC_CASTS_H
#define NARC_CASTS_H

#include <stdbool.h>

#include <stdatomic.h>

#include "dispatch.h"
#include "narc_scene.h"

/* What a call works on. Its pairs may be any; of `nearest` those of a mover follow each other, its row is the one with
 * the number of A, and says whom it hits first; all such rows are misses before. */
typedef struct narc_cast_job {
    const narc_batch *batch;
    const narc_kernel_table *kernels;
    narc_motions motions[2]; /* of A's bodies, and of B's */
    float target, tolerance;
    narc_float_column targets; /* in place of `target`: one for each pair, or of `nearest` for each A */
    bool nearest, front_only;
    narc_impact *rows;
    atomic_size_t skipped;
} narc_cast_job;

/* Casts pairs first .. end - 1. */
void narc_cast_range(narc_cast_job *job, size_t first, size_t end);

/* Checks motions and options, and fills a job but for what it works on. Either motions may be NULL. */
narc_status narc_check_casts(const narc_motions *motions, const narc_motions *other_motions,
                             const narc_cast_options *options, narc_cast_job *out_job, narc_error *error);

/* Checks the targets of a job, so many. */
narc_status narc_check_targets(const narc_cast_job *job, size_t count, narc_error *error);

#endif
