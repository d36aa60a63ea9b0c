/* SPDX-License-Identifier: MIT
 *
 * bullets.c - what is fast passes through nothing thin, fixed or loose, though nobody marks it; nor through each other.
 */
#include <math.h>

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
    for (uint64_t seed = 1; seed <= test_trials(100); seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        const size_t through = count_through(&r, 60);
        if (through > 0)
            fail_msg("seed %d: %d bullets came through", (int)seed, (int)through);
        end_run(&r);
    }
}

/* From both sides, 7 m a step, every 120 steps again: who flew from the left stays there, or goes over the top. */
TEST(test_plate_of_a_centimetre_holds) {
    for (uint64_t seed = 1; seed <= test_trials(20); seed++) {
        run r = begin_run("plates", world_defaults, seed);
        bool right[32] = {false};
        assert_in_range(r.world.body_count, 3, 32);
        for (int steps = 0; steps < 360; steps++) {
            continue_run(&r, 1 / 60.0f);
            for (size_t k = 2; k < r.world.body_count; k++) {
                const vec at = r.world.bodies[k].position;
                const bool starts = steps == 0 || steps % 120 == 119;
                right[k] = starts ? r.world.bodies[k].start.x > 0 : at.y >= 7 ? at.x > 0 : right[k];
                if ((at.x > 0) != right[k])
                    fail_msg("seed %d: body %d came through", (int)seed, (int)k);
            }
        }
        end_run(&r);
    }
}

/* The test can fail: where nothing is thin nothing is fast, and most fly through. */
TEST(test_can_fail) {
    size_t through = 0;
    for (uint64_t seed = 1; seed <= 10; seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        for (size_t shape = 0; shape < 10; shape++)
            r.world.shapes[shape].thickness = 1e9f;
        through += count_through(&r, 60);
        end_run(&r);
    }
    print_message("%zu of 80 came through\n", through);
    assert_true(through > 40);
}

