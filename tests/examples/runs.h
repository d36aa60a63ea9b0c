/* SPDX-License-Identifier: MIT
 *
 * runs.h - scenes of the example world, run and measured.
 */
#ifndef NARC_TEST_EXAMPLES_RUNS_H
#define NARC_TEST_EXAMPLES_RUNS_H

#include "scenes.h"
#include "support.h"

typedef struct run {
    world world;
    const char *name;
    uint64_t seed;
    long step;
} run;

/* Builds the scene; the test fails if that does. */
run begin_run(const char *name, world_settings settings, uint64_t seed);

/* Steps for so many seconds. */
void continue_run(run *r, float seconds);

/* The same for bodies that rest: in no step may energy appear, more than the part in 10,000 that pushing bodies apart
 * may add. */
void continue_calm_run(run *r, float seconds);

/* Measures it and prints that. */
scene_state measure_run(const run *r);

void end_run(run *r);

#endif
