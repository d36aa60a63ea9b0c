/* SPDX-License-Identifier: GPL-2.0-or-later
 *
 * simulation.cpp - an instance of LAMMPS for tests and measurements.
 */
#include "simulation.h"

#include <cmath>
#include <cstdio>
#include <random>
#include <sstream>

#include <unistd.h>

#include "atom.h"
#include "force.h"
#include "input.h"
#include "lammps.h"
#include "pair.h"
#include "register.h"
#include "variable.h"

using namespace LAMMPS_NS;

Simulation::Simulation(MPI_Comm ranks, bool with_styles) : world(ranks) {
    /* What LAMMPS says is in a file, each instance's in its own; an error is on its last lines. */
    static int number = 0;
    std::string screen = "screen." + std::to_string(++number) + ".txt";
    std::string words[] = {"narc_lammps", "-log", "none", "-screen", screen, "-nocite"};
    std::vector<char *> arguments;
    for (std::string &word : words)
        arguments.push_back(&word[0]);
    lammps = new LAMMPS(static_cast<int>(arguments.size()), arguments.data(), world);
    if (with_styles)
        narc_lammps::register_styles(lammps);
}

Simulation::~Simulation() { delete lammps; }

void Simulation::run(const std::string &commands) {
    std::istringstream lines(commands);
    for (std::string line; std::getline(lines, line);)
        if (!line.empty())
            lammps->input->one(line);
}

void Simulation::create(const Packing &packing, const std::string &boundary, bool newton,
                        const std::string &atom_style) {
    int rank;
    MPI_Comm_rank(world, &rank);
    int process = static_cast<int>(getpid());
    MPI_Bcast(&process, 1, MPI_INT, 0, world);
    const std::string name = "grains." + std::to_string(process) + ".data";
    if (rank == 0) {
        FILE *file = std::fopen(name.c_str(), "w");
        std::fprintf(file, "grains\n\n%zu atoms\n%d atom types\n0 %.17g xlo xhi\n0 %.17g ylo yhi\n-0.5 0.5 zlo zhi\n",
                     packing.grains.size(), packing.types, packing.width, packing.height);
        /* ID, type, x y z; of style sphere diameter and density, of style dipole charge and moment. */
        std::fprintf(file, "\nAtoms\n\n");
        int id = 0;
        const bool turns = atom_style != "sphere";
        for (const Grain &grain : packing.grains) {
            if (turns)
                std::fprintf(file, "%d %d %.17g %.17g 0 %.17g 1 0 %.17g %.17g 0\n", ++id, grain.type, grain.x, grain.y,
                             2 * grain.radius, std::cos(grain.angle), std::sin(grain.angle));
            else
                std::fprintf(file, "%d %d %.17g 1 %.17g %.17g 0\n", ++id, grain.type, 2 * grain.radius, grain.x,
                             grain.y);
        }
        std::fprintf(file, "\nVelocities\n\n");
        id = 0;
        for (const Grain &grain : packing.grains)
            std::fprintf(file, "%d %.17g %.17g 0 0 0 %.17g\n", ++id, grain.velocity_x, grain.velocity_y, grain.spin);
        std::fclose(file);
    }
    MPI_Barrier(world);
    run("units lj\ndimension 2\natom_style " + atom_style +
        "\natom_modify map array sort 10 1\ncomm_modify vel yes\nboundary " + boundary + "\nnewton " +
        (newton ? "on" : "off") + "\nread_data " + name.c_str());
    MPI_Barrier(world);
    if (rank == 0)
        std::remove(name.c_str());
}

std::vector<State> Simulation::states() const {
    const Atom *atom = lammps->atom;
    constexpr int columns = sizeof(State) / sizeof(double);
    std::vector<State> all(static_cast<size_t>(atom->natoms), State{});
    for (int i = 0; i < atom->nlocal; i++) {
        const double still[] = {1, 0}, *mu = atom->mu ? atom->mu[i] : still;
        all[static_cast<size_t>(atom->tag[i] - 1)] = {
            atom->x[i][0], atom->x[i][1],     mu[0],         mu[1],         atom->v[i][0],
            atom->v[i][1], atom->omega[i][2], atom->f[i][0], atom->f[i][1], atom->torque[i][2],
            atom->rmass[i]};
    }
    MPI_Allreduce(MPI_IN_PLACE, all.data(), static_cast<int>(all.size()) * columns, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

double Simulation::pair_energy() const {
    double mine = lammps->force->pair->eng_vdwl, all = 0;
    MPI_Allreduce(&mine, &all, 1, MPI_DOUBLE, MPI_SUM, world);
    return all;
}

double Simulation::variable(const std::string &expression) {
    return lammps->input->variable->compute_equal(expression);
}

Packing make_lattice(int columns, int rows, double fill, double spread, double speed, unsigned seed) {
    std::mt19937 random(seed);
    const auto uniform = [&random] { return static_cast<double>(random()) / 4294967296.0; };
    Packing packing = {static_cast<double>(columns), static_cast<double>(rows), {}};
    const double turn = 2 * std::acos(-1.0);
    for (int row = 0; row < rows; row++) {
        for (int column = 0; column < columns; column++) {
            Grain grain = {1, column + 0.5, row + 0.5, 0.5 * fill * (1 + spread * (2 * uniform() - 1)), 0, 0, 0, 0};
            grain.angle = turn * uniform();
            grain.velocity_x = speed * (2 * uniform() - 1);
            grain.velocity_y = speed * (2 * uniform() - 1);
            grain.spin = speed * (2 * uniform() - 1);
            packing.grains.push_back(grain);
        }
    }
    return packing;
}
