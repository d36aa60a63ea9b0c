/* SPDX-License-Identifier: MIT
 *
 * collisions.c - two grains collide: closed forms, conservation, and the order of the time step.
 */
#include <math.h>

#include "worlds.h"

#define PI 3.14159265358979323846

/* Two grains that are about to touch, with the given velocity of the left one. Depths may be large. */
static dem make_collision(uint32_t shape, dem_law kind, dem_contact_law law, double time_step, double vx, double vy) {
    dem_settings settings = plain_settings();
    settings.time_step = time_step;
    settings.max_overlap = 0.5;
    settings.law = kind;
    dem d = make_world(settings, law);
    add_grain(&d, shape, 0, 0, vx, vy);
    add_grain(&d, shape, shape == DISC ? 2 - 1e-9 : 2.7, 0, 0, 0);
    dem_start(&d);
    return d;
}

/* Until they are apart. */
static void collide(dem *d) {
    bool touched = false;
    for (size_t i = 0; i < 1000000 && !(touched && d->contact_count == 0); i++) {
        step(d, 1);
        touched |= d->contact_count > 0;
    }
    assert_int_equal(d->contact_count, 0);
}

static double momentum_x(const dem *d) {
    return d->bodies[0].mass * d->bodies[0].velocity.x + d->bodies[1].mass * d->bodies[1].velocity.x;
}
static double momentum_y(const dem *d) {
    return d->bodies[0].mass * d->bodies[0].velocity.y + d->bodies[1].mass * d->bodies[1].velocity.y;
}

static double angular_momentum(const dem *d) {
    const dem_body *b = d->bodies;
    double sum = 0;
    for (size_t k = 0; k < 2; k++)
        sum += b[k].mass * (b[k].position.x * b[k].velocity.y - b[k].position.y * b[k].velocity.x) +
               b[k].inertia * b[k].spin;
    return sum;
}

/* Without damping all energy comes back. Linear: half a period of the spring, depth v sqrt(m / kn). Hertz, of spheres: force
 * k h^(3/2), k = 4/3 E* sqrt(R); depth (5 m v^2 / (4 k))^(2/5), duration 2.943275 times that over v. */
TEST(test_elastic_collision) {
    const double mass = 0.5 * PI, stiffness = 4.0 / 3 * (1e6 / (2 * (1 - 0.0625))) * sqrt(0.5);
    const double depths[] = {sqrt(mass / 1e5), pow(5 * mass / (4 * stiffness), 0.4)};
    for (int kind = 0; kind < 2; kind++) {
        const double depth = depths[kind], duration = (kind ? 2.943275 : PI) * depth;
        dem_contact_law law = plain_law();
        law.damping_ratio = 0;
        AUTO(dem_destroy) dem d = make_collision(DISC, kind ? DEM_HERTZ : DEM_LINEAR, law, duration / 2000, 1, 0);
        double deepest = 0;
        step(&d, 1);
        for (size_t i = 0; d.contact_count > 0; i++) {
            deepest = fmax(deepest, d.contacts[0].depth);
            step(&d, 1);
        }
        print_message("depth %.6g, expected %.6g; duration %.6g, expected %.6g\n", deepest, depth, d.time, duration);
        assert_true(fabs(d.time / duration - 1) < 3e-3); /* steps, and where the first was within the contact */
        assert_true(fabs(deepest / depth - 1) < 1e-3);
        assert_true(fabs(d.bodies[1].velocity.x - 1) < 1e-3 && fabs(d.bodies[0].velocity.x) < 1e-3);
    }
}

/* Whatever the law: forces are opposite and share their point, and so do kicks. */
TEST(test_conservation) {
    for (int kind = 0; kind < 4; kind++) {
        dem_contact_law law = plain_law();
        law.damping_ratio = dem_damping_ratio(kind % 2 ? DEM_HERTZ : DEM_LINEAR, 0.5);
        law.friction = 0.4;
        law.rolling_friction = 0.1;
        AUTO(dem_destroy)
        dem d = make_collision(kind / 2 ? ARCS : DISC, kind % 2 ? DEM_HERTZ : DEM_LINEAR, law, 1e-5, 3, 2);
        d.bodies[0].spin = 4;
        d.bodies[1].spin = 1;
        const double x = momentum_x(&d), y = momentum_y(&d), turn = angular_momentum(&d), energy = total_energy(&d);
        collide(&d);
        print_message("momentum off by %.3g, %.3g, %.3g; energy by %.3g of %.3g\n", momentum_x(&d) - x,
                      momentum_y(&d) - y, angular_momentum(&d) - turn, total_energy(&d) - energy, energy);
        assert_true(fabs(momentum_x(&d) - x) < 1e-12 && fabs(momentum_y(&d) - y) < 1e-12);
        assert_true(fabs(angular_momentum(&d) - turn) < 1e-11);
        const dem_energies e = energies(&d);
        assert_true(e.damping > 0 && e.friction > 0);
        assert_true(fabs(total_energy(&d) - energy) < 2e-3 * energy);
    }
}

