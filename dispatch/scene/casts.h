/* SPDX-License-Identifier: MIT
 *
 * casts.h - what the files of casts know of each other: all pairs of a call (casts.c). Internal.
 */
#ifndef NARC_CASTS_H
#define NARC_CASTS_H

#include <stdatomic.h>

#include "dispatch.h"
#include "narc_scene.h"

/* What a call works on. */
typedef struct narc_cast_job {
    narc_cast_batch batch;
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
