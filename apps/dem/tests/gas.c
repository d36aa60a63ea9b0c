/* SPDX-License-Identifier: MIT
 *
 * gas.c - energy of many grains: a lossless gas keeps it, and of a pile all that is dissipated is accounted for.
 */
#include <math.h>

#include "place.h"
#include "worlds.h"

/* 40 grains of eight arcs in a box of periodic borders, with elastic contacts and no friction. */
static dem make_gas(double time_step) {
    dem_settings settings = plain_settings();
    settings.periodic_x = settings.periodic_y = true;
    settings.high_x = settings.high_y = 20;
    settings.time_step = time_step;
    dem d = make_world(settings, plain_law());
    const dem_filling filling = {.count = 40,
                                 .region = {true, 0, 20, 0, 20},
                                 .shapes = {ARCS},
                                 .shape_count = 1,
                                 .sizes = {DEM_UNIFORM, 0, 0, 1.4, 2.2},
                                 .speed = 5,
                                 .spin = 3,
                                 .tries = 20000};
    uint64_t random = 11;
    assert_true(dem_fill_randomly(&d, &filling, &random));
    start(&d);
    return d;
}

static double find_drift(double time_step, double *out_first, size_t *out_most) {
    dem d = make_gas(time_step);
    const double before = total_energy(&d);
    double worst = 0;
    *out_first = before;
    *out_most = 0;
    while (d.time < 2) {
        step(&d, 10);
        worst = fmax(worst, fabs(total_energy(&d) - before));
        *out_most = d.contacts.count > *out_most ? d.contacts.count : *out_most;
    }
    const dem_energies e = energies(&d);
    assert_true(fabs(e.damping) < 1e-9 && fabs(e.friction) < 1e-9);
    dem_destroy(&d);
    return worst / before;
}

/* A contact lasts some 0.01, 100 steps: while it lasts, Verlet's energy swings by (w dt)^2 / 8, 1e-4 of its own. What
 * is left behind by a contact that begins or ends within a step is of that size, and of either sign. So some hundred
 * collisions stay within 1e-3 of the gas's energy, and a fourth of the step within a fourth of that. */
TEST(test_gas_keeps_its_energy) {
    double energy;
    size_t contacts;
    const double coarse = find_drift(1e-4, &energy, &contacts), fine = find_drift(2.5e-5, &energy, &contacts);
    print_message("largest drift %.3g and %.3g of %.6g, up to %zu contacts at a time\n", coarse, fine, energy,
                  contacts);
    assert_true(contacts > 4);
    assert_true(coarse < 1e-3);
    assert_true(fine < 2.5e-4);
}

/* The sum of all accounts stays what it was, to the first order of dashpots. */
TEST(test_all_energy_is_accounted_for) {
    double imbalance[2];
    for (int i = 0; i < 2; i++) {
        dem d = make_busy_world(1);
        d.settings.time_step = i ? 2.5e-5 : 1e-4;
        start(&d);
        const double before = total_energy(&d);
        while (d.time < 1)
            step(&d, 100);
        const dem_energies e = energies(&d);
        imbalance[i] = total_energy(&d) - before;
        print_message("damping %.6g, friction %.6g, walls %.6g, kinetic %.6g: off by %.4g\n", e.damping, e.friction,
                      e.walls, e.kinetic, imbalance[i]);
        assert_true(e.damping > 0 && e.friction > 0);
        assert_true(fabs(imbalance[i]) < (i ? 2.5e-3 : 1e-2) * (e.damping + e.friction));
        dem_destroy(&d);
    }
}
