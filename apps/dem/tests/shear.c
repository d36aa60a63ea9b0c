/* SPDX-License-Identifier: MIT
 *
 * shear.c - a sheared cell: across its border things happen as in the plane, what is conserved is, and grains flow as
 * they are sheared.
 */
#include <math.h>

#include "worlds.h"

static const double RATE = 2, SIDE = 16;

static dem_settings sheared_settings(void) {
    dem_settings settings = plain_settings();
    settings.periodic_x = settings.periodic_y = settings.sheared = true;
    settings.high.x = settings.high.y = SIDE;
    settings.rates.shear = RATE;
    return settings;
}

/* Two grains that collide at the upper border at a time when the cell above is somewhere: A comes from below, B is seen
 * by its image, whose velocity is `drift` more. In the plane B is where its image is. `offset` is set at the start. */
static void put_pair(dem *d, bool sheared, double offset, double x) {
    const double drift = RATE * SIDE;
    dem_contact_law law = plain_law();
    law.friction = 0.3;
    law.rolling_friction = 0.1;
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.7);
    dem_settings settings = sheared ? sheared_settings() : plain_settings();
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
        dem d, reference;
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
            assert_true(fabs(d.bodies[k].velocity.x + above * RATE * SIDE - reference.bodies[k].velocity.x) < 1e-9);
            assert_true(fabs(d.bodies[k].velocity.y - reference.bodies[k].velocity.y) < 1e-9);
            assert_true(fabs(d.bodies[k].spin - reference.bodies[k].spin) < 1e-9);
        }
        assert_true(fabs(energies(&d).damping - energies(&reference).damping) < 1e-8);
        assert_true(fabs(energies(&d).friction - energies(&reference).friction) < 1e-8);
        dem_destroy(&d);
        dem_destroy(&reference);
    }
}

/* Dense: 84 % of the cell, frictional; discs, ellipses and Ls. */
static dem make_flow(unsigned threads) {
    dem_settings settings = sheared_settings();
    dem_contact_law law = plain_law();
    settings.threads = threads;
    settings.max_overlap = 0.3;
    law.friction = 0.4;
    law.damping_ratio = dem_damping_ratio(DEM_LINEAR, 0.5);
    dem d = make_world(settings, law);
    const dem_filling filling = {.region = {true, {0, 0}, {SIDE, SIDE}},
                                 .shapes = {DISC, DISC, ELLIPSE, ELL},
                                 .shape_count = 4,
                                 .sizes = {DEM_UNIFORM, 0, 0, 0.85, 1.2},
                                 .spacing = {1, 1}};
    uint64_t random = 3;
    dem_fill_lattice(&d, &filling, &random);
    d.settings.max_overlap = 10; /* they begin one over the other */
    dem_start(&d);
    return d;
}

typedef struct momentum {
    double x, y, scale;
} momentum;

/* As if nobody had crossed the border. */
static momentum find_momentum(const dem *d) {
    momentum sum = {0, 0, 0};
    for (size_t k = 0; k < d->grain_count; k++) {
        sum.x += d->bodies[k].mass * (d->bodies[k].velocity.x + d->bodies[k].cell_y * RATE * SIDE);
        sum.y += d->bodies[k].mass * d->bodies[k].velocity.y;
        sum.scale += d->bodies[k].mass * RATE * SIDE;
    }
    return sum;
}

/* The velocity is a line over the height, whose slope is the rate; momentum stays; the work of shear is that of the
 * shear stress, and all energy is accounted for. */
TEST(test_flow) {
    enum { BANDS = 8 };
    dem d = make_flow(1);
    double speed[BANDS] = {0}, count[BANDS] = {0}, stress = 0, off = 0, mean = 0;
    step(&d, 20000);
    const double energy = total_energy(&d), work = d.shear_work, began = d.time;
    const dem_energies before = energies(&d);
    const momentum first = find_momentum(&d);
    for (int s = 0; s < 40000; s++) {
        dem_measures m;
        step(&d, 1);
        dem_measure(&d, NULL, &m);
        stress -= 0.5 * (m.stress.xy + m.stress.yx);
        for (size_t k = 0; s % 50 == 0 && k < d.grain_count; k++) {
            const double y = d.bodies[k].position.y - SIDE * floor(d.bodies[k].position.y / SIDE);
            const int band = (int)(BANDS * y / SIDE);
            speed[band] += d.bodies[k].velocity.x + (d.bodies[k].position.y - y) / SIDE * -RATE * SIDE;
            count[band]++;
        }
    }
    const momentum last = find_momentum(&d);
    assert_true(fabs(last.x - first.x) < 1e-12 * first.scale && fabs(last.y - first.y) < 1e-12 * first.scale);
    for (int i = 0; i < BANDS; i++) /* but for the velocity of all: who begins off the middle has its share of it */
        mean += (speed[i] / count[i] / (RATE * SIDE) - ((i + 0.5) / BANDS - 0.5)) / BANDS;
    for (int i = 0; i < BANDS; i++)
        off = fmax(off, fabs(speed[i] / count[i] / (RATE * SIDE) - ((i + 0.5) / BANDS - 0.5) - mean));
    const double by_stress = stress / 40000 * RATE * SIDE * SIDE * (d.time - began), done = d.shear_work - work;
    const dem_energies after = energies(&d);
    const double lost = after.damping + after.friction - before.damping - before.friction;
    print_message(
        "profile off by %.3g of the drift, mean %.3g; work %.6g, by stress %.6g; lost %.6g; energy off by %.3g\n", off,
        mean, done, by_stress, lost, total_energy(&d) - energy);
    assert_true(off <
                0.1); /* it fluctuates by 0.05 in such a time; if all moved as one block it would be off by 0.44 */
    assert_true(fabs(by_stress / done - 1) < 0.05);
    assert_true(done > 0 && fabs(lost / done - 1) < 0.1);
    assert_true(fabs(total_energy(&d) - energy) < 1e-2 * done);
    dem_destroy(&d);
}

/* On two threads, and from a restart, the same bits. */
TEST(test_sheared_bits) {
    static const char path[] = "sheared.restart";
    dem_progress progress = {.input = 5};
    dem one = make_flow(1), two = make_flow(2), again = make_flow(1);
    step(&one, 3000);
    dem_write_restart(&one, &progress, path);
    dem_read_restart(&again, &progress, path);
    step(&one, 3000);
    step(&again, 3000);
    step(&two, 6000);
    assert_true(one.renewals > 10 && one.shear_work != 0);
    assert_true(dem_hash(&one) == dem_hash(&two) && dem_hash(&one) == dem_hash(&again));
    dem_destroy(&one);
    dem_destroy(&two);
    dem_destroy(&again);
}
