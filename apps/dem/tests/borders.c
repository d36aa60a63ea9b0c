/* SPDX-License-Identifier: MIT
 *
 * borders.c - a periodic border is nowhere: what happens across it happens as in the middle of the cell.
 */
#include <math.h>

#include "worlds.h"

/* Two grains that collide off their centres, while both move on together, with friction and damping; in a cell of 16 by
 * 16 or in the plane. Times and places are chosen so that the contact, soft and long, is carried across the border. */
static dem collide_at(double x, double y, bool periodic, double drift_x, double drift_y) {
    dem d = plain_world();
    d.settings.periodic_x = d.settings.periodic_y = periodic;
    d.settings.high.x = d.settings.high.y = 16;
    d.settings.max_overlap = 0.5;
    d.settings.time_step = 5e-5;
    d.settings.skin = 0.1; /* lists are renewed within the contact */
    d.laws[0][0].friction = 0.3;
    d.laws[0][0].damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.7);
    d.laws[0][0].rolling_friction = 0.1;
    add_grain(&d, ARCS, x - 1.25, y - 0.3, 3 + drift_x, 1 + drift_y);
    add_grain(&d, OCTAGON, x + 0.95, y + 0.2, -2 + drift_x, drift_y);
    dem_start(&d);
    return d;
}

/* Places are sums of other numbers there, so roundings differ: 1e-16 of 16 in each step, and the float of a difference
 * of places may be the next one, 1e-7 of it, which changes a force by 1e-5 at this depth. */
static void check_same(const dem *d, const dem *reference) {
    for (size_t k = 0; k < 2; k++) {
        assert_true(fabs(d->bodies[k].velocity.x - reference->bodies[k].velocity.x) < 1e-4);
        assert_true(fabs(d->bodies[k].velocity.y - reference->bodies[k].velocity.y) < 1e-4);
        assert_true(fabs(d->bodies[k].spin - reference->bodies[k].spin) < 1e-4);
    }
    const dem_energies e = energies(d), f = energies(reference);
    assert_true(fabs(e.damping - f.damping) < 1e-3 && fabs(e.friction - f.friction) < 1e-3);
}

TEST(test_collision_across_borders) {
    static const double places[][4] = {{8, 8, 0, 0},       {0, 8, 0, 0},      {16, 8, 0, 0},
                                       {8, 0, 0, 0},       {16, 16, 0, 0},    {8, 15.65, 0, 40},
                                       {15.65, 8, 100, 0}, {2.8, 8, -100, 0}, {15.76, 1.72, 90, -90}};
    for (size_t i = 0; i < sizeof places / sizeof places[0]; i++) {
        const double *p = places[i];
        AUTO(dem_destroy) dem d = collide_at(p[0], p[1], true, p[2], p[3]);
        AUTO(dem_destroy) dem reference = collide_at(p[0], p[1], false, p[2], p[3]);
        size_t crossings = 0, contacts = 0;
        for (int s = 0; s < 1000; s++) {
            const int32_t before = d.bodies[0].cell_x + d.bodies[0].cell_y;
            const bool touched = d.contact_count > 0;
            step(&d, 1);
            step(&reference, 1);
            contacts += d.contact_count;
            crossings += touched && d.contact_count > 0 && d.bodies[0].cell_x + d.bodies[0].cell_y != before;
            assert_int_equal(d.contact_count, reference.contact_count);
        }
        print_message("at %g, %g: %zu steps in contact, border crossed %zu times in contact\n", p[0], p[1], contacts,
                      crossings);
        assert_true(contacts > 100);
        assert_true(crossings > 0 || (p[2] == 0 && p[3] == 0));
        check_same(&d, &reference);
    }
}

/* A wall across the border: a box, found from both sides. */
TEST(test_wall_across_border) {
    for (int side = 0; side < 2; side++) {
        AUTO(dem_destroy) dem d = plain_world();
        d.settings.periodic_x = true;
        d.settings.high.x = 16;
        d.settings.gravity = (vec){0, -10};
        d.laws[0][0].damping_ratio = 1;
        add_box(&d, OCTAGON, 2, side ? 0.5 : 15.5, 0);
        add_grain(&d, DISC, side ? 15.9 : 0.1, 2 * cos(3.14159265358979324 / 8) + 1, 0, 0);
        dem_start(&d);
        step(&d, 2000);
        assert_int_equal(d.contact_count, 1);
    }
}

