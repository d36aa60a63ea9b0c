/* SPDX-License-Identifier: MIT
 *
 * shear.c - a sheared cell: what is conserved is, and grains flow as they are sheared. borders.c has what happens across
 * its border.
 */
#include <math.h>

#include "worlds.h"

static const double RATE = 2, SIDE = 16;

/* Dense: 84 % of the cell, frictional; discs, ellipses and Ls. */
static dem make_flow(unsigned threads) {
    dem_settings settings = sheared_settings(SIDE, RATE);
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
    AUTO(dem_destroy) dem d = make_flow(1);
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
}

/* On two threads, and from a restart, the same bits. */
TEST(test_sheared_bits) {
    static const char path[] = "sheared.restart";
    dem_progress progress = {.input = 5};
    AUTO(dem_destroy) dem one = make_flow(1), two = make_flow(2), again = make_flow(1);
    step(&one, 3000);
    dem_write_restart(&one, &progress, path);
    dem_read_restart(&again, &progress, path);
    step(&one, 3000);
    step(&again, 3000);
    step(&two, 6000);
    assert_true(one.renewals > 10 && one.shear_work != 0);
    assert_true(dem_hash(&one) == dem_hash(&two) && dem_hash(&one) == dem_hash(&again));
}
