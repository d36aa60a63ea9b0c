/* SPDX-License-Identifier: MIT
 *
 * gas.c - energy of many grains: a lossless gas keeps it, and of a pile all that is dissipated is accounted for.
 */
#include <math.h>

#include "worlds.h"

/* 200 grains of a shape in a box of periodic borders, with elastic contacts. */
static dem make_gas(uint32_t shape, dem_law kind, double friction, double time_step) {
    dem_settings settings = plain_settings();
    settings.periodic_x = settings.periodic_y = true;
    settings.high.x = settings.high.y = 40;
    settings.time_step = time_step;
    settings.law = kind;
    dem_contact_law law = plain_law();
    law.damping_ratio = 0;
    law.friction = friction;
    dem d = make_world(settings, law);
    const dem_filling filling = {.count = 200,
                                 .region = {true, {0, 0}, {40, 40}},
                                 .shapes = {shape},
                                 .shape_count = 1,
                                 .sizes = {DEM_UNIFORM, 0, 0, 1.4, 2.2},
                                 .speed = 2,
                                 .spin = 1,
                                 .tries = 20000};
    uint64_t random = 11;
    dem_fill_randomly(&d, &filling, &random);
    dem_start(&d);
    return d;
}

/* The largest, relative to the energy. */
static double find_drift(uint32_t shape, dem_law kind, size_t steps, double time_step, size_t *out_most) {
    AUTO(dem_destroy) dem d = make_gas(shape, kind, 0, time_step);
    const double before = total_energy(&d);
    double worst = 0;
    *out_most = 0;
    for (size_t i = 0; i < steps; i += 50) {
        step(&d, 50);
        worst = fmax(worst, fabs(total_energy(&d) - before));
        *out_most = d.contact_count > *out_most ? d.contact_count : *out_most;
    }
    const dem_energies e = energies(&d);
    assert_true(e.damping == 0 && e.friction == 0);
    return worst / before;
}

/* A contact lasts some 0.01, 100 steps: while it lasts, Verlet's energy swings by (w dt)^2 / 8, 1e-4 of its own. What a
 * contact leaves that begins or ends within a step is a part of that, of either sign. Half the step leaves a fourth. At
 * sharp corners the depth's gradient jumps: there the step counts by its first power. */
TEST(test_gas_keeps_its_energy) {
    static const struct {
        const char *name;
        uint32_t shape;
        double coarse, fine;
    } cases[] = {{"ellipses", ELLIPSE, 1e-4, 2.5e-5},
                 {"octagons", SHARP, 1e-3, 2.5e-4},
                 {"fitted grains", SAND, 1e-4, 2.5e-5},
                 {"Ls of two bars", ELL, 1e-4, 2.5e-5}};
    for (int k = 0; k < 8; k++) {
        const dem_law kind = k % 2 ? DEM_HERTZ : DEM_LINEAR;
        size_t contacts;
        const double coarse = find_drift(cases[k / 2].shape, kind, 10000, 1e-4, &contacts);
        const double fine = find_drift(cases[k / 2].shape, kind, 10000, 5e-5, &contacts);
        print_message("%s, %s: largest drift %.3g and %.3g, up to %zu contacts at a time\n", cases[k / 2].name,
                      k % 2 ? "Hertz" : "linear", coarse, fine, contacts);
        assert_true(contacts > 4);
        assert_true(coarse < cases[k / 2].coarse && fine < cases[k / 2].fine);
    }
}

/* A gas of Hertz's discs without dashpots: what friction takes rises, damping takes nothing, all is accounted for. */
TEST(test_hertz_with_friction_gives_no_energy) {
    for (double friction = 0.5; friction < 100; friction *= 100) {
        AUTO(dem_destroy) dem d = make_gas(DISC, DEM_HERTZ, friction, 1e-4);
        const double energy = total_energy(&d);
        double before = 0;
        for (int k = 0; k < 200; k++) {
            step(&d, 100);
            before = energies(&d).friction;
            assert_true(energies(&d).damping == 0);
        }
        print_message("friction %g: lost %.3f, off by %.2g\n", friction, before / energy,
                      total_energy(&d) / energy - 1);
        assert_true(before > 0 && fabs(total_energy(&d) / energy - 1) < 2e-3);
    }
}

/* The sum of all accounts stays what it was, to the first order of dashpots. */
TEST(test_all_energy_is_accounted_for) {
    double imbalance[2];
    for (int i = 0; i < 2; i++) {
        AUTO(dem_destroy) dem d = make_busy_world(1);
        d.settings.time_step = i ? 2.5e-5 : 1e-4;
        dem_start(&d);
        const double before = total_energy(&d);
        while (d.time < 1)
            step(&d, 100);
        const dem_energies e = energies(&d);
        imbalance[i] = total_energy(&d) - before;
        print_message("damping %.6g, friction %.6g, walls %.6g, kinetic %.6g: off by %.4g\n", e.damping, e.friction,
                      e.walls, e.kinetic, imbalance[i]);
        assert_true(e.damping > 0 && e.friction > 0);
        assert_true(fabs(imbalance[i]) < (i ? 2.5e-3 : 1e-2) * (e.damping + e.friction));
    }
}
