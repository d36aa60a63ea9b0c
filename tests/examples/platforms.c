/* SPDX-License-Identifier: MIT
 *
 * platforms.c - platforms of the example world: bodies of all kinds jump and drop through them as if they were not there,
 * and stand on them as on any ground, also where these move.
 */
#include <math.h>

#include "runs.h"

static const float time_step = 1 / 60.0f, gravity = 9.81f;

/* The world of the scene, with its platforms at 2, 4 and 6, but one of its bodies alone: number 1, above the floor. */
static world *begin_with(run *r, size_t kind, float height) {
    *r = begin_run("platforms", world_defaults, 1);
    world *const w = &r->world;
    const world_body body = w->bodies[1 + kind];
    while (w->body_count > 1)
        world_remove_body(w, &w->bodies[w->body_count - 1]);
    assert_int_equal(world_add_body(w, body), NARC_OK);
    w->bodies[1].position = (vec){0, height};
    w->settings.recycling = 0;
    return w;
}

static void step(world *w, int count) {
    for (int k = 0; k < count; k++)
        if (world_step(w) != NARC_OK)
            fail_msg("%s", w->error.message);
}

/* How high its lowest point is. */
static float find_height(const world *w, const world_body *body) {
    narc_aabb box;
    narc_get_aabb(w->store, body->shape, body->cosine, body->sine, 1, &box);
    return body->position.y + (float)box.min_y;
}

/* Has its velocity changed in a step by gravity alone? */
static bool is_free(const world_body *body, vec before) {
    return fabsf(body->velocity.x - before.x) < 1e-6f &&
           fabsf(body->velocity.y - (before.y - gravity * time_step)) < 1e-5f;
}

/* Stands within what contacts give way, and hardly moves. */
static bool stands_at(const world *w, const world_body *body, float height) {
    return fabsf(find_height(w, body) - height) < 0.01f && fabsf(body->velocity.y) < 0.2f;
}

enum { KINDS = 10 };

/* Steps until it falls and is held, by something below its lowest point; how many steps it was not free before. */
static int fly(world *w, int most) {
    const world_body *const body = &w->bodies[1];
    int held = 0;
    for (int k = 0; k < most; k++) {
        const vec before = body->velocity;
        step(w, 1);
        if (!is_free(body, before) && before.y < 0)
            return held;
        held += !is_free(body, before);
    }
    fail_msg("it flies for ever");
    return held;
}

/* From the floor up through the first platform, or not far enough, whatever it is. */
TEST(test_jumps) {
    for (size_t kind = 0; kind < KINDS; kind++)
        for (int high = 0; high < 2; high++) {
            run r;
            world *const w = begin_with(&r, kind, 0.8f);
            world_body *const body = &w->bodies[1];
            step(w, 240);
            world_wake_body(body);
            const float rises = 2 - find_height(w, body) + (high ? 0.2f : -0.2f); /* of its lowest point */
            body->spin = 0;
            body->velocity = (vec){0, sqrtf(2 * gravity * rises)};
            step(w, 1); /* off the floor, where something may hold it */
            assert_int_equal(fly(w, 240), 0);
            step(w, 240);
            if (fabsf(find_height(w, body) - (high ? 2 : 0)) > 0.01f)
                fail_msg("kind %zu, high %d: at %g", kind, high, (double)find_height(w, body));
            end_run(&r);
        }
}

/* From the second platform on to the first, and from there to the floor, each time it is told. */
TEST(test_drops) {
    for (size_t kind = 0; kind < KINDS; kind++) {
        run r;
        world *const w = begin_with(&r, kind, 5);
        world_body *const body = &w->bodies[1];
        for (float height = 4; height >= 2; height -= 2) {
            step(w, 300);
            assert_true(fabsf(find_height(w, body) - height) < 0.01f);
            world_wake_body(body);
            body->drops = true;
            body->velocity = (vec){0, 0};
            body->spin = 0;
            step(w, 1);
            body->drops = false; /* once is enough: it has begun */
            assert_int_equal(fly(w, 120), 0);
        }
        step(w, 300);
        assert_true(fabsf(find_height(w, body)) < 0.01f);
        end_run(&r);
    }
}

/* It carries what stands on it, to the sides and up and down, and from rest, when that slept. */
TEST(test_moving_platforms) {
    for (size_t kind = 0; kind < KINDS; kind++) {
        run r;
        world *const w = begin_with(&r, kind, 5);
        world_body *const body = &w->bodies[1];
        const vec velocities[] = {{0.5f, 0}, {-0.5f, 0}, {0, 0.5f}, {0, -1}, {0.3f, 0.5f}};
        float height = 4;
        step(w, 400);
        assert_true(body->kind & NARC_ASLEEP || kind == 0); /* a ball may roll */
        for (size_t k = 0; k < sizeof velocities / sizeof velocities[0]; k++) {
            world_move_platform(w, 2, velocities[k]);
            step(w, 60);
            height += velocities[k].y;
            const vec left = subtract(body->velocity, velocities[k]);
            if (!(fabsf(find_height(w, body) - height) < 0.015f && fabsf(left.y) < 0.1f &&
                  (kind == 0 || fabsf(left.x) < 0.3f))) /* some rock */
                fail_msg("kind %zu, way %zu: at %g, not %g, left behind by %g %g", kind, k,
                         (double)find_height(w, body), (double)height, (double)left.x, (double)left.y);
            if (kind == 0)
                body->velocity.x = body->spin = 0;
        }
        end_run(&r);
    }
}

/* One that comes up from below passes what stands on the floor, and leaves it there. */
TEST(test_platform_from_below) {
    for (size_t kind = 0; kind < KINDS; kind++) {
        run r;
        world *const w = begin_with(&r, kind, 2.8f);
        world_body *const body = &w->bodies[1];
        step(w, 300);
        assert_true(stands_at(w, body, 2));
        world_move_platform(w, 2, (vec){0, -2.2f});
        step(w, 60); /* from 4 to 1.8 */
        world_move_platform(w, 2, (vec){0, 1.1f});
        step(w, 150);
        assert_true(stands_at(w, body, 2));
        end_run(&r);
    }
}

/* Nothing is lost, and nothing falls out, in half a minute of the scene. */
TEST(test_scene) {
    run r = begin_run("platforms", world_defaults, 2);
    size_t above = 0;
    for (int k = 0; k < 30; k++) {
        continue_run(&r, 1);
        for (size_t i = 1; i < r.world.body_count; i++) {
            assert_true(find_height(&r.world, &r.world.bodies[i]) > -0.05f || fabsf(r.world.bodies[i].position.x) > 19);
            above += find_height(&r.world, &r.world.bodies[i]) > 1.9f;
        }
    }
    assert_true(above > 30);
    end_run(&r);
}

TEST_MAIN("platforms")
