/* SPDX-License-Identifier: MIT
 *
 * ground.c - the example world on ground: bowls, a looping, hills, a slope, against textbook mechanics.
 */
#include <math.h>

#include "runs.h"

static const double pi = 3.14159265358979, g = 9.81;

static world create_world(size_t capacity) {
    world w;
    world_settings settings = world_defaults;
    settings.sleep_time = INFINITY;
    assert_int_equal(world_create(&w, settings, capacity), NARC_OK);
    return w;
}

static world_body *add_to(world *w, const narc_arc *arcs, size_t count, double x, double y, float friction) {
    world_body body = {.position = {(float)x, (float)y}, .cosine = 1, .friction = friction};
    assert_int_equal(world_add_shape(w, arcs, count, &body.shape), NARC_OK);
    assert_int_equal(world_add_body(w, body), NARC_OK);
    return &w->bodies[w->body_count - 1];
}

static world_body *add_ball(world *w, double radius, double x, double y, float friction) {
    narc_arc arcs[NARC_MAX_ARCS];
    size_t count;
    assert_int_equal(narc_build_circle(radius, arcs, &count, NULL), NARC_OK);
    return add_to(w, arcs, count, x, y, friction);
}

static void step(world *w) { assert_int_equal(world_step(w), NARC_OK); }

/* A bowl of radius 5 about the origin, from 80 degrees on one side to 80 on the other: arcs, or so many sides to a full
 * turn, which touch the circle. */
static void add_bowl(world *w, size_t sides) {
    const double half = 80 * pi / 180, turn = 2 * pi / (double)sides, side = 10 * tan(turn / 2);
    track t = {.normal = pi / 2 + half};
    t.x = -5 * cos(t.normal);
    t.y = -5 * sin(t.normal);
    if (sides == 0)
        put_arc(&t, -5, -2 * half);
    else {
        put_arc(&t, 0, 0);
        for (put_edge(&t, side / 2); t.normal > pi / 2 - half; put_edge(&t, side))
            put_arc(&t, -0.0, -turn);
        put_arc(&t, 0, 0);
    }
    assert_int_equal(world_add_ground(w, t.arcs, t.count, false, 0.6f), NARC_OK);
}

/* Of a ball of radius 0.5 without friction, from 60 degrees: the energy that is lost in ten swings. */
static double swing(size_t sides) {
    AUTO(world_destroy) world w = create_world(256);
    w.settings.rolling_arm = 0;
    add_bowl(&w, sides);
    const world_body *ball = add_ball(&w, 0.5, 4.5 * sin(pi / 3), -4.5 * cos(pi / 3), 0);
    const double lowest = -4.5 * g / (double)ball->inverse_mass, start = world_energy(&w) - lowest;
    int turns = 0;
    double most = 0;
    for (int steps = 0; turns < 20 && steps < 4000; steps++) {
        const float before = ball->velocity.x;
        step(&w);
        turns += before * ball->velocity.x < 0;
        most = fmax(most, world_energy(&w) - lowest);
    }
    const double left = (world_energy(&w) - lowest) / start;
    print_message("%zu sides: %d turns, %.2f %% of the energy lost, at most %.2f %% more\n", sides, turns,
                  100 * (1 - left), 100 * (most / start - 1));
    assert_int_equal(turns, 20);
    assert_true(most < 1.005 * start);
    return 1 - left;
}

/* An arc takes nothing, for its normal is the true one after each sub-step; each side of a polyline is a blow. */
TEST(test_bowl) {
    assert_true(fabs(swing(0)) < 0.002);
    assert_true(swing(240) > 0.1);
    assert_true(swing(60) > 0.5);
}

/* How far from its looping is a marble at most, from where it enters it until its arc ends, 0.8 radians short of a full
 * turn? What comes from a height below 2.5 times the radius of its centre's circle falls off. */
