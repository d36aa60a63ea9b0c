/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compare.cpp - whole steps side by side: LAMMPS' own discs, grains of narc's forms, LAMMPS' own polygons.
 *   compare [--grains N] [--steps N] [--rounds N]
 *
 * Discs of uneven sizes in a periodic box run until nothing is left of the lattice that they began on: dilute, where
 * few touch, and jammed. From their places all styles go on, with grains of the same areas. Times are the
 * processor's, as LAMMPS' own timer has them. Styles take turns; of the rounds the median counts.
 */
#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

#include "force.h"
#include "measure.h"
#include "pair.h"

namespace {

const double pi = std::acos(-1.0);
const char *const polygon_style = "body/rounded/polygon";
const std::string law = " 1e4 NULL 20 NULL 0.5 1\npair_coeff * *\n";
const std::string discs =
    "set group all density/disc 1\npair_style gran/hooke/history" + law + "fix nve all nve/sphere disc\n";
const std::string motion = "neighbor 0.2 bin\nneigh_modify delay 0 every 1 check yes\ntimestep 5e-4\nthermo 1000000\n"
                           "atom_modify sort 1000 0\ntimer full\n";

struct Style {
    const char *name, *grains;
    std::unique_ptr<Simulation> simulation = {};
    std::vector<double> times[section_count] = {};
    double contacts = 0; /* of a grain, where the style tells */
};

void create_discs(Simulation &simulation, const Packing &packing) {
    simulation.create(packing, "p p p", false, "sphere");
    simulation.run(motion + discs);
}

/* Discs that fill a share of the area, of diameters around 1. */
Packing make_packing(int side, double share) {
    const double spread = 0.2, fill = std::sqrt(share * 4 / pi / (1 + spread * spread / 3));
    Packing packing = make_lattice(side, side, fill, spread, 0.5, 1);
    Simulation mixing(MPI_COMM_WORLD);
    create_discs(mixing, packing);
    mixing.run("run 8000");
    const std::vector<State> states = mixing.states();
    for (size_t i = 0; i < states.size(); i++) {
        Grain &grain = packing.grains[i];
        grain.x = states[i].x;
        grain.y = states[i].y;
        grain.velocity_x = states[i].velocity_x;
        grain.velocity_y = states[i].velocity_y;
        grain.spin = states[i].spin;
    }
    return packing;
}

/* Octagons in the discs: corners are 0.98 of a radius from the centre, and all within 0.02 of them. The last number of a
 * body is the diameter of the rounding. */
void create_polygons(Simulation &simulation, const Packing &packing) {
    const double corner = 0.98, round = 0.02, eighth = pi / 4;
    FILE *file = std::fopen("polygons.data", "w");
    std::fprintf(file,
                 "polygons\n\n%zu atoms\n%zu bodies\n1 atom types\n0 %.17g xlo xhi\n0 %.17g ylo yhi\n"
                 "-0.5 0.5 zlo zhi\n\nAtoms\n\n",
                 packing.grains.size(), packing.grains.size(), packing.width, packing.height);
    int id = 0;
    for (const Grain &grain : packing.grains)
        std::fprintf(file, "%d 1 1 %.17g %.17g %.17g 0\n", ++id, pi * grain.radius * grain.radius, grain.x, grain.y);
    std::fprintf(file, "\nBodies\n\n");
    id = 0;
    for (const Grain &grain : packing.grains) {
        const double scale = grain.radius, inertia = pi / 4 * std::pow(grain.radius, 4);
        std::fprintf(file, "%d 1 %d\n8\n%.12f %.12f %.12f 0 0 0\n", ++id, 6 + 3 * 8 + 1, inertia, inertia, 2 * inertia);
        for (int k = 0; k < 8; k++)
            std::fprintf(file, "%.12f %.12f 0\n", scale * corner * std::cos(grain.angle + eighth * k),
                         scale * corner * std::sin(grain.angle + eighth * k));
        std::fprintf(file, "%.12f\n", 2 * scale * round);
    }
    std::fclose(file);
    simulation.run("units lj\ndimension 2\natom_style body rounded/polygon 1 8\ncomm_modify vel yes\nboundary p p p\n"
                   "newton on\nread_data polygons.data");
    simulation.run(motion +
                   "pair_style body/rounded/polygon 20 10 0.5 0.1 0.1\npair_coeff * * 10000 0\nfix nve all nve/body");
    std::remove("polygons.data");
}

void begin(Style &style, const Packing &packing) {
    style.simulation = std::make_unique<Simulation>(MPI_COMM_WORLD);
    Simulation &to = *style.simulation;
    if (style.name == polygon_style) {
        create_polygons(to, packing);
    } else if (!std::strcmp(style.name, "gran/hooke/history")) {
        create_discs(to, packing);
    } else {
        to.create(packing);
        to.run(motion + "fix shapes all narc/shapes " + GRAINS_FILE + " " + style.grains + " density 1\npair_style " +
               style.name + law + "fix nve all narc/nve\nrun 0");
        /* To the area of the disc. */
        const double area = to.states()[0].mass / (packing.grains[0].radius * packing.grains[0].radius);
        to.run("variable size atom 2*sqrt(PI*mass)/" + std::to_string(area) + "\nset group all diameter v_size");
    }
    to.run("run 200");
}

void take_turn(Style &style, int steps, size_t grains) {
    style.simulation->run("run " + std::to_string(steps) + " post no");
    add_times(*style.simulation, 1e9 / (static_cast<double>(grains) * steps), style.times);
    int dimension;
    const void *contacts = style.simulation->lammps->force->pair->extract("contact_count", dimension);
    if (contacts && !std::strncmp(style.name, "narc", 4))
        style.contacts =
            2.0 * static_cast<double>(*static_cast<const size_t *>(contacts)) / static_cast<double>(grains);
}

/* (LAMMPS' style for polygons has room for a few contacts of two, and ends the program where it is crowded.) */
void compare(const char *what, double share, bool polygons, const Sizes &sizes) {
    const Packing packing = make_packing(sizes.side, share);
    Style styles[6] = {{"gran/hooke/history", "discs"},         {"narc/hooke/history", "disc"},
                       {"narc/hooke/history", "ellipse8"},      {"narc/hooke/history", "pebble8"},
                       {"narc/hooke/history", "octagon_sharp"}, {polygon_style, "rounded 8-gons"}};
    Style *const end = styles + (polygons ? 6 : 5);
    for (Style *style = styles; style < end; style++)
        begin(*style, packing);
    for (int round = 0; round < sizes.rounds; round++)
        for (Style *style = styles; style < end; style++)
            take_turn(*style, style < styles + 5 ? sizes.steps : (sizes.steps + 9) / 10, packing.grains.size());
    std::printf("\n%s: %zu grains on %g of the area, %d rounds of %d steps, ns a grain and step\n\n", what,
                packing.grains.size(), share, sizes.rounds, sizes.steps);
    std::printf(
        "| pair style | grains | contacts of a grain | pair | neighbour | modify | communication | rest | whole "
        "step | of discs |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const Style *style = styles; style < end; style++) {
        std::printf("| `%s` | %s | ", style->name, style->grains);
        if (style->contacts > 0)
            std::printf("%.2f ", style->contacts);
        print_times(style->times);
        std::printf("| %.2f |\n", median(style->times[whole]) / median(styles[0].times[whole]));
    }
    std::fflush(stdout);
}

} // namespace

int main(int count, char **arguments) {
    const Sizes sizes = read_sizes("compare", count, arguments);
    MPI_Init(&count, &arguments);
    compare("dilute", 0.5, true, sizes);
    compare("jammed", 0.9, false, sizes);
    MPI_Finalize();
    return 0;
}