/* A bullet and a plate of 0.05 x 4 m that nothing holds: it never comes to the plate's other side, but around an end. */
static bool passes_plate(uint64_t seed, float speed) {
    run r = begin_run("bullets", world_defaults, seed);
    world *w = &r.world;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    world_body bullet = w->bodies[2 + seed % 8], plate = {.cosine = 1, .position = {0, 2}, .friction = 0.6f};
    w->settings.gravity = (vec){0, 0};
    w->body_count = 0;
    assert_int_equal(narc_build_box(0.05, 4, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(w, arcs, count, &plate.shape), NARC_OK);
    assert_int_equal(world_add_body(w, plate), NARC_OK);
    struct test_random random = {seed};
    bullet.position = (vec){-speed / 12, (float)random_between(&random, 0.3, 3.7)};
    bullet.velocity.x = speed;
    const double angle = random_between(&random, -3, 3);
    bullet.cosine = (float)cos(angle);
    bullet.sine = (float)sin(angle);
    assert_int_equal(world_add_body(w, bullet), NARC_OK);
    bool passed = false;
    for (int step = 0; step < 40; step++) {
        assert_int_equal(world_step(w), NARC_OK);
        const vec at = to_local(&w->bodies[0], subtract(w->bodies[1].position, w->bodies[0].position));
        if (fabsf(at.y) > 2)
            break;
        passed = passed || at.x > 0;
    }
    end_run(&r);
    return passed;
}

TEST(test_loose_plate) {
    static const float speeds[] = {60, 120, 200, 390};
    size_t passed = 0;
    for (uint64_t seed = 1; seed <= test_trials(3000); seed++)
        for (int k = 0; k < 4; k++)
            passed += passes_plate(seed, speeds[k]);
    assert_int_equal(passed, 0);
}

/* A ball on a thin floor: each time that it comes down it touches and goes up again, for minutes. */
TEST(test_ball_bounces) {
    run r = begin_run("bullets", world_defaults, 1);
    world *w = &r.world;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count, touches = 0, turns = 0;
    world_body floor = {.cosine = 1, .kind = NARC_STATIC}, ball = {.cosine = 1, .position = {0, 3}, .restitution = 1};
    w->body_count = 0;
    assert_int_equal(narc_build_box(40, 0.02, 0, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(w, arcs, count, &floor.shape), NARC_OK);
    assert_int_equal(world_add_body(w, floor), NARC_OK);
    assert_int_equal(narc_build_circle(0.05, arcs, &count, NULL), NARC_OK);
    assert_int_equal(world_add_shape(w, arcs, count, &ball.shape), NARC_OK);
    assert_int_equal(world_add_body(w, ball), NARC_OK);
    const world_body *const moving = &w->bodies[1];
    for (size_t step = 0; step < 60 * 60 * test_trials(5); step++) {
        const float before = moving->velocity.y;
        assert_int_equal(world_step(w), NARC_OK);
        turns += before < -1 && moving->velocity.y > 0;
        for (size_t k = 0; k < w->event_count; k++)
            touches += w->events[k].begins;
        assert_true(moving->position.y > 0.03f);
    }
    print_message("%zu times up, %zu touches\n", turns, touches);
    assert_true(turns > 20 && touches >= turns);
    end_run(&r);
}

/* ------------------------------------------------------------------------------------------------ segments */

/* A world with a segment from (-2000, 0) to (2000, 0), or with a slab so thick. */
static world create_line(double thickness, vec gravity) {
    world w;
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    world_settings settings = world_defaults;
    world_body line = {.cosine = 1, .kind = NARC_STATIC, .friction = 0.5f};
    settings.gravity = gravity;
    assert_int_equal(world_create(&w, settings, 1024), NARC_OK);
    if (thickness > 0)
        assert_int_equal(narc_build_box(4000, thickness, 0, arcs, &count, NULL), NARC_OK);
    else
        assert_int_equal(narc_build_segment(&(narc_point){-2000, 0}, &(narc_point){2000, 0}, 0, arcs, &count, NULL),
                         NARC_OK);
    assert_int_equal(world_add_shape(&w, arcs, count, &line.shape), NARC_OK);
    assert_int_equal(world_add_body(&w, line), NARC_OK);
    return w;
}

/* Shape k of six: circles, a box, thin ones, a rod. */
static world_body *add_body_at(world *w, size_t k, float x, float y) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    world_body body = {.position = {x, y}, .cosine = 1, .friction = 0.5f};
    const narc_status status = k == 0   ? narc_build_circle(0.1, arcs, &count, NULL)
                               : k == 1 ? narc_build_circle(1, arcs, &count, NULL)
                               : k == 2 ? narc_build_box(0.3, 0.3, 0, arcs, &count, NULL)
                               : k == 3 ? narc_build_box(0.6, 0.04, 0, arcs, &count, NULL)
                               : k == 4 ? narc_build_capsule(0.6, 0.03, arcs, &count, NULL)
                                        : narc_build_box(2, 0.01, 0, arcs, &count, NULL);
    assert_int_equal(status, NARC_OK);
    assert_int_equal(world_add_shape(w, arcs, count, &body.shape), NARC_OK);
    assert_int_equal(world_add_body(w, body), NARC_OK);
    return &w->bodies[w->body_count - 1];
}

enum { FLIERS = 300 };

/* Bodies fly at a wall from both sides, turned and spinning: none comes through, and none that spins on stands there. */
static void fly_at_line(double thickness, float speed, uint64_t seed) {
    AUTO(world_destroy) world w = create_line(thickness, (vec){0, 0});
    struct test_random random = {seed};
    for (size_t k = 0; k < FLIERS; k++) {
        const float side = k % 2 ? 1 : -1;
        const double angle = random_between(&random, -3, 3);
        world_body *body = add_body_at(&w, k % 12 / 2, 4 * (float)k - 600, side * (float)random_between(&random, 2, 9));
        body->cosine = (float)cos(angle);
        body->sine = (float)sin(angle);
        body->velocity = (vec){0, -side * speed};
        body->spin = (float)random_between(&random, -15, 15);
        body->restitution = 0.2f;
    }
    size_t stood[FLIERS + 1] = {0};
    for (int step = 0; step < 60; step++) {
        assert_int_equal(world_step(&w), NARC_OK);
        for (size_t k = 1; k <= FLIERS; k++) {
            const world_body *const body = &w.bodies[k];
            assert_true((body->position.y > 0) == (k % 2 == 0));
            stood[k] = body->stop > 0 || fabsf(body->spin) < 1 ? 0 : stood[k] + 1;
            if (stood[k] > 5)
                fail_msg("seed %d, %g m/s: body %zu has stood for %zu steps", (int)seed, (double)speed, k, stood[k]);
        }
    }
}

TEST(test_segment_is_a_wall) {
    for (uint64_t seed = 1; seed <= test_trials(2); seed++)
        for (float speed = 20; speed < 400; speed *= 2.6f)
            fly_at_line(0, speed, seed);
}

TEST(test_thin_walls_hold) {
    for (double thickness = 1e-5; thickness < 0.02; thickness *= 10)
        fly_at_line(thickness, 60, test_trials(1));
}

/* What falls on a segment, fast and turned, comes to rest above it. */
TEST(test_segment_is_a_floor) {
    AUTO(world_destroy) world w = create_line(0, (vec){0, -9.81f});
    struct test_random random = {5};
    for (size_t k = 0; k < 60; k++) {
        const double angle = random_between(&random, -3, 3);
        world_body *body = add_body_at(&w, k % 6, 5 * (float)k, 3 + (float)random_unit(&random));
        body->cosine = (float)cos(angle);
        body->sine = (float)sin(angle);
        body->velocity = (vec){0, -(float)random_between(&random, 0, 100)};
    }
    for (int step = 0; step < 60 * 20; step++) {
        assert_int_equal(world_step(&w), NARC_OK);
        for (size_t k = 1; k < w.body_count; k++)
            assert_true(w.bodies[k].position.y > 0);
    }
    for (size_t k = 1; k < w.body_count; k++)
        assert_true(w.bodies[k].kind & NARC_ASLEEP);
}

/* A box slides on it by v^2 / (2 * friction * g), fast or slow. */
TEST(test_boxes_slide_on_a_segment) {
    for (float speed = 1; speed < 40; speed *= 2) {
        AUTO(world_destroy) world w = create_line(0, (vec){0, -9.81f});
        const world_body *const box = add_body_at(&w, 2, 0, 0.15f);
        w.bodies[1].velocity.x = speed;
        for (int step = 0; step < 60 * 10; step++)
            assert_int_equal(world_step(&w), NARC_OK);
        const double way = (double)speed * (double)speed / (2 * 0.5 * 9.81);
        print_message("%g m/s: %.3f m, expected %.3f\n", (double)speed, (double)box->position.x, way);
        assert_true(fabs((double)box->position.x - way) < 0.05 + 0.02 * way);
    }
}

/* Wheels roll on without slowing down, and stay on it. */
TEST(test_wheels_roll_on_a_segment) {
    for (float speed = 5; speed < 100; speed *= 3) {
        AUTO(world_destroy) world w = create_line(0, (vec){0, -9.81f});
        world_body *const wheel = add_body_at(&w, 1, -1000, 1);
        wheel->velocity.x = speed;
        wheel->spin = -speed;
        w.settings.rolling_arm = 0;
        for (int step = 0; step < 60 * 10; step++) {
            assert_int_equal(world_step(&w), NARC_OK);
            assert_true(fabsf(wheel->position.y - 1) < 0.01f);
        }
        assert_true(fabsf(wheel->velocity.x - speed) < 1e-3f * speed);
        assert_true(fabsf(wheel->position.x - (10 * speed - 1000)) < 1e-3f * 10 * speed);
    }
}

/* Two that fly at each other, at 240 m/s, stay on their sides. */
TEST(test_head_on) {
    for (uint64_t seed = 1; seed <= test_trials(20); seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        world *w = &r.world;
        w->settings.gravity = (vec){0, 0};
        w->bodies[1].position.y = 100; /* no wall */
        world_body *left = &w->bodies[2], *right = &w->bodies[3];
        const uint64_t id = right->id;
        *right = *left; /* two circles: others may pass each other after they have touched */
        right->id = id;
        left->position = (vec){-10 - 0.1f * (float)seed, 20};
        right->position = (vec){10, 20};
        left->velocity = (vec){120, 0};
        right->velocity = (vec){-120, 0};
        for (int step = 0; step < 60; step++) {
            assert_int_equal(world_step(w), NARC_OK);
            assert_true(left->position.x < right->position.x);
        }
        end_run(&r);
    }
}

/* A bar that turns by half a radian in a step does not sweep through a thin wall. */
TEST(test_sweep) {
    for (uint64_t seed = 0; seed < test_trials(100); seed++) {
        run r = begin_run("bullets", world_defaults, 1);
        world *w = &r.world;
        narc_arc arcs[NARC_MAX_ARCS];
        size_t count;
        struct test_random random = {seed};
        const double angle = random_between(&random, 1.1, 2.0);
        world_body bar = {.position = {-0.5f, 20}, .cosine = (float)cos(angle), .sine = (float)sin(angle), .spin = 30};
        w->settings.gravity = (vec){0, 0};
        w->body_count = 2; /* ground and wall */
        assert_int_equal(narc_build_capsule(1.6, 0.05, arcs, &count, NULL), NARC_OK);
        assert_int_equal(world_add_shape(w, arcs, count, &bar.shape), NARC_OK);
        assert_int_equal(world_add_body(w, bar), NARC_OK);
        for (int step = 0; step < 60; step++) {
            assert_int_equal(world_step(w), NARC_OK);
            assert_true(measure_scene(w).overlap < 0.025); /* half of the wall */
        }
        assert_true(w->bodies[2].position.x < 0);
        end_run(&r);
    }
}

/* A fall that begins in this step counts: a body at rest under 600 g stops on a thin floor below it. */
TEST(test_gravity_counts) {
    run r = begin_run("bullets", world_defaults, 1);
    world *w = &r.world;
    w->settings.gravity = (vec){6000, 0};
    for (size_t k = 2; k < w->body_count; k++) {
        w->bodies[k].position.x = -0.4f - 0.1f * (float)k;
        w->bodies[k].velocity = (vec){0, 0};
    }
    assert_int_equal(count_through(&r, 1), 0);
    end_run(&r);
}

TEST_MAIN("bullets")