static double find_gap(double height) {
    AUTO(world_destroy) world w = create_world(64);
    const double circle = 2 - 0.25;
    w.settings.rolling_arm = 0;
    add_looping(&w, 0, height * circle);
    double turned = 0, gap = 0;
    for (int steps = 0; steps < 360 && turned < 2 * pi - 0.85 && gap < 0.5 * circle; steps++) {
        step(&w);
        const double x = (double)w.bodies->position.x, y = (double)w.bodies->position.y - 2;
        if (turned == 0 && x < 0)
            continue; /* it comes */
        turned += remainder(atan2(y, x) + pi / 2 - turned, 2 * pi);
        gap = fmax(gap, circle - hypot(x, y));
    }
    return gap / circle;
}

/* The same of a stone that flies where it is too slow for the circle: at the angle a from the lowest place, where
 * v^2 = 2 (height - 1 + cos a) g has become -cos a g, for a circle of 1. */
static double expect_gap(double height) {
    const double a = acos(-2 * (height - 1) / 3), speed = sqrt(-g * cos(a));
    double gap = 0;
    for (double t = 0; height < 2.5 && t < 1 && gap < 0.5; t += 1e-3) {
        const double x = sin(a) + speed * cos(a) * t, y = -cos(a) + speed * sin(a) * t - g * t * t / 2;
        if (hypot(x, y) > 1)
            break;
        gap = fmax(gap, 1 - hypot(x, y));
    }
    return gap;
}

TEST(test_looping) {
    for (double height = 2.2; height < 4; height += 0.01) {
        const double gap = find_gap(height), expected = expect_gap(height);
        assert_true(fabs(gap - expected) < 0.015);
        assert_true(fabs(height - 2.5) < 0.0051 || (gap > 0.001) == (height < 2.5));
    }
}

/* How far above a crest, 0.5 radians to either side, is a stone at most that comes onto it with this speed? The circle
 * is that of a wheel's centre. */
static double expect_flight(double speed, double circle) {
    double gap = 0;
    for (double t = 0, height = 0; height >= 0; t += 1e-3) {
        const double x = speed * cos(0.5) * t - circle * sin(0.5);
        const double y = speed * sin(0.5) * t - g * t * t / 2 + circle * cos(0.5);
        height = x < y * tan(0.5) ? hypot(x, y) - circle + 1e-12 : -1;
        gap = fmax(gap, height);
    }
    return gap;
}

/* The centre of the ground's arc with this radius. */
static vec find_crest(const world *w, double radius) {
    for (const world_body *entry = w->bodies + w->body_count;; entry++) {
        narc_arc arcs[NARC_MAX_ARCS];
        for (size_t k = narc_get_arcs(w->store, entry->shape, arcs); k-- > 0;)
            if (fabs(arcs[k].radius - radius) < 1e-6)
                return add(entry->position, (vec){(float)arcs[k].center_x, (float)arcs[k].center_y});
        assert_true(entry + 1 < w->bodies + w->body_count + w->ground_count);
    }
}

/* The car coasts over the first hill, with a crest of radius 4. Where gravity holds it on the circle it stays on the
 * ground; else its middle flies as a stone, the front wheel above and the rear one below. */
static void coast(float speed) {
    run r = begin_run("car", world_defaults, 1);
    world *w = &r.world;
    const vec centre = find_crest(w, 4);
    w->settings.rolling_arm = 0;
    for (size_t k = 0; k < 3; k++) {
        w->bodies[k].velocity.x = speed;
        w->bodies[k].spin = k > 0 ? -speed / 0.4f : 0;
    }
    const double circle = 4.4;
    double expected = -1, gap[3] = {0}, start = 0;
    for (int steps = 0; steps < 300; steps++) {
        step(w);
        for (size_t k = 0; k < 3; k++) {
            const vec at = subtract(w->bodies[k].position, centre);
            if (fabsf(at.x) > at.y * tanf(0.5f))
                continue;
            gap[k] = fmax(gap[k], (double)length(at) - circle);
            if (k == 0 && expected < 0) {
                start = (double)length(w->bodies[0].velocity);
                expected = expect_flight(start, circle);
            }
        }
    }
    print_message("%.2f m/s onto the crest, %.2f hold it: rear %.4f, front %.4f, expected %.4f\n", start,
                  sqrt(g * circle * cos(0.5)), gap[1], gap[2], expected);
    assert_true(fabs((gap[1] + gap[2]) / 2 - expected) < 0.06);
    assert_true(start * start > g * circle * cos(0.5) || (gap[1] < 0.01 && gap[2] < 0.01));
    end_run(&r);
}

