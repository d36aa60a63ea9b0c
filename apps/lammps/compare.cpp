/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compare.cpp - whole steps side by side: LAMMPS' own discs, grains of narc's forms.
 *   compare [--grains N] [--steps N] [--rounds N]
 *
 * Discs of uneven sizes in a periodic box run until nothing is left of the lattice that they began on: dilute, where
 * few touch, and jammed. From their places all styles go on, with grains of the same areas. Times are the
 * processor's, as LAMMPS' own timer has them. Styles take turns; of the rounds the median counts.
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>
#include <vector>

#include "force.h"
#include "lammps.h"
#include "pair.h"
#include "simulation.h"
#include "timer.h"

namespace {

/* What the time of a step goes to. */
enum { pair, neighbour, modify, communication, rest, whole, section_count };

struct Sizes {
    int side, steps, rounds; /* grains: side times side */
};

/* Of the arguments: [--grains N] [--steps N] [--rounds N]. */
Sizes read_sizes(int count, char **arguments) {
    int grains = 10000, steps = 200, rounds = 7;
    bool good = count % 2 == 1;
    for (int i = 1; i + 1 < count; i += 2) {
        const char *names[] = {"--grains", "--steps", "--rounds"};
        int *const values[] = {&grains, &steps, &rounds};
        const auto found =
            std::find_if(names, names + 3, [&](const char *name) { return !std::strcmp(arguments[i], name); });
        good = good && found != names + 3;
        if (good)
            *values[found - names] = std::atoi(arguments[i + 1]);
    }
    const int side = static_cast<int>(std::lround(std::sqrt(std::max(grains, 0))));
    if (!good || side < 10 || steps < 1 || rounds < 1) {
        std::fprintf(stderr, "usage: compare [--grains N] [--steps N] [--rounds N]\n");
        std::exit(2);
    }
    return {side, steps, rounds};
}

/* The processor's time for the last run in some unit, which after `timer full` LAMMPS has, and which does not count what
 * else the machine does. */
void add_times(const Simulation &simulation, double unit, std::vector<double> *times) {
    using LAMMPS_NS::Timer;
    const auto spent = [&](Timer::ttype section) { return unit * simulation.lammps->timer->get_cpu(section); };
    double row[section_count] = {spent(Timer::PAIR), spent(Timer::NEIGH), spent(Timer::MODIFY), spent(Timer::COMM)};
    row[whole] = spent(Timer::TOTAL);
    row[rest] = row[whole] - row[pair] - row[neighbour] - row[modify] - row[communication];
    for (int k = 0; k < section_count; k++)
        times[k].push_back(row[k]);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

const double pi = std::acos(-1.0);
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

void begin(Style &style, const Packing &packing) {
    style.simulation = std::make_unique<Simulation>(MPI_COMM_WORLD);
    Simulation &to = *style.simulation;
    if (!std::strcmp(style.name, "gran/hooke/history")) {
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

void compare(const char *what, double share, const Sizes &sizes) {
    const Packing packing = make_packing(sizes.side, share);
    Style styles[] = {{"gran/hooke/history", "discs"},
                      {"narc/hooke/history", "disc"},
                      {"narc/hooke/history", "ellipse8"},
                      {"narc/hooke/history", "pebble8"},
                      {"narc/hooke/history", "octagon_sharp"}};
    for (Style &style : styles)
        begin(style, packing);
    for (int round = 0; round < sizes.rounds; round++)
        for (Style &style : styles)
            take_turn(style, sizes.steps, packing.grains.size());
    std::printf("\n%s: %zu grains on %g of the area, %d rounds of %d steps, ns a grain and step\n\n", what,
                packing.grains.size(), share, sizes.rounds, sizes.steps);
    std::printf(
        "| pair style | grains | contacts of a grain | pair | neighbour | modify | communication | rest | whole "
        "step | of discs |\n|---|---|--:|--:|--:|--:|--:|--:|--:|--:|\n");
    for (const Style &style : styles) {
        std::printf("| `%s` | %s | ", style.name, style.grains);
        if (style.contacts > 0)
            std::printf("%.2f ", style.contacts);
        for (const std::vector<double> &of_section : style.times)
            std::printf("| %.1f ", median(of_section));
        std::printf("| %.2f |\n", median(style.times[whole]) / median(styles[0].times[whole]));
    }
    std::fflush(stdout);
}

} // namespace

int main(int count, char **arguments) {
    const Sizes sizes = read_sizes(count, arguments);
    MPI_Init(&count, &arguments);
    compare("dilute", 0.5, sizes);
    compare("jammed", 0.9, sizes);
    MPI_Finalize();
    return 0;
}
