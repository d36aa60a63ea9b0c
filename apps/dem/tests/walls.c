/* SPDX-License-Identifier: MIT
 *
 * walls.c - walls that move, turn, work and press; and stresses.
 */
#include <math.h>

#include "worlds.h"

#define PI 3.14159265358979323846

/* A plate that moves at a constant speed throws a grain at twice that speed, and its work is the grain's energy. */
TEST(test_work_of_a_wall) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.time_step = 1e-5;
    add_plate(&d, "piston", 0, 0, 1, 0);
    add_grain(&d, DISC, 1.01, 0, 0, 0);
    d.walls[0].velocity = (vec){2, 0};
    dem_start(&d);
    step(&d, 5000);
    print_message("speed %.9g, work %.9g of %.9g\n", d.bodies[0].velocity.x, d.walls[0].work, energies(&d).kinetic);
    assert_int_equal(d.contact_count, 0);
    assert_true(fabs(d.bodies[0].velocity.x - 4) < 4e-3);
    assert_true(fabs(d.walls[0].work - energies(&d).kinetic) < 1e-4); /* 1e-7 of a depth, in each of some steps */
    assert_true(fabs(d.bodies[1].position.x + 4 * (d.grain_reach + d.settings.skin) - 2 * d.time) < 1e-9);
}

/* The depth in a plate that is neither level nor upright, far along it, before the first step: also one that is less than
 * what single precision rounds there. */
TEST(test_oblique_plate_far_away) {
    for (int k = 0; k < 20; k++) {
        const double depth = k % 2 ? 1e-3 : 1e-7;
        const double along = 1e4 + 7.7 * k;
        AUTO(dem_destroy) dem d = plain_world();
        const double above = d.shapes[DISC].reach - depth;
        add_plate(&d, "slope", 0, 0, 0.6, 0.8);
        add_grain(&d, DISC, 0.8 * along + 0.6 * above, -0.6 * along + 0.8 * above, 0, 0);
        dem_start(&d);
        assert_int_equal(d.contact_count, 1);
        assert_true(fabs(hypot(d.bodies[0].force.x, d.bodies[0].force.y) / (plain_law().kn * depth) - 1) < 2e-3);
    }
}

/* A box on an arm: after one turn it is where it was, and its surface moves as it turns. */
TEST(test_turning_wall) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.time_step = 1e-3;
    dem_wall *blade = add_box(&d, OCTAGON, 1, 5, 1);
    blade->angle = 0.25;
    blade->pivot.x = 2;
    blade->spin = 2 * PI;
    blade->velocity.y = 1;
    add_grain(&d, DISC, 100, 0, 0, 0);
    dem_start(&d);
    step(&d, 250);
    /* A quarter of a turn: 2 atan(h) for each step of 2 h, less by a third of h^2, 3.3e-6. */
    assert_true(fabs(d.bodies[1].position.x - 2) < 1e-4 && fabs(d.bodies[1].position.y - 4.25) < 1e-4);
    assert_true(fabs(d.bodies[1].velocity.x + 3 * 2 * PI) < 1e-3 && fabs(d.bodies[1].velocity.y - 1) < 1e-3);
    assert_true(fabs(atan2(d.bodies[1].turn.y, d.bodies[1].turn.x) - 0.25 - PI / 2) < 1e-4);
    step(&d, 750);
    assert_true(fabs(d.bodies[1].position.x - 5) < 1e-3 && fabs(d.bodies[1].position.y - 2) < 1e-3);
    assert_true(fabs(hypot(d.bodies[1].turn.x, d.bodies[1].turn.y) - 1) < 1e-14);
}

/* A tower of three discs between plates, without gravity. The lid goes up (1) or down (-1) until it presses. */
static dem make_press(double up, double force, double gain, double max_speed, double travel) {
    dem d = plain_world();
    d.laws[0][0].damping_ratio = 1;
    add_plate(&d, "floor", 0, 0, 0, 1);
    add_plate(&d, "lid", 0, 6.01, 0, -1);
    for (int k = 0; k < 3; k++)
        add_grain(&d, DISC, 0, 1 + 2 * k, 0, 0);
    d.walls[1].servo =
        (dem_servo){true, {0, up}, force, .between = {-1, -1}, .gain = gain, .max_speed = max_speed, .travel = travel};
    dem_start(&d);
    return d;
}

/* The lid comes down until it presses as it should. In series three discs have four contacts, each F / kn deep. Depths
 * are floats, within 2e-6 of some 1e-3, so forces are within 0.2 %. */
