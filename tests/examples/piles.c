/* SPDX-License-Identifier: MIT
 *
 * piles.c - what falls comes to rest, inside its box and not inside each other.
 */
#include <math.h>

#include "runs.h"

/* At most one body in a thousand, and no less than one, is still on its way. (Box2D 2.4.1: one of 1,000 after 15 s.) */
static void check_rests(const char *name, float half_width, float seconds, double overlap, size_t trials) {
    for (uint64_t seed = 1; seed <= trials; seed++) {
        run r = begin_run(name, world_defaults, seed);
        continue_run(&r, seconds - 2); /* what falls on each other overlaps, and is pushed up */
        continue_calm_run(&r, 2);
        const scene_state state = measure_run(&r);
        assert_true(state.moving <= 1 + r.world.body_count / 1000);
        assert_true(state.overlap < overlap);
        for (size_t k = 0; k < r.world.body_count; k++) {
            const world_body *body = &r.world.bodies[k];
            assert_true(body->still || (fabsf(body->position.x) < half_width && body->position.y > 0));
        }
        end_run(&r);
    }
}

/* 12 layers; bodies of 0.4 to 1.2 m. */
TEST(test_heap) { check_rests("heap", 8, 12, 0.03, test_trials(10)); }

/* 25 layers, which press more. */
TEST(test_pile) { check_rests("pile", 40, 15, 0.06, test_trials(2)); }

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
