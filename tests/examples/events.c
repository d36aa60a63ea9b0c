/* SPDX-License-Identifier: MIT
 *
 * events.c - bodies that come and go, begin and end events against brute force, sensors, sleep.
 */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "runs.h"

enum { IDS = 400, BODIES = 64 };

/* ------------------------------------------------------------------------------------------------ brute force */

/* What all events so far say, by ids; and the distances of all bodies from each other. */
typedef struct record {
    bool touching[IDS][IDS], begun[IDS][IDS];
    world_body before[BODIES];
    size_t before_count;
    size_t begins, ends;
} record;

static void take_events(record *seen, const world *w) {
    memset(seen->begun, 0, sizeof seen->begun);
    for (size_t k = 0; k < w->event_count; k++) {
        const world_event *event = &w->events[k];
        const uint64_t a = event->id_a < event->id_b ? event->id_a : event->id_b, b = event->id_a ^ event->id_b ^ a;
        assert_true(a > 0 && b < IDS);
        assert_int_equal(seen->touching[a][b], !event->begins); /* in turns */
        seen->touching[a][b] = seen->begun[a][b] = event->begins;
        seen->begins += event->begins;
        seen->ends += !event->begins;
        assert_true(!event->begins || (world_find_body(w, a) && world_find_body(w, b)));
    }
}

/* The separation of two bodies. */
static float separate(const world *w, const world_body *a, const world_body *b) {
    const narc_body two[] = {{(double)a->position.x, (double)a->position.y, a->cosine, a->sine, 1, a->shape},
                             {(double)b->position.x, (double)b->position.y, b->cosine, b->sine, 1, b->shape}};
    narc_bodies bodies;
    narc_view_bodies(two, 2, &bodies);
    const narc_query query = {.margin = INFINITY};
    narc_contact row;
    size_t found;
    assert_int_equal(narc_find_contacts(w->store, &bodies, &(narc_pairs){.count = 1}, &query, &row, 1, &found, NULL),
                     NARC_OK);
    return row.separation;
}

/* How far can two bodies that press each other in a step be apart after it? */
static float find_way(const world *w, const world_body *a, const world_body *b) {
    return 0.01f + w->settings.time_step * (world_speed(w, a) + world_speed(w, b));
}

/* Contacts are found where the bodies are before the step. Bodies that touch are pressed in the step, and then close by
 * after it; or they overlap there, or if they touched before are not further apart than the margin. */
static void compare(const record *seen, const world *w) {
    size_t touching = 0, expected = 0;
    for (size_t a = 0; a < IDS; a++)
        for (size_t b = a; b < IDS; b++)
            touching += seen->touching[a][b];
    for (size_t i = 0; i < seen->before_count; i++)
        for (size_t j = i + 1; j < seen->before_count; j++) {
            const world_body *a = &seen->before[seen->before[i].id < seen->before[j].id ? i : j];
            const world_body *b = a == &seen->before[i] ? &seen->before[j] : &seen->before[i];
            if (a->kind & b->kind & (NARC_STATIC | NARC_SENSOR))
                continue;
            const bool on = seen->touching[a->id][b->id];
            const world_body *a_now = world_find_body(w, a->id), *b_now = world_find_body(w, b->id);
            const float before = separate(w, &seen->before[i], &seen->before[j]);
            expected += on;
            if ((a->kind | b->kind) & NARC_SENSOR)
                assert_int_equal(on, before < 0);
            else if (!on)
                assert_true(before >= 0);
            else {
                const float most = seen->begun[a->id][b->id] ? 0 : w->settings.margin;
                assert_true(before < most || separate(w, a_now, b_now) < find_way(w, a_now, b_now));
            }
        }
    assert_int_equal(touching, expected); /* none of bodies that are gone */
}

/* The rain, and what else may happen to bodies: any of them goes, or leaps away; a sensor moves among them. */
static void check_events(float sleep_time, uint64_t seed) {
    world_settings settings = world_defaults;
    settings.recycling = 0; /* separations are exact */
    settings.sleep_time = sleep_time;
    run r = begin_run("rain", settings, seed);
    world *w = &r.world;
    AUTO(free_at) record *seen = calloc(1, sizeof *seen);
    assert_non_null(seen);
    struct test_random random = {seed};
    world_body eye = w->bodies[1];
    eye.kind = NARC_SENSOR;
    eye.shape = 2; /* a circle, which some overlap while others pass by */
    eye.position = (vec){-3, 1.2f};
    eye.velocity = (vec){0.5f, 0};
    assert_int_equal(world_add_body(w, eye), NARC_OK);
    w->capacity = BODIES;
    for (long step = 1; step <= 600; step++) {
        assert_int_equal(find_scene("rain")->act(w, step), NARC_OK);
        if (step % 23 == 0 && w->body_count > 4) {
            const size_t body = step % 2 == 0 ? w->body_count - 1 : 3 + random_below(&random, w->body_count - 3);
            const uint64_t id = w->bodies[body].id;
            world_remove_body(w, &w->bodies[body]);
            assert_null(world_find_body(w, id));
        }
        if (step % 31 == 0 && w->body_count > 3) {
            world_body *body = &w->bodies[3 + random_below(&random, w->body_count - 3)];
            world_wake_body(body);
            body->position.y += (float)random_between(&random, 0, 4);
        }
        memcpy(seen->before, w->bodies, w->body_count * sizeof *w->bodies);
        seen->before_count = w->body_count;
        assert_int_equal(world_step(w), NARC_OK);
        take_events(seen, w);
        compare(seen, w);
    }
    print_message("%zu begin, %zu end, %zu bodies of %d\n", seen->begins, seen->ends, w->body_count, (int)w->last_id);
    assert_true(seen->begins > 100 && seen->ends > 100);
    end_run(&r);
}

