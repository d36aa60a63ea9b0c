/* SPDX-License-Identifier: MIT
 *
 * slopes.c - grains that roll and slide down a slope, against closed forms. The slope is a horizontal plate and
 * gravity is inclined. A grain of radius 1 begins at the depth that carries it, so it does not bounce.
 */
#include <math.h>

#include "worlds.h"

static const double GRAVITY = 10, ANGLE = 0.4;

/* The depth of the grain that rests on the plate. The contact point is halfway between both surfaces, so forces have
 * the arm 1 - depth / 2. */
static double find_depth(const dem *d) { return d->bodies[0].mass * GRAVITY * cos(ANGLE) / d->laws[0][0].kn; }

static dem make_slope(uint32_t shape, double friction, double rolling_friction, bool periodic) {
    dem d = plain_world();
    d.settings.gravity = (vec){GRAVITY * sin(ANGLE), -GRAVITY * cos(ANGLE)};
    d.settings.periodic_x = periodic;
    d.settings.high.x = 7;
    d.laws[0][0].friction = friction;
    d.laws[0][0].rolling_friction = rolling_friction;
    d.laws[0][0].damping_ratio = 1;
    add_plate(&d, "slope", 0, 0, 0, 1);
    add_grain(&d, shape, 0, 1, 0, 0);
    d.bodies[0].position.y = 1 - find_depth(&d);
    dem_start(&d);
    return d;
}

/* About the contact point, gravity's torque m g sin(angle) arm turns m arm^2 + I. The spring of the contact swings in
 * at the start and is damped, and takes a slip of m g sin(angle) / (3 kt) = 3e-4. Float depths are within 2e-6 of 3e-4,
 * but they change the normal force, which does not count as long as the grain does not slide. */
static void check_rolling(uint32_t shape, bool periodic) {
    AUTO(dem_destroy) dem d = make_slope(shape, 0.5, 0, periodic);
    const double arm = 1 - 0.5 * find_depth(&d), mass = d.bodies[0].mass, inertia = d.bodies[0].inertia;
    const double expected = GRAVITY * sin(ANGLE) / (1 + inertia / (mass * arm * arm));
    step(&d, 20000);
    const double time = d.time, speed = d.bodies[0].velocity.x;
    print_message("rolling: acceleration %.9g, expected %.9g, slip %.3g\n", speed / time, expected,
                  speed + d.bodies[0].spin * arm);
    assert_true(fabs(speed / time / expected - 1) < 1e-5);
    assert_true(fabs(speed + d.bodies[0].spin * arm) < 1e-4 * speed);
    const double way = d.bodies[0].position.x + (periodic ? 7.0 * d.bodies[0].cell_x : 0);
    assert_true(fabs(way / (0.5 * expected * time * time) - 1) < 1e-4);
}

TEST(test_disc_rolls) { check_rolling(DISC, false); }

TEST(test_round_grain_rolls) { check_rolling(ROUND, false); }

TEST(test_history_survives_borders) {
    check_rolling(DISC, true);
    check_rolling(ROUND, true);
}

/* Below a third of tan(angle) friction cannot hold it: g (sin - mu cos) down, mu m g cos arm / I about the centre. */
static void check_sliding(uint32_t shape) {
    const double friction = 0.25 * tan(ANGLE) / 3;
    AUTO(dem_destroy) dem d = make_slope(shape, friction, 0, false);
    const double arm = 1 - 0.5 * find_depth(&d), mass = d.bodies[0].mass, inertia = d.bodies[0].inertia;
    const double along = GRAVITY * (sin(ANGLE) - friction * cos(ANGLE));
    const double turn = -friction * mass * GRAVITY * cos(ANGLE) * arm / inertia;
    step(&d, 10000);
    print_message("sliding: acceleration %.9g, expected %.9g; turning %.9g, expected %.9g\n",
                  d.bodies[0].velocity.x / d.time, along, d.bodies[0].spin / d.time, turn);
    /* The spring takes mu m g cos / kt, 4e-5, to load: no more than 1e-2 s of the second. */
    assert_true(fabs(d.bodies[0].velocity.x / d.time / along - 1) < 1e-3);
    assert_true(fabs(d.bodies[0].spin / d.time / turn - 1) < 1e-2);
}

TEST(test_grains_slide) {
    check_sliding(DISC);
    check_sliding(ROUND);
}

/* Rolling friction above tan(angle) holds a disc (its torque can be mu_r R m g cos, gravity's is m g sin R), and below
 * it takes away its share. */
TEST(test_rolling_friction) {
    AUTO(dem_destroy) dem held = make_slope(DISC, 1, 1.2 * tan(ANGLE), false);
    AUTO(dem_destroy) dem slower = make_slope(DISC, 1, 0.5 * tan(ANGLE), false);
    step(&held, 20000);
    step(&slower, 10000); /* until the springs are loaded */
    const double before = slower.bodies[0].velocity.x;
    step(&slower, 10000);
    const double found = slower.bodies[0].velocity.x - before; /* in a second */
    assert_true(fabs(held.bodies[0].velocity.x) < 0.01 && fabs(held.bodies[0].position.x) < 0.01);
    const double arm = 1 - 0.5 * find_depth(&slower), mass = slower.bodies[0].mass;
    const double torque = mass * GRAVITY * sin(ANGLE) * arm - 0.5 * tan(ANGLE) * mass * GRAVITY * cos(ANGLE);
    const double expected = torque * arm / (mass * arm * arm + slower.bodies[0].inertia);
    print_message("rolling friction: acceleration %.9g, expected %.9g\n", found, expected);
    assert_true(fabs(found / expected - 1) < 1e-3); /* the normal force is within 2e-6 of 3e-4 */
}
