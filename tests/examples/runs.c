/* SPDX-License-Identifier: MIT
 *
 * runs.c - scenes of the example world, run and measured.
 */
#include "runs.h"

#include <math.h>
#include <stdio.h>

run begin_run(const char *name, world_settings settings, uint64_t seed) {
    run r = {.name = name, .seed = seed};
    assert_non_null(find_scene(name));
    assert_int_equal(build_scene(find_scene(name), settings, seed, &r.world), NARC_OK);
    return r;
}

static void continue_with(run *r, float seconds, double allowed) {
    const long steps = lroundf(seconds / r->world.settings.time_step);
    for (long k = 0; k < steps; k++) {
        const double before = world_energy(&r->world);
        if (step_scene(find_scene(r->name), &r->world, ++r->step) != NARC_OK)
            fail_msg("%s, seed %d: %s", r->name, (int)r->seed, r->world.error.message);
        const double after = world_energy(&r->world);
        if (allowed < INFINITY && !(after - before <= allowed * fabs(before)))
            fail_msg("%s, seed %d: energy %.9g became %.9g", r->name, (int)r->seed, before, after);
    }
}

void continue_run(run *r, float seconds) { continue_with(r, seconds, INFINITY); }

void continue_calm_run(run *r, float seconds) { continue_with(r, seconds, 1e-4); }

scene_state measure_run(const run *r) {
    const scene_state state = measure_scene(&r->world);
    print_message("%s, seed %d: energy %.2f, displacement %.4f, sideways %.4f, overlap %.4f, %zu moving, %zu awake\n",
                  r->name, (int)r->seed, state.energy, state.displacement, state.sideways, state.overlap, state.moving,
                  state.awake);
    return state;
}

void end_run(run *r) { world_destroy(&r->world); }