TEST(test_events) {
    for (uint64_t seed = 1; seed <= test_trials(4); seed++)
        check_events(seed % 2 == 0 ? INFINITY : 0.1f, seed);
}

/* Of 100 bodies beside a sensor those begin that overlap it, each third one, and no other. */
TEST(test_many_at_a_sensor) {
    world_settings settings = world_defaults;
    settings.gravity = (vec){0, 0};
    run r = begin_run("rain", settings, 1);
    world *w = &r.world;
    world_body sensor = w->bodies[1]; /* a bar, 1 high */
    sensor.kind = NARC_SENSOR;
    sensor.position = (vec){0, 50};
    assert_int_equal(world_add_body(w, sensor), NARC_OK);
    for (int k = 0; k < 100; k++) { /* circles of radius 0.4 */
        const world_body body = {
            .position = {0.07f * (float)k - 3.5f, k % 3 == 0 ? 50.89f : 50.91f}, .cosine = 1, .shape = 2};
        assert_int_equal(world_add_body(w, body), NARC_OK);
    }
    assert_int_equal(world_step(w), NARC_OK);
    assert_int_equal(w->result->sensor_count, 34);
    size_t begun = 0;
    for (size_t k = 0; k < w->event_count; k++)
        if (w->events[k].sensor) {
            const uint64_t id = w->events[k].id_b; /* the sensor has id 3, and the first circle 4 */
            assert_true(w->events[k].begins && w->events[k].id_a == 3 && (id - 4) % 3 == 0);
            begun++;
        }
    assert_int_equal(begun, 34);
    end_run(&r);
}

/* ------------------------------------------------------------------------------------------------ sleep */

static size_t count_awake(const run *r) { return measure_scene(&r->world).awake; }

static run begin_asleep(const char *name) {
    run r = begin_run(name, world_defaults, 1);
    continue_run(&r, 10);
    assert_int_equal(count_awake(&r), 0);
    return r;
}

/* What sleeps keeps its bits, and costs no contact. */
TEST(test_sleepers_stay) {
    run r = begin_asleep("stack");
    const uint64_t hash = world_hash(&r.world);
    continue_run(&r, 1);
    assert_int_equal(world_hash(&r.world), hash);
    assert_int_equal(r.world.result->asked_count + r.world.active_count + r.world.event_count, 0);
    end_run(&r);
}

/* A stack whose lowest box goes wakes, all of it; a box on top falls by one if that below it goes, and sleeps again. */
TEST(test_removal_wakes) {
    run r = begin_asleep("stack");
    const float height = r.world.bodies[30].position.y;
    const uint64_t top = r.world.bodies[30].id;
    world_remove_body(&r.world, &r.world.bodies[29]);
    continue_run(&r, 0.1f);
    assert_int_equal(count_awake(&r), 29);
    continue_run(&r, 10);
    assert_int_equal(count_awake(&r), 0);
    assert_true(fabsf(world_find_body(&r.world, top)->position.y - (height - 1)) < 0.1f);
    /* The top one takes the number of the lowest: pairs with it stand in the other order, and
     * nothing leaps; but what was pressed together parts, and these speeds add up along the stack. */
    world_remove_body(&r.world, &r.world.bodies[1]);
    continue_run(&r, 0.1f);
    assert_int_equal(count_awake(&r), 28);
    for (size_t k = 0; k < r.world.body_count; k++)
        assert_true(world_speed(&r.world, &r.world.bodies[k]) < 3);
    end_run(&r);
}

/* What falls on it wakes it, all of it, when it touches. Its contacts are those that it fell asleep with. */
TEST(test_touch_wakes) {
    run r = begin_asleep("stack");
    world_body body = r.world.bodies[30];
    body.position.y += 1.5f;
    assert_int_equal(world_add_body(&r.world, body), NARC_OK);
    size_t most = 0;
    for (int step = 0; step < 60; step++) {
        continue_run(&r, 1 / 60.0f);
        const size_t awake = count_awake(&r);
        assert_true(awake == 1 || awake == 31);
        most = awake > most ? awake : most;
    }
    assert_int_equal(most, 31);
    continue_run(&r, 10);
    assert_true(measure_run(&r).sideways < 0.05);
    end_run(&r);
}

/* An island far away sleeps on. */
TEST(test_islands) {
    run r = begin_asleep("stack");
    world_body body = r.world.bodies[1];
    body.position = (vec){5, 2};
    assert_int_equal(world_add_body(&r.world, body), NARC_OK);
    const uint64_t hash = world_hash(&r.world);
    continue_run(&r, 1);
    assert_int_not_equal(world_hash(&r.world), hash);
    assert_true(count_awake(&r) == 1);
    end_run(&r);
}

TEST_MAIN("events")