TEST(test_car) {
    for (float speed = 4.5f; speed < 10; speed += 0.5f)
        coast(speed);
}

/* A box of 2 by 1 in a bowl of radius 5 stands on two corners, each with the normal to the bowl's centre; its own is
 * where two corners on the circle put it, less what contacts give way. */
TEST(test_box_in_bowl) {
    run r = begin_run("bowl", world_defaults, 1);
    r.world.settings.sleep_time = INFINITY;
    continue_run(&r, 20);
    continue_calm_run(&r, 1);
    const world_body *box = r.world.bodies;
    assert_true(world_speed(&r.world, box) < 1e-3f);
    const vec from_centre = subtract(box->position, (vec){0, 5});
    print_message("distance %.6f\n", (double)length(from_centre));
    assert_true(fabsf(length(from_centre) - (sqrtf(24) - 0.5f)) < 0.003f);
    size_t points = 0;
    for (size_t k = 0; k < r.world.active_count; k++)
        for (unsigned i = 0; i < r.world.active[k]->point_count; i++, points++) {
            const world_point *p = &r.world.active[k]->points[i];
            const vec corner = subtract(add(box->position, p->anchor_a), (vec){0, 5});
            assert_true(p->normal_impulse > 0);
            assert_true(fabsf(cross(p->normal, corner)) < 1e-3f);
            assert_true(fabsf(length(corner) - 5) < 0.003f);
        }
    assert_int_equal(points, 2);
    end_run(&r);
}

/* All lie, at the end. */
TEST(test_dominoes) {
    for (uint64_t seed = 1; seed <= 3; seed++) {
        run r = begin_run("dominoes", world_defaults, seed);
        continue_run(&r, 1);
        for (size_t k = 0; k < 20; k++)
            assert_true(r.world.bodies[k].cosine > 0.98f);
        continue_run(&r, 7);
        for (size_t k = 0; k < 20; k++)
            assert_true(r.world.bodies[k].cosine < 0.8f);
        assert_int_equal(measure_run(&r).awake, 0);
        end_run(&r);
    }
}

/* Bullets that spin, against ground: none comes through, whatever its shape. */
TEST(test_bullets_on_ground) {
    for (uint64_t seed = 1; seed <= 20; seed++) {
        run r = begin_run("bullets", world_defaults, seed);
        world *const w = &r.world;
        track t = {.x = 20, .y = 30, .normal = pi / 2};
        put_arc(&t, 0, 0);
        put_edge(&t, 40);
        put_arc(&t, 0, 0);
        assert_int_equal(world_add_ground(w, t.arcs, t.count, false, 0.6f), NARC_OK);
        for (size_t k = 2; k < w->body_count; k++) {
            world_body *const body = &w->bodies[k];
            body->position = (vec){-8 + 2 * (float)k, 33 + 0.3f * (float)seed};
            body->velocity = (vec){0, -120};
        }
        for (int steps = 0; steps < 60; steps++) {
            step(w);
            for (size_t k = 2; k < w->body_count; k++)
                assert_true(w->bodies[k].position.y > 30 || fabsf(w->bodies[k].position.x) > 20);
        }
        end_run(&r);
    }
}

TEST_MAIN("ground")
