/* SPDX-License-Identifier: MIT
 *
 * stacks.c - what stands keeps standing: stacks and pyramids, for many seeds.
 */
#include "runs.h"

/* A unit box that leaves its place by more than this was not held by it. What is allowed is that ten or fifteen rows
 * are pressed together: with 8 sub-steps the worst was 0.01 in 20 seeds. */
static const double place = 0.02;

static void check_stands(const char *name, float seconds, size_t trials) {
    for (uint64_t seed = 1; seed <= trials; seed++) {
        run r = begin_run(name, world_defaults, seed);
        continue_calm_run(&r, seconds);
        const scene_state state = measure_run(&r);
        assert_int_equal(state.moving, 0);
        assert_true(state.displacement < place);
        end_run(&r);
    }
}

TEST(test_stack) { check_stands("stack", 60, test_trials(5)); }

TEST(test_pyramid) { check_stands("pyramid", 15, test_trials(2)); }

TEST(test_rounded_pyramid) { check_stands("rounded", 15, test_trials(2)); }

/* The test can fail: with one point for each pair the stack is on the floor within 4 seconds. */
TEST(test_one_point_does_not_hold) {
    world_settings settings = world_defaults;
    settings.flat_angle = -1;
    run r = begin_run("stack", settings, 1);
    continue_run(&r, 4);
    assert_true(measure_run(&r).displacement > 1);
    end_run(&r);
}

/* Other flat angles do as well: docs/solver.md has the table. */
TEST(test_flat_angles) {
    const float degree = 0.017453293f, angles[] = {5 * degree, 15 * degree, 40 * degree};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        world_settings settings = world_defaults;
        settings.flat_angle = angles[i];
        run r = begin_run("rounded", settings, 3);
        continue_run(&r, 6);
        const scene_state measured = measure_run(&r);
        assert_int_equal(measured.moving, 0);
        assert_true(measured.displacement < place);
        end_run(&r);
    }
}

TEST_MAIN("stacks")
