/* SPDX-License-Identifier: MIT
 *
 * stacks.c - what stands keeps standing, awake: stacks and pyramids, for many seeds.
 */
#include <math.h>

#include "runs.h"

/* Nothing sleeps: a body that sleeps would stand in any world. */
static world_settings stay_awake(void) {
    world_settings settings = world_defaults;
    settings.sleep_time = INFINITY;
    return settings;
}

/* Does it stand, pressed together by at most `pressed`? The load of row k from the top presses its contact by k times what
 * one box does, 0.4 mm. And does it lean by no more than `lean`? */
static void check_stands(const char *name, float seconds, double pressed, double lean, size_t trials) {
    for (uint64_t seed = 1; seed <= trials; seed++) {
        run r = begin_run(name, stay_awake(), seed);
        continue_run(&r, 2); /* it is pressed together, and swings back a little */
        continue_calm_run(&r, seconds - 2);
        const scene_state state = measure_run(&r);
        assert_int_equal(state.moving, 0);
        assert_true(state.displacement < pressed);
        assert_true(state.sideways < lean);
        end_run(&r);
    }
}

TEST(test_stack) { check_stands("stack", 60, 0.25, 0.3, test_trials(10)); }

TEST(test_pyramid) { check_stands("pyramid", 15, 0.03, 0.02, test_trials(2)); }

TEST(test_rounded_pyramid) { check_stands("rounded", 15, 0.03, 0.02, test_trials(2)); }

/* A spring of a fifth of the rate of sub-steps is still soft enough, as friction acts in the relaxing pass alone. In both
 * passes all boxes hum with it. */
TEST(test_stiffer_spring) {
    world_settings settings = stay_awake();
    settings.spring_rate = 1 / 5.0f;
    run r = begin_run("rounded", settings, 1);
    continue_run(&r, 15);
    assert_int_equal(measure_run(&r).moving, 0);
    end_run(&r);
}

/* How long until the stack has fallen, at most `most` seconds? */
static int find_fall(world_settings settings, int most) {
    run r = begin_run("stack", settings, 1);
    int seconds = 0;
    for (double way = 0; way < 1.5 && seconds < most; seconds++) {
        continue_run(&r, 1);
        way = measure_run(&r).displacement;
    }
    end_run(&r);
    return seconds;
}

/* Soft contacts that are found anew in each step are a column of springs, which buckles. */
TEST(test_without_recycling_falls) {
    world_settings settings = stay_awake();
    settings.recycling = 0;
    assert_true(find_fall(settings, 30) < 30);
}

/* With one point for each pair the stack is on the floor within 4 seconds. */
TEST(test_one_point_does_not_hold) {
    world_settings settings = stay_awake();
    settings.flat_angle = -1;
    assert_true(find_fall(settings, 5) < 5);
}

/* Other flat angles do as well: docs/solver.md has the table. */
TEST(test_flat_angles) {
    const float degree = 0.017453293f, angles[] = {5 * degree, 15 * degree, 40 * degree};
    for (size_t i = 0; i < sizeof angles / sizeof angles[0]; i++) {
        world_settings settings = stay_awake();
        settings.flat_angle = angles[i];
        run r = begin_run("rounded", settings, 3);
        continue_run(&r, 6);
        const scene_state measured = measure_run(&r);
        assert_int_equal(measured.moving, 0);
        assert_true(measured.displacement < 0.03);
        end_run(&r);
    }
}

TEST_MAIN("stacks")
