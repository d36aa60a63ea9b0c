/* SPDX-License-Identifier: MIT
 *
 * piles.c - what falls comes to rest and sleeps, inside its box and not inside each other.
 */
#include <math.h>

#include "runs.h"

/* A round body may roll for ten seconds more than all others, over many others' flat sides. No overlap is above `most`,
 * and at most one seed in eight has one above `usual`. */
static void check_sleeps(const char *name, float half_width, float seconds, double usual, double most, size_t trials) {
    size_t unusual = 0;
    for (uint64_t seed = 1; seed <= trials; seed++) {
        run r = begin_run(name, world_defaults, seed);
        scene_state state = {.awake = 1};
        for (float time = 0; time < seconds && state.awake > 0; time++) {
            continue_run(&r, 1);
            state = measure_scene(&r.world);
        }
        state = measure_run(&r);
        assert_int_equal(state.awake, 0);
        assert_true(state.overlap < most);
        unusual += state.overlap >= usual;
        for (size_t k = 0; k < r.world.body_count; k++) {
            const world_body *body = &r.world.bodies[k];
            assert_true((body->kind & NARC_STATIC) || (fabsf(body->position.x) < half_width && body->position.y > 0));
        }
        end_run(&r);
    }
    assert_true(unusual <= (trials + 7) / 8);
}

/* 12 layers; bodies of 0.4 to 1.2 m. */
TEST(test_heap) { check_sleeps("heap", 8, 30, 0.03, 0.05, test_trials(40)); }

/* Three times as many. */
TEST(test_pile) { check_sleeps("pile", 20, 30, 0.05, 0.05, test_trials(28)); }

/* They are at rest without sleep, too: at most one that still rolls, and no energy appears. */
TEST(test_rests_awake) {
    world_settings settings = world_defaults;
    settings.sleep_time = INFINITY;
    for (uint64_t seed = 1; seed <= test_trials(3); seed++) {
        run r = begin_run("pile", settings, seed);
        continue_run(&r, 15);
        continue_calm_run(&r, 2);
        assert_true(measure_run(&r).moving <= 1);
        end_run(&r);
    }
}

/* The test can fail: with one point for each pair nothing comes to rest. */
TEST(test_one_point_never_rests) {
    world_settings settings = world_defaults;
    settings.flat_angle = -1;
    run r = begin_run("heap", settings, 1);
    continue_run(&r, 12);
    assert_true(measure_run(&r).moving > 100);
    end_run(&r);
}

TEST_MAIN("piles")
