/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * compare.cpp - the same packing side by side: narc's pair style, LAMMPS' own for polygons, and LAMMPS' own for discs.
 *   compare [GRAINS ...] [--rounds N] [--steps N]
 *
 * Grains of radius 1/2 on a triangular lattice, turned at random and a little out of place, none of which moves: every
 * style computes the forces of the same pairs in each step. With a constant of 0.98 nearly all discs touch, and few of
 * the 8-arcs, which are as long but thinner; with 0.84 most of these do as well. The pair time is that of LAMMPS' own
 * timer. Styles take turns, so that what else the machine does hits them all alike; of the rounds the median counts.
 */
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <memory>

#include <unistd.h>

#include "simulation.h"

#include "force.h"
#include "lammps.h"
#include "pair.h"
#include "timer.h"

namespace {

const char *const tracking = "neighbor 0.1 bin\nneigh_modify delay 0 every 1 check yes\n";
constexpr double disorder = 0.02;

struct Style {
    const char *name;
    const char *shape; /* of narc's styles */
    std::vector<double> nanoseconds = {};
    std::unique_ptr<Simulation> simulation = {};
    long long pairs = 0;
    size_t contacts = 0; /* where the style tells */
};

/* A triangular lattice: six neighbours, as in dense heaps. `rows` is even. */
Packing make_packing(int columns, int rows, double spacing) {
    const double row_height = spacing * std::sqrt(0.75);
    Packing packing = make_lattice(columns, rows, 1, 0, 1, 1);
    for (Grain &grain : packing.grains) {
        const bool odd = static_cast<int>(grain.y) % 2 == 1;
        grain.x = spacing * (grain.x + (odd ? 0.25 : -0.25) + disorder * grain.velocity_x);
        grain.y = row_height * grain.y + spacing * disorder * grain.velocity_y;
        grain.radius = 0.5;
        grain.velocity_x = grain.velocity_y = grain.spin = 0;
    }
    packing.width = spacing * columns;
    packing.height = row_height * rows;
    return packing;
}

/* Bodies of style rounded/polygon: octagons with corners 0.49 from the centre and all within 0.01 of them, which is the
 * shape octagon_sharp of radius 1/2. The last number of a body is the diameter of the rounding. */
void create_polygons(Simulation &simulation, const Packing &packing) {
    const std::string name = "polygons." + std::to_string(getpid()) + ".data";
    FILE *file = std::fopen(name.c_str(), "w");
    std::fprintf(file,
                 "polygons\n\n%zu atoms\n%zu bodies\n1 atom types\n0 %.17g xlo xhi\n0 %.17g ylo yhi\n"
                 "-0.5 0.5 zlo zhi\n\nAtoms\n\n",
                 packing.grains.size(), packing.grains.size(), packing.width, packing.height);
    int id = 0;
    for (const Grain &grain : packing.grains)
        std::fprintf(file, "%d 1 1 1 %.17g %.17g 0\n", ++id, grain.x, grain.y);
    std::fprintf(file, "\nBodies\n\n");
    id = 0;
    for (const Grain &grain : packing.grains) {
        std::fprintf(file, "%d 1 %d\n8\n1 1 4 0 0 0\n", ++id, 6 + 3 * 8 + 1);
        for (int corner = 0; corner < 8; corner++) {
            const double angle = grain.angle + std::acos(-1.0) / 4 * corner;
            std::fprintf(file, "%.12f %.12f 0\n", 0.49 * std::cos(angle), 0.49 * std::sin(angle));
        }
        std::fprintf(file, "0.02\n");
    }
    std::fclose(file);
    simulation.run("units lj\ndimension 2\natom_style body rounded/polygon 1 8\ncomm_modify vel yes\nboundary p p p\n"
                   "newton on\nread_data " +
                   name);
    std::remove(name.c_str());
}

void begin(Style &style, const Packing &packing) {
    style.simulation = std::make_unique<Simulation>(MPI_COMM_WORLD);
    Simulation &to = *style.simulation;
    if (!std::strcmp(style.name, "body/rounded/polygon")) {
        create_polygons(to, packing);
        to.run(std::string(tracking) + "pair_style body/rounded/polygon 1 0 0.5 0.1 0.1\npair_coeff * * 1000 0\n");
    } else {
        to.create(packing, "p p p", true);
        to.run(tracking);
        if (style.shape)
            to.run(std::string("fix shapes all narc/shapes ") + GRAINS_FILE + " " + style.shape + " density 1");
        to.run(std::string("pair_style ") + style.name + " 1000 NULL 10 NULL 0.5 1\npair_coeff * *");
    }
    to.run("timestep 1e-4\nthermo 1000000\nrun 10");
    style.pairs = to.list_pairs();
    int dimension;
    const void *contacts = to.lammps->force->pair->extract("contact_count", dimension);
    if (contacts && style.shape)
        style.contacts = *static_cast<const size_t *>(contacts);
}

double median(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    return values[values.size() / 2];
}

void compare(int columns, int rows, double spacing, int rounds, long long steps) {
    const Packing packing = make_packing(columns, rows, spacing);
    Style styles[] = {{"gran/hooke/history", nullptr},    {"narc/hooke/history", "disc"},
                      {"narc/hooke/history", "ellipse4"}, {"narc/hooke/history", "ellipse8"},
                      {"narc/hooke/history", "pebble8"},  {"narc/hooke/history", "octagon_sharp"},
                      {"body/rounded/polygon", nullptr}};
    for (Style &style : styles)
        begin(style, packing);
    for (int round = 0; round < rounds; round++) {
        for (Style &style : styles) {
            const bool slow = &style == std::end(styles) - 1;
            const long long count = slow ? std::max(steps / 10, 1LL) : steps;
            style.simulation->run("run " + std::to_string(count) + " post no");
            const double seconds = style.simulation->seconds_of(LAMMPS_NS::Timer::PAIR);
            style.nanoseconds.push_back(1e9 * seconds / static_cast<double>(count * style.pairs));
        }
    }
    const double discs = median(styles[0].nanoseconds), polygons = median(std::end(styles)[-1].nanoseconds);
    std::printf("\n%zu grains, lattice constant %g, %d rounds of %lld steps\n\n", packing.grains.size(), spacing,
                rounds, steps);
    std::printf("| pair style | grains | pairs | touching | ns a pair | of discs (target <= 2.5) | "
                "polygons over it (target >= 6) |\n|---|---|--:|--:|--:|--:|--:|\n");
    for (const Style &style : styles) {
        const double time = median(style.nanoseconds);
        const char *grains = style.shape ? style.shape : &style == styles ? "discs" : "rounded 8-gons";
        const std::string touching = style.shape ? std::to_string(style.contacts) : "";
        std::printf("| `%s` | %s | %lld | %s | %.1f | %.2f | %.1f |\n", style.name, grains, style.pairs,
                    touching.c_str(), time, time / discs, polygons / time);
    }
    std::fflush(stdout);
}

} // namespace