TEST(test_servo_force) {
    const double force = 150;
    AUTO(dem_destroy) dem d = make_press(-1, force, 5e-4, 0.5, 0);
    step(&d, 20000);
    print_message("forces %.6g and %.6g\n", dem_wall_force(&d, 0).y, dem_wall_force(&d, 1).y);
    assert_true(fabs(dem_wall_force(&d, 1).y / force - 1) < 1e-3);
    assert_true(fabs(dem_wall_force(&d, 0).y / -force - 1) < 1e-3);
    assert_true(fabs(d.walls[1].work / (4 * 0.5 * force * force / 1e5) - 1) < 0.3); /* and what dashpots took */
    /* Compression of the tower: the force over its length in the volume of a region of 2 by 6. */
    const dem_region region = {true, {-1, -1}, {1, 7}};
    dem_measures m;
    dem_measure(&d, &region, &m);
    const double length = 6 - 4 * 0.5 * force / 1e5 - 2 * 0.5 * force / 1e5;
    assert_true(fabs(m.stress.yy / (force * length / 16) - 1) < 2e-3);
    assert_true(fabs(m.stress.xx) < 1e-9 && fabs(m.stress.xy) < 1e-6 && fabs(m.stress.yx) < 1e-6);
    assert_int_equal(m.contacts, 4);
    assert_true(fabs(m.coordination - 2) < 1e-12); /* two ends of two contacts, and two with walls, of three grains */
}

/* A stress acts on the length between two walls. */
TEST(test_servo_stress) {
    AUTO(dem_destroy) dem d = make_press(-1, 0, 5e-4, 0.5, 0);
    d.walls[1].servo.stress = 25;
    d.walls[1].servo.between[0] = 0;
    d.walls[1].servo.between[1] = 1;
    step(&d, 20000);
    assert_true(fabs(dem_wall_force(&d, 1).y / (25 * 6) - 1) < 2e-3);
}

static void step_until_error(dem *d, const char *message) { EXPECT_ERROR(d, message, step(d, 100000)); }

/* A lid that finds nothing to press goes as far as it may, 0.01 a step, then the run ends. */
TEST(test_servo_without_grains) {
    const double travels[] = {0, 2.495, 39.995};
    for (size_t i = 0; i < 3; i++) {
        dem d =
            make_press(1, 1, 100, 100, travels[i]); /* grains from 0 to 6, 2 wide; the lid at 6.01, the floor at 0 */
        const double travel = i > 0 ? travels[i] : hypot(2, 6.01);
        step_until_error(&d, "wall 'lid' has moved by more than");
        print_message("%s\n", d.error);
        assert_int_equal(d.step, (uint64_t)ceil(travel / 0.01));
        dem_destroy(&d);
    }
}

/* A gap that is shorter than the travel is crossed; after a contact the way counts anew. */
TEST(test_servo_touches_in_time) {
    AUTO(dem_destroy) dem d = make_press(-1, 150, 5e-4, 0.5, 0.011);
    step(&d, 20000);
    assert_true(d.walls[1].idle_way == 0 && fabs(dem_wall_force(&d, 1).y / 150 - 1) < 1e-3);
}

/* Who is to press with no force, and touches nothing, stays. */
TEST(test_servo_of_no_force) {
    AUTO(dem_destroy) dem d = make_press(-1, 0, 5e-4, 0.5, 0);
    const double before = d.bodies[4].position.y;
    step(&d, 1000);
    assert_true(d.bodies[4].position.y == before);
}

/* A plate's own velocity along itself drags a grain by friction until both move alike. */
TEST(test_conveyor) {
    AUTO(dem_destroy) dem d = plain_world();
    d.settings.gravity = (vec){0, -10};
    d.laws[0][0].friction = 0.3;
    d.laws[0][0].damping_ratio = 1;
    add_plate(&d, "belt", 0, 0, 0, 1);
    add_grain(&d, OCTAGON, 0, cos(PI / 8), 0, 0); /* it lies on a side, */
    d.bodies[0].turn.x = cos(PI / 8);             /* after an eighth of a turn */
    d.bodies[0].turn.y = sin(PI / 8);
    d.walls[0].velocity = (vec){-2, 0};
    dem_start(&d);
    step(&d, 20000);
    assert_true(fabs(d.bodies[0].velocity.x + 2) < 0.02);
    assert_true(fabs(d.bodies[1].position.x) < 1e-12); /* the plate's body stays */
}

/* Two grains side by side on a plate, of one category: each has an image of the plate's block that the other one overlaps. */
TEST(test_one_pair_with_a_plate) {
    AUTO(dem_destroy) dem d = plain_world();
    add_plate(&d, "floor", 0, 0, 0, 1);
    for (int k = 0; k <= 63; k++)
        add_grain(&d, DISC, k % 63 == 0 ? k / 25.0 : 10 * k, k % 63 == 0 ? 0.999 : 50, 0, 0);
    dem_start(&d);
    step(&d, 1);
    assert_int_equal(d.pair_count, 2);
    assert_int_equal(d.contact_count, 2);
    assert_true(d.pairs[0].a == 0 && d.pairs[1].a == 63);
}
