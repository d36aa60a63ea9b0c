/* SPDX-License-Identifier: MIT
 *
 * bullets.c - nothing passes through a thin wall, or through another bullet.
 */
#include "runs.h"

/* How many bodies have been behind the wall, x = 0. Wall and ground are bodies 0 and 1. */
static size_t count_through(run *r, int steps) {
    bool through[16] = {false};
    size_t count = 0;
    for (int step = 0; step < steps; step++) {
        assert_int_equal(world_step(&r->world), NARC_OK);
        for (size_t k = 2; k < r->world.body_count; k++)
            through[k] = through[k] || r->world.bodies[k].position.x > 0;
    }
    for (size_t k = 2; k < r->world.body_count; k++)
        count += through[k];
    return count;
}

TEST(test_wall_holds) {
    for (uint64_t seed = 1; seed <= test_trials(40); seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        const size_t through = count_through(&r, 60);
        if (through > 0)
            fail_msg("seed %d: %d bullets came through", (int)seed, (int)through);
        end_run(&r);
    }
}

/* Without a bullet's margin most fly through: the wall is a twentieth of their step. */
TEST(test_without_margins) {
    size_t through = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        for (size_t k = 0; k < r.world.body_count; k++)
            r.world.bodies[k].bullet = 0;
        through += count_through(&r, 60);
        end_run(&r);
    }
    print_message("%zu of 80 came through\n", through);
    assert_true(through > 40);
}

/* Two that fly at each other, 120 m/s apart, stay on their sides. */
TEST(test_head_on) {
    for (uint64_t seed = 1; seed <= test_trials(20); seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        world *w = &r.world;
        w->settings.gravity = (vec){0, 0};
        w->bodies[1].position.y = 100; /* no wall */
        world_body *left = &w->bodies[2], *right = &w->bodies[3];
        *right = *left; /* two circles: others may pass each other after they have touched */
        left->position = (vec){-10 - 0.1f * (float)seed, 20};
        right->position = (vec){10, 20};
        left->velocity = (vec){60, 0};
        right->velocity = (vec){-60, 0};
        for (int step = 0; step < 60; step++) {
            assert_int_equal(world_step(w), NARC_OK);
            assert_true(left->position.x < right->position.x);
        }
        end_run(&r);
    }
}

TEST_MAIN("bullets")