/* Without friction nothing is lost to it, and no tangential spring holds an energy, whatever the dashpot. */
TEST(test_no_friction_loses_nothing) {
    dem_contact_law law = plain_law();
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.5);
    AUTO(dem_destroy) dem d = make_collision(ARCS, DEM_LINEAR, law, 1e-5, 3, 2);
    d.bodies[0].spin = 4;
    for (int i = 0; i < 60000; i++) {
        step(&d, 1);
        assert_true(d.account.friction == 0 && d.account.tangential == 0);
    }
    assert_true(d.account.damping > 0.1);
}

/* Both laws give the restitution that is asked for, whatever touches: tips of ellipses, a side on a side, a corner on a
 * side, fitted grains along the line of their centres. */
TEST(test_restitution_of_shapes) {
    static const struct {
        const char *name;
        uint32_t shape;
        double angle_a, angle_b;
    } cases[] = {
        {"tips of ellipses", ELLIPSE, 0, 0},
        {"sides of ellipses", ELLIPSE, PI / 2, PI / 2},
        {"sides of octagons", SHARP, PI / 8, PI / 8},
        {"corner and side of octagons", SHARP, 0, PI / 8},
        {"sides of rounded octagons", OCTAGON, PI / 8, PI / 8},
        {"sides of squares", SQUARE, 0, 0},
    };
    for (int k = 0; k < 12; k++) {
        dem_contact_law law = plain_law();
        dem_settings settings = plain_settings();
        settings.law = k % 2 ? DEM_HERTZ : DEM_LINEAR;
        settings.time_step = 5e-6;
        law.damping_ratio = dem_damping_ratio(settings.law, 0.6);
        AUTO(dem_destroy) dem d = make_world(settings, law);
        const uint32_t shape = cases[k / 2].shape;
        const double reach = 2 * d.shapes[shape].reach + 1e-3;
        const double angle_a = cases[k / 2].angle_a, angle_b = cases[k / 2].angle_b;
        dem_add_grain(&d, (dem_grain){.shape = shape, .angle = angle_a, .scale = 1, .velocity.x = 1});
        dem_add_grain(&d,
                      (dem_grain){.shape = shape, .angle = angle_b, .position.x = reach, .scale = 1, .velocity.x = -1});
        dem_start(&d);
        collide(&d);
        const double found = 0.5 * (d.bodies[1].velocity.x - d.bodies[0].velocity.x);
        print_message("%s, %s: %.6f\n", cases[k / 2].name, k % 2 ? "Hertz" : "linear", found);
        assert_true(fabs(found - 0.6) < 2e-3);
        assert_true(fabs(d.bodies[0].spin) < 1e-6 && fabs(d.bodies[0].velocity.y) < 1e-6);
    }
}

/* The radius is that of the disc of equal area, whatever touches: a square's side against a corner, and against a side,
 * which touch at two ends: h = sqrt(2) depth, and each bears 1 / sqrt(2) of that force. */
TEST(test_hertz_has_one_radius) {
    for (int corner = 0; corner < 2; corner++) {
        dem_contact_law law = plain_law();
        law.damping_ratio = 0;
        dem_settings settings = plain_settings();
        settings.law = DEM_HERTZ;
        settings.time_step = 1e-6;
        AUTO(dem_destroy) dem d = make_world(settings, law);
        const double depth = 1e-3, reach = corner ? sqrt(0.5) : 0.5, h = corner ? depth : sqrt(2) * depth;
        const dem_grain left = {.shape = SQUARE, .scale = 1};
        const dem_grain right = {
            .shape = SQUARE, .position.x = 0.5 + reach - depth, .angle = corner ? PI / 4 : 0, .scale = 1};
        dem_add_grain(&d, left);
        dem_add_grain(&d, right);
        dem_start(&d);
        const double radius = 0.5 * sqrt(1 / PI), expected = d.laws[0][0].kn * sqrt(radius * h) * h;
        assert_int_equal(d.contact_count, 1);
        const double force = d.contacts[0].on.force.x * (corner ? 1 : sqrt(0.5));
        print_message("Hertz force %.12g, expected %.12g\n", force, expected);
        assert_true(fabs(force / expected - 1) < 1e-11); /* depths are within a rounding of 1 of 1e-3 */
    }
}

/* ------------------------------------------------------------------------------------------------ order */

/* Within the contact of two discs, h = v / w sin(w t). */
static double find_error(double step_angle) {
    const double rate = sqrt(1e5 / (0.5 * PI)), speed = 8;
    AUTO(dem_destroy) dem d = make_collision(DISC, DEM_LINEAR, plain_law(), step_angle / rate, speed, 0);
    d.bodies[1].position.x = 2;
    step(&d, (size_t)lround(2 / step_angle));
    const double depth = 2 - (d.bodies[1].position.x - d.bodies[0].position.x);
    return fabs(depth / (speed / rate * sin(2)) - 1);
}

TEST(test_order_of_time_step) {
    const double coarse = find_error(0.25), middle = find_error(0.125), fine = find_error(0.0625);
    print_message("errors %.3g, %.3g, %.3g: ratios %.3f, %.3f\n", coarse, middle, fine, coarse / middle, middle / fine);
    assert_true(fabs(coarse / middle - 4) < 0.3);
    assert_true(fabs(middle / fine - 4) < 0.3);
}