/* Pairs come in the order of both parts, and once, wherever the image of B is. */
TEST(test_pairs_in_order) {
    AUTO(dem_destroy) dem d = make_busy_world(1);
    size_t images = 0;
    dem_start(&d);
    for (int i = 0; i < 100; i++) {
        step(&d, 50);
        for (size_t k = 0; k < d.pair_count; k++) {
            const dem_pair *p = &d.pairs[k], *last = &d.pairs[k > 0 ? k - 1 : 0];
            images += dem_image_b(&d, k)->right != 0;
            assert_true(p->a < p->b && p->b == dem_image_b(&d, k)->part);
            assert_true(k == 0 || last->a < p->a || (last->a == p->a && last->b < p->b));
        }
    }
    print_message("%zu pairs across the border\n", images);
    assert_true(images > 10);
}

static const double SIDE = 16, SHEAR_RATE = 2;

/* Two grains that collide at the upper border at a time when the cell above is somewhere: A comes from below, B is seen
 * by its image, whose velocity is `drift` more. In the plane B is where its image is. `offset` is set at the start. */
static void put_pair(dem *d, bool sheared, double offset, double x) {
    const double drift = SHEAR_RATE * SIDE;
    dem_contact_law law = plain_law();
    law.friction = 0.3;
    law.rolling_friction = 0.1;
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.7);
    dem_settings settings = sheared ? sheared_settings(SIDE, SHEAR_RATE) : plain_settings();
    settings.time_step = 5e-5;
    settings.skin = 0.1;
    settings.max_overlap = 0.5;
    *d = make_world(settings, law);
    add_grain(d, ARCS, x, 14.6, 0, 0);
    add_grain(d, ELL, sheared ? fmod(x + 0.2 - offset + 10 * SIDE, SIDE) : x + 0.2, sheared ? 0.95 : 16.95, 0, 0);
    d->offset = offset;
    dem_start(d);
    assert_int_equal(d->contact_count, 0);
    d->bodies[0].velocity.x = drift / 2; /* so that they meet */
    d->bodies[0].velocity.y = 2;
    d->bodies[1].velocity.x = sheared ? -drift / 2 : drift / 2;
    d->bodies[1].velocity.y = -3;
}

TEST(test_collision_across_the_sheared_border) {
    static const double offsets[] = {0, 3, -7.9, 7.99}, places[] = {8, 0.2, 15.9};
    for (size_t i = 0; i < 12; i++) {
        AUTO(dem_destroy) dem d, reference;
        put_pair(&d, true, offsets[i % 4], places[i / 4]);
        put_pair(&reference, false, offsets[i % 4], places[i / 4]);
        size_t contacts = 0;
        for (int s = 0; s < 3000; s++) {
            step(&d, 1);
            step(&reference, 1);
            contacts += d.contact_count;
            assert_int_equal(d.contact_count, reference.contact_count);
        }
        assert_true(contacts > 100);
        assert_true(d.bodies[0].cell_y - d.bodies[1].cell_y != 0 || d.bodies[0].position.y > 14);
        for (size_t k = 0; k < 2; k++) {
            /* A starts in this cell, B one below its image. */
            const double above = d.bodies[k].cell_y + (k == 1);
            assert_true(fabs(d.bodies[k].velocity.x + above * SHEAR_RATE * SIDE - reference.bodies[k].velocity.x) <
                        1e-9);
            assert_true(fabs(d.bodies[k].velocity.y - reference.bodies[k].velocity.y) < 1e-9);
            assert_true(fabs(d.bodies[k].spin - reference.bodies[k].spin) < 1e-9);
        }
        assert_true(fabs(energies(&d).damping - energies(&reference).damping) < 1e-8);
        assert_true(fabs(energies(&d).friction - energies(&reference).friction) < 1e-8);
    }
}
