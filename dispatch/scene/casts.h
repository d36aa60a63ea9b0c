/* SPDX-License-Identifier: MIT
 *
 * casts.h - what the files of casts know of each other: a pair under way (impacts.c), and all pairs of a call (casts.c).
 * Internal.
 */
#ifndef NARC_CASTS_H
#define NARC_CASTS_H

#include <stdbool.h>

#include <stdatomic.h>

#include "dispatch.h"
#include "narc_scene.h"
#include "store.h"

/* A body of a cast as it is at the start. */
typedef struct narc_mover {
    const narc_shape_header *header;
    narc_point rotation; /* cosine and sine, a unit vector */
    narc_point turned;   /* and at the cast's time */
    double scale;
    double angle; /* by which it turns in the step */
    double lever; /* of what turns: the largest |point x normal| of its outline, scaled (find_lever()) */
} narc_mover;

/* A pair that is under way. Times are floats, rounded down: a place at a time is exact, and the caller's own. */
typedef struct narc_cast {
    narc_mover a, b;
    double x, y;               /* B's position at the start, from A's */
    double motion_x, motion_y; /* B's against A's */
    double speed;
    double target;
    double tolerance; /* a separation that is so much above the target is a hit */
    double end;       /* nothing touches then or later */
    float time;       /* where it is now */
    float back;       /* where it was to go, had it not tried to go further; -1: it has not */
    uint16_t rounds;
    bool direct; /* it went too far once: it tries no more */
} narc_cast;

/* What a step of a cast may come to, beside NARC_CAST_...: a separation is wanted at cast->time. */
enum { NARC_CAST_GOES_ON = 3 };

/* Places a cast whose bodies, motions and target are set at the first time at which bounding circles touch, where a
 * separation is wanted; or says that they never do: NARC_CAST_MISS. */
int narc_begin_cast(narc_cast *cast, float tolerance);

/* Takes the contact at cast->time and finds what it means: NARC_CAST_... For NARC_CAST_HIT and NARC_CAST_UNFINISHED
 * contact and time are the answer's. */
int narc_advance_cast(const narc_shapes *shapes, narc_cast *cast, const narc_contact *contact);

/* Does turning move its outline? Not that of a circle about its position. */
static inline bool narc_turns(const narc_mover *mover) { return mover->lever != 0; }

/* Turns a body as it is at a time. */
void narc_turn_mover(narc_mover *mover, float time);

/* ------------------------------------------------------------------------------------------------ a call */

/* What a call works on. Its pairs may be any; of `nearest` those of a mover follow each other, its row is the one with
 * the number of A, and says whom it hits first; all such rows are misses before. */
typedef struct narc_cast_job {
    const narc_batch *batch;
    const narc_kernel_table *kernels;
    narc_motions motions[2]; /* of A's bodies, and of B's */
    float target, tolerance;
    bool nearest;
    narc_impact *rows;
    atomic_size_t skipped;
} narc_cast_job;

/* Casts pairs first .. end - 1. */
void narc_cast_range(narc_cast_job *job, size_t first, size_t end);

/* Checks motions and options, and fills a job but for what it works on. Either motions may be NULL. */
narc_status narc_check_casts(const narc_motions *motions, const narc_motions *other_motions,
                             const narc_cast_options *options, narc_cast_job *out_job, narc_error *error);

#endif