int main(int count, char **arguments) {
    MPI_Init(&count, &arguments);
    int rounds = 9;
    long long steps = 0;
    std::vector<int> sizes;
    for (int i = 1; i < count; i++)
        if (!std::strcmp(arguments[i], "--rounds") && i + 1 < count)
            rounds = std::atoi(arguments[++i]);
        else if (!std::strcmp(arguments[i], "--steps") && i + 1 < count)
            steps = std::atoll(arguments[++i]);
        else
            sizes.push_back(std::atoi(arguments[i]));
    if (sizes.empty())
        sizes = {2500, 20000};
    for (const int size : sizes) {
        int rows = static_cast<int>(std::sqrt(size)) / 2 * 2;
        while (rows > 4 && size % rows != 0)
            rows -= 2;
        const int columns = rows > 0 ? size / rows : 0;
        if (rows < 4 || rounds < 1) {
            std::fprintf(stderr, "usage: compare [GRAINS ...] [--rounds N] [--steps N]\n");
            MPI_Abort(MPI_COMM_WORLD, 2);
        }
        for (const double spacing : {0.98, 0.84})
            compare(columns, rows, spacing, rounds, steps > 0 ? steps : std::max(1000000LL / size, 10LL));
    }
    MPI_Finalize();
    return 0;
}
