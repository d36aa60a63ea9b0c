/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * test_dem.cpp - two programs, one physics: the pair style in LAMMPS, and apps/dem, on the same grains.
 */
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <sstream>

#include "check.h"
#include "shape_file.h"

extern "C" {
#include <dem.h>
}

namespace {

constexpr int columns = 12, rows = 12;
constexpr double spacing = 1.06; /* nothing touches at the start */

struct Law {
    double kn, kt, gamma_n, gamma_t, friction;
    double step;
};

std::vector<narc_lammps::Form> read_forms() {
    std::ifstream file(GRAINS_FILE);
    std::stringstream text;
    text << file.rdbuf();
    return narc_lammps::parse_forms(GRAINS_FILE, text.str());
}

const narc_lammps::Form &find_form(const std::vector<narc_lammps::Form> &forms, const std::string &name) {
    for (const narc_lammps::Form &form : forms)
        if (form.name == name)
            return form;
    std::fprintf(stderr, "there is no shape %s\n", name.c_str());
    std::exit(2);
}

/* 8-arcs of scale 1/2, which is the same in single precision, in a periodic box; types take turns. */
Packing make_packing(const narc_lammps::Form forms[2]) {
    Packing packing = make_lattice(columns, rows, 1, 0, 1, 41);
    packing.types = 2;
    for (size_t i = 0; i < packing.grains.size(); i++) {
        Grain &grain = packing.grains[i];
        grain.type = 1 + static_cast<int>(i % 2);
        grain.radius = 0.5 * forms[grain.type - 1].reach;
        grain.x *= spacing;
        grain.y *= spacing;
    }
    packing.width *= spacing;
    packing.height *= spacing;
    return packing;
}

void fill_dem(dem *d, const Packing &packing, const narc_lammps::Form forms[2], const Law &law) {
    dem_settings settings = dem_defaults;
    settings.time_step = law.step;
    settings.gravity = {0, 0};
    settings.skin = 0.2;
    settings.max_overlap = 1;
    settings.periodic_x = settings.periodic_y = true;
    settings.high = {packing.width, packing.height};
    settings.threads = 1;
    dem_material material = {};
    std::snprintf(material.name, sizeof material.name, "stone");
    material.density = 1;
    const uint32_t stone = 0;
    uint32_t shapes[2] = {0, 0};
    dem_create(d, settings);
    d->materials[d->material_count++] = material;
    dem_contact_law contact = {};
    contact.kn = law.kn;
    contact.kt = law.kt;
    contact.gamma_n = law.gamma_n;
    contact.gamma_t = law.gamma_t;
    contact.damping_ratio = -1;
    contact.friction = law.friction;
    d->laws[stone][stone] = contact;
    for (int k = 0; k < 2; k++)
        shapes[k] =
            dem_add_shape(d, forms[k].name.c_str(), forms[k].parts[0].arcs.data(), forms[k].parts[0].arcs.size());
    for (const Grain &g : packing.grains) {
        dem_grain grain = {};
        grain.shape = shapes[g.type - 1];
        grain.material = stone;
        grain.place = {g.x, g.y};
        grain.angle = g.angle;
        grain.scale = 0.5;
        grain.velocity = {g.velocity_x, g.velocity_y};
        grain.spin = g.spin;
        dem_add_grain(d, grain);
    }
    dem_start(d);
}

std::vector<State> states_of(const dem &d) {
    std::vector<State> states;
    for (const dem_body *b = d.bodies; b < d.bodies + d.grain_count; b++)
        states.push_back({b->place.x, b->place.y, b->turn.x, b->turn.y, b->velocity.x, b->velocity.y, b->spin,
                          b->force.x, b->force.y, b->torque, b->mass});
    return states;
}

Difference run_both(const Law &law) {
    const std::vector<narc_lammps::Form> all = read_forms();
    const narc_lammps::Form forms[2] = {find_form(all, "ellipse8"), find_form(all, "pebble8")};
    const Packing packing = make_packing(forms);
    const int steps = static_cast<int>(std::lround(0.2 / law.step));
    Simulation lammps(MPI_COMM_WORLD);
    lammps.create(packing);
    char style[200];
    std::snprintf(style, sizeof style, "pair_style narc/hooke/history %.17g %.17g %.17g %.17g %.17g 1\n", law.kn,
                  law.kt, law.gamma_n, law.gamma_t, law.friction);
    lammps.run(std::string("neighbor 0.2 bin\nneigh_modify delay 0 every 1 check yes\nfix shapes all narc/shapes ") +
               GRAINS_FILE + " ellipse8 pebble8 density 1\n" + style +
               "pair_coeff * *\nfix nve all narc/nve\ntimestep " + std::to_string(1e6 * law.step) + "e-6\nrun " +
               std::to_string(steps));
    dem d;
    fill_dem(&d, packing, forms, law);
    for (int k = 0; k < steps; k++)
        dem_step(&d);
    const Difference at = compare(states_of(d), lammps.states(), packing.width, packing.height);
    dem_destroy(&d);
    return at;
}

} // namespace

/* Both find a pair's contact by the same call, lower number first, and integrate alike. Without tangential forces what
 * differs is the last bits of rotations, and so now and then a rounding to single precision: 1e-7 of a grain.
 *
 * With them, forces act half an overlap d deeper in LAMMPS (README.md), which changes a spin by up to friction *
 * impulse * d / inertia in a collision: 0.5 * 2 m v d / (0.4 m / 4) = 20 d for the speed 2 of two grains; d is at most
 * 2 sqrt(m / kn) with the reduced mass m = 1/4. In the time of 0.2 a grain collides twice at most. */
int main(int count, char **arguments) {
    MPI_Init(&count, &arguments);
    Difference at = run_both({1e4, 0, 50, 0, 0, 2e-4});
    check_at_most("positions, normal forces", at.position, 1e-5);
    check_at_most("angles, normal forces", at.angle, 1e-5);
    const double kn = 1e6, spin = 2 * 20 * 2 * std::sqrt(0.25 / kn);
    at = run_both({kn, 0.2 * kn, 50, 25, 0.5, 2e-4});
    check_at_most("spins, friction", at.spin, spin);
    check_at_most("angles, friction", at.angle, 0.2 * spin);
    check_at_most("positions, friction", at.position, 0.2 * spin);
    MPI_Finalize();
    return failures ? 1 : 0;
}
